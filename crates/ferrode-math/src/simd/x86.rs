//! Lanes of x86-64: SSE2, which every such machine has, AVX2 and AVX-512F.
//!
//! The types of AVX2 and AVX-512 are made in `run_avx2`, `run_quads`, `run_four`, `run_eight` and `run_avx512` only, which the dispatcher
//! calls after it has found the instructions on the machine. That is what makes the intrinsics below sound.

mod eight;
mod ordered;
mod quads;

pub(super) use eight::run_eight;
pub(super) use quads::{run_four, run_quads};

use super::portable::{Block4, Block8, Block16};
use super::sealed::Sealed;
use super::{Compute, Kernel, Lanes, Mask, Record, Work};
use crate::Scalar;
use core::arch::x86_64::*;
use core::cell::Cell;
use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

/// Runs a kernel with eight lanes.
///
/// # Safety
/// The machine has AVX2.
#[target_feature(enable = "avx,avx2")]
pub(super) unsafe fn run_avx2<K: Kernel>(kernel: K) -> K::Out {
    kernel.run::<F32x8>()
}

/// Runs a computation without lanes.
///
/// # Safety
/// The machine has AVX2.
#[target_feature(enable = "avx,avx2")]
pub(super) unsafe fn compute_avx2<C: Compute>(computation: C) -> C::Out {
    computation.run()
}

/// Runs a kernel with sixteen lanes.
///
/// # Safety
/// The machine has AVX-512F.
#[target_feature(enable = "avx,avx2,avx512f")]
pub(super) unsafe fn run_avx512<K: Kernel>(kernel: K) -> K::Out {
    kernel.run::<F32x16>()
}

/// Does work with four lanes.
///
/// # Safety
/// None needed: every x86-64 machine has SSE2.
#[inline(always)]
unsafe fn enter4<W: Work<F32x4>>(work: W) {
    work.run();
}

/// Does work with eight lanes.
///
/// # Safety
/// The machine has AVX2.
#[target_feature(enable = "avx,avx2")]
unsafe fn enter8<W: Work<F32x8>>(work: W) {
    work.run();
}

/// Does work with sixteen lanes.
///
/// # Safety
/// The machine has AVX-512F.
#[target_feature(enable = "avx,avx2,avx512f")]
unsafe fn enter16<W: Work<F32x16>>(work: W) {
    work.run();
}

/// Four lanes of SSE2.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct F32x4(__m128);

/// Eight lanes of AVX2.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct F32x8(__m256);

/// Sixteen lanes of AVX-512.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct F32x16(__m512);

/// Sign bits flipped, comparisons and selection of each width.
macro_rules! helper {
    ($(#[$doc:meta] $name:ident($($arg:ident: $ty:ty),+) -> $out:ty = $body:expr;)+) => {$(
        #[$doc]
        ///
        /// # Safety
        /// The machine has the instructions.
        #[inline(always)]
        unsafe fn $name($($arg: $ty),+) -> $out {
            // SAFETY: the caller's promise.
            unsafe { $body }
        }
    )+};
}

helper! {
    /// −x.
    neg4(x: __m128) -> __m128 = _mm_xor_ps(x, _mm_set1_ps(-0.0));
    /// −x.
    neg8(x: __m256) -> __m256 = _mm256_xor_ps(x, _mm256_set1_ps(-0.0));
    /// −x.
    neg16(x: __m512) -> __m512 =
        _mm512_castsi512_ps(_mm512_xor_epi32(_mm512_castps_si512(x), _mm512_set1_epi32(i32::MIN)));
    /// a < b.
    lt8(a: __m256, b: __m256) -> __m256 = _mm256_cmp_ps::<_CMP_LT_OQ>(a, b);
    /// a < b.
    lt16(a: __m512, b: __m512) -> __mmask16 = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b);
    /// a ≤ b.
    le8(a: __m256, b: __m256) -> __m256 = _mm256_cmp_ps::<_CMP_LE_OQ>(a, b);
    /// a ≤ b.
    le16(a: __m512, b: __m512) -> __mmask16 = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b);
    /// m ? a : b.
    select4(m: __m128, a: __m128, b: __m128) -> __m128 = _mm_or_ps(_mm_and_ps(m, a), _mm_andnot_ps(m, b));
    /// m ? a : b.
    select8(m: __m256, a: __m256, b: __m256) -> __m256 = _mm256_blendv_ps(b, a, m);
    /// m ? a : b.
    select16(m: __mmask16, a: __m512, b: __m512) -> __m512 = _mm512_mask_blend_ps(m, b, a);
}

