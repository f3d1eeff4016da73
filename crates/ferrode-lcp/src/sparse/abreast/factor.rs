//! The factor of several islands: [`super::super::factor`] and [`super::super::matrix`] with lanes for each number.

use super::super::kernels::{by_sizes, stride};
use super::super::symbolic::{Head, NONE, Place, Symbolic};
use super::super::{NO_SPARSE_BODY, RowBlock};
use super::Abreast;
use super::blocks::{
    Row, back, cholesky, forward, load, solve_right, store, sub_aat, sub_abt, sub_mul, sub_product,
    sub_square, sub_transposed, where_positive,
};
use ferrode_math::simd::{Block64, Lanes64};

/// Numbers laid out as the shape says.
#[derive(Clone, Debug, Default)]
pub(super) struct Factor<B> {
    pub values: Vec<B>,
    /// Per block below the diagonal whether it is written for the first time by a coupling yet to come.
    written: Vec<bool>,
    /// For each row where the block of the present column is, counted from the column's start.
    position: Vec<u32>,
}

/// The rows of a block without those that have no weight in an island.
struct Masked<B>([Row<B>; 6]);

impl<B: Block64> Masked<B> {
    #[inline(always)]
    fn new() -> Self {
        Self([[B::splat(0.0); 12]; 6])
    }

    #[inline(always)]
    fn of<'a, Q: Lanes64<Block = B>>(
        &'a mut self,
        all: &'a Abreast<B>,
        block: &RowBlock,
        whole: bool,
    ) -> &'a [Row<B>] {
        let range = block.range();
        let rows = &all.jacobian[range.clone()];
        if whole {
            return rows;
        }
        for ((out, row), weight) in self.0.iter_mut().zip(rows).zip(&all.weight[range]) {
            let weight = Q::load(weight);
            for i in 0..12 {
                where_positive(weight, Q::load(&row[i]), Q::splat(0.0)).store(&mut out[i]);
            }
        }
        let count = rows.len().min(6);
        &self.0[..count]
    }
}

/// Puts the rows into the matrix.
#[inline(always)]
pub(super) fn assemble<Q: Lanes64>(all: &mut Abreast<Q::Block>, blocks: &[RowBlock], shape: &Symbolic) {
    let Factor { mut values, mut written, position } = core::mem::take(&mut all.factor);
    values.resize(shape.numbers(), Q::Block::splat(0.0));
    written.clear();
    written.resize(shape.row.len(), false);
    for coupling in &shape.couplings {
        written[coupling.at as usize] = true;
    }
    for c in 0..shape.columns() {
        // What is not written as a whole; inverses are made later.
        let width = usize::from(shape.size[c]);
        if shape.sign[c] > 0.0 {
            clear_diagonal(&mut values[shape.start[c] as usize..], width, shape.sign[c]);
        }
        let below = shape.column_start[c] as usize..shape.column_start[c + 1] as usize;
        let rows = shape.at[below.clone()].iter().zip(&shape.row[below.clone()]);
        for ((at, row), _) in rows.zip(&written[below]).filter(|(_, written)| !**written) {
            let (at, height) = (*at as usize, usize::from(shape.size[*row as usize]));
            values[at..at + stride(height) * width].fill(Q::Block::splat(0.0));
        }
    }
    let (mut masked, mut other) = (Masked::new(), Masked::new());
    for ((block, place), whole) in blocks.iter().zip(&shape.places).zip(&all.whole) {
        let rows = masked.of::<Q>(all, block, *whole);
        add_joint::<Q>(&mut values, (rows, &all.weight[block.range()]), block, place, shape);
    }
    for coupling in &shape.couplings {
        let [later, earlier] = coupling.blocks.map(|i| i as usize);
        let height = shape.size[shape.places[later].own as usize];
        let width = usize::from(shape.size[shape.places[earlier].own as usize]);
        let first = core::mem::replace(&mut written[coupling.at as usize], false);
        let at = shape.at[coupling.at as usize] as usize;
        let out = &mut values[at..at + stride(usize::from(height)) * width];
        if first {
            out.fill(Q::Block::splat(0.0));
        }
        let rows = masked.of::<Q>(all, &blocks[later], all.whole[later]);
        let cols = other.of::<Q>(all, &blocks[earlier], all.whole[earlier]);
        let [s, t] = coupling.sides.map(usize::from);
        by_sizes!(sub_product, Q, [height], (out, (rows, s), (cols, t)));
    }
    all.factor = Factor { values, written, position };
}

/// The unit matrix with that sign.
#[inline(always)]
fn clear_diagonal<B: Block64>(block: &mut [B], width: usize, sign: f64) {
    block[..stride(width) * width].fill(B::splat(0.0));
    for i in 0..width {
        block[(stride(width) + 1) * i] = B::splat(sign);
    }
}

