//! Double-hinge joints: the parallel arms of a swing that keep its seat level.

use super::prelude::*;
use ferrode::DHinge;

pub(super) const DEMO: Demo = Demo {
    name: "double-hinge",
    subject: Subject::Joints,
    about: "a porch swing on two double hinges",
    property: "the seat stays level to 1 mrad, and its hangers keep their length to 0.1 mm",
    seconds: 6.0,
    picture_at: 0.3,
    show: &[],
    camera: Camera::new([2.2, -4.3, 2.2], [0.0, 0.0, 1.05]),
    build,
};

#[derive(Clone)]
struct Swing {
    seat: BodyKey,
    hangers: Vec<JointKey>,
    tilt: f64,
    stretch: f64,
    span: [f64; 2],
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let seat = add_box(&mut world, at(1.2, 0.5, 0.1), 300.0, at(-0.8, 0.0, 0.9))?;
    let beam = add_box(&mut world, at(1.8, 0.1, 0.1), 300.0, at(0.0, 0.0, 2.3))?;
    world.add_fixed(Some(beam), None)?;
    let mut hangers = Vec::new();
    for x in [-0.5, 0.5] {
        let joint = world.create_joint::<DHinge>(None)?;
        world.attach(joint, Some(seat), Some(beam))?;
        let mut hanger = world.joint_mut::<DHinge>(joint)?;
        hanger.set_axis(Vec3::Y)?;
        hanger.set_anchor1(at(x - 0.8, 0.0, 0.95))?;
        hanger.set_anchor2(at(x, 0.0, 2.25))?;
        hangers.push(joint);
    }
    let swing = Swing { seat, hangers, tilt: 0.0, stretch: 0.0, span: [f64::INFINITY, f64::NEG_INFINITY] };
    Stage::new(world, 0.002, swing)
        .after(|swing, world| {
            let seat = body(world, swing.seat)?;
            swing.tilt = swing.tilt.max(seat.vector_to_world(Vec3::X).z.abs());
            let x = seat.position().x;
            swing.span = [swing.span[0].min(x), swing.span[1].max(x)];
            for hanger in &swing.hangers {
                let joint = world.joint::<DHinge>(*hanger)?;
                let length = (joint.anchor1() - joint.anchor2()).length();
                swing.stretch = swing.stretch.max((length - joint.distance()).abs());
            }
            Ok(())
        })
        .draw(|_, world, drawing| {
            drawing.rods(world, 0.025);
            for (x, side) in [(-0.9, -1.0), (-0.9, 1.0), (0.9, -1.0), (0.9, 1.0)] {
                drawing.rod(at(x, 0.0, 2.3), at(x, side * 0.7, 0.0), 0.05, Tint::FRAME);
            }
        })
        .check(|swing, _| {
            Ok(Findings::new()
                .at_most("tilted by (rad)", swing.tilt, 1e-3)
                .at_most("a hanger's length is off by (m)", swing.stretch, 1e-4)
                .at_least("swung to (m)", swing.span[1], 0.6))
        })
}
