//! All shapes fall into a tray together: spheres, boxes, capsules, cylinders, ellipsoids, cones and a convex hull.

use super::prelude::*;
use crate::solids;
use ferrode::{Cone, Ellipsoid, QuickSettings};

pub(super) const DEMO: Demo = Demo {
    name: "shapes",
    subject: Subject::Heaps,
    about: "sixty-three bodies of seven shapes fall into a tray",
    property: "all end in the tray, at rest, none sunk by more than 5 mm",
    seconds: 8.0,
    picture_at: 8.0,
    show: &[],
    camera: Camera::new([1.9, -2.7, 4.5], [0.0, -0.1, 0.2]),
    build,
};

const TRAY: f64 = 1.5;

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Quick)?;
    // Round shapes come to rest on account of rolling friction.
    world.set_default_material(Material {
        friction: 0.5,
        rolling: 0.01,
        spinning: 0.01,
        ..Material::default()
    })?;
    // Contacts that rest a little inside each other do not come and go.
    world.set_contact_surface_layer(1e-3)?;
    // With the usual 20 sweeps three heaps in forty, begun a nanometre apart, fell asleep with a body pressed in by more than 5 mm; with
    // these two in a hundred.
    let quick = *world.quick();
    world.set_quick(QuickSettings { iterations: 50, ..quick })?;
    let_sleep(&mut world)?;
    for side in [-1.0, 1.0] {
        add_wall(&mut world, at(0.1, 2.0 * TRAY, 1.2), Pose::from_position(at(side * TRAY, 0.0, 0.6)))?;
        add_wall(&mut world, at(2.0 * TRAY, 0.1, 1.2), Pose::from_position(at(0.0, side * TRAY, 0.6)))?;
    }
    let gem: Vec<Vec3> = solids::platonic()[3].iter().map(|p| *p * 0.22).collect();
    for i in 0..63_u32 {
        let shape: Shape = match i % 7 {
            0 => Sphere::new(0.18)?.into(),
            1 => Cuboid::new(at(0.4, 0.3, 0.22))?.into(),
            2 => Capsule::new(0.12, 0.25)?.into(),
            3 => Cylinder::new(0.16, 0.3)?.into(),
            4 => Ellipsoid::new(at(0.22, 0.16, 0.12))?.into(),
            5 => Cone::new(0.18, 0.34)?.into(),
            _ => hull(&gem)?.into(),
        };
        let (layer, place) = (i / 9, i % 9);
        let grid = at(f64::from(place % 3) - 1.0, f64::from(place / 3) - 1.0, 0.0) * 0.7;
        let shift = at(0.1, 0.06, 0.0) * f64::from(layer % 3);
        let builder = BodyBuilder::new()
            .at(grid + shift + at(0.0, 0.0, 0.5 + 0.6 * f64::from(layer)))
            .rotated(turn(at(1.0, 0.7, 0.3), 37.0 * f64::from(i)))
            .with_shape(shape, 700.0);
        world.add_body(builder)?;
    }
    Stage::new(world, 0.005, ()).check(|(), world| {
        let mut out = 0.0_f64;
        for (_, body) in world.bodies() {
            out = out.max(body.position().x.abs().max(body.position().y.abs()));
        }
        let (depth, contacts) = deepest(world)?;
        Ok(Findings::new()
            .at_most("farthest centre (m)", out, TRAY)
            .at_most("deepest contact (m)", depth, 5e-3)
            .at_least("contacts", contacts as f64, world.body_count() as f64)
            .at_most("fastest (m/s)", fastest(world), 0.05))
    })
}
