//! Projected successive over-relaxation, the method of ODE's quick step.
//!
//! The idea: visit the rows one after the other; change the row's force so that its own equation holds (times an over-relaxation
//! factor W), clamp it to its bounds, and let the bodies' accelerations follow at once. Each visit costs a few dozen operations and
//! the matrix `A = J M^-1 J^T + C` is never formed. (C. W. Cryer, "The solution of a quadratic programming problem using systematic
//! overrelaxation", 1971; in rigid-body form E. Catto, "Iterative dynamics with temporal coherence", 2005.)
//!
//! With `a = M^-1 J^T lambda` kept per body (6 numbers), `B_i = M^-1 J_i^T`, `C_i = cfm_i / h` and `d_i = W / (J_i B_i + C_i)`, a visit of row i is
//!
//! ```text
//!    new     = clamp( lambda_i + d_i (rhs_i - J_i a - C_i lambda_i),  lo_i, hi_i )
//!    a      += B_i (new - lambda_i)
//!    lambda_i = new
//! ```
//!
//! A row with a friction index f is clamped to `+- |hi_i lambda_f|` with the force `lambda_f` of this moment.
//!
//! **Order.** At first all rows without a friction index in their order, then all with one. At the start of the iterations 8, 16, 24, …
//! the whole order is shuffled in place: for k = 1 … m-1, r = random(k + 1), entries k and r change places.
//!
//! Up to two dozen rows are visited in the same order by other means: those of one body, such as a box on the ground, in lanes (`alone`,
//! `loom`), those of few bodies on their matrix (`small`); several problems side by side if [`begin_sor_rows`] or [`begin_sor_alone`] has
//! taken them in (`together`).

mod alone;
mod loom;
mod small;
mod sweep;
mod together;

pub use alone::LoneRow;
pub use together::finish_sor;

use crate::error::{LcpError, check_len};
use alone::{Alone, PLACES, check_bounds};
use core::marker::PhantomData;
use ferrode_math::simd::{Quad, QuadKernel, dispatch_quads};
use small::Small;
use std::borrow::Borrow;
use sweep::{Interleaving, InverseMass, PackedRow, Six, Stretch, Sweep, find_stretches, interleave};

/// Stands for "no body".
pub const NO_BODY: u32 = u32::MAX;

/// How many iterations lie between two shuffles of the rows.
const SHUFFLE_PERIOD: u32 = 8;

/// The bodies that stand for no body: several, by turns, so that rows that have none of their own don't wait for each other.
const STAND_INS: usize = 8;

/// What the solver needs to know of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SorBody {
    /// The reciprocal of the mass; 0 for a body that forces do not move.
    pub inv_mass: f64,
    /// The inverse of the inertia in the world frame, symmetric, row by row.
    pub inv_inertia: [f64; 9],
}

/// One scalar constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SorRow {
    /// The Jacobian: linear and angular part of the first body, linear and angular part of the second (world frame).
    pub j: [f64; 12],
    /// The right-hand side of `A lambda = rhs`: `c / h - J (V / h + M^-1 f)`.
    pub rhs: f64,
    /// Constraint force mixing divided by the step size.
    pub cfm: f64,
    /// The lower bound of the force. Not read with a friction index.
    pub lo: f64,
    /// The upper bound of the force; with a friction index the coefficient of friction.
    pub hi: f64,
    /// The row whose force scales the bounds, or a negative number for none.
    pub findex: i32,
    /// The two bodies, [`NO_BODY`] for none.
    pub body: [u32; 2],
}

impl Default for SorRow {
    fn default() -> Self {
        Self {
            j: [0.0; 12],
            rhs: 0.0,
            cfm: 0.0,
            lo: f64::NEG_INFINITY,
            hi: f64::INFINITY,
            findex: -1,
            body: [NO_BODY; 2],
        }
    }
}

/// The acceleration of a body by all constraint forces: linear part (0..3), angular part (3..6), padding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct SorAcceleration(pub [f64; 8]);

impl SorAcceleration {
    /// The linear acceleration, world frame.
    #[must_use]
    pub fn linear(&self) -> [f64; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }

