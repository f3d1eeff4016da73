//! [`super`] on a few rows: in the space of forces.
//!
//! The rows of a box on the ground all act on one body, so each visit waits for the one before, and that takes as long as from a body's
//! acceleration to its next one. With few rows the matrix is small enough to be formed: with `T_ji = -d_i (J_i B_j + [i = j] C_i)` and the
//! changes `r_i = d_i (rhs_i - J_i a - C_i lambda_i)` that all rows want, a visit of row j is
//!
//! ```text
//!    delta = clamp( r_j,  lo_j - lambda_j,  hi_j - lambda_j )        r += T_j delta
//! ```
//!
//! and what the next row k wants, `r_k + T_jk delta`, is found at once, one product, one sum and the bounds after this one. The accelerations are
//! added up at the end. The answer is that of visiting the bodies, to rounding.

use super::sweep::{PackedRow, Six, bounds, clamp};
use super::{InfTimesZero, SHUFFLE_PERIOD, SorAcceleration, SorParams, shuffle};
use ferrode_math::simd::Quad;

/// The most rows: a visit takes time in proportion to them.
const MOST_ROWS: usize = 24;
/// Room for these and the force that is always 1, such that no index needs a look whether it is within.
const PLACES: usize = 32;
const _: () = assert!(MOST_ROWS < PLACES);
const _: () = assert!(MOST_ROWS.div_ceil(4) == 6, "Small::sweep has a case for each width");

/// The memory of the method.
#[derive(Clone, Debug, Default)]
pub(super) struct Small {
    /// `-d J` by columns: six for each body, each with all rows' entries.
    columns: Vec<[f64; 4]>,
    /// `T`, row by row.
    matrix: Vec<[f64; 4]>,
    /// The changes that the rows want.
    wanted: Vec<[f64; 4]>,
    limits: [Limit; PLACES],
}

/// The bounds of a row's force, and the force that scales them.
#[derive(Clone, Copy, Debug, Default)]
struct Limit {
    lo: f64,
    hi: f64,
    scale: u32,
}

/// Whether the method is the faster one. With many bodies, rows seldom wait for each other.
pub(super) fn suits(rows: usize, bodies: usize) -> bool {
    (1..=MOST_ROWS).contains(&rows) && rows >= 6 * bodies
}

impl Small {
    /// Does `params.iterations` iterations on forces that are zero, and adds the accelerations up.
    #[inline(always)]
    pub fn run<Q: Quad>(
        &mut self,
        packed: &[PackedRow],
        order: &mut [u32],
        lambda: &mut [f64],
        acceleration: &mut [SorAcceleration],
        params: &SorParams,
        random: &mut impl FnMut(u32) -> u32,
    ) {
        self.load::<Q>(packed, acceleration.len());
        let mut forces = [0.0; PLACES];
        forces[packed.len()] = 1.0;
        for done in 0..params.iterations {
            if done > 0 && done % SHUFFLE_PERIOD == 0 {
                shuffle(order, random);
            }
            match params.inf_times_zero {
                InfTimesZero::Unbounded => self.sweep::<Q, false>(order, &mut forces),
                InfTimesZero::Zero => self.sweep::<Q, true>(order, &mut forces),
            }
        }
        lambda[..packed.len()].copy_from_slice(&forces[..packed.len()]);
        for (row, force) in packed.iter().zip(&forces) {
            for (body, b) in row.body.into_iter().zip([row.vector::<Q>(1), row.vector(3)]) {
                if let Some(SorAcceleration(a)) = acceleration.get_mut(body as usize) {
                    Six::load(a).plus(b.scaled(*force)).store(a);
                }
            }
        }
    }

