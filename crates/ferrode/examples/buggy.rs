//! A car with three wheels on hinge-2 joints: sprung, driven and steered at the front, fixed in direction at the back.
//! It drives straight, then turns to the left.

use ferrode::prelude::*;
use ferrode::{Hinge2, Softness};

const STEP: f64 = 0.01;
const WHEEL_RADIUS: f64 = 0.18;

struct Buggy {
    chassis: BodyKey,
    /// Front, back left, back right.
    joints: [JointKey; 3],
}

impl Buggy {
    fn build(world: &mut World) -> Result<Self, Error> {
        let height = 0.45;
        let chassis = BodyBuilder::new()
            .at(Vec3::new(0.0, 0.0, height))
            .with_shape(Cuboid::new(Vec3::new(0.7, 0.5, 0.2))?, 1000.0 / 7.0);
        let chassis = world.add_body(chassis)?;

        let suspension = Softness::from_spring(2000.0, 150.0, STEP)?;
        let mut add_wheel = |x: f64, y: f64| -> Result<JointKey, Error> {
            let hub = Vec3::new(x, y, WHEEL_RADIUS);
            let tyre = Material { friction: 1.2, slip1: 0.0005, slip2: 0.0005, ..Material::default() };
            let wheel = BodyBuilder::new()
                .at(hub)
                .with_mass(Mass::sphere_total(1.5, WHEEL_RADIUS)?)
                .with_shape(Sphere::new(WHEEL_RADIUS)?, 0.0)
                .with_material(tyre);
            let wheel = world.add_body(wheel)?;
            // Axis 1, vertical, steers and springs; axis 2, to the left, is the wheel's.
            let joint = world.add_hinge2(chassis, wheel, hub, Vec3::Z, Vec3::Y)?;
            world.joint_mut::<Hinge2>(joint)?.set_suspension(suspension)?;
            Ok(joint)
        };
        let joints = [add_wheel(0.35, 0.0)?, add_wheel(-0.3, 0.3)?, add_wheel(-0.3, -0.3)?];
        for joint in &joints[1..] {
            // Equal stops lock the direction of the wheels at the back.
            world.joint_mut::<Hinge2>(*joint)?.set_limits_of(1, 0.0, 0.0)?;
        }
        Ok(Self { chassis, joints })
    }

    /// Drives at a speed in m/s and steers to an angle in radians, positive to the left. To be called before each step.
    fn control(&self, world: &mut World, speed: f64, steer: f64) -> Result<(), Error> {
        let mut front = world.joint_mut::<Hinge2>(self.joints[0])?;
        // The motor's velocity is that of the chassis relative to the wheel: a wheel that rolls forward counts as
        // negative about the axis that points to the left. So does a wheel that is steered to the left about axis 1.
        front.set_motor_of(2, -speed / WHEEL_RADIUS, 3.0)?;
        let error = -steer - front.as_ref().angle1();
        front.set_motor_of(1, (10.0 * error).clamp(-2.0, 2.0), 5.0)?;
        Ok(())
    }
}

fn main() -> Result<(), Error> {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    world.set_default_material(Material { friction: 2.0, ..Material::default() })?;
    let buggy = Buggy::build(&mut world)?;

    for _ in 0..300 {
        buggy.control(&mut world, 2.0, 0.0)?;
        world.step(STEP)?;
    }
    let (half, velocity) =
        (world.body(buggy.chassis)?.position(), world.body(buggy.chassis)?.linear_velocity());
    println!("After 3 s at ({:.2}, {:.2}), {:.2} m/s.", half.x, half.y, velocity.length());
    assert!(half.x > 3.5 && half.x < 6.0 && half.y.abs() < 0.05, "it drove straight ahead: {half:?}");
    assert!((velocity.x - 2.0).abs() < 0.1, "at the speed asked for: {velocity:?}");

    for _ in 0..300 {
        buggy.control(&mut world, 2.0, 0.3)?;
        world.step(STEP)?;
    }
    let body = world.body(buggy.chassis)?;
    let (end, up, ahead) = (body.position(), body.vector_to_world(Vec3::Z), body.vector_to_world(Vec3::X));
    println!("After 6 s at ({:.2}, {:.2}), heading ({:.2}, {:.2}).", end.x, end.y, ahead.x, ahead.y);
    assert!(up.z > 0.99, "it stands on its wheels: {up:?}");
    assert!(end.y - half.y > 0.5, "it turned to the left");
    assert!(end.z > 0.35 && end.z < 0.5, "its springs carry it: {end:?}");
    for joint in buggy.joints {
        let error = world.joint_error(joint)?;
        assert!(error.position < 0.02 && error.angle < 0.02, "{error:?}");
    }
    Ok(())
}
