//! A binary tree of boxes whose leaves come, go and move.

use super::f32_box::{Box32, Pending};
use super::probe::{Probe, nearer};
use super::tree::split;

const NONE: u32 = u32::MAX;

/// 32 bytes, half a cache line. The two children of a node lie side by side: node i's sibling is node i ^ 1, and pair
/// i >> 1 has one parent.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct Node {
    min: [f32; 3],
    /// The first of two children; `NONE` for a leaf.
    child: u32,
    max: [f32; 3],
    /// The number at a leaf.
    payload: u32,
}

impl Node {
    #[inline(always)]
    fn bounds(&self) -> Box32 {
        Box32 { min: self.min, max: self.max }
    }

    #[inline(always)]
    fn set_bounds(&mut self, b: &Box32) {
        (self.min, self.max) = (b.min, b.max);
    }

    #[inline(always)]
    fn is_leaf(&self) -> bool {
        self.child == NONE
    }

    #[inline(always)]
    fn overlaps(&self, b: &Box32) -> bool {
        self.bounds().overlaps(b)
    }
}

const VACANT: Node =
    Node { min: [f32::INFINITY; 3], child: NONE, max: [f32::NEG_INFINITY; 3], payload: NONE };

/// A tree of bounded boxes, each with a number of its own.
///
/// New leaves go where they enlarge the boxes above least (surface area heuristic: MacDonald and Booth, *Heuristics for
/// ray tracing using space subdivision*, 1990), and on the way back up each node may swap a child with a grandchild if
/// that makes its boxes smaller (Catto, *Dynamic Bounding Volume Hierarchies*, 2019). A leaf that moves a little stays
/// where it is in the tree.
#[derive(Clone, Debug, Default)]
pub(crate) struct DynamicTree {
    /// Node 0 is the root, node 1 is never used.
    nodes: Vec<Node>,
    /// By pair: the node above.
    parents: Vec<u32>,
    /// Pairs not in use.
    free: Vec<u32>,
    /// By payload: its leaf.
    leaves: Vec<u32>,
    count: usize,
}

impl DynamicTree {
    /// Number of leaves.
    pub fn len(&self) -> usize {
        self.count
    }

    /// The box of the leaf with this payload, if there is one.
    pub fn leaf(&self, payload: u32) -> Option<Box32> {
        let leaf = *self.leaves.get(payload as usize)?;
        (leaf != NONE).then(|| self.nodes[leaf as usize].bounds())
    }

