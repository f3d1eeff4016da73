//! The world: bodies and joints, the geoms on them, and the rules by which they touch.

use crate::{Combine, CombineRules, ContactEvent, ContactSource, Error, GeomInfo, Material, TouchingContact};
use core::ops::{Deref, DerefMut};
use ferrode_collide::{Colliders, GeomContact, GeomKey, SpaceKey, SpaceKind};
use ferrode_dynamics::{BodyKey, GroupKey, JointKey, Stepper, Surface};
use std::collections::HashMap;
use std::sync::OnceLock;

/// A world of bodies with shapes.
///
/// [`World::step`] does everything: it finds contacts, makes contact joints from the geoms' materials, steps with
/// [`World::stepper`], and tells which geoms began and ceased to touch.
///
/// A `World` is also an [ODE-like world](ferrode_dynamics::World): everything about bodies and joints is reached
/// through it directly, and the parts of a step can be made by hand (see [`World::parts_mut`]).
///
/// A clone has the same objects under the same keys and steps to the same bits.
#[derive(Clone, Debug)]
pub struct World {
    pub(crate) dynamics: ferrode_dynamics::World,
    pub(crate) colliders: Colliders,
    pub(crate) space: SpaceKey,
    pub(crate) geom_infos: Vec<Option<GeomInfo>>,
    pub(crate) free_geom_slots: Vec<usize>,
    /// Looked up by key only, so that its order never matters.
    pub(crate) geoms_of_body: HashMap<BodyKey, Vec<GeomKey>>,
    pub(crate) default_material: Material,
    pub(crate) rules: CombineRules,
    pub(crate) pair_surfaces: HashMap<(GeomKey, GeomKey), Option<Surface>>,
    pub(crate) joined_collide: HashMap<JointKey, bool>,
    /// How [`World::step`] finds the constraint forces. [`Stepper::Quick`] unless set.
    pub stepper: Stepper,
    pub(crate) max_contacts: u16,
    pub(crate) contact_source: ContactSource,
    pub(crate) contact_group: GroupKey,
    pub(crate) contacts: Vec<TouchingContact>,
    pub(crate) events: Vec<ContactEvent>,
    /// Slots of geoms that touched in the last step, in ascending order.
    pub(crate) touching: Vec<(usize, usize)>,
    pub(crate) time: f64,
    /// What rounding has kept out of `time` so far.
    pub(crate) time_rest: f64,
    pub(crate) steps: u64,
    /// Time of the last step that was spent on pairs and contacts, s.
    pub(crate) collision_time: f64,
    pub(crate) scratch: Scratch,
    /// What `Substep` keeps of the shapes, once it has stepped.
    pub(crate) pipeline: Option<Box<crate::substep::Pipeline>>,
    /// Contacts of a step of `Substep`, made when they are asked for.
    pub(crate) lazy_contacts: OnceLock<Vec<TouchingContact>>,
    /// Length of the last step.
    pub(crate) last_h: f64,
    /// Counts changes of the geoms by hand.
    pub(crate) geom_version: u64,
    /// Counts changes of what decides about surfaces.
    pub(crate) rules_version: u64,
}

/// Memory kept from step to step; holds no state.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    pub pairs: Vec<(GeomKey, GeomKey)>,
    pub found: Vec<GeomContact>,
    pub touching: Vec<(usize, usize)>,
}

impl Clone for Scratch {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}

impl Deref for World {
    type Target = ferrode_dynamics::World;

    fn deref(&self) -> &ferrode_dynamics::World {
        &self.dynamics
    }
}

impl DerefMut for World {
    fn deref_mut(&mut self) -> &mut ferrode_dynamics::World {
        &mut self.dynamics
    }
}

impl World {
    /// An empty world with ODE's defaults: no gravity, ERP 0.2, CFM 1e-10; its geoms in a tree of boxes.
    pub fn new() -> Self {
        // A tree of boxes has no number that could be wrong.
        Self::with_space(SpaceKind::Bvh).expect("a tree of boxes can be made")
    }

