//! Balls, boxes and capsules roll over hills.

use super::prelude::*;
use ferrode::Heightfield;
use ferrode_math::real;

const SIDE: f64 = 12.0;
const SAMPLES: usize = 61;

pub(super) const DEMO: Demo = Demo {
    name: "heightfield",
    subject: Subject::Heaps,
    about: "balls, boxes and capsules tumble over hills",
    property: "everything is lower than it was, and nothing is under the ground",
    seconds: 5.0,
    picture_at: 2.0,
    show: &[],
    camera: Camera::new([7.5, -8.0, 9.5], [0.1, 0.1, -0.3]),
    build,
};

/// Height of the hills, m: they end in a rim, so that nothing leaves.
fn height(x: f64, y: f64) -> f64 {
    let hills = 0.5 * real::sin(1.3 * x) * real::cos(1.1 * y);
    let rim = (x.abs().max(y.abs()) - 0.4 * SIDE).max(0.0);
    hills + 2.0 * rim * rim
}

#[derive(Clone)]
struct Hills {
    bodies: Vec<(BodyKey, f64)>,
    /// Largest depth of a centre under the surface so far, m.
    under: f64,
}

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Quick)?;
    let step = SIDE / (SAMPLES - 1) as f64;
    let mut heights = Vec::new();
    for row in 0..SAMPLES {
        for column in 0..SAMPLES {
            // The field's z runs along the world's −y.
            heights.push(height(column as f64 * step - 0.5 * SIDE, 0.5 * SIDE - row as f64 * step));
        }
    }
    let field = Heightfield::new(SIDE, SIDE, SAMPLES, SAMPLES, heights, 1.0)?;
    world.add_static(field, Pose { position: Vec3::ZERO, rotation: Heightfield::z_up() })?;
    let mut bodies = Vec::new();
    for i in 0..7 {
        for j in 0..7 {
            let (x, y) = (f64::from(i - 3) * 1.1, f64::from(j - 3) * 1.1);
            let start = at(x, y, height(x, y) + 0.8);
            let shape: Shape = match (i + j) % 3 {
                0 => Sphere::new(0.22)?.into(),
                1 => Cuboid::new(at(0.35, 0.3, 0.25))?.into(),
                _ => Capsule::new(0.15, 0.3)?.into(),
            };
            bodies.push((world.add_body(BodyBuilder::new().at(start).with_shape(shape, 500.0))?, start.z));
        }
    }
    Stage::new(world, 0.005, Hills { bodies, under: 0.0 })
        .after(|hills, world| {
            for (key, _) in &hills.bodies {
                let p = place(world, *key)?;
                hills.under = hills.under.max(height(p.x, p.y) - p.z);
            }
            Ok(())
        })
        .check(|hills, world| {
            let mut rise = f64::NEG_INFINITY;
            for (key, start) in &hills.bodies {
                rise = rise.max(place(world, *key)?.z - start);
            }
            Ok(Findings::new().at_most("rose by (m)", rise, 0.0).at_most(
                "a centre was under the surface by (m)",
                hills.under,
                0.0,
            ))
        })
}
