//! Dantzig's principal pivoting for the boxed linear complementarity problem ([`crate::problem`]).
//!
//! The idea (R. W. Cottle, G. B. Dantzig, "Complementary pivot theory of mathematical programming", 1968; D. Baraff, "Fast contact force
//! computation for nonpenetrating rigid bodies", SIGGRAPH 1994, with lower and upper bounds added): rows are taken in one
//! after the other, and after each the problem of the rows so far is solved exactly. A row that has been taken in is
//!
//! - in the clamped set C: its slack is held at `w = 0`, its unknown `x` is free, or
//! - in N: its unknown is held at a bound, its slack has the sign that the bound asks for.
//!
//! To take in row i, its unknown is driven from 0 in the direction `s` that brings its slack `w_i` to 0. The unknowns of C must follow
//! so that their slacks stay 0: `dx_C = -s A_CC^-1 A_Ci`; the slacks of N change by `dw_N = A_NC dx_C + s A_Ni`. The step
//! ends at the first thing that happens: `w_i` reaches 0 (i joins C), `x_i` reaches a bound (i joins N), the slack of a row in N
//! reaches 0 (it moves to C), or the unknown of a row in C reaches a bound (it moves to N). In the last two cases the
//! drive goes on. `A_CC = L D L^T` is kept up to date in `O(n^2)` per change (`envelope.rs`).
//!
//! Rows without any bound go first: they are factored and solved at one go and never leave C. Rows with a friction index
//! go last. When the first of those is reached, the bounds of all of them are frozen at `|hi_i x_f|` for the current `x`; `inf * 0`
//! counts as 0. So friction is bounded by the solution of the frictionless problem.
//!
//! Redundant problems have many solutions as far as rounding can tell, and which one comes out depends on the order of
//! rows and the breaking of ties. Both are therefore fixed: sets are stretches of one permutation, changed by swaps,
//! and of equal step lengths the first found is taken: the row's own slack, its own bound, the slacks of N, the unknowns of C.
//!
//! Nothing is ever moved in memory but indices: vectors stay in the caller's order, the matrix is a compressed copy
//! (`block_rows.rs`).

use crate::block_rows::BlockRows;
use crate::envelope::EnvelopeFactor;
use crate::error::LcpError;
use crate::problem::BoxedLcp;

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum DantzigStatus {
    /// The complementarity conditions hold.
    Solved,
    /// At some row no positive, finite step was left (the matrix is too close to singular). That row and all after it were given
    /// `x` = `w` = 0; the rows before it are solved among themselves.
    StepNotPositive {
        /// The row, in the caller's order.
        row: usize,
        /// The step length found.
        step: f64,
        /// How many rows were given up, that one included.
        given_up: usize,
    },
    /// The limit on set changes was reached. Rows not yet finished were given `x` = `w` = 0.
    PivotLimit {
        /// The row that was being driven.
        row: usize,
        /// How many rows were given up, that one included.
        given_up: usize,
    },
    /// With [`DantzigOptions::recover`]: all rows are solved but some, which are held at the force they had when they got stuck.
    Held {
        /// How many rows are held.
        rows: usize,
    },
    /// The numbers given were not all finite, or grew beyond all bounds: every `x` and `w` was set to 0.
    NotFinite,
}

/// What a solve did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DantzigReport {
    /// How it ended.
    pub status: DantzigStatus,
    /// The rows without bounds, factored at the start.
    pub unbounded: usize,
    /// The number of changes of the sets C and N.
    pub pivots: u64,
    /// Rows of C at the end.
    pub clamped: usize,
    /// Rows that were left out (`x` = 0) because nothing but zeros was left of them: empty rows without CFM.
    pub dropped: usize,
}

/// Choices for [`solve_dantzig_with`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DantzigOptions {
    /// The number of set changes after which to give up; by default 1000 + 100 n. In exact arithmetic the method ends by
    /// itself; with rounding and a singular matrix it could go round in circles.
    pub max_pivots: Option<u64>,
    /// Go on when a step has no length, where ODE (and the default) gives up this row and all after it. Such a step is taken as
    /// one of length zero, which resolves ties of two slacks that vanish together; a row that still cannot be
    /// brought to its end is held at the force it has reached, and the rows after it are solved with that.
    pub recover: bool,
}

/// So many steps of no length are taken for one row before it is held.
const MOST_EMPTY_STEPS: u32 = 32;

/// The row is in no place of the factor.
const NOWHERE: u32 = u32::MAX;

