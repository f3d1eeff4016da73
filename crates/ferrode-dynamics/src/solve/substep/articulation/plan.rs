//! What is computed, block by block, for articulations of one shape whose joints have given numbers of rows.
//!
//! All blocks are of three rows and three columns, so that one short kernel without loops serves all: a ball is one such node of rows, a hinge
//! with what acts about its axis two. Joints with other numbers of rows are filled up with rows that do nothing.

use super::shape::Shape;

/// Rows of a node.
pub(super) const NODE: usize = 3;

/// A plan.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    /// Nodes of each joint, in the order of elimination.
    counts: Vec<u32>,
    /// First node of each joint, and the number of all.
    pub first: Vec<u32>,
    /// Where the blocks below the diagonal of each column begin in `rows`.
    pub start: Vec<u32>,
    /// Rows of these blocks, ascending within a column. Block k of this list is block `nodes + k` of the matrix; the blocks on
    /// the diagonal come first.
    pub rows: Vec<u32>,
    /// What each column takes from the blocks of later ones, column after column.
    pub updates: Vec<Update>,
    /// Where each column's updates begin.
    pub update_start: Vec<u32>,
    /// Blocks between joints that the matrix itself has.
    pub products: Vec<NodeProduct>,
    /// Blocks that only fill in.
    pub fill: Vec<u32>,
}

/// `target -= a D bᵀ`, with a and b among the blocks of a column.
#[derive(Clone, Copy, Debug)]
pub(super) struct Update {
    pub target: u32,
    pub a: u32,
    pub b: u32,
}

/// `target = J_a J_bᵀ`, with the Jacobians of two nodes for the body that their joints share.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeProduct {
    pub target: u32,
    /// It is added, since the joints share two bodies.
    pub again: bool,
    /// Joint, node within it, and which of its ends.
    pub a: (u32, u32, u8),
    pub b: (u32, u32, u8),
}

impl Plan {
    /// Makes the plan for a shape whose joints have so many nodes, unless it is that already. `fresh`: the shape is another one.
    pub fn prepare(&mut self, shape: &Shape, fresh: bool, counts: impl Iterator<Item = u32> + Clone) {
        if !fresh && self.counts.len() == shape.ends.len() && self.counts.iter().copied().eq(counts.clone()) {
            return;
        }
        *self = Self { counts: counts.collect(), ..Self::default() };
        self.first.push(0);
        let mut nodes = 0;
        for count in &self.counts {
            nodes += count;
            self.first.push(nodes);
        }
        self.start.push(0);
        for joint in 0..self.counts.len() {
            for node in self.first[joint]..self.first[joint + 1] {
                self.rows.extend(node + 1..self.first[joint + 1]);
                for row in &shape.rows[shape.start[joint] as usize..shape.start[joint + 1] as usize] {
                    self.rows.extend(self.first[*row as usize]..self.first[*row as usize + 1]);
                }
                self.start.push(self.rows.len() as u32);
            }
        }
        self.update_start.push(0);
        for column in 0..nodes as usize {
            let range = self.start[column]..self.start[column + 1];
            for b in range.clone() {
                for a in b..range.end {
                    let target = self.block(self.rows[a as usize], self.rows[b as usize]);
                    self.updates.push(Update { target, a: a - range.start, b: b - range.start });
                }
            }
            self.update_start.push(self.updates.len() as u32);
        }
        let mut written = vec![false; self.nodes() + self.rows.len()];
        for product in &shape.products {
            let (a, b) = (product.a, product.b);
            for i in 0..self.counts[a.0 as usize] {
                for j in 0..self.counts[b.0 as usize] {
                    let target = self.block(self.first[a.0 as usize] + i, self.first[b.0 as usize] + j);
                    let again = core::mem::replace(&mut written[target as usize], true);
                    self.products.push(NodeProduct { target, again, a: (a.0, i, a.1), b: (b.0, j, b.1) });
                }
            }
        }
        for joint in 0..self.counts.len() {
            for i in 0..self.counts[joint] as usize {
                for j in 0..=i {
                    let own = self.own(joint, i, j);
                    written[own] = true;
                }
            }
        }
        self.fill.extend((0..written.len()).filter(|block| !written[*block]).map(|block| block as u32));
    }

    /// The number of the block of nodes i and j ≤ i of a joint.
    pub fn own(&self, joint: usize, i: usize, j: usize) -> usize {
        let column = self.first[joint] as usize + j;
        // Rows of the same joint come first in a column.
        if i == j { column } else { self.nodes() + self.start[column] as usize + i - j - 1 }
    }

    /// The number of nodes.
    pub fn nodes(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// The number of a block of the lower triangle that is there.
    fn block(&self, row: u32, column: u32) -> u32 {
        if row == column {
            return row;
        }
        let range = self.start[column as usize] as usize..self.start[column as usize + 1] as usize;
        let at = self.rows[range.clone()].partition_point(|r| *r < row);
        (self.nodes() + range.start + at) as u32
    }
}
