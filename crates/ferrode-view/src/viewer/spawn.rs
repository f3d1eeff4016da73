//! Bodies that the user adds while time runs.

use ferrode::prelude::*;
use ferrode_render::Camera;

/// What can be dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A cube.
    Cube,
    /// A ball.
    Ball,
    /// A capsule.
    Capsule,
    /// A cylinder.
    Cylinder,
}

/// Density of what is added, kg/m³.
const DENSITY: f64 = 400.0;

fn shape(kind: Kind, size: f64) -> Result<Shape, Error> {
    Ok(match kind {
        Kind::Cube => Cuboid::new(Vec3::splat(size))?.into(),
        Kind::Ball => Sphere::new(0.5 * size)?.into(),
        Kind::Capsule => Capsule::new(0.3 * size, 0.8 * size)?.into(),
        Kind::Cylinder => Cylinder::new(0.5 * size, 0.8 * size)?.into(),
    })
}

/// Drops a body of a size a little above a point.
///
/// # Errors
/// The engine refuses a number.
pub fn drop_body(world: &mut World, kind: Kind, size: f64, above: Vec3) -> Result<BodyKey, Error> {
    let at = above + Vec3::new(0.0, 0.0, 2.5 * size);
    // Tilted, the same way each time, so that it tumbles.
    let turn = Quat::from_axis_angle(Vec3::new(0.8, 0.6, 0.0), 0.4 + 0.3 * (world.body_count() % 5) as f64);
    let builder = BodyBuilder::new().at(at).rotated(turn);
    world.add_body(builder.with_shape(shape(kind, size)?, DENSITY))
}

/// Shoots a ball of a size from the eye along a direction.
///
/// # Errors
/// The engine refuses a number.
pub fn shoot(world: &mut World, size: f64, camera: &Camera, along: Vec3) -> Result<BodyKey, Error> {
    // The distance to the target in a third of a second, and heavy enough to be felt.
    let speed = (camera.distance() * 3.0).clamp(2.0, 60.0);
    let builder = BodyBuilder::new().at(camera.eye + along * (2.0 * size)).with_velocity(along * speed);
    world.add_body(builder.with_shape(Sphere::new(0.5 * size)?, 4.0 * DENSITY))
}