/// All memory that a solve needs. Made once, it grows to the largest problem met; a solve that fits allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct DantzigWorkspace {
    matrix: BlockRows,
    factor: EnvelopeFactor,
    /// All rows: C, then N, then those not yet taken in.
    order: Vec<u32>,
    /// The rows of C in the order of the factor.
    factor_row: Vec<u32>,
    /// The place of each row in the factor, or `NOWHERE`; padded to whole blocks.
    place: Vec<[u32; 4]>,
    /// Per row: its unknown, its direction (both padded), slack and direction of slack.
    x: Vec<[f64; 4]>,
    dx: Vec<[f64; 4]>,
    w: Vec<f64>,
    dw: Vec<f64>,
    /// The bounds in force, and whether a row of N is at the upper one.
    lo: Vec<f64>,
    hi: Vec<f64>,
    at_hi: Vec<bool>,
    /// Forward solution for the row being driven; how much of it holds for the current C; its first nonzero.
    column: Vec<f64>,
    valid: usize,
    first: usize,
    /// Solution of a triangular solve that is overwritten.
    scratch: Vec<f64>,
    unbounded: usize,
    clamped: usize,
    frozen: bool,
    pivots: u64,
    dropped: usize,
    held: usize,
}

impl DantzigWorkspace {
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

/// Solves a boxed linear complementarity problem by Dantzig's algorithm, with the default options.
///
/// # Errors
/// If the problem is malformed ([`BoxedLcp::check`]); `x` and `w` are then untouched. A problem that cannot be solved to the end is
/// no error but a [`DantzigStatus`].
pub fn solve_dantzig(
    problem: &mut BoxedLcp<'_>,
    workspace: &mut DantzigWorkspace,
) -> Result<DantzigReport, LcpError> {
    solve_dantzig_with(problem, workspace, &DantzigOptions::default())
}

/// Solves a boxed linear complementarity problem by Dantzig's algorithm.
///
/// # Errors
/// As [`solve_dantzig`].
pub fn solve_dantzig_with(
    problem: &mut BoxedLcp<'_>,
    workspace: &mut DantzigWorkspace,
    options: &DantzigOptions,
) -> Result<DantzigReport, LcpError> {
    problem.check()?;
    let n = problem.n;
    let limits =
        Limits { max_pivots: options.max_pivots.unwrap_or(1000 + 100 * n as u64), recover: options.recover };
    workspace.load(problem);
    workspace.solve_unbounded(problem.b);
    let mut status = DantzigStatus::Solved;
    for at in workspace.unbounded..n {
        let row = workspace.order[at] as usize;
        if let Err(stop) = workspace.take_in(at, problem, limits) {
            let given_up = n - at;
            status = match stop {
                Stop::Step(step) => DantzigStatus::StepNotPositive { row, step, given_up },
                Stop::Pivots => DantzigStatus::PivotLimit { row, given_up },
            };
            workspace.give_up(at);
            break;
        }
    }
    if status == DantzigStatus::Solved && workspace.held > 0 {
        status = DantzigStatus::Held { rows: workspace.held };
    }
    workspace.store(problem, &mut status);
    Ok(DantzigReport {
        status,
        unbounded: workspace.unbounded,
        pivots: workspace.pivots,
        clamped: workspace.clamped,
        dropped: workspace.factor.dropped() + workspace.dropped,
    })
}

/// The options, with defaults filled in.
#[derive(Clone, Copy)]
struct Limits {
    max_pivots: u64,
    recover: bool,
}

/// Why a row could not be taken in.
enum Stop {
    Step(f64),
    Pivots,
}

/// What ends a step.
#[derive(Clone, Copy)]
enum Event {
    /// The driven row's slack vanishes.
    Clamp,
    /// The driven row reaches its lower bound.
    AtLower,
    /// The driven row reaches its upper bound.
    AtUpper,
    /// The slack of the row at this place of the order, in N, vanishes.
    Release(usize),
    /// The row at this place of the order, in C, reaches its lower bound.
    HitLower(usize),
    /// The row at this place of the order, in C, reaches its upper bound.
    HitUpper(usize),
}

/// The shortest step found so far and what ends it.
struct Drive {
    step: f64,
    event: Event,
}

impl Drive {
    /// Takes a step length into account. Only a strictly shorter one counts, so that the first of equals wins.
    #[inline(always)]
    fn step_length(&mut self, step: f64, event: Event) {
        if step < self.step {
            self.step = step;
            self.event = event;
        }
    }
}

impl DantzigWorkspace {
    /// Copies the problem in, and orders the rows: those without bounds first, those with a friction index last.
    fn load(&mut self, problem: &BoxedLcp<'_>) {
        let n = problem.n;
        let blocks = n.div_ceil(4);
        self.matrix.assign(problem.a, n, problem.stride, problem.first);
        self.factor.clear();
        self.factor_row.clear();
        refill(&mut self.place, blocks, [NOWHERE; 4]);
        refill(&mut self.x, blocks, [0.0; 4]);
        refill(&mut self.dx, blocks, [0.0; 4]);
        refill(&mut self.w, n, 0.0);
        refill(&mut self.dw, n, 0.0);
        refill(&mut self.at_hi, n, false);
        refill(&mut self.column, n, 0.0);
        refill(&mut self.scratch, n, 0.0);
        self.lo.clear();
        self.lo.extend_from_slice(&problem.lo[..n]);
        self.hi.clear();
        self.hi.extend_from_slice(&problem.hi[..n]);
        self.order.clear();
        self.order.extend(0..n as u32);
        self.clamped = 0;
        self.frozen = false;
        self.pivots = 0;
        self.dropped = 0;
        self.held = 0;

        let mut unbounded = 0;
        for k in 0..n {
            let row = self.order[k] as usize;
            if problem.findex[row] < 0 && self.lo[row] == f64::NEG_INFINITY && self.hi[row] == f64::INFINITY {
                self.order.swap(unbounded, k);
                unbounded += 1;
            }
        }
        self.unbounded = unbounded;
        let mut end = n;
        for k in (unbounded..n).rev() {
            if problem.findex[self.order[k] as usize] >= 0 {
                end -= 1;
                self.order.swap(k, end);
            }
        }
    }

