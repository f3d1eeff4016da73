//! Trees of four boxes to a node, which searches test at once.

use super::f32_box::{Box32, Pending};
use super::probe::{Probe, RayLanes};
use ferrode_math::simd::overlapping;

/// Four boxes side by side, and what each holds: two cache lines, which processors fetch together.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(128))]
pub(crate) struct Four {
    /// Along each axis the lower sides of the four, then the upper ones.
    pub sides: [[[f32; 4]; 2]; 3],
    /// Another node, or of a leaf what its tree says; and how many items are in a leaf: zero for a node, and for nothing.
    held: [(u32, u32); 4],
}

const _: () = assert!(size_of::<Four>() == 128);

/// The link of nothing.
const NONE: u32 = u32::MAX;

impl Four {
    /// Boxes that overlap nothing.
    const VACANT: Self =
        Self { sides: [[[f32::INFINITY; 4], [f32::NEG_INFINITY; 4]]; 3], held: [(NONE, 0); 4] };

    #[inline(always)]
    pub fn bounds(&self, l: usize) -> Box32 {
        Box32 { min: self.sides.map(|s| s[0][l & 3]), max: self.sides.map(|s| s[1][l & 3]) }
    }

    /// Link and count.
    #[inline(always)]
    pub fn holds(&self, l: usize) -> (u32, u32) {
        self.held[l & 3]
    }

    pub fn is_vacant(&self, l: usize) -> bool {
        self.holds(l) == (NONE, 0)
    }

    fn set(&mut self, l: usize, b: &Box32, link: u32, count: u32) {
        self.set_bounds(l, b);
        self.held[l] = (link, count);
    }

    fn set_bounds(&mut self, l: usize, b: &Box32) {
        for k in 0..3 {
            self.sides[k][0][l] = b.min[k];
            self.sides[k][1][l] = b.max[k];
        }
    }

    /// The box around all four.
    fn joint(&self) -> Box32 {
        (1..4).fold(self.bounds(0), |all, l| all.union(&self.bounds(l)))
    }

    /// Which of the four overlap a box, a bit for each.
    #[inline(always)]
    fn overlaps(&self, b: &Box32) -> u8 {
        overlapping(&self.sides, &b.min, &b.max)
    }
}

/// A part of a tree that is being built.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<T> {
    pub bounds: Box32,
    /// Items, if it is a leaf.
    pub leaf: Option<(u32, u32)>,
    /// What its tree needs to take it apart.
    pub of: T,
}

/// A tree of such nodes; the first is the root, and nodes come after those that hold them.
#[derive(Clone, Debug, Default)]
pub(crate) struct WideTree {
    nodes: Vec<Four>,
}

impl WideTree {
    /// Builds the tree anew. `open` takes a part that is no leaf into its two halves. Leaves keep their order.
    pub fn build<T: Copy>(&mut self, root: Part<T>, mut open: impl FnMut(T) -> [Part<T>; 2]) {
        self.nodes.clear();
        self.nodes.push(Four::VACANT);
        let mut waiting = vec![(0usize, root)];
        while let Some((node, part)) = waiting.pop() {
            let mut parts = [part; 4];
            let mut count = 1;
            while count < 4 {
                // The largest is opened, for it is met most often.
                let mut largest = None;
                for (k, p) in parts[..count].iter().enumerate() {
                    if p.leaf.is_none() && largest.is_none_or(|(_, area)| p.bounds.area() > area) {
                        largest = Some((k, p.bounds.area()));
                    }
                }
                let Some((k, _)) = largest else { break };
                let [a, b] = open(parts[k].of);
                parts.copy_within(k + 1..count, k + 2);
                (parts[k], parts[k + 1]) = (a, b);
                count += 1;
            }
            for (l, p) in parts[..count].iter().enumerate() {
                let (link, number) = p.leaf.unwrap_or_else(|| {
                    self.nodes.push(Four::VACANT);
                    waiting.push((self.nodes.len() - 1, *p));
                    (self.nodes.len() as u32 - 1, 0)
                });
                self.nodes[node].set(l, &p.bounds, link, number);
            }
        }
    }

    /// Brings the boxes up to date. `leaf` gives that of a leaf.
    pub fn refit(&mut self, leaf: impl Fn(u32, u32) -> Box32) {
        for i in (0..self.nodes.len()).rev() {
            for l in 0..4 {
                let (link, count) = self.nodes[i].holds(l);
                if count > 0 {
                    self.nodes[i].set_bounds(l, &leaf(link, count));
                } else if link != NONE {
                    let bounds = self.nodes[link as usize].joint();
                    self.nodes[i].set_bounds(l, &bounds);
                }
            }
        }
    }

