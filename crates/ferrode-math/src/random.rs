//! ODE's random generator, bit for bit.
//!
//! `Quick` shuffles its rows with it, so its stream decides the results of a step. A world owns one; the C library
//! shares one among all worlds.

use crate::Vec3;

/// A linear congruential generator of 32 bits: s ← 1664525 s + 1013904223 (Numerical Recipes, "quick and dirty").
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OdeRandom {
    seed: u32,
}

impl OdeRandom {
    /// A generator in the given state; ODE begins at 0.
    pub const fn new(seed: u32) -> Self {
        Self { seed }
    }

    /// The present state.
    pub const fn seed(&self) -> u32 {
        self.seed
    }

    /// Sets the state.
    pub fn set_seed(&mut self, seed: u32) {
        self.seed = seed;
    }

    /// The next number of 32 bits (`dRand`).
    #[inline]
    pub fn next_u32(&mut self) -> u32 {
        self.seed = self.seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        self.seed
    }

    /// A number in 0 … n−1 (`dRandInt`): the bits are folded down and scaled by multiplication. `n = 0` gives 0.
    #[inline]
    pub fn next_below(&mut self, n: u32) -> u32 {
        let fold = |r: u32, k: u32| r ^ (r >> k);
        let r = self.next_u32();
        if n > 65536 {
            return ((u64::from(r) * u64::from(n)) >> 32) as u32;
        }
        let r = fold(r, 16);
        if n > 256 {
            return ((r & 0xffff) * n) >> 16;
        }
        let r = fold(r, 8);
        if n > 16 {
            return ((r & 0xff) * n) >> 8;
        }
        let r = fold(r, 4);
        if n > 4 {
            return ((r & 0xf) * n) >> 4;
        }
        let r = fold(r, 2);
        if n > 2 {
            return ((r & 3) * n) >> 2;
        }
        fold(r, 1) & (n >> 1)
    }

    /// A number in 0 … 1, both inclusive (`dRandReal`).
    pub fn next_real(&mut self) -> f64 {
        f64::from(self.next_u32()) / 4_294_967_295.0
    }

    /// A vector with components in −range … range (`dMakeRandomVector` for n = 3).
    pub fn next_vector(&mut self, range: f64) -> Vec3 {
        let x = self.next_signed(range);
        let y = self.next_signed(range);
        let z = self.next_signed(range);
        Vec3::new(x, y, z)
    }

    /// A number in −range … range.
    pub fn next_signed(&mut self, range: f64) -> f64 {
        (self.next_real() * 2.0 - 1.0) * range
    }

    /// Fills a slice with numbers in −range … range (`dMakeRandomVector`).
    pub fn fill(&mut self, out: &mut [f64], range: f64) {
        for x in out {
            *x = self.next_signed(range);
        }
    }

    /// The state after `n` more draws, without making them: islands can reserve their part of the stream and run in
    /// parallel. O(log n), by squaring the affine map.
    pub fn skip(&mut self, mut n: u64) {
        let (mut a, mut c) = (1_664_525_u32, 1_013_904_223_u32);
        while n > 0 {
            if n & 1 == 1 {
                self.seed = self.seed.wrapping_mul(a).wrapping_add(c);
            }
            c = c.wrapping_mul(a.wrapping_add(1));
            a = a.wrapping_mul(a);
            n >>= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::OdeRandom;

    #[test]
    fn stream_is_odes() {
        let mut r = OdeRandom::default();
        assert_eq!([r.next_u32(), r.next_u32(), r.next_u32()], [1_013_904_223, 1_196_435_762, 3_519_870_697]);
        assert_eq!(OdeRandom::default().next_real(), 0.236_067_972_899_430_43);
    }

    #[test]
    fn bounded_draws_are_odes() {
        // dynamics.md 12.4: the first six results from seed 12345.
        let table: [(u32, [u32; 6]); 13] = [
            (1, [0, 0, 0, 0, 0, 0]),
            (2, [1, 1, 1, 0, 1, 0]),
            (3, [1, 1, 0, 0, 1, 0]),
            (4, [2, 2, 1, 0, 2, 0]),
            (5, [0, 2, 4, 0, 2, 3]),
            (16, [2, 8, 14, 0, 7, 10]),
            (17, [6, 9, 14, 4, 1, 2]),
            (100, [39, 56, 82, 26, 8, 15]),
            (256, [100, 145, 211, 68, 22, 40]),
            (257, [25, 127, 201, 177, 89, 85]),
            (65536, [6525, 32495, 51482, 45300, 22863, 21885]),
            (65537, [1337, 1084, 35596, 41609, 59640, 7370]),
            (1_000_000, [20402, 16547, 543_155, 634_904, 910_029, 112_461]),
        ];
        for (n, want) in table {
            let mut r = OdeRandom::new(12345);
            let got: Vec<u32> = (0..6).map(|_| r.next_below(n)).collect();
            assert_eq!(got, want, "n = {n}");
        }
    }

    #[test]
    fn skipping_equals_drawing() {
        for n in [0, 1, 2, 7, 100, 12345] {
            let (mut a, mut b) = (OdeRandom::new(99), OdeRandom::new(99));
            for _ in 0..n {
                a.next_u32();
            }
            b.skip(n);
            assert_eq!(a, b);
        }
    }
}
