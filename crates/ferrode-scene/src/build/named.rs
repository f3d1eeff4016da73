//! Links and joints under their names in the file.

use ferrode::{BodyKey, JointKey, Pose, Vec3};

use super::NamedWorld;
use crate::description::{Joint, JointId, Link, LinkId};

/// A link of a [`NamedWorld`].
#[derive(Clone, Copy, Debug)]
pub struct NamedLink<'w> {
    world: &'w NamedWorld,
    id: LinkId,
}

impl<'w> NamedLink<'w> {
    pub(super) fn new(world: &'w NamedWorld, id: LinkId) -> Self {
        Self { world, id }
    }

    /// Its place in the scene.
    pub fn id(&self) -> LinkId {
        self.id
    }

    /// What the file says of it.
    pub fn description(&self) -> &'w Link {
        &self.world.scene.links[self.id.0]
    }

    /// Its body; `None` if it belongs to a static model.
    pub fn body(&self) -> Option<BodyKey> {
        self.world.link_body(self.id)
    }

    /// Its frame in the world, now.
    pub fn pose(&self) -> Pose {
        self.world.link_pose(self.id)
    }

    /// The velocity of its origin in m/s and its angular velocity in rad/s, in the world.
    pub fn velocity(&self) -> (Vec3, Vec3) {
        self.world.link_velocity(self.id)
    }
}

/// A joint of a [`NamedWorld`].
#[derive(Clone, Copy, Debug)]
pub struct NamedJoint<'w> {
    world: &'w NamedWorld,
    id: JointId,
}

impl<'w> NamedJoint<'w> {
    pub(super) fn new(world: &'w NamedWorld, id: JointId) -> Self {
        Self { world, id }
    }

    /// Its place in the scene.
    pub fn id(&self) -> JointId {
        self.id
    }

    /// What the file says of it.
    pub fn description(&self) -> &'w Joint {
        &self.world.scene.joints[self.id.0]
    }

    /// The engine's joint; `None` if it could not be built, see [`NamedWorld::warnings`].
    pub fn key(&self) -> Option<JointKey> {
        self.world.joint_key(self.id)
    }

    /// How many axes it has a position of: 0, 1 or 2.
    pub fn axis_count(&self) -> usize {
        (0..2).filter(|&axis| self.position(axis).is_some()).count()
    }

    /// The position of axis 0 or 1 in the file's sense; see [`NamedWorld::joint_position`].
    pub fn position(&self, axis: usize) -> Option<f64> {
        self.world.joint_position(self.id, axis)
    }

    /// The velocity of axis 0 or 1 in the file's sense; see [`NamedWorld::joint_velocity`].
    pub fn velocity(&self, axis: usize) -> Option<f64> {
        self.world.joint_velocity(self.id, axis)
    }

    /// The unit of the position of axis 0 or 1: `rad` or `m`. `None` if it has no such axis.
    pub fn unit(&self, axis: usize) -> Option<&'static str> {
        let built = self.world.built(self.id)?;
        built.motor(axis).map(|_| if built.is_angular() { "rad" } else { "m" })
    }
}
