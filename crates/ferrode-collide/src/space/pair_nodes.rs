//! Nodes of binary trees, two siblings to a cache line and side by side in it, so that searches test both at once.

use super::f32_box::Box32;

/// Two siblings: node 2k is lane 0 of pair k, node 2k + 1 is lane 1.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct PairNode {
    /// Along each axis the lower sides of both, then the upper ones.
    pub sides: [[[f32; 2]; 2]; 3],
    link: [u32; 2],
    tag: [u32; 2],
}

const _: () = assert!(size_of::<PairNode>() == 64);

/// One node: its box and two numbers whose meaning is the tree's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub bounds: Box32,
    pub link: u32,
    pub tag: u32,
}

impl PairNode {
    #[inline(always)]
    pub fn bounds(&self, l: usize) -> Box32 {
        Box32 { min: self.sides.map(|s| s[0][l]), max: self.sides.map(|s| s[1][l]) }
    }

    /// Which of the two boxes overlap `b`.
    #[inline(always)]
    pub fn overlaps(&self, b: &Box32) -> [bool; 2] {
        let mut hit = [true; 2];
        for i in 0..3 {
            for (l, hit) in hit.iter_mut().enumerate() {
                *hit &= (self.sides[i][0][l] <= b.max[i]) & (self.sides[i][1][l] >= b.min[i]);
            }
        }
        hit
    }
}

/// All nodes of a tree.
#[derive(Clone, Debug, Default)]
pub(crate) struct Nodes {
    pairs: Vec<PairNode>,
}

impl Nodes {
    const VACANT: PairNode = PairNode {
        sides: [[[f32::INFINITY; 2], [f32::NEG_INFINITY; 2]]; 3],
        link: [u32::MAX; 2],
        tag: [u32::MAX; 2],
    };

    pub fn clear(&mut self) {
        self.pairs.clear();
    }

    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Adds a pair of nodes that overlap nothing, and returns the first.
    pub fn add_pair(&mut self) -> u32 {
        self.pairs.push(Self::VACANT);
        2 * (self.pairs.len() as u32 - 1)
    }

    /// The pair whose first node is `i`.
    #[inline(always)]
    pub fn pair(&self, i: u32) -> &PairNode {
        &self.pairs[(i >> 1) as usize]
    }

    #[inline(always)]
    pub fn get(&self, i: u32) -> Node {
        let (p, l) = (self.pair(i), (i & 1) as usize);
        Node { bounds: p.bounds(l), link: p.link[l], tag: p.tag[l] }
    }

    #[inline(always)]
    pub fn bounds(&self, i: u32) -> Box32 {
        self.pair(i).bounds((i & 1) as usize)
    }

    /// The two numbers of a node.
    #[inline(always)]
    pub fn numbers(&self, i: u32) -> (u32, u32) {
        let (p, l) = (self.pair(i), (i & 1) as usize);
        (p.link[l], p.tag[l])
    }

    /// The box around both nodes of a pair.
    #[inline(always)]
    pub fn joint(&self, i: u32) -> Box32 {
        let p = self.pair(i);
        p.bounds(0).union(&p.bounds(1))
    }

    #[inline(always)]
    pub fn set_bounds(&mut self, i: u32, b: &Box32) {
        let (p, l) = (&mut self.pairs[(i >> 1) as usize], (i & 1) as usize);
        for k in 0..3 {
            p.sides[k][0][l] = b.min[k];
            p.sides[k][1][l] = b.max[k];
        }
    }

    #[inline(always)]
    pub fn set_link(&mut self, i: u32, link: u32) {
        self.pairs[(i >> 1) as usize].link[(i & 1) as usize] = link;
    }

    #[inline(always)]
    pub fn set(&mut self, i: u32, node: Node) {
        self.set_bounds(i, &node.bounds);
        let (p, l) = (&mut self.pairs[(i >> 1) as usize], (i & 1) as usize);
        (p.link[l], p.tag[l]) = (node.link, node.tag);
    }
}
