//! Block principal pivoting over the sparse factorisation ([`crate::sparse`]), for boxed problems of any size.
//!
//! Each row is guessed to be free or at one of its bounds. One sparse solve finds the forces and accelerations for that guess; rows
//! whose force left its bounds, or whose slack pushes it off the bound it is held at, were guessed wrong. All of them are corrected
//! at once (J. Júdice, F. Pires, "A block principal pivoting algorithm for large-scale strictly monotone linear complementarity
//! problems", 1994; A. Enzenhöfer, N. Lefebvre, S. Andrews, "Efficient block pivoting for multibody simulations with contact", I3D
//! 2019). From the guess of the step before, that takes one or two factorisations. It is the full Newton step on a convex function, and can
//! cycle: loose piles of boxes send it, and Newton's method with line search, through hundreds of factorisations. So when the number
//! of wrong rows has failed to halve three times, an interior-point method (`interior`) finds a better guess in about 20, from which one or
//! two pivots are left. Should pivoting stall again, its steps are shortened by exact line search ([`line`]), which cannot cycle.
//!
//! Friction is ODE's: first the problem without rows that have a friction index, then their bounds frozen at `|hi x_f|` and the whole
//! problem ([`crate::dantzig`] does the same); `inf * 0` is 0.
//!
//! The answer depends on the final guess alone. It is computed from zero by a factorisation whose operations have one order,
//! and rows that are at a bound and would stay there anyway (degenerate ones) are put at the bound first: a different way there ends
//! at the same bits.
//!
//! Rows with less CFM than `1e-10` of their diagonal are solved with that much, and the difference made good by proximal steps
//! `r' = r + (S' - S) lambda` from `lambda = 0`, which leave redundant rows at the forces of least norm. (R. T. Rockafellar, "Monotone
//! operators and the proximal point algorithm", 1976.)

mod abreast;
mod canonical;
mod fallback;
mod interior;
pub(crate) mod line;
mod residuals;

pub use abreast::{ABREAST, AbreastWorkspace, abreast, solve_abreast};

use crate::error::LcpError;
use crate::problem::check_row;
use crate::sparse::kernels::Six;
use crate::sparse::rows::largest;
use crate::sparse::symbolic::{Symbolic, SymbolicCache};
use crate::sparse::system::{Pass, System};
use crate::sparse::{NO_SPARSE_BODY, RowBlock, ScaledRow};
use line::{Bounds, Rows, state_of};

/// What a row's force does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RowState {
    /// Between its bounds; the row's equation holds.
    #[default]
    Free,
    /// At the lower bound.
    Lower,
    /// At the upper bound.
    Upper,
}

/// A boxed problem whose matrix is `J J^T + diag(sigma)`, with the places for its answer.
#[derive(Debug, Default)]
pub struct SparseLcp<'a> {
    /// The number of bodies, each with six unknowns.
    pub bodies: usize,
    /// Which rows act on which bodies. The blocks' ranges follow each other and cover all rows.
    pub blocks: &'a [RowBlock],
    /// The rows, scaled by the bodies' inverse mass; zero where there is no body.
    pub jacobian: &'a [ScaledRow],
    /// CFM/h of each row.
    pub sigma: &'a [f64],
    /// The right-hand side.
    pub rhs: &'a [f64],
    /// Lower bounds, as in [`BoxedLcp`](crate::BoxedLcp).
    pub lo: &'a [f64],
    /// Upper bounds; coefficients of friction for rows with a friction index.
    pub hi: &'a [f64],
    /// Friction indices, negative for none.
    pub findex: &'a [i32],
    /// Guess (or none) and final state of each row: in the problem without friction rows, and in the whole one. A guess saves
    /// time and changes nothing else. Without one a row starts as its own diagonal says.
    pub states: &'a mut [[Option<RowState>; 2]],
    /// Answer: the forces.
    pub x: &'a mut [f64],
}

/// Choices for [`solve_pivoting`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PivotingOptions {
    /// The most factorisations per problem, 200. Past that, problems of up to `most_dense_rows` rows go to Dantzig's method.
    pub max_factorisations: u32,
    /// The most rows that are ever handed to the dense method as a last resort, 1500.
    pub most_dense_rows: usize,
    /// Under which number the shape of the factor is remembered: problems that come again should give the same one.
    pub topology: usize,
}

