//! A bridge of planks whose joints break where the force on them is too large: force feedback.

use super::prelude::*;

const PLANKS: usize = 10;
const STRENGTH: f64 = 8000.0;
const SPAN: f64 = 4.9;
const SAG: f64 = 0.35;

pub(super) const DEMO: Demo = Demo {
    name: "feedback",
    subject: Subject::Mechanisms,
    about: "a bridge carries one load, and breaks under two",
    property: "at rest the end joints carry the weight of bridge and load, within 0.5 %; the second load breaks it",
    seconds: 6.0,
    picture_at: 5.55,
    show: &[],
    camera: Camera::new([1.2, -7.4, 3.6], [0.0, 0.0, 1.6]),
    build,
};

#[derive(Clone)]
struct Bridge {
    joints: Vec<JointKey>,
    ends: [JointKey; 2],
    load: BodyKey,
    second: BodyKey,
    weight: f64,
    /// Sum over the last second before the second load falls, N, and of how many steps.
    carried: f64,
    counted: f64,
    broken: usize,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    damp(&mut world, 0.02, 0.02)?;
    for side in [-1.0, 1.0] {
        add_wall(&mut world, at(1.0, 1.2, 2.5), Pose::from_position(at(side * 3.05, 0.0, 1.25)))?;
    }
    let (mut joints, mut last, mut weight) = (Vec::new(), None, 0.0);
    // Its joints hang on a parabola, as those of a bridge with an even load do.
    let node = |i: usize| {
        let x = SPAN * (i as f64 / PLANKS as f64 - 0.5);
        at(x, 0.0, 2.45 - SAG * (1.0 - 4.0 * x * x / (SPAN * SPAN)))
    };
    for i in 0..PLANKS {
        let along = node(i + 1) - node(i);
        let builder = BodyBuilder::new()
            .at((node(i) + node(i + 1)) * 0.5)
            .rotated(turn(Vec3::Y, -ferrode_math::real::atan2(along.z, along.x).to_degrees()))
            .with_shape(Cuboid::new(at(along.length() - 0.06, 1.0, 0.1))?, 400.0);
        let plank = world.add_body(builder)?;
        weight += body(&world, plank)?.mass().mass * G;
        joints.push(world.add_hinge(Some(plank), last, node(i), Vec3::Y)?);
        last = Some(plank);
    }
    joints.push(world.add_hinge(last, None, node(PLANKS), Vec3::Y)?);
    for joint in &joints {
        world.set_joint_feedback(*joint, true)?;
    }
    let load = add_box(&mut world, Vec3::splat(0.5), 400.0, at(0.0, 0.0, 2.45 - SAG + 0.31))?;
    weight += body(&world, load)?.mass().mass * G;
    // The second load waits high up, out of gravity's reach.
    let second = add_box(&mut world, Vec3::splat(0.7), 1200.0, at(0.6, 0.0, 5.5))?;
    world.body_mut(second)?.disable();
    let ends = [joints[0], joints[PLANKS]];
    let bridge = Bridge { joints, ends, load, second, weight, carried: 0.0, counted: 0.0, broken: 0 };
    Stage::new(world, 0.005, bridge)
        .after(|bridge, world| {
            if world.time() < 3.9 {
                if world.time() > 2.9 {
                    for end in bridge.ends {
                        // The first body of both is a plank.
                        bridge.carried +=
                            world.joint_feedback(end)?.map_or(0.0, |feedback| feedback.force1.z);
                    }
                    bridge.counted += 1.0;
                }
                return Ok(());
            }
            if world.time() < 4.0 {
                world.body_mut(bridge.second)?.enable();
            }
            let mut kept = Vec::new();
            for joint in core::mem::take(&mut bridge.joints) {
                let force = world.joint_feedback(joint)?.map_or(0.0, |feedback| feedback.force1.length());
                if force > STRENGTH {
                    world.destroy_joint(joint)?;
                    bridge.broken += 1;
                } else {
                    kept.push(joint);
                }
            }
            bridge.joints = kept;
            Ok(())
        })
        .check(|bridge, world| {
            Ok(Findings::new()
                .near("the ends carried (N)", bridge.carried / bridge.counted, bridge.weight, 5e-3)
                .at_least("joints broken", bridge.broken as f64, 1.0)
                .at_most("the first load is at height (m)", place(world, bridge.load)?.z, 1.5))
        })
}
