//! A wheel on a hinge-2 drives over bumps under a body that slides up and down: a quarter of a car.

use super::prelude::*;
use ferrode::Hinge2;

const H: f64 = 0.005;
const STIFFNESS: f64 = 3000.0;
const MASS: f64 = 60.0;

pub(super) const DEMO: Demo = Demo {
    name: "hinge2",
    subject: Subject::Joints,
    about: "a wheel's suspension swallows bumps",
    property: "at rest the spring is compressed by m g / k, within 1 %; over bumps of 60 mm the body moves by under 40 mm",
    seconds: 7.0,
    picture_at: 5.0,
    show: &[],
    camera: Camera::new([6.9, -2.4, 1.1], [6.35, 0.0, 0.5]),
    build,
};

#[derive(Clone)]
struct Quarter {
    wheel: BodyKey,
    chassis: BodyKey,
    joint: JointKey,
    /// Height difference of body and wheel at the start, and where it settled; the body's height then.
    start: f64,
    settled: f64,
    height: f64,
    swing: f64,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    world.set_default_material(Material::with_friction(2.0))?;
    for x in [6.0, 8.0, 10.0] {
        let bump = Pose { position: at(x, 0.0, -0.24), rotation: turn(Vec3::X, 90.0) };
        world.add_static(Cylinder::new(0.3, 1.0)?, bump)?;
    }
    let builder = BodyBuilder::new()
        .at(at(0.0, 0.0, 0.9))
        .with_mass(Mass::cuboid_total(MASS, at(0.8, 0.4, 0.3))?)
        .with_shape(Cuboid::new(at(0.8, 0.4, 0.3))?, 0.0);
    let chassis = world.add_body(builder)?;
    let hub = at(0.0, 0.0, 0.35);
    let builder = BodyBuilder::new()
        .at(hub)
        .rotated(turn(Vec3::X, 90.0))
        .with_mass(Mass::cylinder_total(4.0, ferrode::dynamics::Axis::Z, 0.35, 0.15)?)
        .with_shape(Cylinder::new(0.35, 0.15)?, 0.0);
    let wheel = world.add_body(builder)?;
    let joint = world.add_hinge2(chassis, wheel, hub, Vec3::Z, Vec3::Y)?;
    let mut hinge2 = world.joint_mut::<Hinge2>(joint)?;
    hinge2.set_suspension(spring(STIFFNESS, 250.0, H)?)?;
    hinge2.set_limits_of(1, 0.0, 0.0)?;
    // What keeps the body upright stands for the other three wheels: it may go ahead and up, and not turn.
    let frame = world.create_joint::<ferrode::AMotor>(None)?;
    world.attach(frame, Some(chassis), None)?;
    let mut motor = world.joint_mut::<ferrode::AMotor>(frame)?;
    motor.set_axis_count(3);
    for (i, axis) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
        motor.set_axis(i, ferrode::AxisFrame::World, axis)?;
        motor.set_motor_of(i + 1, 0.0, f64::INFINITY)?;
    }
    let quarter = Quarter { wheel, chassis, joint, start: 0.55, settled: 0.0, height: 0.0, swing: 0.0 };
    Stage::new(world, H, quarter)
        .before(|quarter, world| {
            let speed = if world.time() < 3.0 { 0.0 } else { (4.0 * (world.time() - 3.0)).min(4.0) };
            world.joint_mut::<Hinge2>(quarter.joint)?.set_motor_of(2, -speed / 0.35, 200.0)?;
            Ok(())
        })
        .after(|quarter, world| {
            let (top, hub) = (place(world, quarter.chassis)?.z, place(world, quarter.wheel)?.z);
            if world.time() < 3.0 {
                (quarter.settled, quarter.height) = (top - hub, top);
            } else {
                quarter.swing = quarter.swing.max((top - quarter.height).abs());
            }
            Ok(())
        })
        .draw(|quarter, world, drawing| {
            if let (Ok(hub), Ok(top)) = (place(world, quarter.wheel), place(world, quarter.chassis)) {
                let aside = at(0.0, -0.16, 0.0);
                drawing.spring(hub + aside, at(hub.x, 0.0, top.z - 0.12) + aside, 0.06, 6);
                drawing.rod(hub + aside, hub - aside, 0.03, Tint::FRAME);
            }
        })
        .check(|quarter, world| {
            Ok(Findings::new()
                .near("compressed by (m)", quarter.start - quarter.settled, MASS * G / STIFFNESS, 0.01)
                .at_most("over the bumps the body moved by (m)", quarter.swing, 0.04)
                .at_least("went to (m)", place(world, quarter.wheel)?.x, 10.0))
        })
}