    pub fn shrink_to_fit(&mut self) {
        self.nodes.shrink_to_fit();
    }

    /// Bytes in use.
    pub fn size(&self) -> usize {
        self.nodes.capacity() * size_of::<Four>()
    }

    /// Calls `found` with link and count of each leaf whose box overlaps `around`, in the order of the leaves.
    #[inline]
    pub fn query(&self, around: &Box32, mut found: impl FnMut(u32, u32)) {
        let mut pending: Pending<(u32, u32), 32> = Pending::new();
        let Some(mut node) = self.nodes.first() else { return };
        // What has no end would overlap what is vacant.
        let around = Box32 {
            min: around.min.map(|x| if x < f32::MIN { f32::MIN } else { x }),
            max: around.max.map(|x| if x > f32::MAX { f32::MAX } else { x }),
        };
        loop {
            pending.push_set(node.overlaps(&around), &node.held);
            loop {
                let Some((link, count)) = pending.pop() else { return };
                if count == 0 {
                    node = &self.nodes[link as usize];
                    break;
                }
                found(link, count);
            }
        }
    }

    /// Calls `found` with link and count of each leaf that the probe meets within the limit, nearer ones first as far as the
    /// boxes tell. `found` may lower the limit.
    #[inline]
    pub fn seek(&self, probe: &Probe, limit: &mut f64, found: impl FnMut(u32, u32, &mut f64)) {
        let Some(root) = self.nodes.first() else { return };
        match probe.lanes(&root.joint()) {
            Some(lanes) => self.seek_by(limit, found, |four, _, near| lanes.enter_four(four, near)),
            None => self.seek_by(limit, found, |four, limit, _| probe.enter_four(four, limit)),
        }
    }

    /// `enter` gives for a node, the limit and the limit in single precision the [`Entry`] of each of the four.
    #[inline(always)]
    fn seek_by(
        &self,
        limit: &mut f64,
        mut found: impl FnMut(u32, u32, &mut f64),
        enter: impl Fn(&Four, f64, f32) -> [Entry; 4],
    ) {
        let mut pending: Pending<(u32, Entry)> = Pending::new();
        let mut near = RayLanes::limit(*limit);
        let mut i = 0;
        loop {
            let [first, second, third, last] = in_order(enter(&self.nodes[i as usize], *limit, near));
            // Those that are not met come last.
            pending.push_if(last.is_met(), (i, last));
            pending.push_if(third.is_met(), (i, third));
            pending.push_if(second.is_met(), (i, second));
            let mut next = first.is_met().then_some((i, first));
            loop {
                let (node, entry) = match next.take() {
                    Some(next) => next,
                    None => match pending.pop() {
                        Some(waiting) if waiting.1.at() <= near => waiting,
                        Some(_) => continue,
                        None => return,
                    },
                };
                let (link, count) = self.nodes[node as usize].holds(entry.lane());
                if count == 0 {
                    i = link;
                    break;
                }
                found(link, count, limit);
                near = RayLanes::limit(*limit);
            }
        }
    }
}

/// Where one of four boxes is met, and which it is: the bits of a positive number in single precision, whose order is that
/// of the numbers, with the lane in place of the last two.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Entry(u32);

impl Entry {
    pub const MISSED: Self = Self(u32::MAX);

    /// `at` must not be negative.
    #[inline(always)]
    pub fn new(at: f32, lane: usize) -> Self {
        Self((at.to_bits() & !3) | lane as u32)
    }

    #[inline(always)]
    fn is_met(self) -> bool {
        self != Self::MISSED
    }

    /// Rounded down by the bits that tell the lane.
    #[inline(always)]
    fn at(self) -> f32 {
        f32::from_bits(self.0 & !3)
    }

    #[inline(always)]
    fn lane(self) -> usize {
        (self.0 & 3) as usize
    }
}

/// Sorts without branches.
#[inline(always)]
fn in_order([a, b, c, d]: [Entry; 4]) -> [Entry; 4] {
    let (a, b) = (a.min(b), a.max(b));
    let (c, d) = (c.min(d), c.max(d));
    let (a, c) = (a.min(c), a.max(c));
    let (b, d) = (b.min(d), b.max(d));
    [a, b.min(c), b.max(c), d]
}
