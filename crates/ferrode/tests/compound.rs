//! A body whose shape is a compound: its mass, and that it comes to rest.

use ferrode::prelude::*;
use ferrode::{Compound, mass_of};

/// A table: a board on four legs.
fn table() -> Result<Compound, Error> {
    let leg: Shape = Cylinder::new(0.05, 0.6)?.into();
    let board: Shape = Cuboid::new(Vec3::new(1.0, 0.6, 0.05))?.into();
    let legs = [(0.4, 0.2), (0.4, -0.2), (-0.4, 0.2), (-0.4, -0.2)];
    let parts = legs.map(|(x, y)| (leg.clone(), Pose::from_position(Vec3::new(x, y, 0.3))));
    let top = (board, Pose::from_position(Vec3::new(0.0, 0.0, 0.625)));
    Ok(Compound::new(parts.into_iter().chain([top]))?)
}

#[test]
fn mass_is_the_sum_of_the_parts() -> Result<(), Error> {
    let mass = mass_of(&table()?.into(), 500.0)?;
    let (leg, board) = (core::f64::consts::PI * 0.05 * 0.05 * 0.6 * 500.0, 0.6 * 0.05 * 500.0);
    assert!((mass.mass - 4.0 * leg - board).abs() < 1e-9);
    assert!((mass.centre.z - (4.0 * leg * 0.3 + board * 0.625) / mass.mass).abs() < 1e-12);
    assert!(mass.centre.x.abs() < 1e-12 && mass.centre.y.abs() < 1e-12);
    Ok(())
}

#[test]
fn a_table_stands() -> Result<(), Error> {
    for stepper in [Stepper::Direct, Stepper::Quick] {
        let mut world = World::new();
        world.stepper = stepper;
        world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
        let body = world.add_body(BodyBuilder::new().with_shape(table()?, 500.0).at(Vec3::Z * 0.001))?;
        let before = world.body(body)?.position();
        for _ in 0..500 {
            world.step(0.01)?;
        }
        let b = world.body(body)?;
        let speed = b.linear_velocity().length() + b.angular_velocity().length();
        assert!(speed < 1e-3, "{stepper:?}: {speed}");
        assert!((before - b.position()).length() < 5e-3, "{stepper:?}: {before:?} {:?}", b.position());
    }
    Ok(())
}