impl Default for PivotingOptions {
    fn default() -> Self {
        Self { max_factorisations: 200, most_dense_rows: 1500, topology: 0 }
    }
}

/// What a solve did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PivotingReport {
    /// Factorisations, whole or of the columns that changed.
    pub factorisations: u32,
    /// How many of them were Newton steps with line search.
    pub newton_steps: u32,
    /// How many were steps of the interior-point method.
    pub interior_steps: u32,
    /// Whether the dense method had to help.
    pub fell_back: bool,
    /// The natural residual with the frozen bounds, `max |x - proj(x - w / A_ii)|`.
    pub residual: f64,
    /// The largest force.
    pub largest: f64,
    /// Blocks of 6x6 numbers in the factor.
    pub factor_blocks: usize,
}

impl PivotingReport {
    /// Whether the residual is at most `1e-10 (1 + max |x|)`.
    #[must_use]
    pub fn certified(&self) -> bool {
        self.residual <= CERTIFIED * (1.0 + self.largest)
    }
}

const CERTIFIED: f64 = 1e-10;
/// A row counts as wrong when it is off by more than this part of `1 + max |x|`.
const WRONG: f64 = 1e-14;
/// The same before refinement, which is left out while more than one row in `MANY` is wrong by that much.
const MANY: usize = 50;
const CLEARLY_WRONG: f64 = 1e-6;
/// Rounding of a slack, in parts of its right-hand side.
const NOISE: f64 = 4e-15;
/// So many times the number of wrong rows may fail to fall.
const CHANCES: u32 = 3;
const MOST_PROXIMAL_STEPS: u32 = 6;

/// All memory that a solve needs. Made once, it grows to the largest problem met.
#[derive(Clone, Debug, Default)]
pub struct PivotingWorkspace {
    shapes: SymbolicCache,
    system: System,
    lo: Vec<f64>,
    hi: Vec<f64>,
    /// The rows that may have a bound in force. All others are always free.
    bounded: Vec<u32>,
    state: Vec<RowState>,
    /// The states of which the factor is.
    factored: Vec<RowState>,
    proposed: Vec<RowState>,
    accepted: Vec<RowState>,
    /// Degenerate rows that have to be free.
    needed: Vec<bool>,
    /// The point with the smallest F so far, and `J` times the way from there.
    best_y: Vec<Six>,
    best_jy: Vec<f64>,
    jdy: Vec<f64>,
    best_lambda: Vec<f64>,
    residuals: Vec<f64>,
    interior: interior::Interior,
    fallback: fallback::Dense,
}

impl PivotingWorkspace {
    /// An empty workspace.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The lower bounds in force at the end of the last solve: those of friction rows as they were frozen.
    #[must_use]
    pub fn lower_bounds(&self) -> &[f64] {
        &self.lo
    }

    /// The upper bounds in force at the end of the last solve.
    #[must_use]
    pub fn upper_bounds(&self) -> &[f64] {
        &self.hi
    }
}

/// Solves a sparse boxed problem.
///
/// # Errors
/// If the problem is malformed: slices of different lengths, bounds that exclude zero, a friction index that names no row, blocks that
/// don't cover the rows in turn or name bodies that are not there. Nothing is written then. A problem that can't be solved to
/// the end is no error; the report's residual tells.
pub fn solve_pivoting(
    problem: &mut SparseLcp<'_>,
    options: &PivotingOptions,
    workspace: &mut PivotingWorkspace,
) -> Result<PivotingReport, LcpError> {
    check(problem)?;
    let PivotingWorkspace { shapes, .. } = workspace;
    let mut cache = core::mem::take(shapes);
    let report = {
        let shape = cache.get(options.topology, problem.bodies, problem.blocks, problem.lo, problem.hi);
        Solve {
            p: problem,
            options,
            shape,
            work: workspace,
            report: PivotingReport::default(),
            largest: 0.0,
            friction: true,
            pass: Pass::Own,
        }
        .run()
    };
    workspace.shapes = cache;
    Ok(report)
}

