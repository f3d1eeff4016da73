//! A row of dominoes along a curve: the wave runs at a speed that thickness, height and spacing decide.

use super::prelude::*;
use core::f64::consts::PI;
use ferrode_math::real;

const COUNT: usize = 60;
const SIDES: [f64; 3] = [0.08, 0.25, 0.5];
const SPACING: f64 = 0.25;

pub(super) const DEMO: Demo = Demo {
    name: "dominoes",
    subject: Subject::Heaps,
    about: "sixty dominoes fall along a winding row",
    property: "all fall, one after the other; the wave runs at 0.6 to 2 times √(g h)",
    seconds: 8.0,
    picture_at: 3.6,
    show: &[],
    camera: Camera::new([3.2, -6.4, 4.2], [5.5, 0.9, 0.0]),
    build,
};

#[derive(Clone)]
struct Row {
    dominoes: Vec<BodyKey>,
    /// When each fell.
    fell: Vec<Option<f64>>,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Quick)?;
    world.set_default_material(Material::with_friction(0.5))?;
    let_sleep(&mut world)?;
    let mut dominoes = Vec::new();
    let (mut p, mut s) = (Vec3::ZERO, 0.0_f64);
    for _ in 0..COUNT {
        // Heading along a wave.
        let heading = 0.9 * real::sin(s * 2.0 * PI / 7.0);
        let (sin, cos) = sin_cos(heading);
        let builder = BodyBuilder::new()
            .at(p + at(0.0, 0.0, 0.5 * SIDES[2]))
            .rotated(turn(Vec3::Z, heading.to_degrees()))
            .with_shape(Cuboid::new(at(SIDES[0], SIDES[1], SIDES[2]))?, 700.0);
        dominoes.push(world.add_body(builder)?);
        p += at(cos, sin, 0.0) * SPACING;
        s += SPACING;
    }
    world.body_mut(dominoes[0])?.set_angular_velocity(at(0.0, 2.5, 0.0))?;
    let first_push = body(&world, dominoes[0])?.vector_to_world(Vec3::X);
    world.body_mut(dominoes[0])?.set_linear_velocity(first_push * 0.6)?;
    let fell = vec![None; COUNT];
    Stage::new(world, 0.004, Row { dominoes, fell })
        .after(|row, world| {
            for (key, fell) in row.dominoes.iter().zip(&mut row.fell) {
                if fell.is_none() && world.body(*key)?.vector_to_world(Vec3::Z).z < 0.9 {
                    *fell = Some(world.time());
                }
            }
            Ok(())
        })
        .check(|row, _| {
            let times: Vec<f64> = row.fell.iter().flatten().copied().collect();
            let in_order = times.windows(2).all(|pair| pair[0] < pair[1]);
            let findings = Findings::new()
                .at_least("dominoes that fell", times.len() as f64, COUNT as f64)
                .is("one after the other", in_order);
            if times.len() < COUNT {
                return Ok(findings);
            }
            let speed = SPACING * 40.0 / (times[COUNT - 5] - times[COUNT - 45]);
            let scale = (G * SIDES[2]).sqrt();
            Ok(findings.at_most("the wave's speed over √(g h)", speed / scale, 2.0).at_least(
                "the wave's speed over √(g h)",
                speed / scale,
                0.6,
            ))
        })
}
