//! Four `f64` at once, for loops over short vectors: what six numbers of a body and of a row are made of.
//!
//! Where [`Compute`](super::Compute) leaves it to the compiler which numbers share a register, a [`QuadKernel`] says so. All
//! operations are those of the lanes one by one, and the order of each sum is written out, so the bits are the same on every machine.

use super::{Mask, Ordered};
use crate::Scalar;
use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

/// A computation that is written once for registers of any width.
///
/// Mark `run`, and all that it calls with quads, `#[inline(always)]`: only what is inlined into the dispatcher is compiled for the
/// machine's instructions.
pub trait QuadKernel {
    /// What it computes.
    type Out;
    /// Computes it with quads of type `Q`.
    fn run<Q: Quad>(self) -> Self::Out;
}

/// Four `f64`.
///
/// The types that implement it can't be named outside: a kernel gets one from [`dispatch_quads`], which knows that the machine has
/// the instructions.
pub trait Quad: Ordered {
    /// Two `f64` of the same kind.
    type Pair: Pair;

    /// The numbers of an array.
    fn load(from: &[f64; 4]) -> Self;
    /// Writes them to an array.
    fn store(self, to: &mut [f64; 4]);
    /// The same number four times.
    fn splat(x: f64) -> Self;
    /// `[self₀ + self₂, self₁ + self₃]`.
    fn fold(self) -> Self::Pair;
    /// `[self₀, self₁]`.
    fn low(self) -> Self::Pair;
    /// `[self₂, self₃]`.
    fn high(self) -> Self::Pair;
    /// Two pairs as four numbers.
    fn join(low: Self::Pair, high: Self::Pair) -> Self;
    /// `(x₀ + x₁) + (x₂ + x₃)` of each of four.
    fn sums(of: [Self; 4]) -> Self;
    /// The columns of four rows: the first numbers of all four, the second ones, and so on.
    fn columns(rows: [Self; 4]) -> [Self; 4];
}

/// Two `f64`.
pub trait Pair: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The numbers of an array.
    fn load(from: &[f64; 2]) -> Self;
    /// Writes them to an array.
    fn store(self, to: &mut [f64; 2]);
    /// The same number twice.
    fn splat(x: f64) -> Self;
    /// `[self₀ + x, self₁]`.
    fn add_first(self, x: f64) -> Self;
    /// `self₀ + self₁`.
    fn sum(self) -> f64;
    /// `x₀ + x₁` of each of two.
    fn sums(of: [Self; 2]) -> Self;
}

/// Runs a kernel with the widest registers that the machine has: AVX2 on x86-64 if it is there, else what the target has.
#[inline]
pub fn dispatch_quads<K: QuadKernel>(kernel: K) -> K::Out {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has the instructions.
        return unsafe { super::x86::run_quads(kernel) };
    }
    kernel.run::<Array<4>>()
}

/// Quads and pairs as arrays: the fallback, and what the other kind is tested against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Array<const N: usize>(pub [f64; N]);

impl<const N: usize> Add for Array<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self(core::array::from_fn(|l| self.0[l] + b.0[l]))
    }
}

impl<const N: usize> Sub for Array<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self(core::array::from_fn(|l| self.0[l] - b.0[l]))
    }
}

impl<const N: usize> Mul for Array<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self(core::array::from_fn(|l| self.0[l] * b.0[l]))
    }
}

impl<const N: usize> AddAssign for Array<N> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<const N: usize> SubAssign for Array<N> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl<const N: usize> MulAssign for Array<N> {
    #[inline(always)]
    fn mul_assign(&mut self, b: Self) {
        *self = *self * b;
    }
}

impl<const N: usize> Div for Array<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        Self(core::array::from_fn(|l| self.0[l] / b.0[l]))
    }
}

impl<const N: usize> Neg for Array<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl<const N: usize> Default for Array<N> {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

impl<const N: usize> Scalar for Array<N> {
    const ZERO: Self = Self([0.0; N]);
    const ONE: Self = Self([1.0; N]);

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self([x; N])
    }
}

/// A truth value per number of an array.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArrayMask<const N: usize>([bool; N]);

impl<const N: usize> BitAnd for ArrayMask<N> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        Self(core::array::from_fn(|l| self.0[l] & b.0[l]))
    }
}

impl<const N: usize> BitOr for ArrayMask<N> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        Self(core::array::from_fn(|l| self.0[l] | b.0[l]))
    }
}

impl<const N: usize> Not for ArrayMask<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|x| !x))
    }
}

impl<const N: usize> Mask for ArrayMask<N> {
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().fold(false, |any, x| any | x)
    }
}

impl<const N: usize> Ordered for Array<N> {
    type Mask = ArrayMask<N>;

    #[inline(always)]
    fn lt(self, b: Self) -> ArrayMask<N> {
        ArrayMask(core::array::from_fn(|l| self.0[l] < b.0[l]))
    }

    #[inline(always)]
    fn le(self, b: Self) -> ArrayMask<N> {
        ArrayMask(core::array::from_fn(|l| self.0[l] <= b.0[l]))
    }

    #[inline(always)]
    fn select(mask: ArrayMask<N>, a: Self, b: Self) -> Self {
        Self(core::array::from_fn(|l| if mask.0[l] { a.0[l] } else { b.0[l] }))
    }

    #[inline(always)]
    fn bits(mask: ArrayMask<N>) -> u8 {
        mask.0.iter().rev().fold(0, |bits, x| bits << 1 | u8::from(*x))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        Self(core::array::from_fn(|l| self.0[l].copysign(sign.0[l])))
    }
}