/// What the three widths share: arithmetic by one intrinsic each, and the layout of blocks.
macro_rules! lanes {
    (
        $lanes:ident, $register:ident, $block:ident, $n:literal,
        add $add:ident, sub $sub:ident, mul $mul:ident, div $div:ident, sqrt $sqrt:ident, set $set:ident,
        load $load:ident, store $store:ident, min $min:ident, max $max:ident,
        negated $neg:ident, mask $mask:ident, lt $lt:ident, le $le:ident, select $select:ident,
        gather $gather:ident, scatter $scatter:ident, enter $enter:ident,
    ) => {
        lanes!(@binary $lanes, Add, add, $add, AddAssign, add_assign);
        lanes!(@binary $lanes, Sub, sub, $sub, SubAssign, sub_assign);
        lanes!(@binary $lanes, Mul, mul, $mul, MulAssign, mul_assign);

        impl Div for $lanes {
            type Output = Self;
            #[inline(always)]
            fn div(self, b: Self) -> Self {
                // SAFETY: lanes of this type exist only where the machine has the instructions.
                Self(unsafe { $div(self.0, b.0) })
            }
        }

        impl Neg for $lanes {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: lanes of this type exist only where the machine has the instructions.
                Self(unsafe { $neg(self.0) })
            }
        }

        impl PartialEq for $lanes {
            #[inline(always)]
            fn eq(&self, b: &Self) -> bool {
                self.store() == b.store()
            }
        }

        impl Default for $lanes {
            #[inline(always)]
            fn default() -> Self {
                Self::ZERO
            }
        }

        impl Scalar for $lanes {
            // SAFETY: a register of floats has the size of as many floats, and every pattern of bits is a value.
            const ZERO: Self = Self(unsafe { core::mem::transmute::<[f32; $n], $register>([0.0; $n]) });
            // SAFETY: as above.
            const ONE: Self = Self(unsafe { core::mem::transmute::<[f32; $n], $register>([1.0; $n]) });

            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: lanes of this type exist only where the machine has the instructions.
                Self(unsafe { $sqrt(self.0) })
            }

            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                Self::splat(x as f32)
            }
        }

        impl Sealed for $lanes {}

        impl Lanes for $lanes {
            const LANES: usize = $n;
            type Mask = $mask;
            type Block = $block;
            type Index = [u32; $n];

            #[inline(always)]
            fn enter<W: Work<Self>>(work: W) {
                // SAFETY: as in `splat`.
                unsafe { $enter(work) }
            }

            #[inline(always)]
            fn splat(x: f32) -> Self {
                // SAFETY: this type can be named in a kernel only that the dispatcher runs on a machine that has the
                // instructions.
                Self(unsafe { $set(x) })
            }

            #[inline(always)]
            fn load(block: &$block) -> Self {
                // SAFETY: as in `splat`; a block is as long as the register, and aligned to its size.
                Self(unsafe { $load(block.0.as_ptr()) })
            }

            #[inline(always)]
            fn store(self) -> $block {
                let mut block = $block::default();
                // SAFETY: as in `load`.
                unsafe { $store(block.0.as_mut_ptr(), self.0) };
                block
            }

            #[inline(always)]
            fn lt(self, b: Self) -> $mask {
                // SAFETY: lanes of this type exist only where the machine has the instructions.
                $mask(unsafe { $lt(self.0, b.0) })
            }

            #[inline(always)]
            fn le(self, b: Self) -> $mask {
                // SAFETY: lanes of this type exist only where the machine has the instructions.
                $mask(unsafe { $le(self.0, b.0) })
            }

            #[inline(always)]
            fn select(mask: $mask, a: Self, b: Self) -> Self {
                // SAFETY: lanes of this type exist only where the machine has the instructions.
                Self(unsafe { $select(mask.0, a.0, b.0) })
            }

            #[inline(always)]
            fn min(self, b: Self) -> Self {
                // "a < b ? a : b", as the selection that it stands for, NaN and signed zeros included.
                // SAFETY: lanes of this type exist only where the machine has the instructions.
                Self(unsafe { $min(self.0, b.0) })
            }

            #[inline(always)]
            fn max(self, b: Self) -> Self {
                // SAFETY: as in `min`.
                Self(unsafe { $max(self.0, b.0) })
            }

            #[inline(always)]
            fn gather(records: &[Cell<Record>], index: &[u32; $n]) -> [Self; 8] {
                // SAFETY: lanes of this type exist only where the machine has the instructions; each source is a record
                // that nothing writes meanwhile, for cells are not shared among threads.
                unsafe { $gather(index.map(|i| source(records, i))) }
            }

            #[inline(always)]
            fn transpose<'a>(record: impl Fn(usize) -> &'a Record) -> [Self; 8] {
                // SAFETY: as in `gather`; a reference to a record can be read.
                unsafe { $gather(core::array::from_fn(|lane| record(lane).0.as_ptr())) }
            }

            #[inline(always)]
            fn scatter(records: &[Cell<Record>], index: &[u32; $n], numbers: [Self; 8]) {
                // SAFETY: as in `gather`.
                unsafe { $scatter(records, index, numbers) }
            }
        }
    };
    (@binary $lanes:ident, $trait:ident, $method:ident, $intrinsic:ident, $assign:ident, $assign_method:ident) => {
        impl $trait for $lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, b: Self) -> Self {
                // SAFETY: lanes of this type exist only where the machine has the instructions.
                Self(unsafe { $intrinsic(self.0, b.0) })
            }
        }

        impl $assign for $lanes {
            #[inline(always)]
            fn $assign_method(&mut self, b: Self) {
                *self = self.$method(b);
            }
        }
    };
}

