//! From pairs of geoms to contact joints.

use crate::world::Scratch;
use crate::{Error, GeomInfo, World};
use ferrode_collide::{CollideOptions, GeomContact, GeomKey, Item};
use ferrode_dynamics::{Body, Contact, Surface, SurfaceMode};
use ferrode_math::{ContactPoint, Vec3};

/// Where [`World::step`] takes its contacts from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum ContactSource {
    /// [`collide::narrow::steady`](crate::collide::narrow::steady()): as ODE's, but where those leave a body without hold or
    /// catch it at the edges within a mesh. A capsule that lies on a box has two contacts instead of one, a ball on a
    /// mesh one instead of several.
    #[default]
    Steady,
    /// [`collide::narrow::collide`](crate::collide::narrow::collide()): ODE's contacts, as `dCollide` gives them.
    Ode,
}

/// One side of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContactOwner {
    /// The geom.
    pub geom: GeomKey,
    /// Its body; `None` for the static world.
    pub body: Option<ferrode_dynamics::BodyKey>,
    /// The triangle that touches, for meshes; −1 for other shapes.
    pub side: i32,
}

/// A contact of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TouchingContact {
    /// The first geom, into which the normal points.
    pub first: ContactOwner,
    /// The second geom.
    pub second: ContactOwner,
    /// Where they touch.
    pub point: ContactPoint,
    /// Force on the first body in the last step, in newtons, world frame.
    pub force: Vec3,
    pub(crate) joint: Option<ferrode_dynamics::JointKey>,
}

impl World {
    /// Broad phase: pairs of geoms whose boxes overlap and whose bits allow it, in the space's order.
    pub(crate) fn find_pairs(&mut self, scratch: &mut Scratch) -> Result<(), Error> {
        scratch.pairs.clear();
        let pairs = &mut scratch.pairs;
        self.colliders.collide(self.space, |_, a, b| {
            if let (Item::Geom(a), Item::Geom(b)) = (a, b) {
                pairs.push((a, b));
            }
        })?;
        Ok(())
    }

    /// Narrow phase: a contact joint for every point at which a pair that can move touches.
    pub(crate) fn make_contacts(&mut self, scratch: &mut Scratch) -> Result<(), Error> {
        self.contacts.clear();
        scratch.touching.clear();
        for (a, b) in &scratch.pairs {
            let (slot_a, slot_b) = (self.geom_slot(*a)?, self.geom_slot(*b)?);
            let slots = (slot_a.min(slot_b), slot_a.max(slot_b));
            let (info_a, info_b) = (self.geom_info(*a)?.clone(), self.geom_info(*b)?.clone());
            match self.activity(&info_a, &info_b) {
                Activity::Moving => {}
                // Sleepers touch as they did before.
                Activity::Asleep => {
                    if self.touching.binary_search(&slots).is_ok() {
                        scratch.touching.push(slots);
                    }
                    continue;
                }
                Activity::Immovable => continue,
            }
            if self.are_joined(&info_a, &info_b)? {
                continue;
            }
            let Some(surface) = self.pair_surface(&info_a, &info_b) else { continue };
            scratch.found.clear();
            let options = CollideOptions::new(self.max_contacts);
            let found = match self.contact_source {
                ContactSource::Steady => self.colliders.steady_contacts(*a, *b, options, &mut scratch.found),
                ContactSource::Ode => self.colliders.geom_contacts(*a, *b, options, &mut scratch.found),
            };
            if found == 0 {
                continue;
            }
            scratch.touching.push(slots);
            for contact in &scratch.found {
                self.add_contact(&info_a, &info_b, contact, surface)?;
            }
        }
        Ok(())
    }

