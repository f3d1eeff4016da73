//! A binary tree over boxes that stay: the triangles of a mesh.

use super::f32_box::{Box32, Pending};
use super::probe::Probe;
use ferrode_math::Aabb;

/// Most items in a leaf. Four triangles are tested as fast as the three more boxes that would tell them apart.
const LEAF: usize = 4;
/// Planes that are tried as a split.
const BINS: usize = 16;

/// 32 bytes. Siblings lie side by side.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct Node {
    min: [f32; 3],
    /// The first of two children, or of the items of a leaf.
    first: u32,
    max: [f32; 3],
    /// Items of a leaf; zero for an inner node.
    count: u32,
}

impl Node {
    #[inline(always)]
    fn bounds(&self) -> Box32 {
        Box32 { min: self.min, max: self.max }
    }
}

/// A tree over bounded boxes, numbered as they were given; built once, by the surface area heuristic (Wald, *On fast
/// construction of SAH-based bounding volume hierarchies*, 2007). Boxes are rounded outwards to single precision; with
/// its list of items the tree takes 20 to 40 bytes a box.
#[derive(Clone, Debug, Default)]
pub struct AabbTree {
    nodes: Vec<Node>,
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
        let empty = Node { min: [0.0; 3], first: 0, max: [0.0; 3], count: 0 };
        tree.nodes.push(empty);
        // Node and its part of the items.
        let mut waiting = vec![(0usize, 0usize, items.len())];
        while let Some((node, start, end)) = waiting.pop() {
            let part = &mut items[start..end];
            let bounds = part.iter().fold(Box32::EMPTY, |b, i| b.union(&i.1));
            let (first, count) = if part.len() <= LEAF {
                (start, part.len())
            } else {
                let middle = start + split(part);
                let child = tree.nodes.len();
                tree.nodes.extend([empty; 2]);
                waiting.extend([(child, start, middle), (child + 1, middle, end)]);
                (child, 0)
            };
            tree.nodes[node] =
                Node { min: bounds.min, first: first as u32, max: bounds.max, count: count as u32 };
        }
        tree.items = items.into_iter().map(|i| i.0).collect();
        tree.nodes.shrink_to_fit();
        tree
    }

    /// Bytes that the tree takes.
    pub fn size(&self) -> usize {
        self.nodes.capacity() * size_of::<Node>() + self.items.capacity() * size_of::<u32>()
    }

    fn items(&self, node: &Node) -> &[u32] {
        &self.items[node.first as usize..(node.first + node.count) as usize]
    }

    /// Calls `found` with the number of each box that overlaps `aabb`, and a few that lie beside these.
    #[inline]
    pub fn query(&self, aabb: &Aabb, mut found: impl FnMut(u32)) {
        let around = Box32::around(aabb);
        let mut pending: Pending<u32> = Pending::new();
        let Some(root) = self.nodes.first() else { return };
        if root.bounds().overlaps(&around) {
            pending.push(0);
        }
        while let Some(i) = pending.pop() {
            let node = &self.nodes[i as usize];
            if node.count > 0 {
                self.items(node).iter().for_each(|&item| found(item));
            } else if let [a, b] = &self.nodes[node.first as usize..node.first as usize + 2] {
                if b.bounds().overlaps(&around) {
                    pending.push(node.first + 1);
                }
                if a.bounds().overlaps(&around) {
                    pending.push(node.first);
                }
            }
        }
    }

    /// Calls `found` with the number of each box that the probe meets within the limit, and a few beside these, nearer
    /// ones first as far as their boxes tell. `found` may lower the limit.
    #[inline]
    pub fn seek(&self, probe: &Probe, limit: &mut f64, mut found: impl FnMut(u32, &mut f64)) {
        let mut pending: Pending<(u32, f32)> = Pending::new();
        let Some(root) = self.nodes.first() else { return };
        if probe.enter(&root.bounds(), *limit).is_none() {
            return;
        }
        let mut i = 0;
        loop {
            let node = &self.nodes[i as usize];
            let mut next = None;
            if node.count > 0 {
                self.items(node).iter().for_each(|&item| found(item, limit));
            } else {
                let c = node.first;
                if let [left, right] = &self.nodes[c as usize..c as usize + 2] {
                    let (a, b) = (probe.enter(&left.bounds(), *limit), probe.enter(&right.bounds(), *limit));
                    next = super::probe::nearer(c, a, b, &mut pending);
                }
            }
            while next.is_none() {
                let Some((waiting, at)) = pending.pop() else { return };
                if f64::from(at) <= *limit {
                    next = Some(waiting);
                }
            }
            i = next.unwrap_or(0);
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