    /// Factors the rows without bounds and solves for them: `x_U = A_UU^-1 b_U`.
    fn solve_unbounded(&mut self, b: &[f64]) {
        let Self { matrix, factor, order, place, column, x, factor_row, unbounded, .. } = self;
        let rows = &order[..*unbounded];
        for (at, &row) in rows.iter().enumerate() {
            place.as_flattened_mut()[row as usize] = at as u32;
        }
        factor.factor(rows.len(), |k, out| {
            let row = rows[k] as usize;
            (matrix.scatter(row, place, 0, k, out), matrix.diagonal(row))
        });
        for (y, &row) in column.iter_mut().zip(rows) {
            *y = b[row as usize];
        }
        let y = &mut column[..rows.len()];
        factor.forward(y, 0, 0);
        factor.backward(y);
        let x = x.as_flattened_mut();
        for (y, &row) in y.iter().zip(rows) {
            x[row as usize] = *y;
        }
        factor_row.extend_from_slice(rows);
        self.clamped = rows.len();
    }

    /// Takes in the row at place `at` of the order, which is the first that is neither in C nor in N.
    fn take_in(&mut self, at: usize, problem: &BoxedLcp<'_>, limits: Limits) -> Result<(), Stop> {
        let row = self.order[at] as usize;
        if !self.frozen && problem.findex[row] >= 0 {
            self.freeze_friction(at, problem);
        }
        let (lo, hi) = (self.lo[row], self.hi[row]);
        if lo == 0.0 && hi == 0.0 {
            // Nothing to find: x = 0 and any slack will do. The slack is computed at the end.
            return Ok(());
        }
        if self.matrix.diagonal(row) == 0.0 {
            // An empty row: no force has an effect on its slack. ODE would divide by zero.
            self.dropped += 1;
            (self.lo[row], self.hi[row]) = (0.0, 0.0);
            return Ok(());
        }
        self.w[row] = self.matrix.row_dot(row, &self.x) - problem.b[row];
        let w = self.w[row];
        if lo == 0.0 && w >= 0.0 {
            self.at_hi[row] = false;
            return Ok(());
        }
        if hi == 0.0 && w <= 0.0 {
            self.at_hi[row] = true;
            return Ok(());
        }
        self.valid = 0;
        if w == 0.0 {
            self.solve_column(row);
            self.join_with_column(at);
            return Ok(());
        }
        self.drive(at, limits)
    }

    /// Freezes the bounds of all friction rows at what the current normal forces allow.
    fn freeze_friction(&mut self, at: usize, problem: &BoxedLcp<'_>) {
        self.frozen = true;
        let x = self.x.as_flattened();
        for &row in &self.order[at..] {
            let row = row as usize;
            if let Ok(normal) = usize::try_from(problem.findex[row]) {
                let force = x[normal];
                let bound = if force == 0.0 { 0.0 } else { (problem.hi[row] * force).abs() };
                self.lo[row] = -bound;
                self.hi[row] = bound;
            }
        }
    }

