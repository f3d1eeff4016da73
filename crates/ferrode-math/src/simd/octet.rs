//! Eight `f32` at once, also from bytes: for searches through nodes whose boxes are stored in bytes.
//!
//! Where [`Lanes`](super::Lanes) have as many lanes as the machine likes, an octet has eight, whose comparisons are a number's bits. All
//! operations are those of the lanes one by one, so the bits are the same on every machine.

use core::ops::{Add, Mul, Sub};

/// A computation that is written once for registers of any width.
///
/// Mark `run`, and all that it calls with octets, `#[inline(always)]`: only what is inlined into the dispatcher is compiled for the
/// machine's instructions.
pub trait OctetKernel {
    /// What it computes.
    type Out;
    /// Computes it with octets of type `O`.
    fn run<O: Octet>(self) -> Self::Out;
}

/// Eight `f32`.
///
/// The types that implement it can't be named outside: a kernel gets one from [`dispatch_octets`], which knows that the machine has
/// the instructions.
pub trait Octet: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The same number eight times.
    fn splat(x: f32) -> Self;
    /// The bytes as numbers from 0 to 255.
    fn from_bytes(bytes: &[u8; 8]) -> Self;
    /// Times 2 to the power of `word`'s highest byte, read with a sign. The power is added to the exponent: this is the product where
    /// number and product are normal, as the caller has to see to.
    #[must_use]
    fn scale(self, word: u32) -> Self;
    /// The numbers as an array.
    fn store(self) -> [f32; 8];
    /// `self` where that is smaller than `b`, else `b`.
    #[must_use]
    fn min(self, b: Self) -> Self;
    /// `self` where that is larger than `b`, else `b`.
    #[must_use]
    fn max(self, b: Self) -> Self;
    /// Bit `l` tells whether lane `l` is at most that of `b`; zero where one is NaN.
    fn le(self, b: Self) -> u8;
}

/// Runs a kernel with the widest registers that the machine has: AVX2 or SSE2 on x86-64, else what the target has.
#[inline]
pub fn dispatch_octets<K: OctetKernel>(kernel: K) -> K::Out {
    #[cfg(target_arch = "x86_64")]
    {
        // All machines with AVX2 have the others too.
        if std::arch::is_x86_feature_detected!("avx2")
            && std::arch::is_x86_feature_detected!("bmi1")
            && std::arch::is_x86_feature_detected!("bmi2")
            && std::arch::is_x86_feature_detected!("popcnt")
        {
            // SAFETY: the machine has the instructions.
            return unsafe { super::octet_x86::run_avx2(kernel) };
        }
        kernel.run::<super::octet_x86::Two>()
    }
    #[cfg(not(target_arch = "x86_64"))]
    kernel.run::<Array>()
}

/// Octets as arrays: the fallback, and what the other kinds are tested against.
#[cfg(any(test, not(target_arch = "x86_64")))]
#[derive(Clone, Copy, Debug)]
pub(super) struct Array([f32; 8]);

#[cfg(any(test, not(target_arch = "x86_64")))]
mod array {
    use super::{Add, Array, Mul, Octet, Sub};

    #[inline(always)]
    fn each(a: Array, b: Array, f: impl Fn(f32, f32) -> f32) -> Array {
        Array(core::array::from_fn(|l| f(a.0[l], b.0[l])))
    }

    impl Add for Array {
        type Output = Self;
        #[inline(always)]
        fn add(self, b: Self) -> Self {
            each(self, b, |x, y| x + y)
        }
    }

    impl Sub for Array {
        type Output = Self;
        #[inline(always)]
        fn sub(self, b: Self) -> Self {
            each(self, b, |x, y| x - y)
        }
    }

    impl Mul for Array {
        type Output = Self;
        #[inline(always)]
        fn mul(self, b: Self) -> Self {
            each(self, b, |x, y| x * y)
        }
    }

    impl Octet for Array {
        #[inline(always)]
        fn splat(x: f32) -> Self {
            Self([x; 8])
        }

        #[inline(always)]
        fn from_bytes(bytes: &[u8; 8]) -> Self {
            Self(bytes.map(f32::from))
        }

        #[inline(always)]
        fn scale(self, word: u32) -> Self {
            let exponent = (word & 0xff00_0000).cast_signed() >> 1;
            Self(self.0.map(|x| f32::from_bits(x.to_bits().wrapping_add_signed(exponent))))
        }

        #[inline(always)]
        fn store(self) -> [f32; 8] {
            self.0
        }

        #[inline(always)]
        fn min(self, b: Self) -> Self {
            each(self, b, |x, y| if x < y { x } else { y })
        }

        #[inline(always)]
        fn max(self, b: Self) -> Self {
            each(self, b, |x, y| if x > y { x } else { y })
        }

        #[inline(always)]
        fn le(self, b: Self) -> u8 {
            (0..8).fold(0, |bits, l| bits | u8::from(self.0[l] <= b.0[l]) << l)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All operations, on numbers of which some are NaN, infinite or zero with a sign.
    struct All;

    impl OctetKernel for All {
        type Out = (Vec<u32>, [u8; 3]);

        #[inline(always)]
        fn run<O: Octet>(self) -> Self::Out {
            let bytes = O::from_bytes(&[0, 1, 2, 127, 128, 200, 254, 255]);
            let nan = O::splat(f32::NAN);
            // From −∞ to ∞ with a NaN in the first lane, for 0 ∞ is one.
            let wide = bytes * O::splat(f32::INFINITY) + O::splat(0.3);
            let mixed = (bytes + O::splat(-128.0)) * O::splat(0.1);
            let zeros = (O::splat(0.0).min(O::splat(-0.0)), O::splat(0.0).max(O::splat(-0.0)));
            let all = [
                wide.min(mixed),
                mixed.min(wide),
                wide.max(mixed),
                mixed.max(wide),
                mixed.max(bytes * O::splat(0.02)),
                mixed - bytes,
                (bytes + O::splat(0.3)).scale(0xf712_3456),
                (bytes + O::splat(0.3)).scale(0x0998_7654),
                mixed.min(nan),
                nan.max(mixed),
                zeros.0,
                zeros.1,
            ];
            // All NaN are alike.
            let bits = |x: f32| if x.is_nan() { u32::MAX } else { x.to_bits() };
            (
                all.iter().flat_map(|o| o.store()).map(bits).collect(),
                [mixed.le(O::splat(0.0)), wide.le(wide), nan.le(mixed)],
            )
        }
    }

    #[test]
    fn all_kinds_give_the_same_bits() {
        let plain = All.run::<Array>();
        assert_eq!(plain.1, [0b0001_1111, 0b1111_1110, 0]);
        assert_eq!(dispatch_octets(All), plain);
        let scaled = |byte: i8| {
            Array::splat(0.3).scale(u32::from_le_bytes([1, 2, 3, byte.cast_unsigned()])).store()[0]
        };
        assert_eq!([scaled(-60), scaled(0), scaled(7)], [0.3 / (1u64 << 60) as f32, 0.3, 0.3 * 128.0]);
        #[cfg(target_arch = "x86_64")]
        assert_eq!(All.run::<super::super::octet_x86::Two>(), plain);
    }
}
