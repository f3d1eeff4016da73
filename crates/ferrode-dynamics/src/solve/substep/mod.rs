//! `Substep`: thousands of bodies in real time.
//!
//! ```text
//! wake → gather → colour → prepare rows of contacts
//! n times:   forces and impulses of the substep before → (first: contacts' impulses of the step before)
//!            → rows of joints → one sweep with bias → positions → one sweep without
//! restitution → impulses back into the manifolds → velocities and poses → islands to sleep
//! ```
//!
//! That is "Soft Step" (E. Catto, "Solver2D", 2024): small steps instead of many iterations (M. Macklin et al., "Small Steps
//! in Physics Simulation", SCA 2019), constraints that push back like springs (`soft`), and after each move of the bodies
//! a sweep without that push, which takes out the velocity that it put in.
//!
//! Contacts are linearised once per step, rows of joints follow the bodies in each substep. See docs/substep.md.

mod articulation;
mod bodies;
mod colour;
mod contact;
mod far;
mod joints;
mod keys;
mod manifold;
mod parts;
mod room;
mod settings;
mod sleep;
mod soft;
mod surface;

pub use manifold::{ContactManifold, MANIFOLD_POINTS, ManifoldPoint};
pub use settings::SubstepSettings;
pub use soft::Spring;

use crate::arena::NIL;
use crate::body::{Body, BodyKey};
use crate::ends::Frame;
use crate::foreign::MovedObserver;
use crate::joint::JointKind;
use crate::timing::Phase;
use crate::{Error, StepReport, Surface, World};
use articulation::{Articulations, Mode, Task};
use bodies::{SHARE, SolverBodies};
use colour::Colouring;
use contact::{Contacts, Pass};
use ferrode_math::Vec3;
use ferrode_math::simd::Level;
use ferrode_math::stage::chunks;
use joints::{JointContext, JointMemory, Joints, When};
use parts::Parts;
use surface::SurfaceCoefficients;

/// Memory that is kept from step to step. Only the joints' impulses and the world's parts hold something of the past.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    memory: Vec<JointMemory>,
    /// Length of the step before; 0 for none.
    last_h: f64,
    bodies: SolverBodies,
    contacts: Contacts,
    joints: Joints,
    articulations: Articulations,
    parts: Parts,
    colouring: Colouring,
    keyed: Vec<keys::Keyed>,
    surfaces: Vec<SurfaceCoefficients>,
    /// Dense place and serial of each of the world's bodies.
    places: Vec<(u32, u32)>,
    /// Bodies, by tasks, that a step has left not finite.
    spoilt: Vec<Vec<u32>>,
    joint_seen: Vec<bool>,
    /// Contact joints as manifolds, their joints and surfaces; with those of the caller in front.
    loose: Vec<ContactManifold>,
    loose_joints: Vec<u32>,
    all: Vec<ContactManifold>,
    /// Places of the manifolds that count: those of the caller, `own_active` of them, and the loose ones.
    active: Vec<u32>,
    own_active: usize,
    waking: Vec<u64>,
    sets: sleep::Sets,
    restless: Vec<bool>,
}

impl Clone for Workspace {
    fn clone(&self) -> Self {
        Self {
            memory: self.memory.clone(),
            last_h: self.last_h,
            parts: self.parts.clone(),
            ..Self::default()
        }
    }
}

