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
mod tableau;

use crate::error::LcpError;
use crate::kernel::{self, dot};
use crate::problem::BoxedLcp;
use crate::residual::row_residual;
use blocks::{dot_from, sub_scaled};
use eliminate::eliminate;
use ferrode_math::simd::{Compute, compute_wide};
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
    /// Where each row is in `order`.
    place: Vec<u32>,
    /// The matrix in that order: what lies right of the diagonal, and the diagonal. Rows have whole blocks of four numbers; in the block with
    /// the diagonal zeros stand before it.
    upper: Vec<f64>,
    diagonal: Vec<f64>,
    /// Its upper triangle with the right-hand side as last column. Of U the rows become `D L^T`; what is left of the others is `S` and `q`. What
    /// lies left of the diagonal means nothing.
    m: Vec<f64>,
    /// The reciprocals of `D`.
    d: Vec<f64>,
    /// Scratch: the blocks in which rows that are eliminated hold something.
    held: Vec<u32>,
    tableau: Tableau,
    /// The rows of B that are free, a factor of their part of `S`, their solution.
    free: Vec<u32>,
    triangle: Vec<f64>,
    pivots: Vec<f64>,
    y: Vec<f64>,
    /// Right-hand side, forces, slacks and a correction in that order, filled up with zeros.
    b: Vec<f64>,
    x: Vec<f64>,
    w: Vec<f64>,
    v: Vec<f64>,
    /// The bounds in force, in the caller's order.
    lo: Vec<f64>,
    hi: Vec<f64>,
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
        &self.lo
    }

    /// The upper bounds that were in force in the last solve: those of friction rows as they were frozen.
    #[must_use]
    pub fn upper_bounds(&self) -> &[f64] {
        &self.hi
    }
}

/// Solves a boxed problem of up to a hundred rows or so. `None` if it could not be solved to rounding: `x` and `w` are then unspecified.
///
/// # Errors
/// If the problem is malformed ([`BoxedLcp::check`]); `x` and `w` are then untouched.
pub fn solve_condensed(
    problem: &mut BoxedLcp<'_>,
    workspace: &mut CondensedWorkspace,
) -> Result<Option<CondensedReport>, LcpError> {
    problem.check()?;
    Ok(compute_wide(Solve { p: problem, work: workspace }))
}

struct Solve<'a, 'b> {
    p: &'a mut BoxedLcp<'b>,
    work: &'a mut CondensedWorkspace,
}

impl Compute for Solve<'_, '_> {
    type Out = Option<CondensedReport>;