lanes! {
    F32x4, __m128, Block4, 4,
    add _mm_add_ps, sub _mm_sub_ps, mul _mm_mul_ps, div _mm_div_ps, sqrt _mm_sqrt_ps, set _mm_set1_ps,
    load _mm_load_ps, store _mm_store_ps, min _mm_min_ps, max _mm_max_ps,
    negated neg4, mask Mask4, lt _mm_cmplt_ps, le _mm_cmple_ps, select select4,
    gather gather4, scatter scatter4, enter enter4,
}

lanes! {
    F32x8, __m256, Block8, 8,
    add _mm256_add_ps, sub _mm256_sub_ps, mul _mm256_mul_ps, div _mm256_div_ps, sqrt _mm256_sqrt_ps,
    set _mm256_set1_ps,
    load _mm256_load_ps, store _mm256_store_ps, min _mm256_min_ps, max _mm256_max_ps,
    negated neg8, mask Mask8, lt lt8, le le8, select select8,
    gather gather8, scatter scatter8, enter enter8,
}

lanes! {
    F32x16, __m512, Block16, 16,
    add _mm512_add_ps, sub _mm512_sub_ps, mul _mm512_mul_ps, div _mm512_div_ps, sqrt _mm512_sqrt_ps,
    set _mm512_set1_ps,
    load _mm512_load_ps, store _mm512_store_ps, min _mm512_min_ps, max _mm512_max_ps,
    negated neg16, mask Mask16, lt lt16, le le16, select select16,
    gather gather16, scatter scatter16, enter enter16,
}

/// All bits of a lane set for true.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mask4(__m128);

/// All bits of a lane set for true.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mask8(__m256);

/// A bit per lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mask16(__mmask16);

macro_rules! vector_mask {
    ($mask:ident, $and:ident, $or:ident, $xor:ident, $ones:expr, $movemask:ident) => {
        impl BitAnd for $mask {
            type Output = Self;
            #[inline(always)]
            fn bitand(self, b: Self) -> Self {
                // SAFETY: masks come from lanes, which exist only where the machine has the instructions.
                Self(unsafe { $and(self.0, b.0) })
            }
        }

        impl BitOr for $mask {
            type Output = Self;
            #[inline(always)]
            fn bitor(self, b: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $or(self.0, b.0) })
            }
        }

        impl Not for $mask {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $xor(self.0, $ones) })
            }
        }

        impl Mask for $mask {
            #[inline(always)]
            fn any(self) -> bool {
                // SAFETY: as above.
                unsafe { $movemask(self.0) != 0 }
            }
        }
    };
}

vector_mask!(Mask4, _mm_and_ps, _mm_or_ps, _mm_xor_ps, _mm_castsi128_ps(_mm_set1_epi32(-1)), _mm_movemask_ps);
vector_mask!(
    Mask8,
    _mm256_and_ps,
    _mm256_or_ps,
    _mm256_xor_ps,
    _mm256_castsi256_ps(_mm256_set1_epi32(-1)),
    _mm256_movemask_ps
);

impl BitAnd for Mask16 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        Self(self.0 & b.0)
    }
}

impl BitOr for Mask16 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        Self(self.0 | b.0)
    }
}

impl Not for Mask16 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl Mask for Mask16 {
    #[inline(always)]
    fn any(self) -> bool {
        self.0 != 0
    }
}

/// What a missing record reads as.
static NOTHING: Record = Record::ZERO;

