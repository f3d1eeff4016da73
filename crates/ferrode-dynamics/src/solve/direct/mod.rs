//! `Direct`: the exact solution of the boxed linear complementarity problem.
//!
//! Small islands, where nothing beats it, go to Dantzig's pivoting on the dense matrix ([`dense`]), as in ODE; all others to block pivoting on
//! a sparse factorisation ([`sparse`]), whose time grows with the mechanism and not with the cube of its rows. Both freeze friction
//! bounds at the solution without friction, so both have the same answer; the second one starts from what
//! the rows did in the step before ([`warm`]).

mod abreast;
mod arrange;
mod cone;
mod dense;
mod project;
mod sparse;
mod twelve;
mod warm;

use super::{FreeMotion, Solved, free_motions, right_hand_side};
use crate::report::{DirectMethod, IslandSolve};
use crate::rows::{NO_FRICTION_INDEX, Row};
use crate::step::{Island, JointSpan, SolverBody};
pub(crate) use abreast::solve_all;
use ferrode_lcp::{PivotingReport, SparseLcp};
use ferrode_math::Vec3;
use ferrode_math::simd::{Quad, QuadKernel, dispatch_quads};
pub(crate) use project::{Displacement, keep_rigid};
use twelve::{Six, Twelve};
use warm::WarmStart;

/// What bounds the friction of contacts whose bounds hang on the normal force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrictionLaw {
    /// Each tangent for itself, with bounds frozen at the normal forces without friction (ODE's pyramid): friction is up to √2 times
    /// stronger between the tangents.
    #[default]
    Pyramid,
    /// Coulomb's law: the same in every direction, against the sliding velocity, with the normal forces as they are. Takes several
    /// solutions of the boxed problem, each from the one before.
    Cone,
}

/// In which order contacts with restitution bounce.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum ImpactLaw {
    /// All at once, as in ODE: each contact that approaches departs with its restitution, by the forces of one solution. A ball that hits four
    /// touching ones comes back with 3/5 of its speed and gives them 2/5.
    #[default]
    Together,
    /// Pair of bodies after pair, the fastest approach first, each as if alone, until none approaches: in Newton's cradle the last
    /// ball leaves. Joints and friction take no part in the impulses; they act in the same step, on the velocities after them. (B. Smith,
    /// D. M. Kaufman, E. Vouga, R. Tamstorf, E. Grinspun, "Reflections on simultaneous impact", SIGGRAPH 2012, section 3.)
    InTurn,
}

/// How `Direct` solves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectSettings {
    /// What bounds friction.
    pub friction: FrictionLaw,
    /// In which order contacts with restitution bounce.
    pub impacts: ImpactLaw,
    /// Islands with fewer rows are solved by Dantzig's method on the dense matrix, as in ODE; 30 by default. Jointed figures of up to 160
    /// rows are too, for which it takes less time, unless this is 0. `usize::MAX` solves all islands so.
    pub dense_rows: usize,
    /// The most factorisations that block pivoting may take for one problem, 200 by default. Past that an island of up to
    /// `most_dense_rows` rows goes to Dantzig's method.
    pub max_factorisations: u32,
    /// The most rows that the dense method is given as a last resort; 1500 by default.
    pub most_dense_rows: usize,
    /// Whether pivoting starts from the states that the rows had in the step before. It saves time and changes no result.
    pub warm_start: bool,
    /// Whether each step ends with moving the bodies back to where their joints hold together; off by default, as in ODE, where
    /// bodies move along the tangents of their paths and the error that is left of it, of second order in the step, is reduced by the
    /// factor ERP in each step. With it errors are of fourth order, for the time of a second solve (M. B. Cline and D. K. Pai,
    /// "Post-stabilization for rigid body simulation with contact and constraints", ICRA 2003). Velocities stay as they are. Joints with
    /// a CFM of their own, limits, motors and contacts take no part.
    pub project_joints: bool,
}

impl Default for DirectSettings {
    fn default() -> Self {
        Self {
            friction: FrictionLaw::Pyramid,
            impacts: ImpactLaw::Together,
            dense_rows: 30,
            max_factorisations: 200,
            most_dense_rows: 1500,
            warm_start: true,
            project_joints: false,
        }
    }
}

/// Memory of the stepper.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    arrangement: arrange::Memory,
    warm: WarmStart,
    projection: project::Workspace,
}

/// An island, and what its solution needs of memory, of which dropping costs time and changes nothing. Several may be solved at once.
#[derive(Debug, Default)]
pub(crate) struct IslandWork {
    pub island: Island,
    /// The answer; the forces are in the island.
    pub solved: Solved,
    pub report: IslandSolve,
    state: State,
    memory: Memory,
}

