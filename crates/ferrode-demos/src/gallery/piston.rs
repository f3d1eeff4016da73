//! A crank turns and drives a piston: four joints close a loop.

use super::prelude::*;
use ferrode::{Hinge, Piston};

const CRANK: f64 = 0.3;
const ROD: f64 = 0.9;
const SPEED: f64 = 3.0;

pub(super) const DEMO: Demo = Demo {
    name: "piston",
    subject: Subject::Joints,
    about: "a crank drives a piston",
    property: "the piston is at r cos φ + √(l² − r² sin² φ) at every moment, to 0.1 mm",
    seconds: 5.0,
    picture_at: 0.4,
    show: &[],
    camera: Camera::new([0.9, -2.3, 1.6], [0.55, 0.0, 0.8]),
    build,
};

#[derive(Clone)]
struct Engine {
    crank: JointKey,
    head: BodyKey,
    off: f64,
}

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Direct)?;
    let origin = at(0.0, 0.0, 1.0);
    let x = |x: f64| origin + at(x, 0.0, 0.0);
    let wheel = BodyBuilder::new()
        .at(x(0.0))
        .rotated(turn(Vec3::X, 90.0))
        .with_shape(Cylinder::new(CRANK + 0.08, 0.06)?, 1000.0);
    let wheel = world.add_body(wheel)?;
    let rod = add_box(&mut world, at(ROD, 0.05, 0.06), 800.0, x(CRANK + 0.5 * ROD) + at(0.0, -0.1, 0.0))?;
    let head = BodyBuilder::new()
        .at(x(CRANK + ROD))
        .rotated(turn(Vec3::Y, 90.0))
        .with_shape(Cylinder::new(0.15, 0.2)?, 1000.0);
    let head = world.add_body(head)?;
    for key in [wheel, rod, head] {
        for geom in world.body_geoms(key)?.to_vec() {
            world.set_geom_bits(geom, 0, 0)?;
        }
    }
    let crank = world.add_hinge(Some(wheel), None, x(0.0), Vec3::Y)?;
    world.add_hinge(Some(rod), Some(wheel), x(CRANK), Vec3::Y)?;
    // A ball here: hinges all around would say three times that the mechanism is flat.
    world.add_ball(Some(rod), Some(head), x(CRANK + ROD))?;
    let cylinder = world.create_joint::<Piston>(None)?;
    world.attach(cylinder, Some(head), None)?;
    let mut piston = world.joint_mut::<Piston>(cylinder)?;
    piston.set_anchor(x(CRANK + ROD))?;
    piston.set_axis(Vec3::X)?;
    world.joint_mut::<Hinge>(crank)?.set_motor(SPEED, 1000.0)?;
    Stage::new(world, 0.002, Engine { crank, head, off: 0.0 })
        .after(|engine, world| {
            let (sin, cos) = sin_cos(world.joint::<Hinge>(engine.crank)?.angle());
            let expected = CRANK * cos + (ROD * ROD - CRANK * CRANK * sin * sin).sqrt();
            engine.off = engine.off.max((place(world, engine.head)?.x - expected).abs());
            Ok(())
        })
        .draw(|_, world, drawing| {
            drawing.floor = Some(0.0);
            let far = CRANK + ROD;
            for side in [-1.0, 1.0] {
                let rail = at(far, 0.0, 1.0 + side * 0.17);
                drawing.block(at(2.0 * CRANK + 0.3, 0.3, 0.03), rail, Tint::FRAME);
            }
            drawing.block(at(0.1, 0.3, 0.82), at(far + CRANK + 0.1, 0.0, 0.41), Tint::FRAME);
            drawing.block(at(0.12, 0.1, 1.06), at(0.0, 0.12, 0.53), Tint::FRAME);
            for joint in world.joints() {
                if let Ok(pin) = world.joint::<Hinge>(joint).map(|hinge| hinge.anchor()) {
                    drawing.rod(pin - Vec3::Y * 0.13, pin + Vec3::Y * 0.13, 0.028, Tint::SPRING);
                }
            }
        })
        .check(|engine, world| {
            let rate = world.joint::<Hinge>(engine.crank)?.angle_rate();
            Ok(Findings::new().near("crank (rad/s)", rate, SPEED, 1e-3).at_most(
                "the piston is off by (m)",
                engine.off,
                1e-4,
            ))
        })
}
