//! A tree over boxes that stay: the triangles of a mesh.

mod refit;

use super::f32_box::Box32;
use super::probe::Probe;
use super::wide::{Part, WideTree};
use ferrode_math::Aabb;

/// Most items in a leaf. Four triangles are tested as fast as the three more boxes that would tell them apart.
const LEAF: usize = 4;
/// Planes that are tried as a split.
const BINS: usize = 16;

/// A tree over bounded boxes, numbered as they were given; built once, by the surface area heuristic (Wald, *On fast
/// construction of SAH-based bounding volume hierarchies*, 2007), four boxes to a node. Boxes are rounded outwards to single
/// precision; with its list of items the tree takes 20 to 40 bytes a box.
#[derive(Clone, Debug, Default)]
pub struct AabbTree {
    /// Leaves are parts of the list of items: the first, and how many.
    nodes: WideTree,
    items: Vec<u32>,
}

impl AabbTree {
    /// A tree over `boxes`.
    pub fn build(boxes: &[Aabb]) -> Self {
        let mut tree = Self::default();
        let mut items: Vec<(u32, Box32)> =
            boxes.iter().enumerate().map(|(i, b)| (i as u32, Box32::around(b))).collect();
        if items.is_empty() {
            return tree;
        }
        let part = |items: &[(u32, Box32)], start: usize, end: usize| Part {
            bounds: items[start..end].iter().fold(Box32::EMPTY, |b, i| b.union(&i.1)),
            leaf: (end - start <= LEAF).then_some((start as u32, (end - start) as u32)),
            of: (start, end),
        };
        tree.nodes.build(part(&items, 0, items.len()), |(start, end)| {
            let middle = start + split(&mut items[start..end]);
            [part(&items, start, middle), part(&items, middle, end)]
        });
        // Not in the memory of the larger ones, where it would be collected.
        tree.items = items.iter().map(|i| i.0).collect();
        tree.nodes.shrink_to_fit();
        tree
    }

    /// Bytes that the tree takes.
    pub fn size(&self) -> usize {
        self.nodes.size() + self.items.capacity() * size_of::<u32>()
    }

    fn items(&self, first: u32, count: u32) -> &[u32] {
        &self.items[first as usize..(first + count) as usize]
    }

    /// Calls `found` with the number of each box that overlaps `aabb`, and a few that lie beside these.
    #[inline]
    pub fn query(&self, aabb: &Aabb, mut found: impl FnMut(u32)) {
        self.nodes.query(&Box32::around(aabb), |first, count| {
            self.items(first, count).iter().for_each(|&item| found(item));
        });
    }

    /// Calls `found` with the number of each box that the probe meets within the limit, and a few beside these, nearer
    /// ones first as far as their boxes tell. `found` may lower the limit.
    #[inline]
    pub fn seek(&self, probe: &Probe, limit: &mut f64, mut found: impl FnMut(u32, &mut f64)) {
        self.nodes.seek(probe, limit, |first, count, limit| {
            self.items(first, count).iter().for_each(|&item| found(item, limit));
        });
    }
}

/// Puts the items of the lower part first and returns how many they are: neither none nor all.
pub(super) fn split(items: &mut [(u32, Box32)]) -> usize {
    let mut centers = Box32::EMPTY;
    for (_, b) in items.iter() {
        let c = [b.center2(0), b.center2(1), b.center2(2)];
        centers = centers.union(&Box32 { min: c, max: c });
    }
    let mut best = (f32::INFINITY, 0, 0.0f32);
    for axis in 0..3 {
        let (lo, hi) = (centers.min[axis], centers.max[axis]);
        let scale = BINS as f32 / (hi - lo);
        if !(scale.is_finite() && scale > 0.0) {
            continue;
        }
        let mut bins = [(Box32::EMPTY, 0u32); BINS];
        for (_, b) in items.iter() {
            let bin = &mut bins[(((b.center2(axis) - lo) * scale) as usize).min(BINS - 1)];
            *bin = (bin.0.union(b), bin.1 + 1);
        }
        // What lies above each plane.
        let mut above = [(Box32::EMPTY, 0u32); BINS];
        for k in (0..BINS - 1).rev() {
            above[k] = (above[k + 1].0.union(&bins[k + 1].0), above[k + 1].1 + bins[k + 1].1);
        }
        let mut below = (Box32::EMPTY, 0u32);
        for k in 0..BINS - 1 {
            below = (below.0.union(&bins[k].0), below.1 + bins[k].1);
            if below.1 > 0 && above[k].1 > 0 {
                let cost = below.0.area() * below.1 as f32 + above[k].0.area() * above[k].1 as f32;
                if cost < best.0 {
                    best = (cost, axis, k as f32);
                }
            }
        }
    }
    let (cost, axis, bin) = best;
    let (lo, hi) = (centers.min[axis], centers.max[axis]);
    let scale = BINS as f32 / (hi - lo);
    let mut split = 0;
    if cost < f32::INFINITY {
        for k in 0..items.len() {
            if (((items[k].1.center2(axis) - lo) * scale) as usize).min(BINS - 1) <= bin as usize {
                items.swap(split, k);
                split += 1;
            }
        }
    }
    if split == 0 || split == items.len() { items.len() / 2 } else { split }
}
