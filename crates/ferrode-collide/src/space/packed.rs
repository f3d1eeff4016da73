//! Trees of seven boxes to a node of one cache line: for rays, which wait for memory more than for anything else.

mod node;
mod seek;

use super::f32_box::Box32;
use super::leaf_box::LeafBox;
use super::probe::Bundle;
use super::wide::Part;
use ferrode_math::simd::dispatch_octets;
use node::{LANES, Seven};
use seek::Seek;

/// A tree of such nodes; the first is the root, and nodes come after those that hold them. It is for searches by rays.
#[derive(Clone, Debug)]
pub(super) struct PackedTree {
    /// With [`LeafBox`]es between them, if leaves are such: those of a node follow the nodes in it.
    nodes: Vec<Seven>,
    /// Of other trees by node and lane: the first number of the leaf; in place of an eighth the second ones, in `COUNT_BITS` each.
    leaves: Vec<[u32; 8]>,
    /// By payload: where its [`LeafBox`] is.
    places: Vec<u32>,
    all: Box32,
}

impl Default for PackedTree {
    fn default() -> Self {
        Self { nodes: Vec::new(), leaves: Vec::new(), places: Vec::new(), all: Box32::EMPTY }
    }
}

/// Enough for what a leaf counts.
const COUNT_BITS: usize = 4;

impl PackedTree {
    /// What it takes of leaves: numbers of nodes and lanes have to be told apart from each other.
    pub const MOST: usize = 1 << 27;

    /// `open` takes a part that is no leaf into its two halves. Leaves may count up to fifteen.
    ///
    /// The largest part is opened first, for it is met most often. That is within a hundredth of the best way to make wide nodes
    /// of a binary tree, by visits.
    pub fn build<T: Copy>(root: Part<T>, open: impl FnMut(T) -> [Part<T>; 2]) -> Self {
        let mut tree = Self { leaves: vec![[0; 8]], ..Self::default() };
        tree.build_nodes(root, open, None);
        tree
    }

    /// A tree whose leaves are single payloads, each with a box of its own (`leaf`), which rays are tested against before it is found.
    pub fn build_with_boxes<T: Copy>(
        root: Part<T>,
        open: impl FnMut(T) -> [Part<T>; 2],
        leaf: &dyn Fn(u32) -> LeafBox,
    ) -> Self {
        let mut tree = Self::default();
        tree.build_nodes(root, open, Some(leaf));
        tree
    }

    fn build_nodes<T: Copy>(
        &mut self,
        root: Part<T>,
        mut open: impl FnMut(T) -> [Part<T>; 2],
        leaf: Option<&dyn Fn(u32) -> LeafBox>,
    ) {
        self.all = root.bounds;
        self.nodes.push(Seven::VACANT);
        let mut waiting = vec![(0usize, root)];
        while let Some((node, part)) = waiting.pop() {
            let mut parts = [part; LANES];
            let mut count = 1;
            while count < LANES {
                let mut largest = None;
                for (k, p) in parts[..count].iter().enumerate() {
                    if p.leaf.is_none() && largest.is_none_or(|(_, area)| p.bounds.area() > area) {
                        largest = Some((k, p.bounds.area()));
                    }
                }
                let Some((k, _)) = largest else { break };
                let [a, b] = open(parts[k].of);
                (parts[k], parts[count]) = (a, b);
                count += 1;
            }
            let parts = &mut parts[..count];
            parts.sort_by_key(|p| p.leaf.is_some());
            let (child, mut inner) = (self.nodes.len(), 0);
            for (l, p) in parts.iter().enumerate() {
                match (p.leaf, leaf) {
                    (None, _) => {
                        waiting.push((child + inner, *p));
                        inner += 1;
                        self.nodes.push(Seven::VACANT);
                    }
                    (Some((payload, _)), Some(leaf)) => {
                        let i = payload as usize;
                        self.places.resize(self.places.len().max(i + 1), 0);
                        self.places[i] = self.nodes.len() as u32;
                        self.nodes.push(Seven::leaf(&leaf(payload)));
                    }
                    (Some((first, count)), None) => {
                        self.leaves[node][l] = first;
                        self.leaves[node][7] |= count << (COUNT_BITS * l);
                    }
                }
            }
            if leaf.is_none() {
                self.leaves.resize(self.nodes.len(), [0; 8]);
            }
            self.nodes[node] = Seven::new(parts.iter().map(|p| &p.bounds), inner as u8, child as u32);
        }
        self.nodes.shrink_to_fit();
        self.leaves.shrink_to_fit();
        self.places.shrink_to_fit();
    }