fn check(p: &SparseLcp<'_>) -> Result<(), LcpError> {
    let m = p.jacobian.len();
    let lengths = [
        ("sigma", p.sigma.len()),
        ("rhs", p.rhs.len()),
        ("lo", p.lo.len()),
        ("hi", p.hi.len()),
        ("findex", p.findex.len()),
        ("states", p.states.len()),
        ("x", p.x.len()),
    ];
    for (what, got) in lengths {
        if got < m {
            return Err(LcpError::Size { what, need: m, got });
        }
    }
    let mut next = 0;
    for block in p.blocks {
        if block.first as usize != next {
            return Err(LcpError::Index { what: "block", index: block.first as usize, end: next + 1 });
        }
        next += block.count as usize;
        let exists = |b: u32| b == NO_SPARSE_BODY || (b as usize) < p.bodies;
        let [a, b] = block.bodies;
        if !exists(a) || !exists(b) || (a == b && a != NO_SPARSE_BODY) {
            return Err(LcpError::Body { row: block.first as usize, body: block.bodies });
        }
    }
    if next != m {
        return Err(LcpError::Size { what: "blocks", need: m, got: next });
    }
    let rows = p.lo[..m].iter().zip(&p.hi[..m]).zip(&p.findex[..m]);
    let plain = rows.fold(true, |plain, ((lo, hi), f)| plain & (*f < 0) & (*lo <= 0.0) & (*hi >= 0.0));
    if plain {
        return Ok(());
    }
    (0..m).try_for_each(|row| check_row(row, m, p.lo[row], p.hi[row], p.findex[row]))
}

/// One solve.
struct Solve<'a, 'b> {
    p: &'a mut SparseLcp<'b>,
    options: &'a PivotingOptions,
    shape: &'a Symbolic,
    work: &'a mut PivotingWorkspace,
    report: PivotingReport,
    /// The largest force of the last solution.
    largest: f64,
    /// Whether any row has a friction index.
    friction: bool,
    /// Whether the problem is solved as it is or with the CFM that rows were raised to.
    pass: Pass,
}

impl Solve<'_, '_> {
    fn run(mut self) -> PivotingReport {
        let m = self.p.jacobian.len();
        self.work.system.load(self.p.jacobian, self.p.sigma, self.p.rhs, self.shape);
        self.work.factored.clear();
        self.report.factor_blocks = self.shape.blocks();
        self.friction = self.p.findex[..m].iter().any(|f| *f >= 0);
        self.bounds_without_friction();
        if self.friction {
            self.phase(0);
            self.freeze_friction();
        }
        self.phase(1);
        self.p.x[..m].copy_from_slice(&self.work.system.lambda);
        self.report
    }

    fn bounds_without_friction(&mut self) {
        let m = self.p.jacobian.len();
        let Self { p, work, .. } = self;
        let PivotingWorkspace { lo, hi, bounded, system, .. } = &mut **work;
        lo.clear();
        lo.extend_from_slice(&p.lo[..m]);
        hi.clear();
        hi.extend_from_slice(&p.hi[..m]);
        bounded.clear();
        let rows = lo.iter_mut().zip(hi.iter_mut()).zip(p.findex.iter().zip(&system.used_sigma));
        for (row, ((lo, hi), (findex, sigma))) in rows.enumerate() {
            // An empty row without CFM takes no force.
            if *findex >= 0 || *sigma <= 0.0 {
                (*lo, *hi) = (0.0, 0.0);
            }
            if *lo > f64::NEG_INFINITY || *hi < f64::INFINITY {
                bounded.push(row as u32);
            }
        }
    }

    fn freeze_friction(&mut self) {
        let Self { p, work, .. } = self;
        for row in 0..p.jacobian.len() {
            if let Ok(f) = usize::try_from(p.findex[row]) {
                let force = work.system.lambda[f];
                let empty = force == 0.0 || work.system.used_sigma[row] <= 0.0;
                work.hi[row] = if empty { 0.0 } else { (p.hi[row] * force).abs() };
                // Not -0.
                work.lo[row] = 0.0 - work.hi[row];
            }
        }
    }

