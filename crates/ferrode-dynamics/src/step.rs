//! One step: the table of contents of the engine.

mod fast;
mod few_rows;
mod four;
mod impacts;
mod project;
mod quick_islands;

use crate::body::{Body, BodyKey};
use crate::ends::{Ends, Frame, StepContext};
use crate::foreign::MovedObserver;
use crate::island::Islands;
use crate::joint::Joint;
use crate::rows::{JointRows, Row, RowCount, Wrench};
use crate::solve::direct::{self, ImpactLaw, IslandWork};
use crate::solve::substep;
use crate::timing::Phase;
use crate::{Error, StepReport, World, integrate};
use ferrode_lcp::abreast;
use ferrode_math::random::OdeRandom;
use ferrode_math::stage::chunks;
use ferrode_math::{Mat3, Vec3};

/// So many joints are worth a second thread.
const LEAST_JOINTS: usize = 40;
/// Islands that are assembled before they are solved, for each thread: more share the load better and leave the caches.
const ISLANDS_PER_THREAD: usize = 8;

/// How a step finds the constraint forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Stepper {
    /// Exact: factorises the whole system and pivots (ODE's `dWorldStep`). For robots, mechanisms, high mass ratios.
    Direct,
    /// Iterative: sweeps over the rows (ODE's `dWorldQuickStep`). Fast, approximate.
    #[default]
    Quick,
    /// Thousands of bodies in real time: soft constraints, substeps, SIMD lanes, warm starts (the manual's "StepFast").
    Substep,
}

/// Who is told of bodies that a step moves.
pub(crate) struct Moved<'a> {
    pub observer: Option<MovedObserver<'a>>,
    /// It leaves the world as it is, so that islands may be stepped side by side.
    pub looks_only: bool,
}

impl Moved<'_> {
    /// Nobody is told.
    const UNSEEN: Self = Self { observer: None, looks_only: true };
}

/// A body as the solvers see it: in a dense array, in the order of its island.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SolverBody {
    /// State at the start of the step.
    pub frame: Frame,
    pub inv_mass: f64,
    /// World frame.
    pub inv_inertia: Mat3,
    pub force: Vec3,
    pub torque: Vec3,
}

/// The rows of one joint within its island.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointSpan {
    /// Slot of the joint.
    pub joint: u32,
    /// Its bodies' places in the island's array, or `NIL`.
    pub bodies: [u32; 2],
    /// First row.
    pub first: usize,
    pub count: RowCount,
}

/// An island as the solvers see it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Island {
    pub bodies: Vec<SolverBody>,
    pub spans: Vec<JointSpan>,
    pub rows: Vec<Row>,
    /// Answer: a force per row.
    pub lambda: Vec<f64>,
    /// The world's slots of `bodies`.
    slots: Vec<u32>,
    /// How many of them, from the first, are the island's own; the others are quarantined ones at the ends of its joints.
    movable: usize,
    /// Place of each of the world's bodies in `bodies`, or `NIL`.
    place: Vec<u32>,
}

/// Memory that is kept from step to step. Of the past, `Direct`'s part holds the guesses that its solves begin
/// from, which can decide among redundant forces, and `Substep`'s the impulses of joints. A clone takes both along and
/// steps to the same bits.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// Large: a step takes it and gives it back without copying it.
    stepping: Option<Box<Stepping>>,
    /// Memory of destroyed contacts, for the next step's.
    #[allow(clippy::vec_box)]
    pub spare_contacts: Vec<Box<crate::joint::Contact>>,
    pub substep: substep::Workspace,
}

/// What `Direct` and `Quick` work in.
#[derive(Debug, Default)]
struct Stepping {
    islands: Islands,
    /// At least one.
    works: Vec<IslandWork>,
    direct: direct::Workspace,
    quick: quick_islands::Workspace,
    fast: fast::Workspace,
    impacts: impacts::Workspace,
    /// The island once more, with the bodies where the step has brought them.
    moved_island: Island,
}

impl Clone for Scratch {
    fn clone(&self) -> Self {
        Self { stepping: self.stepping.clone(), substep: self.substep.clone(), ..Self::default() }
    }
}

impl Clone for Stepping {
    fn clone(&self) -> Self {
        Self { direct: self.direct.clone(), ..Self::default() }
    }
}

impl Island {
    /// The world's slot of a body, or `NIL`.
    pub fn slot(&self, place: u32) -> u32 {
        self.slots.get(place as usize).copied().unwrap_or(crate::arena::NIL)
    }
}

