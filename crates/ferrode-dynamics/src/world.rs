//! The world: a container of bodies and joints, and the parameters of its steps.

use crate::arena::{Arena, NIL};
use crate::body::{Body, BodyKey};
use crate::ends::{Ends, Frame};
use crate::error::{finite, finite_number, not_nan};
use crate::group::{GroupKey, JointGroup};
use crate::joint::{Contact, Joint, JointKind, Link, Node};
use crate::roll::Roll;
use crate::solve::direct::DirectSettings;
use crate::solve::substep::SubstepSettings;
use crate::step::Scratch;
use crate::{AutoDisable, Damping, DynamicIterations, Error, JointFeedback, JointKey, JointType};
use ferrode_math::Vec3;
use ferrode_math::random::OdeRandom;
use ferrode_math::stage::Crew;

/// How `Quick` iterates (ODE manual, `dWorldSetQuickStepNumIterations`, `dWorldSetQuickStepW`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuickSettings {
    /// Sweeps over all rows; 20 by default. 0 gives no constraint forces at all.
    pub iterations: u32,
    /// Over-relaxation; useful in 0 … 2, 1.3 by default.
    pub over_relaxation: f64,
    /// ODE leaves a friction row with an infinite coefficient unbounded while its contact separates. `true` treats
    /// ∞ · 0 as 0, as `Direct` does.
    pub infinite_friction_needs_contact: bool,
    /// Fewer or more sweeps, by how much the last one changed; `None`, always as many as `iterations`, by default, as in ODE
    /// 0.16.2. Newer ODEs have 1e-8, as many again, and 1e-2.
    pub dynamic: Option<DynamicIterations>,
}

impl Default for QuickSettings {
    fn default() -> Self {
        Self { iterations: 20, over_relaxation: 1.3, infinite_friction_needs_contact: false, dynamic: None }
    }
}

/// The parameters of a world's steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Params {
    pub gravity: Vec3,
    pub erp: f64,
    pub cfm: f64,
    pub auto_disable: AutoDisable,
    pub damping: Damping,
    pub max_angular_speed: f64,
    pub contact_max_correcting_velocity: f64,
    pub contact_surface_layer: f64,
    pub quick: QuickSettings,
    pub direct: DirectSettings,
    pub substep: SubstepSettings,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            gravity: Vec3::ZERO,
            erp: 0.2,
            cfm: 1e-10,
            auto_disable: AutoDisable::default(),
            damping: Damping::default(),
            max_angular_speed: f64::INFINITY,
            contact_max_correcting_velocity: f64::INFINITY,
            contact_surface_layer: 0.0,
            quick: QuickSettings::default(),
            direct: DirectSettings::default(),
            substep: SubstepSettings::default(),
        }
    }
}

/// A list of objects, newest first: ODE's order, which decides the order of rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct List {
    pub first: u32,
}

/// A container of bodies and joints that exist at the same time (ODE manual, "World").
///
/// Objects of different worlds don't interact; worlds may be stepped at different rates, and in different threads.
/// A clone has the same objects under the same keys and steps to the same bits.
#[derive(Clone, Debug)]
pub struct World {
    pub(crate) bodies: Arena<Body>,
    pub(crate) roll: Roll,
    pub(crate) joints: Arena<Joint>,
    pub(crate) groups: Arena<JointGroup>,
    pub(crate) body_list: List,
    pub(crate) joint_list: List,
    pub(crate) params: Params,
    pub(crate) random: OdeRandom,
    pub(crate) user_data: u64,
    /// Counts changes of what joints link, contacts aside.
    pub(crate) topology_version: u64,
    /// Numbers given to groups of bodies that fell asleep together.
    pub(crate) sleep_groups: u64,
    pub(crate) timing: crate::timing::Timing,
    /// The threads that `Substep` and `Direct` may use.
    pub(crate) crew: Crew,
    pub(crate) scratch: Scratch,
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}

