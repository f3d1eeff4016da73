//! The numbers of the factor: `K = L D L^T` in blocks of 3 or 6 rows and columns, `D` the signs of the columns, column by column from the left.
//!
//! Column `c` is made from column `c` of `K` and the columns `k < c` in which row `c` has a block:
//!
//! ```text
//!     d_c L_cc L_cc^T = K_cc - sum_k d_k L_ck L_ck^T          L_rc = (K_rc - sum_k d_k L_rk L_ck^T) L_cc^-T
//! ```
//!
//! (in which `L_rc` lacks the factor `d_c`, which is put back where it is used). It reads only its descendants in the elimination tree. So
//! when some blocks of `K` change, the columns on the paths from these to the root are made anew, by the same operations in the same
//! order as from scratch, to the same bits.

use super::kernels::{
    Block, backward, by_sizes, cholesky, forward, solve_right, sub_aat, sub_abt, sub_mul, sub_mul_transposed,
};
use super::symbolic::{NONE, Symbolic};

/// The factor.
#[derive(Clone, Debug, Default)]
pub(crate) struct Factor {
    /// Column after column: the lower triangle of `L_cc`, the inverses of its diagonal, the blocks `L_rc` below.
    pub values: Vec<f64>,
    /// Columns to be made.
    stale: Vec<bool>,
    any_stale: bool,
    /// For each row where the block of the present column is, counted from the column's start.
    position: Vec<u32>,
    /// Pivots that were not positive and had to be replaced: in the last [`Factor::factorise`].
    pub replaced: u32,
}

impl Factor {
    /// Sizes the factor for a shape; everything is stale.
    pub fn reset(&mut self, shape: &Symbolic) {
        let n = shape.columns();
        self.values.resize(shape.numbers(), 0.0);
        self.position.resize(n, NONE);
        self.stale.clear();
        self.stale.resize(n, true);
        self.any_stale = true;
    }

    /// Has a column made again, with all that depend on it.
    pub fn invalidate(&mut self, column: u32, shape: &Symbolic) {
        self.any_stale = true;
        let mut next = (column != NONE).then_some(column as usize);
        while let Some(c) = next
            && !self.stale[c]
        {
            self.stale[c] = true;
            next = shape.parent(c);
        }
    }

    pub fn is_stale(&self, column: u32) -> bool {
        column != NONE && self.stale[column as usize]
    }

    /// Sets the stale columns to those of the unit matrix with the signs of the columns, to which blocks are then added.
    pub fn clear_stale(&mut self, shape: &Symbolic) {
        for c in 0..shape.columns() {
            if self.stale[c] {
                let (own, width) = (shape.start[c] as usize, usize::from(shape.size[c]));
                self.values[own..shape.start[c + 1] as usize].fill(0.0);
                for i in 0..width {
                    self.values[own + (width + 1) * i] = shape.sign[c];
                }
            }
        }
    }

    /// Adds to the diagonal block of a body's column.
    pub fn add_diagonal(&mut self, column: u32, shape: &Symbolic, block: &Block) {
        add(&mut self.values[shape.start[column as usize] as usize..], block);
    }

    /// Adds to a block of two bodies below the diagonal.
    pub fn add_below(&mut self, at: u32, shape: &Symbolic, block: &Block) {
        add(&mut self.values[shape.at[at as usize] as usize..], block);
    }

    /// Makes the stale columns.
    pub fn factorise(&mut self, shape: &Symbolic) {
        self.replaced = 0;
        for c in 0..shape.columns() {
            if !core::mem::replace(&mut self.stale[c], false) {
                continue;
            }
            let range = shape.column_start[c] as usize..shape.column_start[c + 1] as usize;
            let start = shape.start[c];
            // Blocks of earlier columns come before this column's own.
            let (earlier, own) = self.values.split_at_mut(start as usize);
            let width = shape.size[c];
            let sources = shape.row_start[c] as usize..shape.row_start[c + 1] as usize;
            if !sources.is_empty() {
                for block in range.clone() {
                    self.position[shape.row[block] as usize] = shape.at[block] - start;
                }
            }
            for source in sources {
                let first = shape.row_block[source] as usize;
                let k = shape.row_column[source] as usize;
                let (depth, sign) = (shape.size[k], shape.sign[k]);
                let factor = &earlier[shape.at[first] as usize..];
                by_sizes!(sub_aat, [width, depth], (own, factor, sign));
                for block in first + 1..shape.column_start[k + 1] as usize {
                    let row = shape.row[block] as usize;
                    let target = &mut own[self.position[row] as usize..];
                    let other = &earlier[shape.at[block] as usize..];
                    by_sizes!(sub_abt, [shape.size[row], width, depth], (target, other, factor, sign));
                }
            }
            let (diagonal, rest) = own.split_at_mut(usize::from(width) * usize::from(width));
            self.replaced += by_sizes!(cholesky, [width], (diagonal, rest, shape.sign[c]));
            let (inverse, mut rest) = rest.split_at_mut(usize::from(width));
            for row in &shape.row[range] {
                let height = shape.size[*row as usize];
                by_sizes!(solve_right, [height, width], (rest, diagonal, inverse));
                rest = &mut rest[usize::from(height) * usize::from(width)..];
            }
        }
        self.any_stale = false;
    }

    /// `x = K^-1 x`, `x` by columns.
    pub fn solve(&self, shape: &Symbolic, x: &mut [f64]) {
        let n = shape.columns();
        for c in 0..n {
            let (own, width) = (&self.values[shape.start[c] as usize..], shape.size[c]);
            let (diagonal, rest) = own.split_at(usize::from(width) * usize::from(width));
            let (inverse, mut rest) = rest.split_at(usize::from(width));
            let (head, tail) = x.split_at_mut(shape.offset[c + 1] as usize);
            let own = &mut head[shape.offset[c] as usize..];
            by_sizes!(forward, [width], (own, diagonal, inverse));
            for block in shape.column_start[c] as usize..shape.column_start[c + 1] as usize {
                let row = shape.row[block] as usize;
                let height = shape.size[row];
                let target = &mut tail[(shape.offset[row] - shape.offset[c + 1]) as usize..];
                by_sizes!(sub_mul, [height, width], (target, rest, own, shape.sign[c]));
                rest = &rest[usize::from(height) * usize::from(width)..];
            }
        }
        for c in (0..n).rev() {
            let (own, width) = (&self.values[shape.start[c] as usize..], shape.size[c]);
            let (diagonal, rest) = own.split_at(usize::from(width) * usize::from(width));
            let (inverse, mut rest) = rest.split_at(usize::from(width));
            let (head, tail) = x.split_at_mut(shape.offset[c + 1] as usize);
            let own = &mut head[shape.offset[c] as usize..];
            for block in shape.column_start[c] as usize..shape.column_start[c + 1] as usize {
                let row = shape.row[block] as usize;
                let height = shape.size[row];
                let source = &tail[(shape.offset[row] - shape.offset[c + 1]) as usize..];
                by_sizes!(sub_mul_transposed, [height, width], (own, rest, source));
                rest = &rest[usize::from(height) * usize::from(width)..];
            }
            by_sizes!(backward, [width], (own, diagonal, inverse, shape.sign[c]));
        }
    }
}

#[inline(always)]
fn add(to: &mut [f64], block: &Block) {
    for (to, x) in to[..36].iter_mut().zip(block) {
        *to += x;
    }
}
