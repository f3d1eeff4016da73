//! A binary tree of boxes that can be built at once and changed one leaf at a time.

use ferrode_math::{Aabb, Vec3};

/// No node.
const NONE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
struct Node {
    aabb: Aabb,
    parent: u32,
    /// Children of an inner node; a leaf has `NONE` for the first and its payload for the second.
    left: u32,
    right: u32,
}

impl Node {
    fn is_leaf(&self) -> bool {
        self.left == NONE
    }
}

/// A tree of bounded boxes with a number at each leaf.
///
/// New leaves go where they enlarge the boxes above least (surface area heuristic: MacDonald and Booth, *Heuristics for
/// ray tracing using space subdivision*, 1990), and on the way back up each node may swap a child with a grandchild if
/// that makes its boxes smaller (Catto, *Dynamic Bounding Volume Hierarchies*, 2019).
#[derive(Clone, Debug)]
pub struct AabbTree {
    nodes: Vec<Node>,
    free: Vec<u32>,
    root: u32,
}

impl Default for AabbTree {
    fn default() -> Self {
        Self { nodes: Vec::new(), free: Vec::new(), root: NONE }
    }
}

impl AabbTree {
    /// A tree without leaves.
    pub fn new() -> Self {
        Self::default()
    }

    /// A tree over `boxes`, whose payloads are their indices: split at the middle of the longest side of the box around
    /// the centres, halves by count where that fails.
    pub fn build(boxes: &[Aabb]) -> Self {
        let mut tree = Self { nodes: Vec::with_capacity(2 * boxes.len()), ..Self::default() };
        let mut items: Vec<u32> = (0..boxes.len() as u32).collect();
        if !items.is_empty() {
            tree.root = tree.build_range(boxes, &mut items, NONE);
        }
        tree
    }

    fn build_range(&mut self, boxes: &[Aabb], items: &mut [u32], parent: u32) -> u32 {
        let at = |i: u32| &boxes[i as usize];
        let index = self.nodes.len() as u32;
        if let [item] = *items {
            self.nodes.push(Node { aabb: *at(item), parent, left: NONE, right: item });
            return index;
        }
        let mut aabb = Aabb::EMPTY;
        let mut centers = Aabb::EMPTY;
        for &i in items.iter() {
            aabb = aabb.union(at(i));
            let c = at(i).center();
            centers = centers.union(&Aabb::new(c, c));
        }
        let e = centers.extent();
        let axis = if e.x >= e.y && e.x >= e.z {
            0
        } else if e.y >= e.z {
            1
        } else {
            2
        };
        let middle = centers.center()[axis];
        let mut split = 0;
        for k in 0..items.len() {
            if at(items[k]).center()[axis] < middle {
                items.swap(split, k);
                split += 1;
            }
        }
        if split == 0 || split == items.len() {
            split = items.len() / 2;
        }
        self.nodes.push(Node { aabb, parent, left: NONE, right: NONE });
        let (low, high) = items.split_at_mut(split);
        let left = self.build_range(boxes, low, index);
        let right = self.build_range(boxes, high, index);
        self.nodes[index as usize].left = left;
        self.nodes[index as usize].right = right;
        index
    }

    /// Adds a leaf and returns its node.
    pub fn insert(&mut self, payload: u32, aabb: Aabb) -> u32 {
        let leaf = self.new_node(Node { aabb, parent: NONE, left: NONE, right: payload });
        if self.root == NONE {
            self.root = leaf;
            return leaf;
        }
        let sibling = self.best_sibling(&aabb);
        let parent = self.nodes[sibling as usize].parent;
        let joint = self.new_node(Node {
            aabb: aabb.union(&self.nodes[sibling as usize].aabb),
            parent,
            left: sibling,
            right: leaf,
        });
        self.nodes[sibling as usize].parent = joint;
        self.nodes[leaf as usize].parent = joint;
        self.replace_child(parent, sibling, joint);
        self.refit(parent);
        leaf
    }

    /// Removes a leaf by its node.
    pub fn remove(&mut self, leaf: u32) {
        let parent = self.nodes[leaf as usize].parent;
        self.free.push(leaf);
        if parent == NONE {
            self.root = NONE;
            return;
        }
        let p = self.nodes[parent as usize];
        let sibling = if p.left == leaf { p.right } else { p.left };
        self.nodes[sibling as usize].parent = p.parent;
        self.replace_child(p.parent, parent, sibling);
        self.free.push(parent);
        self.refit(p.parent);
    }

    /// The box of a node.
    pub fn aabb(&self, node: u32) -> &Aabb {
        &self.nodes[node as usize].aabb
    }

    /// The box around all leaves.
    pub fn bounds(&self) -> Aabb {
        if self.root == NONE { Aabb::EMPTY } else { self.nodes[self.root as usize].aabb }
    }

    /// Calls `found` with the payload of each leaf whose box passes `test`, as do the boxes above it; stops when it
    /// returns false.
    pub fn walk(&self, test: impl Fn(&Aabb) -> bool, mut found: impl FnMut(u32) -> bool) {
        // Preorder without a stack: down to the left, else on to the next node to the right.
        let mut node = self.root;
        while node != NONE {
            let n = &self.nodes[node as usize];
            if test(&n.aabb) {
                if !n.is_leaf() {
                    node = n.left;
                    continue;
                }
                if !found(n.right) {
                    return;
                }
            }
            node = self.after(node);
        }
    }

    /// The node after the whole of `node` in preorder.
    fn after(&self, mut node: u32) -> u32 {
        loop {
            let parent = self.nodes[node as usize].parent;
            if parent == NONE {
                return NONE;
            }
            let p = &self.nodes[parent as usize];
            if p.left == node {
                return p.right;
            }
            node = parent;
        }
    }

