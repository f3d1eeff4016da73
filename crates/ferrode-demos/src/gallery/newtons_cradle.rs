//! Newton's cradle: five steel balls on threads, a hair's breadth apart.

use super::prelude::*;
use ferrode::DBall;

const COUNT: usize = 5;
const RADIUS: f64 = 0.1;
/// Between neighbours, m: impacts follow one another, as the sound's way through steel lets them.
const GAP: f64 = 1e-3;
const THREAD: f64 = 0.8;

pub(super) const DEMO: Demo = Demo {
    name: "newtons-cradle",
    subject: Subject::Mechanisms,
    about: "one ball falls in on four, and one flies off at the other side",
    property: "at the first swing the last ball rises as high as the first one fell, within 2 %, and the middle ones stay",
    seconds: 1.4,
    picture_at: 1.05,
    show: &[],
    camera: Camera::new([0.95, -2.3, 1.6], [0.1, 0.0, 1.0]),
    build,
};

#[derive(Clone)]
struct Cradle {
    balls: Vec<BodyKey>,
    start: f64,
    /// Largest height of each ball after the first impact, over its lowest place, m.
    highest: [f64; COUNT],
}

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Direct)?;
    world.set_default_material(Material::with_friction(0.0).with_restitution(1.0))?;
    let mut balls = Vec::new();
    for i in 0..COUNT {
        let x = (i as f64 - 0.5 * (COUNT - 1) as f64) * (2.0 * RADIUS + GAP);
        let top = at(x, 0.0, 0.8 + THREAD);
        let lean = if i == 0 { turn(Vec3::Y, 35.0) } else { Quat::IDENTITY };
        let start = top + lean.rotate(at(0.0, 0.0, -THREAD));
        let ball = add_ball(&mut world, RADIUS, 7800.0, start)?;
        for side in [-0.3, 0.3] {
            let thread = world.create_joint::<DBall>(None)?;
            world.attach(thread, Some(ball), None)?;
            let mut joint = world.joint_mut::<DBall>(thread)?;
            joint.set_anchor1(start)?;
            joint.set_anchor2(top + at(0.0, side, 0.0))?;
        }
        balls.push(ball);
    }
    let start = place(&world, balls[0])?.z - 0.8;
    Stage::new(world, 0.0005, Cradle { balls, start, highest: [0.0; COUNT] })
        .after(|cradle, world| {
            if world.time() > 0.7 {
                for (highest, key) in cradle.highest.iter_mut().zip(&cradle.balls) {
                    *highest = highest.max(place(world, *key)?.z - 0.8);
                }
            }
            Ok(())
        })
        .draw(|_, world, drawing| {
            drawing.floor = Some(0.4);
            drawing.rods(world, 0.004);
            let (half, top) = (0.62, 0.8 + THREAD);
            for y in [-0.3, 0.3] {
                drawing.rod(at(-half, y, top), at(half, y, top), 0.02, Tint::FRAME);
                for x in [-half, half] {
                    drawing.rod(at(x, y, top), at(x, y, 0.4), 0.02, Tint::FRAME);
                }
            }
        })
        .check(|cradle, _| {
            let middle = cradle.highest[1..COUNT - 1].iter().copied().fold(0.0, f64::max);
            Ok(Findings::new()
                .near("the last ball rose by (m)", cradle.highest[COUNT - 1], cradle.start, 0.02)
                .at_most("the middle ones by (m)", middle, 0.02 * cradle.start))
        })
}