impl World {
    /// Advances the world by `h` seconds with [`Stepper::Substep`](crate::Stepper::Substep), given what touches.
    ///
    /// Manifolds come from the caller's collision detection, with the positions that the bodies have now; the caller
    /// keeps them for the next step, where points that are the same go on with the impulses that they end with here. Their
    /// `surface` is a place in `surfaces`. Manifolds of bodies that are no more are passed over. Contact joints work too,
    /// each as a manifold without a past.
    ///
    /// ```
    /// use ferrode_dynamics::{ContactManifold, ManifoldPoint, Surface, World};
    /// use ferrode_math::Vec3;
    /// # fn main() -> Result<(), ferrode_dynamics::Error> {
    /// let mut world = World::new();
    /// world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    /// let ball = world.create_body();
    /// world.body_mut(ball)?.set_position(Vec3::new(0.0, 0.0, 1.0))?;
    /// let surfaces = [Surface::with_friction(0.5)];
    /// let mut manifold = ContactManifold::new(Some(ball), None, 0);
    /// manifold.set_normal(Vec3::Z);
    /// for _ in 0..300 {
    ///     // A ball of radius 0.5 above the plane z = 0.
    ///     let height = world.body(ball)?.position().z;
    ///     let impulse = manifold.points().map(|p| p.impulse).sum();
    ///     manifold.clear();
    ///     let separation = (height - 0.5) as f32;
    ///     manifold.push(ManifoldPoint { arm1: [0.0, 0.0, -0.5], arm2: [0.0; 3], separation, impulse });
    ///     world.step_with_manifolds(1.0 / 60.0, core::slice::from_mut(&mut manifold), &surfaces)?;
    /// }
    /// assert!((world.body(ball)?.position().z - 0.5).abs() < 1e-3);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a step that is not positive and finite, or a manifold whose surface is not in the list;
    /// nothing is stepped then.
    pub fn step_with_manifolds(
        &mut self,
        h: f64,
        manifolds: &mut [ContactManifold],
        surfaces: &[Surface],
    ) -> Result<StepReport, Error> {
        self.step_substep(h, (manifolds, None), surfaces, None)
    }

    /// As [`World::step_with_manifolds`], of many manifolds of which few matter: those whose bit is set in `awake`, the first in the lowest
    /// bit of the first word. The others are not looked at, and cost nothing.
    ///
    /// # Errors
    /// As there; surfaces count of manifolds that matter.
    pub fn step_with_awake_manifolds(
        &mut self,
        h: f64,
        manifolds: &mut [ContactManifold],
        awake: &[u64],
        surfaces: &[Surface],
    ) -> Result<StepReport, Error> {
        self.step_substep(h, (manifolds, Some(awake)), surfaces, None)
    }

    /// A step of [`Stepper::Substep`](crate::Stepper::Substep) in a world in which nothing is awake; does nothing and returns `false`
    /// where something may be.
    #[doc(hidden)]
    pub fn step_asleep(&mut self, h: f64) -> bool {
        // Who asks for an impossible step has to hear of it.
        let possible = crate::softness::step_size(h).is_ok();
        let work = &mut self.scratch.substep;
        if !possible || self.roll.count() > 0 || work.bodies.len() > 0 {
            return false;
        }
        self.timing.begin();
        work.last_h = h;
        true
    }

    pub(crate) fn step_substep(
        &mut self,
        h: f64,
        (manifolds, awake): (&mut [ContactManifold], Option<&[u64]>),
        surfaces: &[Surface],
        moved: Option<MovedObserver<'_>>,
    ) -> Result<StepReport, Error> {
        crate::softness::step_size(h)?;
        let mut work = core::mem::take(&mut self.scratch.substep);
        keys::list_active(manifolds.len(), awake, &mut work);
        let checked = keys::check_surfaces(&self.crew, manifolds, &work.active, surfaces);
        if let Err(error) = checked {
            self.scratch.substep = work;
            return Err(error);
        }
        self.timing.begin();
        let mut report = StepReport::default();
        self.convert_surfaces(h, surfaces, &mut work);
        let watched = self.gather_awake(h, manifolds, &mut work, &mut report);
        if work.bodies.len() > 0 {
            if work.loose.is_empty() {
                self.solve_substeps(h, manifolds, &mut work);
            } else {
                let mut all = core::mem::take(&mut work.all);
                self.solve_substeps(h, &mut all, &mut work);
                manifolds.copy_from_slice(&all[..manifolds.len()]);
                self.write_contact_feedback(h, &all[manifolds.len()..], &work);
                work.all = all;
            }
            report.islands = 1;
            report.bodies = work.bodies.len();
            report.rows = work.contacts.row_count() + work.joints.row_count();
            report.largest_island_rows = report.rows;
            self.move_awake(h, &mut work, moved, watched, &mut report);
            self.put_islands_to_sleep(h, &mut work);
            self.timing.spent_on(Phase::Integrate);
        }
        work.last_h = h;
        self.scratch.substep = work;
        Ok(report)
    }

    fn convert_surfaces(&self, h: f64, surfaces: &[Surface], work: &mut Workspace) {
        let ctx = self.step_context(h);
        let settings = &self.params.substep;
        let n = f64::from(settings.substeps);
        work.surfaces.clear();
        work.surfaces
            .extend(surfaces.iter().map(|s| SurfaceCoefficients::new(s, &ctx, n, settings.push_out_speed)));
    }

