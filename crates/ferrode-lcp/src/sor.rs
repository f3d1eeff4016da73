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

mod sweep;

use crate::error::{LcpError, check_len};
use crate::kernel::sum4;
use ferrode_math::simd::{Compute, compute_wide};
use std::borrow::Borrow;
use sweep::{Interleaving, PackedRow, Stretch, Sweep, find_stretches, interleave};

/// Stands for "no body".
pub const NO_BODY: u32 = u32::MAX;

/// How many iterations lie between two shuffles of the rows.
const SHUFFLE_PERIOD: u32 = 8;

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

impl SorRow {
    /// The same row with its two bodies in the other order.
    #[cold]
    fn swapped(&self) -> Self {
        let mut j = self.j;
        j.rotate_left(6);
        Self { j, body: [self.body[1], self.body[0]], ..*self }
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

/// All memory that a solve needs, and its answer. Made once, it grows to the largest problem met; a solve that fits
/// allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct SorWorkspace {
    packed: Vec<PackedRow>,
    order: Vec<u32>,
    /// The order before the first shuffle, as stretches of rows on the same bodies.
    stretches: Vec<Stretch>,
    interleaving: Interleaving,
    /// Scratch: the rows with a friction index.
    friction: Vec<u32>,
    /// The forces, and the one that is always 1.
    lambda: Vec<f64>,
    /// The accelerations, and one of a body that stands for no body.
    acceleration: Vec<SorAcceleration>,
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
        &self.lambda[..self.lambda.len().saturating_sub(1)]
    }

    /// The accelerations of the last solve, one per body.
    #[must_use]
    pub fn acceleration(&self) -> &[SorAcceleration] {
        &self.acceleration[..self.acceleration.len().saturating_sub(1)]
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
    check_params(params)?;
    if let Err(error) = workspace.load(bodies, count, rows, params) {
        workspace.lambda.clear();
        workspace.acceleration.clear();
        return Err(error);
    }
    let (iterations, exit) = match (params.dynamic, params.inf_times_zero) {
        (None, InfTimesZero::Unbounded) => compute_wide(Run::<_, false, false> { workspace, params, random }),
        (None, InfTimesZero::Zero) => compute_wide(Run::<_, true, false> { workspace, params, random }),
        (Some(_), InfTimesZero::Unbounded) => {
            compute_wide(Run::<_, false, true> { workspace, params, random })
        }
        (Some(_), InfTimesZero::Zero) => compute_wide(Run::<_, true, true> { workspace, params, random }),
    };
    // 0 times a number is 0 unless the number is infinite or none.
    let forces: f64 = workspace.lambda.iter().map(|v| 0.0 * v).sum();
    let accelerations: f64 = workspace.acceleration.iter().flat_map(|a| a.0).map(|v| 0.0 * v).sum();
    Ok(SorReport { iterations, exit, finite: !(forces + accelerations).is_nan() })
}

/// The iterations, compiled for the machine. `ZERO`: infinity times zero is zero; `DYNAMIC`: watch the changes.
struct Run<'a, R, const ZERO: bool, const DYNAMIC: bool> {
    workspace: &'a mut SorWorkspace,
    params: &'a SorParams,
    random: &'a mut R,
}

impl<R: FnMut(u32) -> u32, const ZERO: bool, const DYNAMIC: bool> Compute for Run<'_, R, ZERO, DYNAMIC> {
    type Out = (u32, SorExit);

    #[inline(always)]
    fn run(self) -> (u32, SorExit) {
        self.workspace.run::<ZERO, DYNAMIC>(self.params, self.random)
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
    if r.findex >= 0 {
        if r.findex as usize >= rows {
            return Err(LcpError::FrictionIndex { row, findex: r.findex });
        }
        if r.hi.is_nan() {
            return Err(LcpError::Bounds { row, lo: r.lo, hi: r.hi });
        }
    } else if r.lo.is_nan() || r.hi.is_nan() || r.lo > r.hi {
        return Err(LcpError::Bounds { row, lo: r.lo, hi: r.hi });
    }
    let known = |b: u32| b == NO_BODY || (b as usize) < bodies;
    let twice = r.body[0] == r.body[1] && r.body[0] != NO_BODY;
    if !known(r.body[0]) || !known(r.body[1]) || twice {
        return Err(LcpError::Body { row, body: r.body });
    }
    Ok(())
}

/// `B = M^-1 J^T` of one body.
#[inline(always)]
fn apply_inverse_mass(body: &SorBody, j: &[f64]) -> [f64; 6] {
    let (m, i) = (body.inv_mass, &body.inv_inertia);
    [
        m * j[0],
        m * j[1],
        m * j[2],
        i[0] * j[3] + i[1] * j[4] + i[2] * j[5],
        i[3] * j[3] + i[4] * j[4] + i[5] * j[5],
        i[6] * j[3] + i[7] * j[4] + i[8] * j[5],
    ]
}

/// The part of a row on one body: its Jacobian, and `B`. Zero for no body.
#[inline(always)]
fn part(bodies: &[SorBody], body: u32, j: &[f64]) -> ([f64; 6], [f64; 6]) {
    match bodies.get(body as usize) {
        Some(body) => ([j[0], j[1], j[2], j[3], j[4], j[5]], apply_inverse_mass(body, j)),
        None => ([0.0; 6], [0.0; 6]),
    }
}

