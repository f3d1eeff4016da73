//! A four-legged robot from a URDF file stands, each joint held by a motor with a spring's law.

use super::prelude::*;
use ferrode_scene::{BuildOptions, LoadOptions, build as build_scene, load_str};

const H: f64 = 0.001;
/// Stiffness, N m/rad, and damping, N m s/rad.
const GAINS: [f64; 2] = [300.0, 8.0];

pub(super) const DEMO: Demo = Demo {
    name: "robot",
    subject: Subject::Creatures,
    about: "a four-legged robot, read from URDF, is dropped and stands",
    property: "its base is level to 1°, at rest, and its joints open by under 0.1 mm",
    seconds: 3.0,
    picture_at: 3.0,
    show: &[],
    camera: Camera::new([0.9, -1.15, 0.7], [0.02, 0.0, 0.22]),
    build,
};

fn build() -> Result<Play, Failure> {
    let text = include_str!("../../robots/quadruped.urdf");
    let mut loaded = load_str("quadruped.urdf", text, &LoadOptions::default())?;
    loaded.scene.translate_moving(at(0.0, 0.0, 0.48));
    let options = BuildOptions { step: Some(H), stepper: Some(Stepper::Direct), ..BuildOptions::default() };
    let named = build_scene(&loaded.scene, &options)?;
    let refused = |what: &str| Failure::Refused(what.to_owned());
    let base = named.link("base").and_then(|link| named.link_body(link.id()));
    let base = base.ok_or_else(|| refused("the robot has no base"))?;
    let mut world = named.world;
    world.set_gravity(Vec3::new(0.0, 0.0, -G))?;
    world.stepper = Stepper::Direct;
    let floor = world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    world.set_material(floor, Material::with_friction(1.0))?;
    let hinges: Vec<JointKey> = world.joints().collect();
    for joint in &hinges {
        // Both stops where it starts: a spring with a damper, solved along with everything else.
        let mut hinge = world.joint_mut::<ferrode::Hinge>(*joint)?;
        let angle = hinge.as_ref().angle();
        hinge.set_limits(angle, angle)?;
        hinge.limit_motor_mut().set_stop_softness(spring(GAINS[0], GAINS[1], H)?)?;
    }
    Stage::new(world, H, base).check(|base, world| {
        let base = body(world, *base)?;
        let tilt = ferrode_math::real::acos(base.vector_to_world(Vec3::Z).z.min(1.0)).to_degrees();
        Ok(Findings::new()
            .at_most("tilt (degrees)", tilt, 1.0)
            .at_least("height (m)", base.position().z, 0.35)
            .at_most("speed (m/s)", fastest(world), 1e-3)
            .at_most("joints open by (m)", joint_errors(world)?.0, 1e-4))
    })
}