/// A record to read from.
#[inline(always)]
fn source(records: &[Cell<Record>], index: u32) -> *const f32 {
    match records.get(index as usize) {
        Some(cell) => cell.as_ptr().cast_const().cast(),
        None => NOTHING.0.as_ptr(),
    }
}

/// The transposition of 4 by 4 numbers.
#[inline(always)]
unsafe fn transpose4(r: [__m128; 4]) -> [__m128; 4] {
    // SAFETY: every x86-64 machine has SSE2.
    unsafe {
        let a = _mm_unpacklo_ps(r[0], r[1]); // 00 10 01 11
        let b = _mm_unpackhi_ps(r[0], r[1]); // 02 12 03 13
        let c = _mm_unpacklo_ps(r[2], r[3]);
        let d = _mm_unpackhi_ps(r[2], r[3]);
        [_mm_movelh_ps(a, c), _mm_movehl_ps(c, a), _mm_movelh_ps(b, d), _mm_movehl_ps(d, b)]
    }
}

/// The transposition of 4 by 4 numbers in each half.
///
/// # Safety
/// The machine has AVX.
#[inline(always)]
unsafe fn transpose8(r: [__m256; 4]) -> [__m256; 4] {
    // SAFETY: the caller's promise.
    unsafe {
        let a = _mm256_unpacklo_ps(r[0], r[1]);
        let b = _mm256_unpackhi_ps(r[0], r[1]);
        let c = _mm256_unpacklo_ps(r[2], r[3]);
        let d = _mm256_unpackhi_ps(r[2], r[3]);
        [
            _mm256_shuffle_ps::<0x44>(a, c),
            _mm256_shuffle_ps::<0xee>(a, c),
            _mm256_shuffle_ps::<0x44>(b, d),
            _mm256_shuffle_ps::<0xee>(b, d),
        ]
    }
}

/// The transposition of 4 by 4 numbers in each quarter.
///
/// # Safety
/// The machine has AVX-512F.
#[inline(always)]
unsafe fn transpose16(r: [__m512; 4]) -> [__m512; 4] {
    // SAFETY: the caller's promise.
    unsafe {
        let a = _mm512_unpacklo_ps(r[0], r[1]);
        let b = _mm512_unpackhi_ps(r[0], r[1]);
        let c = _mm512_unpacklo_ps(r[2], r[3]);
        let d = _mm512_unpackhi_ps(r[2], r[3]);
        [
            _mm512_shuffle_ps::<0x44>(a, c),
            _mm512_shuffle_ps::<0xee>(a, c),
            _mm512_shuffle_ps::<0x44>(b, d),
            _mm512_shuffle_ps::<0xee>(b, d),
        ]
    }
}

/// # Safety
/// The pointers are those of records, which can be read.
#[inline(always)]
unsafe fn gather4(p: [*const f32; 4]) -> [F32x4; 8] {
    // SAFETY: every x86-64 machine has SSE2. Each source is a record of eight floats, aligned to 32 bytes.
    unsafe {
        let low = transpose4(p.map(|p| _mm_load_ps(p)));
        let high = transpose4(p.map(|p| _mm_load_ps(p.add(4))));
        [low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]].map(F32x4)
    }
}

#[inline(always)]
unsafe fn scatter4(records: &[Cell<Record>], index: &[u32; 4], numbers: [F32x4; 8]) {
    let [a, b, c, d, e, f, g, h] = numbers.map(|x| x.0);
    // SAFETY: every x86-64 machine has SSE2. A cell's record may be written, and is aligned to 32 bytes.
    unsafe {
        let low = transpose4([a, b, c, d]);
        let high = transpose4([e, f, g, h]);
        for ((i, low), high) in index.iter().zip(low).zip(high) {
            if let Some(cell) = records.get(*i as usize) {
                let p: *mut f32 = cell.as_ptr().cast();
                _mm_store_ps(p, low);
                _mm_store_ps(p.add(4), high);
            }
        }
    }
}

/// Lanes i and i + 4 share a register from the start, so that the transposition stays within halves.
///
/// # Safety
/// The machine has AVX; the pointers are those of records, which can be read.
#[inline(always)]
unsafe fn gather8(p: [*const f32; 8]) -> [F32x8; 8] {
    // SAFETY: the caller's promise; sources as in `gather4`.
    unsafe {
        let pair = |i: usize, offset: usize| {
            let first = _mm256_castps128_ps256(_mm_load_ps(p[i].add(offset)));
            _mm256_insertf128_ps::<1>(first, _mm_load_ps(p[i + 4].add(offset)))
        };
        let low = transpose8([pair(0, 0), pair(1, 0), pair(2, 0), pair(3, 0)]);
        let high = transpose8([pair(0, 4), pair(1, 4), pair(2, 4), pair(3, 4)]);
        [low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]].map(F32x8)
    }
}

