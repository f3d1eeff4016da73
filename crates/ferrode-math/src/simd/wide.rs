//! The machine's widest instructions for loops that name no lanes.

/// A computation in plain numbers whose loops the compiler may put into registers of any width.
///
/// It may not reorder sums, and products and sums are never fused, so the bits are those of any other machine.
///
/// Mark `run`, and all that it calls in its loops, `#[inline(always)]`: only what is inlined into the dispatcher is compiled for
/// the machine's instructions.
pub trait Compute {
    /// What it computes.
    type Out;
    /// Computes it.
    fn run(self) -> Self::Out;
}

/// Runs a computation with the widest instructions that the machine has: AVX2 on x86-64 if it is there, else what the target has.
#[inline]
pub fn compute_wide<C: Compute>(computation: C) -> C::Out {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has the instructions.
        return unsafe { super::x86::compute_avx2(computation) };
    }
    computation.run()
}
