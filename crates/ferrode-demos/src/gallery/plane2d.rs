//! A two-dimensional world: discs and boxes in a plane, each held there by a plane-2D joint.

use super::prelude::*;
use ferrode::Plane2D;

pub(super) const DEMO: Demo = Demo {
    name: "plane2d",
    subject: Subject::Joints,
    about: "a game of billiards in the plane, seen from above",
    property: "nothing leaves the plane by more than a nanometre, nor the table by more than 2 cm",
    seconds: 6.0,
    picture_at: 0.9,
    show: &[],
    camera: Camera::new([0.0, -2.9, 4.6], [0.0, -0.15, 0.0]),
    build,
};

fn build() -> Result<Play, Failure> {
    let mut world = World::new(); // no gravity: the plane is the floor
    world.stepper = Stepper::Quick;
    let felt = Material::with_friction(0.2).with_restitution(0.85);
    world.set_default_material(felt)?;
    damp(&mut world, 0.004, 0.004)?;
    for side in [-1.0, 1.0] {
        add_wall(&mut world, at(5.0, 0.2, 0.4), Pose::from_position(at(0.0, side * 1.4, 0.0)))?;
        add_wall(&mut world, at(0.2, 3.0, 0.4), Pose::from_position(at(side * 2.5, 0.0, 0.0)))?;
    }
    let mut add = |place: Vec3, velocity: Vec3| -> Result<BodyKey, Failure> {
        let shape = Cylinder::new(0.12, 0.1)?;
        let key =
            world.add_body(BodyBuilder::new().at(place).with_velocity(velocity).with_shape(shape, 800.0))?;
        let joint = world.create_joint::<Plane2D>(None)?;
        world.attach(joint, Some(key), None)?;
        Ok(key)
    };
    let mut discs = vec![add(at(-1.8, 0.03, 0.0), at(6.0, 0.0, 0.0))?];
    for row in 0..5 {
        for i in 0..=row {
            let y = (f64::from(i) - 0.5 * f64::from(row)) * 0.25;
            discs.push(add(at(0.4 + 0.22 * f64::from(row), y, 0.0), Vec3::ZERO)?);
        }
    }
    Stage::new(world, 0.005, discs)
        .draw(|_, _, drawing| {
            drawing.floor = Some(-0.8);
            drawing.block(at(5.0, 3.0, 0.1), at(0.0, 0.0, -0.11), Tint::FELT);
            for (x, y) in [(-2.2, -1.2), (2.2, -1.2), (2.2, 1.2), (-2.2, 1.2)] {
                drawing.block(at(0.2, 0.2, 0.65), at(x, y, -0.48), Tint::FRAME);
            }
        })
        .check(|discs, world| {
            let (mut out, mut wide, mut moved) = (0.0_f64, f64::NEG_INFINITY, 0);
            for (i, key) in discs.iter().enumerate() {
                let p = place(world, *key)?;
                out = out.max(p.z.abs());
                wide = wide.max((p.x.abs() - 2.4).max(p.y.abs() - 1.3));
                moved += i32::from(i > 0 && (p.x - 0.4).abs() > 0.3);
            }
            Ok(Findings::new()
                .at_most("out of the plane by (m)", out, 1e-9)
                .at_most("past the cushion by (m)", wide + 0.12, 0.02)
                .at_least("discs scattered", f64::from(moved), 8.0))
        })
}