    /// The angular acceleration, world frame.
    #[must_use]
    pub fn angular(&self) -> [f64; 3] {
        [self.0[3], self.0[4], self.0[5]]
    }
}

/// What an infinite friction coefficient times a vanishing normal force is to mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InfTimesZero {
    /// No bounds at all, as in ODE's quick step, where a contact that separates still holds sideways.
    #[default]
    Unbounded,
    /// No force.
    Zero,
}

/// Lets the number of iterations follow the need. The sums looked at are those of all changes of a body's acceleration in one
/// iteration, upward and downward changes apart; the largest component of `B_i` stands for the row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicIterations {
    /// Stop early when all sums stay below this. 0: never.
    pub premature_exit_delta: f64,
    /// How many iterations may be added when the given number was not enough.
    pub extra_iterations: u32,
    /// During added iterations, stop when all sums stay below this.
    pub extra_requirement_delta: f64,
}

/// The parameters of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SorParams {
    /// The number of iterations.
    pub iterations: u32,
    /// The over-relaxation W, 1.3 in ODE.
    pub over_relaxation: f64,
    /// The meaning of infinity times zero in friction bounds.
    pub inf_times_zero: InfTimesZero,
    /// A number of iterations that depends on the progress; `None` for exactly [`SorParams::iterations`].
    pub dynamic: Option<DynamicIterations>,
}

impl Default for SorParams {
    fn default() -> Self {
        Self { iterations: 20, over_relaxation: 1.3, inf_times_zero: InfTimesZero::default(), dynamic: None }
    }
}

/// What ended the iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SorExit {
    /// The given number of iterations was done.
    Completed,
    /// It had converged before.
    Premature,
    /// It converged during the extra iterations.
    Prolonged,
    /// All extra iterations were done.
    FullExtra,
}

/// What a solve did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SorReport {
    /// The number of iterations done.
    pub iterations: u32,
    /// What ended them.
    pub exit: SorExit,
    /// Whether all forces and accelerations are finite numbers.
    pub finite: bool,
}

/// How far a solve is.
#[derive(Clone, Copy, Debug, Default)]
enum State {
    /// There is no answer.
    #[default]
    Idle,
    /// The problem is taken in, and its random numbers are drawn.
    Begun {
        iterations: u32,
        /// It is one of a body alone.
        alone: bool,
    },
    Ended {
        iterations: u32,
        exit: SorExit,
    },
}

/// All memory that a solve needs, and its answer. Made once, it grows to the largest problem met; a solve that fits
/// allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct SorWorkspace {
    /// The bodies' inverse masses, and that of no body.
    mass: Vec<InverseMass>,
    packed: Vec<PackedRow>,
    order: Vec<u32>,
    /// The order before the first shuffle, as stretches of rows on the same bodies.
    stretches: Vec<Stretch>,
    interleaving: Interleaving,
    /// Scratch: the rows with a friction index.
    friction: Vec<u32>,
    /// The forces, and the one that is always 1.
    lambda: Vec<f64>,
    /// The accelerations, and those of [`STAND_INS`] bodies that stand for no body.
    acceleration: Vec<SorAcceleration>,
    small: Small,
    alone: Alone,
    /// None, or two: most problems of one body are visited in another's.
    looms: Vec<loom::Loom>,
    /// The number of rows, and of bodies, of the last problem that was taken in.
    rows: usize,
    bodies: usize,
    /// All rows are of one body.
    one_body: bool,
    /// What [`begin_sor_rows`] has begun, or how it ended.
    state: State,
    /// Largest component of `B` per row and body; sums of upward and downward changes per body.
    weight: Vec<[f64; 2]>,
    change: Vec<[f64; 2]>,
}

impl SorWorkspace {
    /// An empty workspace.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The forces of the last solve, one per row.
    #[must_use]
    pub fn lambda(&self) -> &[f64] {
        &self.lambda[..self.rows]
    }

    /// The accelerations of the last solve, one per body.
    #[must_use]
    pub fn acceleration(&self) -> &[SorAcceleration] {
        &self.acceleration[..self.bodies]
    }