    /// Takes out what is not finite, wakes what has to be awake, and copies awake bodies, joints and contacts into the workspace.
    /// Returns whether a body has a callback.
    fn gather_awake(
        &mut self,
        h: f64,
        manifolds: &[ContactManifold],
        work: &mut Workspace,
        report: &mut StepReport,
    ) -> bool {
        loop {
            let watched = self.gather_bodies(h, work, report);
            self.gather_joints(h, manifolds, work);
            let all = core::mem::take(&mut work.all);
            let list = if work.loose.is_empty() { manifolds } else { &all };
            self.colour_manifolds(list, work);
            work.all = all;
            if work.waking.is_empty() {
                return watched;
            }
            let mut waking = core::mem::take(&mut work.waking);
            self.wake_islands(&mut waking);
            work.waking = waking;
        }
    }

    fn gather_bodies(&mut self, h: f64, work: &mut Workspace, report: &mut StepReport) -> bool {
        loop {
            // Bodies that were enabled by hand wake those that fell asleep with them.
            let mut waking = core::mem::take(&mut work.waking);
            let returned =
                |slot: &u32| self.bodies.get(*slot).is_some_and(|b| b.enabled && b.sleep_group != 0);
            let returned: Vec<u32> = self.roll.slots().filter(returned).collect();
            for slot in returned {
                self.rouse(slot, &mut waking);
            }
            self.wake_islands(&mut waking);
            work.waking = waking;

            for slot in &work.bodies.slots {
                work.places[*slot as usize] = (NIL, 0);
            }
            work.bodies.clear();
            work.places.resize(self.bodies.capacity(), (NIL, 0));
            let bodies = &self.bodies;
            self.roll.retain(|slot| bodies.get(slot).is_some_and(|body| body.enabled || body.quarantined));
            for slot in self.roll.slots() {
                work.places[slot as usize] = (work.bodies.len() as u32, bodies.key_of(slot).serial as u32);
                work.bodies.slots.push(slot);
            }
            debug_assert_eq!(
                work.bodies.len(),
                self.bodies().filter(|(_, body)| body.enabled || body.quarantined).count(),
                "a body that is awake is not on the roll"
            );
            let found = work.bodies.fill(&self.crew, bodies, self.params.gravity, h);
            if !found.unusable {
                return found.watched;
            }
            self.quarantine_unusable_of_roll(report);
        }
    }

    /// Collects the joints of awake bodies. Contact joints become manifolds.
    fn gather_joints(&mut self, h: f64, manifolds: &[ContactManifold], work: &mut Workspace) {
        work.joints.clear();
        work.loose.clear();
        work.loose_joints.clear();
        work.active.truncate(work.own_active);
        if self.joints.len() == 0 {
            return;
        }
        let ctx = self.step_context(h);
        let (n, push_out) = (f64::from(self.params.substep.substeps), self.params.substep.push_out_speed);
        work.joint_seen.clear();
        work.joint_seen.resize(self.joints.capacity(), false);
        let mut asleep = Vec::new();
        for place in 0..work.bodies.len() {
            if !work.bodies.is_movable(place as u32) {
                continue;
            }
            let mut link = self.bodies.at(work.bodies.slots[place]).first_joint;
            while link != NIL {
                let (index, side) = (link >> 1, (link & 1) as usize);
                let joint = self.joints.at(index);
                link = joint.nodes[side].next;
                if core::mem::replace(&mut work.joint_seen[index as usize], true) || !joint.enabled {
                    continue;
                }
                let slots = joint.nodes.map(|node| node.body);
                let places = slots.map(|slot| if slot == NIL { NIL } else { work.places[slot as usize].0 });
                let other = slots[1 - side];
                if other != NIL && places[1 - side] == NIL {
                    asleep.push(other);
                    continue;
                }
                if let JointKind::Contact(contact) = &joint.kind {
                    let mut keys = slots.map(|slot| (slot != NIL).then(|| self.body_key(slot)));
                    let mut centres = keys.map(|key| self.centre(key));
                    if joint.reverse {
                        keys.swap(0, 1);
                        centres.swap(0, 1);
                    }
                    let surface = work.surfaces.len() as u32;
                    work.surfaces.push(SurfaceCoefficients::new(&contact.surface, &ctx, n, push_out));
                    let mut manifold = ContactManifold::of_contact(keys, centres, &contact.point, surface);
                    if contact.surface.mode.has(crate::SurfaceMode::FDIR1) {
                        manifold.set_tangent(contact.fdir1);
                    }
                    work.loose.push(manifold);
                    work.loose_joints.push(index);
                } else {
                    let exact = joint.exact.unwrap_or(self.params.substep.exact_joints);
                    let marked = joint.exact == Some(true);
                    work.joints.push(index, places, [exact, marked], joint.feedback.is_some());
                }
            }
        }
        for slot in asleep {
            self.rouse(slot, &mut work.waking);
            // The body itself is awake already; something must make the caller gather again.
            work.waking.push(0);
        }
        if !work.loose.is_empty() {
            work.all.clear();
            work.all.extend_from_slice(manifolds);
            work.all.extend_from_slice(&work.loose);
            work.active.extend(manifolds.len() as u32..work.all.len() as u32);
        }
    }

