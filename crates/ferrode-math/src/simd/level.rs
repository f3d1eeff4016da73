//! Which lanes the machine has, and the way into them.

use super::Kernel;
use super::portable::Portable;

/// A kind of lanes. All give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Level {
    /// One lane.
    Scalar,
    /// Four lanes as an array.
    Portable4,
    /// Eight lanes as an array.
    Portable8,
    /// Sixteen lanes as an array.
    Portable16,
    /// Four lanes of x86-64's SSE2.
    Sse2,
    /// Eight lanes of x86-64's AVX2.
    Avx2,
    /// Sixteen lanes of x86-64's AVX-512.
    Avx512,
    /// Four lanes of aarch64's NEON.
    Neon,
}

impl Level {
    /// All kinds.
    pub const ALL: [Self; 8] = [
        Self::Scalar,
        Self::Portable4,
        Self::Portable8,
        Self::Portable16,
        Self::Sse2,
        Self::Avx2,
        Self::Avx512,
        Self::Neon,
    ];

    /// Whether this machine has it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Scalar | Self::Portable4 | Self::Portable8 | Self::Portable16 => true,
            #[cfg(target_arch = "x86_64")]
            Self::Sse2 => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => std::arch::is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => std::arch::is_x86_feature_detected!("avx512f"),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => true,
            #[allow(unreachable_patterns)]
            _ => false,
        }
    }

    /// The kind that runs fastest on this machine.
    pub fn best() -> Self {
        let by_speed = [Self::Avx2, Self::Sse2, Self::Neon];
        by_speed.into_iter().find(|level| level.is_available()).unwrap_or(Self::Portable4)
    }
}

/// Runs a kernel with the lanes that are fastest on this machine.
///
/// Call it inside each parallel task, not around a parallel loop: closures don't inherit the instruction set.
#[inline]
pub fn dispatch<K: Kernel>(kernel: K) -> K::Out {
    dispatch_at(Level::best(), kernel)
}

/// Runs a kernel with lanes of a given kind; with the machine's best if it lacks that kind.
#[inline]
pub fn dispatch_at<K: Kernel>(level: Level, kernel: K) -> K::Out {
    let level = if level.is_available() { level } else { Level::best() };
    match level {
        Level::Scalar => kernel.run::<Portable<1>>(),
        Level::Portable4 => kernel.run::<Portable<4>>(),
        Level::Portable8 => kernel.run::<Portable<8>>(),
        Level::Portable16 => kernel.run::<Portable<16>>(),
        #[cfg(target_arch = "x86_64")]
        Level::Sse2 => kernel.run::<super::x86::F32x4>(),
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `is_available` has found the instructions on this machine.
        Level::Avx2 => unsafe { super::x86::run_avx2(kernel) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `is_available` has found the instructions on this machine.
        Level::Avx512 => unsafe { super::x86::run_avx512(kernel) },
        #[cfg(target_arch = "aarch64")]
        Level::Neon => kernel.run::<super::neon::F32x4>(),
        #[allow(unreachable_patterns)]
        _ => kernel.run::<Portable<4>>(),
    }
}

/// As [`dispatch_at`] for large kernels: compiled for one lane and the machine's own instructions only. Other levels run as those.
#[inline]
pub fn dispatch_few<K: Kernel>(level: Level, kernel: K) -> K::Out {
    match level {
        Level::Scalar | Level::Portable4 | Level::Portable8 | Level::Portable16 => {
            kernel.run::<Portable<1>>()
        }
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `is_available` has found the instructions on this machine.
        Level::Avx512 if Level::Avx512.is_available() => unsafe { super::x86::run_avx512(kernel) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `is_available` has found the instructions on this machine.
        Level::Avx2 | Level::Avx512 if Level::Avx2.is_available() => unsafe { super::x86::run_avx2(kernel) },
        #[cfg(target_arch = "x86_64")]
        _ => kernel.run::<super::x86::F32x4>(),
        #[cfg(target_arch = "aarch64")]
        _ => kernel.run::<super::neon::F32x4>(),
        #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
        _ => kernel.run::<Portable<1>>(),
    }
}
