//! SIMD lanes: one source of a kernel for scalar and wide code, with the same bits at every width.
//!
//! A [`Kernel`] is written once, generic over [`Lanes`]. [`dispatch`] runs it with the widest lanes that the machine has,
//! found at run time: SSE2, AVX2 or AVX-512 on x86-64, NEON on aarch64, arrays elsewhere.
//!
//! Lanes offer + − × ÷ √, comparison and selection, nothing else: no fused multiply-add, no reciprocal estimate, no
//! sum across lanes. Each of these is correctly rounded, so a lane computes the bits that a scalar would, and a kernel
//! whose lanes don't depend on each other gives the same bits at every width.
//!
//! Data comes in two layouts. A [`Lanes::Block`] holds one number per lane, ready to load. A [`Record`] holds eight
//! numbers of one object; [`Lanes::gather`] and [`Lanes::scatter`] move records of as many objects as there are lanes, by
//! whole-record loads and a transposition in registers: far cheaper than loading number by number.
//!
//! ```text
//!   record i₀  x₀ y₀ z₀ …                  lane   0  1  2  3
//!   record i₁  x₁ y₁ z₁ …     gather  →       x  [x₀ x₁ x₂ x₃]
//!   record i₂  x₂ y₂ z₂ …    ← scatter        y  [y₀ y₁ y₂ y₃]
//!   record i₃  x₃ y₃ z₃ …                     z  [z₀ z₁ z₂ z₃]  …
//! ```
//!
//! ```
//! use ferrode_math::simd::{Kernel, Lanes, dispatch};
//!
//! /// Halves every number of a slice.
//! struct Halve<'a>(&'a mut [f32]);
//!
//! impl Kernel for Halve<'_> {
//!     type Out = ();
//!     #[inline(always)]
//!     fn run<L: Lanes>(self) {
//!         let mut chunks = self.0.chunks_exact_mut(L::LANES);
//!         for chunk in &mut chunks {
//!             let mut block = L::Block::default();
//!             block.as_mut().copy_from_slice(chunk);
//!             chunk.copy_from_slice((L::load(&block) * L::splat(0.5)).store().as_ref());
//!         }
//!         for x in chunks.into_remainder() {
//!             *x *= 0.5;
//!         }
//!     }
//! }
//!
//! let mut numbers: Vec<f32> = (0..19).map(|i| i as f32).collect();
//! dispatch(Halve(&mut numbers));
//! assert_eq!(numbers[18], 9.0);
//! ```
// The one module of this crate that may.
#![allow(unsafe_code)]

mod boxes;
mod lanes64;
mod level;
#[cfg(target_arch = "aarch64")]
mod neon;
mod octet;
#[cfg(target_arch = "x86_64")]
mod octet_x86;
mod ordered;
mod portable;
mod quad;
mod record;
mod wide;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use boxes::overlapping;
pub use lanes64::{Block64, EightF64, FourF64, Kernel64, Lanes64};
pub use level::{Level, dispatch, dispatch_at, dispatch_few};
pub use octet::{Octet, OctetKernel, dispatch_octets};
pub use ordered::Ordered;
pub use quad::{Pair, Quad, QuadKernel, dispatch_quads};
pub use record::{NO_RECORD, Record};
pub use wide::{Compute, compute_wide};

use quad::Array;

use crate::Scalar;
use core::cell::Cell;
use core::ops::{BitAnd, BitOr, Not};

/// A computation that is written once for lanes of any width.
///
/// Mark `run`, and all that it calls with lanes, `#[inline(always)]`: only what is inlined into the dispatcher is
/// compiled for the machine's instructions.
pub trait Kernel {
    /// What it computes.
    type Out;
    /// Computes it with lanes of type `L`.
    fn run<L: Lanes>(self) -> Self::Out;
}

/// A part of a kernel's computation that another thread does, with the lanes that the kernel was given: see [`Lanes::enter`].
///
/// Mark `run` `#[inline(always)]`, as that of a [`Kernel`].
pub trait Work<L: Lanes> {
    /// Does it.
    fn run(self);
}

mod sealed {
    /// Lanes are what this module offers: `stage` relies on what they read and write.
    pub trait Sealed {}
}

/// A truth value per lane.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Whether it is true in any lane.
    fn any(self) -> bool;
}

/// Numbers per lane in memory, aligned for loading.
pub trait Block:
    Copy + Default + AsRef<[f32]> + AsMut<[f32]> + Send + Sync + core::fmt::Debug + 'static
{
}

/// Several `f32` that are computed with at once.
///
/// The types that implement it can't be named outside: a kernel gets one from [`dispatch`], which knows that the machine
/// has the instructions.
pub trait Lanes: Scalar + Send + Sync + sealed::Sealed + 'static {
    /// How many lanes.
    const LANES: usize;
    /// A truth value per lane.
    type Mask: Mask;
    /// A number per lane in memory.
    type Block: Block;
    /// A number of a record per lane in memory.
    type Index: Copy + Default + AsRef<[u32]> + AsMut<[u32]> + Send + Sync + core::fmt::Debug + 'static;

    /// Does work with the machine's instructions for these lanes. Closures that run in other threads, or that are called by
    /// reference, don't inherit them from the kernel around them.
    #[inline(always)]
    fn enter<W: Work<Self>>(work: W) {
        work.run();
    }

    /// The same number in every lane.
    fn splat(x: f32) -> Self;
    /// A block's numbers.
    fn load(block: &Self::Block) -> Self;
    /// The lanes as a block.
    fn store(self) -> Self::Block;
    /// Where `self < b`; false where one is NaN.
    fn lt(self, b: Self) -> Self::Mask;
    /// Where `self ≤ b`; false where one is NaN.
    fn le(self, b: Self) -> Self::Mask;
    /// `a` where the mask is true, `b` elsewhere.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;

    /// `self` where that is smaller than `b`, else `b`.
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        Self::select(self.lt(b), self, b)
    }

    /// `self` where that is larger than `b`, else `b`.
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        Self::select(b.lt(self), self, b)
    }

    /// The numbers of the records `index`; zeros for [`NO_RECORD`] and all that lies beyond the end.
    #[inline(always)]
    fn gather(records: &[Cell<Record>], index: &Self::Index) -> [Self; 8] {
        portable::gather(records, index.as_ref())
    }

    /// The numbers of as many records as there are lanes, each found by its lane's number.
    #[inline(always)]
    fn transpose<'a>(record: impl Fn(usize) -> &'a Record) -> [Self; 8] {
        portable::transpose(record)
    }

    /// Writes the records `index`; skips [`NO_RECORD`] and all that lies beyond the end. Of lanes with the same index
    /// the last one counts.
    #[inline(always)]
    fn scatter(records: &[Cell<Record>], index: &Self::Index, numbers: [Self; 8]) {
        portable::scatter(records, index.as_ref(), numbers);
    }
}
