//! Balls of different restitution fall from the same height.

use super::prelude::*;

const HEIGHT: f64 = 2.0;
const RADIUS: f64 = 0.15;
const RESTITUTION: [f64; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];

pub(super) const DEMO: Demo = Demo {
    name: "bounce",
    subject: Subject::Contacts,
    about: "balls of different restitution fall from the same height",
    property: "after the first bounce each rises to e² times the height it fell, within 1 % of that height",
    seconds: 1.95,
    picture_at: 1.2,
    show: &[],
    camera: Camera::new([0.8, -5.0, 1.8], [0.0, 0.0, 1.05]),
    build,
};

#[derive(Clone)]
struct Balls {
    balls: Vec<BodyKey>,
    bounced: [bool; 6],
    again: [bool; 6],
    highest: [f64; 6],
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let mut balls = Vec::new();
    for (i, e) in RESTITUTION.into_iter().enumerate() {
        let builder = BodyBuilder::new()
            .at(at(0.8 * (i as f64 - 2.5), 0.0, RADIUS + HEIGHT))
            .with_shape(Sphere::new(RADIUS)?, 1000.0)
            .with_material(Material::with_friction(0.5).with_restitution(e));
        balls.push(world.add_body(builder)?);
    }
    Stage::new(world, 0.0005, Balls { balls, bounced: [false; 6], again: [false; 6], highest: [0.0; 6] })
        .after(|s, world| {
            for (i, key) in s.balls.iter().enumerate() {
                let (z, v) = {
                    let ball = world.body(*key)?;
                    (ball.position().z - RADIUS, ball.linear_velocity().z)
                };
                s.bounced[i] |= z < 0.01 && v >= 0.0;
                if s.bounced[i] && !s.again[i] {
                    s.highest[i] = s.highest[i].max(z);
                    s.again[i] = v < -0.5;
                }
            }
            Ok(())
        })
        .draw(|_, _, drawing| {
            // How high each should rise after its first bounce.
            for (i, e) in RESTITUTION.into_iter().enumerate() {
                let (x, z) = (0.8 * (i as f64 - 2.5), RADIUS + e * e * HEIGHT);
                drawing.rod(at(x - 0.25, 0.0, z), at(x + 0.25, 0.0, z), 0.012, Tint::MARK);
            }
        })
        .check(|s, _| {
            let mut worst = 0.0_f64;
            for (highest, e) in s.highest.into_iter().zip(RESTITUTION) {
                worst = worst.max((highest - e * e * HEIGHT).abs() / HEIGHT);
            }
            Ok(Findings::new().at_most("heights are off by (parts of the fall)", worst, 0.01))
        })
}