impl Quad for Array<4> {
    type Pair = Array<2>;

    #[inline(always)]
    fn load(from: &[f64; 4]) -> Self {
        Self(*from)
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; 4]) {
        *to = self.0;
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 4])
    }

    #[inline(always)]
    fn fold(self) -> Array<2> {
        Array([self.0[0] + self.0[2], self.0[1] + self.0[3]])
    }

    #[inline(always)]
    fn low(self) -> Array<2> {
        Array([self.0[0], self.0[1]])
    }

    #[inline(always)]
    fn high(self) -> Array<2> {
        Array([self.0[2], self.0[3]])
    }

    #[inline(always)]
    fn join(low: Array<2>, high: Array<2>) -> Self {
        Self([low.0[0], low.0[1], high.0[0], high.0[1]])
    }

    #[inline(always)]
    fn sums(of: [Self; 4]) -> Self {
        Self(of.map(|Self([a, b, c, d])| (a + b) + (c + d)))
    }

    #[inline(always)]
    fn columns(rows: [Self; 4]) -> [Self; 4] {
        core::array::from_fn(|k| Self(rows.map(|row| row.0[k])))
    }
}

impl Pair for Array<2> {
    #[inline(always)]
    fn load(from: &[f64; 2]) -> Self {
        Self(*from)
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; 2]) {
        *to = self.0;
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 2])
    }

    #[inline(always)]
    fn add_first(self, x: f64) -> Self {
        Self([self.0[0] + x, self.0[1]])
    }

    #[inline(always)]
    fn sum(self) -> f64 {
        self.0[0] + self.0[1]
    }

    #[inline(always)]
    fn sums(of: [Self; 2]) -> Self {
        Self(of.map(|Self([a, b])| a + b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All operations, on numbers that none of them computes exactly.
    struct All([f64; 4], [f64; 2]);

    impl QuadKernel for All {
        type Out = Vec<u64>;

        #[inline(always)]
        fn run<Q: Quad>(self) -> Vec<u64> {
            let (q, p) = (Q::load(&self.0), Q::Pair::load(&self.1));
            let (mut four, mut two) = ([0.0; 4], [0.0; 2]);
            (q * Q::splat(0.3) + q * q).store(&mut four);
            (p * Q::Pair::splat(0.7) + p * q.fold()).add_first(0.1).store(&mut two);
            let (mut sums, mut joined) = ([0.0; 4], [0.0; 4]);
            Q::sums([q, q * q, q - Q::splat(0.1), Q::splat(0.3) * q]).store(&mut sums);
            Q::join(Q::Pair::sums([q.high(), q.low()]), p - q.low()).store(&mut joined);
            let sum = (q.fold() + p).sum();
            let all = four.iter().chain(&two).chain(&sums).chain(&joined).chain([&sum]);
            all.map(|x| x.to_bits()).collect()
        }
    }

    /// What [`Ordered`] adds, on numbers of which some are NaN, infinite or zero with a sign.
    struct Compared([[f64; 4]; 4]);

    impl QuadKernel for Compared {
        type Out = (Vec<u64>, Vec<u8>);

        #[inline(always)]
        fn run<Q: Quad>(self) -> Self::Out {
            let (mut numbers, mut masks) = (Vec::new(), Vec::new());
            let rows = [0, 1, 2, 3].map(|k| Q::load(&self.0[k]));
            let columns = Q::columns(rows);
            for a in rows.into_iter().chain(columns) {
                for b in rows {
                    let (lt, le) = (a.lt(b), a.le(b));
                    let all =
                        [a.lesser(b), a.greater(b), a.copysign(b), Q::select(lt, a, b), a / b, -a, a.abs()];
                    for q in all.into_iter().chain([Q::ONE, Q::ZERO, Q::from_f64(0.3), a.abs().sqrt()]) {
                        let mut four = [0.0; 4];
                        q.store(&mut four);
                        // All NaN are alike.
                        numbers.extend(four.map(|x| if x.is_nan() { u64::MAX } else { x.to_bits() }));
                    }
                    masks.extend([Q::bits(lt), Q::bits(le), Q::bits(!lt & le), Q::bits(lt | !le)]);
                    masks.extend([u8::from(lt.any()), u8::from(a == b)]);
                }
            }
            (numbers, masks)
        }
    }

    #[test]
    fn comparisons_of_both_kinds_agree() {
        let odd = [f64::NAN, 0.0, -0.0, f64::INFINITY];
        let all = || {
            Compared([[0.1, -2.7, 1e17, -0.0], odd, [1.0, -0.0, 0.0, f64::NAN], [0.1, 2.0, -1e300, 5e-324]])
        };
        let plain = all().run::<Array<4>>();
        assert_eq!(dispatch_quads(all()), plain);
        // 0.1 < 1, −2.7 < −0, not 1e17 < 0, nothing < NaN.
        assert_eq!(plain.1[12..14], [0b0011, 0b0011]);
    }

    #[test]
    fn both_kinds_give_the_same_bits() {
        let all = || All([0.1, -2.7, 1e17, 3.3e-5], [-0.0, 1.0 / 3.0]);
        let plain = all().run::<Array<4>>();
        assert_eq!(dispatch_quads(all()), plain);
        let fold = [0.1 + 1e17, -2.7 + 3.3e-5];
        let sum = (fold[0] + -0.0) + (fold[1] + 1.0 / 3.0);
        assert_eq!(plain.last(), Some(&f64::to_bits(sum)));
    }
}