    /// As [`World::new`], with a space of another kind: it decides the order in which pairs are found, and so the order of
    /// contacts.
    ///
    /// # Errors
    /// [`Error::Collider`] for a quadtree whose numbers can't be.
    pub fn with_space(kind: SpaceKind) -> Result<Self, Error> {
        let mut dynamics = ferrode_dynamics::World::new();
        let contact_group = dynamics.create_group();
        let mut colliders = Colliders::new();
        let space = colliders.add_space(None, kind)?;
        Ok(Self {
            dynamics,
            colliders,
            space,
            geom_infos: Vec::new(),
            free_geom_slots: Vec::new(),
            geoms_of_body: HashMap::new(),
            default_material: Material::default(),
            rules: CombineRules::default(),
            pair_surfaces: HashMap::new(),
            joined_collide: HashMap::new(),
            stepper: Stepper::default(),
            max_contacts: 10,
            contact_source: ContactSource::default(),
            contact_group,
            contacts: Vec::new(),
            events: Vec::new(),
            touching: Vec::new(),
            time: 0.0,
            time_rest: 0.0,
            steps: 0,
            collision_time: 0.0,
            scratch: Scratch::default(),
            pipeline: None,
            lazy_contacts: OnceLock::new(),
            last_h: 1.0,
            geom_version: 0,
            rules_version: 0,
        })
    }

    /// The bodies and joints, without shapes.
    pub fn dynamics(&self) -> &ferrode_dynamics::World {
        &self.dynamics
    }

    /// The geoms and spaces, without bodies.
    pub fn colliders(&self) -> &Colliders {
        &self.colliders
    }

    /// Both halves at once, to make the parts of a step by hand in ODE's way: collide, make contact joints, step, empty
    /// the group.
    ///
    /// ```
    /// use ferrode::prelude::*;
    /// use ferrode::{CollideOptions, Contact};
    /// # fn main() -> Result<(), Error> {
    /// let mut world = World::new();
    /// world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    /// world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    /// let ball = world.add_body(BodyBuilder::new().at(Vec3::new(0.0, 0.0, 1.0)).with_shape(Sphere::new(0.5)?, 1000.0))?;
    /// let group = world.create_group();
    /// for _ in 0..200 {
    ///     world.sync_geoms();
    ///     let mut pairs = Vec::new();
    ///     let space = world.space();
    ///     let (dynamics, colliders) = world.parts_mut();
    ///     colliders.collide(space, |colliders, a, b| {
    ///         colliders.contacts(a, b, CollideOptions::new(4), &mut pairs);
    ///     })?;
    ///     for (a, b, contact) in &pairs {
    ///         let bodies = world.bodies_of(*a, *b)?;
    ///         let contact = Contact::at(contact.point, Surface::with_friction(0.5));
    ///         let joint = world.create_contact(Some(group), &contact)?;
    ///         world.attach(joint, bodies.0, bodies.1)?;
    ///     }
    ///     world.step_dynamics(Stepper::Direct, 0.01)?;
    ///     world.empty_group(group)?;
    /// }
    /// assert!((world.body(ball)?.position().z - 0.5).abs() < 1e-3);
    /// # Ok(()) }
    /// ```
    pub fn parts_mut(&mut self) -> (&mut ferrode_dynamics::World, &mut Colliders) {
        (&mut self.dynamics, &mut self.colliders)
    }

    /// The bodies of two geoms; `None` for a geom of the static world.
    ///
    /// # Errors
    /// [`Error::Collider`] for a key that names no geom.
    pub fn bodies_of(&self, a: GeomKey, b: GeomKey) -> Result<(Option<BodyKey>, Option<BodyKey>), Error> {
        Ok((self.geom_info(a)?.body, self.geom_info(b)?.body))
    }