    /// Every payload and box, in an order that depends on nothing but the history of the tree.
    pub fn leaves(&self) -> impl Iterator<Item = (u32, Box32)> + '_ {
        self.leaves
            .iter()
            .enumerate()
            .filter(|(_, l)| **l != NONE)
            .map(|(payload, &leaf)| (payload as u32, self.nodes[leaf as usize].bounds()))
    }

    /// Rebuilds the tree over these boxes by the surface area heuristic.
    pub fn build(&mut self, items: &mut [(u32, Box32)]) {
        self.nodes.clear();
        self.parents.clear();
        self.free.clear();
        self.leaves.fill(NONE);
        self.count = items.len();
        if let Some(largest) = items.iter().map(|i| i.0).max() {
            self.grow_leaves(largest);
            self.nodes.resize(2, VACANT);
            self.parents.push(NONE);
            self.build_node(0, items);
        }
    }

    fn build_node(&mut self, node: u32, items: &mut [(u32, Box32)]) {
        if let [(payload, bounds)] = items {
            self.nodes[node as usize] =
                Node { min: bounds.min, child: NONE, max: bounds.max, payload: *payload };
            self.leaves[*payload as usize] = node;
            return;
        }
        let split = split(items);
        let (low, high) = items.split_at_mut(split);
        let child = self.new_pair(node);
        self.build_node(child, low);
        self.build_node(child + 1, high);
        let bounds = self.nodes[child as usize].bounds().union(&self.nodes[child as usize + 1].bounds());
        self.nodes[node as usize] = Node { min: bounds.min, child, max: bounds.max, payload: NONE };
    }

    fn grow_leaves(&mut self, payload: u32) {
        if payload as usize >= self.leaves.len() {
            self.leaves.resize(payload as usize + 1, NONE);
        }
    }

    fn new_pair(&mut self, parent: u32) -> u32 {
        match self.free.pop() {
            Some(pair) => {
                self.parents[pair as usize] = parent;
                2 * pair
            }
            None => {
                self.parents.push(parent);
                self.nodes.extend([VACANT; 2]);
                self.nodes.len() as u32 - 2
            }
        }
    }

    /// Tells what points at node `i` that it is there.
    fn relink(&mut self, i: u32) {
        let node = &self.nodes[i as usize];
        if node.is_leaf() {
            self.leaves[node.payload as usize] = i;
        } else {
            self.parents[(node.child >> 1) as usize] = i;
        }
    }

    /// Adds a leaf. The payload must not be in the tree.
    pub fn insert(&mut self, payload: u32, bounds: &Box32) {
        self.grow_leaves(payload);
        self.count += 1;
        let leaf = Node { min: bounds.min, child: NONE, max: bounds.max, payload };
        if self.count == 1 {
            if self.nodes.is_empty() {
                self.nodes.resize(2, VACANT);
                self.parents.push(NONE);
            }
            self.nodes[0] = leaf;
            self.leaves[payload as usize] = 0;
            return;
        }
        // The sibling moves down to a new pair, beside the new leaf; its place becomes their parent.
        let place = self.best_sibling(bounds);
        let pair = self.new_pair(place);
        self.nodes[pair as usize] = self.nodes[place as usize];
        self.nodes[pair as usize + 1] = leaf;
        self.nodes[place as usize].child = pair;
        self.relink(pair);
        self.relink(pair + 1);
        self.refit(place);
    }

    /// Removes the leaf with this payload, if there is one.
    pub fn remove(&mut self, payload: u32) {
        let Some(leaf) = self.leaves.get_mut(payload as usize) else { return };
        let i = core::mem::replace(leaf, NONE);
        if i == NONE {
            return;
        }
        self.count -= 1;
        if i == 0 {
            return;
        }
        // The sibling takes the parent's place.
        let parent = self.parents[(i >> 1) as usize];
        self.nodes[parent as usize] = self.nodes[(i ^ 1) as usize];
        self.relink(parent);
        self.free.push(i >> 1);
        if parent != 0 {
            self.refit(self.parents[(parent >> 1) as usize]);
        }
    }

    /// Gives a leaf another box and leaves those above it wrong: for all that is done before [`build`](Self::build).
    pub fn set_box(&mut self, payload: u32, bounds: &Box32) {
        let leaf = self.leaves[payload as usize];
        self.nodes[leaf as usize].set_bounds(bounds);
    }

    /// Gives a leaf of the tree another box.
    pub fn change(&mut self, payload: u32, bounds: &Box32) {
        let i = self.leaves[payload as usize];
        let sibling = self.nodes[(i ^ 1) as usize].bounds();
        if i != 0 {
            let parent = self.parents[(i >> 1) as usize];
            let old = self.nodes[parent as usize].area_of();
            if bounds.union(&sibling).area() > 2.0 * old {
                // It went far: the tree is better with it elsewhere.
                self.remove(payload);
                self.insert(payload, bounds);
                return;
            }
        }
        self.nodes[i as usize].set_bounds(bounds);
        if i != 0 {
            self.refit(self.parents[(i >> 1) as usize]);
        }
    }

    /// The node beside which a new leaf adds least surface to the tree, going down while that is not certain to be here.
    fn best_sibling(&self, bounds: &Box32) -> u32 {
        let mut i = 0;
        loop {
            let node = &self.nodes[i as usize];
            if node.is_leaf() {
                return i;
            }
            let joint = node.bounds().union(bounds).area();
            // What all nodes below inherit if the leaf goes further down.
            let inherited = joint - node.area_of();
            let cost = |child: u32| {
                let c = &self.nodes[child as usize];
                let union = c.bounds().union(bounds).area();
                inherited + if c.is_leaf() { union } else { union - c.area_of() }
            };
            let (left, right) = (cost(node.child), cost(node.child + 1));
            if joint < left && joint < right {
                return i;
            }
            i = if left < right { node.child } else { node.child + 1 };
        }
    }

    /// Recomputes the boxes from node `i` up, improving the tree on the way, until nothing changes.
    fn refit(&mut self, mut i: u32) {
        loop {
            let child = self.nodes[i as usize].child as usize;
            let bounds = self.nodes[child].bounds().union(&self.nodes[child + 1].bounds());
            let node = &mut self.nodes[i as usize];
            let same = node.bounds() == bounds;
            node.set_bounds(&bounds);
            self.rotate(i);
            if same || i == 0 {
                return;
            }
            i = self.parents[(i >> 1) as usize];
        }
    }

    /// Swaps a child of node `i` with one of the other child's children if that makes the other child's box smaller.
    fn rotate(&mut self, i: u32) {
        let child = self.nodes[i as usize].child;
        let mut best = (0.0, 0, 0);
        for (lone, other) in [(child, child + 1), (child + 1, child)] {
            let o = &self.nodes[other as usize];
            if o.is_leaf() {
                continue;
            }
            let (area, lone_bounds) = (o.area_of(), self.nodes[lone as usize].bounds());
            for grandchild in [o.child, o.child + 1] {
                let stays = &self.nodes[(grandchild ^ 1) as usize];
                let gain = area - lone_bounds.union(&stays.bounds()).area();
                if gain > best.0 {
                    best = (gain, lone, grandchild);
                }
            }
        }
        let (gain, lone, grandchild) = best;
        if gain > 0.0 {
            self.nodes.swap(lone as usize, grandchild as usize);
            self.relink(lone);
            self.relink(grandchild);
            let other = lone ^ 1;
            let pair = self.nodes[other as usize].child as usize;
            let bounds = self.nodes[pair].bounds().union(&self.nodes[pair + 1].bounds());
            self.nodes[other as usize].set_bounds(&bounds);
        }
    }

    /// Calls `found` with the payload of each leaf that passes `test`, as do the nodes above it.
    #[inline(always)]
    pub fn walk(&self, test: impl Fn(&Box32) -> bool, mut found: impl FnMut(u32)) {
        if self.count == 0 || !test(&self.nodes[0].bounds()) {
            return;
        }
        let mut pending: Pending<u32> = Pending::new();
        let mut i = 0;
        loop {
            let node = &self.nodes[i as usize];
            if node.is_leaf() {
                found(node.payload);
            } else {
                let c = node.child as usize;
                if let [a, b] = &self.nodes[c..c + 2] {
                    if test(&b.bounds()) {
                        pending.push(node.child + 1);
                    }
                    if test(&a.bounds()) {
                        i = node.child;
                        continue;
                    }
                }
            }
            match pending.pop() {
                Some(next) => i = next,
                None => return,
            }
        }
    }

    /// Calls `found` with the payload of each leaf whose box overlaps `bounds`.
    #[inline]
    pub fn query(&self, bounds: &Box32, found: impl FnMut(u32)) {
        self.walk(|b| b.overlaps(bounds), found);
    }

    /// Calls `found` with the payload of each leaf that the probe meets within the limit, nearer ones first as far as
    /// the boxes tell. `found` may lower the limit.
    #[inline]
    pub fn seek(&self, probe: &Probe, limit: &mut f64, mut found: impl FnMut(u32, &mut f64)) {
        if self.count == 0 || probe.enter(&self.nodes[0].bounds(), *limit).is_none() {
            return;
        }
        let mut pending: Pending<(u32, f32)> = Pending::new();
        let mut i = 0;
        loop {
            let node = &self.nodes[i as usize];
            let mut next = None;
            if node.is_leaf() {
                found(node.payload, limit);
            } else {
                let c = node.child;
                if let [left, right] = &self.nodes[c as usize..c as usize + 2] {
                    let (a, b) = (probe.enter(&left.bounds(), *limit), probe.enter(&right.bounds(), *limit));
                    next = nearer(c, a, b, &mut pending);
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

    /// Calls `found` with the payloads of each two leaves whose boxes overlap, once. `stack` is working memory.
    pub fn pairs(&self, stack: &mut Vec<(u32, u32)>, mut found: impl FnMut(u32, u32)) {
        stack.clear();
        if self.count > 1 {
            self.inner_pairs(0, stack);
        }
        while let Some((a, b)) = stack.pop() {
            if a == b {
                self.inner_pairs(a, stack);
            } else {
                cross(&self.nodes, a, &self.nodes, b, stack, &mut found);
            }
        }
    }

    fn inner_pairs(&self, i: u32, stack: &mut Vec<(u32, u32)>) {
        let c = self.nodes[i as usize].child;
        if c != NONE {
            stack.extend([(c, c), (c + 1, c + 1), (c, c + 1)]);
        }
    }

    /// Calls `found` with the payloads of each leaf of this tree and leaf of the other whose boxes overlap.
    pub fn pairs_with(&self, other: &Self, stack: &mut Vec<(u32, u32)>, mut found: impl FnMut(u32, u32)) {
        stack.clear();
        if self.count > 0 && other.count > 0 {
            stack.push((0, 0));
        }
        while let Some((a, b)) = stack.pop() {
            cross(&self.nodes, a, &other.nodes, b, stack, &mut found);
        }
    }
}

impl Node {
    #[inline(always)]
    fn area_of(&self) -> f32 {
        self.bounds().area()
    }
}

/// One step of comparing node `a` of one tree with node `b` of another: reports two leaves, or opens the larger node.
#[inline]
fn cross(
    first: &[Node],
    a: u32,
    second: &[Node],
    b: u32,
    stack: &mut Vec<(u32, u32)>,
    found: &mut impl FnMut(u32, u32),
) {
    let (na, nb) = (&first[a as usize], &second[b as usize]);
    if !na.overlaps(&nb.bounds()) {
        return;
    }
    match (na.is_leaf(), nb.is_leaf()) {
        (true, true) => found(na.payload, nb.payload),
        (leaf, other) if !leaf && (other || na.area_of() >= nb.area_of()) => {
            stack.extend([(na.child, b), (na.child + 1, b)]);
        }
        _ => stack.extend([(a, nb.child), (a, nb.child + 1)]),
    }
}
