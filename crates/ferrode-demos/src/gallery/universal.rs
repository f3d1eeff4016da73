//! A shaft with a universal joint: the bent half does not turn evenly.

use super::prelude::*;
use ferrode::{Hinge, Universal};
use ferrode_math::real;

const BEND: f64 = 35.0;
const SPEED: f64 = 4.0;

pub(super) const DEMO: Demo = Demo {
    name: "universal",
    subject: Subject::Joints,
    about: "a Cardan joint drives a bent shaft",
    property: "the driven shaft's speed goes between ω cos β and ω / cos β, within 1 %",
    seconds: 5.0,
    picture_at: 2.0,
    show: &[],
    camera: Camera::new([0.5, -2.5, 2.0], [0.0, 0.1, 0.72]),
    build,
};

#[derive(Clone)]
struct Shaft {
    driver: JointKey,
    cross: JointKey,
    driven: BodyKey,
    axis: Vec3,
    slowest: f64,
    quickest: f64,
}

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Direct)?;
    let middle = at(0.0, 0.0, 1.0);
    let bent = turn(Vec3::Z, BEND);
    let axis = bent.rotate(Vec3::X);
    let mut add = |direction: Vec3, side: f64| -> Result<BodyKey, Failure> {
        let disc = Pose { position: at(0.0, 0.0, side * 0.3), rotation: Quat::IDENTITY };
        let builder = BodyBuilder::new()
            .at(middle + direction * (0.55 * side))
            .rotated(from_z_to(direction))
            .with_shape(Cylinder::new(0.06, 1.0)?, 3000.0)
            .with_shape_at(Cuboid::new(at(0.5, 0.12, 0.1))?, 3000.0, disc);
        Ok(world.add_body(builder)?)
    };
    let first = add(Vec3::X, -1.0)?;
    let second = add(axis, 1.0)?;
    let driver = world.add_hinge(Some(first), None, middle - Vec3::X, Vec3::X)?;
    world.add_hinge(Some(second), None, middle + axis, axis)?;
    // The cross: one arm fixed to each shaft. Two hinges and this close a loop, which leaves one freedom.
    let cross = world.add_universal(Some(first), Some(second), middle, Vec3::Z, axis.cross(Vec3::Z))?;
    world.joint_mut::<Hinge>(driver)?.set_motor(SPEED, 500.0)?;
    let shaft = Shaft { driver, cross, driven: second, axis, slowest: f64::INFINITY, quickest: 0.0 };
    Stage::new(world, 0.002, shaft)
        .after(|shaft, world| {
            if world.time() > 1.0 {
                let speed = body(world, shaft.driven)?.angular_velocity().dot(shaft.axis);
                shaft.slowest = shaft.slowest.min(speed);
                shaft.quickest = shaft.quickest.max(speed);
            }
            Ok(())
        })
        .draw(|shaft, world, drawing| {
            drawing.floor = Some(0.0);
            let middle = at(0.0, 0.0, 1.0);
            // Bearings at both ends, and the cross.
            for place in [middle - Vec3::X, middle + shaft.axis] {
                drawing.block(at(0.07, 0.2, 1.1), place - at(0.0, 0.0, 0.45), Tint::FRAME);
            }
            if let Ok(cross) = world.joint::<Universal>(shaft.cross) {
                for arm in [cross.axis1(), cross.axis2()] {
                    drawing.rod(
                        cross.anchor() - arm * 0.13,
                        cross.anchor() + arm * 0.13,
                        0.025,
                        Tint::SPRING,
                    );
                }
            }
        })
        .check(|shaft, world| {
            let beta = real::cos(BEND.to_radians());
            let driver = world.joint::<Hinge>(shaft.driver)?.angle_rate();
            Ok(Findings::new()
                .near("driver (rad/s)", driver, SPEED, 1e-3)
                .near("slowest (rad/s)", shaft.slowest, SPEED * beta, 0.01)
                .near("quickest (rad/s)", shaft.quickest, SPEED / beta, 0.01)
                .at_most("joints open by (m)", joint_errors(world)?.0, 1e-4))
        })
}