    /// Finds a payload from now on wherever its part of the tree is met: the box that it had is no longer true.
    pub fn forget_box(&mut self, payload: u32) {
        if let Some(&place) = self.places.get(payload as usize) {
            self.nodes[place as usize] = Seven::leaf(&LeafBox::anywhere(payload));
        }
    }

    /// Brings the boxes up to date. `leaf` gives that of a leaf. Not for trees with boxes of leaves.
    pub fn refit(&mut self, leaf: impl Fn(u32, u32) -> Box32) {
        let mut joint = vec![Box32::EMPTY; self.nodes.len()];
        for i in (0..self.nodes.len()).rev() {
            let Seven { child, .. } = self.nodes[i];
            let (inner, used) = (self.nodes[i].inner(), self.nodes[i].used().count_ones() as usize);
            let mut boxes = [Box32::EMPTY; LANES];
            for (l, b) in boxes[..used].iter_mut().enumerate() {
                *b = if l < usize::from(inner) {
                    joint[child as usize + l]
                } else {
                    let (first, count) = self.leaf((i << 3 | l) as u32);
                    leaf(first, count)
                };
            }
            joint[i] = boxes.iter().fold(Box32::EMPTY, |all, b| all.union(b));
            self.nodes[i] = Seven::new(boxes[..used].iter(), inner, child);
        }
        self.all = joint.first().copied().unwrap_or(Box32::EMPTY);
    }

    /// The box around all.
    pub fn bounds(&self) -> &Box32 {
        &self.all
    }

    /// Bytes in use.
    pub fn size(&self) -> usize {
        self.nodes.capacity() * size_of::<Seven>()
            + self.leaves.capacity() * size_of::<[u32; 8]>()
            + self.places.capacity() * size_of::<u32>()
    }

    /// What a leaf holds, by number of node and lane.
    #[inline(always)]
    fn leaf(&self, at: u32) -> (u32, u32) {
        let (row, lane) = (&self.leaves[(at >> 3) as usize], at as usize & 7);
        (row[lane], row[7] >> (COUNT_BITS * lane) & ((1 << COUNT_BITS) - 1))
    }

    /// Calls `found` with what each leaf holds (its two numbers) that the bundle meets within the limit, nearer ones first as far as the boxes
    /// tell. `found` may lower the limit. For trees of [`build`](Self::build).
    #[inline]
    pub fn seek(&self, bundle: &Bundle, limit: &mut f64, mut found: impl FnMut(u32, u32, &mut f64)) {
        let tell = |at, limit: &mut f64| {
            let (first, count) = self.leaf(at);
            found(first, count, limit);
        };
        dispatch_octets(Seek::<false, _> { nodes: &self.nodes, bundle, limit, tell });
    }

    /// As [`seek`](Self::seek) with the payload, for trees of [`build_with_boxes`](Self::build_with_boxes).
    #[inline]
    pub fn seek_boxes(&self, bundle: &Bundle, limit: &mut f64, mut found: impl FnMut(u32, &mut f64)) {
        let tell = |at, limit: &mut f64| {
            let leaf = self.nodes[at as usize].as_leaf();
            if bundle.line.as_ref().is_none_or(|line| leaf.is_met(line)) {
                found(leaf.payload, limit);
            }
        };
        dispatch_octets(Seek::<true, _> { nodes: &self.nodes, bundle, limit, tell });
    }
}

#[cfg(test)]
mod tests;
