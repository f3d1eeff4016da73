//! The ranges of a joint's axes, as stops see them.

use super::{JointKey, LimitMotor};
use crate::{Error, World};
use core::f64::consts::PI;
use ferrode_math::{Vec3, plane_space};

/// An axis of a joint that can have stops, and where it is now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitedAxis {
    /// The number of its group of parameters: 1, 2 or 3.
    pub number: usize,
    /// It turns (else it slides).
    pub turns: bool,
    /// Unit vector, in the world: the position grows as the joint's first body turns about it by the right hand, or slides
    /// along it. For a joint attached as (world, body) that is the caller's second body.
    pub axis: Vec3,
    /// Of one that turns: a unit vector across the axis that turns along as the position grows. Zero of one that slides.
    pub hand: Vec3,
    /// What is compared with the stops: m or rad.
    pub position: f64,
    /// The low stop; −∞ for none.
    pub low: f64,
    /// The high stop; ∞ for none.
    pub high: f64,
}

impl LimitedAxis {
    pub(crate) fn sliding(number: usize, axis: Vec3, position: f64, motor: &LimitMotor) -> Self {
        Self::new(number, axis, Vec3::ZERO, position, motor, motor.has_linear_stops())
    }

    /// `hand` need not be square to the axis.
    pub(crate) fn turning(number: usize, axis: Vec3, hand: Vec3, position: f64, motor: &LimitMotor) -> Self {
        let unit = axis.normalized_or(Vec3::X);
        let across = (hand - unit * hand.dot(unit)).normalized_or(plane_space(unit).0);
        Self { turns: true, ..Self::new(number, axis, across, position, motor, motor.has_angular_stops()) }
    }

    /// For an angle of which any finite stop counts.
    pub(crate) fn with_any_stop(self, motor: &LimitMotor) -> Self {
        let (low, high) =
            if motor.has_linear_stops() { motor.limits() } else { (f64::NEG_INFINITY, f64::INFINITY) };
        Self { low, high, ..self }
    }

    fn new(
        number: usize,
        axis: Vec3,
        hand: Vec3,
        position: f64,
        motor: &LimitMotor,
        stops_count: bool,
    ) -> Self {
        let (low, high) = if stops_count { motor.limits() } else { (f64::NEG_INFINITY, f64::INFINITY) };
        Self { number, turns: false, axis: axis.normalized_or(Vec3::X), hand, position, low, high }
    }

    /// Whether there is a stop that the axis can reach: a turning one only within ±π.
    pub fn has_stops(&self) -> bool {
        let reach = if self.turns { PI } else { f64::INFINITY };
        self.low > -reach || self.high < reach
    }
}

impl World {
    /// The axes of a joint that can have stops, with their positions and stops; empty for joints without such axes or not
    /// attached to any body. Stops that don't count (in the wrong order, or of angles beyond ±π) are infinite.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn joint_limits(&self, joint: JointKey) -> Result<Vec<LimitedAxis>, Error> {
        let index = self.joint_index(joint)?;
        let ends = self.ends_of(index);
        if ends.first.is_none() {
            return Ok(Vec::new());
        }
        Ok(self.joints.at(index).kind.model().limited_axes(&ends))
    }
}

#[cfg(test)]
mod tests {
    use super::LimitedAxis;
    use crate::{
        AMotor, AMotorMode, AxisFrame, BodyKey, Hinge, Hinge2, JointData, JointKey, JointMut, PR, PU, Piston,
        Slider, Universal, World,
    };
    use ferrode_math::{Pose, Quat, Vec3};

    const STEP: f64 = 1e-4;

    fn vec3(x: f64, y: f64, z: f64) -> Vec3 {
        Vec3::new(x, y, z)
    }

