//! Ten thousand boxes rain into a yard.

use super::prelude::*;
use ferrode_math::random::OdeRandom;

const SIDE: usize = 25;
const LAYERS: usize = 16;

pub(super) const DEMO: Demo = Demo {
    name: "ten-thousand",
    subject: Subject::Engine,
    about: "ten thousand boxes fall into a yard",
    property: "none leaves the yard or sinks into the ground, and contacts are under a centimetre deep on the mean",
    seconds: 4.0,
    picture_at: 4.0,
    show: &[],
    camera: Camera::new([15.0, -19.0, 33.0], [0.0, -0.8, 4.0]),
    build,
};

const YARD: f64 = 10.5;

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Substep)?;
    for side in [-1.0, 1.0] {
        add_wall(
            &mut world,
            at(1.0, 2.0 * YARD + 2.0, 12.0),
            Pose::from_position(at(side * (YARD + 0.5), 0.0, 6.0)),
        )?;
        add_wall(
            &mut world,
            at(2.0 * YARD + 2.0, 1.0, 12.0),
            Pose::from_position(at(0.0, side * (YARD + 0.5), 6.0)),
        )?;
    }
    let mut random = OdeRandom::new(1);
    for layer in 0..LAYERS {
        for i in 0..SIDE {
            for j in 0..SIDE {
                let jitter = random.next_vector(0.05);
                let place = at(
                    (i as f64 - 0.5 * (SIDE - 1) as f64) * 0.8,
                    (j as f64 - 0.5 * (SIDE - 1) as f64) * 0.8,
                    0.4 + 0.62 * layer as f64,
                );
                add_box(&mut world, at(0.5, 0.5, 0.5), 500.0, place + jitter)?;
            }
        }
    }
    Stage::new(world, 1.0 / 60.0, ()).check(|(), world| {
        let mut out = 0.0_f64;
        for (_, body) in world.bodies() {
            let p = body.position();
            out = out.max(p.x.abs().max(p.y.abs()) - YARD);
        }
        let depths = world.contacts().iter().map(|contact| contact.point.depth);
        let mean = depths.sum::<f64>() / world.contacts().len().max(1) as f64;
        Ok(Findings::new()
            .at_least("boxes", world.body_count() as f64, 10_000.0)
            .at_most("a centre left the yard by (m)", out, 0.0)
            .at_least("lowest centre (m)", lowest(world), 0.2)
            .at_most("mean penetration (m)", mean, 0.01))
    })
}
