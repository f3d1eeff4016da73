//! Boxes of different sizes on each other. A stack is where contacts are tried hardest: each box must carry all above it.

use super::prelude::*;

const SIDES: [f64; 8] = [1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3];

pub(super) const DEMO: Demo = Demo {
    name: "box-stack",
    subject: Subject::Heaps,
    about: "eight boxes on each other, largest at the bottom",
    property: "no box moves by more than a millimetre, and all are still",
    seconds: 5.0,
    picture_at: 5.0,
    show: &[],
    camera: Camera::new([6.6, -6.6, 4.4], [0.0, 0.0, 2.6]),
    build,
};

#[derive(Clone)]
struct Stack {
    boxes: Vec<(BodyKey, Vec3)>,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let (mut boxes, mut top) = (Vec::new(), 0.0);
    for side in SIDES {
        let start = at(0.0, 0.0, top + 0.5 * side);
        boxes.push((add_box(&mut world, Vec3::splat(side), 500.0, start)?, start));
        top += side;
    }
    Stage::new(world, 0.01, Stack { boxes }).check(|stack, world| {
        let mut moved = 0.0_f64;
        for (key, start) in &stack.boxes {
            moved = moved.max((place(world, *key)? - *start).length());
        }
        Ok(Findings::new().at_most("a box moved by (m)", moved, 1e-3).at_most(
            "speed (m/s)",
            fastest(world),
            1e-6,
        ))
    })
}
