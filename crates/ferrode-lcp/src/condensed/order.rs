//! The order of elimination: minimum degree, joint by joint.
//!
//! An elimination makes all rows neighbours that the row was a neighbour of, so those with few go first: a figure from its hands and feet to
//! its trunk (W. F. Tinney, J. W. Walker, "Direct solutions of sparse network equations by optimally ordered triangular factorization", 1967).
//! Rows of a joint follow each other and reach equally far left, which tells them from those of others, or from most.

use super::MOST_BLOCKS;
use crate::problem::BoxedLcp;

/// The most runs of rows: a set of them is one number.
const MOST: usize = 64;

/// Rows of a joint, or of joints on the same bodies.
#[derive(Clone, Copy, Debug, Default)]
struct Run {
    start: usize,
    len: usize,
    /// The runs that it shares entries with, and how many rows these have.
    near: u64,
    degree: usize,
}

/// The runs in a set.
fn members(mut set: u64) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let first = (set != 0).then(|| set.trailing_zeros() as usize);
        set &= set.wrapping_sub(1);
        first
    })
}

/// Puts the rows that are to be eliminated into an order; `None` if there are too many runs, or no telling them apart.
#[inline(always)]
pub(super) fn by_degree(p: &BoxedLcp<'_>, eliminated: &[bool], order: &mut Vec<u32>) -> Option<()> {
    let first = p.first?;
    let mut runs = [Run::default(); MOST];
    let mut run_of = [0u8; 4 * MOST_BLOCKS];
    let (mut count, mut left) = (0, 0u64);
    for r in 0..p.n {
        if r == 0 || first[r] != first[r - 1] {
            let run = runs.get_mut(count)?;
            run.start = r;
            // The first row tells for all.
            let from = first[r] as usize;
            for (v, other) in p.a[r * p.stride + from..r * p.stride + r].iter().zip(&run_of[from..]) {
                run.near |= u64::from(*v != 0.0) << (other & 63);
            }
            count += 1;
        }
        run_of[r] = count as u8 - 1;
        runs[count - 1].len += 1;
        left |= u64::from(eliminated[r]) << (count - 1);
    }
    for run in 1..count {
        for other in members(runs[run].near) {
            runs[other].near |= 1 << run;
        }
    }
    let degree = |runs: &[Run; MOST], run: usize| members(runs[run].near).map(|other| runs[other].len).sum();
    for run in members(left) {
        runs[run].degree = degree(&runs, run);
    }
    while left != 0 {
        let (mut run, mut least) = (0, usize::MAX);
        for other in members(left) {
            if runs[other].degree < least {
                (run, least) = (other, runs[other].degree);
            }
        }
        left &= !(1 << run);
        let near = runs[run].near;
        for other in members(near) {
            runs[other].near = (runs[other].near | near) & !(1 << other) & !(1 << run);
        }
        for other in members(near & left) {
            runs[other].degree = degree(&runs, other);
        }
        let Run { start, len, .. } = runs[run];
        for (eliminated, row) in eliminated[start..start + len].iter().zip(start as u32..) {
            if *eliminated {
                order.push(row);
            }
        }
    }
    Some(())
}
