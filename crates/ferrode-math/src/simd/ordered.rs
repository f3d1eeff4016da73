//! Comparison, selection and signs, for numbers and for lanes of numbers alike.

use super::Mask;
use crate::Scalar;

/// A number, or lanes of numbers, that can be compared: what separating axes and clipping are written in once for one and for many.
pub trait Ordered: Scalar {
    /// A truth value per lane.
    type Mask: Mask;

    /// Where `self < b`; false where one is NaN.
    fn lt(self, b: Self) -> Self::Mask;
    /// Where `self ≤ b`; false where one is NaN.
    fn le(self, b: Self) -> Self::Mask;
    /// `a` where the mask is true, `b` elsewhere.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// Bit `l` tells whether the mask is true in lane `l`.
    fn bits(mask: Self::Mask) -> u8;
    /// Without the sign.
    #[must_use]
    fn abs(self) -> Self;
    /// With the sign of another number, also of a zero.
    #[must_use]
    fn copysign(self, sign: Self) -> Self;

    /// `self` where that is smaller than `b`, else `b`.
    #[inline(always)]
    #[must_use]
    fn lesser(self, b: Self) -> Self {
        Self::select(self.lt(b), self, b)
    }

    /// `self` where that is larger than `b`, else `b`.
    #[inline(always)]
    #[must_use]
    fn greater(self, b: Self) -> Self {
        Self::select(b.lt(self), self, b)
    }
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
}

impl Ordered for f64 {
    type Mask = bool;

    #[inline(always)]
    fn lt(self, b: Self) -> bool {
        self < b
    }

    #[inline(always)]
    fn le(self, b: Self) -> bool {
        self <= b
    }

    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }

    #[inline(always)]
    fn bits(mask: bool) -> u8 {
        u8::from(mask)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        f64::copysign(self, sign)
    }
}
