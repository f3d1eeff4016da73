//! The matrix of the rows that have a weight, put into the columns of the factor that are to be made.

use super::factor::Factor;
use super::kernels::{by_sizes, stride};
use super::rows::{self, Weighted, sub_product, sub_square};
use super::symbolic::{NONE, Place, Symbolic};
use super::{NO_SPARSE_BODY, RowBlock};
use ferrode_math::simd::Quad;

/// Adds the blocks of all rows that have a weight to the stale columns; `whole` tells of each block of rows whether all of them have one.
#[inline(always)]
pub(super) fn assemble<Q: Quad>(
    factor: &mut Factor,
    blocks: &[RowBlock],
    all: Weighted<'_>,
    shape: &Symbolic,
    whole: &mut Vec<bool>,
) {
    factor.clear_stale(shape);
    whole.resize(blocks.len(), false);
    for ((block, place), whole) in blocks.iter().zip(&shape.places).zip(whole) {
        let rows = all.of(block);
        *whole = rows.weight.iter().all(|weight| *weight != 0.0);
        if place.own == NONE {
            add_folded::<Q>(factor, rows, place, shape);
        } else {
            add_joint::<Q>(factor, rows, light_sides(block, place), place, shape);
        }
    }
    for coupling in &shape.couplings {
        let [later, earlier] = coupling.blocks.map(|i| i as usize);
        if !factor.is_stale(shape.places[earlier].own) {
            continue;
        }
        let height = shape.size[shape.places[later].own as usize];
        let out = &mut factor.values[shape.at[coupling.at as usize] as usize..];
        let (rows, cols) = (all.of(&blocks[later]), all.of(&blocks[earlier]));
        let [s, t] = coupling.sides.map(usize::from);
        by_sizes!(sub_product, Q, [height], (out, (rows, s), (cols, t)));
    }
}

/// `J^T S^-1 J` of rows without unknowns of their own.
#[inline(always)]
fn add_folded<Q: Quad>(factor: &mut Factor, rows: Weighted<'_>, place: &Place, shape: &Symbolic) {
    let (columns, pair) = (place.columns, place.at[0]);
    let stale = columns.map(|c| factor.is_stale(c));
    if (!stale[0] && !stale[1]) || rows.weight.iter().all(|weight| *weight == 0.0) {
        return;
    }
    for side in 0..2 {
        if stale[side] {
            let block = rows::outer_products::<Q>(rows, side, side);
            factor.add_diagonal(columns[side], shape, &block);
        }
    }
    // The pair's block stands in the column of the body that is eliminated first.
    let (low, high) = if columns[0] < columns[1] { (0, 1) } else { (1, 0) };
    if pair != NONE && stale[low] {
        factor.add_below(pair, shape, &rows::outer_products::<Q>(rows, high, low));
    }
}

/// `-S` of a joint, `J` between it and its bodies; of light bodies, which are eliminated already, `-J J^T`.
#[inline(always)]
fn add_joint<Q: Quad>(
    factor: &mut Factor,
    rows: Weighted<'_>,
    light: [bool; 2],
    place: &Place,
    shape: &Symbolic,
) {
    let own = place.own as usize;
    let width = usize::from(shape.size[own]);
    if factor.is_stale(place.own) {
        let diagonal = &mut factor.values[shape.start[own] as usize..];
        for (c, weight) in rows.weight.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
            // A row without a weight keeps the -1 that stands there.
            diagonal[(stride(width) + 1) * c] = -1.0 / weight;
        }
        if light != [false; 2] {
            by_sizes!(sub_square, Q, [width], (diagonal, rows, light));
        }
    }
    for (s, column) in place.columns.into_iter().enumerate() {
        if column == NONE || !factor.is_stale(column.min(place.own)) {
            continue;
        }
        let values = &mut factor.values[shape.at[place.at[s] as usize] as usize..];
        for (r, (row, weight)) in rows.rows.iter().zip(rows.weight).enumerate() {
            if *weight == 0.0 {
                continue;
            }
            for (c, x) in row[s].iter().enumerate() {
                // By columns: the one eliminated first.
                let at = if column < place.own { stride(width) * c + r } else { 6 * r + c };
                values[at] += x;
            }
        }
    }
}

/// Which of a joint's bodies have no column.
#[inline(always)]
fn light_sides(block: &RowBlock, place: &Place) -> [bool; 2] {
    [0, 1].map(|s| place.columns[s] == NONE && block.bodies[s] != NO_SPARSE_BODY)
}
