//! A six-legged creature walks in a tripod gait: its legs follow sines, nothing else holds it up.

use super::prelude::*;
use core::f64::consts::{PI, TAU};
use ferrode::Hinge;

const H: f64 = 0.004;
const PERIOD: f64 = 0.8;

pub(super) const DEMO: Demo = Demo {
    name: "walker",
    subject: Subject::Creatures,
    about: "a six-legged creature walks",
    property: "it walks two metres ahead, upright, and strays by less than a fifth of its way",
    seconds: 10.0,
    picture_at: 4.0,
    show: &[],
    camera: Camera::new([2.7, -2.4, 1.35], [1.75, 0.0, 0.2]),
    build,
};

#[derive(Clone)]
struct Leg {
    /// Swings the leg to and fro about the vertical.
    hip: JointKey,
    /// Lifts it about the length of the body.
    lift: JointKey,
    phase: f64,
    side: f64,
}

#[derive(Clone)]
struct Walker {
    trunk: BodyKey,
    legs: Vec<Leg>,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    world.set_default_material(Material::with_friction(1.0))?;
    let trunk = add_box(&mut world, at(0.9, 0.26, 0.14), 400.0, at(0.0, 0.0, 0.36))?;
    let mut legs = Vec::new();
    for (i, x) in [-0.36, 0.0, 0.36].into_iter().enumerate() {
        for (j, side) in [-1.0, 1.0].into_iter().enumerate() {
            let root = at(x, side * 0.15, 0.36);
            let hub = add_ball(&mut world, 0.05, 900.0, root + at(0.0, side * 0.03, 0.0))?;
            let knee = root + at(0.0, side * 0.3, 0.05);
            let leg = BodyBuilder::new()
                .at(root)
                .with_shape_at(Capsule::new(0.035, 0.28)?, 600.0, between(root, root, knee))
                .with_shape_at(
                    Capsule::new(0.035, 0.34)?,
                    600.0,
                    between(root, knee, knee + at(0.0, side * 0.06, -0.375)),
                );
            let leg = world.add_body(leg)?;
            let hip = world.add_hinge(Some(hub), Some(trunk), root, Vec3::Z)?;
            let lift = world.add_hinge(Some(leg), Some(hub), root, Vec3::X)?;
            // Two tripods, half a period apart.
            let phase = if (i + j) % 2 == 0 { 0.0 } else { PI };
            legs.push(Leg { hip, lift, phase, side });
        }
    }
    // Its parts overlap where they are joined: they touch the ground, and not each other.
    let own: Vec<GeomKey> = world.geoms().filter(|geom| geom.body.is_some()).map(|geom| geom.key).collect();
    for geom in own {
        world.set_geom_bits(geom, 2, !2)?;
    }
    Stage::new(world, H, Walker { trunk, legs })
        .before(|walker, world| {
            let t = world.time();
            let ramp = t.min(1.0);
            for leg in &walker.legs {
                let (sin, cos) = sin_cos(TAU * t / PERIOD + leg.phase);
                // The foot goes ahead while it is lifted. About z, a leg to the left goes ahead with a negative angle.
                let swing = -leg.side * 0.35 * ramp * sin;
                let lift = leg.side * 0.3 * ramp * cos.max(0.0);
                for (joint, wanted) in [(leg.hip, swing), (leg.lift, lift)] {
                    let mut hinge = world.joint_mut::<Hinge>(joint)?;
                    let error = wanted - hinge.as_ref().angle();
                    hinge.set_motor((15.0 * error).clamp(-8.0, 8.0), 60.0)?;
                }
            }
            Ok(())
        })
        .check(|walker, world| {
            let trunk = body(world, walker.trunk)?;
            Ok(Findings::new()
                .at_least("walked (m)", trunk.position().x, 2.0)
                .at_most("aside (parts of its way)", trunk.position().y.abs() / trunk.position().x, 0.2)
                .at_least("upright", trunk.vector_to_world(Vec3::Z).z, 0.97))
        })
}

/// The pose of a capsule from one point to another, in a body's frame that stands unturned at `origin`.
fn between(origin: Vec3, from: Vec3, to: Vec3) -> Pose {
    Pose { position: (from + to) * 0.5 - origin, rotation: from_z_to(to - from) }
}
