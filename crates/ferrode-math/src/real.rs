//! Transcendental functions that give the same bits on every machine.
//!
//! The platform's libm differs in the last bit from system to system, so everything that enters the state of a
//! simulation uses these, which are the `libm` crate's portable implementations.

macro_rules! wrap {
    ($($(#[$doc:meta])* $name:ident ( $($arg:ident),+ );)+) => {
        $($(#[$doc])* #[inline] pub fn $name($($arg: f64),+) -> f64 { libm::$name($($arg),+) })+
    };
}

wrap! {
    /// Sine of an angle in radians.
    sin(x);
    /// Cosine of an angle in radians.
    cos(x);
    /// Tangent of an angle in radians.
    tan(x);
    /// Inverse sine, in −π/2 … π/2.
    asin(x);
    /// Inverse cosine, in 0 … π.
    acos(x);
    /// Inverse tangent, in −π/2 … π/2.
    atan(x);
    /// Angle of the point (x, y), in −π … π.
    atan2(y, x);
    /// e to the power x.
    exp(x);
    /// Natural logarithm.
    log(x);
    /// x to the power y.
    pow(x, y);
    /// √(x² + y²) without overflow.
    hypot(x, y);
    /// Cube root.
    cbrt(x);
}

/// sin(x)/x, by its series near zero (ODE manual, finite rotation).
#[inline]
pub fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-4 { 1.0 - x * x * (1.0 / 6.0) } else { sin(x) / x }
}
