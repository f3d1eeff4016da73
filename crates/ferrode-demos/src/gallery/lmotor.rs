//! A portal crane: a linear motor moves its trolley along three axes around a square, a load swings below.

use super::prelude::*;
use ferrode::{AxisFrame, LMotor};

pub(super) const DEMO: Demo = Demo {
    name: "lmotor",
    subject: Subject::Motors,
    about: "a linear motor drives a trolley around a square, with a load on a rope",
    property: "the trolley is back where it began to 1 cm, and was at each corner to 1 cm",
    seconds: 8.0,
    picture_at: 3.0,
    show: &[],
    camera: Camera::new([3.9, -5.2, 3.5], [0.0, 0.0, 1.25]),
    build,
};

const CORNERS: [[f64; 2]; 4] = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];

#[derive(Clone)]
struct Crane {
    trolley: BodyKey,
    motor: JointKey,
    worst: f64,
    trail: Trail,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let trolley = add_box(&mut world, at(0.4, 0.4, 0.2), 800.0, at(-1.0, -1.0, 2.6))?;
    let load = add_ball(&mut world, 0.2, 1000.0, at(-1.0, -1.0, 1.4))?;
    let rope = world.create_joint::<ferrode::DBall>(None)?;
    world.attach(rope, Some(load), Some(trolley))?;
    let mut joint = world.joint_mut::<ferrode::DBall>(rope)?;
    joint.set_anchor1(at(-1.0, -1.0, 1.6))?;
    joint.set_anchor2(at(-1.0, -1.0, 2.5))?;
    let motor = world.create_joint::<LMotor>(None)?;
    world.attach(motor, Some(trolley), None)?;
    let mut joint = world.joint_mut::<LMotor>(motor)?;
    joint.set_axis_count(3);
    for (i, axis) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
        joint.set_axis(i, AxisFrame::World, axis)?;
        joint.set_motor_of(i + 1, 0.0, 20_000.0)?;
    }
    let upright = world.create_joint::<ferrode::AMotor>(None)?;
    world.attach(upright, Some(trolley), None)?;
    let mut joint = world.joint_mut::<ferrode::AMotor>(upright)?;
    joint.set_axis_count(3);
    for (i, axis) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
        joint.set_axis(i, AxisFrame::World, axis)?;
        joint.set_motor_of(i + 1, 0.0, 20_000.0)?;
    }
    Stage::new(world, 0.002, Crane { trolley, motor, worst: 0.0, trail: Trail::default() })
        .before(|crane, world| {
            let side = ((world.time() + 1e-9) / 2.0) as usize % 4;
            let p = place(world, crane.trolley)?;
            let speed = |error: f64| (8.0 * error).clamp(-1.5, 1.5);
            let velocity = [speed(CORNERS[side][0] - p.x), speed(CORNERS[side][1] - p.y), speed(2.6 - p.z)];
            let mut joint = world.joint_mut::<LMotor>(crane.motor)?;
            for (i, v) in velocity.into_iter().enumerate() {
                joint.set_motor_of(i + 1, v, 20_000.0)?;
            }
            Ok(())
        })
        .after(|crane, world| {
            crane.trail.follow(place(world, crane.trolley)?, 10);
            let side = world.time() / 2.0;
            if (side - side.round()).abs() < 1e-3 {
                let [x, y] = CORNERS[(side.round() as usize + 3) % 4];
                crane.worst = crane.worst.max((place(world, crane.trolley)? - at(x, y, 2.6)).length());
            }
            Ok(())
        })
        .draw(|crane, world, drawing| {
            drawing.rods(world, 0.012);
            for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                let corner = at(1.3 * x, 1.3 * y, 2.8);
                drawing.rod(at(corner.x, corner.y, 0.0), corner, 0.04, Tint::FRAME);
                drawing.rod(corner, at(-1.3 * y, 1.3 * x, 2.8), 0.04, Tint::FRAME);
            }
            drawing.path(&crane.trail);
        })
        .check(|crane, world| {
            Ok(Findings::new().at_most("a corner was missed by (m)", crane.worst, 0.01).at_most(
                "the rope is off by (m)",
                joint_errors(world)?.0,
                1e-4,
            ))
        })
}
