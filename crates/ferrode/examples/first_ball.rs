//! A ball falls on the ground.

use ferrode::prelude::*;

fn main() -> Result<(), Error> {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    let ball = BodyBuilder::new().at(Vec3::new(0.0, 0.0, 3.0)).with_shape(Sphere::new(0.5)?, 1000.0);
    let ball = world.add_body(ball)?;
    for _ in 0..200 {
        world.step(0.01)?;
    }
    println!("The ball rests at {:.3} m.", world.body(ball)?.position().z);
    assert!((world.body(ball)?.position().z - 0.5).abs() < 1e-3);
    Ok(())
}
