//! Where a joint is: its anchors, axes and limits, as the engine gives them.

use ferrode::dynamics::World;
use ferrode::{
    AMotor, Ball, DBall, DHinge, Hinge, Hinge2, JointKey, JointType, LMotor, LimitMotor, PR, PU, Piston,
    Slider, Transmission, Universal,
};
use ferrode_math::Vec3;

/// An axis of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisMark {
    /// A point on it, in the world.
    pub at: Vec3,
    /// Unit vector along it.
    pub along: Vec3,
    /// Its stops and where it is between them (rad or m), if it has both stops.
    pub range: Option<Range>,
}

/// The range of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower stop, upper stop.
    pub stops: [f64; 2],
    /// Where it is.
    pub position: f64,
    /// It turns (else it slides).
    pub turns: bool,
}

/// What is to be seen of a joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointMarks {
    /// Its anchors, in the world; where two should be one, both, so that an error shows.
    pub anchors: Vec<Vec3>,
    /// Its axes.
    pub axes: Vec<AxisMark>,
}

fn range(motor: Option<&LimitMotor>, position: f64, turns: bool) -> Option<Range> {
    let (low, high) = motor?.limits();
    let both = low.is_finite() && high.is_finite() && low <= high && position.is_finite();
    both.then_some(Range { stops: [low, high], position, turns })
}

fn free(at: Vec3, along: Vec3) -> AxisMark {
    AxisMark { at, along, range: None }
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
    let (anchors, axes) = match kind {
        JointType::Ball => {
            let joint = world.joint::<Ball>(joint).ok()?;
            (vec![joint.anchor(), joint.anchor2()], vec![])
        }
        JointType::Hinge => {
            let hinge = world.joint::<Hinge>(joint).ok()?;
            let range = range(hinge.limit_motor_of(0).ok(), hinge.angle(), true);
            let axis = AxisMark { at: hinge.anchor(), along: hinge.axis(), range };
            (vec![hinge.anchor(), hinge.anchor2()], vec![axis])
        }
        JointType::Slider => {
            let slider = world.joint::<Slider>(joint).ok()?;
            let range = range(slider.limit_motor_of(0).ok(), slider.position().unwrap_or(f64::NAN), false);
            let at = world.joint_bodies(joint).ok()?.into_iter().flatten().next();
            let at = at.and_then(|key| world.body(key).ok()).map_or(Vec3::ZERO, |body| body.position());
            (vec![at], vec![AxisMark { at, along: slider.axis(), range }])
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
            let range = range(joint.limit_motor_of(0).ok(), joint.position(), false);
            let axis = AxisMark { at: joint.anchor(), along: joint.axis(), range };
            (vec![joint.anchor(), joint.anchor2()], vec![axis])
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
            (vec![], (0..motor.axis_count()).map(|axis| free(at, motor.axis(axis))).collect())
        }
        JointType::Fixed => (vec![middle(world, joint)], vec![]),
        _ => return None,
    };
    Some(JointMarks { anchors, axes })
}
