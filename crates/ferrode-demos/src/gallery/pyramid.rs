//! A pyramid of equal boxes, ten rows high.

use super::prelude::*;

const ROWS: usize = 10;

pub(super) const DEMO: Demo = Demo {
    name: "pyramid",
    subject: Subject::Heaps,
    about: "fifty-five boxes in a pyramid",
    property: "it stands: no box has moved by more than 5 mm",
    seconds: 4.0,
    picture_at: 4.0,
    show: &[],
    camera: Camera::new([6.0, -16.5, 7.5], [0.0, 0.0, 4.7]),
    build,
};

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let mut boxes = Vec::new();
    for row in 0..ROWS {
        for i in 0..ROWS - row {
            let x = (i as f64 - 0.5 * (ROWS - row - 1) as f64) * 1.05;
            let start = at(x, 0.0, 0.5 + row as f64);
            boxes.push((add_box(&mut world, Vec3::splat(1.0), 200.0, start)?, start));
        }
    }
    Stage::new(world, 1.0 / 60.0, boxes).check(|boxes, world| {
        let mut moved = 0.0_f64;
        for (key, start) in boxes {
            moved = moved.max((place(world, *key)? - *start).length());
        }
        Ok(Findings::new().at_most("a box moved by (m)", moved, 5e-3))
    })
}
