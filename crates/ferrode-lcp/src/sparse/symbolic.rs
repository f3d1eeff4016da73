//! The shape of the factor, and where the rows of each block go in it.
//!
//! A column is a body's acceleration or a joint's forces. A light body, one that carries nothing but up to three joints, has none: its part
//! of the matrix is the unit matrix, so it is eliminated before all others in passing, which leaves products `J_i J_j^T` between
//! its joints.

use super::kernels::stride;
use super::ordering::{Elimination, Node};
use super::rows::MOST_OWN;
use super::{NO_SPARSE_BODY, RowBlock};

/// No block, no column, no parent.
pub(crate) const NONE: u32 = u32::MAX;
/// The most joints of a light body.
const MOST_JOINTS: usize = 3;
/// The most rows of a joint that get unknowns of their own.
const MOST_ROWS: u32 = MOST_OWN as u32;

/// Where a block of rows goes in the factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    /// The column of the rows' forces, or [`NONE`] if the rows are folded into their bodies' blocks.
    pub own: u32,
    /// The columns of the bodies, [`NONE`] where there is no body or a light one.
    pub columns: [u32; 2],
    /// Folded: the pair's block and [`NONE`]. Otherwise the block of the joint with each of the columns.
    pub at: [u32; 2],
}

/// Two joints at a light body, and their common block: the one eliminated later first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Coupling {
    pub blocks: [u32; 2],
    /// Which of its two bodies it is for each.
    pub sides: [u8; 2],
    pub at: u32,
}

/// A column, as who goes through them all wants it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Head {
    /// Where its numbers start, and where its unknowns are in a vector.
    pub start: u32,
    pub offset: u32,
    /// The blocks below the diagonal.
    pub first_below: u32,
    pub end_below: u32,
    /// Numbers in its unknown, 3 or 6.
    pub width: u8,
    /// The sign of its pivots.
    pub sign: f64,
}

impl Head {
    #[inline(always)]
    pub fn below(&self) -> core::ops::Range<usize> {
        self.first_below as usize..self.end_below as usize
    }
}

/// The row of a block below the diagonal: where its unknowns are in a vector, and how many.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Below {
    pub offset: u32,
    pub height: u8,
}

/// The shape of the factor of one topology.
#[derive(Clone, Debug, Default)]
pub(crate) struct Symbolic {
    /// What it was made for.
    bodies: usize,
    ends: Vec<[u32; 2]>,
    kinds: Vec<u8>,
    /// The unknowns and the pairs of them that share a number of the matrix: these decide the order of elimination.
    nodes: Vec<Node>,
    edges: Vec<[u32; 2]>,
    /// The column of each node.
    place: Vec<u32>,
    /// Numbers in each column's unknown, 3 or 6; 1 for bodies and -1 for joints, the sign of their pivots; where they start in a vector, in which
    /// three take four places.
    pub size: Vec<u8>,
    pub sign: Vec<f64>,
    pub offset: Vec<u32>,
    /// Where the numbers of each column start: diagonal block, rows of its factor's inverse, blocks below.
    pub start: Vec<u32>,
    /// Blocks below the diagonal, column by column: `column_start[c]..column_start[c + 1]`, rows ascending, and where their numbers are.
    pub column_start: Vec<u32>,
    pub row: Vec<u32>,
    pub at: Vec<u32>,
    /// The same once more, for going through them.
    pub heads: Vec<Head>,
    pub below: Vec<Below>,
    /// The same blocks row by row: in which column, and at which place of the column-wise list.
    pub row_start: Vec<u32>,
    pub row_column: Vec<u32>,
    pub row_block: Vec<u32>,
    /// For each block of rows.
    pub places: Vec<Place>,
    /// The columns of bodies; [`NONE`] for light ones.
    pub body_column: Vec<u32>,
    /// The joints of each light body, as blocks of rows.
    joints: Vec<[u32; MOST_JOINTS]>,
    pub couplings: Vec<Coupling>,
}

