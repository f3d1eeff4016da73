//! What a vector's component must be able to do.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number, or a lane of numbers, with the operations that give the same bits on every machine: + − × ÷ √.
///
/// There is deliberately no fused multiply-add and no reciprocal estimate.
pub trait Scalar:
    Copy
    + Debug
    + PartialEq
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// Zero, in every lane.
    const ZERO: Self;
    /// One, in every lane.
    const ONE: Self;
    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// The constant `x`, rounded to the component's precision, in every lane.
    fn from_f64(x: f64) -> Self;
}

impl Scalar for f64 {
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn from_f64(x: f64) -> f64 {
        x
    }
}

impl Scalar for f32 {
    const ZERO: f32 = 0.0;
    const ONE: f32 = 1.0;
    #[inline(always)]
    fn sqrt(self) -> f32 {
        f32::sqrt(self)
    }
    #[inline(always)]
    fn from_f64(x: f64) -> f32 {
        x as f32
    }
}
