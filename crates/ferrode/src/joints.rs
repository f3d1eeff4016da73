//! Joints in one call, for those who know where they want them.

use crate::{Error, World};
use ferrode_dynamics::{Ball, BodyKey, Hinge, JointData, JointKey};
use ferrode_math::Vec3;

impl World {
    fn add_joint<J: JointData>(
        &mut self,
        a: Option<BodyKey>,
        b: Option<BodyKey>,
        set: impl FnOnce(&mut ferrode_dynamics::World, JointKey) -> Result<(), ferrode_dynamics::Error>,
    ) -> Result<JointKey, Error> {
        let joint = self.dynamics.create_joint::<J>(None)?;
        let result = self.dynamics.attach(joint, a, b).and_then(|()| set(&mut self.dynamics, joint));
        if let Err(error) = result {
            self.dynamics.destroy_joint(joint)?;
            return Err(error.into());
        }
        Ok(joint)
    }

    /// Links two bodies (`None`: the static world) by a ball joint at a world point.
    ///
    /// # Errors
    /// As attaching and setting the anchor by hand; then no joint is added. So for all functions here.
    pub fn add_ball(
        &mut self,
        a: Option<BodyKey>,
        b: Option<BodyKey>,
        anchor: Vec3,
    ) -> Result<JointKey, Error> {
        self.add_joint::<Ball>(a, b, |world, joint| world.joint_mut::<Ball>(joint)?.set_anchor(anchor))
    }

    /// Links two bodies by a hinge through a world point along a world axis.
    ///
    /// # Errors
    /// As [`World::add_ball`].
    pub fn add_hinge(
        &mut self,
        a: Option<BodyKey>,
        b: Option<BodyKey>,
        anchor: Vec3,
        axis: Vec3,
    ) -> Result<JointKey, Error> {
        self.add_joint::<Hinge>(a, b, |world, joint| {
            let mut hinge = world.joint_mut::<Hinge>(joint)?;
            hinge.set_anchor(anchor)?;
            hinge.set_axis(axis)
        })
    }
}