    /// Solves with the bounds in force; `which` guess it starts from and leaves its states in.
    fn phase(&mut self, which: usize) {
        let m = self.p.jacobian.len();
        self.guess(which);
        self.pass = Pass::Own;
        let mut solved = self.pivot();
        if solved && self.pass == Pass::Raised && self.work.system.raised && !self.solve_as_given() {
            solved = self.proximal_steps();
        }
        self.clamp();
        self.measure();
        if !self.report.certified() || !solved {
            self.fall_back();
        }
        let states = self.p.states[..m].iter_mut().zip(&self.work.state);
        if self.friction {
            states.for_each(|(states, state)| states[which] = Some(*state));
        } else {
            states.for_each(|(states, state)| *states = [Some(*state); 2]);
        }
    }

    fn guess(&mut self, which: usize) {
        let Self { p, work, .. } = self;
        let PivotingWorkspace { system: s, state, lo, hi, bounded, .. } = &mut **work;
        state.clear();
        state.resize(p.jacobian.len(), RowState::Free);
        for row in bounded.iter().map(|row| *row as usize) {
            let (lo, hi) = (lo[row], hi[row]);
            if lo == f64::NEG_INFINITY && hi == f64::INFINITY {
                continue;
            }
            let guess = p.states[row][which].unwrap_or_else(|| {
                // A row that asks for nothing carries load, as those of a stack at rest do.
                let alone = s.rhs[row] / s.diagonal[row];
                if alone == 0.0 { RowState::Free } else { state_of(alone, lo, hi) }
            });
            state[row] = possible(guess, lo, hi);
        }
    }

    /// Pivots to the end; false if the limit was reached first.
    fn pivot(&mut self) -> bool {
        let (mut best, mut chances, mut newton) = (usize::MAX, CHANCES, false);
        let (mut best_value, mut advised) = (f64::INFINITY, false);
        for _ in 0..self.options.max_factorisations {
            self.solve_set();
            if !self.largest.is_finite() {
                return false;
            }
            let mut wrong = self.propose(CLEARLY_WRONG);
            if wrong * MANY < self.work.state.len() {
                self.refine_set();
                wrong = self.propose(WRONG);
            }
            if wrong == 0 {
                self.canonical();
                return true;
            }
            if !newton {
                // Remember the point with the least F, in case Newton's method takes over.
                let value = self.rows().value(&self.work.system.y, &self.work.system.jy);
                if value < best_value {
                    best_value = value;
                    self.keep_point();
                }
                if wrong <= best / 2 {
                    (best, chances) = (wrong, CHANCES);
                } else if chances > 0 {
                    chances -= 1;
                } else if !advised {
                    advised = true;
                    self.pass = Pass::Raised;
                    (best, chances) = (usize::MAX, CHANCES);
                    self.take_advice();
                    best_value = self.rows().value(&self.work.system.y, &self.work.system.jy);
                    self.keep_point();
                    continue;
                } else {
                    newton = true;
                    let PivotingWorkspace { state, best_jy, lo, hi, system, .. } = &mut *self.work;
                    rows(lo, hi, system).states(best_jy, state);
                    continue;
                }
                core::mem::swap(&mut self.work.state, &mut self.work.proposed);
            } else {
                self.report.newton_steps += 1;
                self.newton_step();
            }
        }
        false
    }

    /// Goes from the kept point towards the present one as far as F falls, and takes the states there.
    fn newton_step(&mut self) {
        let PivotingWorkspace { system, best_y, best_jy, jdy, state, proposed, lo, hi, .. } = &mut *self.work;
        for (dy, (y, best)) in system.dy.iter_mut().zip(system.y.iter().zip(best_y.iter())) {
            for r in 0..6 {
                dy[r] = y[r] - best[r];
            }
        }
        for (jdy, (jy, best)) in jdy.iter_mut().zip(system.jy.iter().zip(best_jy.iter())) {
            *jdy = jy - best;
        }
        let rows = rows(lo, hi, system);
        let t = rows.search(best_y, &system.dy, best_jy, jdy);
        for (best, dy) in best_y.iter_mut().zip(&system.dy) {
            for r in 0..6 {
                best[r] += t * dy[r];
            }
        }
        crate::sparse::rows::multiply_in_quads(self.p.blocks, self.p.jacobian, best_y, best_jy);
        if (t - 1.0).abs() < 1e-9 {
            // At the end of a whole step the forces are known better than `r - J y` tells them.
            core::mem::swap(state, proposed);
        } else {
            rows.states(best_jy, state);
        }
    }