/// How many numbers of its own a block of rows has in the system: 0 if it is folded into its bodies' blocks. Joints have them;
/// contacts, which come many to a pair of bodies, and limits don't.
pub(crate) fn kind(block: &RowBlock, lo: &[f64], hi: &[f64]) -> u8 {
    let first = block.first as usize;
    let unbounded = block.count > 0 && lo[first] == f64::NEG_INFINITY && hi[first] == f64::INFINITY;
    match block.count {
        _ if !unbounded => 0,
        0..=3 => 3,
        4..=MOST_ROWS => 6,
        _ => 0,
    }
}

impl Symbolic {
    /// Whether this is the shape of these blocks of rows.
    pub fn fits(&self, bodies: usize, blocks: &[RowBlock], lo: &[f64], hi: &[f64]) -> bool {
        self.bodies == bodies
            && self.ends.len() == blocks.len()
            && self.ends.iter().zip(blocks).all(|(ends, block)| *ends == block.bodies)
            && self.kinds.iter().zip(blocks).all(|(have, block)| *have == kind(block, lo, hi))
    }

    /// Finds the shape. If only the number or order of the blocks of rows changed, the order of elimination stands.
    pub fn update(
        &mut self,
        bodies: usize,
        blocks: &[RowBlock],
        lo: &[f64],
        hi: &[f64],
        work: &mut SymbolicWork,
    ) {
        self.bodies = bodies;
        self.ends.clear();
        self.ends.extend(blocks.iter().map(|block| block.bodies));
        self.kinds.clear();
        self.kinds.extend(blocks.iter().map(|block| kind(block, lo, hi)));
        self.find_light_bodies();
        self.number(work);
        work.edges.sort_unstable();
        work.edges.dedup();
        if self.nodes != work.nodes || self.edges != work.edges {
            core::mem::swap(&mut self.nodes, &mut work.nodes);
            core::mem::swap(&mut self.edges, &mut work.edges);
            self.eliminate(work);
        }
        self.find_places(work);
    }

    /// Lists the joints of light bodies; the first entry of any other body's list stays [`NONE`], as does that of a body without rows.
    fn find_light_bodies(&mut self) {
        self.joints.clear();
        self.joints.resize(self.bodies, [NONE; MOST_JOINTS]);
        self.body_column.clear();
        // Meanwhile the number of joints.
        self.body_column.resize(self.bodies, 0);
        for (i, (ends, kind)) in self.ends.iter().zip(&self.kinds).enumerate() {
            for body in ends.iter().filter(|b| **b != NO_SPARSE_BODY).map(|b| *b as usize) {
                let count = &mut self.body_column[body];
                if *kind == 0 || *count as usize >= MOST_JOINTS {
                    *count = NONE;
                } else {
                    self.joints[body][*count as usize] = i as u32;
                    *count += 1;
                }
            }
        }
        for (joints, count) in self.joints.iter_mut().zip(&self.body_column) {
            if *count == NONE {
                *joints = [NONE; MOST_JOINTS];
            }
        }
    }

    /// Numbers the unknowns, heavy bodies first, and lists the pairs that share a number of the matrix.
    fn number(&mut self, work: &mut SymbolicWork) {
        let SymbolicWork { nodes, edges, of_block, .. } = work;
        nodes.clear();
        edges.clear();
        of_block.clear();
        for count in &mut self.body_column {
            if *count == NONE {
                *count = nodes.len() as u32;
                nodes.push(Node::free(6));
            } else {
                *count = NONE;
            }
        }
        for (ends, kind) in self.ends.iter().zip(&self.kinds) {
            let of_body = |b: u32| if b == NO_SPARSE_BODY { NONE } else { self.body_column[b as usize] };
            let bodies = ends.map(of_body);
            if *kind == 0 {
                of_block.push(NONE);
                if bodies[0] != NONE && bodies[1] != NONE {
                    edges.push([bodies[0].min(bodies[1]), bodies[0].max(bodies[1])]);
                }
                continue;
            }
            let own = nodes.len() as u32;
            of_block.push(own);
            edges.extend(bodies.iter().filter(|b| **b != NONE).map(|b| [*b, own]));
            // With a light body it need not wait, nor without any.
            let light = (0..2).any(|s| ends[s] != NO_SPARSE_BODY && bodies[s] == NONE);
            let [a, b] = bodies;
            let after = match (a, b) {
                _ if light => [NONE; 2],
                (NONE, b) => [b, b],
                (a, NONE) => [a, a],
                both => [both.0, both.1],
            };
            nodes.push(Node { size: *kind, after });
        }
        for joints in &self.joints {
            each_pair(joints, |i, j| {
                let pair = [of_block[i as usize], of_block[j as usize]];
                edges.push([pair[0].min(pair[1]), pair[0].max(pair[1])]);
            });
        }
    }

