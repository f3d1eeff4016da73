//! What many scenes begin with, and measure.

use crate::Failure;
use ferrode::prelude::*;
use ferrode::{Body, Convex, Softness};

/// Gravity on Earth, m/s².
pub(crate) const G: f64 = 9.81;

/// A world with gravity.
pub(crate) fn air(stepper: Stepper) -> Result<World, Failure> {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -G))?;
    world.stepper = stepper;
    Ok(world)
}

/// A world with gravity and the ground z = 0, which is as rough as whatever touches it: of two frictions the smaller counts.
pub(crate) fn ground(stepper: Stepper) -> Result<World, Failure> {
    let mut world = air(stepper)?;
    let ground = world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    world.set_material(ground, Material::with_friction(f64::INFINITY))?;
    Ok(world)
}

/// A place.
pub(crate) const fn at(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// A rotation about an axis by an angle in degrees.
pub(crate) fn turn(axis: Vec3, degrees: f64) -> Quat {
    Quat::from_axis_angle(axis, degrees.to_radians())
}

/// Adds a box of the given sides and density (kg/m³).
pub(crate) fn add_box(world: &mut World, sides: Vec3, density: f64, place: Vec3) -> Result<BodyKey, Failure> {
    Ok(world.add_body(BodyBuilder::new().at(place).with_shape(Cuboid::new(sides)?, density))?)
}

/// Adds a ball.
pub(crate) fn add_ball(
    world: &mut World,
    radius: f64,
    density: f64,
    place: Vec3,
) -> Result<BodyKey, Failure> {
    Ok(world.add_body(BodyBuilder::new().at(place).with_shape(Sphere::new(radius)?, density))?)
}

/// Adds a capsule from one point to another.
pub(crate) fn add_capsule(
    world: &mut World,
    radius: f64,
    density: f64,
    ends: [Vec3; 2],
) -> Result<BodyKey, Failure> {
    let along = ends[1] - ends[0];
    let builder = BodyBuilder::new()
        .at((ends[0] + ends[1]) * 0.5)
        .rotated(from_z_to(along))
        .with_shape(Capsule::new(radius, along.length())?, density);
    Ok(world.add_body(builder)?)
}

/// A fixed box.
pub(crate) fn add_wall(world: &mut World, sides: Vec3, pose: Pose) -> Result<GeomKey, Failure> {
    Ok(world.add_static(Cuboid::new(sides)?, pose)?)
}

/// The shortest rotation that takes z to a direction.
pub(crate) fn from_z_to(direction: Vec3) -> Quat {
    let d = direction.normalized_or(Vec3::Z);
    let axis = Vec3::Z.cross(d);
    match axis.normalized() {
        Some(unit) => Quat::from_axis_angle(unit, ferrode_math::real::atan2(axis.length(), d.z)),
        None if d.z < 0.0 => Quat::from_axis_angle(Vec3::X, core::f64::consts::PI),
        None => Quat::IDENTITY,
    }
}

/// A convex body of points.
pub(crate) fn hull(points: &[Vec3]) -> Result<Convex, Failure> {
    Ok(Convex::from_points(points)?)
}

/// The body that a key names; a scene holds keys of its own world only.
pub(crate) fn body(world: &World, key: BodyKey) -> Result<&Body, Failure> {
    Ok(world.body(key)?)
}

/// Where a body is.
pub(crate) fn place(world: &World, key: BodyKey) -> Result<Vec3, Failure> {
    Ok(world.body(key)?.position())
}

/// Largest position error of all joints, m, and largest angle error, rad.
pub(crate) fn joint_errors(world: &World) -> Result<(f64, f64), Failure> {
    let mut worst = (0.0_f64, 0.0_f64);
    for joint in world.joints() {
        let error = world.joint_error(joint)?;
        worst = (worst.0.max(error.position), worst.1.max(error.angle));
    }
    Ok(worst)
}

/// Speed of the fastest dynamic body, m/s.
pub(crate) fn fastest(world: &World) -> f64 {
    let dynamic = world.bodies().filter(|(_, body)| !body.is_kinematic());
    dynamic.map(|(_, body)| body.linear_velocity().length()).fold(0.0, f64::max)
}

/// Height of the lowest dynamic body's centre, m.
pub(crate) fn lowest(world: &World) -> f64 {
    let dynamic = world.bodies().filter(|(_, body)| !body.is_kinematic());
    dynamic.map(|(_, body)| body.position().z).fold(f64::INFINITY, f64::min)
}

/// Depth of the deepest contact where bodies are now, m, and the number of contacts. Sleeping bodies have none, so all are woken
/// in a copy of the world; its step finds contacts before it moves anything.
pub(crate) fn deepest(world: &World) -> Result<(f64, usize), Failure> {
    let mut copy = world.clone();
    let bodies: Vec<BodyKey> = copy.bodies().map(|(key, _)| key).collect();
    for key in bodies {
        copy.body_mut(key)?.enable();
    }
    copy.step(1e-3)?;
    let contacts = copy.contacts();
    Ok((contacts.iter().map(|contact| contact.point.depth).fold(0.0, f64::max), contacts.len()))
}

/// Lets bodies that stay still sleep.
pub(crate) fn let_sleep(world: &mut World) -> Result<(), Failure> {
    let settings = ferrode::AutoDisable {
        enabled: true,
        linear_threshold: 0.05,
        angular_threshold: 0.1,
        time: 0.3,
        average_samples: 5,
        ..ferrode::AutoDisable::default()
    };
    Ok(world.set_auto_disable(settings)?)
}

/// Damping for scenes that show a position of rest: per step, without threshold.
pub(crate) fn damp(world: &mut World, linear: f64, angular: f64) -> Result<(), Failure> {
    let damping = ferrode::Damping {
        linear_scale: linear,
        angular_scale: angular,
        linear_threshold: 0.0,
        angular_threshold: 0.0,
    };
    Ok(world.set_damping(damping)?)
}

/// The softness of a spring (N/m) and a damper (N s/m) at a step size.
pub(crate) fn spring(stiffness: f64, damping: f64, h: f64) -> Result<Softness, Failure> {
    Ok(Softness::from_spring(stiffness, damping, h)?)
}

/// Sine and cosine of an angle.
pub(crate) fn sin_cos(angle: f64) -> (f64, f64) {
    (ferrode_math::real::sin(angle), ferrode_math::real::cos(angle))
}

#[cfg(test)]
mod tests {
    use super::{add_ball, at, deepest, ground};
    use ferrode::Stepper;

    #[test]
    fn a_ball_that_sleeps_in_the_ground_is_found_there() {
        let mut world = ground(Stepper::Quick).unwrap();
        let ball = add_ball(&mut world, 0.2, 500.0, at(0.0, 0.0, 0.18)).unwrap();
        world.body_mut(ball).unwrap().disable();
        world.step(0.01).unwrap();
        assert!(world.contacts().is_empty());
        let (depth, contacts) = deepest(&world).unwrap();
        assert!((depth - 0.02).abs() < 1e-12 && contacts == 1, "{depth} m, {contacts}");
    }
}