    /// What the last solve did; `None` if there was none, or it has not ended.
    #[must_use]
    pub fn report(&self) -> Option<SorReport> {
        let State::Ended { iterations, exit } = self.state else { return None };
        let (blocks, rest) = self.lambda.as_chunks();
        let finite = all_finite(blocks.iter())
            && rest.iter().all(|v| v.is_finite())
            && all_finite(self.acceleration.iter().map(|a| &a.0));
        Some(SorReport { iterations, exit, finite })
    }
}

/// Solves for the constraint forces of `rows` on `bodies`, and the accelerations they cause.
///
/// `random(n)` gives the next random number below n (ODE: `dRandInt`); it is asked m - 1 times per shuffle. The answer is in the
/// workspace.
///
/// # Errors
/// If a row names a body or a friction row that does not exist, one body twice, or has bounds that are not numbers
/// or the wrong way round; if a parameter is not a usable number. The workspace then holds no answer.
pub fn solve_sor(
    bodies: &[SorBody],
    rows: &[SorRow],
    params: &SorParams,
    random: &mut impl FnMut(u32) -> u32,
    workspace: &mut SorWorkspace,
) -> Result<SorReport, LcpError> {
    solve_sor_rows(bodies, rows.len(), rows.iter(), params, random, workspace)
}

/// [`solve_sor`] for `count` rows that are made on the way: each is asked for once, in order, and need not be kept.
///
/// # Errors
/// As [`solve_sor`], and if there are fewer rows than `count`; more are not asked for.
pub fn solve_sor_rows(
    bodies: &[SorBody],
    count: usize,
    rows: impl Iterator<Item: Borrow<SorRow>>,
    params: &SorParams,
    random: &mut impl FnMut(u32) -> u32,
    workspace: &mut SorWorkspace,
) -> Result<SorReport, LcpError> {
    begin_sor_rows(bodies, count, rows, params, random, workspace)?;
    finish_sor(core::iter::once(&mut *workspace));
    Ok(workspace.report().unwrap_or(SorReport { iterations: 0, exit: SorExit::Completed, finite: true }))
}

/// The first half of [`solve_sor_rows`]: takes the problem in and draws all random numbers. A problem of few rows waits for
/// [`finish_sor`] then, which solves several in less time than one by one; any other is solved at once.
///
/// # Errors
/// As [`solve_sor_rows`].
pub fn begin_sor_rows(
    bodies: &[SorBody],
    count: usize,
    rows: impl Iterator<Item: Borrow<SorRow>>,
    params: &SorParams,
    random: &mut impl FnMut(u32) -> u32,
    workspace: &mut SorWorkspace,
) -> Result<(), LcpError> {
    workspace.state = State::Idle;
    check_params(params)?;
    if let Err(error) = dispatch_quads(Load { workspace, bodies, count, rows, params }) {
        workspace.refuse();
        return Err(error);
    }
    match (params.dynamic, params.inf_times_zero) {
        (None, InfTimesZero::Unbounded) => {
            dispatch_quads(Run::<_, false, false> { workspace, params, random })
        }
        (None, InfTimesZero::Zero) => dispatch_quads(Run::<_, true, false> { workspace, params, random }),
        (Some(_), InfTimesZero::Unbounded) => {
            dispatch_quads(Run::<_, false, true> { workspace, params, random })
        }
        (Some(_), InfTimesZero::Zero) => dispatch_quads(Run::<_, true, true> { workspace, params, random }),
    }
    Ok(())
}