impl World {
    /// Advances the world by `h` seconds.
    ///
    /// Keep `h` constant: with varying steps resting contacts jitter (ODE manual, "Variable step size: don't!").
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a step that is not positive and finite; nothing is stepped then.
    pub fn step(&mut self, stepper: Stepper, h: f64) -> Result<StepReport, Error> {
        let mut random = self.random;
        let report = self.step_with_random(stepper, h, &mut random);
        self.random = random;
        report
    }

    /// As [`World::step`], into a report whose memory is used again: a step like those before it allocates nothing.
    ///
    /// # Errors
    /// As [`World::step`]; the report is left as it was then.
    pub fn step_into(&mut self, stepper: Stepper, h: f64, report: &mut StepReport) -> Result<(), Error> {
        let mut random = self.random;
        let done = self.step_in_full(stepper, h, &mut random, Moved::UNSEEN, report);
        self.random = random;
        done
    }

    /// As [`World::step`], with a random generator of the caller's: ODE shares one among all its worlds.
    ///
    /// # Errors
    /// As [`World::step`].
    pub fn step_with_random(
        &mut self,
        stepper: Stepper,
        h: f64,
        random: &mut OdeRandom,
    ) -> Result<StepReport, Error> {
        let mut report = StepReport::default();
        self.step_in_full(stepper, h, random, Moved::UNSEEN, &mut report)?;
        Ok(report)
    }

    pub(crate) fn step_in_full(
        &mut self,
        stepper: Stepper,
        h: f64,
        random: &mut OdeRandom,
        moved: Moved<'_>,
        report: &mut StepReport,
    ) -> Result<(), Error> {
        if stepper == Stepper::Substep {
            *report = self.step_substep(h, (&mut [], None), &[], moved.observer)?;
            return Ok(());
        }
        crate::softness::step_size(h)?;
        debug_assert_eq!(self.check(), Ok(()));
        report.clear();
        self.timing.begin();
        let mut stepping = self.scratch.stepping.take().unwrap_or_default();
        self.judge_bodies(h, report);
        self.find_islands(&mut stepping.islands);
        match stepper {
            Stepper::Direct => self.step_direct(h, &mut stepping, moved, report),
            _ => {
                // What `Direct` keeps from step to step grows old meanwhile.
                direct::begin_step(&mut stepping.direct);
                self.step_quick(h, random, &mut stepping, moved, report);
                direct::end_step(&mut stepping.direct);
            }
        }
        self.scratch.stepping = Some(stepping);
        Ok(())
    }