    #[inline(always)]
    fn run(self) -> Option<CondensedReport> {
        let Self { p, work } = self;
        let u = work.arrange(p);
        work.load(p);
        work.eliminate(p.n, u)?;
        work.take_bounds(p, u)?;
        let (n, m, width) = (p.n, &work.m, width(p.n));
        work.tableau.solve(n - u, (u..n).map(|r| &m[r * width + r..r * width + n + 1]))?;
        let pivots = work.tableau.pivots;
        for _ in 0..MOST_ROUNDS {
            work.solve_set(n, u)?;
            let (residual, largest) = work.polish(n, u);
            if residual <= GOOD * (1.0 + largest) {
                work.store(p, u);
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
        self.order.clear();
        self.order.extend(0..n as u32);
        let mut u = 0;
        for at in 0..n {
            let row = self.order[at] as usize;
            if p.findex[row] < 0 && p.lo[row] == f64::NEG_INFINITY && p.hi[row] == f64::INFINITY {
                self.order.swap(u, at);
                u += 1;
            }
        }
        let mut end = n;
        for at in (u..n).rev() {
            if p.findex[self.order[at] as usize] >= 0 {
                end -= 1;
                self.order.swap(at, end);
            }
        }
        self.place.clear();
        self.place.resize(n, 0);
        for (at, row) in self.order.iter().enumerate() {
            self.place[*row as usize] = at as u32;
        }
        u
    }

    /// Takes the matrix in, in the order of elimination.
    #[inline(always)]
    fn load(&mut self, p: &BoxedLcp<'_>) {
        let (n, width) = (p.n, width(p.n));
        for m in [&mut self.upper, &mut self.m] {
            if m.len() < n * width {
                m.resize(n * width, 0.0);
            }
        }
        for (r, row) in self.upper.chunks_exact_mut(width).take(n).enumerate() {
            row[r & !3..].fill(0.0);
        }
        for v in [&mut self.diagonal, &mut self.b, &mut self.x, &mut self.w, &mut self.v] {
            refill(v, width, 0.0);
        }
        for r in 0..n {
            let first = p.first.map_or(0, |first| first[r] as usize);
            let row = &p.a[r * p.stride..][..=r];
            let at = self.place[r] as usize;
            self.diagonal[at] = row[r];
            self.b[at] = p.b[r];
            // Zeros are passed over four at a time.
            let places = self.place[first..r].chunks(4);
            for (values, places) in row[first..r].chunks(4).zip(places) {
                if values.iter().fold(0, |bits, v| bits | v.to_bits()) << 1 == 0 {
                    continue;
                }
                for (v, other) in values.iter().zip(places) {
                    let other = *other as usize;
                    let place = if other < at { other * width + at } else { at * width + other };
                    self.upper[place] = *v;
                }
            }
        }
        let rows = self.m.chunks_exact_mut(width).zip(self.upper.chunks_exact(width));
        for (at, (row, upper)) in rows.take(n).enumerate() {
            row[at & !3..].copy_from_slice(&upper[at & !3..]);
            row[at] = self.diagonal[at];
            row[n] = self.b[at];
        }
    }

    /// Eliminates the first `u` rows, four at a time: from the right-hand side and from what is left of the matrix. `None` if a pivot
    /// vanishes.
    #[inline(always)]
    fn eliminate(&mut self, n: usize, u: usize) -> Option<()> {
        let Self { m, d, diagonal, held, .. } = self;
        d.clear();
        for start in (0..u).step_by(4) {
            let rows = (start, u.min(start + 4), n);
            eliminate(m.as_chunks_mut().0, width(n) / 4, rows, diagonal, d, held)?;
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

    /// Solves from scratch for the rows that are free, with the others at their bounds. `None` if a pivot vanishes.
    #[inline(always)]
    fn solve_set(&mut self, n: usize, u: usize) -> Option<()> {
        let width = width(n);
        let Self { tableau, free, triangle, pivots, y, x, m, d, diagonal, .. } = self;
        free.clear();
        for (at, place) in tableau.rows.iter().enumerate() {
            if place.is_free() {
                free.push((u + at) as u32);
            }
            x[u + at] = place.bound();
        }
        // Entries of a symmetric matrix whose upper triangle there is.
        let entry = |a: usize, b: usize| if a < b { m[a * width + b] } else { m[b * width + a] };
        y.clear();
        y.extend(free.iter().map(|at| m[*at as usize * width + n]));
        for (at, bound) in x.iter().enumerate().take(n).skip(u) {
            if *bound != 0.0 {
                for (y, free) in y.iter_mut().zip(free.iter()) {
                    *y -= entry(*free as usize, at) * bound;
                }
            }
        }
        // L D L^T with unit diagonal, row by row; `pivots` the reciprocals of D.
        let f = free.len();
        triangle.clear();
        triangle.resize(f * f, 0.0);
        pivots.clear();
        for (i, at) in free.iter().enumerate() {
            let at = *at as usize;
            let (above, own) = triangle.split_at_mut(i * f);
            let own = &mut own[..i];
            for (own, c) in own.iter_mut().zip(free.iter()) {
                *own = m[*c as usize * width + at];
            }
            for j in 1..i {
                own[j] -= dot(&own[..j], &above[j * f..][..j]);
            }
            let mut pivot = m[at * width + at];
            for (l, d) in own.iter_mut().zip(pivots.iter()) {
                let scaled = *l * d;
                pivot -= *l * scaled;
                *l = scaled;
            }
            if pivot.is_nan() || pivot <= SINGULAR * diagonal[at] {
                return None;
            }
            pivots.push(1.0 / pivot);
        }
        solve_free(triangle, pivots, y);
        for (at, y) in free.iter().zip(y.iter()) {
            x[*at as usize] = *y;
        }
        for j in (0..u).rev() {
            let row = &m[j * width..][..width];
            x[j] = (row[n] - dot_from(row, x, j + 1)) * d[j];
        }
        Some(())
    }

    /// Refines the answer of a set in the whole system. Returns its natural residual and the largest force.
    #[inline(always)]
    fn polish(&mut self, n: usize, u: usize) -> (f64, f64) {
        let width = width(n);
        self.slack(n);
        for _ in 0..MOST_CORRECTIONS {
            let Self { free, triangle, pivots, y, v, x, w, m, d, diagonal, .. } = &mut *self;
            let largest = x.iter().fold(0.0, |m: f64, x| if x.abs() > m { x.abs() } else { m });
            let mut error: f64 = 0.0;
            let mut see = |at: usize| {
                let e = (w[at] / diagonal[at]).abs();
                error = if e > error || e.is_nan() { e } else { error };
            };
            (0..u).for_each(&mut see);
            free.iter().for_each(|at| see(*at as usize));
            if error <= FINE * (1.0 + largest) || error.is_nan() {
                break;
            }
            for (v, w) in v[..n].iter_mut().zip(w.iter()) {
                *v = -w;
            }
            for j in 0..u {
                let s = v[j] * d[j];
                sub_scaled(v, s, &m[j * width..][..width], j + 1);
            }
            y.clear();
            y.extend(free.iter().map(|at| v[*at as usize]));
            solve_free(triangle, pivots, y);
            v[u..].fill(0.0);
            for (at, y) in free.iter().zip(y.iter()) {
                v[*at as usize] = *y;
            }
            for j in (0..u).rev() {
                v[j] = (v[j] - dot_from(&m[j * width..][..width], v, j + 1)) * d[j];
            }
            for (x, v) in x.iter_mut().zip(v.iter()) {
                *x += v;
            }
            self.slack(n);
        }
        // Forces that rounding left outside their bounds.
        let mut clamped = false;
        for (x, place) in self.x[u..].iter_mut().zip(&self.tableau.rows) {
            if *x < place.lo {
                (*x, clamped) = (place.lo, true);
            } else if *x > place.hi {
                (*x, clamped) = (place.hi, true);
            }
        }
        if clamped {
            self.slack(n);
        }
        let (mut residual, mut largest): (f64, f64) = (0.0, 0.0);
        for at in 0..n {
            let (x, w) = (self.x[at], self.w[at]);
            let r = match at.checked_sub(u) {
                Some(b) => {
                    let place = &self.tableau.rows[b];
                    row_residual(x, w, self.diagonal[at], place.lo, place.hi)
                }
                None => (w / self.diagonal[at]).abs(),
            };
            if r > residual || r.is_nan() {
                residual = r;
            }
            largest = if x.abs() > largest { x.abs() } else { largest };
            if residual.is_nan() {
                break;
            }
        }
        (residual, largest)
    }

    /// `w = A x - b`.
    #[inline(always)]
    fn slack(&mut self, n: usize) {
        let width = width(n);
        let Self { upper, diagonal, b, x, w, .. } = self;
        for (w, b) in w.iter_mut().zip(b.iter()) {
            *w = -b;
        }
        for (r, row) in upper.chunks_exact(width).take(n).enumerate() {
            // Left of the diagonal stand zeros.
            let from = r & !3;
            let s = x[r];
            sub_scaled(w, -s, row, from);
            w[r] += dot_from(row, x, from) + diagonal[r] * s;
        }
    }

    /// Puts rows that are in the wrong state into a better one. Whether there were any.
    #[inline(always)]
    fn correct_states(&mut self, u: usize, largest: f64) -> bool {
        let close = 1e-14 * (1.0 + largest);
        let mut changed = false;
        for (b, place) in self.tableau.rows.iter_mut().enumerate() {
            let at = u + b;
            changed |= place.correct(self.x[at], self.w[at] / self.diagonal[at], close);
        }
        changed
    }

    /// Hands out the answer, and the bounds in the caller's order.
    #[inline(always)]
    fn store(&mut self, p: &mut BoxedLcp<'_>, u: usize) {
        for (row, at) in self.place.iter().enumerate() {
            p.x[row] = self.x[*at as usize];
            p.w[row] = self.w[*at as usize];
        }
        refill(&mut self.lo, p.n, f64::NEG_INFINITY);
        refill(&mut self.hi, p.n, f64::INFINITY);
        for (row, place) in self.order[u..].iter().zip(&self.tableau.rows) {
            (self.lo[*row as usize], self.hi[*row as usize]) = (place.lo, place.hi);
        }
    }
}

/// Solves with the factor of the free rows: `triangle` has as many columns as there are rows.
#[inline(always)]
fn solve_free(triangle: &[f64], pivots: &[f64], y: &mut [f64]) {
    let f = y.len();
    for i in 1..f {
        y[i] -= dot(&triangle[i * f..][..i], &y[..i]);
    }
    for (y, d) in y.iter_mut().zip(pivots) {
        *y *= d;
    }
    for i in (1..f).rev() {
        let (head, tail) = y.split_at_mut(i);
        kernel::sub_scaled(head, tail[0], &triangle[i * f..][..i]);
    }
}

/// The length of a row of the matrix with its right-hand side: whole blocks of four.
fn width(n: usize) -> usize {
    (n + 1).next_multiple_of(4)
}

fn refill(v: &mut Vec<f64>, n: usize, value: f64) {
    v.clear();
    v.resize(n, value);
}
