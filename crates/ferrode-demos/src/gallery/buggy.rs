//! A car with three wheels on hinge-2 joints: sprung, driven and steered at the front, fixed in direction at the back.

use super::prelude::*;
use ferrode::Hinge2;

const STEP: f64 = 0.01;
const WHEEL: f64 = 0.18;

pub(super) const DEMO: Demo = Demo {
    name: "buggy",
    subject: Subject::Creatures,
    about: "a sprung three-wheeled car drives ahead, over a ramp, and turns",
    property: "it keeps its speed, turns to the left, and stays on its wheels",
    seconds: 7.0,
    picture_at: 2.4,
    show: &[],
    camera: Camera::new([1.3, -2.7, 1.4], [2.9, 0.1, 0.3]),
    build,
};

#[derive(Clone)]
struct Buggy {
    chassis: BodyKey,
    /// Front, back left, back right.
    joints: [JointKey; 3],
    /// Where it was before it turned.
    half: Vec3,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Quick)?;
    world.set_default_material(Material { friction: 2.0, ..Material::default() })?;
    let ramp = Pose { position: at(3.0, 0.0, 0.02), rotation: turn(Vec3::Y, -6.0) };
    add_wall(&mut world, at(1.2, 1.6, 0.08), ramp)?;
    let chassis = add_box(&mut world, at(0.7, 0.5, 0.2), 1000.0 / 7.0, at(0.0, 0.0, 0.45))?;
    let mut joints = Vec::new();
    for (x, y) in [(0.35, 0.0), (-0.3, 0.3), (-0.3, -0.3)] {
        let hub = at(x, y, WHEEL);
        let tyre = Material { friction: 1.2, slip1: 0.0005, slip2: 0.0005, ..Material::default() };
        let wheel = BodyBuilder::new()
            .at(hub)
            .with_mass(Mass::sphere_total(1.5, WHEEL)?)
            .with_shape(Sphere::new(WHEEL)?, 0.0)
            .with_material(tyre);
        let wheel = world.add_body(wheel)?;
        // Axis 1, vertical, steers and springs; axis 2, to the left, is the wheel's.
        let joint = world.add_hinge2(chassis, wheel, hub, Vec3::Z, Vec3::Y)?;
        world.joint_mut::<Hinge2>(joint)?.set_suspension(spring(2000.0, 150.0, STEP)?)?;
        joints.push(joint);
    }
    for joint in &joints[1..] {
        // Equal stops lock the direction of the wheels at the back.
        world.joint_mut::<Hinge2>(*joint)?.set_limits_of(1, 0.0, 0.0)?;
    }
    let buggy = Buggy { chassis, joints: [joints[0], joints[1], joints[2]], half: Vec3::ZERO };
    Stage::new(world, STEP, buggy)
        .before(|buggy, world| {
            let ahead = world.time() < 4.0;
            let mut front = world.joint_mut::<Hinge2>(buggy.joints[0])?;
            // A wheel that rolls forward, or is steered to the left, counts as negative about its axis.
            front.set_motor_of(2, -2.0 / WHEEL, 4.0)?;
            let error = if ahead { 0.0 } else { -0.3 } - front.as_ref().angle1();
            front.set_motor_of(1, (10.0 * error).clamp(-2.0, 2.0), 5.0)?;
            Ok(())
        })
        .after(|buggy, world| {
            if world.time() < 4.0 {
                buggy.half = place(world, buggy.chassis)?;
            }
            Ok(())
        })
        .check(|buggy, world| {
            let chassis = body(world, buggy.chassis)?;
            Ok(Findings::new()
                .at_least("went ahead (m)", buggy.half.x, 5.0)
                .at_most("aside by (m)", buggy.half.y.abs(), 0.2)
                .at_least("turned to the left (m)", chassis.position().y - buggy.half.y, 0.5)
                .at_least("upright", chassis.vector_to_world(Vec3::Z).z, 0.99)
                .at_most("joints open by (m)", joint_errors(world)?.0, 0.02))
        })
}