    fn eliminate(&mut self, work: &mut SymbolicWork) {
        let n = self.nodes.len();
        self.place.clear();
        self.place.resize(n, NONE);
        for v in [&mut self.column_start, &mut self.row, &mut self.at, &mut self.start, &mut self.offset] {
            v.clear();
        }
        self.size.clear();
        self.sign.clear();
        self.column_start.push(0);
        let mut next = 0;
        let Self { place, column_start, row, nodes, size, .. } = self;
        work.elimination.run(nodes, &self.edges, |node, rows| {
            place[node as usize] = next;
            next += 1;
            row.extend_from_slice(rows);
            column_start.push(row.len() as u32);
            size.push(nodes[node as usize].size);
        });
        self.row_start.clear();
        self.row_start.resize(n + 2, 0);
        let (mut start, mut offset) = (0, 0);
        for c in 0..n {
            let range = self.column_start[c] as usize..self.column_start[c + 1] as usize;
            let rows = &mut self.row[range];
            for r in rows.iter_mut() {
                *r = self.place[*r as usize];
                self.row_start[*r as usize + 2] += 1;
            }
            rows.sort_unstable();
            let padded = |size: u8| stride(usize::from(size)) as u32;
            let width = u32::from(self.size[c]);
            self.offset.push(offset);
            self.start.push(start);
            offset += padded(self.size[c]);
            start += 2 * width * padded(self.size[c]);
            for r in rows {
                self.at.push(start);
                start += width * padded(self.size[*r as usize]);
            }
        }
        self.offset.push(offset);
        self.start.push(start);
        for r in 2..n + 2 {
            self.row_start[r] += self.row_start[r - 1];
        }
        self.row_column.clear();
        self.row_column.resize(self.row.len(), 0);
        self.row_block.clear();
        self.row_block.resize(self.row.len(), 0);
        for c in 0..n {
            for block in self.column_start[c]..self.column_start[c + 1] {
                let next = &mut self.row_start[self.row[block as usize] as usize + 1];
                self.row_column[*next as usize] = c as u32;
                self.row_block[*next as usize] = block;
                *next += 1;
            }
        }
    }

    fn find_places(&mut self, work: &SymbolicWork) {
        self.places.clear();
        self.couplings.clear();
        for column in self.body_column.iter_mut().filter(|column| **column != NONE) {
            *column = self.place[*column as usize];
        }
        self.sign.resize(self.nodes.len(), 1.0);
        for (ends, node) in self.ends.iter().zip(&work.of_block) {
            let of_body = |b: u32| if b == NO_SPARSE_BODY { NONE } else { self.body_column[b as usize] };
            let columns = ends.map(of_body);
            let place = if *node == NONE {
                Place { own: NONE, columns, at: [self.block(columns[0], columns[1]), NONE] }
            } else {
                let own = self.place[*node as usize];
                self.sign[own as usize] = -1.0;
                Place { own, columns, at: columns.map(|c| self.block(c, own)) }
            };
            self.places.push(place);
        }
        self.heads.clear();
        self.heads.extend((0..self.nodes.len()).map(|c| Head {
            start: self.start[c],
            offset: self.offset[c],
            first_below: self.column_start[c],
            end_below: self.column_start[c + 1],
            width: self.size[c],
            sign: self.sign[c],
        }));
        self.below.clear();
        self.below.extend(self.row.iter().map(|r| {
            let r = *r as usize;
            Below { offset: self.offset[r], height: self.size[r] }
        }));
        let mut couplings = core::mem::take(&mut self.couplings);
        for (body, joints) in self.joints.iter().enumerate() {
            each_pair(joints, |i, j| {
                let [a, b] = [i, j].map(|i| self.places[i as usize].own);
                let blocks = if a > b { [i, j] } else { [j, i] };
                let sides = blocks.map(|i| u8::from(self.ends[i as usize][1] as usize == body));
                couplings.push(Coupling { blocks, sides, at: self.block(a, b) });
            });
        }
        self.couplings = couplings;
    }

