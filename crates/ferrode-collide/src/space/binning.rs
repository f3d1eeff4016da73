//! Splits for trees that are built while the world waits: along one axis, with few planes where few boxes are left.

use super::f32_box::Box32;

/// Most planes that are tried as a split.
const BINS: usize = 16;

/// A box to build a tree over, in lanes of which the last is of no account.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    low: [f32; 4],
    high: [f32; 4],
    pub payload: u32,
}

const NOTHING: ([f32; 4], [f32; 4]) = ([f32::INFINITY; 4], [f32::NEG_INFINITY; 4]);

impl Item {
    pub fn new(payload: u32, b: &Box32) -> Self {
        let lanes = |a: [f32; 3]| [a[0], a[1], a[2], 0.0];
        Self { low: lanes(b.min), high: lanes(b.max), payload }
    }

    pub fn bounds(&self) -> Box32 {
        let ([a, b, c, _], [d, e, f, _]) = (self.low, self.high);
        Box32 { min: [a, b, c], max: [d, e, f] }
    }

    /// Twice the centre along an axis.
    #[inline(always)]
    fn center2(&self, axis: usize) -> f32 {
        self.low[axis & 3] + self.high[axis & 3]
    }
}

/// Makes a box hold another.
#[inline(always)]
fn grow(b: &mut ([f32; 4], [f32; 4]), low: &[f32; 4], high: &[f32; 4]) {
    for k in 0..4 {
        b.0[k] = if low[k] < b.0[k] { low[k] } else { b.0[k] };
        b.1[k] = if high[k] > b.1[k] { high[k] } else { b.1[k] };
    }
}

/// Half the surface area; not a number for a box that holds nothing.
#[inline(always)]
fn area(b: &([f32; 4], [f32; 4])) -> f32 {
    let e = [b.1[0] - b.0[0], b.1[1] - b.0[1], b.1[2] - b.0[2]];
    e[0] * e[1] + e[1] * e[2] + e[2] * e[0]
}

/// Puts the items of the lower part first and returns how many they are: neither none nor all of the two or more.
pub(super) fn split(items: &mut [Item]) -> usize {
    let count = items.len();
    if count == 2 {
        return 1;
    }
    let mut centers = NOTHING;
    for i in items.iter() {
        let c = core::array::from_fn(|k| i.low[k] + i.high[k]);
        grow(&mut centers, &c, &c);
    }
    let extent = [0, 1, 2].map(|k| centers.1[k] - centers.0[k]);
    let axis = if extent[0] >= extent[1] && extent[0] >= extent[2] {
        0
    } else {
        1 + usize::from(extent[2] > extent[1])
    };
    let bins = if count > 64 { BINS } else { 4 << usize::from(count > 8) };
    let (start, scale) = (centers.0[axis], bins as f32 / extent[axis]);
    if !(scale.is_finite() && scale > 0.0) {
        return count / 2;
    }
    let bin = |i: &Item| (((i.center2(axis) - start) * scale) as usize).min(bins - 1);
    let mut boxes = [NOTHING; BINS];
    let mut counts = [0u32; BINS];
    for i in items.iter() {
        let k = bin(i);
        grow(&mut boxes[k], &i.low, &i.high);
        counts[k] += 1;
    }
    // What lies above each plane costs.
    let mut above = [0.0f32; BINS];
    let (mut all, mut number) = (NOTHING, 0);
    for k in (1..bins).rev() {
        grow(&mut all, &boxes[k].0, &boxes[k].1);
        number += counts[k];
        above[k - 1] = area(&all) * number as f32;
    }
    let (mut best, mut plane) = (f32::INFINITY, bins);
    (all, number) = (NOTHING, 0);
    for k in 0..bins - 1 {
        grow(&mut all, &boxes[k].0, &boxes[k].1);
        number += counts[k];
        // Not a number if all lie on one side.
        let cost = area(&all) * number as f32 + above[k];
        if cost < best {
            (best, plane) = (cost, k);
        }
    }
    if plane == bins {
        return count / 2;
    }
    let mut split = 0;
    for k in 0..count {
        // Without a branch on what cannot be foretold: what is not below the plane changes places with its like.
        let below = bin(&items[k]) <= plane;
        items.swap(split, k);
        split += usize::from(below);
    }
    if split == 0 || split == count { count / 2 } else { split }
}
