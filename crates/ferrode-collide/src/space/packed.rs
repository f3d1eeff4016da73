//! Trees of seven boxes to a node of one cache line: for rays, which wait for memory more than for anything else.

use super::f32_box::{Box32, Pending};
use super::probe::Bundle;
use super::wide::Part;
use ferrode_math::simd::{Octet, OctetKernel, dispatch_octets};

/// Seven boxes in bytes, side by side, in a cache line: wide nodes with quantised boxes (Ylitie, Karras and Laine, *Efficient
/// incoherent ray traversal on GPUs through compressed wide BVHs*, 2017). A side that reads `q` lies at
/// `origin + q · 2^exponent` of its axis, never further in than the side that it stands for.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Seven {
    /// Along each axis the lower sides of the seven, then the upper ones. In place of an eighth: of the lower sides the exponent
    /// (as the bits of a number in single precision have it), of the upper ones what `INNER` and `USED` say.
    sides: [[[u8; 8]; 2]; 3],
    origin: [f32; 3],
    /// The first of the nodes in it, which follow one another: what the first lanes hold. The others hold leaves.
    child: u32,
}

const _: () = assert!(size_of::<Seven>() == 64);

/// Along which axis the last upper side is the number of nodes within.
const INNER: usize = 0;
/// Along which axis the last upper side has a bit for each lane that holds anything.
const USED: usize = 1;

/// Boxes to a node.
pub(super) const LANES: usize = 7;
/// Lowest exponent: what is smaller is as good as a point.
const FINEST: i32 = -60;
/// Highest; boxes that need more are beyond what rays are searched for here.
const COARSEST: i32 = 100;

impl Seven {
    const VACANT: Self = Self { sides: [[[0; 8]; 2]; 3], origin: [0.0; 3], child: 0 };

    /// The step between sides along an axis.
    #[inline(always)]
    fn step(&self, axis: usize) -> f32 {
        f32::from_bits(u32::from(self.sides[axis][0][7]) << 23)
    }

    /// How many of the first lanes hold nodes.
    #[inline(always)]
    fn inner(&self) -> u8 {
        self.sides[INNER][1][7]
    }

    /// A bit for each lane that holds anything.
    #[inline(always)]
    fn used(&self) -> u8 {
        self.sides[USED][1][7]
    }

    /// Boxes of which the first `inner` are of nodes, which begin at `child`.
    fn new<'a>(boxes: impl ExactSizeIterator<Item = &'a Box32> + Clone, inner: u8, child: u32) -> Self {
        let mut seven = Self { child, ..Self::VACANT };
        let all = boxes.clone().fold(Box32::EMPTY, |all, b| all.union(b));
        let used = ((1u32 << boxes.len()) - 1) as u8;
        for axis in 0..3 {
            let origin = f64::from(all.min[axis]);
            let extent = f64::from(all.max[axis]) - origin;
            // Of the power of two below a 255th.
            let mut exponent = (((extent / 255.0).to_bits() >> 52) as i32 - 1023).clamp(FINEST, COARSEST);
            while 255.0 * power_of_two(exponent) < extent && exponent < COARSEST {
                exponent += 1;
            }
            let step = power_of_two(exponent);
            let [low, high] = &mut seven.sides[axis];
            for (l, b) in boxes.clone().enumerate() {
                // Within 0 and 255 but for rounding.
                low[l] = ((f64::from(b.min[axis]) - origin) / step).floor() as u8;
                high[l] = ((f64::from(b.max[axis]) - origin) / step).ceil() as u8;
            }
            low[7] = (exponent + 127) as u8;
            seven.origin[axis] = all.min[axis];
        }
        seven.sides[INNER][1][7] = inner;
        seven.sides[USED][1][7] = used;
        seven
    }

    /// What a bundle enters within the limit, as a bit a lane, and where, rounded down.
    #[inline(always)]
    fn enter<O: Octet>(&self, bundle: &Bundle, limit: f32) -> (u8, [f32; 8]) {
        let (mut enter, mut leave) = (O::splat(0.0), O::splat(limit));
        for i in 0..3 {
            let (sides, side) = (&self.sides[i], bundle.near[i] & 1);
            let inverse = bundle.inverse[i];
            let step = O::splat(self.step(i) * inverse);
            let near = O::splat((self.origin[i] - bundle.origin[i][0]) * inverse);
            let far = O::splat((self.origin[i] - bundle.origin[i][1]) * inverse);
            enter = (O::from_bytes(&sides[side]) * step + near).max(enter);
            leave = (O::from_bytes(&sides[side ^ 1]) * step + far).min(leave);
        }
        let met = enter.le(leave * O::splat(Bundle::WIDER)) & self.used();
        (met, (enter * O::splat(2.0 - Bundle::WIDER)).store())
    }
}

