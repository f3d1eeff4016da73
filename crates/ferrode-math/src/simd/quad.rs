//! Four `f64` at once, for loops over short vectors: what six numbers of a body and of a row are made of.
//!
//! Where [`Compute`](super::Compute) leaves it to the compiler which numbers share a register, a [`QuadKernel`] says so. All
//! operations are those of the lanes one by one, and the order of each sum is written out, so the bits are the same on every machine.

use core::ops::{Add, Div, Mul, Sub};

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
pub trait Quad:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
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
    /// The first numbers of each of four, the second ones, and so on.
    #[must_use]
    fn transpose(of: [Self; 4]) -> [Self; 4];
    /// The square roots.
    #[must_use]
    fn sqrt(self) -> Self;
    /// `self` where that is larger than `b`, else `b`.
    #[must_use]
    fn max(self, b: Self) -> Self;
    /// `a` where `self` is larger than zero, else `b`.
    #[must_use]
    fn where_positive(self, a: Self, b: Self) -> Self;
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
#[derive(Clone, Copy, Debug)]
pub(super) struct Array<const N: usize>([f64; N]);

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

impl<const N: usize> Div for Array<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        Self(core::array::from_fn(|l| self.0[l] / b.0[l]))
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
    fn transpose([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        core::array::from_fn(|l| Self([a.0[l], b.0[l], c.0[l], d.0[l]]))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    #[inline(always)]
    fn max(self, b: Self) -> Self {
        Self(core::array::from_fn(|l| if self.0[l] > b.0[l] { self.0[l] } else { b.0[l] }))
    }

    #[inline(always)]
    fn where_positive(self, a: Self, b: Self) -> Self {
        Self(core::array::from_fn(|l| if self.0[l] > 0.0 { a.0[l] } else { b.0[l] }))
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
            let (mut roots, mut larger, mut chosen) = ([0.0; 4], [0.0; 4], [0.0; 4]);
            ((q * q / Q::splat(0.3)).sqrt()).store(&mut roots);
            q.max(Q::splat(f64::NAN)).max(Q::splat(1e-3)).store(&mut larger);
            (q - Q::splat(0.1)).where_positive(q, Q::splat(f64::NAN)).store(&mut chosen);
            let mut turned = [[0.0; 4]; 4];
            for (of, to) in Q::transpose([q, q * q, q + q, q - q * q]).into_iter().zip(&mut turned) {
                of.store(to);
            }
            let sum = (q.fold() + p).sum();
            let all = four.iter().chain(&two).chain(&sums).chain(&joined);
            let all =
                all.chain(turned.as_flattened()).chain(&roots).chain(&larger).chain(&chosen).chain([&sum]);
            all.map(|x| x.to_bits()).collect()
        }
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
