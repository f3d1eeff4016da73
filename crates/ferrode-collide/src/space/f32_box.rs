//! Boxes rounded outwards to single precision: half the memory, and never smaller than what they stand for.

use ferrode_math::{Aabb, Vec3};

/// The largest `f32` not above `x`.
#[inline]
pub(crate) fn down(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) > x { y.next_down() } else { y }
}

/// The smallest `f32` not below `x`.
#[inline]
pub(crate) fn up(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) < x { y.next_up() } else { y }
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
