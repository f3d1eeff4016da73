//! A house of cards stands by friction alone.

use super::prelude::*;
use ferrode_math::real;

const LENGTH: f64 = 0.1;
const WIDTH: f64 = 0.06;
const THICK: f64 = 0.002;
/// Degrees from the vertical.
const LEAN: f64 = 20.0;
const STOREYS: usize = 3;

pub(super) const DEMO: Demo = Demo {
    name: "cards",
    subject: Subject::Heaps,
    about: "a house of cards, three storeys high",
    property: "no card moves by more than 0.1 mm, and all stand still",
    seconds: 5.0,
    picture_at: 5.0,
    show: &[],
    camera: Camera::new([0.27, -0.43, 0.22], [0.0, 0.0, 0.135]),
    build,
};

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    world.set_default_material(Material::with_friction(1.0))?;
    let lean = LEAN.to_radians();
    // A tent's half width, from its middle to the middle of a card's foot, and its height.
    // Cards touch by this much from the start, and stay so deep in each other: on a knife's edge, contact comes and goes.
    let touch = 2e-5;
    world.set_contact_surface_layer(touch)?;
    let rise = LENGTH * real::cos(lean) + THICK * real::sin(lean) - touch;
    let pitch = LENGTH * real::sin(lean) + THICK * real::cos(lean) - touch;
    let mut cards = Vec::new();
    let mut add = |world: &mut World, length: f64, position: Vec3, degrees: f64| -> Result<(), Failure> {
        let card = BodyBuilder::new()
            .at(position)
            .rotated(turn(Vec3::Y, degrees))
            .with_shape(Cuboid::new(at(THICK, WIDTH, length))?, 700.0);
        cards.push((world.add_body(card)?, position));
        Ok(())
    };
    for storey in 0..STOREYS {
        let floor = storey as f64 * (rise + THICK - touch) - touch;
        let tents = STOREYS - storey;
        for tent in 0..tents {
            let middle = (tent as f64 - 0.5 * (tents - 1) as f64) * 2.0 * pitch;
            for side in [-1.0, 1.0] {
                add(
                    &mut world,
                    LENGTH,
                    at(middle + side * 0.5 * pitch, 0.0, floor + 0.5 * rise),
                    -side * LEAN,
                )?;
            }
        }
        if tents > 1 {
            // A long card lies on the tents.
            let length = 2.0 * pitch * (tents - 1) as f64 + 0.03;
            add(&mut world, length, at(0.0, 0.0, floor + rise + 0.5 * THICK), 90.0)?;
        }
    }
    Stage::new(world, 0.002, cards).check(|cards, world| {
        let mut moved = 0.0_f64;
        for (key, start) in cards {
            moved = moved.max((place(world, *key)? - *start).length());
        }
        Ok(Findings::new().at_most("a card moved by (m)", moved, 1e-4).at_most(
            "fastest (m/s)",
            fastest(world),
            1e-9,
        ))
    })
}
