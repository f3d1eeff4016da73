//! Unit vectors, quickly.

use ferrode_math::Vec3;

/// The unit vector along `v`, as [`Vec3::normalized`] but for the last bits: that one first divides by the largest
/// component, which only lengths near the ends of the range of numbers need.
#[inline(always)]
pub(super) fn unit(v: Vec3) -> Option<Vec3> {
    let square = v.length_squared();
    if square > 1e-200 && square < 1e200 { Some(v * (1.0 / square.sqrt())) } else { v.normalized() }
}

/// As [`unit`]; `fallback` if `v` has no direction.
#[inline(always)]
pub(super) fn unit_or(v: Vec3, fallback: Vec3) -> Vec3 {
    unit(v).unwrap_or(fallback)
}

/// The unit vector along `v`, whose length is known but for rounding: without a root.
#[inline(always)]
pub(super) fn unit_of_length(v: Vec3, length: f64) -> Option<Vec3> {
    let n = v * (1.0 / length);
    let off = n.length_squared() - 1.0;
    // One step of Newton's method for the reciprocal root leaves 3/8 of the square.
    if off.abs() < 1e-8 { Some(n * (1.0 - 0.5 * off)) } else { unit(v) }
}