impl World {
    /// An empty world with ODE's defaults: no gravity, ERP 0.2, CFM 1e-10.
    pub fn new() -> Self {
        Self {
            bodies: Arena::default(),
            roll: Roll::default(),
            joints: Arena::default(),
            groups: Arena::default(),
            body_list: List { first: NIL },
            joint_list: List { first: NIL },
            params: Params::default(),
            random: OdeRandom::default(),
            user_data: 0,
            topology_version: 0,
            sleep_groups: 0,
            timing: crate::timing::Timing::default(),
            crew: Crew::default(),
            scratch: Scratch::default(),
        }
    }

    // ---- parameters ----

    /// Gravity, m/s². Zero by default.
    pub fn gravity(&self) -> Vec3 {
        self.params.gravity
    }

    /// Sets gravity.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_gravity(&mut self, gravity: Vec3) -> Result<(), Error> {
        self.params.gravity = finite("gravity", gravity)?;
        Ok(())
    }

    /// Error reduction per step, 0.2 by default.
    pub fn erp(&self) -> f64 {
        self.params.erp
    }

    /// Sets the error reduction per step; 0.1 to 0.8 makes sense. Joints with an ERP of their own copied the world's
    /// when they were created.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not finite.
    pub fn set_erp(&mut self, erp: f64) -> Result<(), Error> {
        self.params.erp = finite_number("erp", erp)?;
        Ok(())
    }

    /// Constraint force mixing, 1e-10 by default.
    pub fn cfm(&self) -> f64 {
        self.params.cfm
    }

    /// Sets the constraint force mixing; 1e-9 to 1 makes sense. A negative one destabilises.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not finite.
    pub fn set_cfm(&mut self, cfm: f64) -> Result<(), Error> {
        self.params.cfm = finite_number("cfm", cfm)?;
        Ok(())
    }

    /// Auto-disable settings that new bodies get.
    pub fn auto_disable(&self) -> &AutoDisable {
        &self.params.auto_disable
    }

    /// Sets the auto-disable settings that new bodies get.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a number is NaN.
    pub fn set_auto_disable(&mut self, settings: AutoDisable) -> Result<(), Error> {
        self.params.auto_disable = settings.checked()?;
        Ok(())
    }

    /// Damping that new bodies get.
    pub fn damping(&self) -> &Damping {
        &self.params.damping
    }

    /// Sets the damping that new bodies get.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a number is NaN or a scale is infinite.
    pub fn set_damping(&mut self, damping: Damping) -> Result<(), Error> {
        self.params.damping = damping.checked()?;
        Ok(())
    }

    /// Angular speed limit that new bodies get, rad/s; ∞ for none.
    pub fn max_angular_speed(&self) -> f64 {
        self.params.max_angular_speed
    }

    /// Sets the angular speed limit that new bodies get.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is NaN.
    pub fn set_max_angular_speed(&mut self, speed: f64) -> Result<(), Error> {
        self.params.max_angular_speed = not_nan("maximum angular speed", speed)?;
        Ok(())
    }

    /// Largest speed at which contacts push bodies apart, m/s; ∞ by default.
    pub fn contact_max_correcting_velocity(&self) -> f64 {
        self.params.contact_max_correcting_velocity
    }

    /// Sets the largest speed at which contacts push bodies apart; a small one keeps deep contacts from popping.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is NaN.
    pub fn set_contact_max_correcting_velocity(&mut self, velocity: f64) -> Result<(), Error> {
        self.params.contact_max_correcting_velocity = not_nan("contact max correcting velocity", velocity)?;
        Ok(())
    }

    /// Depth in metres that contacts are left at; 0 by default.
    pub fn contact_surface_layer(&self) -> f64 {
        self.params.contact_surface_layer
    }

    /// Sets the depth that contacts are left at; 0.001 keeps resting contacts from being made and broken in turn.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not finite.
    pub fn set_contact_surface_layer(&mut self, depth: f64) -> Result<(), Error> {
        self.params.contact_surface_layer = finite_number("contact surface layer", depth)?;
        Ok(())
    }

    /// How `Quick` iterates.
    pub fn quick(&self) -> &QuickSettings {
        &self.params.quick
    }

    /// Sets how `Quick` iterates.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the over-relaxation is not finite.
    pub fn set_quick(&mut self, settings: QuickSettings) -> Result<(), Error> {
        finite_number("over-relaxation", settings.over_relaxation)?;
        if let Some(dynamic) = &settings.dynamic {
            for value in [dynamic.premature_exit_delta, dynamic.extra_requirement_delta] {
                if !(value >= 0.0 && value.is_finite()) {
                    let what = "change that ends the iteration";
                    return Err(Error::OutOfRange { what, value, expected: "a number of at least 0" });
                }
            }
        }
        self.params.quick = settings;
        Ok(())
    }

    /// How `Direct` solves.
    pub fn direct(&self) -> &DirectSettings {
        &self.params.direct
    }

    /// Sets how `Direct` solves.
    pub fn set_direct(&mut self, settings: DirectSettings) {
        self.params.direct = settings;
    }

    /// How `Substep` steps.
    pub fn substep(&self) -> &SubstepSettings {
        &self.params.substep
    }

    /// Sets how `Substep` steps.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] naming the first unusable number.
    pub fn set_substep(&mut self, settings: SubstepSettings) -> Result<(), Error> {
        settings.check()?;
        self.params.substep = settings;
        Ok(())
    }

    /// Threads that [`Stepper::Substep`](crate::Stepper::Substep) and [`Stepper::Direct`](crate::Stepper::Direct) may use, the caller's
    /// included.
    pub fn threads(&self) -> usize {
        self.crew.threads()
    }

    /// Sets how many threads `Substep` and `Direct` may use, the caller's included; 1 by default, and 0 for as many as the machine has. No
    /// result depends on it, to the bit. `Direct` solves several islands at a time, unless a body has a moved callback, which could change
    /// other islands.
    ///
    /// Helpers start here and sleep between steps. They end with the last world that has them: clones of a world have the same,
    /// as have worlds that are [given](World::set_crew) them. Where a platform has no threads, or grants fewer, there are
    /// fewer. Worlds of less than some hundred bodies gain nothing.
    pub fn set_threads(&mut self, threads: usize) {
        let threads = if threads > 0 {
            threads
        } else {
            std::thread::available_parallelism().map_or(1, core::num::NonZero::get)
        };
        if threads != self.crew.threads() {
            self.crew = Crew::new(threads);
        }
    }

    /// The threads that the world's steps use.
    pub fn crew(&self) -> &Crew {
        &self.crew
    }

    /// Lets the world use the threads of another. Worlds with the same crew may be stepped at the same time: who finds the helpers
    /// busy does without.
    pub fn set_crew(&mut self, crew: &Crew) {
        self.crew = crew.clone();
    }

    /// The state of the random generator that shuffles `Quick`'s rows.
    pub fn random(&self) -> OdeRandom {
        self.random
    }

    /// Sets the state of the random generator.
    pub fn set_random(&mut self, random: OdeRandom) {
        self.random = random;
    }

    /// The force that, acting for one step of `h` seconds, has the effect of an impulse.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a step that is not positive, [`Error::NotFinite`] for the impulse.
    pub fn impulse_to_force(&self, h: f64, impulse: Vec3) -> Result<Vec3, Error> {
        Ok(finite("impulse", impulse)? * (1.0 / crate::softness::step_size(h)?))
    }

    /// A number of the caller's.
    pub fn user_data(&self) -> u64 {
        self.user_data
    }

    /// Sets the caller's number.
    pub fn set_user_data(&mut self, data: u64) {
        self.user_data = data;
    }

    // ---- bodies ----

    /// Creates a body of 1 kg with unit inertia at the origin, at rest.
    pub fn create_body(&mut self) -> BodyKey {
        let p = &self.params;
        let mut body = Body::new(p.auto_disable, p.damping, p.max_angular_speed);
        body.next = self.body_list.first;
        let key = self.bodies.insert(body);
        if self.body_list.first != NIL {
            self.bodies.at_mut(self.body_list.first).prev = key.index;
        }
        self.body_list.first = key.index;
        self.roll.call(key.index);
        BodyKey(key)
    }

    /// Destroys a body. Its joints go to limbo on both sides, but live on.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn destroy_body(&mut self, body: BodyKey) -> Result<(), Error> {
        let index = self.body_index(body)?;
        while self.bodies.at(index).first_joint != NIL {
            self.detach(self.bodies.at(index).first_joint >> 1);
        }
        if let Some(body) = self.bodies.remove(index) {
            unlink(body.prev, body.next, &mut self.body_list.first, |i, prev, next| {
                let b = self.bodies.at_mut(i);
                b.prev = prev.unwrap_or(b.prev);
                b.next = next.unwrap_or(b.next);
            });
        }
        Ok(())
    }

    /// The body, to read.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn body(&self, body: BodyKey) -> Result<&Body, Error> {
        Ok(self.bodies.at(self.body_index(body)?))
    }

    /// The body, to change.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn body_mut(&mut self, body: BodyKey) -> Result<&mut Body, Error> {
        let index = self.body_index(body)?;
        self.roll.call(index);
        Ok(self.bodies.at_mut(index))
    }

    /// Whether the key names a body of this world.
    pub fn contains_body(&self, body: BodyKey) -> bool {
        self.body_index(body).is_ok()
    }

    /// All bodies, newest first.
    pub fn bodies(&self) -> impl Iterator<Item = (BodyKey, &Body)> + '_ {
        let link = move |i: u32| (i != NIL).then_some(i);
        core::iter::successors(link(self.body_list.first), move |i| link(self.bodies.at(*i).next))
            .map(|i| (self.body_key(i), self.bodies.at(i)))
    }

    /// The bodies that may be awake: all that are enabled or quarantined, and those that were changed through
    /// [`World::body_mut`]. Others sleep as they did. `Substep` strikes off who sleeps; the other steppers do not.
    pub fn roll(&self) -> impl Iterator<Item = BodyKey> + '_ {
        self.roll.slots().filter(|slot| self.bodies.get(*slot).is_some()).map(|slot| self.body_key(slot))
    }

    /// Number of bodies on the [`roll`](Self::roll), or a few more, and how many times bodies were struck off: who goes by the roll and finds
    /// that the second number is not what he saw after his last step has missed some.
    pub fn roll_call(&self) -> (usize, u64) {
        (self.roll.count(), self.roll.cleared)
    }

    /// Number of bodies.
    pub fn body_count(&self) -> usize {
        self.bodies.len()
    }

    /// Sets a body's auto-disable flag as ODE does: clearing it also wakes the body and resets its idle steps, idle
    /// time and sample count to the world's.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn set_body_auto_disable_flag(&mut self, body: BodyKey, on: bool) -> Result<(), Error> {
        let defaults = self.params.auto_disable;
        let body = self.body_mut(body)?;
        let mut settings = body.auto_disable;
        settings.enabled = on;
        if !on {
            settings.steps = defaults.steps;
            settings.time = defaults.time;
            settings.average_samples = defaults.average_samples;
        }
        body.set_auto_disable(settings)?;
        if !on {
            body.enable();
        }
        Ok(())
    }

    /// Gives a body the world's auto-disable settings.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn set_body_auto_disable_defaults(&mut self, body: BodyKey) -> Result<(), Error> {
        let defaults = self.params.auto_disable;
        self.body_mut(body)?.set_auto_disable(defaults)?;
        self.set_body_auto_disable_flag(body, defaults.enabled)
    }

    /// Gives a body the world's damping.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn set_body_damping_defaults(&mut self, body: BodyKey) -> Result<(), Error> {
        let defaults = self.params.damping;
        self.body_mut(body)?.set_damping(defaults)
    }

    pub(crate) fn body_index(&self, body: BodyKey) -> Result<u32, Error> {
        self.bodies.index_of(body.0).ok_or(Error::NoSuchBody(body))
    }

    pub(crate) fn body_key(&self, index: u32) -> BodyKey {
        BodyKey(self.bodies.key_of(index))
    }

    // ---- joints ----

    /// A contact in memory of a destroyed one, if there is any, after `write` has written its numbers.
    #[inline]
    pub(crate) fn contact_box(&mut self, write: impl FnOnce(&mut Contact)) -> Box<Contact> {
        let mut contact = self.scratch.spare_contacts.pop().unwrap_or_default();
        write(&mut contact);
        contact
    }

    pub(crate) fn insert_joint(
        &mut self,
        kind: JointKind,
        group: Option<GroupKey>,
    ) -> Result<JointKey, Error> {
        let group = group.map(|g| self.group_index(g)).transpose()?;
        let key = self.push_joint(kind, group.unwrap_or(NIL), 0);
        if let Some(group) = group {
            self.groups.at_mut(group).joints.push(key.0);
        }
        Ok(key)
    }

    /// A joint at the head of the world's list.
    pub(crate) fn push_joint(&mut self, kind: JointKind, group: u32, user_data: u64) -> JointKey {
        let next = self.joint_list.first;
        let mut joint = Joint::new(kind);
        (joint.group, joint.next, joint.user_data) = (group, next, user_data);
        let key = self.joints.insert(joint);
        if next != NIL {
            self.joints.at_mut(next).prev = key.index;
        }
        self.joint_list.first = key.index;
        JointKey(key)
    }

    /// Destroys a joint.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`]; [`Error::JointInGroup`] for a joint of a group, which is destroyed by emptying the
    /// group.
    pub fn destroy_joint(&mut self, joint: JointKey) -> Result<(), Error> {
        let index = self.joint_index(joint)?;
        if self.joints.at(index).group != NIL {
            return Err(Error::JointInGroup(joint));
        }
        self.remove_joint(index);
        Ok(())
    }

    pub(crate) fn remove_joint(&mut self, index: u32) {
        self.detach(index);
        if let Some(joint) = self.joints.remove(index) {
            if let JointKind::Contact(contact) = joint.kind {
                self.scratch.spare_contacts.push(contact);
            }
            unlink(joint.prev, joint.next, &mut self.joint_list.first, |i, prev, next| {
                let j = self.joints.at_mut(i);
                j.prev = prev.unwrap_or(j.prev);
                j.next = next.unwrap_or(j.next);
            });
        }
    }

    /// Attaches a joint to one or two bodies, in place of those it had. `None` stands for the static world; two `None`
    /// put the joint into limbo.
    ///
    /// The joint's anchors and axes are kept in body coordinates, so set them after attaching.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`], [`Error::NoSuchBody`], [`Error::SameBody`], [`Error::NeedsTwoBodies`]; then the joint
    /// stays attached as it was.
    pub fn attach(
        &mut self,
        joint: JointKey,
        first: Option<BodyKey>,
        second: Option<BodyKey>,
    ) -> Result<(), Error> {
        let index = self.joint_index(joint)?;
        let mut bodies = [NIL; 2];
        for (slot, key) in bodies.iter_mut().zip([first, second]) {
            if let Some(key) = key {
                *slot = self.body_index(key)?;
            }
        }
        if let (Some(a), Some(b)) = (first, second)
            && a == b
        {
            return Err(Error::SameBody(a));
        }
        let joint = self.joints.at(index);
        let joint_type = joint.kind.joint_type();
        let is_detached = joint.nodes[0].body == NIL && joint.nodes[1].body == NIL;
        if joint_type.needs_two_bodies() && first.is_some() != second.is_some() {
            return Err(Error::NeedsTwoBodies(joint_type));
        }
        if !is_detached {
            self.detach(index);
        }
        let reverse = first.is_none();
        if reverse {
            bodies.swap(0, 1);
        }
        self.joints.at_mut(index).reverse = reverse;
        for (side, body) in bodies.into_iter().enumerate() {
            if body != NIL {
                self.topology_version += u64::from(joint_type != JointType::Contact);
                self.push_link(index * 2 + side as u32, body);
            }
        }
        // A contact's frame is the world's: it does not look at its bodies.
        if bodies[0] != NIL && joint_type != JointType::Contact {
            let joint = self.joints.at_mut(index);
            let ends = ends_in(&self.bodies, joint);
            joint.kind.model_mut().attached(&ends);
        }
        Ok(())
    }

    /// A number that changes whenever a joint other than a contact is attached to a body or taken off it.
    pub fn topology_version(&self) -> u64 {
        self.topology_version
    }

    fn push_link(&mut self, link: Link, body: u32) {
        let owner = self.bodies.at_mut(body);
        let next = core::mem::replace(&mut owner.first_joint, link);
        owner.joint_count += 1;
        self.joints.at_mut(link >> 1).nodes[(link & 1) as usize] = Node { body, next, prev: NIL };
        if next != NIL {
            self.joints.at_mut(next >> 1).nodes[(next & 1) as usize].prev = link;
        }
    }

    /// Takes a joint off its bodies.
    fn detach(&mut self, joint: u32) {
        let Joint { nodes, kind, .. } = self.joints.at_mut(joint);
        let changes = u64::from(kind.joint_type() != JointType::Contact);
        for node in core::mem::replace(nodes, [Node::DETACHED; 2]) {
            if node.body == NIL {
                continue;
            }
            self.topology_version += changes;
            let body = self.bodies.at_mut(node.body);
            body.joint_count -= 1;
            unlink(node.prev, node.next, &mut body.first_joint, |link, prev, next| {
                let n = &mut self.joints.at_mut(link >> 1).nodes[(link & 1) as usize];
                n.prev = prev.unwrap_or(n.prev);
                n.next = next.unwrap_or(n.next);
            });
        }
    }

    /// All joints, newest first.
    pub fn joints(&self) -> impl Iterator<Item = JointKey> + '_ {
        let link = move |i: u32| (i != NIL).then_some(i);
        core::iter::successors(link(self.joint_list.first), move |i| link(self.joints.at(*i).next))
            .map(|i| self.joint_key(i))
    }

    /// Number of joints, contacts included.
    pub fn joint_count(&self) -> usize {
        self.joints.len()
    }

    /// Whether the key names a joint of this world.
    pub fn contains_joint(&self, joint: JointKey) -> bool {
        self.joint_index(joint).is_ok()
    }

    /// The joint's type.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn joint_type(&self, joint: JointKey) -> Result<JointType, Error> {
        Ok(self.joints.at(self.joint_index(joint)?).kind.joint_type())
    }

    /// The joint's bodies in the order of the call that attached them; `None` is the static world.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn joint_bodies(&self, joint: JointKey) -> Result<[Option<BodyKey>; 2], Error> {
        let joint = self.joints.at(self.joint_index(joint)?);
        let mut bodies = joint.nodes.map(|n| (n.body != NIL).then(|| self.body_key(n.body)));
        if joint.reverse {
            bodies.swap(0, 1);
        }
        Ok(bodies)
    }

    /// Switches a joint on or off. A disabled joint adds no rows, joins no islands and wakes nobody, but still counts
    /// as a connection.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn set_joint_enabled(&mut self, joint: JointKey, enabled: bool) -> Result<(), Error> {
        let index = self.joint_index(joint)?;
        self.joints.at_mut(index).enabled = enabled;
        Ok(())
    }

    /// Says whether [`Stepper::Substep`](crate::Stepper::Substep) solves a joint exactly, as a part of an articulation: together with all joints
    /// that bodies link it to and that are exact too. `None`, as joints begin: as [`SubstepSettings::exact_joints`](crate::SubstepSettings::exact_joints)
    /// says, unless that would cost much. An articulation with a joint of `Some(true)` is solved exactly whatever it costs.
    ///
    /// The other steppers solve all joints in one way.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn set_joint_exact(&mut self, joint: JointKey, exact: Option<bool>) -> Result<(), Error> {
        let index = self.joint_index(joint)?;
        self.joints.at_mut(index).exact = exact;
        Ok(())
    }

    /// What [`World::set_joint_exact`] has said of a joint.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn joint_exact(&self, joint: JointKey) -> Result<Option<bool>, Error> {
        Ok(self.joints.at(self.joint_index(joint)?).exact)
    }

    /// [`World::set_joint_exact`] for all joints of a body's articulation: a whole robot, vehicle or chain.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn set_articulation_exact(&mut self, body: BodyKey, exact: Option<bool>) -> Result<(), Error> {
        for index in self.articulation(self.body_index(body)?).1 {
            self.joints.at_mut(index).exact = exact;
        }
        Ok(())
    }

    /// The bodies that joints other than contacts link to a body, itself first, and whether a joint or a kinematic body among them holds them to a
    /// place.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn articulation_of(&self, body: BodyKey) -> Result<(Vec<BodyKey>, bool), Error> {
        let (bodies, joints) = self.articulation(self.body_index(body)?);
        let held = |index: &u32| {
            let mut ends = self.joints.at(*index).nodes.iter().map(|node| node.body);
            ends.any(|body| body == NIL || self.bodies.at(body).is_kinematic())
        };
        Ok((bodies.into_iter().map(|index| self.body_key(index)).collect(), joints.iter().any(held)))
    }

    /// The bodies and joints that joints other than contacts connect with a body. What no force moves connects nothing.
    fn articulation(&self, first: u32) -> (Vec<u32>, Vec<u32>) {
        let (mut bodies, mut joints) = (vec![first], Vec::new());
        let mut seen = std::collections::BTreeSet::from([first]);
        let mut at = 0;
        while let Some(body) = bodies.get(at).map(|index| self.bodies.at(*index)) {
            at += 1;
            let mut link = body.first_joint;
            while link != NIL && !body.is_kinematic() {
                let (index, side) = (link >> 1, (link & 1) as usize);
                let joint = self.joints.at(index);
                link = joint.nodes[side].next;
                if matches!(joint.kind, JointKind::Contact(_)) {
                    continue;
                }
                let other = joint.nodes[1 - side].body;
                // A joint shows up at both of its ends.
                if side == 0 || other == NIL || self.bodies.at(other).is_kinematic() {
                    joints.push(index);
                }
                if other != NIL && seen.insert(other) {
                    bodies.push(other);
                }
            }
        }
        (bodies, joints)
    }

    /// Whether a joint is switched on.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn is_joint_enabled(&self, joint: JointKey) -> Result<bool, Error> {
        Ok(self.joints.at(self.joint_index(joint)?).enabled)
    }

    /// Switches the recording of a joint's forces on (cleared) or off.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn set_joint_feedback(&mut self, joint: JointKey, on: bool) -> Result<(), Error> {
        let index = self.joint_index(joint)?;
        self.joints.at_mut(index).feedback = on.then(Box::default);
        Ok(())
    }

    /// The forces of the last step in which the joint had rows; `None` unless recording is on.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn joint_feedback(&self, joint: JointKey) -> Result<Option<&JointFeedback>, Error> {
        Ok(self.joints.at(self.joint_index(joint)?).feedback.as_deref())
    }

    /// The caller's number of a joint.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn joint_user_data(&self, joint: JointKey) -> Result<u64, Error> {
        Ok(self.joints.at(self.joint_index(joint)?).user_data)
    }

    /// Sets the caller's number of a joint.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn set_joint_user_data(&mut self, joint: JointKey, data: u64) -> Result<(), Error> {
        let index = self.joint_index(joint)?;
        self.joints.at_mut(index).user_data = data;
        Ok(())
    }

    /// The group that a joint belongs to.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn joint_group(&self, joint: JointKey) -> Result<Option<GroupKey>, Error> {
        let group = self.joints.at(self.joint_index(joint)?).group;
        Ok((group != NIL).then(|| GroupKey(self.groups.key_of(group))))
    }

    /// The joints of a body, the most recently attached first.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn body_joints(&self, body: BodyKey) -> Result<impl Iterator<Item = JointKey> + '_, Error> {
        let index = self.body_index(body)?;
        Ok(self.links(index).map(|link| self.joint_key(link >> 1)))
    }

    pub(crate) fn links(&self, body: u32) -> impl Iterator<Item = Link> + '_ {
        let some = move |link: Link| (link != NIL).then_some(link);
        core::iter::successors(some(self.bodies.at(body).first_joint), move |link| {
            some(self.joints.at(link >> 1).nodes[(link & 1) as usize].next)
        })
    }

    /// All joints between two bodies, the most recently attached first; `None` for one of them asks for joints to the
    /// static world.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn connecting_joints(
        &self,
        a: Option<BodyKey>,
        b: Option<BodyKey>,
    ) -> Result<impl Iterator<Item = JointKey> + '_, Error> {
        let a = a.map(|a| self.body_index(a)).transpose()?;
        let b = b.map(|b| self.body_index(b)).transpose()?;
        let (from, to) = if a.is_some() { (a, b) } else { (b, a) };
        let to = to.unwrap_or(NIL);
        Ok(from
            .into_iter()
            .flat_map(|from| self.links(from))
            .filter(move |link| self.joints.at(link >> 1).nodes[1 - (link & 1) as usize].body == to)
            .map(|link| self.joint_key(link >> 1)))
    }

    /// Whether a joint links the two; `None` for one of them stands for the static world.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn are_connected(&self, a: Option<BodyKey>, b: Option<BodyKey>) -> Result<bool, Error> {
        Ok(self.connecting_joints(a, b)?.next().is_some())
    }

    /// Whether a joint of another type than the given one links the two.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    pub fn are_connected_excluding(
        &self,
        a: Option<BodyKey>,
        b: Option<BodyKey>,
        excluded: JointType,
    ) -> Result<bool, Error> {
        let mut joints = self.connecting_joints(a, b)?;
        Ok(joints.any(|j| self.joints.at(j.0.index).kind.joint_type() != excluded))
    }

    pub(crate) fn ends_of(&self, joint: u32) -> Ends<'_> {
        ends_in(&self.bodies, self.joints.at(joint))
    }
}

/// The bodies at a joint's ends.
pub(crate) fn ends_in<'a>(bodies: &'a Arena<Body>, joint: &Joint) -> Ends<'a> {
    let frame =
        |node: &Node| -> Option<&'a Frame> { (node.body != NIL).then(|| &bodies.at(node.body).frame) };
    Ends { first: frame(&joint.nodes[0]), second: frame(&joint.nodes[1]), reverse: joint.reverse }
}

/// Takes an element out of a doubly linked list: `set(neighbour, prev, next)` changes what is `Some`.
fn unlink(prev: u32, next: u32, first: &mut u32, mut set: impl FnMut(u32, Option<u32>, Option<u32>)) {
    if prev == NIL {
        *first = next;
    } else {
        set(prev, None, Some(next));
    }
    if next != NIL {
        set(next, Some(prev), None);
    }
}
