//! Kinematic bodies: a lift, a carousel and a shuttle carry boxes. They push, and nothing pushes them.

use super::prelude::*;
use ferrode_math::real;

pub(super) const DEMO: Demo = Demo {
    name: "platforms",
    subject: Subject::Contacts,
    about: "a lift, a shuttle and a carousel carry boxes",
    property: "each box stays where it stands on its platform, to 2 mm",
    seconds: 8.0,
    picture_at: 2.2,
    show: &[],
    camera: Camera::new([2.8, -6.2, 3.4], [0.45, 0.0, 0.5]),
    build,
};

#[derive(Clone)]
struct Platforms {
    lift: BodyKey,
    shuttle: BodyKey,
    /// Each box, its platform, and its place on it.
    boxes: Vec<(BodyKey, BodyKey, Vec3)>,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    world.set_default_material(Material::with_friction(0.8))?;
    let mut platform = |shape: Shape, place: Vec3, spin: f64| -> Result<BodyKey, Failure> {
        let builder = BodyBuilder::new().at(place).with_spin(at(0.0, 0.0, spin)).with_shape(shape, 100.0);
        Ok(world.add_body(builder.kinematic())?)
    };
    let slab: Shape = Cuboid::new(at(1.2, 1.2, 0.1))?.into();
    let lift = platform(slab.clone(), at(-2.2, 0.0, 0.5), 0.0)?;
    let shuttle = platform(slab, at(0.0, 0.0, 0.5), 0.0)?;
    let carousel = platform(Cylinder::new(1.0, 0.1)?.into(), at(2.6, 0.0, 0.5), 0.8)?;
    let mut boxes = Vec::new();
    for (ground, offset) in
        [(lift, at(0.2, 0.1, 0.25)), (shuttle, at(0.1, -0.2, 0.25)), (carousel, at(0.5, 0.0, 0.25))]
    {
        let start = place(&world, ground)? + offset;
        let builder = BodyBuilder::new().at(start).with_shape(Cuboid::new(Vec3::splat(0.4))?, 300.0);
        let rider = world.add_body(builder)?;
        if ground == carousel {
            world.body_mut(rider)?.set_angular_velocity(at(0.0, 0.0, 0.8))?;
            world.body_mut(rider)?.set_linear_velocity(at(0.0, 0.4, 0.0))?;
        }
        boxes.push((rider, ground, offset));
    }
    Stage::new(world, 0.001, Platforms { lift, shuttle, boxes })
        .before(|p, world| {
            let swing = real::sin(1.5 * world.time());
            world.body_mut(p.lift)?.set_linear_velocity(at(0.0, 0.0, 0.5 * swing))?;
            world.body_mut(p.shuttle)?.set_linear_velocity(at(0.0, swing, 0.0))?;
            Ok(())
        })
        .check(|p, world| {
            let mut moved = 0.0_f64;
            for (rider, ground, offset) in &p.boxes {
                let pose = body(world, *ground)?.pose();
                moved = moved.max((pose.inverse_transform_point(place(world, *rider)?) - *offset).length());
            }
            Ok(Findings::new().at_most("a box moved on its platform by (m)", moved, 2e-3))
        })
}
