//! Dantzig's method for small islands, on the rows with bounds alone.
//!
//! The rows without bounds, U, hold in every state of the others, B. Eliminating them once leaves a problem in `x_B` only,
//!
//! ```text
//!     S = A_BB - A_BU A_UU^-1 A_UB        q = b_B - A_BU A_UU^-1 b_U        w_B = S x_B - q
//! ```
//!
//! (a Schur complement; R. W. Cottle, "Manifestations of the Schur complement", 1974), which has the same answer and, for a ragdoll on
//! the ground, half the rows or fewer. It is small enough to be kept as a tableau (`condensed/tableau`), from which the direction of each drive
//! is read off, and which a change of sets updates in one pass.
//!
//! A tableau gathers rounding errors, so it only finds which rows are at which bound. The answer is computed from those: by a factorisation of `S` at the
//! final set, with iterative refinement in the whole system. It depends on the set alone. If the answer fails the test of its natural residual, the
//! caller has to turn to [`crate::dantzig`].

mod blocks;
mod eliminate;
mod order;
mod refine;
mod tableau;

use crate::error::LcpError;
use crate::problem::BoxedLcp;
use eliminate::{Blocks, eliminate};
use ferrode_math::simd::{Quad, QuadKernel, dispatch_quads};
use tableau::{Place, Tableau};

/// The natural residual that an answer may have, in parts of `1 + max |x|`.
const GOOD: f64 = 1e-12;
/// Refinement ends when the residuals are below this.
const FINE: f64 = 1e-13;
/// A pivot below this part of its diagonal is rounding: the row is redundant, and nothing in it tells its share of the load.
const SINGULAR: f64 = 1e-13;
/// So many corrections are made at most.
const MOST_CORRECTIONS: usize = 3;
/// So often wrong states are corrected at most.
const MOST_ROUNDS: usize = 6;
/// The most blocks of four numbers in a row: the set of those that hold something is one number.
const MOST_BLOCKS: usize = 64;

/// What a solve found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CondensedReport {
    /// The natural residual with the frozen bounds, `max |x - proj(x - w / A_ii)|`.
    pub residual: f64,
    /// The largest force.
    pub largest: f64,
    /// The rows without bounds, which were eliminated.
    pub eliminated: usize,
    /// The number of changes of sets.
    pub pivots: u32,
}

/// All memory that a solve needs. Made once, it grows to the largest problem met.
#[derive(Clone, Debug, Default)]
pub struct CondensedWorkspace {
    /// The rows: U, then B in the order in which they are taken in, those with a friction index last.
    order: Vec<u32>,
    /// Which rows are in U.
    unbounded: Vec<bool>,
    /// Where each row is in `order`.
    place: Vec<u32>,
    /// The upper triangle of the matrix in that order, with the right-hand side as last column, in whole blocks of four numbers. Of U the rows
    /// become `D L^T`; what is left of the others is `S` and `q`. What lies left of the diagonal means nothing.
    m: Vec<[f64; 4]>,
    /// For each row of `m` which blocks hold something, and the diagonal that it had.
    held: Vec<u64>,
    scale: Vec<f64>,
    /// The reciprocals of `D`.
    d: Vec<f64>,
    scratch: Vec<[[f64; 4]; 8]>,
    tableau: Tableau,
    /// The rows of B that are free, a factor of their part of `S`, their solution.
    free: Vec<u32>,
    triangle: Vec<f64>,
    pivots: Vec<f64>,
    y: Vec<f64>,
    /// Forces or a correction in the order of `m`, filled up with zeros.
    v: Vec<[f64; 4]>,
    /// Forces, slacks and the diagonal in the caller's order, filled up with zeros and ones.
    x: Vec<f64>,
    w: Vec<f64>,
    diagonal: Vec<f64>,
    /// The diagonal of rows that are to have no slack, infinity for the others.
    tight: Vec<f64>,
    /// The bounds in force, in the caller's order, filled up.
    lo: Vec<f64>,
    hi: Vec<f64>,
    /// How many rows there are.
    n: usize,
}

impl CondensedWorkspace {
    /// An empty workspace.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The lower bounds that were in force in the last solve: those of friction rows as they were frozen.
    #[must_use]
    pub fn lower_bounds(&self) -> &[f64] {
        &self.lo[..self.n]
    }

