//! Three hinge motors of different strength lift the same arm.

use super::prelude::*;
use ferrode::Hinge;

const MASS: f64 = 4.0;
const REACH: f64 = 0.5;
/// Torque that holds the arm level, N m.
const NEEDED: f64 = MASS * G * REACH;

pub(super) const DEMO: Demo = Demo {
    name: "motors",
    subject: Subject::Motors,
    about: "three motors of different strength lift the same arm",
    property: "the weak one stops where its torque is m g l cos θ, within 1 %; the strong ones go round at their speed",
    seconds: 10.0,
    picture_at: 1.2,
    show: &[],
    camera: Camera::new([0.6, -3.9, 1.9], [0.0, 0.0, 1.0]),
    build,
};

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Direct)?;
    let mut joints = Vec::new();
    for (i, strength) in [0.6, 1.2, 3.0].into_iter().enumerate() {
        let pivot = at(1.4 * (i as f64 - 1.0), 0.0, 1.2);
        let builder = BodyBuilder::new()
            .at(pivot + at(0.0, 0.0, -REACH))
            .with_mass(Mass::cuboid_total(MASS, at(0.1, 0.1, 2.0 * REACH))?)
            .with_shape(Cuboid::new(at(0.1, 0.1, 2.0 * REACH))?, 0.0);
        let arm = world.add_body(builder)?;
        let joint = world.add_hinge(Some(arm), None, pivot, Vec3::Y)?;
        world.joint_mut::<Hinge>(joint)?.set_motor(1.5, strength * NEEDED)?;
        if strength < 1.0 {
            // What cannot go round swings about its place of rest: air takes the swing out of it.
            let damping = ferrode::Damping {
                angular_scale: 0.02,
                angular_threshold: 0.0,
                ..ferrode::Damping::default()
            };
            world.body_mut(arm)?.set_damping(damping)?;
        }
        joints.push(joint);
    }
    Stage::new(world, 0.005, joints)
        .draw(|_, _, drawing| {
            drawing.floor = Some(0.0);
            for i in 0..3 {
                let x = 1.4 * (f64::from(i) - 1.0);
                drawing.block(at(0.12, 0.12, 1.3), at(x, 0.16, 0.65), Tint::FRAME);
                drawing.rod(at(x, -0.08, 1.2), at(x, 0.2, 1.2), 0.05, Tint::SPRING);
            }
        })
        .check(|joints, world| {
            let hinge = |i: usize| world.joint::<Hinge>(joints[i]);
            // From hanging straight down, the load's torque is m g l sin(angle).
            let stalled = ferrode_math::real::asin(0.6);
            Ok(Findings::new()
                .near("the weak motor stops at (rad)", hinge(0)?.angle().abs(), stalled, 0.01)
                .near("the middle one turns at (rad/s)", hinge(1)?.angle_rate(), 1.5, 1e-3)
                .near("the strong one turns at (rad/s)", hinge(2)?.angle_rate(), 1.5, 1e-3))
        })
}