    fn centre(&self, key: Option<BodyKey>) -> Vec3 {
        key.map_or(Vec3::ZERO, |key| self.bodies.at(key.0.index).frame.position)
    }

    fn solve_substeps(&mut self, h: f64, manifolds: &mut [ContactManifold], work: &mut Workspace) {
        let settings = self.params.substep;
        let level = settings.lanes.unwrap_or_else(Level::best);
        let n = f64::from(settings.substeps);
        let part = h / n;
        let ratio = if work.last_h > 0.0 { (h / work.last_h) as f32 } else { 1.0 };
        let Workspace { bodies, contacts, joints, articulations, surfaces, memory, .. } = work;
        let crew = &self.crew;
        contacts.prepare(
            level,
            crew,
            &contact::Context {
                bodies,
                manifolds,
                surfaces,
                soft: settings.contact.coefficients(part),
                ratio,
            },
        );
        let context = JointContext::new(self.step_context(h), n, settings.joint.coefficients(part), ratio);
        joints.find_carried(&context, bodies, &self.bodies, &mut self.joints, memory);
        articulations.find((settings.lanes, crew.threads()), joints, bodies);
        joints.begin(bodies, &self.bodies);
        let touching =
            contacts.keys.iter().filter(|key| key.sort != contact::NOT_SOLVED).map(|key| key.bodies);
        let loose = joints.constraints.iter().filter(|c| !c.exact).map(|c| c.bodies);
        articulations.find_company(bodies.len(), touching.chain(loose));
        self.timing.spent_on(Phase::Assembly);
        let dt = part as f32;
        for i in 0..settings.substeps {
            bodies.integrate_velocities(crew, dt, i == 0);
            if i == 0 {
                contacts.pass(level, crew, Pass::WarmStart, bodies, (dt, 0.0));
            }
            let when = if i == 0 { When::First } else { When::Next };
            joints.rewrite(when, &context, bodies, &self.bodies, &mut self.joints, memory);
            let load = if i == 0 { Task::Begin(joints, dt) } else { Task::Advance(joints, true) };
            articulations.pass(crew, load, bodies);
            joints.solve(false, bodies);
            contacts.pass(level, crew, Pass::Biased, bodies, (dt, dt * i as f32));
            articulations.pass(crew, Task::Solve(Mode::Biased(dt)), bodies);
            bodies.integrate_positions(crew, dt);
            joints.solve(true, bodies);
            contacts.pass(level, crew, Pass::Relax, bodies, (dt, dt * (i + 1) as f32));
            articulations.pass(crew, Task::Solve(Mode::Relax), bodies);
            if joints.are_written() {
                articulations.pass(crew, Task::Store(joints), bodies);
                joints.sum_feedback();
            }
        }
        if contacts.has_bounce {
            contacts.pass(level, crew, Pass::Restitution, bodies, (dt, h as f32));
            articulations.pass(crew, Task::Solve(Mode::Relax), bodies);
        }
        articulations.pass(crew, Task::Store(joints), bodies);
        if !articulations.is_empty() {
            joints.rewrite(When::End, &context, bodies, &self.bodies, &mut self.joints, memory);
            articulations.pass(crew, Task::Advance(joints, false), bodies);
            articulations.pass(crew, Task::Solve(Mode::Project), bodies);
        }
        contacts.store(level, manifolds);
        joints.remember(memory, &self.joints);
        joints.write_feedback(h, &mut self.joints);
        self.timing.spent_on(Phase::Solve);
    }

