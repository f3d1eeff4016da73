//! A tree over boxes that stay: the triangles of a mesh.

mod refit;

use super::f32_box::Box32;
use super::packed::PackedTree;
use super::probe::Probe;
use super::wide::{Part, WideTree};
use ferrode_math::Aabb;

/// Most items in a leaf. Four triangles are tested as fast as the three more boxes that would tell them apart.
pub(crate) const LEAF: usize = 4;
/// Planes that are tried as a split.
const BINS: usize = 16;

/// Fewer items fit the processor's first cache as they are, and a small mesh shall not take twice the memory.
const PACKED: usize = 64;

/// A tree over bounded boxes, numbered as they were given; built once, by the surface area heuristic (Wald, *On fast
/// construction of SAH-based bounding volume hierarchies*, 2007), four boxes to a node, and for rays seven. Boxes are rounded outwards to
/// single precision, or to bytes; with its list of items the tree takes 30 to 50 bytes a box.
#[derive(Clone, Debug, Default)]
pub struct AabbTree {
    /// Leaves are parts of the list of items: the first, and how many.
    nodes: WideTree,
    /// The same leaves, for rays and what moves; of small trees empty.
    packed: PackedTree,
    /// By leaves, and behind them what is no item: a leaf can be read as if it were full.
    items: Vec<u32>,
}

/// A part of the list of items while the tree is being built.
struct Stretch {
    bounds: Box32,
    start: usize,
    end: usize,
    /// The first of its two halves, which follow one another; zero for a leaf.
    halves: usize,
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
        let stretch = |items: &[(u32, Box32)], start: usize, end: usize| {
            let bounds = items[start..end].iter().fold(Box32::EMPTY, |all, i| all.union(&i.1));
            Stretch { bounds, start, end, halves: 0 }
        };
        let mut list = vec![stretch(&items, 0, items.len())];
        let mut k = 0;
        while k < list.len() {
            let Stretch { start, end, .. } = list[k];
            if end - start > LEAF {
                list[k].halves = list.len();
                let middle = start + split(&mut items[start..end]);
                list.extend([stretch(&items, start, middle), stretch(&items, middle, end)]);
            }
            k += 1;
        }
        let part = |k: usize| {
            let &Stretch { bounds, start, end, halves } = &list[k];
            Part { bounds, leaf: (halves == 0).then_some((start as u32, (end - start) as u32)), of: k }
        };
        let open = |k: usize| [0, 1].map(|h| part(list[k].halves + h));
        tree.nodes.build(part(0), open);
        if items.len() >= PACKED {
            tree.packed = PackedTree::build(part(0), open);
        }
        // Not in the memory of the larger ones, where it would be collected.
        tree.items = Vec::with_capacity(items.len() + LEAF - 1);
        tree.items.extend(items.iter().map(|i| i.0).chain([0; LEAF - 1]));
        tree.nodes.shrink_to_fit();
        tree
    }

    /// Bytes that the tree takes.
    pub fn size(&self) -> usize {
        self.nodes.size() + self.packed.size() + self.items.capacity() * size_of::<u32>()
    }

    /// How many items there are.
    fn len(&self) -> usize {
        self.items.len().saturating_sub(LEAF - 1)
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

    /// As [`query`](Self::query), leaf by leaf: of four numbers the first few count, and how many these are.
    #[inline]
    pub(crate) fn query_leaves(&self, aabb: &Aabb, mut found: impl FnMut(&[u32; LEAF], usize)) {
        self.nodes.query(&Box32::around(aabb), |first, count| {
            if let Some(items) = self.items.get(first as usize..).and_then(<[u32]>::first_chunk) {
                found(items, count as usize);
            }
        });
    }

    /// Calls `found` with the number of each box that the probe meets within the limit, and a few beside these, nearer
    /// ones first as far as their boxes tell. `found` may lower the limit.
    #[inline]
    pub fn seek(&self, probe: &Probe, limit: &mut f64, mut found: impl FnMut(u32, &mut f64)) {
        let mut found = |first, count, limit: &mut f64| {
            self.items(first, count).iter().for_each(|&item| found(item, limit));
        };
        let packed = (PACKED..PackedTree::MOST).contains(&self.len());
        match probe.bundle(self.packed.bounds()).filter(|_| packed) {
            Some(bundle) => self.packed.seek(&bundle, limit, found),
            None => self.nodes.seek(probe, limit, &mut found),
        }
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
