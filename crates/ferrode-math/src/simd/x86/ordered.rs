//! Four `f64` of AVX2 as numbers that can be compared.

use super::quads::F64x4;
use crate::Scalar;
use crate::simd::{Mask, Ordered};
use core::arch::x86_64::*;
use core::ops::{AddAssign, BitAnd, BitOr, Div, MulAssign, Neg, Not, SubAssign};

// As everywhere in this file's parent: values of the type are only made, and its functions only called, where the machine has AVX2.

macro_rules! assign {
    ($($trait:ident $method:ident $operator:tt;)+) => {$(
        impl $trait for F64x4 {
            #[inline(always)]
            fn $method(&mut self, b: Self) {
                *self = *self $operator b;
            }
        }
    )+};
}

assign! {
    AddAssign add_assign +;
    SubAssign sub_assign -;
    MulAssign mul_assign *;
}

impl Div for F64x4 {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_div_pd(self.0, b.0) })
    }
}

impl Neg for F64x4 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_xor_pd(self.0, _mm256_set1_pd(-0.0)) })
    }
}

impl PartialEq for F64x4 {
    #[inline(always)]
    fn eq(&self, b: &Self) -> bool {
        // SAFETY: the machine has AVX2.
        unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_EQ_OQ>(self.0, b.0)) == 15 }
    }
}

impl Default for F64x4 {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

impl Scalar for F64x4 {
    // SAFETY: a register of numbers has the size of as many numbers, and every pattern of bits is a value.
    const ZERO: Self = Self(unsafe { core::mem::transmute::<[f64; 4], __m256d>([0.0; 4]) });
    // SAFETY: as above.
    const ONE: Self = Self(unsafe { core::mem::transmute::<[f64; 4], __m256d>([1.0; 4]) });

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_sqrt_pd(self.0) })
    }

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_set1_pd(x) })
    }
}

/// All bits of a lane set for true.
#[derive(Clone, Copy, Debug)]
pub(in crate::simd) struct MaskF64x4(__m256d);

impl BitAnd for MaskF64x4 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_and_pd(self.0, b.0) })
    }
}

impl BitOr for MaskF64x4 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_or_pd(self.0, b.0) })
    }
}

impl Not for MaskF64x4 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_xor_pd(self.0, _mm256_castsi256_pd(_mm256_set1_epi64x(-1))) })
    }
}

impl Mask for MaskF64x4 {
    #[inline(always)]
    fn any(self) -> bool {
        // SAFETY: the machine has AVX2.
        unsafe { _mm256_movemask_pd(self.0) != 0 }
    }
}

impl Ordered for F64x4 {
    type Mask = MaskF64x4;

    #[inline(always)]
    fn lt(self, b: Self) -> MaskF64x4 {
        // SAFETY: the machine has AVX2.
        MaskF64x4(unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, b.0) })
    }

    #[inline(always)]
    fn le(self, b: Self) -> MaskF64x4 {
        // SAFETY: the machine has AVX2.
        MaskF64x4(unsafe { _mm256_cmp_pd::<_CMP_LE_OQ>(self.0, b.0) })
    }

    #[inline(always)]
    fn select(mask: MaskF64x4, a: Self, b: Self) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_blendv_pd(b.0, a.0, mask.0) })
    }

    #[inline(always)]
    fn bits(mask: MaskF64x4) -> u8 {
        // SAFETY: the machine has AVX2.
        unsafe { _mm256_movemask_pd(mask.0) as u8 }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        // SAFETY: the machine has AVX2.
        unsafe {
            let bit = _mm256_set1_pd(-0.0);
            Self(_mm256_or_pd(_mm256_andnot_pd(bit, self.0), _mm256_and_pd(bit, sign.0)))
        }
    }

    // The instructions return the second number where both are zero, or one is NaN: what the comparison does.

    #[inline(always)]
    fn lesser(self, b: Self) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_min_pd(self.0, b.0) })
    }

    #[inline(always)]
    fn greater(self, b: Self) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_max_pd(self.0, b.0) })
    }
}
