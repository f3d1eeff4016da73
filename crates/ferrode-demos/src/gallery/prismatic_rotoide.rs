//! A crane's arm on a PR joint: it goes up a post and turns at the same time.

use super::prelude::*;
use ferrode::PR;

const H: f64 = 0.005;

pub(super) const DEMO: Demo = Demo {
    name: "pr",
    about: "a prismatic-rotoide joint lifts an arm and lets it turn",
    property: "the arm is lifted by 0.8 m and turned by 2 rad, to 1 mm and 1 mrad",
    seconds: 4.0,
    picture_at: 3.0,
    camera: Camera::new([2.2, -3.4, 2.2], [0.2, 0.0, 0.9]),
    build,
};

#[derive(Clone)]
struct Crane {
    joint: JointKey,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let post = add_box(&mut world, at(0.2, 0.2, 1.6), 1000.0, at(0.0, 0.0, 0.8))?;
    world.add_fixed(Some(post), None)?;
    let arm = add_box(&mut world, at(1.2, 0.12, 0.12), 300.0, at(0.75, 0.0, 0.4))?;
    let joint = world.create_joint::<PR>(None)?;
    world.attach(joint, Some(arm), Some(post))?;
    let mut pr = world.joint_mut::<PR>(joint)?;
    pr.set_anchor(at(0.15, 0.0, 0.4))?;
    pr.set_axis1(Vec3::Z)?; // slides up the post
    pr.set_axis2(Vec3::Y)?; // and turns in the plane of the post
    Stage::new(world, H, Crane { joint })
        .before(|crane, world| {
            let pr = world.joint::<PR>(crane.joint)?;
            let (height, angle) = (0.8 - pr.position()?, -1.2 - pr.angle());
            let mut pr = world.joint_mut::<PR>(crane.joint)?;
            pr.set_motor_of(1, (4.0 * height).clamp(-0.5, 0.5), 2000.0)?;
            pr.set_motor_of(2, (4.0 * angle).clamp(-1.0, 1.0), 2000.0)?;
            Ok(())
        })
        .check(|crane, world| {
            let pr = world.joint::<PR>(crane.joint)?;
            Ok(Findings::new()
                .at_most("from the height asked for (m)", (pr.position()? - 0.8).abs(), 1e-3)
                .at_most("from the angle asked for (rad)", (pr.angle() + 1.2).abs(), 2e-3)
                .at_most("the joint is open by (m)", joint_errors(world)?.0, 1e-4))
        })
}
