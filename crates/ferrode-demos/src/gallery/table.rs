//! A table on four legs, loaded off its middle: how much does each leg carry? Statics alone can't tell; the
//! exact stepper gives the forces of least norm, which rise linearly toward the load.

use super::prelude::*;

const SIDES: [f64; 2] = [2.0, 1.2];

pub(super) const DEMO: Demo = Demo {
    name: "table",
    subject: Subject::Contacts,
    about: "a table on four legs, with a load near one corner",
    property: "the legs' forces balance weight and moments to 0.01 %, and are those of least norm to 1 %",
    seconds: 2.0,
    picture_at: 2.0,
    show: &["forces"],
    camera: Camera::new([2.0, -2.6, 1.8], [0.05, 0.0, 0.45]),
    build,
};

#[derive(Clone)]
struct Table {
    table: BodyKey,
    load: BodyKey,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let mut builder = BodyBuilder::new()
        .at(at(0.0, 0.0, 0.75))
        .with_shape(Cuboid::new(at(SIDES[0], SIDES[1], 0.05))?, 600.0);
    for x in [-0.5, 0.5] {
        for y in [-0.5, 0.5] {
            let foot = at(x * SIDES[0] * 0.9, y * SIDES[1] * 0.9, -0.39);
            builder = builder.with_shape_at(
                Capsule::new(0.03, 0.66)?,
                600.0,
                Pose::from_position(foot + at(0.0, 0.0, 0.0)),
            );
        }
    }
    let table = world.add_body(builder)?;
    let load = add_box(&mut world, Vec3::splat(0.3), 800.0, at(0.55, 0.3, 0.94))?;
    Stage::new(world, 0.005, Table { table, load }).check(|s, world| {
        // Each foot is a ball: one contact with the ground.
        let mut feet = Vec::new();
        for contact in world.contacts() {
            let bodies = [contact.first.body, contact.second.body];
            if bodies.contains(&None) && bodies.contains(&Some(s.table)) {
                feet.push((contact.point.position, contact.force.z.abs()));
            }
        }
        if feet.len() != 4 {
            return Ok(Findings::new().is("four feet touch the ground", false));
        }
        let weights =
            [s.table, s.load].map(|key| body(world, key).map(|body| (body.position(), body.mass().mass * G)));
        let (mut force, mut moment) = (0.0, Vec3::ZERO);
        for weight in weights {
            let (p, w) = weight?;
            force += w;
            moment += p * w;
        }
        let carried: f64 = feet.iter().map(|foot| foot.1).sum();
        let moments = feet.iter().fold(Vec3::ZERO, |sum, foot| sum + foot.0 * foot.1) - moment;
        // Least norm: forces are a + b x + c y. On a rectangle that says: the two diagonals carry alike.
        let diagonal = |sign: f64| -> f64 {
            feet.iter().filter(|foot| foot.0.x * foot.0.y * sign > 0.0).map(|foot| foot.1).sum()
        };
        Ok(Findings::new()
            .near("carried (N)", carried, force, 1e-4)
            .at_most(
                "moments out of balance (parts of weight × width)",
                (moments.x.abs() + moments.y.abs()) / (force * SIDES[0]),
                1e-4,
            )
            .near("a diagonal carries (N)", diagonal(1.0), diagonal(-1.0), 0.01))
    })
}
