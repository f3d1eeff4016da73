//! A heavy ball is shot into a brick wall.

use super::prelude::*;

pub(super) const DEMO: Demo = Demo {
    name: "wall-crash",
    subject: Subject::Heaps,
    about: "a heavy ball breaks through a brick wall",
    property: "the ball goes through, a dozen bricks fly, and no step makes energy",
    seconds: 4.0,
    picture_at: 0.65,
    show: &[],
    camera: Camera::new([6.2, -7.2, 3.6], [0.7, 0.0, 1.5]),
    build,
};

#[derive(Clone)]
struct Crash {
    ball: BodyKey,
    bricks: Vec<(BodyKey, Vec3)>,
    energy: f64,
    /// Largest gain of energy in one step, J.
    gain: f64,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Quick)?;
    let brick = at(0.4, 0.8, 0.4);
    let mut bricks = Vec::new();
    for row in 0..8 {
        for i in 0..6 {
            let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
            let start = at(0.0, (f64::from(i) - 2.75 + shift) * 0.801, 0.2 + 0.4 * f64::from(row));
            bricks.push((add_box(&mut world, brick, 600.0, start)?, start));
        }
    }
    let ball = BodyBuilder::new()
        .at(at(-8.0, 0.0, 1.6))
        .with_velocity(at(18.0, 0.0, 2.0))
        .with_shape(Sphere::new(0.5)?, 2500.0);
    let ball = world.add_body(ball)?;
    let energy = world.energy().total();
    Stage::new(world, 0.005, Crash { ball, bricks, energy, gain: 0.0 })
        .after(|crash, world| {
            let energy = world.energy().total();
            crash.gain = crash.gain.max(energy - crash.energy);
            crash.energy = energy;
            Ok(())
        })
        .check(|crash, world| {
            let mut displaced = 0_u32;
            for (key, start) in &crash.bricks {
                displaced += u32::from((place(world, *key)? - *start).length() > 0.5);
            }
            let start = 0.5 * body(world, crash.ball)?.mass().mass * (18.0_f64 * 18.0 + 4.0);
            Ok(Findings::new()
                .at_least("bricks knocked away", f64::from(displaced), 12.0)
                .at_least("the ball went through to (m)", place(world, crash.ball)?.x, 0.5)
                .at_most("largest gain of energy in a step (J per J of the shot)", crash.gain / start, 0.01)
                .at_least("lowest centre (m)", lowest(world), 0.1))
        })
}