/// [`begin_sor_rows`] for `count` rows of one body alone, with the same answer.
///
/// # Errors
/// As [`begin_sor_rows`].
pub fn begin_sor_alone(
    body: &SorBody,
    count: usize,
    rows: impl Iterator<Item = LoneRow>,
    params: &SorParams,
    random: &mut impl FnMut(u32) -> u32,
    workspace: &mut SorWorkspace,
) -> Result<(), LcpError> {
    if params.dynamic.is_some() || !alone::suits(count, params.iterations) {
        let rows = rows.map(|LoneRow { j: [a, b, c, d, e, f], rhs, cfm, lo, hi, findex }| SorRow {
            j: [a, b, c, d, e, f, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            rhs,
            cfm,
            lo,
            hi,
            findex,
            body: [0, NO_BODY],
        });
        return begin_sor_rows(core::slice::from_ref(body), count, rows, params, random, workspace);
    }
    workspace.state = State::Idle;
    check_params(params)?;
    let taken = dispatch_quads(LoadAlone { workspace, body, count, rows, params, random });
    if taken.is_err() {
        workspace.refuse();
    }
    taken
}

/// Whether all numbers are finite: 0 times a number is 0 unless the number is infinite or none.
fn all_finite<'a>(blocks: impl Iterator<Item = &'a [f64; 8]>) -> bool {
    let mut s = [0.0; 8];
    for block in blocks {
        for l in 0..8 {
            s[l] += 0.0 * block[l];
        }
    }
    s.iter().all(|v| *v == 0.0)
}

/// Taking the rows in, compiled for the machine.
struct Load<'a, R> {
    workspace: &'a mut SorWorkspace,
    bodies: &'a [SorBody],
    count: usize,
    rows: R,
    params: &'a SorParams,
}

impl<R: Iterator<Item: Borrow<SorRow>>> QuadKernel for Load<'_, R> {
    type Out = Result<(), LcpError>;

    #[inline(always)]
    fn run<Q: Quad>(self) -> Result<(), LcpError> {
        self.workspace.load::<Q>(self.bodies, self.count, self.rows, self.params)
    }
}

/// Taking the rows of a body alone in, and drawing the order of their visits, compiled for the machine.
struct LoadAlone<'a, I, R> {
    workspace: &'a mut SorWorkspace,
    body: &'a SorBody,
    count: usize,
    rows: I,
    params: &'a SorParams,
    random: &'a mut R,
}

impl<I: Iterator<Item = LoneRow>, R: FnMut(u32) -> u32> QuadKernel for LoadAlone<'_, I, R> {
    type Out = Result<(), LcpError>;

    #[inline(always)]
    fn run<Q: Quad>(self) -> Result<(), LcpError> {
        let Self { workspace, body, count, rows, params, random } = self;
        workspace.blank(count, PLACES, 1, 1);
        workspace.alone.load::<Q>(body, count, rows, params)?;
        workspace.alone.draw(random);
        workspace.state = State::Begun { iterations: params.iterations, alone: true };
        Ok(())
    }
}

/// Whether the few rows that there are can be solved by their matrix.
fn is_small(rows: usize, bodies: usize, params: &SorParams) -> bool {
    params.dynamic.is_none() && small::suits(rows, bodies, params.iterations)
}

/// Shuffles the order of the rows.
fn shuffle<T>(order: &mut [T], random: &mut impl FnMut(u32) -> u32) {
    for k in 1..order.len() {
        let r = random(k as u32 + 1) as usize;
        order.swap(k, r.min(k));
    }
}

/// The iterations, compiled for the machine. `ZERO`: infinity times zero is zero; `DYNAMIC`: watch the changes.
struct Run<'a, R, const ZERO: bool, const DYNAMIC: bool> {
    workspace: &'a mut SorWorkspace,
    params: &'a SorParams,
    random: &'a mut R,
}

impl<R: FnMut(u32) -> u32, const ZERO: bool, const DYNAMIC: bool> QuadKernel for Run<'_, R, ZERO, DYNAMIC> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        self.workspace.state = self.workspace.run::<Q, ZERO, DYNAMIC>(self.params, self.random);
    }
}

fn check_params(params: &SorParams) -> Result<(), LcpError> {
    let usable = |what, value: f64| {
        if value.is_finite() && value >= 0.0 { Ok(()) } else { Err(LcpError::Parameter { what, value }) }
    };
    usable("over_relaxation", params.over_relaxation)?;
    if let Some(dynamic) = params.dynamic {
        usable("premature_exit_delta", dynamic.premature_exit_delta)?;
        usable("extra_requirement_delta", dynamic.extra_requirement_delta)?;
    }
    Ok(())
}