    /// Drives the row at place `at` until it joins C or N.
    fn drive(&mut self, at: usize, limits: Limits) -> Result<(), Stop> {
        let row = self.order[at] as usize;
        let (mut steps, mut empty_steps) = (0, 0);
        loop {
            let s = if self.w[row] <= 0.0 { 1.0 } else { -1.0 };
            self.direction(row, s);
            let Drive { mut step, event } = self.longest_step(at, s);
            let stuck = !(step > 0.0 && step.is_finite());
            if stuck && (!limits.recover || step.is_nan()) {
                return Err(Stop::Step(step));
            }
            if limits.recover {
                empty_steps += u32::from(stuck);
                steps += 1;
                if step.is_infinite() || empty_steps > MOST_EMPTY_STEPS || steps > 100 + 4 * self.order.len()
                {
                    self.hold(row);
                    return Ok(());
                }
                if stuck {
                    step = 0.0;
                }
            }
            if self.pivots >= limits.max_pivots {
                return Err(Stop::Pivots);
            }
            self.pivots += 1;
            for (x, dx) in self.x.as_flattened_mut().iter_mut().zip(self.dx.as_flattened()) {
                *x += step * dx;
            }
            for (w, dw) in self.w.iter_mut().zip(&self.dw) {
                *w += step * dw;
            }
            match event {
                Event::Clamp => {
                    self.w[row] = 0.0;
                    self.join_with_column(at);
                    return Ok(());
                }
                Event::AtLower => {
                    self.put_at_bound(row, false);
                    return Ok(());
                }
                Event::AtUpper => {
                    self.put_at_bound(row, true);
                    return Ok(());
                }
                Event::Release(k) => self.release(k),
                Event::HitLower(k) => self.hit(k, false),
                Event::HitUpper(k) => self.hit(k, true),
            }
        }
    }

    /// Leaves a row at the force it has: its bounds close on it, so that it stays in N for good.
    fn hold(&mut self, row: usize) {
        let x = self.x.as_flattened()[row];
        (self.lo[row], self.hi[row]) = (x, x);
        self.held += 1;
    }

    /// The forward solution `L^-1 A_Ci` for row i in `column`. What of it holds from before the last change of C is kept.
    fn solve_column(&mut self, row: usize) {
        let n = self.clamped;
        let from = self.valid.min(n);
        self.column[from..n].fill(0.0);
        self.first = self.matrix.scatter(row, &self.place, from, n, &mut self.column);
        self.factor.forward(&mut self.column[..n], from, self.first);
        self.valid = n;
    }

    /// `dx_C = -s A_CC^-1 A_Ci`, `dx_i = s`.
    fn direction(&mut self, row: usize, s: f64) {
        self.solve_column(row);
        let n = self.clamped;
        self.scratch[..n].copy_from_slice(&self.column[..n]);
        self.factor.backward(&mut self.scratch[..n]);
        let dx = self.dx.as_flattened_mut();
        dx.fill(0.0);
        for (y, &to) in self.scratch.iter().zip(&self.factor_row) {
            dx[to as usize] = -s * y;
        }
        dx[row] = s;
    }

    /// Finds how far the drive can go, and the directions of the slacks on the way.
    fn longest_step(&mut self, at: usize, s: f64) -> Drive {
        let row = self.order[at] as usize;
        let dw_i = self.matrix.row_dot(row, &self.dx);
        let w_i = self.w[row];
        self.dw[row] = dw_i;
        let x = self.x.as_flattened();
        let dx = self.dx.as_flattened();
        let (lo, hi) = (&self.lo, &self.hi);

        // 1: the row's own slack. Without any effect on it, the step is infinite in the direction of -w.
        let own = if dw_i != 0.0 {
            -w_i / dw_i
        } else if w_i == 0.0 {
            0.0
        } else {
            f64::INFINITY.copysign(-w_i)
        };
        let mut drive = Drive { step: own, event: Event::Clamp };
        // 2, 3: the row's own bounds.
        if s > 0.0 {
            if hi[row] < f64::INFINITY {
                drive.step_length(hi[row] - x[row], Event::AtUpper);
            }
        } else if lo[row] > f64::NEG_INFINITY {
            drive.step_length(x[row] - lo[row], Event::AtLower);
        }
        // 4: slacks of N that would take the wrong sign.
        for (k, &other) in self.order.iter().enumerate().take(at).skip(self.clamped) {
            let other = other as usize;
            if lo[other] == hi[other] {
                continue;
            }
            let dw = self.matrix.row_dot(other, &self.dx);
            self.dw[other] = dw;
            if if self.at_hi[other] { dw > 0.0 } else { dw < 0.0 } {
                drive.step_length(-self.w[other] / dw, Event::Release(k));
            }
        }
        // 5, 6: unknowns of C that would leave their bounds.
        for (k, &other) in self.order.iter().enumerate().take(self.clamped).skip(self.unbounded) {
            let other = other as usize;
            let dx = dx[other];
            if dx < 0.0 && lo[other] > f64::NEG_INFINITY {
                drive.step_length((lo[other] - x[other]) / dx, Event::HitLower(k));
            }
            if dx > 0.0 && hi[other] < f64::INFINITY {
                drive.step_length((hi[other] - x[other]) / dx, Event::HitUpper(k));
            }
        }
        drive
    }

