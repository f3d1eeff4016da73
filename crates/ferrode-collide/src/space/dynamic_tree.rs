//! A binary tree of boxes whose leaves come, go and move.

use super::binning::{self, Item};
use super::f32_box::{Box32, Pending};
use super::leaf_box::{LeafBox, TurnedBox};
use super::mirror::{Mirror, Search};
use super::packed::PackedTree;
use super::pair_nodes::{Node, Nodes, PairNode};
use super::probe::{Probe, RayLanes, nearer};
use super::tree::split;
use super::wide::{Part, WideTree};

const NONE: u32 = u32::MAX;

/// Links of inner nodes are their first child, leaves have none; tags are payloads.
fn leaf(payload: u32, bounds: &Box32) -> Node {
    Node { bounds: *bounds, link: NONE, tag: payload }
}

impl Node {
    #[inline(always)]
    fn is_leaf(&self) -> bool {
        self.link == NONE
    }
}

/// A tree of bounded boxes, each with a number of its own.
///
/// New leaves go where they enlarge the boxes above least (surface area heuristic: MacDonald and Booth, *Heuristics for
/// ray tracing using space subdivision*, 1990), and on the way back up each node may swap a child with a grandchild if
/// that makes its boxes smaller (Catto, *Dynamic Bounding Volume Hierarchies*, 2019). A leaf that moves a little stays
/// where it is in the tree.
#[derive(Clone, Debug, Default)]
pub(crate) struct DynamicTree {
    /// Node 0 is the root, node 1 is never used. Node i's sibling is i ^ 1.
    nodes: Nodes,
    /// By pair: the node above.
    parents: Vec<u32>,
    /// Pairs not in use.
    free: Vec<u32>,
    /// By payload: its leaf.
    leaves: Vec<u32>,
    count: usize,
    /// Leaves that changed since the tree was last looked over.
    changes: usize,
    /// What [`cost`](Self::cost) was when it was last built.
    fresh: f64,
    /// Working memory of [`build_soon`](Self::build_soon).
    items: Vec<Item>,
    stack: Vec<u32>,
    /// For boxes, and for probes that packed trees are not for.
    wide: Mirror<WideTree>,
    /// For rays and what moves.
    packed: Mirror<PackedTree>,
}

/// A tree is built anew when its boxes have grown to this part of those of a new one.
const WORN: f64 = 1.3;

impl DynamicTree {
    /// Number of leaves.
    pub fn len(&self) -> usize {
        self.count
    }

    /// The box of the leaf with this payload, if there is one.
    pub fn leaf(&self, payload: u32) -> Option<Box32> {
        let leaf = *self.leaves.get(payload as usize)?;
        (leaf != NONE).then(|| self.nodes.bounds(leaf))
    }