    fn activity(&self, a: &GeomInfo, b: &GeomInfo) -> Activity {
        let body = |info: &GeomInfo| info.body.and_then(|key| self.dynamics.body(key).ok());
        let bodies = [body(a), body(b)];
        let movable = |body: &Body| !body.is_kinematic() && !body.is_quarantined();
        if !bodies.iter().flatten().any(|body| movable(body)) {
            Activity::Immovable
        } else if bodies.iter().flatten().any(|body| body.is_enabled()) {
            Activity::Moving
        } else {
            Activity::Asleep
        }
    }

    /// Whether a joint keeps the two bodies from colliding.
    pub(crate) fn are_joined(&self, a: &GeomInfo, b: &GeomInfo) -> Result<bool, Error> {
        // A joint to the static world says nothing about the ground's geoms.
        let (Some(body_a), Some(body_b)) = (a.body, b.body) else { return Ok(false) };
        let mut joints = self.dynamics.connecting_joints(Some(body_a), Some(body_b))?;
        Ok(joints.any(|joint| {
            self.dynamics.joint_group(joint).ok().flatten() != Some(self.contact_group)
                && !self.joined_collide.contains_key(&joint)
        }))
    }

    /// The surface between two geoms; `None` if they pass through each other.
    pub(crate) fn pair_surface(&self, a: &GeomInfo, b: &GeomInfo) -> Option<Surface> {
        if !self.pair_surfaces.is_empty()
            && let Some(surface) = self.pair_surfaces.get(&(a.key.min(b.key), a.key.max(b.key)))
        {
            return *surface;
        }
        Some(self.rules.surface(&a.material, &b.material))
    }

    fn add_contact(
        &mut self,
        a: &GeomInfo,
        b: &GeomInfo,
        found: &GeomContact,
        mut surface: Surface,
    ) -> Result<(), Error> {
        if a.body.is_none() {
            // A joint from the static world to a body counts the body as its first.
            (surface.motion1, surface.motion2) = (-surface.motion1, -surface.motion2);
        }
        let mut contact = Contact::at(found.point, surface);
        if let Some(direction) = self.friction_direction(a, b, found.point.normal)? {
            surface.mode |= SurfaceMode::FDIR1;
            contact.surface = surface;
            contact.fdir1 = direction;
        }
        let joint = self.dynamics.create_contact(Some(self.contact_group), &contact)?;
        self.dynamics.attach(joint, a.body, b.body)?;
        self.dynamics.set_joint_feedback(joint, true)?;
        self.contacts.push(TouchingContact {
            first: ContactOwner { geom: a.key, body: a.body, side: found.side1 },
            second: ContactOwner { geom: b.key, body: b.body, side: found.side2 },
            point: found.point,
            force: Vec3::ZERO,
            joint: Some(joint),
        });
        Ok(())
    }

    /// The first friction direction in the world, in the tangent plane: of the first geom that has one.
    fn friction_direction(&self, a: &GeomInfo, b: &GeomInfo, normal: Vec3) -> Result<Option<Vec3>, Error> {
        for info in [a, b] {
            if let Some(direction) = info.material.friction_direction {
                let world = self.geom(info.key)?.pose().transform_vector(direction);
                return Ok((world - normal * normal.dot(world)).normalized());
            }
        }
        Ok(None)
    }

    /// Takes the forces of the step just made, and destroys its contact joints.
    pub(crate) fn finish_contacts(&mut self) -> Result<(), Error> {
        for contact in &mut self.contacts {
            if let Some(joint) = contact.joint
                && let Some(feedback) = self.dynamics.joint_feedback(joint)?
            {
                // A contact of the static world with a body is turned round inside; its force is on the body.
                let on_body = feedback.force1;
                contact.force = if contact.first.body.is_some() { on_body } else { -on_body };
            }
        }
        Ok(self.dynamics.empty_group(self.contact_group)?)
    }
}

/// Whether a pair of geoms needs contacts.
enum Activity {
    /// An awake body can be moved.
    Moving,
    /// All movable bodies sleep.
    Asleep,
    /// Nothing can be moved.
    Immovable,
}
