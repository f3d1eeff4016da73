//! Gears, a bevel gear and a chain: three transmissions, each with a motor at its left wheel.

use super::prelude::*;
use ferrode::{Hinge, Transmission, TransmissionMode};

const SPEED: f64 = 2.0;

pub(super) const DEMO: Demo = Demo {
    name: "transmission",
    subject: Subject::Motors,
    about: "motors drive a pair of gears, a chain and a bevel gear",
    property: "every wheel turns at its ratio, to 0.1 %",
    seconds: 4.0,
    picture_at: 2.0,
    show: &[],
    camera: Camera::new([0.9, -4.9, 2.4], [0.4, 0.0, 0.8]),
    build,
};

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Direct)?;
    let wheel = |world: &mut World, centre: Vec3, axis: Vec3, radius: f64| {
        let builder = BodyBuilder::new()
            .at(centre)
            .rotated(from_z_to(axis))
            .with_shape(Cylinder::new(radius, 0.1)?, 400.0)
            .with_shape_at(Cuboid::new(at(0.6 * radius, 0.1, 0.14))?, 0.0, Pose::IDENTITY);
        let key = world.add_body(builder)?;
        for geom in world.body_geoms(key)?.to_vec() {
            world.set_geom_bits(geom, 0, 0)?;
        }
        let hinge = world.add_hinge(Some(key), None, centre, axis)?;
        Ok::<_, Failure>((key, hinge, centre))
    };
    let gears = [
        wheel(&mut world, at(-2.0, 0.0, 1.0), Vec3::Y, 0.6)?,
        wheel(&mut world, at(-1.1, 0.0, 1.0), Vec3::Y, 0.3)?,
    ];
    let chain = [
        wheel(&mut world, at(-0.2, 0.0, 1.0), Vec3::Y, 0.3)?,
        wheel(&mut world, at(1.2, 0.0, 1.0), Vec3::Y, 0.45)?,
    ];
    let bevel = [
        wheel(&mut world, at(2.4, 0.0, 1.0), Vec3::Y, 0.35)?,
        wheel(&mut world, at(2.75, 0.35, 1.0), Vec3::X, 0.35)?,
    ];
    let couple = |world: &mut World, pair: &[(BodyKey, JointKey, Vec3); 2], mode: TransmissionMode| {
        let key = world.create_joint::<Transmission>(None)?;
        world.attach(key, Some(pair[0].0), Some(pair[1].0))?;
        world.joint_mut::<Hinge>(pair[0].1)?.set_motor(SPEED, 1000.0)?;
        world.joint_mut::<Transmission>(key)?.set_mode(mode);
        Ok::<_, Failure>(key)
    };
    let key = couple(&mut world, &gears, TransmissionMode::ParallelAxes)?;
    let mut joint = world.joint_mut::<Transmission>(key)?;
    joint.set_ratio(2.0)?;
    joint.set_axis(Vec3::Y)?;
    joint.set_anchor1(gears[0].2)?;
    joint.set_anchor2(gears[1].2)?;
    let key = couple(&mut world, &chain, TransmissionMode::ChainDrive)?;
    let mut joint = world.joint_mut::<Transmission>(key)?;
    joint.set_axis(Vec3::Y)?;
    joint.set_anchor1(chain[0].2)?;
    joint.set_anchor2(chain[1].2)?;
    joint.set_radius1(0.3)?;
    joint.set_radius2(0.45)?;
    let key = couple(&mut world, &bevel, TransmissionMode::IntersectingAxes)?;
    let mut joint = world.joint_mut::<Transmission>(key)?;
    joint.set_anchor1(bevel[0].2)?;
    joint.set_anchor2(bevel[1].2)?;
    joint.set_axis1(Vec3::Y)?;
    joint.set_axis2(Vec3::X)?;
    let driven = [
        ("gear (rad/s)", gears[1].1, -2.0 * SPEED),
        ("chain wheel (rad/s)", chain[1].1, SPEED * 0.3 / 0.45),
        ("bevel wheel (rad/s)", bevel[1].1, -SPEED),
    ];
    Stage::new(world, 0.005, driven)
        .draw(|_, world, drawing| {
            drawing.floor = Some(0.0);
            for (_, body) in world.bodies() {
                let place = body.position();
                let back = body.vector_to_world(Vec3::Z) * 0.1;
                drawing.block(at(0.08, 0.08, 1.0), at(place.x + back.x, place.y + back.y, 0.5), Tint::FRAME);
            }
            for geom in world.geoms() {
                let Ok(geom) = world.geom(geom.key) else { continue };
                if let Shape::Cylinder(wheel) = geom.shape() {
                    // A spoke, to see it turn.
                    let sides = at(1.8 * wheel.radius(), 0.06, wheel.length() + 0.02);
                    drawing.solid(Cuboid::new(sides), *geom.pose(), Tint::SPRING);
                }
            }
            // The chain, along both tangents of its wheels.
            let (near, far) = (at(-0.2, 0.0, 1.0), at(1.2, 0.0, 1.0));
            let cos: f64 = (0.3 - 0.45) / (far.x - near.x);
            for side in [-1.0, 1.0] {
                let out = at(cos, 0.0, side * (1.0 - cos * cos).sqrt());
                drawing.rod(near + out * 0.31, far + out * 0.46, 0.025, Tint::ROPE);
            }
        })
        .check(|driven, world| {
            let mut findings = Findings::new();
            for (name, hinge, expected) in driven {
                findings = findings.near(name, world.joint::<Hinge>(*hinge)?.angle_rate(), *expected, 1e-3);
            }
            Ok(findings)
        })
}