    /// Every payload and box, in an order that depends on nothing but the history of the tree.
    pub fn leaves(&self) -> impl Iterator<Item = (u32, Box32)> + '_ {
        self.leaves
            .iter()
            .enumerate()
            .filter(|(_, l)| **l != NONE)
            .map(|(payload, &leaf)| (payload as u32, self.nodes.bounds(leaf)))
    }

    /// Rebuilds the tree over these boxes by the surface area heuristic.
    fn build(&mut self, items: &mut [(u32, Box32)]) {
        if self.start(items.iter().map(|i| i.0)) {
            self.build_node(0, items);
        }
    }

    /// Empties the tree to build it over these payloads; whether there are any.
    fn start(&mut self, payloads: impl ExactSizeIterator<Item = u32>) -> bool {
        self.drop_copies();
        self.nodes.clear();
        self.parents.clear();
        self.free.clear();
        self.leaves.fill(NONE);
        self.count = payloads.len();
        let Some(largest) = payloads.max() else { return false };
        self.grow_leaves(largest);
        self.nodes.add_pair();
        self.parents.push(NONE);
        true
    }

    /// Rebuilds the tree over its leaves and these, within a fraction of the time that [`build`](Self::build) takes: for
    /// leaves that will soon be elsewhere.
    fn build_soon(&mut self, more: &[(u32, Box32)]) {
        let mut items = core::mem::take(&mut self.items);
        items.clear();
        items.extend(self.leaves().chain(more.iter().copied()).map(|(payload, b)| Item::new(payload, &b)));
        if self.start(items.iter().map(|i| i.payload)) {
            self.build_node_soon(0, &mut items);
        }
        self.items = items;
        self.changes = 0;
        self.fresh = self.cost();
    }

    fn build_node_soon(&mut self, node: u32, items: &mut [Item]) -> Box32 {
        if let [item] = items {
            let bounds = item.bounds();
            self.nodes.set(node, leaf(item.payload, &bounds));
            self.leaves[item.payload as usize] = node;
            return bounds;
        }
        let split = binning::split(items);
        let (low, high) = items.split_at_mut(split);
        let child = self.new_pair(node);
        let bounds = self.build_node_soon(child, low).union(&self.build_node_soon(child + 1, high));
        self.nodes.set(node, Node { bounds, link: child, tag: NONE });
        bounds
    }

    /// The surfaces of all boxes that hold others: what a search has to look at grows with it.
    fn cost(&mut self) -> f64 {
        let mut cost = 0.0;
        self.stack.clear();
        self.stack.extend((self.count > 1).then_some(0));
        while let Some(i) = self.stack.pop() {
            let node = self.nodes.get(i);
            if !node.is_leaf() {
                cost += f64::from(node.bounds.area());
                self.stack.extend([node.link, node.link + 1]);
            }
        }
        cost
    }

    fn build_node(&mut self, node: u32, items: &mut [(u32, Box32)]) {
        if let [(payload, bounds)] = items {
            self.nodes.set(node, leaf(*payload, bounds));
            self.leaves[*payload as usize] = node;
            return;
        }
        let split = split(items);
        let (low, high) = items.split_at_mut(split);
        let child = self.new_pair(node);
        self.build_node(child, low);
        self.build_node(child + 1, high);
        self.nodes.set(node, Node { bounds: self.nodes.joint(child), link: child, tag: NONE });
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
                self.nodes.add_pair()
            }
        }
    }

    /// Tells what points at node `i` that it is there.
    fn relink(&mut self, i: u32) {
        match self.nodes.numbers(i) {
            (NONE, payload) => self.leaves[payload as usize] = i,
            (child, _) => self.parents[(child >> 1) as usize] = i,
        }
    }

    /// Adds a leaf. The payload must not be in the tree.
    pub fn insert(&mut self, payload: u32, bounds: &Box32) {
        self.drop_copies();
        self.grow_leaves(payload);
        self.count += 1;
        if self.count == 1 {
            if self.nodes.is_empty() {
                self.nodes.add_pair();
                self.parents.push(NONE);
            }
            self.nodes.set(0, leaf(payload, bounds));
            self.leaves[payload as usize] = 0;
            return;
        }
        // The sibling moves down to a new pair, beside the new leaf; its place becomes their parent.
        let place = self.best_sibling(bounds);
        let pair = self.new_pair(place);
        self.nodes.set(pair, self.nodes.get(place));
        self.nodes.set(pair + 1, leaf(payload, bounds));
        self.nodes.set_link(place, pair);
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
        self.drop_copies();
        self.count -= 1;
        if i == 0 {
            return;
        }
        // The sibling takes the parent's place.
        let parent = self.parents[(i >> 1) as usize];
        self.nodes.set(parent, self.nodes.get(i ^ 1));
        self.relink(parent);
        self.free.push(i >> 1);
        if parent != 0 {
            self.refit(self.parents[(parent >> 1) as usize]);
        }
    }

    /// Adds leaves, which must not be in the tree, and empties the list. Those that move are put into a tree that is built
    /// quickly, those that stay into one that is searched quickly.
    pub fn insert_all(&mut self, new: &mut Vec<(u32, Box32)>, moving: bool) {
        if 4 * new.len() <= self.count + 16 {
            new.iter().for_each(|(payload, bounds)| self.insert(*payload, bounds));
        } else if moving {
            self.build_soon(new);
        } else {
            new.extend(self.leaves());
            self.build(new);
        }
        new.clear();
    }

    /// Gives leaves of the tree other boxes, and empties the list.
    ///
    /// Leaves that go separate ways stretch the boxes above them step by step, none of which would be worth a place
    /// elsewhere. So the whole tree is looked at now and then, and built anew when it is worn.
    pub fn change_all(&mut self, changes: &mut Vec<(u32, Box32)>) {
        if 2 * changes.len() > self.count + 16 {
            // Most leaves: building the tree anew costs no more, and its boxes are smaller.
            for (payload, bounds) in changes.iter() {
                self.nodes.set_bounds(self.leaves[*payload as usize], bounds);
            }
            self.build_soon(&[]);
        } else if 16 * changes.len() > self.count + 16 {
            for (payload, bounds) in changes.iter() {
                if self.goes_far(*payload, bounds) {
                    self.change(*payload, bounds);
                } else {
                    self.nodes.set_bounds(self.leaves[*payload as usize], bounds);
                }
            }
            if self.refit_all() > WORN * self.fresh {
                self.build_soon(&[]);
            }
        } else {
            changes.iter().for_each(|(payload, bounds)| self.change(*payload, bounds));
            self.changes += changes.len();
            if 2 * self.changes > self.count + 16 {
                self.changes = 0;
                if self.cost() > WORN * self.fresh {
                    self.build_soon(&[]);
                }
            }
        }
        changes.clear();
    }

    /// Whether the tree is better with a leaf elsewhere if it gets this box.
    fn goes_far(&self, payload: u32, bounds: &Box32) -> bool {
        let i = self.leaves[payload as usize];
        let old = |parent: u32| self.nodes.bounds(parent).area();
        i != 0 && bounds.union(&self.nodes.bounds(i ^ 1)).area() > 2.0 * old(self.parents[(i >> 1) as usize])
    }

    /// Recomputes all boxes from those of the leaves. Returns the [`cost`](Self::cost).
    fn refit_all(&mut self) -> f64 {
        self.drop_copies();
        self.changes = 0;
        // What holds others before these.
        self.stack.clear();
        self.stack.extend((self.count > 1).then_some(0));
        let mut k = 0;
        while let Some(&i) = self.stack.get(k) {
            let (child, _) = self.nodes.numbers(i);
            for c in [child, child + 1] {
                if self.nodes.numbers(c).0 != NONE {
                    self.stack.push(c);
                }
            }
            k += 1;
        }
        let mut cost = 0.0;
        for &i in self.stack.iter().rev() {
            let bounds = self.nodes.joint(self.nodes.numbers(i).0);
            self.nodes.set_bounds(i, &bounds);
            cost += f64::from(bounds.area());
        }
        cost
    }

    /// Gives a leaf of the tree another box.
    fn change(&mut self, payload: u32, bounds: &Box32) {
        self.drop_copies();
        if self.goes_far(payload, bounds) {
            self.remove(payload);
            self.insert(payload, bounds);
            return;
        }
        let i = self.leaves[payload as usize];
        self.nodes.set_bounds(i, bounds);
        if i != 0 {
            self.refit(self.parents[(i >> 1) as usize]);
        }
    }

    /// The node beside which a new leaf adds least surface to the tree, going down while that is not certain to be here.
    fn best_sibling(&self, bounds: &Box32) -> u32 {
        let mut i = 0;
        loop {
            let node = self.nodes.get(i);
            if node.is_leaf() {
                return i;
            }
            let joint = node.bounds.union(bounds).area();
            // What all nodes below inherit if the leaf goes further down.
            let inherited = joint - node.bounds.area();
            let cost = |child: u32| {
                let c = self.nodes.get(child);
                let union = c.bounds.union(bounds).area();
                inherited + if c.is_leaf() { union } else { union - c.bounds.area() }
            };
            let (left, right) = (cost(node.link), cost(node.link + 1));
            if joint < left && joint < right {
                return i;
            }
            i = if left < right { node.link } else { node.link + 1 };
        }
    }

    /// Recomputes the boxes from node `i` up, improving the tree on the way, until nothing changes.
    fn refit(&mut self, mut i: u32) {
        loop {
            let node = self.nodes.get(i);
            let bounds = self.nodes.joint(node.link);
            let same = node.bounds == bounds;
            self.nodes.set_bounds(i, &bounds);
            self.rotate(i);
            if same || i == 0 {
                return;
            }
            i = self.parents[(i >> 1) as usize];
        }
    }

    /// Swaps a child of node `i` with one of the other child's children if that makes the other child's box smaller.
    fn rotate(&mut self, i: u32) {
        let (child, _) = self.nodes.numbers(i);
        let mut best = (0.0, 0, 0);
        for (lone, other) in [(child, child + 1), (child + 1, child)] {
            let o = self.nodes.get(other);
            if o.is_leaf() {
                continue;
            }
            let (area, lone_bounds) = (o.bounds.area(), self.nodes.bounds(lone));
            for grandchild in [o.link, o.link + 1] {
                let gain = area - lone_bounds.union(&self.nodes.bounds(grandchild ^ 1)).area();
                if gain > best.0 {
                    best = (gain, lone, grandchild);
                }
            }
        }
        let (gain, lone, grandchild) = best;
        if gain > 0.0 {
            let (a, b) = (self.nodes.get(lone), self.nodes.get(grandchild));
            self.nodes.set(lone, b);
            self.nodes.set(grandchild, a);
            self.relink(lone);
            self.relink(grandchild);
            let other = lone ^ 1;
            let bounds = self.nodes.joint(self.nodes.numbers(other).0);
            self.nodes.set_bounds(other, &bounds);
        }
    }

    /// Calls `found` with the payload of each leaf that passes `test`, as do the nodes above it.
    #[inline(always)]
    pub fn walk(&self, test: impl Fn(&Box32) -> bool, found: impl FnMut(u32)) {
        if self.count > 0 && test(&self.nodes.bounds(0)) {
            self.descend(|c| [test(&self.nodes.bounds(c)), test(&self.nodes.bounds(c + 1))], found);
        }
    }

    /// Calls `found` with the payload of each leaf whose box overlaps `bounds`.
    #[inline]
    pub fn query(&self, bounds: &Box32, mut found: impl FnMut(u32)) {
        if self.count == 0 || !self.nodes.bounds(0).overlaps(bounds) {
            return;
        }
        if let Some(wide) = self.wide(Search::Query) {
            wide.query(bounds, |payload, _| found(payload));
        } else {
            self.descend(|c| self.nodes.pair(c).overlaps(bounds), found);
        }
    }

    /// For every change of the tree.
    #[inline]
    fn drop_copies(&mut self) {
        self.wide.drop_copy();
        self.packed.drop_copy();
    }

    fn part(&self, i: u32) -> Part<u32> {
        let node = self.nodes.get(i);
        Part { bounds: node.bounds, leaf: node.is_leaf().then_some((node.tag, 1)), of: i }
    }

    fn open(&self, i: u32) -> [Part<u32>; 2] {
        let (child, _) = self.nodes.numbers(i);
        [self.part(child), self.part(child + 1)]
    }

    /// The tree with four boxes to a node, if that is worth while.
    #[inline]
    fn wide(&self, search: Search) -> Option<&WideTree> {
        self.wide.get(search, self.count, || {
            let mut tree = WideTree::default();
            tree.build(self.part(0), |i| self.open(i));
            tree
        })
    }

    /// The tree with seven boxes to a node, if that is worth while.
    #[inline]
    fn packed(&self, turned: &dyn Fn(u32) -> Option<TurnedBox>) -> Option<&PackedTree> {
        self.packed.get(Search::Seek, self.count, || {
            let leaf = |payload| match turned(payload) {
                Some(turned) => LeafBox::new(payload, &turned),
                None => LeafBox::anywhere(payload),
            };
            PackedTree::build_with_boxes(self.part(0), |i| self.open(i), &leaf)
        })
    }

    /// For a leaf whose box stays, but not what `turned` says of it in [`seek`](Self::seek).
    pub fn turn(&mut self, payload: u32) {
        if let Some(packed) = self.packed.copy_mut() {
            packed.forget_box(payload);
        }
    }

    /// Visits the leaves below the root that `test` lets through, two siblings at a time.
    #[inline(always)]
    fn descend(&self, test: impl Fn(u32) -> [bool; 2], mut found: impl FnMut(u32)) {
        let mut pending: Pending<u32> = Pending::new();
        let mut i = 0;
        loop {
            let (child, payload) = self.nodes.numbers(i);
            if child == NONE {
                found(payload);
            } else {
                let [a, b] = test(child);
                // Without a branch for which of the two: that cannot be foretold.
                pending.push_if(a & b, child + 1);
                if a | b {
                    i = child + u32::from(!a);
                    continue;
                }
            }
            match pending.pop() {
                Some(next) => i = next,
                None => return,
            }
        }
    }

    /// Calls `found` with the payload of each leaf that the probe meets within the limit, nearer ones first as far as
    /// the boxes tell. `found` may lower the limit. `turned` may know of a tighter box within a leaf's own, until
    /// [`turn`](Self::turn); leaves whose tighter box a ray misses need not be found.
    #[inline]
    pub fn seek(
        &self,
        probe: &Probe,
        limit: &mut f64,
        turned: &dyn Fn(u32) -> Option<TurnedBox>,
        mut found: impl FnMut(u32, &mut f64),
    ) {
        if self.count == 0 {
            return;
        }
        let all = &self.nodes.bounds(0);
        let bundle = probe.bundle(all).filter(|_| self.count < PackedTree::MOST);
        if let Some(bundle) = &bundle {
            if let Some(packed) = self.packed(turned) {
                packed.seek_boxes(bundle, limit, found);
                return;
            }
        } else if let Some(wide) = self.wide(Search::Seek) {
            wide.seek(probe, limit, |payload, _, limit| found(payload, limit));
            return;
        }
        if probe.enter(all, *limit).is_none() {
            return;
        }
        match probe.lanes(all) {
            Some(lanes) => self.seek_by(limit, found, |pair, _, near| lanes.enter_pair(pair, near)),
            None => self.seek_by(limit, found, |pair, limit, _| probe.enter_pair(pair, limit)),
        }
    }

    /// `enter` tells for a pair of nodes, the limit and the limit in single precision which of the two are met, and where.
    #[inline(always)]
    fn seek_by(
        &self,
        limit: &mut f64,
        mut found: impl FnMut(u32, &mut f64),
        enter: impl Fn(&PairNode, f64, f32) -> ([bool; 2], [f32; 2]),
    ) {
        let mut pending: Pending<(u32, f32)> = Pending::new();
        let mut near = RayLanes::limit(*limit);
        let mut i = 0;
        loop {
            let (link, payload) = self.nodes.numbers(i);
            let mut next = None;
            if link == NONE {
                found(payload, limit);
                near = RayLanes::limit(*limit);
            } else {
                next = nearer(link, enter(self.nodes.pair(link), *limit, near), &mut pending);
            }
            while next.is_none() {
                let Some((waiting, at)) = pending.pop() else { return };
                if at <= near {
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
        let (c, _) = self.nodes.numbers(i);
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

/// One step of comparing node `a` of one tree with node `b` of another: reports two leaves, or opens the larger node.
#[inline]
fn cross(
    first: &Nodes,
    a: u32,
    second: &Nodes,
    b: u32,
    stack: &mut Vec<(u32, u32)>,
    found: &mut impl FnMut(u32, u32),
) {
    let (na, nb) = (first.get(a), second.get(b));
    if !na.bounds.overlaps(&nb.bounds) {
        return;
    }
    match (na.is_leaf(), nb.is_leaf()) {
        (true, true) => found(na.tag, nb.tag),
        (leaf, other) if !leaf && (other || na.bounds.area() >= nb.bounds.area()) => {
            stack.extend([(na.link, b), (na.link + 1, b)]);
        }
        _ => stack.extend([(a, nb.link), (a, nb.link + 1)]),
    }
}

#[cfg(test)]
mod tests;
