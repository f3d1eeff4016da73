//! Convex polyhedra: the five regular solids fall into a heap.

use super::prelude::*;
use crate::solids;

pub(super) const DEMO: Demo = Demo {
    name: "convex",
    subject: Subject::Heaps,
    about: "Plato's solids fall into a heap",
    property: "all lie on the ground at rest, none sunk by more than 5 mm",
    seconds: 6.0,
    picture_at: 6.0,
    show: &[],
    camera: Camera::new([3.2, -4.2, 2.5], [0.35, -0.15, 0.1]),
    build,
};

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Quick)?;
    // Contacts that rest a little inside each other do not come and go.
    world.set_contact_surface_layer(1e-3)?;
    let_sleep(&mut world)?;
    for layer in 0..4 {
        for (i, points) in solids::platonic().iter().enumerate() {
            let angle = i as f64 * 72.0 + layer as f64 * 36.0;
            let out = turn(Vec3::Z, angle).rotate(at(0.75, 0.0, 0.0));
            let shape = hull(&points.iter().map(|p| *p * 0.35).collect::<Vec<_>>())?;
            let tilt = turn(at(1.0, 0.5, 0.2), 40.0 * layer as f64 + 20.0 * i as f64);
            let builder = BodyBuilder::new()
                .at(out + at(0.0, 0.0, 0.8 + 0.9 * layer as f64))
                .rotated(tilt)
                .with_shape(shape, 800.0);
            world.add_body(builder)?;
        }
    }
    Stage::new(world, 0.005, ()).check(|(), world| {
        let (depth, contacts) = deepest(world)?;
        Ok(Findings::new()
            .at_most("deepest contact (m)", depth, 5e-3)
            .at_least("contacts", contacts as f64, world.body_count() as f64)
            .at_most("fastest (m/s)", fastest(world), 0.05)
            .at_least("lowest centre (m)", lowest(world), 0.1))
    })
}
