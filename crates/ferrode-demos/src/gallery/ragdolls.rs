//! Ragdolls tumble down a stair: ten capsules and boxes each, on ball joints, hinges and universal joints with limits.

use super::prelude::*;
use ferrode::{Hinge, Universal};

pub(super) const DEMO: Demo = Demo {
    name: "ragdolls",
    subject: Subject::Creatures,
    about: "five ragdolls tumble down a stair",
    property: "their joints open by under 10 mm, knees and elbows bend only their way, and nobody falls through the stair",
    seconds: 5.0,
    picture_at: 0.9,
    show: &[],
    camera: Camera::new([3.8, -5.6, 3.3], [-0.1, 0.0, 0.8]),
    build,
};

#[derive(Clone)]
struct Crowd {
    bends: Vec<JointKey>,
    apart: f64,
    wrong_way: f64,
}

/// A ragdoll that stands with its feet at `feet`, arms to the sides. Adds its knees and elbows to `bends`.
fn ragdoll(world: &mut World, feet: Vec3, bends: &mut Vec<JointKey>) -> Result<(), Failure> {
    let p = |x: f64, y: f64, z: f64| feet + at(x, y, z);
    let density = 900.0;
    let pelvis = add_box(world, at(0.18, 0.32, 0.18), density, p(0.0, 0.0, 0.95))?;
    let chest = add_box(world, at(0.2, 0.36, 0.38), density, p(0.0, 0.0, 1.28))?;
    let head = add_ball(world, 0.12, density, p(0.0, 0.0, 1.66))?;
    limited(world, chest, pelvis, p(0.0, 0.0, 1.06), [Vec3::X, Vec3::Y], 0.4)?;
    limited(world, head, chest, p(0.0, 0.0, 1.52), [Vec3::X, Vec3::Y], 0.6)?;
    for side in [-1.0, 1.0] {
        let hip = p(0.0, side * 0.1, 0.84);
        let (knee, foot) = (p(0.0, side * 0.1, 0.46), p(0.0, side * 0.1, 0.07));
        let thigh = add_capsule(world, 0.07, density, [hip, knee])?;
        let shin = add_capsule(world, 0.055, density, [knee, foot])?;
        limited(world, thigh, pelvis, hip, [Vec3::X, Vec3::Y], 0.7)?;
        bends.push(bend(world, shin, thigh, knee, Vec3::Y)?);
        let shoulder = p(0.0, side * 0.22, 1.42);
        let (elbow, hand) = (p(0.0, side * 0.5, 1.42), p(0.0, side * 0.78, 1.42));
        let upper = add_capsule(world, 0.05, density, [shoulder, elbow])?;
        let lower = add_capsule(world, 0.04, density, [elbow, hand])?;
        limited(world, upper, chest, shoulder, [Vec3::X, Vec3::Z], 1.2)?;
        bends.push(bend(world, lower, upper, elbow, Vec3::Z * side)?);
    }
    Ok(())
}

/// A universal joint that turns by at most `most` radians about each axis.
fn limited(
    world: &mut World,
    a: BodyKey,
    b: BodyKey,
    anchor: Vec3,
    axes: [Vec3; 2],
    most: f64,
) -> Result<(), Failure> {
    let joint = world.add_universal(Some(a), Some(b), anchor, axes[0], axes[1])?;
    let mut universal = world.joint_mut::<Universal>(joint)?;
    universal.set_limits_of(1, -most, most)?;
    universal.set_limits_of(2, -most, most)?;
    Ok(())
}

/// A hinge that bends to one side only.
fn bend(world: &mut World, a: BodyKey, b: BodyKey, anchor: Vec3, axis: Vec3) -> Result<JointKey, Failure> {
    let joint = world.add_hinge(Some(a), Some(b), anchor, axis)?;
    world.joint_mut::<Hinge>(joint)?.set_limits(0.0, 2.2)?;
    Ok(joint)
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    world.set_default_material(Material::with_friction(0.6))?;
    world.set_contact_max_correcting_velocity(2.0)?;
    for i in 0..6 {
        let height = 0.3 * f64::from(6 - i);
        let middle = at(-2.0 + 0.6 * f64::from(i), 0.0, 0.5 * height);
        add_wall(&mut world, at(0.6, 5.0, height), Pose::from_position(middle))?;
    }
    let mut bends = Vec::new();
    for i in 0..5 {
        ragdoll(&mut world, at(-1.9, 0.9 * f64::from(i) - 1.8, 1.85), &mut bends)?;
    }
    let keys: Vec<BodyKey> = world.bodies().map(|(key, _)| key).collect();
    for key in keys {
        world.body_mut(key)?.set_linear_velocity(at(1.8, 0.0, 0.0))?;
    }
    Stage::new(world, 0.005, Crowd { bends, apart: 0.0, wrong_way: 0.0 })
        .after(|crowd, world| {
            crowd.apart = crowd.apart.max(joint_errors(world)?.0);
            for joint in &crowd.bends {
                crowd.wrong_way = crowd.wrong_way.max(-world.joint::<Hinge>(*joint)?.angle());
            }
            Ok(())
        })
        .check(|crowd, world| {
            Ok(Findings::new()
                .at_most("joints open by (m)", crowd.apart, 0.01)
                .at_most("bent the wrong way by (rad)", crowd.wrong_way, 0.15)
                .at_least("lowest centre (m)", lowest(world), 0.03))
        })
}