/// What is ready of an island's problem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    /// Nothing, or what was left by a step before.
    #[default]
    Old,
    /// What all methods need.
    Ready,
    /// What the sparse method needs too.
    ReadyForSparse,
}

#[derive(Debug, Default)]
struct Memory {
    free: Vec<FreeMotion>,
    system: RowSystem,
    /// For the dense method.
    spans: SpansByBody,
    /// The rows' forces and torques on each body.
    forces: Vec<Six>,
    dense: dense::Workspace,
    sparse: sparse::Workspace,
    cone: cone::Workspace,
}

/// What all methods need of the rows: right-hand side, CFM/h, bounds.
#[derive(Clone, Debug, Default)]
struct RowSystem {
    rhs: Vec<f64>,
    sigma: Vec<f64>,
    lo: Vec<f64>,
    hi: Vec<f64>,
    findex: Vec<i32>,
    /// The bodies' free motions.
    free: Vec<Six>,
}

/// Which spans act on each body, and on which side: `starts[b]..starts[b + 1]` in `at_body`.
#[derive(Clone, Debug, Default)]
struct SpansByBody {
    starts: Vec<usize>,
    at_body: Vec<(u32, u32)>,
}

/// Puts an island's joints into ODE's order.
pub(crate) fn arrange(spans: &mut Vec<JointSpan>, work: &mut Workspace) {
    arrange::arrange(spans, &mut work.arrangement);
}

/// Begins a step.
pub(crate) fn begin_step(work: &mut Workspace) {
    work.warm.begin_step();
}

/// Ends a step.
pub(crate) fn end_step(work: &mut Workspace) {
    work.warm.end_step();
}

/// Finds how an island's bodies have to move for the rows of its joints to have no error of position; nothing if there are none.
/// `island.rows` hold the joints' rows, with bodies where they are.
pub(crate) fn project<'a>(
    island: &mut Island,
    settings: &DirectSettings,
    number: usize,
    work: &'a mut Workspace,
) -> &'a [Displacement] {
    work.projection.solve(island, settings, number)
}

impl IslandWork {
    /// Finds the forces of the island's rows, and adds them to all others of its bodies; `number` is the island's in this step. `past` is
    /// only read.
    pub fn solve(&mut self, h: f64, settings: &DirectSettings, number: usize, past: &Workspace) {
        let problem = Problem { settings, number, warm: &past.warm };
        self.begin(h, problem, false);
        self.solve_alone(h, problem);
    }

    /// Another island comes in: nothing of it is ready, whatever became of the one before.
    pub fn forget(&mut self) {
        self.state = State::Old;
    }

    /// Makes ready, right after its rows were written, one of as many islands that may be solved together.
    pub fn begin_one_of(
        &mut self,
        count: usize,
        h: f64,
        settings: &DirectSettings,
        number: usize,
        past: &Workspace,
    ) {
        if count >= abreast::LEAST {
            self.begin(h, Problem { settings, number, warm: &past.warm }, true);
        }
    }

    /// Makes ready what is not: what all methods need, and if the island may be solved together with others, what that needs.
    fn begin(&mut self, h: f64, problem: Problem<'_>, together: bool) {
        let Self { island, solved, report, state, memory } = self;
        if *state != State::Old {
            return;
        }
        *state = State::Ready;
        let m = island.rows.len();
        island.lambda.clear();
        island.lambda.resize(m, 0.0);
        *report = IslandSolve { rows: m, ..IslandSolve::default() };
        *solved = Solved::Completely;
        if m > 0 {
            let fps = 1.0 / h;
            free_motions(&island.bodies, fps, &mut memory.free);
            memory.system.load(island, fps, &memory.free);
            let friction = memory.system.findex.iter().any(|f| *f >= 0);
            if together && !friction && !memory.system.is_for_dense(m, problem.settings) {
                memory.sparse.begin(island, problem, Start::Step);
                *state = State::ReadyForSparse;
            }
        }
    }

    fn solve_alone(&mut self, h: f64, problem: Problem<'_>) {
        let Self { island, solved, report, memory, state } = self;
        *state = State::Old;
        if island.rows.is_empty() {
            return;
        }
        *solved = solve_boxed(island, problem, Start::Step, memory, report);
        if problem.settings.friction == FrictionLaw::Cone && memory.cone.find(island) {
            *solved = solve_cone(island, 1.0 / h, problem, memory, report);
        }
        sum_forces(island, &mut memory.forces);
    }

