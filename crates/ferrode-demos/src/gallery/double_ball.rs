//! Double-ball joints are rods without mass: a mobile of weights hung from beams.

use super::prelude::*;
use ferrode::DBall;

pub(super) const DEMO: Demo = Demo {
    name: "double-ball",
    subject: Subject::Joints,
    about: "a mobile hangs on rods without mass and swings in balance",
    property: "each rod keeps its length to 0.1 mm; the beams stay level to 3°",
    seconds: 6.0,
    picture_at: 2.0,
    show: &[],
    camera: Camera::new([1.2, -3.9, 2.1], [0.0, 0.0, 1.85]),
    build,
};

#[derive(Clone)]
struct Mobile {
    rods: Vec<(JointKey, f64)>,
    beams: Vec<BodyKey>,
    stretch: f64,
    tilt: f64,
}

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Direct)?;
    let mut rods = Vec::new();
    let mut hang = |world: &mut World, a: BodyKey, b: Option<BodyKey>, from: Vec3, to: Vec3| {
        let rod = world.create_joint::<DBall>(None)?;
        world.attach(rod, Some(a), b)?;
        let mut joint = world.joint_mut::<DBall>(rod)?;
        joint.set_anchor1(from)?;
        joint.set_anchor2(to)?;
        rods.push((rod, (to - from).length()));
        Ok::<(), Failure>(())
    };
    let beam = |world: &mut World, z: f64, x: f64, length: f64| {
        add_box(world, at(length, 0.03, 0.03), 700.0, at(x, 0.0, z))
    };
    let top = beam(&mut world, 2.2, 0.0, 1.6)?;
    // The rods end above the beam, so that it balances stably.
    hang(&mut world, top, None, at(0.0, 0.0, 2.28), at(0.0, 0.0, 2.9))?;
    let mut beams = vec![top];
    for side in [-1.0, 1.0] {
        let x = side * 0.75;
        let low = beam(&mut world, 1.5, x, 0.8)?;
        hang(&mut world, low, Some(top), at(x, 0.0, 1.58), at(x, 0.0, 2.2))?;
        beams.push(low);
        for end in [-1.0, 1.0] {
            let x = x + end * 0.35;
            let weight = add_ball(&mut world, 0.12, 800.0, at(x, 0.0, 0.95))?;
            hang(&mut world, weight, Some(low), at(x, 0.0, 1.07), at(x, 0.0, 1.5))?;
            // A push across the beam: it turns and swings.
            world.body_mut(weight)?.set_linear_velocity(at(0.0, 0.35 * side, 0.0))?;
        }
    }
    Stage::new(world, 0.002, Mobile { rods, beams, stretch: 0.0, tilt: 0.0 })
        .after(|mobile, world| {
            for (rod, length) in &mobile.rods {
                let joint = world.joint::<DBall>(*rod)?;
                let now = (joint.anchor1() - joint.anchor2()).length();
                mobile.stretch = mobile.stretch.max((now - length).abs());
            }
            for beam in &mobile.beams {
                mobile.tilt = mobile.tilt.max(body(world, *beam)?.vector_to_world(Vec3::X).z.abs());
            }
            Ok(())
        })
        .draw(|_, world, drawing| {
            drawing.floor = Some(0.0);
            drawing.rods(world, 0.01);
            drawing.block(at(0.5, 0.5, 0.06), at(0.0, 0.0, 2.93), Tint::FRAME);
        })
        .check(|mobile, _| {
            Ok(Findings::new().at_most("a rod's length is off by (m)", mobile.stretch, 1e-4).at_most(
                "a beam is tilted by (sine)",
                mobile.tilt,
                0.052,
            ))
        })
}
