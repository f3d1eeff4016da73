//! Four `f64` of AVX2, and two next to them.

use crate::simd::{FourF64, Kernel64, Lanes64, Pair, Quad, QuadKernel};
use core::arch::x86_64::*;
use core::ops::{Add, Mul, Sub};

/// Runs a kernel with AVX2's quads.
///
/// # Safety
/// The machine has AVX2.
#[target_feature(enable = "avx,avx2")]
pub(in crate::simd) unsafe fn run_quads<K: QuadKernel>(kernel: K) -> K::Out {
    kernel.run::<F64x4>()
}

/// Runs a kernel with four lanes of `f64`.
///
/// # Safety
/// The machine has AVX2.
#[target_feature(enable = "avx,avx2")]
pub(in crate::simd) unsafe fn run_four<K: Kernel64<FourF64>>(kernel: K) -> K::Out {
    kernel.run::<F64x4>()
}

/// Four numbers in a register of AVX2.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(in crate::simd) struct F64x4(pub(super) __m256d);

/// Two numbers in a register, next to [`F64x4`].
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(in crate::simd) struct F64x2(__m128d);

macro_rules! f64_operators {
    ($($type:ident $add:ident $sub:ident $mul:ident;)+) => {$(
        impl Add for $type {
            type Output = Self;
            #[inline(always)]
            fn add(self, b: Self) -> Self {
                // SAFETY: values of the type are only made where the machine has AVX2.
                Self(unsafe { $add(self.0, b.0) })
            }
        }

        impl Sub for $type {
            type Output = Self;
            #[inline(always)]
            fn sub(self, b: Self) -> Self {
                // SAFETY: as in `add`.
                Self(unsafe { $sub(self.0, b.0) })
            }
        }

        impl Mul for $type {
            type Output = Self;
            #[inline(always)]
            fn mul(self, b: Self) -> Self {
                // SAFETY: as in `add`.
                Self(unsafe { $mul(self.0, b.0) })
            }
        }
    )+};
}

f64_operators! {
    F64x4 _mm256_add_pd _mm256_sub_pd _mm256_mul_pd;
    F64x2 _mm_add_pd _mm_sub_pd _mm_mul_pd;
}

// Each function below that takes no value of the type is called by a kernel that `run_quads` runs, and by nobody else: the types are
// named in this file only.

impl Lanes64 for F64x4 {
    type Block = FourF64;

    #[inline(always)]
    fn load(from: &FourF64) -> Self {
        // SAFETY: the machine has AVX2; the block holds four numbers, aligned to as many.
        Self(unsafe { _mm256_load_pd(from.as_ref().as_ptr()) })
    }

    #[inline(always)]
    fn store(self, to: &mut FourF64) {
        // SAFETY: as in `load`.
        unsafe { _mm256_store_pd(to.as_mut().as_mut_ptr(), self.0) };
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_set1_pd(x) })
    }
}

impl Quad for F64x4 {
    type Pair = F64x2;

    #[inline(always)]
    fn load(from: &[f64; 4]) -> Self {
        // SAFETY: the machine has AVX2; the array holds four numbers, of any alignment.
        Self(unsafe { _mm256_loadu_pd(from.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; 4]) {
        // SAFETY: as in `load`.
        unsafe { _mm256_storeu_pd(to.as_mut_ptr(), self.0) };
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_set1_pd(x) })
    }

    #[inline(always)]
    fn fold(self) -> F64x2 {
        // SAFETY: the machine has AVX2.
        F64x2(unsafe { _mm_add_pd(_mm256_castpd256_pd128(self.0), _mm256_extractf128_pd::<1>(self.0)) })
    }

    #[inline(always)]
    fn low(self) -> F64x2 {
        // SAFETY: the machine has AVX2.
        F64x2(unsafe { _mm256_castpd256_pd128(self.0) })
    }

    #[inline(always)]
    fn high(self) -> F64x2 {
        // SAFETY: the machine has AVX2.
        F64x2(unsafe { _mm256_extractf128_pd::<1>(self.0) })
    }

    #[inline(always)]
    fn join(low: F64x2, high: F64x2) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(low.0), high.0) })
    }

    #[inline(always)]
    fn sums([a, b, c, d]: [Self; 4]) -> Self {
        // SAFETY: the machine has AVX2.
        unsafe {
            // [a₀ + a₁, b₀ + b₁, a₂ + a₃, b₂ + b₃], and so for the others.
            let (ab, cd) = (_mm256_hadd_pd(a.0, b.0), _mm256_hadd_pd(c.0, d.0));
            let across = _mm256_permute2f128_pd::<0x21>(ab, cd);
            Self(_mm256_add_pd(_mm256_blend_pd::<0b1100>(ab, cd), across))
        }
    }

    #[inline(always)]
    fn columns([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        // SAFETY: the machine has AVX2.
        unsafe {
            // [a₀, b₀, a₂, b₂] and [a₁, b₁, a₃, b₃], and so for the others.
            let (ab, ab1) = (_mm256_unpacklo_pd(a.0, b.0), _mm256_unpackhi_pd(a.0, b.0));
            let (cd, cd1) = (_mm256_unpacklo_pd(c.0, d.0), _mm256_unpackhi_pd(c.0, d.0));
            [
                Self(_mm256_permute2f128_pd::<0x20>(ab, cd)),
                Self(_mm256_permute2f128_pd::<0x20>(ab1, cd1)),
                Self(_mm256_permute2f128_pd::<0x31>(ab, cd)),
                Self(_mm256_permute2f128_pd::<0x31>(ab1, cd1)),
            ]
        }
    }
}

impl Pair for F64x2 {
    #[inline(always)]
    fn load(from: &[f64; 2]) -> Self {
        // SAFETY: the machine has AVX2; the array holds two numbers, of any alignment.
        Self(unsafe { _mm_loadu_pd(from.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; 2]) {
        // SAFETY: as in `load`.
        unsafe { _mm_storeu_pd(to.as_mut_ptr(), self.0) };
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm_set1_pd(x) })
    }

    #[inline(always)]
    fn add_first(self, x: f64) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm_add_sd(self.0, _mm_set_sd(x)) })
    }

    #[inline(always)]
    fn sum(self) -> f64 {
        // SAFETY: the machine has AVX2.
        unsafe { _mm_cvtsd_f64(_mm_add_sd(self.0, _mm_unpackhi_pd(self.0, self.0))) }
    }

    #[inline(always)]
    fn sums([a, b]: [Self; 2]) -> Self {
        // SAFETY: the machine has AVX2, and with it SSE3.
        Self(unsafe { _mm_hadd_pd(a.0, b.0) })
    }
}