/// `-S` of a joint, `J` between it and its bodies; of light bodies, which are eliminated already, `-J J^T`.
#[inline(always)]
fn add_joint<Q: Lanes64>(
    values: &mut [Q::Block],
    (rows, weight): (&[Row<Q::Block>], &[Q::Block]),
    block: &RowBlock,
    place: &Place,
    shape: &Symbolic,
) {
    let own = place.own as usize;
    let width = usize::from(shape.size[own]);
    let diagonal = &mut values[shape.start[own] as usize..];
    clear_diagonal(diagonal, width, shape.sign[own]);
    for (c, weight) in weight.iter().enumerate() {
        let (weight, least) = (Q::load(weight), Q::splat(-1.0));
        // A row without a weight keeps the -1 that stands there.
        where_positive(weight, least / weight, least).store(&mut diagonal[(stride(width) + 1) * c]);
    }
    let light = light_sides(block, place);
    if light != [false; 2] {
        by_sizes!(sub_square, Q, [width], (diagonal, rows, light));
    }
    for (s, column) in place.columns.into_iter().enumerate() {
        if column == NONE {
            continue;
        }
        let values = &mut values[shape.at[place.at[s] as usize] as usize..];
        for (r, row) in rows.iter().enumerate() {
            for c in 0..6 {
                // By columns: the one eliminated first.
                let at = if column < place.own { stride(width) * c + r } else { 6 * r + c };
                (Q::load(&values[at]) + Q::load(&row[6 * s + c])).store(&mut values[at]);
            }
        }
    }
}

/// Which of a joint's bodies have no column.
#[inline(always)]
pub(super) fn light_sides(block: &RowBlock, place: &Place) -> [bool; 2] {
    [
        place.columns[0] == NONE && block.bodies[0] != NO_SPARSE_BODY,
        place.columns[1] == NONE && block.bodies[1] != NO_SPARSE_BODY,
    ]
}

impl<B: Block64> Factor<B> {
    /// Factors what was assembled.
    #[inline(always)]
    pub fn factorise<Q: Lanes64<Block = B>>(&mut self, shape: &Symbolic) {
        self.position.resize(shape.columns(), NONE);
        for c in 0..shape.columns() {
            let range = shape.column_start[c] as usize..shape.column_start[c + 1] as usize;
            let start = shape.start[c];
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
            by_sizes!(cholesky, Q, [width], (diagonal, rest, shape.sign[c]));
            let (inverse, mut rest) = rest.split_at_mut(square);
            for row in &shape.row[range] {
                let height = shape.size[*row as usize];
                by_sizes!(solve_right, Q, [height, width], (rest, diagonal, inverse));
                rest = &mut rest[stride(usize::from(height)) * usize::from(width)..];
            }
        }
    }

    /// `x = K^-1 x`, `x` by columns.
    #[inline(always)]
    pub fn solve<Q: Lanes64<Block = B>>(&self, shape: &Symbolic, x: &mut [B]) {
        for head in &shape.heads {
            let values = &self.values[head.start as usize..];
            by_sizes!(go_forward, Q, [head.width], (head, shape, values, x));
        }
        for head in shape.heads.iter().rev() {
            let values = &self.values[head.start as usize..];
            by_sizes!(go_back, Q, [head.width], (head, shape, values, x));
        }
    }
}

/// `x_c = L_cc^-1 x_c`, and takes it off the unknowns below.
#[inline(always)]
fn go_forward<Q: Lanes64, const N: usize>(
    head: &Head,
    shape: &Symbolic,
    values: &[Q::Block],
    x: &mut [Q::Block],
) {
    let square = N * stride(N);
    let (inverse, mut rest) = values[square..].split_at(square);
    let own = &mut x[head.offset as usize..];
    let solved = forward::<Q, N>(inverse, load(own));
    store(solved, own);
    for below in &shape.below[head.below()] {
        let target = &mut x[below.offset as usize..];
        if below.height == 3 {
            sub_mul::<Q, 3, N>(target, rest, &solved, head.sign);
        } else {
            sub_mul::<Q, 6, N>(target, rest, &solved, head.sign);
        }
        rest = &rest[stride(usize::from(below.height)) * N..];
    }
}

/// Takes the unknowns below off `x_c`, and `x_c = d_c L_cc^-T x_c`.
#[inline(always)]
fn go_back<Q: Lanes64, const N: usize>(
    head: &Head,
    shape: &Symbolic,
    values: &[Q::Block],
    x: &mut [Q::Block],
) {
    let square = N * stride(N);
    let (inverse, mut rest) = values[square..].split_at(square);
    let mut sum = load::<Q, N>(&x[head.offset as usize..]);
    for below in &shape.below[head.below()] {
        let source = &x[below.offset as usize..];
        if below.height == 3 {
            sub_transposed::<Q, N, 3>(&mut sum, rest, source);
        } else {
            sub_transposed::<Q, N, 6>(&mut sum, rest, source);
        }
        rest = &rest[stride(usize::from(below.height)) * N..];
    }
    let mut solved = back::<Q, N>(inverse, sum);
    let sign = Q::splat(head.sign);
    for x in &mut solved {
        *x *= sign;
    }
    store(solved, &mut x[head.offset as usize..]);
}