/// 2 to the power of what an exponent of single precision can be.
fn power_of_two(exponent: i32) -> f64 {
    f64::from(f32::from_bits(((exponent + 127) as u32) << 23))
}

/// A tree of such nodes; the first is the root, and nodes come after those that hold them. It is for searches by rays.
#[derive(Clone, Debug)]
pub(super) struct PackedTree {
    nodes: Vec<Seven>,
    /// By node and lane: the first number of the leaf; in place of an eighth the second ones, in `COUNT_BITS` each.
    leaves: Vec<[u32; 8]>,
    all: Box32,
}

impl Default for PackedTree {
    fn default() -> Self {
        Self { nodes: Vec::new(), leaves: Vec::new(), all: Box32::EMPTY }
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
    pub fn build<T: Copy>(root: Part<T>, mut open: impl FnMut(T) -> [Part<T>; 2]) -> Self {
        let mut tree = Self { nodes: vec![Seven::VACANT], leaves: vec![[0; 8]], all: root.bounds };
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
            let (child, mut inner) = (tree.nodes.len(), 0);
            for (l, p) in parts.iter().enumerate() {
                match p.leaf {
                    Some((first, count)) => {
                        tree.leaves[node][l] = first;
                        tree.leaves[node][7] |= count << (COUNT_BITS * l);
                    }
                    None => {
                        waiting.push((child + inner, *p));
                        inner += 1;
                    }
                }
            }
            tree.nodes.resize(child + inner, Seven::VACANT);
            tree.leaves.resize(child + inner, [0; 8]);
            tree.nodes[node] = Seven::new(parts.iter().map(|p| &p.bounds), inner as u8, child as u32);
        }
        tree.nodes.shrink_to_fit();
        tree.leaves.shrink_to_fit();
        tree
    }

    /// Brings the boxes up to date. `leaf` gives that of a leaf.
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
        self.nodes.capacity() * size_of::<Seven>() + self.leaves.capacity() * size_of::<[u32; 8]>()
    }

    /// What a leaf holds, by number of node and lane.
    #[inline(always)]
    fn leaf(&self, at: u32) -> (u32, u32) {
        let (row, lane) = (&self.leaves[(at >> 3) as usize], at as usize & 7);
        (row[lane], row[7] >> (COUNT_BITS * lane) & ((1 << COUNT_BITS) - 1))
    }

    /// Calls `found` with what each leaf holds (its two numbers) that the bundle meets within the limit, nearer ones first as far as the boxes
    /// tell. `found` may lower the limit.
    #[inline]
    pub fn seek(&self, bundle: &Bundle, limit: &mut f64, found: impl FnMut(u32, u32, &mut f64)) {
        if self.nodes.is_empty() {
            return;
        }
        dispatch_octets(Seek { tree: self, bundle, limit, found });
    }
}

struct Seek<'a, F> {
    tree: &'a PackedTree,
    bundle: &'a Bundle,
    limit: &'a mut f64,
    found: F,
}

/// What has yet to be visited: where it is met in the upper half (as the bits of a positive number, whose order is that of
/// the numbers), in the lower half the number of a node, or with `LEAF` where a leaf is found.
type Target = u64;
const LEAF: u32 = 1 << 31;

impl<F: FnMut(u32, u32, &mut f64)> OctetKernel for Seek<'_, F> {
    type Out = ();

    #[inline(always)]
    fn run<O: Octet>(self) {
        let Self { tree, bundle, limit, mut found } = self;
        let mut near = Bundle::limit(*limit);
        let mut pending: Pending<Target> = Pending::new();
        let mut i = 0u32;
        loop {
            let node = &tree.nodes[i as usize];
            let (mut met, at) = node.enter::<O>(bundle, near);
            let target = |met: u8, at: &[f32; 8]| -> Target {
                let lane = met.trailing_zeros() & 7;
                let of =
                    if lane < u32::from(node.inner()) { node.child + lane } else { LEAF | i << 3 | lane };
                u64::from(at[lane as usize].to_bits()) << 32 | u64::from(of)
            };
            let mut next = None;
            if met != 0 {
                let mut first = target(met, &at);
                met &= met - 1;
                let bottom = pending.len();
                while met != 0 {
                    let other = target(met, &at);
                    met &= met - 1;
                    pending.push_sorted(first.max(other), bottom);
                    first = first.min(other);
                }
                next = Some(first);
            }
            loop {
                let (at, of) = match next.take().or_else(|| pending.pop()) {
                    Some(target) => (f32::from_bits((target >> 32) as u32), target as u32),
                    None => return,
                };
                if at > near {
                    continue;
                }
                if of & LEAF == 0 {
                    i = of;
                    break;
                }
                let (first, count) = tree.leaf(of & !LEAF);
                found(first, count, limit);
                near = Bundle::limit(*limit);
            }
        }
    }
}

#[cfg(test)]
mod tests;