    /// Fixes a row at one of its bounds, exactly.
    fn put_at_bound(&mut self, row: usize, upper: bool) {
        self.x.as_flattened_mut()[row] = if upper { self.hi[row] } else { self.lo[row] };
        self.at_hi[row] = upper;
    }

    /// The row at place `at` joins C; its forward solution is in `column`.
    fn join_with_column(&mut self, at: usize) {
        let row = self.order[at] as usize;
        self.factor.append(&self.column[..self.clamped], self.first, self.matrix.diagonal(row));
        self.join(at);
    }

    /// Book-keeping of a row that has joined the factor.
    fn join(&mut self, at: usize) {
        let row = self.order[at];
        self.dw[row as usize] = 0.0;
        self.place.as_flattened_mut()[row as usize] = self.clamped as u32;
        self.factor_row.push(row);
        self.order.swap(at, self.clamped);
        self.clamped += 1;
    }

    /// The row at place `at`, in N, moves to C.
    fn release(&mut self, at: usize) {
        let row = self.order[at] as usize;
        let n = self.clamped;
        self.w[row] = 0.0;
        self.scratch[..n].fill(0.0);
        let first = self.matrix.scatter(row, &self.place, 0, n, &mut self.scratch);
        self.factor.forward(&mut self.scratch[..n], 0, first);
        self.factor.append(&self.scratch[..n], first, self.matrix.diagonal(row));
        self.join(at);
    }

    /// The row at place `at`, in C, reaches a bound and moves to N.
    fn hit(&mut self, at: usize, upper: bool) {
        let row = self.order[at] as usize;
        self.put_at_bound(row, upper);
        let place = self.place.as_flattened_mut();
        let gone = place[row] as usize;
        place[row] = NOWHERE;
        self.factor.remove(gone);
        self.factor_row.remove(gone);
        for &moved in &self.factor_row[gone..] {
            place[moved as usize] -= 1;
        }
        self.clamped -= 1;
        self.order.swap(at, self.clamped);
        self.valid = self.valid.min(gone);
    }

    /// Gives the rows from place `at` on no force.
    fn give_up(&mut self, at: usize) {
        let x = self.x.as_flattened_mut();
        for &row in &self.order[at..] {
            x[row as usize] = 0.0;
            self.w[row as usize] = 0.0;
        }
        // The rows before keep their solution; those fixed at zero among the given up have no slack to report.
        self.order.truncate(at);
    }

    /// Hands the answer out, with the slacks that were not needed before.
    fn store(&mut self, problem: &mut BoxedLcp<'_>, status: &mut DantzigStatus) {
        let n = problem.n;
        for &row in &self.order[self.clamped..] {
            let row = row as usize;
            if self.lo[row] == self.hi[row] {
                self.w[row] = self.matrix.row_dot(row, &self.x) - problem.b[row];
            }
        }
        for &row in &self.order[..self.clamped] {
            self.w[row as usize] = 0.0;
        }
        let x = &self.x.as_flattened()[..n];
        let total: f64 = x.iter().chain(&self.w).map(|v| 0.0 * v).sum();
        if total.is_nan() {
            *status = DantzigStatus::NotFinite;
            problem.x[..n].fill(0.0);
            problem.w[..n].fill(0.0);
        } else {
            problem.x[..n].copy_from_slice(x);
            problem.w[..n].copy_from_slice(&self.w);
        }
    }
}

/// Makes a vector `n` copies of `value`, keeping its memory.
fn refill<T: Copy>(v: &mut Vec<T>, n: usize, value: T) {
    v.clear();
    v.resize(n, value);
}