    /// Steps bodies and joints only: no contacts are looked for (ODE's `dWorldStep` and `dWorldQuickStep`).
    ///
    /// # Errors
    /// [`Error::Dynamics`] for a step that is not positive and finite.
    pub fn step_dynamics(&mut self, stepper: Stepper, h: f64) -> Result<ferrode_dynamics::StepReport, Error> {
        Ok(self.dynamics.step(stepper, h)?)
    }

    /// Destroys a body and its geoms. Its joints go to limbo.
    ///
    /// # Errors
    /// [`Error::Dynamics`] for a key that names no body.
    pub fn destroy_body(&mut self, body: BodyKey) -> Result<(), Error> {
        self.dynamics.destroy_body(body)?;
        for geom in self.geoms_of_body.remove(&body).unwrap_or_default() {
            self.remove_geom(geom)?;
        }
        Ok(())
    }

    /// How two materials become the surface of a contact.
    pub fn combine_rules(&self) -> &CombineRules {
        &self.rules
    }

    /// Sets how two materials become the surface of a contact.
    pub fn set_combine_rules(&mut self, rules: CombineRules) {
        self.rules = rules;
        self.rules_version += 1;
    }

    /// Sets how friction coefficients are combined.
    pub fn set_friction_rule(&mut self, rule: Combine) {
        self.rules.friction = rule;
        self.rules_version += 1;
    }

    /// Sets what two geoms do to each other, whatever their materials: a surface of its own, or `None` to let them pass
    /// through each other.
    ///
    /// # Errors
    /// [`Error::Collider`] for a key that names no geom, [`Error::Dynamics`] naming the first unusable number.
    pub fn set_pair_surface(
        &mut self,
        a: GeomKey,
        b: GeomKey,
        surface: Option<Surface>,
    ) -> Result<(), Error> {
        self.geom(a)?;
        self.geom(b)?;
        if let Some(surface) = &surface {
            surface.check()?;
        }
        self.pair_surfaces.insert((a.min(b), a.max(b)), surface);
        self.rules_version += 1;
        Ok(())
    }

    /// Undoes [`World::set_pair_surface`].
    pub fn clear_pair_surface(&mut self, a: GeomKey, b: GeomKey) {
        self.pair_surfaces.remove(&(a.min(b), a.max(b)));
        self.rules_version += 1;
    }

    /// Lets the two bodies of a joint collide with each other; by default they don't.
    ///
    /// # Errors
    /// [`Error::Dynamics`] for a key that names no joint.
    pub fn set_joined_bodies_collide(&mut self, joint: JointKey, collide: bool) -> Result<(), Error> {
        self.dynamics.joint_type(joint)?;
        self.rules_version += 1;
        if collide {
            self.joined_collide.insert(joint, true);
        } else {
            self.joined_collide.remove(&joint);
        }
        Ok(())
    }

    /// Most contacts that a pair of geoms gets; 10 unless set.
    pub fn max_contacts(&self) -> u16 {
        self.max_contacts
    }

    /// Sets the most contacts that a pair of geoms gets.
    pub fn set_max_contacts(&mut self, max_contacts: u16) {
        self.max_contacts = max_contacts.max(1);
    }

    /// Where [`World::step`] takes its contacts from; [`ContactSource::Steady`] unless set.
    pub fn contact_source(&self) -> ContactSource {
        self.contact_source
    }

    /// Sets where [`World::step`] takes its contacts from.
    pub fn set_contact_source(&mut self, source: ContactSource) {
        self.contact_source = source;
    }

    /// Simulated time in seconds.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Steps made by [`World::step`].
    pub fn step_count(&self) -> u64 {
        self.steps
    }

    /// The contacts of the last step.
    pub fn contacts(&self) -> &[TouchingContact] {
        if self.stepper == Stepper::Substep {
            return self.lazy_contacts.get_or_init(|| self.substep_contacts());
        }
        &self.contacts
    }

    /// Which geoms began and ceased to touch in the last step.
    pub fn contact_events(&self) -> &[ContactEvent] {
        &self.events
    }
}
