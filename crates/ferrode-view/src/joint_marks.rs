//! Where a joint is: its anchors, axes and limits, as the engine gives them.

use ferrode::dynamics::World;
use ferrode::{
    AMotor, AxisFrame, Ball, DBall, DHinge, Hinge, Hinge2, JointKey, JointType, LMotor, LimitedAxis, PR, PU,
    Piston, Slider, Transmission, Universal,
};
use ferrode_math::{Quat, Vec3};
use std::f64::consts::PI;

/// An axis of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisMark {
    /// A point on it, in the world.
    pub at: Vec3,
    /// Unit vector along it.
    pub along: Vec3,
}

/// The range of an axis that has stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeMark {
    /// Of an axis that turns: a point on it. Of one that slides: the centre of the joint's first body.
    pub at: Vec3,
    /// The axis, its position and its stops, as the engine compares them.
    pub limit: LimitedAxis,
}

impl RangeMark {
    /// Where the hand is, or the first body's centre, when the axis is at `position`; hands are of length `radius`.
    pub fn place(&self, position: f64, radius: f64) -> Vec3 {
        let moved = position - self.limit.position;
        if self.limit.turns {
            self.at + Quat::from_axis_angle(self.limit.axis, moved).rotate(self.limit.hand) * radius
        } else {
            self.at + self.limit.axis * moved
        }
    }

    /// The stops that can be reached: angles within ±π.
    pub fn stops(&self) -> impl Iterator<Item = f64> + use<> {
        let reach = if self.limit.turns { PI } else { f64::INFINITY };
        [self.limit.low, self.limit.high].into_iter().filter(move |stop| stop.abs() < reach)
    }
}

/// What is to be seen of a joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointMarks {
    /// Its anchors, in the world; where two should be one, both, so that an error shows.
    pub anchors: Vec<Vec3>,
    /// Its axes.
    pub axes: Vec<AxisMark>,
    /// The ranges of those that have stops.
    pub ranges: Vec<RangeMark>,
}

fn free(at: Vec3, along: Vec3) -> AxisMark {
    AxisMark { at, along }
}

fn ranges(world: &World, joint: JointKey, anchor: Vec3) -> Vec<RangeMark> {
    let limits = world.joint_limits(joint).unwrap_or_default();
    let at = |limit: &LimitedAxis| if limit.turns { anchor } else { first_centre(world, joint) };
    limits
        .into_iter()
        .filter(LimitedAxis::has_stops)
        .map(|limit| RangeMark { at: at(&limit), limit })
        .collect()
}

/// The centre of a joint's first body.
fn first_centre(world: &World, joint: JointKey) -> Vec3 {
    let first = world.joint_bodies(joint).unwrap_or_default().into_iter().flatten().next();
    first.and_then(|key| world.body(key).ok()).map_or(Vec3::ZERO, |body| body.position())
}

/// The middle of a joint's bodies, for joints that have no anchor.
fn middle(world: &World, joint: JointKey) -> Vec3 {
    let bodies = world.joint_bodies(joint).unwrap_or_default();
    let places =
        bodies.into_iter().flatten().filter_map(|key| world.body(key).ok()).map(|body| body.position());
    let (sum, count) = places.fold((Vec3::ZERO, 0.0), |(sum, count), place| (sum + place, count + 1.0));
    if count > 0.0 { sum * (1.0 / count) } else { Vec3::ZERO }
}

/// What is to be seen of a joint; `None` for contacts and joints that are not attached.
pub fn joint_marks(world: &World, joint: JointKey) -> Option<JointMarks> {
    let kind = world.joint_type(joint).ok()?;
    if world.joint_bodies(joint).ok()? == [None, None] {
        return None;
    }
    let (anchors, axes): (Vec<Vec3>, Vec<AxisMark>) = match kind {
        JointType::Ball => {
            let joint = world.joint::<Ball>(joint).ok()?;
            (vec![joint.anchor(), joint.anchor2()], vec![])
        }
        JointType::Hinge => {
            let hinge = world.joint::<Hinge>(joint).ok()?;
            (vec![hinge.anchor(), hinge.anchor2()], vec![free(hinge.anchor(), hinge.axis())])
        }
        JointType::Slider => {
            let slider = world.joint::<Slider>(joint).ok()?;
            let at = first_centre(world, joint);
            (vec![at], vec![free(at, slider.axis())])
        }
        JointType::Universal => {
            let joint = world.joint::<Universal>(joint).ok()?;
            let at = joint.anchor();
            (vec![at, joint.anchor2()], vec![free(at, joint.axis1()), free(at, joint.axis2())])
        }
        JointType::Hinge2 => {
            let joint = world.joint::<Hinge2>(joint).ok()?;
            let at = joint.anchor();
            (vec![at, joint.anchor2()], vec![free(at, joint.axis1()), free(at, joint.axis2())])
        }
        JointType::PR => {
            let joint = world.joint::<PR>(joint).ok()?;
            let at = joint.anchor();
            (vec![at], vec![free(at, joint.axis1()), free(at, joint.axis2())])
        }
        JointType::PU => {
            let joint = world.joint::<PU>(joint).ok()?;
            let at = joint.anchor();
            (vec![at], [joint.axis1(), joint.axis2(), joint.axis3()].map(|along| free(at, along)).to_vec())
        }
        JointType::Piston => {
            let joint = world.joint::<Piston>(joint).ok()?;
            (vec![joint.anchor(), joint.anchor2()], vec![free(joint.anchor(), joint.axis())])
        }
        JointType::DBall => {
            let joint = world.joint::<DBall>(joint).ok()?;
            (vec![joint.anchor1(), joint.anchor2()], vec![])
        }
        JointType::DHinge => {
            let joint = world.joint::<DHinge>(joint).ok()?;
            let (a, b) = (joint.anchor1(), joint.anchor2());
            (vec![a, b], vec![free(a, joint.axis()), free(b, joint.axis())])
        }
        JointType::Transmission => {
            let joint = world.joint::<Transmission>(joint).ok()?;
            let (a, b) = (joint.anchor1(), joint.anchor2());
            (vec![a, b], vec![free(a, joint.axis1()), free(b, joint.axis2())])
        }
        JointType::AMotor => {
            let at = middle(world, joint);
            let motor = world.joint::<AMotor>(joint).ok()?;
            (vec![], (0..motor.axis_count()).map(|axis| free(at, motor.axis(axis))).collect())
        }
        JointType::LMotor => {
            let at = middle(world, joint);
            let motor = world.joint::<LMotor>(joint).ok()?;
            // They are kept in the coordinates of what they are fixed to; a single body is the first.
            let turn = |frame: AxisFrame| {
                let ends = world.joint_bodies(joint).unwrap_or_default();
                let place = match frame {
                    AxisFrame::World => return Quat::IDENTITY,
                    AxisFrame::First => 0,
                    AxisFrame::Second => 1,
                };
                let key = ends.into_iter().flatten().nth(place);
                key.and_then(|key| world.body(key).ok()).map_or(Quat::IDENTITY, |body| body.quaternion())
            };
            let axis = |n: usize| turn(motor.axis_frame(n)).rotate(motor.axis(n));
            (vec![], (0..motor.axis_count().min(3)).map(|n| free(at, axis(n))).collect())
        }
        JointType::Fixed => (vec![middle(world, joint)], vec![]),
        _ => return None,
    };
    let anchor = anchors.first().copied().unwrap_or_else(|| middle(world, joint));
    Some(JointMarks { ranges: ranges(world, joint, anchor), anchors, axes })
}