/// The largest component by size.
fn largest(b: &[f64; 6]) -> f64 {
    b.iter().fold(0.0, |m: f64, v| if v.abs() > m { v.abs() } else { m })
}

impl SorWorkspace {
    /// Packs the rows and sets forces and accelerations to zero.
    fn load(
        &mut self,
        bodies: &[SorBody],
        m: usize,
        rows: impl Iterator<Item: Borrow<SorRow>>,
        params: &SorParams,
    ) -> Result<(), LcpError> {
        let nobody = bodies.len() as u32;
        self.lambda.clear();
        self.lambda.resize(m, 0.0);
        self.lambda.push(1.0);
        self.acceleration.clear();
        self.acceleration.resize(bodies.len() + 1, SorAcceleration::default());
        // Rows of an earlier solve may stand behind the m of this one; every row is written whole.
        if self.packed.len() < m {
            self.packed.resize(m, PackedRow::default());
        }
        self.order.clear();
        self.friction.clear();
        self.weight.clear();
        self.change.clear();
        if params.dynamic.is_some() {
            self.weight.reserve(m);
            self.change.resize(bodies.len() + 1, [0.0; 2]);
        }
        let mut count = 0;
        for (row, (r, packed)) in rows.zip(&mut self.packed[..m]).enumerate() {
            let r = r.borrow();
            count += 1;
            check_row(row, r, m, bodies.len())?;
            // The loop reads the first body always and the second if there is one.
            let swapped;
            let r = if r.body[0] == NO_BODY {
                swapped = r.swapped();
                &swapped
            } else {
                r
            };
            (packed.j0, packed.b0) = part(bodies, r.body[0], &r.j[..6]);
            (packed.j1, packed.b1) = part(bodies, r.body[1], &r.j[6..]);
            let PackedRow { j0, b0, j1, b1, .. } = packed;
            let mut s = [0.0; 4];
            for l in 0..6 {
                s[l % 2] += j0[l] * b0[l];
                s[2 + l % 2] += j1[l] * b1[l];
            }
            let diagonal = sum4(s) + r.cfm;
            // An empty row without CFM has no effect on anything; its force stays 0.
            let d =
                if diagonal == 0.0 || diagonal.is_nan() { 0.0 } else { params.over_relaxation / diagonal };
            for l in 0..6 {
                j0[l] *= -d;
                j1[l] *= -d;
            }
            let (lo, hi, scale) = if r.findex >= 0 {
                self.friction.push(row as u32);
                (-r.hi.abs(), r.hi.abs(), r.findex as u32)
            } else {
                self.order.push(row as u32);
                (r.lo, r.hi, m as u32)
            };
            packed.rhs = r.rhs * d;
            packed.cfm = r.cfm * d;
            (packed.lo, packed.hi, packed.scale) = (lo, hi, scale);
            packed.body = [r.body[0].min(nobody), r.body[1]];
            if params.dynamic.is_some() {
                self.weight.push([largest(&packed.b0), largest(&packed.b1)]);
            }
        }
        check_len("rows", count, m)?;
        self.order.extend_from_slice(&self.friction);
        find_stretches(&self.order, &self.packed, &mut self.stretches);
        let Self { order, packed, stretches, interleaving, .. } = self;
        interleave(order, &packed[..m], bodies.len(), stretches, interleaving);
        Ok(())
    }

    /// Does the iterations. `ZERO`: infinity times zero is zero; `DYNAMIC`: watch the changes.
    #[inline(always)]
    fn run<const ZERO: bool, const DYNAMIC: bool>(
        &mut self,
        params: &SorParams,
        random: &mut impl FnMut(u32) -> u32,
    ) -> (u32, SorExit) {
        let planned = params.iterations;
        if planned == 0 {
            return (0, SorExit::Completed);
        }
        let mut done = 0;
        let mut extra = 0;
        let mut limit = params.dynamic.map_or(0.0, |d| d.premature_exit_delta);
        loop {
            if done >= SHUFFLE_PERIOD && done % SHUFFLE_PERIOD == 0 {
                self.shuffle(random);
            }
            self.sweep::<ZERO, DYNAMIC>(done >= SHUFFLE_PERIOD);
            done += 1;
            let added = params.dynamic.map_or(0, |d| d.extra_iterations);
            if done == planned.saturating_add(extra) {
                if extra != 0 || added == 0 {
                    return (done, if extra != 0 { SorExit::FullExtra } else { SorExit::Completed });
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
                return (done, exit);
            }
        }
    }

    /// Shuffles the order of the rows.
    fn shuffle(&mut self, random: &mut impl FnMut(u32) -> u32) {
        for k in 1..self.order.len() {
            let r = random(k as u32 + 1) as usize;
            self.order.swap(k, r.min(k));
        }
    }

    /// Visits every row once: in stretches of rows on the same bodies until the first shuffle, one by one after.
    #[inline(always)]
    fn sweep<const ZERO: bool, const DYNAMIC: bool>(&mut self, shuffled: bool) {
        let Self { packed, order, stretches, lambda, acceleration, weight, change, .. } = self;
        let mut sweep = Sweep::<ZERO, DYNAMIC> { packed, lambda, acceleration, weight, change };
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
