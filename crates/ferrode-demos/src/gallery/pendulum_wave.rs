//! A row of pendulums whose periods are T/12, T/13, … : they drift apart into waves, and after T they swing together
//! again (after Ernst Mach; in this form by Berg, Am. J. Phys. 59, 1991).

use super::prelude::*;
use core::f64::consts::TAU;
use ferrode_math::real;

const COUNT: usize = 12;
const FIRST: usize = 12;
const CYCLE: f64 = 20.0;
const START: f64 = 8.0;

pub(super) const DEMO: Demo = Demo {
    name: "pendulum-wave",
    subject: Subject::Mechanisms,
    about: "twelve pendulums drift apart into waves, and come together again",
    property: "after twenty seconds all swing in step again, to 4 % of a swing",
    seconds: CYCLE,
    picture_at: 5.0,
    show: &[],
    camera: Camera::new([1.6, -3.1, 2.3], [0.1, 0.0, 1.62]),
    build,
};

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Direct)?;
    let mut bobs = Vec::new();
    for i in 0..COUNT {
        let period = CYCLE / (FIRST + i) as f64;
        // Swings of 8° take 1 + θ²/16 times as long as small ones.
        let stretch = 1.0 + START.to_radians() * START.to_radians() / 16.0;
        let length = G * (period / (TAU * stretch)) * (period / (TAU * stretch));
        let pivot = at(0.25 * (i as f64 - 0.5 * (COUNT - 1) as f64), 0.0, 2.2);
        let lean = turn(Vec3::X, START);
        // A point mass, so that it is the simple pendulum of the formula.
        let builder = BodyBuilder::new()
            .at(pivot + lean.rotate(at(0.0, 0.0, -length)))
            .rotated(lean)
            .with_mass(Mass::sphere_total(1.0, 0.001)?)
            .with_shape(Sphere::new(0.07)?, 0.0)
            .with_shape_at(
                Capsule::new(0.006, length)?,
                0.0,
                Pose::from_position(at(0.0, 0.0, 0.5 * length)),
            );
        let bob = world.add_body(builder)?;
        for geom in world.body_geoms(bob)?.to_vec() {
            world.set_geom_bits(geom, 0, 0)?;
        }
        world.add_hinge(Some(bob), None, pivot, Vec3::X)?;
        bobs.push(bob);
    }
    Stage::new(world, 0.001, bobs)
        .draw(|_, _, drawing| {
            drawing.floor = Some(0.9);
            drawing.rod(at(-1.55, 0.0, 2.2), at(1.55, 0.0, 2.2), 0.02, Tint::FRAME);
            for (x, y) in [(-1.55, -0.3), (-1.55, 0.3), (1.55, -0.3), (1.55, 0.3)] {
                drawing.rod(at(x, 0.0, 2.2), at(x, y, 0.9), 0.02, Tint::FRAME);
            }
        })
        .check(|bobs, world| {
            let mut apart = 0.0_f64;
            for key in bobs {
                let down = body(world, *key)?.vector_to_world(-Vec3::Z);
                let angle = real::atan2(down.y, -down.z).to_degrees();
                apart = apart.max((angle - START).abs() / (2.0 * START));
            }
            Ok(Findings::new().at_most("out of step by (parts of a swing)", apart, 0.04))
        })
}
