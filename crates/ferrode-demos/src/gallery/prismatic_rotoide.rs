//! A crane's arm on a PR joint: it goes up a post and turns at the same time.

use super::prelude::*;
use ferrode::PR;

const H: f64 = 0.005;

pub(super) const DEMO: Demo = Demo {
    name: "pr",
    subject: Subject::Joints,
    about: "a prismatic-rotoide joint lifts an arm and lets it turn",
    property: "the arm is lifted by 0.8 m and turned by 1.2 rad, to 1 mm and 2 mrad",
    seconds: 4.0,
    picture_at: 1.6,
    show: &[],
    camera: Camera::new([1.7, -3.1, 2.3], [0.3, 0.0, 1.15]),
    build,
};

#[derive(Clone)]
struct Crane {
    joint: JointKey,
    arm: BodyKey,
}

/// The arm's root, in its own frame, and where it is at first.
const ROOT: Vec3 = at(-0.6, 0.0, 0.0);
const LOW: Vec3 = at(0.15, 0.0, 0.4);

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let post = add_box(&mut world, at(0.2, 0.2, 1.6), 1000.0, at(0.0, 0.0, 0.8))?;
    world.add_fixed(Some(post), None)?;
    let arm = add_box(&mut world, at(1.2, 0.12, 0.12), 300.0, LOW - ROOT)?;
    let joint = world.create_joint::<PR>(None)?;
    // The line that is slid along is fixed in the first body, the hinge in the second.
    world.attach(joint, Some(post), Some(arm))?;
    let mut pr = world.joint_mut::<PR>(joint)?;
    pr.set_anchor(LOW)?;
    pr.set_axis1(Vec3::Z)?; // along the post
    pr.set_axis2(Vec3::Y)?; // and turns in the plane of the post
    Stage::new(world, H, Crane { joint, arm })
        .before(|crane, world| {
            // The joint counts how the post moves as seen from the arm: down, and tipped ahead.
            let pr = world.joint::<PR>(crane.joint)?;
            let (height, angle) = (-0.8 - pr.position()?, 1.2 - pr.angle());
            let mut pr = world.joint_mut::<PR>(crane.joint)?;
            pr.set_motor_of(1, (4.0 * height).clamp(-0.5, 0.5), 2000.0)?;
            pr.set_motor_of(2, (4.0 * angle).clamp(-1.0, 1.0), 2000.0)?;
            Ok(())
        })
        .draw(|crane, world, drawing| {
            if let Ok(arm) = world.body(crane.arm) {
                let root = arm.relative_point_position(ROOT);
                drawing.block(at(0.3, 0.28, 0.2), at(0.0, 0.0, root.z), Tint::FRAME);
                drawing.rod(root - Vec3::Y * 0.12, root + Vec3::Y * 0.12, 0.035, Tint::SPRING);
            }
        })
        .check(|crane, world| {
            let arm = body(world, crane.arm)?;
            let (lifted, along) = (arm.relative_point_position(ROOT) - LOW, arm.vector_to_world(Vec3::X));
            let angle = ferrode_math::real::atan2(along.z, along.x);
            Ok(Findings::new()
                .at_most("from the height asked for (m)", (lifted - at(0.0, 0.0, 0.8)).length(), 1e-3)
                .at_most("from the angle asked for (rad)", (angle - 1.2).abs(), 2e-3)
                .at_most("the joint is open by (m)", joint_errors(world)?.0, 1e-4))
        })
}
