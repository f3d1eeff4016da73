//! Elimination of the rows without bounds, four at a time.
//!
//! Each joint of a figure shares bodies with few others, so most of a row are zeros. They are left out by blocks: of four rows that are
//! eliminated, only the blocks in which any of them holds something are looked at, and only the rows that stand in these blocks change.

use super::SINGULAR;

/// Eliminates the rows from `start` to `end`, up to four of which the first is a multiple of four, from all `n` rows of a matrix whose
/// upper triangle counts. The reciprocals of their pivots are added to `d`. `None` if a pivot vanishes.
#[inline(always)]
pub(super) fn eliminate(
    matrix: &mut [[f64; 4]],
    blocks: usize,
    (start, end, n): (usize, usize, usize),
    diagonal: &[f64],
    d: &mut Vec<f64>,
    held: &mut Vec<u32>,
) -> Option<()> {
    let (above, below) = matrix[start * blocks..n * blocks].split_at_mut((end - start) * blocks);
    let own = start / 4;
    find_held(above, blocks, own, held);
    for j in 0..end - start {
        let (row, rest) = above[j * blocks..].split_at_mut(blocks);
        let pivot = row[own][j];
        if pivot.is_nan() || pivot <= SINGULAR * diagonal[start + j] {
            return None;
        }
        let inverse = 1.0 / pivot;
        d.push(inverse);
        for (i, target) in (j + 1..end - start).zip(rest.chunks_exact_mut(blocks)) {
            let f = row[own][i] * inverse;
            if f != 0.0 {
                for b in held.iter().map(|b| *b as usize) {
                    let (y, a) = (target[b], row[b]);
                    target[b] = [y[0] - f * a[0], y[1] - f * a[1], y[2] - f * a[2], y[3] - f * a[3]];
                }
            }
        }
    }
    let row = |k: usize| &above[k.min(end - start - 1) * blocks..][..blocks];
    let rows = [row(0), row(1), row(2), row(3)];
    let inverse = |k: usize| d.get(start + k).copied().unwrap_or(0.0);
    let inverses = [inverse(0), inverse(1), inverse(2), inverse(3)];
    for (at, b) in held.iter().enumerate() {
        let first = 4 * *b as usize;
        let held = &held[at..];
        let a = [rows[0][*b as usize], rows[1][*b as usize], rows[2][*b as usize], rows[3][*b as usize]];
        for i in first.max(end)..n.min(first + 4) {
            let factor = |k: usize| a[k][i & 3] * inverses[k];
            let f = [factor(0), factor(1), factor(2), factor(3)];
            if f != [0.0; 4] {
                sub_four(&mut below[(i - end) * blocks..][..blocks], f, rows, held);
            }
        }
    }
    Some(())
}

/// Lists the blocks from `from` on in which any of the rows holds something.
#[inline(always)]
fn find_held(rows: &[[f64; 4]], blocks: usize, from: usize, held: &mut Vec<u32>) {
    held.clear();
    for b in from..blocks {
        let mut bits = 0;
        for row in rows.chunks_exact(blocks) {
            bits |= row[b].iter().fold(0, |bits, v| bits | v.to_bits());
        }
        // The sign bit is left out: minus zero is zero.
        if bits << 1 != 0 {
            held.push(b as u32);
        }
    }
}

/// `y -= s₀ a₀ + s₁ a₁ + s₂ a₂ + s₃ a₃`, one after the other, in some blocks.
#[inline(always)]
fn sub_four(y: &mut [[f64; 4]], s: [f64; 4], a: [&[[f64; 4]]; 4], held: &[u32]) {
    let n = y.len();
    let (a0, a1, a2, a3) = (&a[0][..n], &a[1][..n], &a[2][..n], &a[3][..n]);
    for b in held {
        let b = *b as usize;
        let (y, a0, a1, a2, a3) = (&mut y[b], &a0[b], &a1[b], &a2[b], &a3[b]);
        let l = |l: usize| (((y[l] - s[0] * a0[l]) - s[1] * a1[l]) - s[2] * a2[l]) - s[3] * a3[l];
        *y = [l(0), l(1), l(2), l(3)];
    }
}
