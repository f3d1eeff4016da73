//! The shape of the factor, and where the rows of each block go in it.

use super::ordering::Elimination;
use super::{NO_SPARSE_BODY, RowBlock};

/// No block, no column, no parent.
pub(crate) const NONE: u32 = u32::MAX;

/// The shape of the factor of one topology.
#[derive(Clone, Debug, Default)]
pub(crate) struct Symbolic {
    /// What it was made for.
    bodies: usize,
    ends: Vec<[u32; 2]>,
    /// Pairs of bodies that share rows: first the lower number, ascending, each once.
    edges: Vec<[u32; 2]>,
    /// The column of each body.
    pub place: Vec<u32>,
    /// Blocks below the diagonal, column by column: `column_start[c]..column_start[c + 1]`, rows ascending.
    pub column_start: Vec<u32>,
    pub row: Vec<u32>,
    /// The same blocks row by row: in which column, and at which place of the column-wise list.
    pub row_start: Vec<u32>,
    pub row_column: Vec<u32>,
    pub row_block: Vec<u32>,
    /// For each block of rows: the columns of its bodies, and the factor's block of the pair.
    pub columns: Vec<[u32; 2]>,
    pub pair: Vec<u32>,
}

impl Symbolic {
    pub fn columns_len(&self) -> usize {
        self.bodies
    }

    /// Whether this is the shape of these blocks of rows.
    pub fn fits(&self, bodies: usize, blocks: &[RowBlock]) -> bool {
        self.bodies == bodies
            && self.ends.len() == blocks.len()
            && self.ends.iter().zip(blocks).all(|(ends, block)| *ends == block.bodies)
    }

    /// Finds the shape. If only the number or order of the blocks of rows changed, the order of elimination stands.
    pub fn update(&mut self, bodies: usize, blocks: &[RowBlock], work: &mut SymbolicWork) {
        work.edges.clear();
        work.edges.extend(blocks.iter().filter_map(|block| {
            let [a, b] = block.bodies;
            (a != NO_SPARSE_BODY && b != NO_SPARSE_BODY).then(|| [a.min(b), a.max(b)])
        }));
        work.edges.sort_unstable();
        work.edges.dedup();
        if self.bodies != bodies || self.edges != work.edges {
            core::mem::swap(&mut self.edges, &mut work.edges);
            self.bodies = bodies;
            self.eliminate(work);
        }
        self.ends.clear();
        self.ends.extend(blocks.iter().map(|block| block.bodies));
        self.columns.clear();
        self.pair.clear();
        for ends in &self.ends {
            let columns = ends.map(|b| if b == NO_SPARSE_BODY { NONE } else { self.place[b as usize] });
            let pair = if columns.contains(&NONE) {
                NONE
            } else {
                let (c, r) = (columns[0].min(columns[1]) as usize, columns[0].max(columns[1]));
                let range = self.column_start[c] as usize..self.column_start[c + 1] as usize;
                // The pair is an edge, so its block is there.
                range.start as u32 + self.row[range].binary_search(&r).unwrap_or(0) as u32
            };
            self.columns.push(columns);
            self.pair.push(pair);
        }
    }

    fn eliminate(&mut self, work: &mut SymbolicWork) {
        let n = self.bodies;
        self.place.clear();
        self.place.resize(n, NONE);
        self.column_start.clear();
        self.column_start.push(0);
        self.row.clear();
        let mut next = 0;
        let Self { place, column_start, row, .. } = self;
        work.elimination.run(n, &self.edges, |body, rows| {
            place[body as usize] = next;
            next += 1;
            row.extend_from_slice(rows);
            column_start.push(row.len() as u32);
        });
        self.row_start.clear();
        self.row_start.resize(n + 2, 0);
        for c in 0..n {
            let range = self.column_start[c] as usize..self.column_start[c + 1] as usize;
            let rows = &mut self.row[range];
            for r in rows.iter_mut() {
                *r = self.place[*r as usize];
                self.row_start[*r as usize + 2] += 1;
            }
            rows.sort_unstable();
        }
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

    /// The column that a column's elimination touches first, its parent in the elimination tree.
    pub fn parent(&self, column: usize) -> Option<usize> {
        let range = self.column_start[column] as usize..self.column_start[column + 1] as usize;
        self.row[range].first().map(|r| *r as usize)
    }

    /// Blocks of the factor, the diagonal included.
    pub fn blocks(&self) -> usize {
        self.bodies + self.row.len()
    }
}

/// Memory for finding shapes.
#[derive(Clone, Debug, Default)]
pub(crate) struct SymbolicWork {
    elimination: Elimination,
    edges: Vec<[u32; 2]>,
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
    pub fn get(&mut self, hint: usize, bodies: usize, blocks: &[RowBlock]) -> &Symbolic {
        let fits = self.shapes.get(self.last).is_some_and(|shape| shape.fits(bodies, blocks));
        if !fits {
            self.last = hint % MOST_SHAPES;
            if self.shapes.len() <= self.last {
                self.shapes.resize_with(self.last + 1, Symbolic::default);
            }
            let shape = &mut self.shapes[self.last];
            if !shape.fits(bodies, blocks) {
                shape.update(bodies, blocks, &mut self.work);
            }
        }
        &self.shapes[self.last]
    }
}
