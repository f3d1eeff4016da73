//! A PU joint: a telescope whose tube slides, behind a cross of two axes.

use super::prelude::*;
use ferrode::PU;

pub(super) const DEMO: Demo = Demo {
    name: "pu",
    subject: Subject::Joints,
    about: "a telescope on a prismatic-universal joint pans, tilts and extends",
    property: "it reaches 0.4 rad, −0.3 rad and 0.3 m, to 2 mrad and 1 mm",
    seconds: 4.0,
    picture_at: 4.0,
    show: &[],
    camera: Camera::new([2.0, -2.8, 2.1], [0.75, 0.1, 0.95]),
    build,
};

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let post = add_box(&mut world, at(0.3, 0.3, 1.2), 1000.0, at(0.0, 0.0, 0.6))?;
    world.add_fixed(Some(post), None)?;
    let tube = add_capsule(&mut world, 0.1, 200.0, [at(0.35, 0.0, 1.3), at(1.55, 0.0, 1.3)])?;
    let joint = world.create_joint::<PU>(None)?;
    world.attach(joint, Some(tube), Some(post))?;
    let mut pu = world.joint_mut::<PU>(joint)?;
    pu.set_anchor(at(0.2, 0.0, 1.3))?;
    pu.set_axis1(Vec3::Z)?;
    pu.set_axis2(Vec3::Y)?;
    pu.set_axis_p(Vec3::X)?;
    Stage::new(world, 0.005, joint)
        .before(|joint, world| {
            let pu = world.joint::<PU>(*joint)?;
            let errors = [0.4 - pu.angle1(), -0.3 - pu.angle2(), 0.3 - pu.position()?];
            let mut pu = world.joint_mut::<PU>(*joint)?;
            for (i, error) in errors.into_iter().enumerate() {
                pu.set_motor_of(i + 1, (4.0 * error).clamp(-0.4, 0.4), 5000.0)?;
            }
            Ok(())
        })
        .draw(|joint, world, drawing| {
            if let (Ok(joint), Some((_, tube))) = (world.joint::<PU>(*joint), world.bodies().next()) {
                drawing.block(at(0.2, 0.2, 0.12), at(0.0, 0.0, 1.26), Tint::FRAME);
                drawing.rod(at(0.0, 0.0, 1.3), joint.anchor(), 0.05, Tint::FRAME);
                // The inner tube.
                drawing.rod(joint.anchor(), tube.position(), 0.06, Tint::FRAME);
            }
        })
        .check(|joint, world| {
            let pu = world.joint::<PU>(*joint)?;
            Ok(Findings::new()
                .at_most("pan is off by (rad)", (pu.angle1() - 0.4).abs(), 2e-3)
                .at_most("tilt is off by (rad)", (pu.angle2() + 0.3).abs(), 2e-3)
                .at_most("extension is off by (m)", (pu.position()? - 0.3).abs(), 1e-3))
        })
}
