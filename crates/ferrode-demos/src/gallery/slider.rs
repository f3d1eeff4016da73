//! A mass on a slider between soft stops that meet: a spring without damper.

use super::prelude::*;
use core::f64::consts::TAU;
use ferrode::Slider;

const H: f64 = 0.001;
const MASS: f64 = 2.0;
const STIFFNESS: f64 = 80.0;

pub(super) const DEMO: Demo = Demo {
    name: "slider",
    subject: Subject::Joints,
    about: "a mass on a spring slides to and fro",
    property: "its period is 2π √(m/k), within 0.5 %",
    seconds: 6.0,
    picture_at: 0.05,
    show: &[],
    camera: Camera::new([0.8, -2.7, 1.9], [0.0, 0.0, 0.8]),
    build,
};

#[derive(Clone)]
struct Spring {
    joint: JointKey,
    before: f64,
    /// Times at which it went through the middle to the right.
    crossings: Vec<f64>,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let builder = BodyBuilder::new()
        .at(at(0.0, 0.0, 1.0))
        .with_mass(Mass::cuboid_total(MASS, at(0.4, 0.3, 0.3))?)
        .with_shape(Cuboid::new(at(0.4, 0.3, 0.3))?, 0.0);
    let block = world.add_body(builder)?;
    let joint = world.add_slider(Some(block), None, Vec3::X)?;
    let mut slider = world.joint_mut::<Slider>(joint)?;
    // Both stops at the middle: whichever side the mass is on, one of them pulls it back like a spring.
    slider.set_limits(0.0, 0.0)?;
    slider.limit_motor_mut().set_stop_softness(spring(STIFFNESS, 0.0, H)?)?;
    world.body_mut(block)?.set_position(at(0.6, 0.0, 1.0))?;
    let rail = Pose { position: at(0.0, 0.0, 1.0), rotation: turn(Vec3::Y, 90.0) };
    let rail = world.add_static(Cylinder::new(0.03, 2.4)?, rail)?;
    world.set_geom_bits(rail, 0, 0)?;
    Stage::new(world, H, Spring { joint, before: 0.6, crossings: Vec::new() })
        .after(|spring, world| {
            let now = world.joint::<Slider>(spring.joint)?.position()?;
            if spring.before < 0.0 && now >= 0.0 {
                spring.crossings.push(world.time() - H * now / (now - spring.before));
            }
            spring.before = now;
            Ok(())
        })
        .draw(|spring, world, drawing| {
            for side in [-1.0, 1.0] {
                drawing.block(at(0.08, 0.3, 1.2), at(side * 1.2, 0.0, 0.6), Tint::FRAME);
                if let Ok(joint) = world.joint::<Slider>(spring.joint).and_then(|joint| joint.position()) {
                    let face = at(joint + side * 0.2, 0.0, 1.0);
                    drawing.spring(face, at(side * 1.16, 0.0, 1.0), 0.07, 9);
                }
            }
        })
        .check(|spring, world| {
            let (Some(first), Some(last)) = (spring.crossings.first(), spring.crossings.last()) else {
                return Ok(Findings::new().is("it swings", false));
            };
            let period = (last - first) / (spring.crossings.len() - 1) as f64;
            Ok(Findings::new().near("period (s)", period, TAU * (MASS / STIFFNESS).sqrt(), 5e-3).at_most(
                "off the rail by (m)",
                joint_errors(world)?.0,
                1e-6,
            ))
        })
}
