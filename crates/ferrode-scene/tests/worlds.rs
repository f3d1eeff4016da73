//! Worlds of the Gazebo simulator and robots of the field load whole. `FERRODE_WORLDS` names the folder that holds
//! them; without it these tests say so and check nothing.

use std::path::PathBuf;

use ferrode::Stepper;
use ferrode_scene::description::{JointId, LinkId};
use ferrode_scene::{BuildOptions, LoadOptions, Loaded, NamedWorld, WarningKind, build, load};

fn worlds() -> Option<PathBuf> {
    let folder = std::env::var_os("FERRODE_WORLDS").map(PathBuf::from);
    if folder.is_none() {
        println!("FERRODE_WORLDS is not set: worlds and robots are not loaded");
    }
    folder
}

fn load_file(path: &str) -> Option<Loaded> {
    let path = worlds()?.join(path);
    Some(load(&path, &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}")))
}

/// Models, links, joints, collisions, and the mass that can move: counted and added up from the files by a script
/// that knows XML only.
const GAZEBO: &[(&str, usize, usize, usize, usize, f64)] = &[
    ("3k_shapes.sdf", 3004, 3004, 0, 3004, 6006.0),
    ("apply_joint_force.sdf", 2, 3, 1, 3, 120.6),
    ("diff_drive.sdf", 3, 9, 6, 9, 12.2879),
    ("nested_model.sdf", 3, 3, 0, 3, 2.0),
    ("pendulum_links.sdf", 2, 4, 2, 8, 345.3896),
    ("physics_options.sdf", 4, 4, 0, 4, 6.0),
    ("polylines.sdf", 5, 5, 0, 5, 4.0),
    ("rolling_shapes.sdf", 6, 6, 0, 6, 5.0),
    // Five links of 1 kg, and a cone of density 1: π 0.5² / 3.
    ("shapes.sdf", 7, 7, 0, 7, 5.0 + std::f64::consts::PI / 12.0),
    ("world_joint.sdf", 1, 1, 1, 1, 1.0),
];

#[test]
fn gazebo_worlds_have_all_their_parts() {
    for &(file, models, links, joints, collisions, mass) in GAZEBO {
        let Some(Loaded { scene, warnings }) = load_file(&format!("gazebo/{file}")) else { return };
        let found: usize = scene.links.iter().map(|link| link.collisions.len()).sum();
        assert_eq!(
            (scene.models.len(), scene.links.len(), scene.joints.len(), found),
            (models, links, joints, collisions),
            "{file}"
        );
        assert!((scene.moving_mass() - mass).abs() < 1e-9, "{file}: {}", scene.moving_mass());
        assert!(warnings.iter().all(|w| w.kind() == WarningKind::Ignored), "{file}: {warnings:?}");
    }
}

#[test]
fn anymal_is_a_quadruped_of_twelve_joints() {
    let Some(Loaded { scene, warnings }) = load_file("robots/anymal/anymal.urdf") else { return };
    // 18 links and 17 joints, of which 5 are fixed.
    assert_eq!((scene.links.len(), scene.joints.len()), (13, 12));
    assert!((scene.moving_mass() - 33.946674).abs() < 1e-9, "{}", scene.moving_mass());
    assert_eq!(scene.links.iter().map(|link| link.collisions.len()).sum::<usize>(), 18);
    for leg in ["LF", "RF", "LH", "RH"] {
        for joint in ["HAA", "HFE", "KFE"] {
            assert!(scene.joint(&format!("{leg}_{joint}")).is_some(), "{leg}_{joint}");
        }
    }
    // The file speaks of foot sensors that it has no links for: four times, beside as many empty elements.
    let refers =
        warnings.iter().filter(|warning| warning.message().contains("which is neither a link nor a joint"));
    assert_eq!(refers.count(), 4);
}

#[test]
fn atlas_is_a_humanoid_of_twenty_nine_joints() {
    let Some(Loaded { scene, warnings }) = load_file("robots/atlas/robot.urdf") else { return };
    // 44 links and 43 joints, of which 14 are fixed.
    assert_eq!((scene.links.len(), scene.joints.len()), (30, 29));
    assert!((scene.moving_mass() - 174.25031).abs() < 1e-9, "{}", scene.moving_mass());
    assert_eq!(scene.links.iter().map(|link| link.collisions.len()).sum::<usize>(), 77);
    assert!(warnings.iter().all(|warning| warning.kind() == WarningKind::Ignored), "{warnings:?}");
}

fn build_file(path: &str, options: &BuildOptions) -> Option<NamedWorld> {
    let loaded = load_file(path)?;
    Some(build(&loaded.scene, options).unwrap_or_else(|error| panic!("{path}: {error}")))
}

fn assert_sound(world: &NamedWorld, what: &str) {
    for (index, link) in world.scene.links.iter().enumerate() {
        let pose = world.link_pose(LinkId(index));
        assert!(pose.is_finite() && pose.position.length() < 1e3, "{what}: {} is at {pose:?}", link.name);
    }
    for (index, joint) in world.scene.joints.iter().enumerate() {
        if let Some(key) = world.joint_key(JointId(index)) {
            let error = world.world.joint_error(key).unwrap();
            assert!(error.position < 0.01 && error.angle < 0.02, "{what}: {}: {error:?}", joint.name);
        }
    }
}

#[test]
fn gazebo_worlds_run_with_both_steppers() {
    for &(file, ..) in GAZEBO {
        for stepper in [Stepper::Quick, Stepper::Direct] {
            let steps = if file == "3k_shapes.sdf" { 3 } else { 300 };
            let options = BuildOptions { stepper: Some(stepper), ..BuildOptions::default() };
            let Some(mut world) = build_file(&format!("gazebo/{file}"), &options) else { return };
            for _ in 0..steps {
                world.step().unwrap_or_else(|error| panic!("{file}: {error}"));
            }
            assert_sound(&world, file);
        }
    }
}

#[test]
fn shapes_at_rest_stay_at_rest() {
    let Some(mut world) = build_file("gazebo/shapes.sdf", &BuildOptions::default()) else { return };
    let known = ["box_link", "cylinder_link", "sphere_link", "capsule_link", "ellipsoid_link", "cone_link"];
    let before: Vec<_> = known.iter().map(|name| world.link(name).unwrap().pose().position).collect();
    for _ in 0..1000 {
        world.step().unwrap();
    }
    for (name, before) in known.iter().zip(before) {
        let moved = world.link(name).unwrap().pose().position - before;
        assert!(moved.length() < 5e-3, "{name} moved by {moved:?}");
    }
}

#[test]
fn robots_hang_together() {
    for path in ["robots/anymal/anymal.urdf", "robots/atlas/robot.urdf"] {
        for stepper in [Stepper::Direct, Stepper::Quick] {
            let options = BuildOptions { stepper: Some(stepper), ..BuildOptions::default() };
            let Some(mut world) = build_file(path, &options) else { return };
            let before = world.world.energy().total();
            for _ in 0..200 {
                world.step().unwrap();
            }
            assert_sound(&world, path);
            let after = world.world.energy().total();
            assert!(after < before + 1e-6 * before.abs(), "{path}: {before} J become {after} J");
            // Nothing holds it: its centre of mass falls as a stone does.
            // Semi-implicit Euler: v is g h n after n steps, and x the sum of h v.
            let fallen = 0.5 * 9.8 * world.step_size() * world.step_size() * 200.0 * 201.0;
            let mass: f64 = world.scene.moving_mass();
            let height = |pose_of: &dyn Fn(usize) -> f64| -> f64 {
                world
                    .scene
                    .links
                    .iter()
                    .enumerate()
                    .map(|(i, link)| link.inertial.mass * pose_of(i))
                    .sum::<f64>()
                    / mass
            };
            let start = height(&|i| {
                let link = &world.scene.links[i];
                (link.pose * link.inertial.pose).position.z
            });
            let now =
                height(&|i| (world.link_pose(LinkId(i)) * world.scene.links[i].inertial.pose).position.z);
            assert!((start - now - fallen).abs() < 1e-4, "{path}: fell {} instead of {fallen}", start - now);
        }
    }
}
