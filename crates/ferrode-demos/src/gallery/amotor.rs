//! A shoulder: a ball joint, with an angular motor in Euler mode that drives and stops its three angles.

use super::prelude::*;
use ferrode::{AMotor, AMotorMode, AxisFrame};

pub(super) const DEMO: Demo = Demo {
    name: "amotor",
    subject: Subject::Motors,
    about: "a shoulder of a ball joint and an angular motor waves an arm",
    property: "the three Euler angles reach 0.7, −0.5 and 0.4 rad, to 2 mrad",
    seconds: 4.0,
    picture_at: 4.0,
    show: &[],
    camera: Camera::new([1.4, -2.5, 2.1], [0.25, 0.0, 1.05]),
    build,
};

const ASKED: [f64; 3] = [0.7, -0.5, 0.4];

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let trunk = add_box(&mut world, at(0.4, 0.3, 1.6), 500.0, at(-0.3, 0.0, 0.8))?;
    world.add_fixed(Some(trunk), None)?;
    let builder = BodyBuilder::new()
        .at(at(0.45, 0.0, 1.4))
        .with_shape(Cuboid::new(at(0.7, 0.12, 0.2))?, 500.0)
        .with_shape_at(Cuboid::new(at(0.15, 0.3, 0.06))?, 500.0, Pose::from_position(at(0.4, 0.0, 0.0)));
    let arm = world.add_body(builder)?;
    let shoulder = at(0.0, 0.0, 1.4);
    world.add_ball(Some(arm), Some(trunk), shoulder)?;
    let motor = world.create_joint::<AMotor>(None)?;
    world.attach(motor, Some(arm), Some(trunk))?;
    let mut amotor = world.joint_mut::<AMotor>(motor)?;
    amotor.set_mode(AMotorMode::Euler);
    amotor.set_axis(0, AxisFrame::First, Vec3::X)?;
    amotor.set_axis(2, AxisFrame::Second, Vec3::Z)?;
    // The middle angle has to stay clear of ±90°, where the other two axes coincide.
    amotor.set_limits_of(2, -1.2, 1.2)?;
    Stage::new(world, 0.005, motor)
        .before(|motor, world| {
            for (i, asked) in ASKED.into_iter().enumerate() {
                let error = asked - world.joint::<AMotor>(*motor)?.angle(i);
                let rate = (4.0 * error).clamp(-1.0, 1.0);
                world.joint_mut::<AMotor>(*motor)?.set_motor_of(i + 1, rate, 500.0)?;
            }
            Ok(())
        })
        .draw(|motor, world, drawing| {
            if let Ok(joint) = world.joint::<AMotor>(*motor) {
                let shoulder = at(0.0, 0.0, 1.4);
                drawing.solid(Sphere::new(0.13), Pose::from_position(shoulder), Tint::FRAME);
                for i in 0..3 {
                    let axis = joint.axis(i);
                    drawing.arrow(shoulder, shoulder + axis * 0.5, 0.012, Tint::MARK);
                }
            }
        })
        .check(|motor, world| {
            let joint = world.joint::<AMotor>(*motor)?;
            let off = (0..3).map(|i| (joint.angle(i) - ASKED[i]).abs()).fold(0.0, f64::max);
            Ok(Findings::new().at_most("angles are off by (rad)", off, 2e-3))
        })
}