/// Checks one of `rows` rows on `bodies` bodies.
#[inline(always)]
fn check_row(row: usize, r: &SorRow, rows: usize, bodies: usize) -> Result<(), LcpError> {
    check_bounds(row, r.findex, r.lo, r.hi, rows)?;
    let known = |b: u32| b == NO_BODY || (b as usize) < bodies;
    let twice = r.body[0] == r.body[1] && r.body[0] != NO_BODY;
    if !known(r.body[0]) || !known(r.body[1]) || twice {
        return Err(LcpError::Body { row, body: r.body });
    }
    Ok(())
}

impl SorWorkspace {
    /// Sets so many forces and accelerations to zero, of which those of the rows and bodies are the answer.
    #[inline(always)]
    fn blank(&mut self, rows: usize, forces: usize, bodies: usize, accelerations: usize) {
        (self.rows, self.bodies) = (rows, bodies);
        self.lambda.clear();
        self.lambda.resize(forces, 0.0);
        self.acceleration.clear();
        self.acceleration.resize(accelerations, SorAcceleration::default());
    }

    /// Leaves no answer.
    fn refuse(&mut self) {
        (self.rows, self.bodies) = (0, 0);
    }

    /// Packs the rows and sets forces and accelerations to zero.
    #[inline(always)]
    fn load<Q: Quad>(
        &mut self,
        bodies: &[SorBody],
        m: usize,
        rows: impl Iterator<Item: Borrow<SorRow>>,
        params: &SorParams,
    ) -> Result<(), LcpError> {
        let nobody = bodies.len();
        self.blank(m, PLACES.max(m + 1), nobody, nobody + STAND_INS);
        self.lambda[m] = 1.0;
        self.mass.clear();
        self.mass.extend(bodies.iter().map(InverseMass::new));
        self.mass.push(InverseMass::default());
        // Rows of an earlier solve may stand behind the m of this one; every row is written whole.
        if self.packed.len() < m {
            self.packed.resize(m, PackedRow::default());
        }
        self.order.clear();
        self.one_body = nobody == 1;
        self.friction.clear();
        self.weight.clear();
        self.change.clear();
        if params.dynamic.is_some() {
            self.weight.reserve(m);
            self.change.resize(nobody + STAND_INS, [0.0; 2]);
        }
        let mut count = 0;
        let mut rows = rows;
        for (row, packed) in self.packed[..m].iter_mut().enumerate() {
            let Some(r) = rows.next() else { break };
            let r = r.borrow();
            count += 1;
            check_row(row, r, m, nobody)?;
            let j = r.j.as_chunks().0;
            let (j0, j1) = (Six::<Q>::load(&j[0]), Six::<Q>::load(&j[1]));
            let [first, second] = r.body.map(|body| (body as usize).min(nobody));
            self.one_body &= first == 0;
            let (b0, b1) = (self.mass[first].times(&j[0], j0), self.mass[second].times(&j[1], j1));
            let diagonal = Six::dot([j0, j1], [b0, b1], r.cfm);
            // An empty row without CFM has no effect on anything; its force stays 0.
            let d =
                if diagonal == 0.0 || diagonal.is_nan() { 0.0 } else { params.over_relaxation / diagonal };
            let (lo, hi, scale) = if r.findex >= 0 {
                self.friction.push(row as u32);
                (-r.hi.abs(), r.hi.abs(), r.findex as u32)
            } else {
                self.order.push(row as u32);
                (r.lo, r.hi, m as u32)
            };
            packed.set_vectors([j0.scaled(-d), b0, j1.scaled(-d), b1]);
            packed.rhs = r.rhs * d;
            packed.cfm = r.cfm * d;
            (packed.lo, packed.hi, packed.scale) = (lo, hi, scale);
            let stand_in = nobody + row % STAND_INS;
            packed.body = [first, second].map(|body| if body == nobody { stand_in } else { body } as u32);
            if params.dynamic.is_some() {
                self.weight.push([b0.largest(), b1.largest()]);
            }
        }
        check_len("rows", count, m)?;
        self.order.extend_from_slice(&self.friction);
        if self.is_alone(params) || is_small(m, nobody, params) {
            return Ok(());
        }
        find_stretches::<Q>(&self.order, &self.packed, nobody, &mut self.stretches);
        let Self { order, packed, stretches, interleaving, .. } = self;
        interleave(order, &packed[..m], nobody, stretches, interleaving);
        Ok(())
    }

