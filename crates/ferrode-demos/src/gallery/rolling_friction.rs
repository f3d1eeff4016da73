//! Balls on grounds that resist rolling more and more.

use super::prelude::*;

const RADIUS: f64 = 0.2;
const SPEED: f64 = 2.0;
/// Lever arms of the resisting torque, m.
const ARMS: [f64; 5] = [0.002, 0.004, 0.008, 0.016, 0.032];

pub(super) const DEMO: Demo = Demo {
    name: "rolling-friction",
    subject: Subject::Contacts,
    about: "balls roll out on surfaces of different rolling friction",
    property: "each rolls v² (1 + 2/5) r / (2 g ρ) far, within 2 %",
    seconds: 40.0,
    picture_at: 40.0,
    show: &[],
    camera: Camera::new([-2.4, -3.2, 2.3], [5.0, 0.5, 0.0]),
    build,
};

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let mut balls = Vec::new();
    for (i, rolling) in ARMS.into_iter().enumerate() {
        let builder = BodyBuilder::new()
            .at(at(0.0, 0.8 * (i as f64 - 2.0), RADIUS))
            .with_velocity(at(SPEED, 0.0, 0.0))
            .with_spin(at(0.0, SPEED / RADIUS, 0.0))
            .with_shape(Sphere::new(RADIUS)?, 1000.0)
            .with_material(Material { friction: 1.0, rolling, ..Material::default() });
        balls.push(world.add_body(builder)?);
    }
    Stage::new(world, 0.01, balls)
        .draw(|_, _, drawing| {
            // Where each should stop.
            for (i, arm) in ARMS.into_iter().enumerate() {
                let expected = 0.5 * SPEED * SPEED * 1.4 * RADIUS / (G * arm);
                let y = 0.8 * (i as f64 - 2.0);
                drawing.rod(at(expected, y - 0.35, 0.0), at(expected, y + 0.35, 0.0), 0.03, Tint::MARK);
                drawing.line(at(0.0, y, 0.01), at(expected, y, 0.01), Tint::PATH);
            }
            drawing.rod(at(0.0, -2.0, 0.0), at(0.0, 2.0, 0.0), 0.03, Tint::FRAME);
        })
        .check(|balls, world| {
            let mut findings = Findings::new();
            for (arm, key) in ARMS.into_iter().zip(balls) {
                // The torque m g ρ slows m r² (1 + 2/5) of inertia about the point of contact.
                let expected = 0.5 * SPEED * SPEED * 1.4 * RADIUS / (G * arm);
                findings = findings.near(&format!("ρ {arm} (m)"), place(world, *key)?.x, expected, 0.02);
            }
            Ok(findings.at_most("fastest (m/s)", fastest(world), 1e-6))
        })
}
