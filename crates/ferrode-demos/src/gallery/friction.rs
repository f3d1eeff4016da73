//! Blocks of different roughness on a slope of 25°: some stick, some slide.

use super::prelude::*;

const SLOPE: f64 = 25.0;
const SECONDS: f64 = 2.0;
/// tan 25° is 0.466.
const ROUGH: [f64; 6] = [0.0, 0.1, 0.2, 0.3, 0.42, 0.52];

pub(super) const DEMO: Demo = Demo {
    name: "friction",
    subject: Subject::Contacts,
    about: "blocks of different roughness on a slope",
    property: "the smooth ones slide with g (sin θ − µ cos θ), within 1 %; the roughest stays, to 0.1 mm",
    seconds: SECONDS,
    picture_at: 1.4,
    show: &[],
    camera: Camera::new([5.2, -7.4, 1.8], [2.1, 0.0, -1.25]),
    build,
};

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Direct)?;
    let lean = turn(Vec3::Y, SLOPE);
    let slope = Pose { position: lean.rotate(at(4.0, 0.0, -0.1)), rotation: lean };
    let slope = add_wall(&mut world, at(10.0, 5.0, 0.2), slope)?;
    world.set_material(slope, Material::with_friction(f64::INFINITY))?;
    let mut blocks = Vec::new();
    for (i, mu) in ROUGH.into_iter().enumerate() {
        let builder = BodyBuilder::new()
            .at(lean.rotate(at(0.0, 0.8 * (i as f64 - 2.5), 0.15 - 1e-5)))
            .rotated(lean)
            .with_shape(Cuboid::new(at(0.5, 0.5, 0.3))?, 400.0)
            .with_material(Material::with_friction(mu));
        blocks.push(world.add_body(builder)?);
    }
    Stage::new(world, 0.002, blocks)
        .draw(|_, _, drawing| {
            let lean = turn(Vec3::Y, SLOPE);
            let start = |y: f64| lean.rotate(at(0.3, y, 0.003));
            drawing.rod(start(-2.4), start(2.4), 0.015, Tint::MARK);
        })
        .check(|blocks, world| {
            let (sin, cos) = sin_cos(SLOPE.to_radians());
            let mut findings = Findings::new();
            for (mu, key) in ROUGH.into_iter().zip(blocks) {
                let gone = turn(Vec3::Y, SLOPE).inverse_rotate(place(world, *key)?).x;
                let expected = 0.5 * G * (sin - mu * cos) * SECONDS * SECONDS;
                findings = if expected > 0.0 {
                    findings.near(&format!("µ {mu} (m)"), gone, expected, 0.01)
                } else {
                    findings.at_most(&format!("µ {mu} (m)"), gone.abs(), 1e-4)
                };
            }
            Ok(findings)
        })
}