    /// Takes the states that the interior-point method sees.
    fn take_advice(&mut self) {
        let Self { p, shape, work, report, .. } = self;
        let PivotingWorkspace { interior, system, state, lo, hi, factored, .. } = &mut **work;
        let steps = interior.guess(p.blocks, p.jacobian, shape, system, Bounds { lo, hi }, state);
        report.factorisations += steps;
        report.interior_steps += steps;
        factored.clear();
        system.factor.reset(shape);
    }

    fn keep_point(&mut self) {
        let PivotingWorkspace { system, best_y, best_jy, jdy, .. } = &mut *self.work;
        best_y.clone_from(&system.y);
        best_jy.clone_from(&system.jy);
        jdy.clone_from(&system.jy);
    }

    fn rows(&self) -> Rows<'_> {
        rows(&self.work.lo, &self.work.hi, &self.work.system)
    }

    /// Factors at the present states and solves, `J y` included, without refinement.
    fn solve_set(&mut self) {
        let Self { p, shape, work, report, .. } = self;
        let PivotingWorkspace { system, state, factored, lo, hi, bounded, .. } = &mut **work;
        let mut changed = factored.len() != state.len();
        if !changed && factored != state {
            for (i, block) in p.blocks.iter().enumerate() {
                let free = |s: &RowState| *s == RowState::Free;
                if block.range().any(|row| free(&state[row]) != free(&factored[row])) {
                    changed = true;
                    shape.for_each_touched(i, |column| system.factor.invalidate(column, shape));
                }
            }
        }
        if changed {
            system.factorise(p.blocks, p.jacobian, state, shape);
            factored.clone_from(state);
            report.factorisations += 1;
        }
        system.lambda.fill(0.0);
        for row in bounded.iter().map(|row| *row as usize) {
            match state[row] {
                RowState::Free => {}
                RowState::Lower => system.lambda[row] = lo[row],
                RowState::Upper => system.lambda[row] = hi[row],
            }
        }
        self.largest = system.solve(p.blocks, p.jacobian, state, shape);
        if !bounded.is_empty() {
            system.product(p.blocks, p.jacobian, shape);
        }
    }

    /// Refines the solution of the present states.
    fn refine_set(&mut self) {
        let Self { p, shape, work, pass, .. } = self;
        work.system.refine_roughly(p.blocks, p.jacobian, &work.state, shape, *pass);
        if !work.bounded.is_empty() {
            work.system.product(p.blocks, p.jacobian, shape);
        }
    }

    /// Finds the rows whose state is wrong by more than so many parts of the largest force, and proposes better ones. Returns their number.
    fn propose(&mut self, tolerance: f64) -> usize {
        let tolerance = tolerance * (1.0 + self.largest);
        let PivotingWorkspace { system: s, state, proposed, lo, hi, bounded, .. } = &mut *self.work;
        if bounded.is_empty() {
            return 0;
        }
        proposed.clone_from(state);
        let sigma = if self.pass == Pass::Own { &s.sigma } else { &s.used_sigma };
        let slack = |row: usize| s.jy[row] + sigma[row] * s.lambda[row] - s.rhs[row];
        let least = |row: usize| tolerance * s.diagonal[row] + NOISE * s.rhs[row].abs();
        let mut wrong = 0;
        for row in bounded.iter().map(|row| *row as usize) {
            let (state, lambda, lo, hi) = (&mut proposed[row], s.lambda[row], lo[row], hi[row]);
            let better = match *state {
                RowState::Free if lambda >= lo - tolerance && lambda <= hi + tolerance => continue,
                _ if lo == hi => continue,
                RowState::Free if lambda < lo - tolerance => RowState::Lower,
                RowState::Free if lambda > hi + tolerance => RowState::Upper,
                RowState::Lower if slack(row) < -least(row) => RowState::Free,
                RowState::Upper if slack(row) > least(row) => RowState::Free,
                _ => continue,
            };
            *state = better;
            wrong += 1;
        }
        wrong
    }

    /// Solves at the present states with the rows' own CFM; whether the states are right for it.
    fn solve_as_given(&mut self) -> bool {
        self.pass = Pass::Own;
        self.solve_set();
        self.refine_set();
        if self.propose(WRONG) > 0 {
            self.pass = Pass::Raised;
            return false;
        }
        self.canonical();
        true
    }

    /// Repeats the solve with the right-hand side that makes good the CFM that rows were given beyond their own.
    fn proximal_steps(&mut self) -> bool {
        let mut before = f64::INFINITY;
        for _ in 0..MOST_PROXIMAL_STEPS {
            let s = &mut self.work.system;
            let mut change: f64 = 0.0;
            let mut largest: f64 = 0.0;
            for row in 0..s.lambda.len() {
                let extra = s.used_sigma[row] - s.sigma[row];
                if extra != 0.0 {
                    let rhs = self.p.rhs[row] + extra * s.lambda[row];
                    let step = ((rhs - s.rhs[row]) / s.diagonal[row]).abs();
                    change = if step > change { step } else { change };
                    s.rhs[row] = rhs;
                }
                largest = if s.lambda[row].abs() > largest { s.lambda[row].abs() } else { largest };
            }
            // What is left grows no smaller when redundant rows contradict each other.
            let falls = change < 0.5 * before;
            if !falls || change <= 1e-17 * (1.0 + largest) {
                break;
            }
            before = change;
            if !self.pivot() {
                return false;
            }
        }
        true
    }

    /// Brings forces that rounding left outside their bounds inside.
    fn clamp(&mut self) {
        let PivotingWorkspace { system, lo, hi, bounded, .. } = &mut *self.work;
        for row in bounded.iter().map(|row| *row as usize) {
            let lambda = &mut system.lambda[row];
            if *lambda < lo[row] {
                *lambda = lo[row];
            } else if *lambda > hi[row] {
                *lambda = hi[row];
            }
        }
    }

    /// The natural residual of the forces as they are, for the problem as it was given.
    fn measure(&mut self) {
        let Self { p, work, report, .. } = self;
        let PivotingWorkspace { system, lo, hi, residuals, .. } = &mut **work;
        system.accelerations(p.blocks, p.jacobian);
        residuals::find(system, p.rhs, Bounds { lo, hi }, residuals);
        report.residual = largest(residuals);
        report.largest = largest(&system.lambda);
    }

    /// Tries the dense method, and takes its answer if it is better.
    fn fall_back(&mut self) {
        let m = self.p.jacobian.len();
        if m > self.options.most_dense_rows {
            return;
        }
        let before = self.report.residual;
        self.work.best_lambda.clone_from(&self.work.system.lambda);
        let PivotingWorkspace { fallback, system, lo, hi, .. } = &mut *self.work;
        fallback.solve(self.p, lo, hi, &mut system.lambda);
        self.clamp();
        self.measure();
        if self.report.residual < before || before.is_nan() {
            self.report.fell_back = true;
            let PivotingWorkspace { system, state, lo, hi, .. } = &mut *self.work;
            for row in 0..m {
                state[row] = state_of(system.lambda[row], lo[row], hi[row]);
            }
        } else {
            self.work.system.lambda.clone_from(&self.work.best_lambda);
            self.measure();
        }
    }
}

fn rows<'a>(lo: &'a [f64], hi: &'a [f64], s: &'a System) -> Rows<'a> {
    Rows { bounds: Bounds { lo, hi }, rhs: &s.rhs, sigma: &s.used_sigma, inverse_sigma: &s.inverse_sigma }
}

/// The state, or the nearest that the bounds allow.
fn possible(state: RowState, lo: f64, hi: f64) -> RowState {
    match state {
        _ if lo == hi => RowState::Lower,
        RowState::Lower if lo == f64::NEG_INFINITY => RowState::Free,
        RowState::Upper if hi == f64::INFINITY => RowState::Free,
        state => state,
    }
}