/// # Safety
/// The machine has AVX.
#[inline(always)]
unsafe fn scatter8(records: &[Cell<Record>], index: &[u32; 8], numbers: [F32x8; 8]) {
    let [a, b, c, d, e, f, g, h] = numbers.map(|x| x.0);
    // SAFETY: the caller's promise; cells as in `scatter4`.
    unsafe {
        let low = transpose8([a, b, c, d]);
        let high = transpose8([e, f, g, h]);
        for k in 0..4 {
            if let Some(cell) = records.get(index[k] as usize) {
                let whole = _mm256_permute2f128_ps::<0x20>(low[k], high[k]);
                _mm256_store_ps(cell.as_ptr().cast(), whole);
            }
            if let Some(cell) = records.get(index[k + 4] as usize) {
                let whole = _mm256_permute2f128_ps::<0x31>(low[k], high[k]);
                _mm256_store_ps(cell.as_ptr().cast(), whole);
            }
        }
    }
}

/// Lanes i, i + 4, i + 8 and i + 12 share a register from the start.
///
/// # Safety
/// The machine has AVX-512F; the pointers are those of records, which can be read.
#[inline(always)]
unsafe fn gather16(p: [*const f32; 16]) -> [F32x16; 8] {
    // SAFETY: the caller's promise; sources as in `gather4`.
    unsafe {
        let four = |i: usize, offset: usize| {
            let r = _mm512_castps128_ps512(_mm_load_ps(p[i].add(offset)));
            let r = _mm512_insertf32x4::<1>(r, _mm_load_ps(p[i + 4].add(offset)));
            let r = _mm512_insertf32x4::<2>(r, _mm_load_ps(p[i + 8].add(offset)));
            _mm512_insertf32x4::<3>(r, _mm_load_ps(p[i + 12].add(offset)))
        };
        let low = transpose16([four(0, 0), four(1, 0), four(2, 0), four(3, 0)]);
        let high = transpose16([four(0, 4), four(1, 4), four(2, 4), four(3, 4)]);
        [low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]].map(F32x16)
    }
}

/// # Safety
/// The machine has AVX-512F.
#[inline(always)]
unsafe fn scatter16(records: &[Cell<Record>], index: &[u32; 16], numbers: [F32x16; 8]) {
    let [a, b, c, d, e, f, g, h] = numbers.map(|x| x.0);
    // SAFETY: the caller's promise; cells as in `scatter4`.
    unsafe {
        let low = transpose16([a, b, c, d]);
        let high = transpose16([e, f, g, h]);
        for k in 0..4 {
            let quarters = [
                [_mm512_extractf32x4_ps::<0>(low[k]), _mm512_extractf32x4_ps::<0>(high[k])],
                [_mm512_extractf32x4_ps::<1>(low[k]), _mm512_extractf32x4_ps::<1>(high[k])],
                [_mm512_extractf32x4_ps::<2>(low[k]), _mm512_extractf32x4_ps::<2>(high[k])],
                [_mm512_extractf32x4_ps::<3>(low[k]), _mm512_extractf32x4_ps::<3>(high[k])],
            ];
            for (quarter, [low, high]) in quarters.into_iter().enumerate() {
                if let Some(cell) = records.get(index[k + 4 * quarter] as usize) {
                    let p: *mut f32 = cell.as_ptr().cast();
                    _mm_store_ps(p, low);
                    _mm_store_ps(p.add(4), high);
                }
            }
        }
    }
}

/// See [`super::overlapping`].
#[inline(always)]
pub(super) fn overlapping(sides: &[[[f32; 4]; 2]; 3], min: &[f32; 3], max: &[f32; 3]) -> u8 {
    // SAFETY: every x86-64 machine has SSE2; each array holds four numbers, of any alignment.
    unsafe {
        let below = |k: usize| {
            let low = _mm_cmple_ps(_mm_loadu_ps(sides[k][0].as_ptr()), _mm_set1_ps(max[k]));
            let high = _mm_cmple_ps(_mm_set1_ps(min[k]), _mm_loadu_ps(sides[k][1].as_ptr()));
            _mm_and_ps(low, high)
        };
        _mm_movemask_ps(_mm_and_ps(_mm_and_ps(below(0), below(1)), below(2))) as u8
    }
}
