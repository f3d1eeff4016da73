//! A four-bar linkage: a crank goes round and a rocker to and fro (Grashof's condition holds).

use super::prelude::*;
use ferrode::Hinge;
use ferrode_math::real;

/// Lengths of crank, coupler, rocker and ground, m.
const CRANK: f64 = 0.4;
const COUPLER: f64 = 1.1;
const ROCKER: f64 = 0.8;
const GROUND: f64 = 1.0;

pub(super) const DEMO: Demo = Demo {
    name: "four-bar",
    subject: Subject::Mechanisms,
    about: "a four-bar linkage turns rotation into rocking",
    property: "the rocker stands where the loop's closure puts it at every moment, to 0.2 mrad",
    seconds: 5.0,
    picture_at: 2.3,
    show: &[],
    camera: Camera::new([0.9, -3.0, 1.8], [0.45, 0.0, 0.98]),
    build,
};

/// Where coupler and rocker meet when the crank stands at an angle: the intersection of two circles, the upper one.
fn knuckle(angle: f64) -> Vec3 {
    let (sin, cos) = sin_cos(angle);
    let tip = at(CRANK * cos, 0.0, CRANK * sin);
    let to = at(GROUND, 0.0, 0.0) - tip;
    let d = to.length();
    let along = (COUPLER * COUPLER - ROCKER * ROCKER + d * d) / (2.0 * d);
    let across = (COUPLER * COUPLER - along * along).sqrt();
    let unit = to * (1.0 / d);
    tip + unit * along + at(-unit.z, 0.0, unit.x) * across
}

#[derive(Clone)]
struct Linkage {
    crank: BodyKey,
    rocker: BodyKey,
    coupler: BodyKey,
    motor: JointKey,
    off: f64,
    /// Of the middle of the coupler.
    trail: Trail,
}

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Direct)?;
    let base = at(0.0, 0.0, 1.0);
    let (tip, top, far) = (base + at(CRANK, 0.0, 0.0), base + knuckle(0.0), base + at(GROUND, 0.0, 0.0));
    let mut bar = |from: Vec3, to: Vec3, aside: f64| -> Result<BodyKey, Failure> {
        let shape = Cuboid::new(at(0.05, 0.03, (to - from).length() + 0.05))?;
        let builder = BodyBuilder::new()
            .at((from + to) * 0.5)
            .rotated(from_z_to(to - from))
            .with_shape_at(shape, 2000.0, Pose::from_position(at(0.0, aside, 0.0)))
            .with_mass(Mass::cuboid(2000.0, at(0.05, 0.03, (to - from).length()))?);
        let key = world.add_body(builder)?;
        for geom in world.body_geoms(key)?.to_vec() {
            world.set_geom_bits(geom, 0, 0)?;
        }
        Ok(key)
    };
    let crank = bar(base, tip, 0.0)?;
    let coupler = bar(tip, top, -0.05)?;
    let rocker = bar(far, top, 0.0)?;
    let motor = world.add_hinge(Some(crank), None, base, Vec3::Y)?;
    world.add_hinge(Some(coupler), Some(crank), tip, Vec3::Y)?;
    world.add_ball(Some(coupler), Some(rocker), top)?;
    world.add_hinge(Some(rocker), None, far, Vec3::Y)?;
    world.joint_mut::<Hinge>(motor)?.set_motor(-2.5, 1000.0)?;
    Stage::new(world, 0.002, Linkage { crank, rocker, coupler, motor, off: 0.0, trail: Trail::default() })
        .after(|linkage, world| {
            linkage.trail.follow(place(world, linkage.coupler)? - Vec3::Y * 0.08, 6);
            // About y, a positive angle turns x down: away from the angle of a drawing in x and z.
            let base = at(0.0, 0.0, 1.0);
            let arm = (place(world, linkage.crank)? - base) * 2.0;
            let expected = base + knuckle(real::atan2(arm.z, arm.x));
            let far = base + at(GROUND, 0.0, 0.0);
            let found = far + (place(world, linkage.rocker)? - far) * 2.0;
            linkage.off = linkage.off.max((found - expected).length() / ROCKER);
            Ok(())
        })
        .draw(|linkage, world, drawing| {
            drawing.floor = Some(0.0);
            for x in [0.0, GROUND] {
                drawing.block(at(0.1, 0.06, 1.03), at(x, 0.06, 0.515), Tint::FRAME);
            }
            for joint in world.joints() {
                let pin = world.joint::<Hinge>(joint).map(|hinge| hinge.anchor());
                let pin = pin.or_else(|_| world.joint::<ferrode::Ball>(joint).map(|ball| ball.anchor()));
                if let Ok(pin) = pin {
                    drawing.rod(pin - Vec3::Y * 0.08, pin + Vec3::Y * 0.06, 0.02, Tint::SPRING);
                }
            }
            drawing.path(&linkage.trail);
        })
        .check(|linkage, world| {
            let rate = world.joint::<Hinge>(linkage.motor)?.angle_rate();
            Ok(Findings::new()
                .near("crank (rad/s)", rate, -2.5, 1e-3)
                .at_most("the rocker is off by (rad)", linkage.off, 2e-4)
                .at_most("joints open by (m)", joint_errors(world)?.0, 1e-4))
        })
}
