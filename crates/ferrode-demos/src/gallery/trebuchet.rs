//! A trebuchet: a falling weight throws a stone from a sling.

use super::prelude::*;
use ferrode::DBall;

const SHORT: f64 = 0.8;
const LONG: f64 = 3.0;
const SLING: f64 = 2.2;

pub(super) const DEMO: Demo = Demo {
    name: "trebuchet",
    subject: Subject::Mechanisms,
    about: "a falling weight throws a stone",
    property: "the stone flies at least ten metres far, on the parabola of its release, within 1 %; no energy is made",
    seconds: 6.0,
    picture_at: 0.7,
    show: &[],
    camera: Camera::new([-0.6, -9.6, 3.6], [-0.9, 0.0, 2.95]),
    build,
};

#[derive(Clone)]
struct Engine {
    stone: BodyKey,
    sling: Option<JointKey>,
    energy: f64,
    most: f64,
    /// Place, velocity and time at the release.
    release: Option<(Vec3, Vec3, f64)>,
    /// How far off the parabola so far, over the way flown.
    off: f64,
    landed: Option<f64>,
    trail: Trail,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let axle = at(0.0, 0.0, 2.6);
    for side in [-0.5, 0.5] {
        let post = add_wall(&mut world, at(0.2, 0.1, 2.6), Pose::from_position(at(0.0, side, 1.3)))?;
        world.set_geom_bits(post, 0, 0)?;
    }
    // The beam's long arm points back and down; the short one carries the weight.
    let lean = turn(Vec3::Y, -40.0);
    let ahead = lean.rotate(Vec3::X);
    let builder = BodyBuilder::new()
        .at(axle + ahead * (0.5 * (SHORT - LONG)))
        .rotated(lean)
        .with_shape(Cuboid::new(at(SHORT + LONG, 0.1, 0.1))?, 500.0);
    let beam = world.add_body(builder)?;
    world.add_hinge(Some(beam), None, axle, Vec3::Y)?;
    let (short, long) = (axle + ahead * SHORT, axle - ahead * LONG);
    let weight = add_box(&mut world, Vec3::splat(0.7), 1800.0, short + at(0.0, 0.0, -0.6))?;
    world.add_hinge(Some(weight), Some(beam), short, Vec3::Y)?;
    for key in [beam, weight] {
        for geom in world.body_geoms(key)?.to_vec() {
            world.set_geom_bits(geom, 0, 0)?;
        }
    }
    let stone = add_ball(
        &mut world,
        0.12,
        1500.0,
        at(long.x + (SLING * SLING - (long.z - 0.12) * (long.z - 0.12)).sqrt(), 0.0, 0.12),
    )?;
    let sling = world.create_joint::<DBall>(None)?;
    world.attach(sling, Some(stone), Some(beam))?;
    let from = place(&world, stone)?;
    let mut joint = world.joint_mut::<DBall>(sling)?;
    joint.set_anchor1(from)?;
    joint.set_anchor2(long)?;
    let energy = world.energy().total();
    let engine = Engine {
        stone,
        sling: Some(sling),
        energy,
        most: 0.0,
        release: None,
        off: 0.0,
        landed: None,
        trail: Trail::default(),
    };
    Stage::new(world, 0.001, engine)
        .after(|engine, world| {
            engine.most = engine.most.max(world.energy().total() - engine.energy);
            let (p, v) = {
                let stone = world.body(engine.stone)?;
                (stone.position(), stone.linear_velocity())
            };
            engine.trail.follow(p, 10);
            if let Some(sling) = engine.sling {
                // The sling opens when the stone flies ahead at 45° or flatter.
                if v.x > 4.0 && v.z < v.x && p.z > 2.0 {
                    world.destroy_joint(sling)?;
                    (engine.sling, engine.release) = (None, Some((p, v, world.time())));
                }
            } else if let Some((p0, v0, t0)) = engine.release
                && engine.landed.is_none()
            {
                let t = world.time() - t0;
                let parabola = p0 + v0 * t + at(0.0, 0.0, -0.5 * G * t * t);
                engine.off = engine.off.max((p - parabola).length() / (p - p0).length().max(1.0));
                if p.z < 0.13 {
                    engine.landed = Some(p.x);
                }
            }
            Ok(())
        })
        .draw(|engine, world, drawing| {
            drawing.rods(world, 0.02);
            drawing.rod(at(0.0, -0.55, 2.6), at(0.0, 0.55, 2.6), 0.06, Tint::FRAME);
            drawing.path(&engine.trail);
        })
        .check(|engine, _| {
            Ok(Findings::new()
                .at_least("the stone landed at (m)", engine.landed.unwrap_or(f64::NAN), 10.0)
                .at_most("off the parabola by (part)", engine.off, 0.01)
                .at_most("energy made (part)", engine.most / engine.energy, 0.01))
        })
}
