//! The numbers of the factor: `H = L L^T` in blocks of 6x6, column by column from the left.
//!
//! Column `c` is made from column `c` of `H` and the columns `k < c` in which row `c` has a block:
//!
//! ```text
//!     L_cc L_cc^T = H_cc - sum_k L_ck L_ck^T          L_rc = (H_rc - sum_k L_rk L_ck^T) L_cc^-T
//! ```
//!
//! It reads only its descendants in the elimination tree. So when some bodies' blocks of `H` change, the columns on the paths from
//! these to the root are made anew, by the same operations in the same order as from scratch, to the same bits.

use super::kernel6::{self, Block, Six};
use super::symbolic::{NONE, Symbolic};

/// The factor.
#[derive(Clone, Debug, Default)]
pub(crate) struct Factor {
    /// `L_cc`, lower triangle, and the inverses of its diagonal.
    diagonal: Vec<Block>,
    inverse: Vec<Six>,
    /// `L_rc` in the order of [`Symbolic::row`].
    below: Vec<Block>,
    /// Columns to be made.
    stale: Vec<bool>,
    /// For each row the block of the present column, where the column has one.
    position: Vec<u32>,
    /// Pivots that were not positive and had to be replaced: in the last [`Factor::factorise`].
    pub replaced: u32,
}

impl Factor {
    /// Sizes the factor for a shape; everything is stale.
    pub fn reset(&mut self, shape: &Symbolic) {
        let n = shape.columns_len();
        self.diagonal.resize(n, [0.0; 36]);
        self.inverse.resize(n, [0.0; 6]);
        self.below.resize(shape.row.len(), [0.0; 36]);
        self.position.clear();
        self.position.resize(n, NONE);
        self.stale.clear();
        self.stale.resize(n, true);
    }

    /// Has a column made again, with all that depend on it.
    pub fn invalidate(&mut self, column: u32, shape: &Symbolic) {
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

    /// Sets the stale columns to those of the unit matrix, to which blocks are then added.
    pub fn clear_stale(&mut self, shape: &Symbolic) {
        for c in 0..shape.columns_len() {
            if self.stale[c] {
                let block = &mut self.diagonal[c];
                *block = [0.0; 36];
                for i in 0..6 {
                    block[7 * i] = 1.0;
                }
                self.below[shape.column_start[c] as usize..shape.column_start[c + 1] as usize]
                    .fill([0.0; 36]);
            }
        }
    }

    /// Adds to the diagonal block of a column.
    pub fn add_diagonal(&mut self, column: u32, block: &Block) {
        add(&mut self.diagonal[column as usize], block);
    }

    /// Adds to a block below the diagonal.
    pub fn add_below(&mut self, at: u32, block: &Block) {
        add(&mut self.below[at as usize], block);
    }

    /// Makes the stale columns.
    pub fn factorise(&mut self, shape: &Symbolic) {
        self.replaced = 0;
        for c in 0..shape.columns_len() {
            if !core::mem::replace(&mut self.stale[c], false) {
                continue;
            }
            let range = shape.column_start[c] as usize..shape.column_start[c + 1] as usize;
            for block in range.clone() {
                self.position[shape.row[block] as usize] = block as u32;
            }
            // Blocks of earlier columns come before this column's own.
            let (earlier, own) = self.below.split_at_mut(range.start);
            let diagonal = &mut self.diagonal[c];
            for at in shape.row_start[c] as usize..shape.row_start[c + 1] as usize {
                let first = shape.row_block[at] as usize;
                let end = shape.column_start[shape.row_column[at] as usize + 1] as usize;
                let factor = &earlier[first];
                kernel6::sub_abt(diagonal, factor, factor);
                for (block, row) in earlier[first + 1..end].iter().zip(&shape.row[first + 1..end]) {
                    let target = self.position[*row as usize] as usize - range.start;
                    kernel6::sub_abt(&mut own[target], block, factor);
                }
            }
            self.replaced += kernel6::cholesky(diagonal, &mut self.inverse[c], 1.0);
            for block in &mut own[..range.len()] {
                kernel6::solve_right(block, diagonal, &self.inverse[c]);
            }
        }
    }

    /// `x = H^-1 x`.
    pub fn solve(&self, shape: &Symbolic, x: &mut [Six]) {
        let n = shape.columns_len();
        for c in 0..n {
            let (head, tail) = x.split_at_mut(c + 1);
            let own = &mut head[c];
            kernel6::forward(own, &self.diagonal[c], &self.inverse[c]);
            for block in shape.column_start[c] as usize..shape.column_start[c + 1] as usize {
                let row = shape.row[block] as usize - c - 1;
                kernel6::sub_mul(&mut tail[row], &self.below[block], own);
            }
        }
        for c in (0..n).rev() {
            let (head, tail) = x.split_at_mut(c + 1);
            let own = &mut head[c];
            for block in shape.column_start[c] as usize..shape.column_start[c + 1] as usize {
                let row = shape.row[block] as usize - c - 1;
                kernel6::sub_mul_transposed(own, &self.below[block], &tail[row]);
            }
            kernel6::backward(own, &self.diagonal[c], &self.inverse[c]);
        }
    }
}

#[inline(always)]
fn add(to: &mut Block, block: &Block) {
    for (to, x) in to.iter_mut().zip(block) {
        *to += x;
    }
}
