//! A heavy top, held at its tip, precesses instead of falling.

use super::prelude::*;

const SPIN: f64 = 60.0;
const ARM: f64 = 0.4;
const TILT: f64 = 60.0;

pub(super) const DEMO: Demo = Demo {
    name: "gyroscope",
    subject: Subject::Spin,
    about: "a spinning wheel on a stand precesses",
    property: "it goes round at the rate of a steady precession, within 1 %, and does not sink by more than 2°",
    seconds: 5.0,
    picture_at: 3.0,
    show: &[],
    camera: Camera::new([1.2, -1.8, 1.75], [0.05, 0.0, 0.72]),
    build,
};

/// Rate of the slow steady precession of a symmetric top (Goldstein, Classical Mechanics, §5.7): the smaller root of
/// (I₁ − I₃) cos θ Ω² − I₃ s Ω + m g l = 0, where s is the spin about the axle beside that of the precession:
/// with ω₃ = s + Ω cos θ, I₁ cos θ Ω² − I₃ ω₃ Ω + m g l = 0.
fn precession(mass: f64, across: f64, axial: f64, spin: f64) -> f64 {
    let a = across * ferrode_math::real::cos(TILT.to_radians());
    let (b, c) = (-axial * spin, mass * G * ARM);
    2.0 * c / (-b + (b * b - 4.0 * a * c).sqrt())
}

#[derive(Clone)]
struct Top {
    wheel: BodyKey,
    expected: f64,
    turned: f64,
    last: Vec3,
    sunk: f64,
    trail: Trail,
}

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Direct)?;
    world.set_max_angular_speed(f64::INFINITY)?;
    let tip = at(0.0, 0.0, 1.0);
    add_wall(&mut world, at(0.08, 0.08, 0.96), Pose::from_position(at(0.0, 0.0, 0.48)))?;
    let lean = turn(Vec3::Y, TILT);
    let axle = lean.rotate(Vec3::Z);
    let builder = BodyBuilder::new()
        .at(tip + axle * ARM)
        .rotated(lean)
        .with_shape(Cylinder::new(0.25, 0.06)?, 1000.0)
        .with_shape_at(Cuboid::new(at(0.3, 0.06, 0.07))?, 0.0, Pose::IDENTITY)
        .with_shape_at(Capsule::new(0.012, ARM)?, 0.0, Pose::from_position(at(0.0, 0.0, -0.5 * ARM)));
    let wheel = world.add_body(builder)?;
    for geom in world.body_geoms(wheel)?.to_vec() {
        world.set_geom_bits(geom, 0, 0)?;
    }
    world.add_ball(Some(wheel), None, tip)?;
    let mass = *body(&world, wheel)?.mass();
    let across = mass.inertia.rows[0][0] + mass.mass * ARM * ARM;
    let axial = mass.inertia.rows[2][2];
    let rate = precession(mass.mass, across, axial, SPIN);
    // Started in steady precession, so that it does not nod: ω = ω₃ along the axle, and what is left of Ω z across it.
    let across_part = Vec3::Z * rate - axle * (rate * axle.z);
    let spin = axle * SPIN + across_part;
    let body = world.body_mut(wheel)?;
    body.set_angular_velocity(spin)?;
    body.set_linear_velocity(spin.cross(axle * ARM))?;
    let last = axle;
    Stage::new(
        world,
        0.000_025,
        Top { wheel, expected: rate, turned: 0.0, last, sunk: 0.0, trail: Trail::default() },
    )
    .after(|top, world| {
        let axle = world.body(top.wheel)?.vector_to_world(Vec3::Z);
        let (a, b) = (top.last, axle);
        top.turned += ferrode_math::real::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
        top.last = axle;
        top.trail.follow(at(0.0, 0.0, 1.0) + axle * (ARM + 0.05), 200);
        let tilt = ferrode_math::real::acos(axle.z.clamp(-1.0, 1.0)).to_degrees();
        top.sunk = top.sunk.max((tilt - TILT).abs());
        Ok(())
    })
    .draw(|top, _, drawing| {
        drawing.floor = Some(0.0);
        drawing.path(&top.trail);
    })
    .check(|top, world| {
        Ok(Findings::new().near("precession (rad/s)", top.turned / world.time(), top.expected, 0.01).at_most(
            "tilt changed by (degrees)",
            top.sunk,
            2.0,
        ))
    })
}
