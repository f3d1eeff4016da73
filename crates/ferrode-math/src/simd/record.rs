//! Records: the eight numbers of one object, side by side.

/// Eight numbers of one object, as [`Lanes::gather`](super::Lanes::gather) reads them: half a cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Record(pub [f32; 8]);

/// The index of no record: it reads as zeros, and nothing is written.
pub const NO_RECORD: u32 = u32::MAX;

impl Record {
    /// All zeros: what a missing record reads as.
    pub const ZERO: Self = Self([0.0; 8]);
}
