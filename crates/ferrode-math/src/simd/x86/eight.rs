//! Eight `f64` of AVX-512.

use crate::Scalar;
use crate::simd::{EightF64, Kernel64, Lanes64, Mask, Ordered};
use core::arch::x86_64::*;
use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

// As everywhere in this file's parent: values of the type are only made, and its functions only called, where the machine has AVX-512F: by
// kernels that `run_eight` runs.

/// Runs a kernel with eight lanes of `f64`.
///
/// # Safety
/// The machine has AVX-512F.
#[target_feature(enable = "avx,avx2,avx512f")]
pub(in crate::simd) unsafe fn run_eight<K: Kernel64<EightF64>>(kernel: K) -> K::Out {
    kernel.run::<F64x8>()
}

/// Eight numbers in a register.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct F64x8(__m512d);

macro_rules! operators {
    ($($trait:ident $method:ident $intrinsic:ident;)+) => {$(
        impl $trait for F64x8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, b: Self) -> Self {
                // SAFETY: the machine has AVX-512F.
                Self(unsafe { $intrinsic(self.0, b.0) })
            }
        }
    )+};
}

operators! {
    Add add _mm512_add_pd;
    Sub sub _mm512_sub_pd;
    Mul mul _mm512_mul_pd;
    Div div _mm512_div_pd;
}

macro_rules! assign {
    ($($trait:ident $method:ident $operator:tt;)+) => {$(
        impl $trait for F64x8 {
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

impl Neg for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: the machine has AVX-512F.
        unsafe {
            let bits = _mm512_castpd_si512(self.0);
            Self(_mm512_castsi512_pd(_mm512_xor_epi64(bits, _mm512_set1_epi64(i64::MIN))))
        }
    }
}

impl PartialEq for F64x8 {
    #[inline(always)]
    fn eq(&self, b: &Self) -> bool {
        // SAFETY: the machine has AVX-512F.
        unsafe { _mm512_cmp_pd_mask::<_CMP_EQ_OQ>(self.0, b.0) == u8::MAX }
    }
}

impl Default for F64x8 {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

impl Scalar for F64x8 {
    // SAFETY: a register of numbers has the size of as many numbers, and every pattern of bits is a value.
    const ZERO: Self = Self(unsafe { core::mem::transmute::<[f64; 8], __m512d>([0.0; 8]) });
    // SAFETY: as above.
    const ONE: Self = Self(unsafe { core::mem::transmute::<[f64; 8], __m512d>([1.0; 8]) });

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the machine has AVX-512F.
        Self(unsafe { _mm512_sqrt_pd(self.0) })
    }

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        // SAFETY: the machine has AVX-512F.
        Self(unsafe { _mm512_set1_pd(x) })
    }
}

/// A bit per lane.
#[derive(Clone, Copy, Debug)]
pub(in crate::simd) struct MaskF64x8(__mmask8);

impl BitAnd for MaskF64x8 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        Self(self.0 & b.0)
    }
}

impl BitOr for MaskF64x8 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        Self(self.0 | b.0)
    }
}

impl Not for MaskF64x8 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl Mask for MaskF64x8 {
    #[inline(always)]
    fn any(self) -> bool {
        self.0 != 0
    }
}

impl Ordered for F64x8 {
    type Mask = MaskF64x8;

    #[inline(always)]
    fn lt(self, b: Self) -> MaskF64x8 {
        // SAFETY: the machine has AVX-512F.
        MaskF64x8(unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, b.0) })
    }

    #[inline(always)]
    fn le(self, b: Self) -> MaskF64x8 {
        // SAFETY: the machine has AVX-512F.
        MaskF64x8(unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, b.0) })
    }

    #[inline(always)]
    fn select(mask: MaskF64x8, a: Self, b: Self) -> Self {
        // SAFETY: the machine has AVX-512F.
        Self(unsafe { _mm512_mask_blend_pd(mask.0, b.0, a.0) })
    }

    #[inline(always)]
    fn bits(mask: MaskF64x8) -> u8 {
        mask.0
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: the machine has AVX-512F.
        Self(unsafe { _mm512_abs_pd(self.0) })
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        // SAFETY: the machine has AVX-512F.
        unsafe {
            let bit = _mm512_set1_epi64(i64::MIN);
            let size = _mm512_andnot_epi64(bit, _mm512_castpd_si512(self.0));
            let sign = _mm512_and_epi64(bit, _mm512_castpd_si512(sign.0));
            Self(_mm512_castsi512_pd(_mm512_or_epi64(size, sign)))
        }
    }

    // The instructions return the second number where both are zero, or one is NaN: what the comparison does.

    #[inline(always)]
    fn lesser(self, b: Self) -> Self {
        // SAFETY: the machine has AVX-512F.
        Self(unsafe { _mm512_min_pd(self.0, b.0) })
    }

    #[inline(always)]
    fn greater(self, b: Self) -> Self {
        // SAFETY: the machine has AVX-512F.
        Self(unsafe { _mm512_max_pd(self.0, b.0) })
    }
}

impl Lanes64 for F64x8 {
    type Block = EightF64;

    #[inline(always)]
    fn load(from: &EightF64) -> Self {
        // SAFETY: the machine has AVX-512F; the block holds eight numbers, aligned to as many.
        Self(unsafe { _mm512_load_pd(from.as_ref().as_ptr()) })
    }

    #[inline(always)]
    fn store(self, to: &mut EightF64) {
        // SAFETY: as in `load`.
        unsafe { _mm512_store_pd(to.as_mut().as_mut_ptr(), self.0) };
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        // SAFETY: the machine has AVX-512F.
        Self(unsafe { _mm512_set1_pd(x) })
    }
}