    /// Calls `found` with the payload of each leaf whose box overlaps `aabb`.
    pub fn query(&self, aabb: &Aabb, mut found: impl FnMut(u32)) {
        self.walk(
            |b| b.overlaps(aabb),
            |payload| {
                found(payload);
                true
            },
        );
    }

    /// Calls `found` with the payloads of each two leaves whose boxes overlap, once. `stack` is working memory.
    pub fn pairs(&self, stack: &mut Vec<(u32, u32)>, mut found: impl FnMut(u32, u32)) {
        stack.clear();
        if self.root != NONE {
            stack.push((self.root, self.root));
        }
        while let Some((a, b)) = stack.pop() {
            let (na, nb) = (&self.nodes[a as usize], &self.nodes[b as usize]);
            if a == b {
                if !na.is_leaf() {
                    stack.extend([(na.left, na.left), (na.right, na.right), (na.left, na.right)]);
                }
                continue;
            }
            if !na.aabb.overlaps(&nb.aabb) {
                continue;
            }
            match (na.is_leaf(), nb.is_leaf()) {
                (true, true) => found(na.right, nb.right),
                (true, false) => stack.extend([(a, nb.left), (a, nb.right)]),
                (false, true) => stack.extend([(na.left, b), (na.right, b)]),
                // Open the larger.
                (false, false) if na.aabb.surface_area() >= nb.aabb.surface_area() => {
                    stack.extend([(na.left, b), (na.right, b)]);
                }
                (false, false) => stack.extend([(a, nb.left), (a, nb.right)]),
            }
        }
    }

    fn new_node(&mut self, node: Node) -> u32 {
        match self.free.pop() {
            Some(i) => {
                self.nodes[i as usize] = node;
                i
            }
            None => {
                self.nodes.push(node);
                (self.nodes.len() - 1) as u32
            }
        }
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        if parent == NONE {
            self.root = new;
            return;
        }
        let p = &mut self.nodes[parent as usize];
        if p.left == old {
            p.left = new;
        } else {
            p.right = new;
        }
    }

    /// The node beside which a new leaf adds least surface to the tree, going down while that is not certain to be here.
    fn best_sibling(&self, aabb: &Aabb) -> u32 {
        let mut node = self.root;
        loop {
            let n = &self.nodes[node as usize];
            if n.is_leaf() {
                return node;
            }
            let area = n.aabb.surface_area();
            let joint = n.aabb.union(aabb).surface_area();
            // What all nodes below inherit if the leaf goes further down.
            let inherited = joint - area;
            let cost = |child: u32| {
                let c = &self.nodes[child as usize];
                let union = c.aabb.union(aabb).surface_area();
                let own = if c.is_leaf() { union } else { union - c.aabb.surface_area() };
                own + inherited
            };
            let (left, right) = (cost(n.left), cost(n.right));
            if joint < left && joint < right {
                return node;
            }
            node = if left < right { n.left } else { n.right };
        }
    }

    /// Recomputes the boxes from `node` up, improving the tree on the way.
    fn refit(&mut self, mut node: u32) {
        while node != NONE {
            let n = self.nodes[node as usize];
            let aabb = self.nodes[n.left as usize].aabb.union(&self.nodes[n.right as usize].aabb);
            self.nodes[node as usize].aabb = aabb;
            self.rotate(node);
            node = n.parent;
        }
    }

    /// Swaps a child with one of the other child's children if that makes the other child's box smaller.
    fn rotate(&mut self, node: u32) {
        let n = self.nodes[node as usize];
        let mut best = (0.0, NONE, NONE, NONE);
        for (child, other) in [(n.left, n.right), (n.right, n.left)] {
            let o = self.nodes[other as usize];
            if o.is_leaf() {
                continue;
            }
            let area = o.aabb.surface_area();
            for (grandchild, stays) in [(o.left, o.right), (o.right, o.left)] {
                let union = self.nodes[child as usize].aabb.union(&self.nodes[stays as usize].aabb);
                let gain = area - union.surface_area();
                if gain > best.0 {
                    best = (gain, child, grandchild, other);
                }
            }
        }
        let (gain, child, grandchild, other) = best;
        if gain > 0.0 {
            self.replace_child(node, child, grandchild);
            self.replace_child(other, grandchild, child);
            self.nodes[grandchild as usize].parent = node;
            self.nodes[child as usize].parent = other;
            let o = self.nodes[other as usize];
            self.nodes[other as usize].aabb =
                self.nodes[o.left as usize].aabb.union(&self.nodes[o.right as usize].aabb);
        }
    }
}

/// Whether the segment from `o` to `o + u` (`inverse` = 1/u by component) meets the box; touching counts.
#[inline]
pub fn segment_meets(aabb: &Aabb, o: Vec3, inverse: Vec3) -> bool {
    let (mut lo, mut hi) = (0.0f64, 1.0f64);
    for i in 0..3 {
        if inverse[i].is_finite() {
            let (s, t) = ((aabb.min[i] - o[i]) * inverse[i], (aabb.max[i] - o[i]) * inverse[i]);
            let (s, t) = if s <= t { (s, t) } else { (t, s) };
            // A little wider, against the rounding of the quotient.
            let slack = 4.0 * f64::EPSILON * (1.0 + s.abs().min(t.abs()));
            lo = lo.max(s - slack);
            hi = hi.min(t + slack);
        } else if o[i] < aabb.min[i] || o[i] > aabb.max[i] {
            return false;
        }
    }
    lo <= hi
}
