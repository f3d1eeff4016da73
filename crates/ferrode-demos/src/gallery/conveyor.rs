//! Conveyor belts: fixed boxes whose surfaces move hand parcels around a square.

use super::prelude::*;

const SPEED: f64 = 0.8;

pub(super) const DEMO: Demo = Demo {
    name: "conveyor",
    subject: Subject::Contacts,
    about: "parcels ride around on four conveyor belts",
    property: "a parcel on a belt moves at the belt's speed, within 1 %; none falls off, and the first goes around by 4 rad",
    seconds: 10.0,
    picture_at: 5.0,
    show: &[],
    camera: Camera::new([3.5, -4.9, 4.0], [0.0, 0.0, 0.15]),
    build,
};

#[derive(Clone)]
struct Parcels {
    parcels: Vec<BodyKey>,
    speed: f64,
    /// How far the first parcel has gone around the middle, rad.
    around: f64,
    last: Vec3,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    // Four belts, each from one corner of a square to the next.
    for side in 0..4 {
        let rotation = turn(Vec3::Z, 90.0 * f64::from(side));
        let pose = Pose { position: rotation.rotate(at(-0.5, -1.5, 0.25)), rotation };
        let belt = add_wall(&mut world, at(3.0, 1.0, 0.5), pose)?;
        let rubber = Material {
            friction: 0.8,
            friction_direction: Some(Vec3::X),
            motion: [SPEED, 0.0],
            ..Material::default()
        };
        world.set_material(belt, rubber)?;
    }
    world.set_default_material(Material::with_friction(0.8))?;
    let mut parcels = Vec::new();
    for i in 0..5 {
        let x = -1.6 + 0.65 * f64::from(i);
        parcels.push(add_box(&mut world, at(0.35, 0.3, 0.25), 200.0, at(x, -1.5, 0.64))?);
    }
    Stage::new(world, 0.005, Parcels { parcels, speed: 0.0, around: 0.0, last: Vec3::ZERO })
        .after(|s, world| {
            let (a, b) = (s.last, place(world, s.parcels[4])?);
            if a != Vec3::ZERO {
                s.around += ferrode_math::real::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
            }
            s.last = b;
            // The last parcel, before it reaches a corner.
            if (world.time() - 0.8).abs() < 0.003 {
                s.speed = world.body(s.parcels[0])?.linear_velocity().x;
            }
            Ok(())
        })
        .draw(|_, _, drawing| {
            for side in 0..4 {
                let rotation = turn(Vec3::Z, 90.0 * f64::from(side));
                for x in [-1.6, -0.6, 0.4] {
                    let from = rotation.rotate(at(x, -1.85, 0.505));
                    drawing.arrow(from, from + rotation.rotate(at(0.5, 0.0, 0.0)), 0.02, Tint::MARK);
                }
            }
        })
        .check(|s, world| {
            Ok(Findings::new()
                .near("speed on the belt (m/s)", s.speed, SPEED, 0.01)
                .at_least("lowest parcel (m)", lowest(world), 0.5)
                .at_least("the first one has gone around by (rad)", s.around, 4.0))
        })
}
