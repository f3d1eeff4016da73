//! Several `f64` at once, each of a problem of its own: nothing goes across lanes.
//!
//! Where a [`Quad`](super::Quad) holds four numbers of one problem, these lanes hold the same number of four or eight problems, so that blocks
//! of three or six fill whole registers and no sum runs across one. Each lane computes the bits that a scalar would.

use super::sealed::Sealed;
use super::{Array, Ordered};
use core::fmt::Debug;
use core::ops::{Index, IndexMut};

/// A computation that is written once for lanes of any kind, on numbers that are stored for so many lanes.
///
/// Mark `run`, and all that it calls with lanes, `#[inline(always)]`: only what is inlined into the dispatcher is compiled for the
/// machine's instructions.
pub trait Kernel64<B: Block64> {
    /// What it computes.
    type Out;
    /// Computes it with lanes of type `L`.
    fn run<L: Lanes64<Block = B>>(self) -> Self::Out;
}

/// Several `f64` that are computed with at once.
///
/// The types that implement it can't be named outside: a kernel gets one from [`Block64::dispatch`], which knows that the machine has the
/// instructions.
pub trait Lanes64: Ordered {
    /// A number per lane in memory.
    type Block: Block64;
    /// A block's numbers.
    fn load(from: &Self::Block) -> Self;
    /// Writes the numbers.
    fn store(self, to: &mut Self::Block);
    /// The same number in every lane.
    fn splat(x: f64) -> Self;
}

/// A number per lane in memory, aligned for loading.
pub trait Block64:
    Copy
    + Default
    + PartialEq
    + Debug
    + AsRef<[f64]>
    + AsMut<[f64]>
    + Index<usize, Output = f64>
    + IndexMut<usize>
    + Send
    + Sync
    + Sealed
    + 'static
{
    /// How many lanes: a multiple of four.
    const LANES: usize;

    /// The same number in every lane.
    fn splat(x: f64) -> Self;

    /// Whether the machine has registers for so many lanes, or the kind is the fallback.
    fn is_available() -> bool;

    /// Runs a kernel; nothing is run where [`Block64::is_available`] says no.
    fn dispatch<K: Kernel64<Self>>(kernel: K) -> Option<K::Out>;
}

macro_rules! block {
    ($(#[$doc:meta])* $name:ident, $n:literal, $align:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        #[repr(C, align($align))]
        pub struct $name([f64; $n]);

        impl AsRef<[f64]> for $name {
            #[inline(always)]
            fn as_ref(&self) -> &[f64] {
                &self.0
            }
        }

        impl AsMut<[f64]> for $name {
            #[inline(always)]
            fn as_mut(&mut self) -> &mut [f64] {
                &mut self.0
            }
        }

        impl Index<usize> for $name {
            type Output = f64;
            #[inline(always)]
            fn index(&self, lane: usize) -> &f64 {
                &self.0[lane]
            }
        }

        impl IndexMut<usize> for $name {
            #[inline(always)]
            fn index_mut(&mut self, lane: usize) -> &mut f64 {
                &mut self.0[lane]
            }
        }

        impl From<[f64; $n]> for $name {
            #[inline(always)]
            fn from(numbers: [f64; $n]) -> Self {
                Self(numbers)
            }
        }

        impl From<$name> for [f64; $n] {
            #[inline(always)]
            fn from(block: $name) -> Self {
                block.0
            }
        }

        impl Sealed for $name {}

        impl Lanes64 for Array<$n> {
            type Block = $name;

            #[inline(always)]
            fn load(from: &$name) -> Self {
                Self(from.0)
            }

            #[inline(always)]
            fn store(self, to: &mut $name) {
                to.0 = self.0;
            }

            #[inline(always)]
            fn splat(x: f64) -> Self {
                Self([x; $n])
            }
        }
    };
}

block! {
    /// Four numbers: a register of AVX2, an array elsewhere.
    FourF64, 4, 32
}

block! {
    /// Eight numbers: a register of AVX-512, which the machine may lack.
    EightF64, 8, 64
}

impl Block64 for FourF64 {
    const LANES: usize = 4;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 4])
    }

    fn is_available() -> bool {
        true
    }

    #[inline]
    fn dispatch<K: Kernel64<Self>>(kernel: K) -> Option<K::Out> {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the machine has the instructions.
            return Some(unsafe { super::x86::run_four(kernel) });
        }
        Some(kernel.run::<Array<4>>())
    }
}

impl Block64 for EightF64 {
    const LANES: usize = 8;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 8])
    }

    fn is_available() -> bool {
        #[cfg(target_arch = "x86_64")]
        return std::arch::is_x86_feature_detected!("avx512f");
        #[cfg(not(target_arch = "x86_64"))]
        false
    }

    #[inline]
    fn dispatch<K: Kernel64<Self>>(kernel: K) -> Option<K::Out> {
        #[cfg(target_arch = "x86_64")]
        if Self::is_available() {
            // SAFETY: the machine has the instructions.
            return Some(unsafe { super::x86::run_eight(kernel) });
        }
        let _ = kernel;
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All operations, on numbers of which some are NaN, infinite or zero with a sign.
    struct All<B>(Vec<B>);

    impl<B: Block64> Kernel64<B> for All<B> {
        type Out = Vec<u64>;

        #[inline(always)]
        fn run<L: Lanes64<Block = B>>(self) -> Vec<u64> {
            let mut bits = Vec::new();
            for x in &self.0 {
                for y in &self.0 {
                    let (x, y) = (L::load(x), L::load(y));
                    let mut z = x;
                    z += y;
                    z -= L::splat(0.3);
                    z *= y;
                    let all = [
                        x + y,
                        x - y,
                        x * y,
                        x / y,
                        -x,
                        z,
                        x.sqrt(),
                        x.abs(),
                        x.copysign(y),
                        x.lesser(y),
                        x.greater(y),
                        L::select(x.lt(y), x, L::ONE),
                        L::select(x.le(y), L::from_f64(0.1), y),
                        L::select(!x.lt(y) & y.le(x) | x.lt(L::ZERO), x, y),
                    ];
                    bits.push(u64::from(L::bits(x.lt(y)) + u8::from(x == y)));
                    for number in all {
                        let mut block = B::default();
                        number.store(&mut block);
                        // All NaN are alike.
                        bits.extend(block.as_ref().iter().map(|x| if x.is_nan() { 1 } else { x.to_bits() }));
                    }
                }
            }
            bits
        }
    }

    /// Every lane meets each of the numbers.
    fn blocks<B: Block64>() -> Vec<B> {
        let numbers = [0.0, -0.0, 1.5, -2.25e-300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, 0.1];
        let block = |first: usize| {
            let mut block = B::default();
            for (l, x) in block.as_mut().iter_mut().enumerate() {
                *x = numbers[(first + 2 * l) % numbers.len()];
            }
            block
        };
        (0..numbers.len()).map(block).collect()
    }

    fn same_bits<B: Block64, L: Lanes64<Block = B>>() {
        assert_eq!(B::splat(0.3).as_ref(), vec![0.3; B::LANES]);
        let wide = B::dispatch(All(blocks::<B>()));
        assert_eq!(wide.is_some(), B::is_available());
        if let Some(wide) = wide {
            assert_eq!(wide, All(blocks::<B>()).run::<L>());
        }
    }

    #[test]
    fn all_kinds_give_the_same_bits() {
        same_bits::<FourF64, Array<4>>();
        same_bits::<EightF64, Array<8>>();
    }
}
