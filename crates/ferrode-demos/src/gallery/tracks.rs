//! A tracked vehicle: its two tracks are surfaces that move.

use super::prelude::*;
use crate::kit::hull as hull_of;

const H: f64 = 0.005;
const GAUGE: f64 = 1.0;

pub(super) const DEMO: Demo = Demo {
    name: "tracks",
    subject: Subject::Creatures,
    about: "a tracked vehicle drives ahead, over a step, and turns on the spot",
    property: "it runs at its tracks' speed within 2 %, and turns when they run opposite",
    seconds: 7.0,
    picture_at: 3.2,
    show: &[],
    camera: Camera::new([1.7, -4.7, 2.7], [3.3, 0.0, 0.15]),
    build,
};

#[derive(Clone)]
struct Tank {
    hull: BodyKey,
    /// Left, right.
    tracks: [GeomKey; 2],
    speed: f64,
    heading: f64,
}

/// The surface of a track that drives its vehicle ahead at a speed: it runs backward below.
fn track(speed: f64) -> Material {
    Material {
        friction: 1.0,
        // To the side tracks slip more easily, or it could not turn.
        friction2: Some(0.4),
        friction_direction: Some(Vec3::X),
        motion: [-speed, 0.0],
        ..Material::default()
    }
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    world.set_default_material(Material::with_friction(1.0))?;
    add_wall(&mut world, at(2.0, 4.0, 0.12), Pose::from_position(at(4.0, 0.0, 0.06)))?;
    let builder = BodyBuilder::new()
        .at(at(0.0, 0.0, 0.31))
        .with_shape_at(Cuboid::new(at(1.2, 0.6, 0.35))?, 300.0, Pose::from_position(at(0.0, 0.0, 0.3)))
        .with_shape_at(Cuboid::new(at(1.3, 0.9, 0.2))?, 600.0, Pose::IDENTITY);
    let hull = world.add_body(builder)?;
    let centre = body(&world, hull)?.position() - at(0.0, 0.0, 0.31);
    let mut tracks = [Vec::new(), Vec::new()];
    for (side, track) in [0.5, -0.5].into_iter().zip(&mut tracks) {
        // A hull of points: flat below, with rising ends to climb.
        let (half, mut points) = (0.12, Vec::new());
        for y in [side * GAUGE - half, side * GAUGE + half] {
            for (x, z) in [(-0.7, -0.3), (0.7, -0.3), (1.0, 0.05), (-1.0, 0.05), (0.95, 0.2), (-0.95, 0.2)] {
                points.push(at(x, y, z) - centre);
            }
        }
        track.push(world.add_geom(hull, hull_of(&points)?, Pose::IDENTITY)?);
    }
    let [left, right] = tracks;
    let tank = Tank { hull, tracks: [left[0], right[0]], speed: 0.0, heading: 0.0 };
    Stage::new(world, H, tank)
        .before(|tank, world| {
            // Left, right.
            let speeds = match world.time() {
                t if t < 0.5 => [0.0, 0.0],
                t if t < 4.5 => [1.5, 1.5],
                _ => [-0.6, 0.6],
            };
            for (geom, speed) in tank.tracks.into_iter().zip(speeds) {
                world.set_material(geom, track(speed))?;
            }
            Ok(())
        })
        .after(|tank, world| {
            let hull = world.body(tank.hull)?;
            if world.time() < 1.5 {
                tank.speed = hull.linear_velocity().x;
            }
            let ahead = hull.vector_to_world(Vec3::X);
            tank.heading = ferrode_math::real::atan2(ahead.y, ahead.x);
            Ok(())
        })
        .check(|tank, world| {
            let hull = body(world, tank.hull)?;
            Ok(Findings::new()
                .near("ahead (m/s)", tank.speed, 1.5, 0.02)
                .at_least("went to (m)", hull.position().x, 5.0)
                .at_least("turned to the left by (rad)", tank.heading, 0.7)
                .at_least("upright", hull.vector_to_world(Vec3::Z).z, 0.98))
        })
}
