//! Joints in one call, for those who know where they want them.

use crate::{Error, World};
use ferrode_dynamics::{Ball, BodyKey, Fixed, Hinge, Hinge2, JointData, JointKey, Slider, Universal};
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

    /// Links two bodies by a slider along a world axis.
    ///
    /// # Errors
    /// As [`World::add_ball`].
    pub fn add_slider(
        &mut self,
        a: Option<BodyKey>,
        b: Option<BodyKey>,
        axis: Vec3,
    ) -> Result<JointKey, Error> {
        self.add_joint::<Slider>(a, b, |world, joint| world.joint_mut::<Slider>(joint)?.set_axis(axis))
    }

    /// Links two bodies by a universal joint: `axis1` is fixed to the first, `axis2` to the second.
    ///
    /// # Errors
    /// As [`World::add_ball`].
    pub fn add_universal(
        &mut self,
        a: Option<BodyKey>,
        b: Option<BodyKey>,
        anchor: Vec3,
        axis1: Vec3,
        axis2: Vec3,
    ) -> Result<JointKey, Error> {
        self.add_joint::<Universal>(a, b, |world, joint| {
            let mut universal = world.joint_mut::<Universal>(joint)?;
            universal.set_anchor(anchor)?;
            universal.set_axis1(axis1)?;
            universal.set_axis2(axis2)
        })
    }

    /// Links a chassis and a wheel by a hinge-2: steering and suspension along `axis1`, the wheel turns about `axis2`.
    ///
    /// # Errors
    /// As [`World::add_ball`].
    pub fn add_hinge2(
        &mut self,
        chassis: BodyKey,
        wheel: BodyKey,
        anchor: Vec3,
        axis1: Vec3,
        axis2: Vec3,
    ) -> Result<JointKey, Error> {
        self.add_joint::<Hinge2>(Some(chassis), Some(wheel), |world, joint| {
            let mut hinge2 = world.joint_mut::<Hinge2>(joint)?;
            hinge2.set_anchor(anchor)?;
            hinge2.set_axes(Some(axis1), Some(axis2))
        })
    }

    /// Glues two bodies together as they stand.
    ///
    /// # Errors
    /// As [`World::add_ball`].
    pub fn add_fixed(&mut self, a: Option<BodyKey>, b: Option<BodyKey>) -> Result<JointKey, Error> {
        self.add_joint::<Fixed>(a, b, |world, joint| {
            world.joint_mut::<Fixed>(joint)?.set_fixed();
            Ok(())
        })
    }
}