    /// Steps all islands exactly.
    fn step_direct(
        &mut self,
        h: f64,
        stepping: &mut Stepping,
        Moved { mut observer, looks_only }: Moved<'_>,
        report: &mut StepReport,
    ) {
        let Stepping { islands, works, moved_island, direct, impacts, .. } = stepping;
        let ctx = self.step_context(h);
        direct::begin_step(direct);
        let projects = self.params.direct.project_joints;
        let threads = self.crew.threads();
        let at_once = if looks_only { self.islands_at_once(islands) } else { 1 };
        if works.len() < at_once {
            works.resize_with(at_once, IslandWork::default);
        }
        let mut first = 0;
        while first < islands.ends.len() {
            // Without threads only those gain that are solved together.
            let most = if at_once == abreast() { islands.alike(first) } else { islands.ends.len() - first };
            let count = at_once.min(most);
            let works = &mut works[..count];
            for (i, work) in works.iter_mut().enumerate() {
                let (bodies, joints) = islands.of(first + i);
                work.forget();
                // An observer that only looks destroys none.
                let survivors = if looks_only { None } else { self.survivors(bodies, joints) };
                match survivors {
                    Some((bodies, joints)) => self.gather(&bodies, &joints, &mut work.island),
                    None => self.gather(bodies, joints, &mut work.island),
                }
                self.assemble(&ctx, &mut work.island, impacts, direct);
                if threads == 1 {
                    // While the rows are in the cache.
                    work.begin_one_of(count, h, &self.params.direct, report.islands + i, direct);
                }
            }
            self.timing.spent_on(Phase::Assembly);
            match &mut *works {
                [work] => work.solve(h, &self.params.direct, report.islands, direct),
                works => {
                    let (settings, number, past) = (&self.params.direct, report.islands, &*direct);
                    // Among threads few islands are shared out one by one.
                    let share = works.len() / threads;
                    let some =
                        [abreast(), 4].into_iter().find(|some| threads == 1 || *some <= share).unwrap_or(1);
                    self.crew.each(chunks(works, some), |i, works| {
                        direct::solve_all(works, h, settings, number + some * i, past);
                    });
                }
            }
            for work in &mut *works {
                work.remember(direct);
                if work.report.rows > 0 {
                    report.solves.push(work.report);
                }
                let bodies = work.island.movable;
                report.count_island(bodies, work.island.rows.len(), work.solved);
                self.write_feedback(&work.island);
            }
            self.timing.spent_on(Phase::Solve);
            let last = report.islands;
            let number = last - works.len();
            for (i, IslandWork { island, .. }) in works.iter().enumerate() {
                if projects {
                    self.move_and_project(island, moved_island, &ctx, number + i, direct);
                }
                let observer = observer.as_mut().map(|observer| &mut **observer as MovedObserver<'_>);
                self.move_bodies(island, (Stepper::Direct, h, projects), observer, report);
            }
            self.timing.spent_on(Phase::Integrate);
            first += works.len();
        }
        direct::end_step(direct);
    }

    /// How many islands may be solved at the same time: one if a callback of an earlier one could change a later one.
    fn islands_at_once(&self, islands: &Islands) -> usize {
        let threads = self.crew.threads();
        let watched = |slot: &u32| self.bodies.get(*slot).is_some_and(|body| body.moved.is_some());
        if islands.ends.len() < 2 || islands.bodies.iter().any(watched) {
            1
        } else if threads == 1 || islands.joints.len() < LEAST_JOINTS {
            abreast()
        } else {
            ISLANDS_PER_THREAD * threads
        }
    }

    /// Writes the rows of an island that is gathered.
    fn assemble(
        &mut self,
        ctx: &StepContext,
        island: &mut Island,
        impacts: &mut impacts::Workspace,
        direct: &mut direct::Workspace,
    ) {
        if self.params.direct.impacts == ImpactLaw::InTurn {
            self.collide_in_turn(island, impacts);
        }
        self.apply_gravity(island);
        self.apply_gyroscopic_torques(island, ctx.h);
        self.count_rows(island, ctx);
        direct::arrange(&mut island.spans, direct);
        self.write_rows(island, ctx);
    }

    pub(crate) fn step_context(&self, h: f64) -> StepContext {
        let p = &self.params;
        StepContext {
            h,
            fps: 1.0 / h,
            erp: p.erp,
            cfm: p.cfm,
            contact_max_correcting_velocity: p.contact_max_correcting_velocity,
            contact_surface_layer: p.contact_surface_layer,
        }
    }

    /// Takes bodies out whose state or gathered force is not finite, before they spoil their islands, and disables idle ones.
    pub(crate) fn judge_bodies(&mut self, h: f64, report: &mut StepReport) {
        let mut index = self.body_list.first;
        while index != crate::arena::NIL {
            let body = self.bodies.at_mut(index);
            let next = body.next;
            let usable = !body.enabled || body.quarantined || body.is_finite();
            if !usable {
                body.quarantine(None);
            }
            body.update_auto_disable(h);
            if !usable {
                report.quarantined.push(self.body_key(index));
            }
            index = next;
        }
    }

    /// Takes bodies out whose state or gathered force is not finite, of those that may be awake.
    pub(crate) fn quarantine_unusable_of_roll(&mut self, report: &mut StepReport) {
        for slot in self.roll.slots() {
            let Some(body) = self.bodies.get_mut(slot) else { continue };
            if body.enabled && !body.quarantined && !body.is_finite() {
                body.quarantine(None);
                report.quarantined.push(BodyKey(self.bodies.key_of(slot)));
            }
        }
    }

    /// What is left of an island if callbacks of an earlier one have destroyed some of it; `None` if all is.
    fn survivors(&self, bodies: &[u32], joints: &[u32]) -> Option<(Vec<u32>, Vec<u32>)> {
        let body = |index: &u32| self.bodies.get(*index).is_some();
        let joint = |index: &u32| self.joints.get(*index).is_some();
        if bodies.iter().all(body) && joints.iter().all(joint) {
            return None;
        }
        let bodies = bodies.iter().copied().filter(body).collect();
        Some((bodies, joints.iter().copied().filter(joint).collect()))
    }

    /// Copies an island's bodies into a dense array. A quarantined body at the end of a joint comes along as an immovable
    /// one.
    fn gather(&self, bodies: &[u32], joints: &[u32], island: &mut Island) {
        use crate::arena::NIL;
        for slot in island.slots.drain(..) {
            island.place[slot as usize] = NIL;
        }
        island.place.resize(self.bodies.capacity(), NIL);
        island.bodies.clear();
        island.spans.clear();
        for (place, index) in bodies.iter().enumerate() {
            island.place[*index as usize] = place as u32;
        }
        island.slots.extend_from_slice(bodies);
        if bodies.len() < four::WORTH_LANES {
            island.bodies.extend(bodies.iter().map(|index| SolverBody::new(self.bodies.at(*index))));
        } else {
            island.bodies.extend(bodies.iter().map(|index| SolverBody::not_turned(self.bodies.at(*index))));
            four::turn_inertia(&mut island.bodies);
        }
        island.movable = bodies.len();
        for joint in joints {
            let ends = self.joints.at(*joint).nodes.map(|node| node.body);
            for index in ends {
                if index != NIL && island.place[index as usize] == NIL && self.bodies.at(index).quarantined {
                    island.place[index as usize] = island.bodies.len() as u32;
                    island.slots.push(index);
                    island.bodies.push(SolverBody::new(self.bodies.at(index)));
                }
            }
            island.spans.push(JointSpan {
                joint: *joint,
                bodies: ends.map(|body| if body == NIL { NIL } else { island.place[body as usize] }),
                first: 0,
                count: RowCount::default(),
            });
        }
    }

    fn apply_gravity(&self, island: &mut Island) {
        let g = self.params.gravity;
        if g == Vec3::ZERO {
            return;
        }
        for (index, solver_body) in island.slots[..island.movable].iter().zip(&mut island.bodies) {
            let body = self.bodies.at(*index);
            if body.gravity_mode {
                solver_body.force += g * body.mass.mass;
            }
        }
    }

    fn apply_gyroscopic_torques(&self, island: &mut Island, h: f64) {
        let movable = island.movable;
        four::add_gyroscopic_torques(self, &island.slots[..movable], &mut island.bodies[..movable], h);
    }

    /// Asks each joint for its rows; those without any drop out.
    fn count_rows(&mut self, island: &mut Island, ctx: &StepContext) {
        let joints = &mut self.joints;
        let bodies = &island.bodies;
        island.spans.retain_mut(|span| {
            let joint = joints.at_mut(span.joint);
            let ends = ends_of(joint, span, bodies);
            span.count = joint.kind.model_mut().row_count(&ends, ctx);
            span.count.rows > 0
        });
    }

    /// Has each joint fill its rows. Forces that joints add meanwhile enter the right-hand side of this step.
    fn write_rows(&mut self, island: &mut Island, ctx: &StepContext) {
        island.rows.clear();
        for span in &mut island.spans {
            span.first = island.rows.len();
            island.rows.resize(span.first + span.count.rows, Row::blank(ctx.cfm));
            let mut out = JointRows { rows: &mut island.rows[span.first..], forces: [Wrench::default(); 2] };
            let joint = self.joints.at_mut(span.joint);
            let ends = ends_of(joint, span, &island.bodies);
            joint.kind.model_mut().write_rows(&ends, ctx, &mut out);
            let forces = out.forces;
            for (place, wrench) in span.bodies.into_iter().zip(forces) {
                if let Some(body) = island.bodies.get_mut(place as usize) {
                    body.force += wrench.force;
                    body.torque += wrench.torque;
                }
            }
        }
    }

    /// Tells joints that ask for it what forces they put on their bodies.
    fn write_feedback(&mut self, island: &Island) {
        for span in &island.spans {
            let joint = self.joints.at_mut(span.joint);
            let two = joint.nodes[1].body != crate::arena::NIL;
            let Some(feedback) = &mut joint.feedback else { continue };
            let range = span.first..span.first + span.count.rows;
            let mut wrenches = [Wrench::default(); 2];
            for (row, lambda) in island.rows[range.clone()].iter().zip(&island.lambda[range]) {
                wrenches[0].force += row.linear1 * *lambda;
                wrenches[0].torque += row.angular1 * *lambda;
                wrenches[1].force += row.linear2 * *lambda;
                wrenches[1].torque += row.angular2 * *lambda;
            }
            (feedback.force1, feedback.torque1) = (wrenches[0].force, wrenches[0].torque);
            if two {
                (feedback.force2, feedback.torque2) = (wrenches[1].force, wrenches[1].torque);
            }
        }
    }

    /// Velocity and pose, unless the bodies were moved already, moved callback, damping, cleared accumulators: body after body.
    fn move_bodies(
        &mut self,
        island: &Island,
        (stepper, h, moved): (Stepper, f64, bool),
        mut observer: Option<MovedObserver<'_>>,
        report: &mut StepReport,
    ) {
        let bodies = &island.slots[..island.movable];
        let mut moved = moved;
        let is_watched = |slot: &u32| self.bodies.at(*slot).moved.is_some();
        if stepper == Stepper::Direct
            && !moved
            && bodies.len() >= four::WORTH_LANES
            && observer.is_none()
            && !bodies.iter().any(is_watched)
        {
            // Nobody can tell in which order.
            four::advance(self, bodies, &island.bodies[..island.movable], h);
            moved = true;
        }
        if stepper == Stepper::Quick {
            // All velocities of the island are final before the first callback.
            for (index, solver_body) in bodies.iter().zip(&island.bodies) {
                self.bodies.at_mut(*index).set_velocities(solver_body);
            }
        }
        for (index, solver_body) in bodies.iter().zip(&island.bodies) {
            // An observer may have destroyed the body.
            let Some(body) = self.bodies.get_mut(*index) else { continue };
            if !moved {
                if stepper == Stepper::Direct {
                    body.advance_velocity(solver_body, h);
                }
                integrate::advance_pose(body, h);
            }
            // What moved it, for callbacks to see: gravity and the forces of joints at stops are in it.
            body.force = solver_body.force;
            body.torque = solver_body.torque;
            if observer.is_some() || body.moved.is_some() {
                let key = self.body_key(*index);
                let body = self.bodies.at_mut(*index);
                if let Some(moved) = body.moved.clone() {
                    moved(key, body);
                }
                if let Some(observer) = &mut observer {
                    observer(self, key);
                }
                if !self.contains_body(key) {
                    continue;
                }
            }
            self.roll.call(*index);
            let body = self.bodies.at_mut(*index);
            let damping = body.damping;
            damping.apply(&mut body.frame.linear_velocity, &mut body.frame.angular_velocity);
            body.force = Vec3::ZERO;
            body.torque = Vec3::ZERO;
            if !body.is_finite() {
                body.quarantine(Some(&solver_body.frame));
                report.quarantined.push(self.body_key(*index));
            }
        }
    }
}

/// The ends of a joint, from the island's array.
fn ends_of<'a>(joint: &Joint, span: &JointSpan, bodies: &'a [SolverBody]) -> Ends<'a> {
    let frame = |place: u32| bodies.get(place as usize).map(|body| &body.frame);
    Ends { first: frame(span.bodies[0]), second: frame(span.bodies[1]), reverse: joint.reverse }
}