    /// The place in the list of blocks of the block of two columns; [`NONE`] if one of them is.
    fn block(&self, a: u32, b: u32) -> u32 {
        if a == NONE || b == NONE {
            return NONE;
        }
        let (c, r) = (a.min(b) as usize, a.max(b));
        let range = self.column_start[c] as usize..self.column_start[c + 1] as usize;
        // The pair is an edge, so its block is there.
        range.start as u32 + self.row[range].binary_search(&r).unwrap_or(0) as u32
    }

    /// Calls `f` with columns such that all numbers that the rows of a block enter into are in these and the columns to the root.
    pub fn for_each_touched(&self, block: usize, mut f: impl FnMut(u32)) {
        let place = &self.places[block];
        for (column, body) in place.columns.iter().zip(self.ends[block]) {
            if *column != NONE {
                f(*column);
            } else if body != NO_SPARSE_BODY {
                let joints = self.joints[body as usize].iter().filter(|j| **j != NONE);
                joints.for_each(|j| f(self.places[*j as usize].own));
            }
        }
        if place.own != NONE {
            f(place.own);
        }
    }

    /// The column that a column's elimination touches first, its parent in the elimination tree.
    pub fn parent(&self, column: usize) -> Option<usize> {
        let range = self.column_start[column] as usize..self.column_start[column + 1] as usize;
        self.row[range].first().map(|r| *r as usize)
    }

    pub fn bodies(&self) -> usize {
        self.bodies
    }

    pub fn columns(&self) -> usize {
        self.nodes.len()
    }

    /// Numbers in the factor.
    pub fn numbers(&self) -> usize {
        self.start.last().map_or(0, |n| *n as usize)
    }

    /// Blocks of the factor, the diagonal included.
    pub fn blocks(&self) -> usize {
        self.nodes.len() + self.row.len()
    }
}

fn each_pair(joints: &[u32; MOST_JOINTS], mut f: impl FnMut(u32, u32)) {
    for (i, a) in joints.iter().enumerate().filter(|(_, a)| **a != NONE) {
        joints[i + 1..].iter().filter(|b| **b != NONE).for_each(|b| f(*a, *b));
    }
}

/// Memory for finding shapes.
#[derive(Clone, Debug, Default)]
pub(crate) struct SymbolicWork {
    elimination: Elimination,
    nodes: Vec<Node>,
    edges: Vec<[u32; 2]>,
    /// The node of each block of rows.
    of_block: Vec<u32>,
}

/// Shapes that were found, each under a number of the caller's.
#[derive(Clone, Debug, Default)]
pub(crate) struct SymbolicCache {
    shapes: Vec<Symbolic>,
    last: usize,
    work: SymbolicWork,
}

/// The most shapes that are kept.
const MOST_SHAPES: usize = 1024;

impl SymbolicCache {
    /// The shape of these blocks of rows: the one used last if it fits (equal robots come one after the other), or the one under
    /// `hint`, brought up to date.
    pub fn get(
        &mut self,
        hint: usize,
        bodies: usize,
        blocks: &[RowBlock],
        lo: &[f64],
        hi: &[f64],
    ) -> &Symbolic {
        let fits = self.shapes.get(self.last).is_some_and(|shape| shape.fits(bodies, blocks, lo, hi));
        if !fits {
            self.last = hint % MOST_SHAPES;
            if self.shapes.len() <= self.last {
                self.shapes.resize_with(self.last + 1, Symbolic::default);
            }
            let shape = &mut self.shapes[self.last];
            if !shape.fits(bodies, blocks, lo, hi) {
                shape.update(bodies, blocks, lo, hi, &mut self.work);
            }
        }
        &self.shapes[self.last]
    }
}
