//! Boxes rounded outwards to single precision: half the memory, and never smaller than what they stand for.

use ferrode_math::{Aabb, Vec3};

/// The largest `f32` not above `x`.
#[inline(always)]
pub(crate) fn down(x: f64) -> f32 {
    let y = x as f32;
    towards(y, f64::from(y) > x, u32::MAX)
}

/// The smallest `f32` not below `x`.
#[inline(always)]
pub(crate) fn up(x: f64) -> f32 {
    let y = x as f32;
    towards(y, f64::from(y) < x, 1)
}

/// `y`, or where `wanted` the next number up, for a `step` of 1, or down, for −1. Which of them is as likely as not, so nothing branches on it.
/// A zero is left only on its own side: it has been rounded towards zero.
#[inline(always)]
fn towards(y: f32, wanted: bool, step: u32) -> f32 {
    let bits = y.to_bits();
    // Numbers below zero have larger bits the lower they are.
    let negative = (bits.cast_signed() >> 31).cast_unsigned();
    let step = (step ^ negative).wrapping_sub(negative);
    f32::from_bits(bits.wrapping_add(step & u32::from(wanted).wrapping_neg()))
}

/// A box in single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box32 {
    pub min: [f32; 3],
    pub max: [f32; 3],
}

impl Box32 {
    /// Holds nothing, overlaps nothing.
    pub const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    #[inline]
    pub fn around(b: &Aabb) -> Self {
        Self {
            min: [down(b.min.x), down(b.min.y), down(b.min.z)],
            max: [up(b.max.x), up(b.max.y), up(b.max.z)],
        }
    }

    #[inline(always)]
    pub fn overlaps(&self, b: &Self) -> bool {
        // Without short cuts: six comparisons at once beat a chain of branches.
        (self.min[0] <= b.max[0])
            & (self.min[1] <= b.max[1])
            & (self.min[2] <= b.max[2])
            & (self.max[0] >= b.min[0])
            & (self.max[1] >= b.min[1])
            & (self.max[2] >= b.min[2])
    }

    #[inline(always)]
    pub fn union(&self, b: &Self) -> Self {
        let (mut min, mut max) = (self.min, self.max);
        for i in 0..3 {
            min[i] = if b.min[i] < min[i] { b.min[i] } else { min[i] };
            max[i] = if b.max[i] > max[i] { b.max[i] } else { max[i] };
        }
        Self { min, max }
    }

    /// Half the surface area.
    #[inline(always)]
    pub fn area(&self) -> f32 {
        let e = [self.max[0] - self.min[0], self.max[1] - self.min[1], self.max[2] - self.min[2]];
        e[0] * e[1] + e[1] * e[2] + e[2] * e[0]
    }

    /// The same box in double precision.
    #[inline]
    pub fn aabb(&self) -> Aabb {
        let wide = |a: [f32; 3]| Vec3::from_array(a.map(f64::from));
        Aabb::new(wide(self.min), wide(self.max))
    }

    /// Whether all of `b` lies within.
    #[inline]
    pub fn contains(&self, b: &Aabb) -> bool {
        self.aabb().contains(b)
    }

    /// Twice the centre along axis `i`.
    #[inline]
    pub fn center2(&self, i: usize) -> f32 {
        self.min[i] + self.max[i]
    }
}

/// Depth-first searches keep what they have yet to visit here: on the stack unless the tree is very deep.
#[derive(Debug)]
pub(crate) struct Pending<T, const FIRST: usize = 64> {
    first: [T; FIRST],
    len: usize,
    spilled: Vec<T>,
}

impl<T: Copy + Default, const FIRST: usize> Pending<T, FIRST> {
    #[inline]
    pub fn new() -> Self {
        Self { first: [T::default(); FIRST], len: 0, spilled: Vec::new() }
    }

    #[inline(always)]
    pub fn push(&mut self, node: T) {
        if self.len < FIRST {
            self.first[self.len] = node;
            self.len += 1;
        } else {
            self.spilled.push(node);
        }
    }

    /// As [`push`](Self::push) where `wanted`, else nothing; does not branch on it.
    #[inline(always)]
    pub fn push_if(&mut self, wanted: bool, node: T) {
        if self.len < FIRST {
            self.first[self.len] = node;
            self.len += usize::from(wanted);
        } else if wanted {
            self.spilled.push(node);
        }
    }

    /// Pushes those of four whose bits are set, the last first; does not branch on these.
    #[inline(always)]
    pub fn push_set(&mut self, bits: u8, four: &[T; 4]) {
        let [a, b, c, d] = *four;
        let bit = |l: u8| usize::from(bits >> l & 1);
        if let Some(room) = self.first.get_mut(self.len..).and_then(<[T]>::first_chunk_mut::<4>) {
            // What isn't wanted is written over.
            let (third, second) = (bit(3), bit(3) + bit(2));
            let first = second + bit(1);
            room[0] = d;
            room[third] = c;
            room[second] = b;
            room[first & 3] = a;
            self.len += first + bit(0);
        } else {
            self.push_if(bit(3) != 0, d);
            self.push_if(bit(2) != 0, c);
            self.push_if(bit(1) != 0, b);
            self.push_if(bit(0) != 0, a);
        }
    }

    #[inline(always)]
    pub fn pop(&mut self) -> Option<T> {
        if self.len == FIRST
            && let Some(node) = self.spilled.pop()
        {
            return Some(node);
        }
        self.len = self.len.checked_sub(1)?;
        Some(self.first[self.len])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_the_side_asked_for() {
        let tiny = f64::from(f32::from_bits(1));
        let halves = [0.5, 0.25, 1.5, 0.999_999_99, 1.0, 1.000_000_01, 16_777_217.0, 0.1, 1e-30, 1e30];
        let edges = [0.0, tiny, 0.4 * tiny, 0.6 * tiny, 1e-300, f64::MIN_POSITIVE];
        let ends = [f64::from(f32::MAX), f64::from(f32::MAX) * 1.000_000_01, 1e300, f64::INFINITY];
        for x in halves.into_iter().chain(edges).chain(ends).flat_map(|x| [x, -x]) {
            let (low, high) = (down(x), up(x));
            assert!(f64::from(low) <= x && x <= f64::from(high), "{x}: {low} {high}");
            assert!(f64::from(low.next_up()) > x || low == f32::INFINITY, "{x}: {low}");
            assert!(f64::from(high.next_down()) < x || high == f32::NEG_INFINITY, "{x}: {high}");
        }
        assert!(down(f64::NAN).is_nan() && up(f64::NAN).is_nan());
    }
}