    /// The upper bounds that were in force in the last solve: those of friction rows as they were frozen.
    #[must_use]
    pub fn upper_bounds(&self) -> &[f64] {
        &self.hi[..self.n]
    }
}

/// Solves a boxed problem of up to a hundred rows or so. `None` if it could not be solved to rounding, or has over 255 rows: `x` and `w` are
/// then unspecified.
///
/// # Errors
/// If the problem is malformed ([`BoxedLcp::check`]); `x` and `w` are then untouched.
pub fn solve_condensed(
    problem: &mut BoxedLcp<'_>,
    workspace: &mut CondensedWorkspace,
) -> Result<Option<CondensedReport>, LcpError> {
    problem.check()?;
    workspace.n = 0;
    if width(problem.n) > MOST_BLOCKS {
        return Ok(None);
    }
    Ok(dispatch_quads(Solve { p: problem, work: workspace }))
}

struct Solve<'a, 'b> {
    p: &'a mut BoxedLcp<'b>,
    work: &'a mut CondensedWorkspace,
}

impl QuadKernel for Solve<'_, '_> {
    type Out = Option<CondensedReport>;

    #[inline(always)]
    fn run<Q: Quad>(self) -> Option<CondensedReport> {
        let Self { p, work } = self;
        let u = work.arrange(p);
        work.load::<Q>(p);
        work.eliminate::<Q>(p.n, u)?;
        work.take_bounds(p, u)?;
        let (n, stride) = (p.n, 4 * width(p.n));
        let numbers = work.m.as_flattened();
        let upper = (u..n).map(|r| &numbers[r * stride + r..r * stride + n + 1]);
        work.tableau.solve::<Q>(n - u, upper)?;
        work.freeze_bounds(n, u);
        let pivots = work.tableau.pivots;
        for _ in 0..MOST_ROUNDS {
            work.solve_set::<Q>(n, u)?;
            let (residual, largest) = work.polish::<Q>(p, u);
            if residual <= GOOD * (1.0 + largest) {
                p.x[..n].copy_from_slice(&work.x[..n]);
                p.w[..n].copy_from_slice(&work.w[..n]);
                return Some(CondensedReport { residual, largest, eliminated: u, pivots });
            }
            if !work.correct_states(u, largest) {
                return None;
            }
        }
        None
    }
}

impl CondensedWorkspace {
    /// Finds the order of the rows. Returns the number of those without bounds.
    #[inline(always)]
    fn arrange(&mut self, p: &BoxedLcp<'_>) -> usize {
        let n = p.n;
        let (lo, hi, findex) = (&p.lo[..n], &p.hi[..n], &p.findex[..n]);
        self.unbounded.clear();
        self.unbounded.extend(
            (0..n).map(|r| (findex[r] < 0) & (lo[r] == f64::NEG_INFINITY) & (hi[r] == f64::INFINITY)),
        );
        self.order.clear();
        if order::by_degree(p, &self.unbounded, &mut self.order).is_none() {
            self.order.clear();
            self.order.extend((0..n as u32).filter(|row| self.unbounded[*row as usize]));
        }
        let u = self.order.len();
        for (row, unbounded) in self.unbounded.iter().enumerate() {
            if !unbounded {
                self.order.push(row as u32);
            }
        }
        let mut end = n;
        for at in (u..n).rev() {
            if p.findex[self.order[at] as usize] >= 0 {
                end -= 1;
                self.order.swap(at, end);
            }
        }
        refill(&mut self.place, n, 0);
        for (at, row) in self.order.iter().enumerate() {
            self.place[*row as usize] = at as u32;
        }
        u
    }

