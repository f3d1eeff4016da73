//! Octets of x86-64: one register of AVX2, or two of SSE2, which every such machine has.
//!
//! The type of AVX2 is made in `run_avx2` only, which the dispatcher calls after it has found the instructions on the machine. That is
//! what makes the intrinsics below sound.

use super::{Octet, OctetKernel};
use core::arch::x86_64::*;
use core::ops::{Add, Mul, Sub};

/// Runs a kernel with octets of AVX2.
///
/// # Safety
/// The machine has AVX2, and these instructions for bits.
#[target_feature(enable = "avx,avx2,bmi1,bmi2,popcnt")]
pub(super) unsafe fn run_avx2<K: OctetKernel>(kernel: K) -> K::Out {
    kernel.run::<One>()
}

/// Eight numbers in a register of AVX2.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct One(__m256);

/// Eight numbers in two registers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Two([__m128; 2]);

impl Add for One {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        // SAFETY: values of the type are only made where the machine has AVX2.
        Self(unsafe { _mm256_add_ps(self.0, b.0) })
    }
}

impl Sub for One {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        // SAFETY: as in `add`.
        Self(unsafe { _mm256_sub_ps(self.0, b.0) })
    }
}

impl Mul for One {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        // SAFETY: as in `add`.
        Self(unsafe { _mm256_mul_ps(self.0, b.0) })
    }
}

// The functions that take no value of the type are called by a kernel that `run_avx2` runs, and by nobody else: the type is named in
// this file only.
impl Octet for One {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_set1_ps(x) })
    }

    #[inline(always)]
    fn from_bytes(bytes: &[u8; 8]) -> Self {
        let bytes = i64::from_le_bytes(*bytes);
        // SAFETY: the machine has AVX2.
        Self(unsafe { _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_cvtsi64_si128(bytes))) })
    }

    #[inline(always)]
    fn scale(self, word: u32) -> Self {
        // SAFETY: as in `add`.
        unsafe {
            let top = _mm256_set1_epi32(0xff00_0000u32.cast_signed());
            let exponent =
                _mm256_srai_epi32::<1>(_mm256_and_si256(_mm256_set1_epi32(word.cast_signed()), top));
            Self(_mm256_castsi256_ps(_mm256_add_epi32(_mm256_castps_si256(self.0), exponent)))
        }
    }

    #[inline(always)]
    fn store(self) -> [f32; 8] {
        let mut to = [0.0; 8];
        // SAFETY: the machine has AVX2; the array holds eight numbers, of any alignment.
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) };
        to
    }

    #[inline(always)]
    fn min(self, b: Self) -> Self {
        // "a < b ? a : b", NaN and signed zeros included.
        // SAFETY: as in `add`.
        Self(unsafe { _mm256_min_ps(self.0, b.0) })
    }

    #[inline(always)]
    fn max(self, b: Self) -> Self {
        // SAFETY: as in `add`.
        Self(unsafe { _mm256_max_ps(self.0, b.0) })
    }

    #[inline(always)]
    fn le(self, b: Self) -> u8 {
        // SAFETY: as in `add`.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, b.0)) as u8 }
    }
}

impl Two {
    #[inline(always)]
    fn each(self, b: Self, f: impl Fn(__m128, __m128) -> __m128) -> Self {
        Self([f(self.0[0], b.0[0]), f(self.0[1], b.0[1])])
    }
}

impl Add for Two {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        // SAFETY: every x86-64 machine has SSE2.
        self.each(b, |x, y| unsafe { _mm_add_ps(x, y) })
    }
}

impl Sub for Two {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        // SAFETY: as in `add`.
        self.each(b, |x, y| unsafe { _mm_sub_ps(x, y) })
    }
}

impl Mul for Two {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        // SAFETY: as in `add`.
        self.each(b, |x, y| unsafe { _mm_mul_ps(x, y) })
    }
}

impl Octet for Two {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        // SAFETY: as in `add`.
        Self([unsafe { _mm_set1_ps(x) }; 2])
    }

    #[inline(always)]
    fn from_bytes(bytes: &[u8; 8]) -> Self {
        let bytes = i64::from_le_bytes(*bytes);
        // SAFETY: as in `add`.
        unsafe {
            let zero = _mm_setzero_si128();
            let words = _mm_unpacklo_epi8(_mm_cvtsi64_si128(bytes), zero);
            let (low, high) = (_mm_unpacklo_epi16(words, zero), _mm_unpackhi_epi16(words, zero));
            Self([_mm_cvtepi32_ps(low), _mm_cvtepi32_ps(high)])
        }
    }

    #[inline(always)]
    fn scale(self, word: u32) -> Self {
        // SAFETY: as in `add`.
        unsafe {
            let top = _mm_set1_epi32(0xff00_0000u32.cast_signed());
            let exponent = _mm_srai_epi32::<1>(_mm_and_si128(_mm_set1_epi32(word.cast_signed()), top));
            Self(self.0.map(|x| _mm_castsi128_ps(_mm_add_epi32(_mm_castps_si128(x), exponent))))
        }
    }

    #[inline(always)]
    fn store(self) -> [f32; 8] {
        let mut to = [0.0; 8];
        // SAFETY: as in `add`; the array holds eight numbers, of any alignment.
        unsafe {
            _mm_storeu_ps(to.as_mut_ptr(), self.0[0]);
            _mm_storeu_ps(to.as_mut_ptr().add(4), self.0[1]);
        }
        to
    }

    #[inline(always)]
    fn min(self, b: Self) -> Self {
        // SAFETY: as in `add`.
        self.each(b, |x, y| unsafe { _mm_min_ps(x, y) })
    }

    #[inline(always)]
    fn max(self, b: Self) -> Self {
        // SAFETY: as in `add`.
        self.each(b, |x, y| unsafe { _mm_max_ps(x, y) })
    }

    #[inline(always)]
    fn le(self, b: Self) -> u8 {
        // SAFETY: as in `add`.
        let bits = [0, 1].map(|k| unsafe { _mm_movemask_ps(_mm_cmple_ps(self.0[k], b.0[k])) });
        (bits[0] | bits[1] << 4) as u8
    }
}