    /// The problem that was made ready for the sparse method.
    fn lcp(&mut self) -> SparseLcp<'_> {
        self.memory.sparse.lcp(&mut self.island, &self.memory.system)
    }

    /// Takes the sparse method's answer, whose forces are in the island.
    fn take_answer(&mut self, answer: PivotingReport, settings: &DirectSettings) {
        let Self { island, solved, report, memory, state } = self;
        *state = State::Old;
        *solved = memory.sparse.end(island, answer, (settings, Start::Step), report);
        sum_forces(island, &mut memory.forces);
    }

    /// Keeps what the next step can begin from.
    pub fn remember(&mut self, work: &mut Workspace) {
        self.memory.sparse.remember(&self.island, &mut work.warm);
    }
}

/// What the solution of an island depends on besides its rows.
#[derive(Clone, Copy)]
struct Problem<'a> {
    settings: &'a DirectSettings,
    /// The island's number.
    number: usize,
    warm: &'a WarmStart,
}

/// What block pivoting starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Start {
    /// What rows did in the step before.
    Step,
    /// What they did in the problem solved last, of the same rows.
    Problem,
}

/// Solves the problem that is loaded.
fn solve_boxed(
    island: &mut Island,
    problem: Problem<'_>,
    start: Start,
    memory: &mut Memory,
    report: &mut IslandSolve,
) -> Solved {
    let settings = problem.settings;
    let dense = memory.system.is_for_dense(island.rows.len(), settings);
    if dense {
        memory.spans.list(island);
        let solved = dense::solve(island, &memory.system, &memory.spans, &mut memory.dense, report);
        if solved == Solved::Completely {
            return solved;
        }
        // ODE gives up here, and bodies fall through each other.
        report.fell_back = true;
    }
    let solved = sparse::solve(island, &memory.system, problem, start, &mut memory.sparse, report);
    if dense {
        report.method = DirectMethod::BlockPivoting;
    }
    solved
}

/// Goes from the pyramid's answer to the cone's: see [`cone`].
fn solve_cone(
    island: &mut Island,
    fps: f64,
    problem: Problem<'_>,
    memory: &mut Memory,
    report: &mut IslandSolve,
) -> Solved {
    memory.cone.begin(island);
    let mut start = Start::Step;
    for sweep in 0..cone::MOST_SWEEPS {
        memory.cone.push(island);
        let pushed = memory.cone.take_pushed();
        let free = &memory.free;
        memory.cone.turn(island, sweep, fps, |island, span, row| {
            let span = &island.spans[span];
            [cone::along(row, span.bodies, &pushed), right_hand_side(row, span, fps, free)]
        });
        memory.cone.give_pushed(pushed);
        memory.system.load(island, fps, &memory.free);
        report.residual = 0.0;
        report.largest_force = 0.0;
        let factorisations = report.factorisations;
        let solved = solve_boxed(island, problem, start, memory, report);
        report.factorisations += factorisations;
        report.friction_sweeps += 1;
        start = Start::Problem;
        let change = memory.cone.turn_back(island);
        memory.cone.restore(island);
        if cone::Workspace::converged(change, sweep) {
            return solved;
        }
    }
    // Not at rest, but each round is a solution for the bounds of the one before.
    Solved::Partly
}

/// The most rows of small figures: all, and those without bounds of one figure, and of two that lie on each other.
const MOST_FIGURE_ROWS: usize = 160;
const MOST_HELD_ROWS: [usize; 2] = [60, 96];

impl RowSystem {
    /// Whether the dense method is faster.
    fn is_for_dense(&self, rows: usize, settings: &DirectSettings) -> bool {
        rows < settings.dense_rows || (settings.dense_rows > 0 && self.is_small_figure(rows))
    }

    /// Whether the rows are those of a jointed figure, such as a person on the ground, and few enough for the dense method. Measured: the
    /// sparse one is ahead where contacts are many to each row without bounds, and on long chains.
    fn is_small_figure(&self, rows: usize) -> bool {
        if rows > MOST_FIGURE_ROWS {
            return false;
        }
        let bounds = self.lo.iter().zip(&self.hi).zip(&self.findex);
        let held =
            bounds.filter(|((lo, hi), f)| **f < 0 && **lo == f64::NEG_INFINITY && **hi == f64::INFINITY);
        let held = held.count();
        let bounded = rows - held;
        // With few bounded rows the sparse method has few states to find.
        let most = MOST_HELD_ROWS[usize::from(3 * bounded >= held)];
        held <= most && bounded <= 3 * held
    }