    /// Whether the rows are those of one body and few.
    fn is_alone(&self, params: &SorParams) -> bool {
        self.one_body && params.dynamic.is_none() && alone::suits(self.order.len(), params.iterations)
    }

    /// Does the iterations, or prepares them if they can wait for others'. `ZERO`: infinity times zero is zero; `DYNAMIC`: watch the changes.
    #[inline(always)]
    fn run<Q: Quad, const ZERO: bool, const DYNAMIC: bool>(
        &mut self,
        params: &SorParams,
        random: &mut impl FnMut(u32) -> u32,
    ) -> State {
        let planned = params.iterations;
        let ended = |iterations, exit| State::Ended { iterations, exit };
        if planned == 0 {
            return ended(0, SorExit::Completed);
        }
        let (rows, bodies) = (self.rows, self.bodies);
        if !DYNAMIC && self.is_alone(params) {
            self.alone.take_over(&self.packed[..rows], &self.order, params);
            self.alone.draw(random);
            return State::Begun { iterations: planned, alone: true };
        }
        if !DYNAMIC && is_small(rows, bodies, params) {
            self.small.begin::<Q>(&self.packed[..rows], &self.order, bodies, params, random);
            return State::Begun { iterations: planned, alone: false };
        }
        let mut done = 0;
        let mut extra = 0;
        let mut limit = params.dynamic.map_or(0.0, |d| d.premature_exit_delta);
        loop {
            if done >= SHUFFLE_PERIOD && done % SHUFFLE_PERIOD == 0 {
                shuffle(&mut self.order, random);
            }
            self.sweep::<Q, ZERO, DYNAMIC>(done >= SHUFFLE_PERIOD);
            done += 1;
            let added = params.dynamic.map_or(0, |d| d.extra_iterations);
            if done == planned.saturating_add(extra) {
                if extra != 0 || added == 0 {
                    return ended(done, if extra != 0 { SorExit::FullExtra } else { SorExit::Completed });
                }
                extra = added;
                limit = params.dynamic.map_or(0.0, |d| d.extra_requirement_delta);
            }
            if DYNAMIC && self.is_calm(limit) {
                let exit = match done.cmp(&planned) {
                    std::cmp::Ordering::Less => SorExit::Premature,
                    std::cmp::Ordering::Equal => SorExit::Completed,
                    std::cmp::Ordering::Greater => SorExit::Prolonged,
                };
                return ended(done, exit);
            }
        }
    }

    /// Visits every row once: in stretches of rows on the same bodies until the first shuffle, one by one after.
    #[inline(always)]
    fn sweep<Q: Quad, const ZERO: bool, const DYNAMIC: bool>(&mut self, shuffled: bool) {
        let Self { packed, order, stretches, lambda, acceleration, weight, change, bodies, .. } = self;
        let nobody = *bodies;
        let mut sweep = Sweep::<Q, ZERO, DYNAMIC> {
            packed,
            lambda,
            acceleration,
            weight,
            change,
            nobody,
            quads: PhantomData,
        };
        if shuffled {
            for &row in order.iter() {
                sweep.visit(row as usize);
            }
        } else {
            for stretch in stretches.iter() {
                sweep.visit_stretch(order, stretch);
            }
        }
    }

    /// Whether all bodies changed less than `limit` in the last iteration. Sets the sums back to zero.
    #[inline(always)]
    fn is_calm(&mut self, limit: f64) -> bool {
        let calm = limit > 0.0 && self.change.iter().all(|c| c[0] < limit && -c[1] < limit);
        self.change.fill([0.0; 2]);
        calm
    }
}