impl SolverBody {
    #[inline(always)]
    fn new(body: &Body) -> Self {
        let r = body.frame.rotation;
        let immovable = body.quarantined || body.is_kinematic();
        Self {
            frame: body.frame,
            inv_mass: if immovable { 0.0 } else { body.inv_mass },
            inv_inertia: if immovable { Mat3::ZERO } else { r * body.inv_inertia * r.transpose() },
            force: body.force,
            torque: body.torque,
        }
    }

    /// With the inverse inertia in the body's own frame.
    #[inline(always)]
    fn not_turned(body: &Body) -> Self {
        let immovable = body.quarantined || body.is_kinematic();
        Self {
            frame: body.frame,
            inv_mass: if immovable { 0.0 } else { body.inv_mass },
            inv_inertia: body.inv_inertia,
            force: body.force,
            torque: body.torque,
        }
    }
}

impl Body {
    /// The velocity after a step of `Direct`.
    fn advance_velocity(&mut self, from: &SolverBody, h: f64) {
        let [linear, angular] = direct::velocity_after(from, h);
        (self.frame.linear_velocity, self.frame.angular_velocity) = (linear, angular);
    }

    fn set_velocities(&mut self, from: &SolverBody) {
        self.frame.linear_velocity = from.frame.linear_velocity;
        self.frame.angular_velocity = from.frame.angular_velocity;
    }

    /// Takes the body out of the simulation, at rest in its last good pose.
    pub(crate) fn quarantine(&mut self, last_good: Option<&Frame>) {
        if let Some(frame) = last_good {
            self.frame = *frame;
        }
        self.frame.linear_velocity = Vec3::ZERO;
        self.frame.angular_velocity = Vec3::ZERO;
        self.force = Vec3::ZERO;
        self.torque = Vec3::ZERO;
        self.quarantined = true;
    }
}
