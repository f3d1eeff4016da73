//! Elimination of the rows without bounds, four at a time.
//!
//! Each joint of a figure shares bodies with few others, so most of a row are zeros. They are left out by blocks of four numbers: each row has
//! a set of the blocks that may hold something. Of four rows that are eliminated only the blocks are looked at that any of them holds, and only the
//! rows that stand in these blocks change.

use super::{MOST_BLOCKS, SINGULAR};
use ferrode_math::simd::Quad;

/// A matrix whose upper triangle counts, in rows of whole blocks, and for each row the set of the blocks that hold something. What lies left
/// of the diagonal means nothing.
pub(super) struct Blocks<'a> {
    pub numbers: &'a mut [[f64; 4]],
    pub held: &'a mut [u64],
    /// Blocks of a row.
    pub width: usize,
}

/// The numbers of blocks, rising.
struct List {
    numbers: [u8; MOST_BLOCKS],
    count: usize,
}

impl List {
    #[inline(always)]
    fn of(mut set: u64) -> Self {
        let mut list = Self { numbers: [0; MOST_BLOCKS], count: 0 };
        while set != 0 {
            list.numbers[list.count] = set.trailing_zeros() as u8;
            list.count += 1;
            set &= set - 1;
        }
        list
    }

    #[inline(always)]
    fn blocks(&self) -> &[u8] {
        &self.numbers[..self.count]
    }
}

/// Eliminates the rows from `start` to `end`, up to four of which the first is a multiple of four, from all `n` rows. The reciprocals of
/// their pivots are added to `d`; `scratch` is some memory. `None` if a pivot vanishes.
#[inline(always)]
pub(super) fn eliminate<Q: Quad>(
    matrix: &mut Blocks<'_>,
    (start, end, n): (usize, usize, usize),
    diagonal: &[f64],
    d: &mut Vec<f64>,
    scratch: &mut Vec<[[f64; 4]; 8]>,
) -> Option<()> {
    let width = matrix.width;
    let own = start / 4;
    let held = matrix.held[start..end].iter().fold(1 << own, |all, held| all | held) & (!0 << own);
    let list = List::of(held);
    let list = list.blocks();
    let (above, below) = matrix.numbers[start * width..n * width].split_at_mut((end - start) * width);
    let mut inverses = [0.0; 4];
    for j in 0..end - start {
        let (row, rest) = above[j * width..].split_at_mut(width);
        let pivot = row[own][j];
        if pivot.is_nan() || pivot <= SINGULAR * diagonal[start + j] {
            return None;
        }
        inverses[j] = 1.0 / pivot;
        d.push(inverses[j]);
        for (i, target) in (j + 1..end - start).zip(rest.chunks_exact_mut(width)) {
            let f = row[own][i] * inverses[j];
            if f != 0.0 {
                let f = Q::splat(-f);
                for b in list.iter().map(|b| usize::from(*b)) {
                    if let (Some(y), Some(a)) = (target.get_mut(b), row.get(b)) {
                        (Q::load(y) + f * Q::load(a)).store(y);
                    }
                }
            }
        }
    }
    // The four rows' blocks side by side, and those over the pivots, with the other sign.
    if scratch.len() < list.len() {
        scratch.resize(MOST_BLOCKS, [[0.0; 4]; 8]);
    }
    let scratch = &mut scratch[..list.len()];
    for k in end - start..4 {
        for packed in &mut *scratch {
            (packed[k], packed[4 + k]) = ([0.0; 4], [0.0; 4]);
        }
    }
    for (k, row) in above.chunks_exact(width).enumerate() {
        let inverse = Q::splat(-inverses[k]);
        for (packed, b) in scratch.iter_mut().zip(list) {
            let block = Q::load(&row[usize::from(*b)]);
            block.store(&mut packed[k]);
            (block * inverse).store(&mut packed[4 + k]);
        }
    }
    for (at, b) in list.iter().enumerate() {
        let first = 4 * usize::from(*b);
        let (scratch, list) = (&scratch[at..], &list[at..]);
        let [_, _, _, _, s0, s1, s2, s3] = &scratch[0];
        let (from, to) = (first.max(end), n.min(first + 4));
        let held = held & (!0 << *b);
        for i in (from..to).step_by(2) {
            // What is added of the four rows, two rows at a time.
            let f = |i: usize| {
                let l = i & 3;
                [s0[l], s1[l], s2[l], s3[l]]
            };
            let (f0, f1) = (f(i), if i + 1 < to { f(i + 1) } else { [0.0; 4] });
            if (f0, f1) == ([0.0; 4], [0.0; 4]) {
                continue;
            }
            let (row, next) = below[(i - end) * width..].split_at_mut(width);
            match next.get_mut(..width) {
                Some(next) if f1 != [0.0; 4] => {
                    matrix.held[i] |= held;
                    matrix.held[i + 1] |= held;
                    add_four_to_two::<Q>([row, next], [f0, f1], scratch, list);
                }
                _ => {
                    matrix.held[i] |= held;
                    add_four::<Q>(row, f0, scratch, list);
                }
            }
        }
    }
    Some(())
}

/// `y += s₀ a₀ + s₁ a₁ + s₂ a₂ + s₃ a₃`, one after the other, in some blocks.
#[inline(always)]
fn add_four<Q: Quad>(y: &mut [[f64; 4]], s: [f64; 4], a: &[[[f64; 4]; 8]], list: &[u8]) {
    let (s0, s1, s2, s3) = (Q::splat(s[0]), Q::splat(s[1]), Q::splat(s[2]), Q::splat(s[3]));
    for (a, b) in a.iter().zip(list) {
        if let Some(y) = y.get_mut(usize::from(*b)) {
            let sum = Q::load(y) + s0 * Q::load(&a[0]) + s1 * Q::load(&a[1]);
            (sum + s2 * Q::load(&a[2]) + s3 * Q::load(&a[3])).store(y);
        }
    }
}

/// The same for two rows.
#[inline(always)]
fn add_four_to_two<Q: Quad>(y: [&mut [[f64; 4]]; 2], s: [[f64; 4]; 2], a: &[[[f64; 4]; 8]], list: &[u8]) {
    let [y, z] = y;
    let [s, t] = s;
    let (s0, s1, s2, s3) = (Q::splat(s[0]), Q::splat(s[1]), Q::splat(s[2]), Q::splat(s[3]));
    let (t0, t1, t2, t3) = (Q::splat(t[0]), Q::splat(t[1]), Q::splat(t[2]), Q::splat(t[3]));
    for (a, b) in a.iter().zip(list) {
        if let (Some(y), Some(z)) = (y.get_mut(usize::from(*b)), z.get_mut(usize::from(*b))) {
            let (a0, a1, a2, a3) = (Q::load(&a[0]), Q::load(&a[1]), Q::load(&a[2]), Q::load(&a[3]));
            (Q::load(y) + s0 * a0 + s1 * a1 + s2 * a2 + s3 * a3).store(y);
            (Q::load(z) + t0 * a0 + t1 * a1 + t2 * a2 + t3 * a3).store(z);
        }
    }
}