    /// Takes the matrix in, in the order of elimination.
    #[inline(always)]
    fn load<Q: Quad>(&mut self, p: &BoxedLcp<'_>) {
        let (n, width) = (p.n, width(p.n));
        self.n = n;
        let Self { m, held, place, scale, diagonal, .. } = self;
        if m.len() < n * width {
            m.resize(n * width, [0.0; 4]);
        }
        for (at, row) in m.chunks_exact_mut(width).take(n).enumerate() {
            for block in &mut row[at / 4..] {
                Q::splat(0.0).store(block);
            }
        }
        refill(scale, n, 0.0);
        refill(diagonal, 4 * width, 1.0);
        let (numbers, stride) = (m.as_flattened_mut(), 4 * width);
        for r in 0..n {
            let first = p.first.map_or(0, |first| first[r] as usize);
            let row = &p.a[r * p.stride..][..=r];
            let at = place[r] as usize;
            (scale[at], diagonal[r]) = (row[r], row[r]);
            numbers[at * stride + at] = row[r];
            numbers[at * stride + n] = p.b[r];
            let ((values, last), (places, last_places)) =
                (row[first..r].as_chunks::<4>(), place[first..r].as_chunks::<4>());
            let mut put = |v: f64, other: u32| {
                let other = other as usize;
                let (above, column) = if other < at { (other, at) } else { (at, other) };
                numbers[above * stride + column] = v;
            };
            for (v, places) in values.iter().zip(places) {
                // Zeros are passed over.
                if (v[0].to_bits() | v[1].to_bits() | v[2].to_bits() | v[3].to_bits()) << 1 == 0 {
                    continue;
                }
                put(v[0], places[0]);
                put(v[1], places[1]);
                put(v[2], places[2]);
                put(v[3], places[3]);
            }
            for (v, place) in last.iter().zip(last_places) {
                put(*v, *place);
            }
        }
        held.clear();
        for (at, row) in m.chunks_exact(width).take(n).enumerate() {
            // What stands left of the diagonal may be anything.
            let mut set = 1 << (at / 4) | 1 << (n / 4);
            for (b, v) in row.iter().enumerate().skip(at / 4 + 1) {
                let any = (v[0].to_bits() | v[1].to_bits() | v[2].to_bits() | v[3].to_bits()) << 1 != 0;
                set |= u64::from(any) << b;
            }
            held.push(set);
        }
    }

    /// Eliminates the first `u` rows, four at a time: from the right-hand side and from what is left of the matrix. `None` if a pivot
    /// vanishes.
    #[inline(always)]
    fn eliminate<Q: Quad>(&mut self, n: usize, u: usize) -> Option<()> {
        let Self { m, held, d, scale, scratch, .. } = self;
        let mut matrix = Blocks { numbers: m, held, width: width(n) };
        d.clear();
        for start in (0..u).step_by(4) {
            eliminate::<Q>(&mut matrix, (start, u.min(start + 4), n), scale, d, scratch)?;
        }
        Some(())
    }

    /// Hands the bounds to the tableau; `None` if friction hangs on a row without bounds.
    #[inline(always)]
    fn take_bounds(&mut self, p: &BoxedLcp<'_>, u: usize) -> Option<()> {
        self.tableau.rows.clear();
        for row in &self.order[u..] {
            let row = *row as usize;
            let normal = match usize::try_from(p.findex[row]) {
                Ok(f) => (self.place[f] as usize).checked_sub(u)? as u32,
                Err(_) => tableau::NO_NORMAL,
            };
            self.tableau.rows.push(Place::new(p.lo[row], p.hi[row], normal));
        }
        Some(())
    }

    /// Notes the bounds in the caller's order, those of friction rows as they were frozen.
    #[inline(always)]
    fn freeze_bounds(&mut self, n: usize, u: usize) {
        refill(&mut self.lo, 4 * width(n), f64::NEG_INFINITY);
        refill(&mut self.hi, 4 * width(n), f64::INFINITY);
        for (row, place) in self.order[u..].iter().zip(&self.tableau.rows) {
            (self.lo[*row as usize], self.hi[*row as usize]) = (place.lo, place.hi);
        }
    }

    /// Puts rows that are in the wrong state into a better one. Whether there were any.
    #[inline(always)]
    fn correct_states(&mut self, u: usize, largest: f64) -> bool {
        let close = 1e-14 * (1.0 + largest);
        let mut changed = false;
        for (row, place) in self.order[u..].iter().zip(&mut self.tableau.rows) {
            let row = *row as usize;
            changed |= place.correct(self.x[row], self.w[row] / self.diagonal[row], close);
        }
        changed
    }
}

/// The blocks of a row of the matrix with its right-hand side.
fn width(n: usize) -> usize {
    (n + 1).div_ceil(4)
}

fn refill<T: Copy>(v: &mut Vec<T>, n: usize, value: T) {
    v.clear();
    v.resize(n, value);
}
