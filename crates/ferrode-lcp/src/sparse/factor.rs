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

use super::kernels::{Block, Column, by_sizes, cholesky, solve_right, stride, sub_aat, sub_abt, sub_mul};
use super::symbolic::{Below, Head, NONE, Symbolic};
use ferrode_math::simd::Quad;

/// The factor.
#[derive(Clone, Debug, Default)]
pub(crate) struct Factor {
    /// Column after column: the lower triangle of `L_cc`, the rows of its inverse, the blocks `L_rc` below.
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
        let all = self.stale.iter().all(|stale| *stale);
        if all {
            self.values.fill(0.0);
        }
        for c in 0..shape.columns() {
            if self.stale[c] {
                let (own, width) = (shape.start[c] as usize, usize::from(shape.size[c]));
                if !all {
                    self.values[own..shape.start[c + 1] as usize].fill(0.0);
                }
                for i in 0..width {
                    self.values[own + (stride(width) + 1) * i] = shape.sign[c];
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
    #[inline(always)]
    pub fn factorise<Q: Quad>(&mut self, shape: &Symbolic) {
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
                by_sizes!(sub_aat, Q, [width, depth], (own, factor, sign));
                for block in first + 1..shape.column_start[k + 1] as usize {
                    let row = shape.row[block] as usize;
                    let target = &mut own[self.position[row] as usize..];
                    let other = &earlier[shape.at[block] as usize..];
                    by_sizes!(sub_abt, Q, [shape.size[row], width, depth], (target, other, factor, sign));
                }
            }
            let square = usize::from(width) * stride(usize::from(width));
            let (diagonal, rest) = own.split_at_mut(square);
            self.replaced += by_sizes!(cholesky, Q, [width], (diagonal, rest, shape.sign[c]));
            let (inverse, mut rest) = rest.split_at_mut(square);
            for row in &shape.row[range] {
                let height = shape.size[*row as usize];
                by_sizes!(solve_right, Q, [height, width], (rest, diagonal, inverse));
                rest = &mut rest[stride(usize::from(height)) * usize::from(width)..];
            }
        }
        self.any_stale = false;
    }

    /// `x = K^-1 x`, `x` by columns.
    #[inline(always)]
    pub fn solve<Q: Quad>(&self, shape: &Symbolic, x: &mut [f64]) {
        for head in &shape.heads {
            let below = &shape.below[head.below()];
            let values = &self.values[head.start as usize..];
            by_sizes!(go_forward, Q, [head.width], (head, below, values, x));
        }
        for head in shape.heads.iter().rev() {
            let below = &shape.below[head.below()];
            let values = &self.values[head.start as usize..];
            by_sizes!(go_back, Q, [head.width], (head, below, values, x));
        }
    }
}

/// `x_c = L_cc^-1 x_c`, and takes it off the unknowns below.
#[inline(always)]
fn go_forward<Q: Quad, const N: usize>(head: &Head, below: &[Below], values: &[f64], x: &mut [f64]) {
    let square = N * stride(N);
    let (inverse, mut rest) = values[square..].split_at(square);
    let own = &mut x[head.offset as usize..];
    let solved = Column::<Q, N>::transposed_product::<N>(inverse, Column::load(own));
    solved.store(own);
    let mut own = [0.0; 6];
    solved.store(&mut own);
    for below in below {
        let target = &mut x[below.offset as usize..];
        by_sizes!(sub_mul, Q, [below.height, N], (target, rest, &own, head.sign));
        rest = &rest[stride(usize::from(below.height)) * N..];
    }
}

/// Takes the unknowns below off `x_c`, and `x_c = d_c L_cc^-T x_c`.
#[inline(always)]
fn go_back<Q: Quad, const N: usize>(head: &Head, below: &[Below], values: &[f64], x: &mut [f64]) {
    let square = N * stride(N);
    let (inverse, mut rest) = values[square..].split_at(square);
    let mut sum = Column::<Q, N>::load(&x[head.offset as usize..]);
    for below in below {
        let source = &x[below.offset as usize..];
        let product = if below.height == 3 {
            Column::<Q, N>::transposed_product::<3>(rest, Column::load(source))
        } else {
            Column::<Q, N>::transposed_product::<6>(rest, Column::load(source))
        };
        sum = sum.sub(product);
        rest = &rest[stride(usize::from(below.height)) * N..];
    }
    let mut own = [0.0; 6];
    sum.store(&mut own);
    let solved = Column::<Q, N>::product::<N>(inverse, &own).times(head.sign);
    solved.store(&mut x[head.offset as usize..]);
}

#[inline(always)]
fn add(to: &mut [f64], block: &Block) {
    for (to, x) in to[..36].iter_mut().zip(block) {
        *to += x;
    }
}