    fn load(&mut self, island: &Island, fps: f64, free: &[FreeMotion]) {
        let m = island.rows.len();
        for v in [&mut self.rhs, &mut self.sigma, &mut self.lo, &mut self.hi] {
            v.resize(m, 0.0);
        }
        self.findex.resize(m, -1);
        self.free.clear();
        self.free.extend(free.iter().map(|motion| motion.to_array()));
        dispatch_quads(LoadRows { system: self, island, fps });
    }
}

struct LoadRows<'a> {
    system: &'a mut RowSystem,
    island: &'a Island,
    fps: f64,
}

impl QuadKernel for LoadRows<'_> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        let Self { system: RowSystem { rhs, sigma, lo, hi, findex, free }, island, fps } = self;
        for span in &island.spans {
            let motion = Twelve::<Q>::of_bodies(free, span.bodies);
            let range = span.first..span.first + span.count.rows;
            for (rows, rhs) in island.rows[range.clone()].chunks(4).zip(rhs[range].chunks_mut(4)) {
                let products = motion.times_rows(rows);
                for i in 0..rows.len().min(rhs.len()) {
                    rhs[i] = rows[i].c * fps - products[i & 3];
                }
            }
        }
        let m = island.rows.len();
        let (sigma, lo, hi, findex) = (&mut sigma[..m], &mut lo[..m], &mut hi[..m], &mut findex[..m]);
        let mut friction = false;
        for (i, row) in island.rows.iter().enumerate() {
            sigma[i] = row.cfm * fps;
            (lo[i], hi[i]) = (row.lo, row.hi);
            findex[i] = row.friction_index;
            friction |= row.friction_index != NO_FRICTION_INDEX;
        }
        if !friction {
            return;
        }
        for span in &island.spans {
            for local in &mut findex[span.first..span.first + span.count.rows] {
                if *local != NO_FRICTION_INDEX {
                    *local += span.first as i32;
                }
            }
        }
    }
}

impl SpansByBody {
    /// Counting sort of the spans by body; within a body they stay in the order of their rows.
    fn list(&mut self, island: &Island) {
        self.starts.clear();
        self.starts.resize(island.bodies.len() + 2, 0);
        let n = island.bodies.len();
        for place in island.spans.iter().flat_map(|span| span.bodies) {
            if (place as usize) < n {
                self.starts[place as usize + 2] += 1;
            }
        }
        for i in 2..self.starts.len() {
            self.starts[i] += self.starts[i - 1];
        }
        self.at_body.clear();
        self.at_body.resize(*self.starts.last().unwrap_or(&0), (0, 0));
        for (index, span) in island.spans.iter().enumerate() {
            for (side, place) in span.bodies.into_iter().enumerate() {
                if (place as usize) < n {
                    let next = &mut self.starts[place as usize + 1];
                    self.at_body[*next] = (index as u32, side as u32);
                    *next += 1;
                }
            }
        }
    }
}

#[inline(always)]
fn jacobian(row: &Row, side: u32) -> (Vec3, Vec3) {
    if side == 0 { (row.linear1, row.angular1) } else { (row.linear2, row.angular2) }
}

/// Adds the constraint forces Jᵀλ to all other forces of an island's bodies.
fn sum_forces(island: &mut Island, forces: &mut Vec<Six>) {
    forces.clear();
    forces.resize(island.bodies.len(), [0.0; 6]);
    dispatch_quads(SumForces { island, forces });
    for (body, [fx, fy, fz, tx, ty, tz]) in island.bodies.iter_mut().zip(forces) {
        body.force = Vec3::new(*fx, *fy, *fz) + body.force;
        body.torque = Vec3::new(*tx, *ty, *tz) + body.torque;
    }
}

struct SumForces<'a> {
    island: &'a Island,
    forces: &'a mut [Six],
}

impl QuadKernel for SumForces<'_> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        let Self { island, forces } = self;
        for span in &island.spans {
            let mut sum = Twelve::<Q>::of_bodies(forces, span.bodies);
            let range = span.first..span.first + span.count.rows;
            for (row, lambda) in island.rows[range.clone()].iter().zip(&island.lambda[range]) {
                sum = sum.plus(*lambda, Twelve::of_row(row));
            }
            sum.put(forces, span.bodies);
        }
    }
}

/// The linear and the angular velocity of a body after the step.
pub(crate) fn velocity_after(body: &SolverBody, h: f64) -> [Vec3; 2] {
    let frame = &body.frame;
    [
        frame.linear_velocity + body.force * (h * body.inv_mass),
        frame.angular_velocity + body.inv_inertia * (body.torque * h),
    ]
}
