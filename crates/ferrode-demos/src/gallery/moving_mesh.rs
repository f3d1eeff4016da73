//! Triangle meshes that move: rings, which no convex shape could stand for, thrown over a peg and onto each other.

use super::prelude::*;
use crate::solids;

pub(super) const DEMO: Demo = Demo {
    name: "moving-mesh",
    subject: Subject::Heaps,
    about: "rings of triangles are thrown over a peg",
    property: "the peg stands in the hole of each ring, and the rings lie still",
    seconds: 5.0,
    picture_at: 0.25,
    show: &[],
    camera: Camera::new([3.4, -4.2, 2.9], [0.0, 0.0, 1.15]),
    build,
};

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Quick)?;
    // Contacts that rest a little inside each other do not come and go.
    world.set_contact_surface_layer(1e-3)?;
    let_sleep(&mut world)?;
    world.add_static(Cylinder::new(0.12, 2.4)?, Pose::from_position(at(0.0, 0.0, 1.2)))?;
    let ring = solids::torus(0.45, 0.12, 24, 12);
    let ring = ferrode::TriMesh::new(ring.0, ring.1)?;
    let mut rings = Vec::new();
    for i in 0..4 {
        let place = at(0.05, 0.0, 0.7 + 0.45 * f64::from(i));
        let builder = BodyBuilder::new()
            .at(place)
            .rotated(turn(at(1.0, 0.3, 0.0), 8.0 * f64::from(i)))
            .with_shape(ring.clone(), 600.0);
        rings.push(world.add_body(builder)?);
    }
    Stage::new(world, 0.005, rings).check(|rings, world| {
        let mut aside = 0.0_f64;
        for ring in rings {
            let p = place(world, *ring)?;
            aside = aside.max((p.x * p.x + p.y * p.y).sqrt());
        }
        let (depth, contacts) = deepest(world)?;
        Ok(Findings::new()
            .at_most("a ring's middle from the peg (m)", aside, 0.33)
            .at_most("fastest (m/s)", fastest(world), 0.05)
            .at_least("lowest ring (m)", lowest(world), 0.1)
            .at_most("deepest contact (m)", depth, 0.01)
            .at_least("contacts", contacts as f64, world.body_count() as f64))
    })
}