    /// Forms the matrix.
    #[inline(always)]
    fn load<Q: Quad>(&mut self, packed: &[PackedRow], bodies: usize) {
        let width = packed.len().div_ceil(4);
        let Self { columns, matrix, wanted, limits } = self;
        columns.clear();
        columns.resize(bodies * 6 * width, [0.0; 4]);
        wanted.clear();
        wanted.resize(width, [0.0; 4]);
        let numbers = columns.as_flattened_mut();
        for (i, row) in packed.iter().enumerate() {
            wanted.as_flattened_mut()[i] = row.rhs;
            limits[i] = Limit { lo: row.lo, hi: row.hi, scale: row.scale };
            for (side, body) in row.body.into_iter().enumerate() {
                if (body as usize) < bodies {
                    let start = body as usize * 24 * width + i;
                    for (n, j) in row.numbers(2 * side).into_iter().enumerate() {
                        numbers[start + 4 * n * width] = j;
                    }
                }
            }
        }
        matrix.clear();
        matrix.resize(PLACES * width, [0.0; 4]);
        for (i, (out, row)) in matrix.chunks_exact_mut(width).zip(packed).enumerate() {
            for (side, body) in row.body.into_iter().enumerate() {
                if (body as usize) < bodies {
                    let columns = &columns[body as usize * 6 * width..][..6 * width];
                    add_products::<Q>(out, columns, row.numbers(2 * side + 1));
                }
            }
            out.as_flattened_mut()[i] -= row.cfm;
        }
    }

    /// Visits every row once.
    #[inline(always)]
    fn sweep<Q: Quad, const ZERO: bool>(&mut self, order: &[u32], forces: &mut [f64; PLACES]) {
        match self.wanted.len() {
            1 => self.sweep_blocks::<Q, ZERO, 1>(order, forces),
            2 => self.sweep_blocks::<Q, ZERO, 2>(order, forces),
            3 => self.sweep_blocks::<Q, ZERO, 3>(order, forces),
            4 => self.sweep_blocks::<Q, ZERO, 4>(order, forces),
            5 => self.sweep_blocks::<Q, ZERO, 5>(order, forces),
            _ => self.sweep_blocks::<Q, ZERO, 6>(order, forces),
        }
    }

    /// Visits every row once; the matrix has `W` blocks of columns.
    #[inline(always)]
    fn sweep_blocks<Q: Quad, const ZERO: bool, const W: usize>(
        &mut self,
        order: &[u32],
        forces: &mut [f64; PLACES],
    ) {
        let Self { matrix, wanted, limits, .. } = self;
        let Some(wanted) = wanted.first_chunk_mut::<W>() else { return };
        let Some(columns) = matrix.as_chunks::<W>().0.first_chunk::<PLACES>() else { return };
        let at = |row: u32| row as usize % PLACES;
        let Some(mut row) = order.first().copied().map(at) else { return };
        let mut change = wanted.as_flattened()[row];
        // After the last row the first one again, whose change nobody asks for.
        for next in order[1..].iter().chain(order.first()).copied().map(at) {
            let (limit, column) = (&limits[row], &columns[row]);
            let old = forces[row];
            let (lo, hi) = bounds::<ZERO>(limit.lo, limit.hi, forces[at(limit.scale)]);
            let delta = clamp(change, lo - old, hi - old);
            forces[row] = clamp(old + change, lo, hi);
            change = wanted.as_flattened()[next] + column.as_flattened()[next] * delta;
            let delta = Q::splat(delta);
            for (wanted, column) in wanted.iter_mut().zip(column) {
                (Q::load(wanted) + Q::load(column) * delta).store(wanted);
            }
            row = next;
        }
    }
}

/// Adds a body's columns to a row of the matrix, each times a number of `b`.
#[inline(always)]
fn add_products<Q: Quad>(out: &mut [[f64; 4]], columns: &[[f64; 4]], b: [f64; 6]) {
    let width = out.len();
    let (c0, c1, c2) = (&columns[..width], &columns[width..][..width], &columns[2 * width..][..width]);
    let c3 = &columns[3 * width..][..width];
    let (c4, c5) = (&columns[4 * width..][..width], &columns[5 * width..][..width]);
    let (b0, b1, b2) = (Q::splat(b[0]), Q::splat(b[1]), Q::splat(b[2]));
    let (b3, b4, b5) = (Q::splat(b[3]), Q::splat(b[4]), Q::splat(b[5]));
    for l in 0..width {
        let linear = Q::load(&c0[l]) * b0 + Q::load(&c1[l]) * b1 + Q::load(&c2[l]) * b2;
        let angular = Q::load(&c3[l]) * b3 + Q::load(&c4[l]) * b4 + Q::load(&c5[l]) * b5;
        (Q::load(&out[l]) + (linear + angular)).store(&mut out[l]);
    }
}