    /// Attaches a joint in each way (of a type that needs two bodies in one), and moves its first body along each axis: the position must grow by as much, and the hand
    /// turn along.
    fn check<J: JointData>(
        axes: usize,
        alone: bool,
        set: impl Fn(&mut JointMut<'_, J>),
        anchor: impl Fn(&World, JointKey) -> Vec3,
    ) {
        for way in 0..3 {
            let mut world = World::new();
            let place = |world: &mut World, at: Vec3, turn: Vec3| -> BodyKey {
                let body = world.create_body();
                let turn = Quat::from_axis_angle(turn.normalized().unwrap(), 0.7);
                world.body_mut(body).unwrap().set_pose(Pose::new(at, turn)).unwrap();
                body
            };
            let bodies = [
                place(&mut world, vec3(0.3, -0.2, 0.9), vec3(1.0, 2.0, -0.5)),
                place(&mut world, vec3(-0.6, 0.4, 0.1), vec3(-0.3, 1.0, 0.8)),
            ];
            let joint = world.create_joint::<J>(None).unwrap();
            let ends = match way {
                0 => [Some(bodies[0]), Some(bodies[1])],
                _ if !alone => continue,
                1 => [Some(bodies[0]), None],
                _ => [None, Some(bodies[0])],
            };
            world.attach(joint, ends[0], ends[1]).unwrap();
            set(&mut world.joint_mut::<J>(joint).unwrap());
            let before = world.joint_limits(joint).unwrap();
            assert_eq!(before.len(), axes);
            for axis in &before {
                let mut moved = world.clone();
                let body = moved.body_mut(bodies[0]).unwrap();
                let pose = body.pose();
                let pose = if axis.turns {
                    let turn = Quat::from_axis_angle(axis.axis, STEP);
                    let centre = anchor(&world, joint);
                    Pose::new(centre + turn.rotate(pose.position - centre), turn * pose.rotation)
                } else {
                    Pose::new(pose.position + axis.axis * STEP, pose.rotation)
                };
                body.set_pose(pose).unwrap();
                let after: LimitedAxis =
                    *moved.joint_limits(joint).unwrap().iter().find(|a| a.number == axis.number).unwrap();
                let told = format!("attached in way {way}: {axis:?}, then {after:?}");
                assert!((after.position - axis.position - STEP).abs() < 1e-3 * STEP, "{told}");
                if axis.turns {
                    assert!(axis.hand.dot(axis.axis).abs() < 1e-12, "{told}");
                    let turned = Quat::from_axis_angle(axis.axis, STEP).rotate(axis.hand);
                    assert!((after.hand - turned).length() < 1e-3 * STEP, "{told}");
                }
            }
        }
    }

    const AT: Vec3 = Vec3 { x: 0.1, y: 0.2, z: 0.3 };

    #[test]
    fn hinges_and_sliders() {
        let axis = vec3(0.6, 0.0, 0.8);
        let anchor = |_: &World, _: JointKey| AT;
        check::<Hinge>(
            1,
            true,
            |joint| {
                joint.set_anchor(AT).unwrap();
                joint.set_axis(axis).unwrap();
            },
            anchor,
        );
        check::<Slider>(1, true, |joint| joint.set_axis(axis).unwrap(), anchor);
        check::<Piston>(
            2,
            true,
            |joint| {
                joint.set_anchor(AT).unwrap();
                joint.set_axis(axis).unwrap();
            },
            anchor,
        );
    }

    #[test]
    fn joints_with_two_axes_and_more() {
        let (axis1, axis2) = (vec3(0.6, 0.0, 0.8), vec3(0.0, 1.0, 0.0));
        let anchor = |_: &World, _: JointKey| AT;
        check::<Universal>(
            2,
            true,
            |joint| {
                joint.set_anchor(AT).unwrap();
                joint.set_axis1(axis1).unwrap();
                joint.set_axis2(axis2).unwrap();
            },
            anchor,
        );
        check::<Hinge2>(
            1,
            false,
            |joint| {
                joint.set_anchor(AT).unwrap();
                joint.set_axes(Some(axis1), Some(axis2)).unwrap();
            },
            anchor,
        );
        check::<PR>(
            2,
            true,
            |joint| {
                joint.set_anchor(AT).unwrap();
                joint.set_axis1(axis1).unwrap();
                joint.set_axis2(axis2).unwrap();
            },
            anchor,
        );
        check::<PU>(
            3,
            true,
            |joint| {
                joint.set_anchor(AT).unwrap();
                joint.set_axis1(axis1).unwrap();
                joint.set_axis2(axis2).unwrap();
                joint.set_axis3(vec3(0.8, 0.0, -0.6)).unwrap();
            },
            anchor,
        );
    }

    #[test]
    fn angular_motors_by_euler_angles() {
        check::<AMotor>(
            3,
            true,
            |joint| {
                joint.set_mode(AMotorMode::Euler);
                joint.set_axis(0, AxisFrame::First, vec3(0.6, 0.0, 0.8)).unwrap();
                joint.set_axis(2, AxisFrame::Second, vec3(0.0, 1.0, 0.0)).unwrap();
            },
            |_, _| AT,
        );
    }

    #[test]
    fn stops_that_do_not_count_are_none() {
        let mut world = World::new();
        let body = world.create_body();
        let joint = world.create_joint::<Hinge>(None).unwrap();
        assert!(world.joint_limits(joint).unwrap().is_empty(), "not attached");
        world.attach(joint, Some(body), None).unwrap();
        let mut limits = |low: f64, high: f64| {
            world.joint_mut::<Hinge>(joint).unwrap().set_limits(low, high).unwrap();
            let axis = world.joint_limits(joint).unwrap()[0];
            (axis.low, axis.high, axis.has_stops())
        };
        assert_eq!(limits(-0.5, 0.8), (-0.5, 0.8, true));
        assert_eq!(limits(0.8, -0.5), (f64::NEG_INFINITY, f64::INFINITY, false));
        assert_eq!(limits(-0.5, f64::INFINITY), (-0.5, f64::INFINITY, true));
        assert!(!limits(-7.0, 7.0).2);
    }
}