    /// Tells contact joints that ask for it what they pushed with at the end of the step.
    fn write_contact_feedback(&mut self, h: f64, manifolds: &[ContactManifold], work: &Workspace) {
        let per_second = f64::from(self.params.substep.substeps) / h;
        for (manifold, index) in manifolds.iter().zip(&work.loose_joints) {
            let joint = self.joints.at(*index);
            if joint.feedback.is_none() {
                continue;
            }
            let force =
                (manifold.normal() * manifold.normal_impulse() + manifold.friction_impulse()) * per_second;
            let JointKind::Contact(contact) = &joint.kind else { continue };
            let point = contact.point.position;
            let sign = if joint.reverse { -1.0 } else { 1.0 };
            let centre = joint
                .nodes
                .map(|node| if node.body == NIL { point } else { self.bodies.at(node.body).frame.position });
            let two = joint.nodes[1].body != NIL;
            let joint = self.joints.at_mut(*index);
            let Some(feedback) = &mut joint.feedback else { continue };
            feedback.force1 = force * sign;
            feedback.torque1 = (point - centre[0]).cross(feedback.force1);
            if two {
                feedback.force2 = -feedback.force1;
                feedback.torque2 = (point - centre[1]).cross(feedback.force2);
            }
        }
    }

    /// Velocity, pose, moved callback, damping, cleared accumulators: body after body.
    fn move_awake(
        &mut self,
        h: f64,
        work: &mut Workspace,
        mut observer: Option<MovedObserver<'_>>,
        watched: bool,
        report: &mut StepReport,
    ) {
        let gravity = self.params.gravity;
        if !watched && observer.is_none() && self.crew.threads() > 1 && work.bodies.len() > SHARE {
            return self.move_awake_together(h, work, report);
        }
        for (place, slot) in work.bodies.slots.iter().enumerate() {
            // An observer may have destroyed the body.
            let Some(body) = self.bodies.get_mut(*slot) else { continue };
            if body.quarantined {
                continue;
            }
            let before = body.frame;
            work.bodies.advance(place, body, gravity, h);
            let key = self.body_key(*slot);
            let body = self.bodies.at_mut(*slot);
            if let Some(moved) = body.moved.clone() {
                moved(key, body);
            }
            if let Some(observer) = &mut observer {
                observer(self, key);
            }
            let Ok(body) = self.body_mut(key) else { continue };
            if !settle(body, &before) {
                report.quarantined.push(key);
            }
        }
    }

    /// As [`World::move_awake`], with all threads; there is nobody to tell of each body.
    fn move_awake_together(&mut self, h: f64, work: &mut Workspace, report: &mut StepReport) {
        let (gravity, crew) = (self.params.gravity, self.crew.clone());
        let slots = self.bodies.slots_mut();
        let Workspace { bodies, places, spoilt, .. } = work;
        spoilt.resize_with(slots.len().div_ceil(SHARE), Vec::new);
        crew.each((chunks(slots, SHARE), chunks(spoilt, 1)), |share, (slots, spoilt)| {
            let spoilt = &mut spoilt[0];
            spoilt.clear();
            for (slot, (place, _)) in slots.iter_mut().zip(&places[share * SHARE..]) {
                let Some(body) = slot.value.as_mut().filter(|body| *place != NIL && !body.quarantined) else {
                    continue;
                };
                let before = body.frame;
                bodies.advance(*place as usize, body, gravity, h);
                if !settle(body, &before) {
                    spoilt.push(*place);
                }
            }
        });
        let mut places: Vec<u32> = spoilt.iter().flatten().copied().collect();
        places.sort_unstable();
        report.quarantined.extend(places.iter().map(|place| self.body_key(bodies.slots[*place as usize])));
    }
}

/// Damping, cleared accumulators; false for a body that isn't finite and was put back to where it was before.
fn settle(body: &mut Body, before: &Frame) -> bool {
    let damping = body.damping;
    damping.apply(&mut body.frame.linear_velocity, &mut body.frame.angular_velocity);
    body.force = Vec3::ZERO;
    body.torque = Vec3::ZERO;
    let sound = body.is_finite();
    if !sound {
        body.quarantine(Some(before));
    }
    sound
}
