//! What URDF files say comes out right, with fixed joints merged.

use std::path::Path;

use ferrode_math::Vec3;
use ferrode_scene::description::{Body, Geometry, JointId, JointKind, LinkId, Spring};
use ferrode_scene::{BuildOptions, LoadOptions, Loaded, WarningKind, build, load, load_str};

fn options() -> LoadOptions {
    LoadOptions { use_environment: false, ..LoadOptions::default() }
}

fn robot(options: &LoadOptions) -> Loaded {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/robot.urdf");
    load(path, options).unwrap_or_else(|error| panic!("{error}"))
}

fn close(a: Vec3, b: [f64; 3]) -> bool {
    (a - Vec3::from_array(b)).length() < 1e-12
}

#[test]
fn a_robot_keeps_its_names_with_fixed_joints_merged() {
    let Loaded { scene, warnings } = robot(&options());
    let names: Vec<&str> = scene.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(names, ["arm::base", "arm::forearm", "arm::left_finger", "arm::right_finger"]);
    let joints: Vec<&str> = scene.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(joints, ["arm::mount", "arm::elbow", "arm::left", "arm::right"]);
    let mut frames: Vec<&str> = scene.frames.iter().map(|frame| frame.name.as_str()).collect();
    frames.sort_unstable();
    assert_eq!(frames, ["arm::camera", "arm::plate"]);
    assert_eq!(scene.frame("camera").unwrap().attached_to, Body::Link(LinkId(1)));
    let ignored: Vec<&str> = warnings.iter().map(|warning| warning.message()).collect();
    assert_eq!(ignored, ["sensors ignored: 1", "plugins ignored: 1"]);
}

#[test]
fn merged_links_add_up() {
    let scene = robot(&options()).scene;
    let base = scene.link("base").unwrap();
    assert!(close(base.pose.position, [0.0, 0.0, 1.0]));
    let inertial = &base.inertial;
    assert!((inertial.mass - 4.0).abs() < 1e-12);
    assert!(close(inertial.pose.position, [0.0, 0.0, 0.225]));
    // Base: 3 kg, 0.125 from the common centre; plate: 1 kg, 0.375 from it, and turned by 90° about z.
    let expected = [0.02 + 3.0 * 0.015625 + 0.02 + 0.140625, 0.02 + 3.0 * 0.015625 + 0.01 + 0.140625, 0.06];
    for (axis, expected) in expected.into_iter().enumerate() {
        assert!((inertial.inertia.rows[axis][axis] - expected).abs() < 1e-12);
    }
    let collisions: Vec<&str> = base.collisions.iter().map(|collision| collision.name.as_str()).collect();
    assert_eq!(collisions, ["base_collision", "base_collision_1", "top"]);
    assert!(close(base.collisions[2].pose.position, [0.0, 0.1, 0.5]));
    assert!(close(base.collisions[1].pose.transform_vector(Vec3::Y), [0.0, 0.0, 1.0]));
    assert_eq!(base.collisions[1].geometry, Geometry::Cuboid { size: Vec3::new(0.1, 0.2, 0.3) });
    assert!((scene.moving_mass() - 4.7).abs() < 1e-12);
}

#[test]
fn joints_are_placed_along_the_tree() {
    let scene = robot(&options()).scene;
    let mount = scene.joint("mount").unwrap();
    assert_eq!((mount.kind, mount.parent), (JointKind::Fixed, Body::World));
    let elbow = scene.joint("elbow").unwrap();
    assert_eq!((elbow.parent, elbow.child), (Body::Link(LinkId(0)), Body::Link(LinkId(1))));
    assert!(close(elbow.pose.position, [0.0, 0.3, 1.5]));
    let axis = elbow.axis.as_ref().unwrap();
    assert!(close(axis.direction, [-1.0, 0.0, 0.0]));
    assert_eq!((axis.limits.lower, axis.limits.upper, axis.limits.effort), (-2.0, 1.0, Some(50.0)));
    assert_eq!((axis.damping, axis.friction), (0.4, 0.2));
    assert_eq!(axis.spring, Some(Spring { stiffness: 3.0, reference: 0.0 }));
    assert!(elbow.advanced.implicit_spring_damper);
    let mimic = scene.joint("right").unwrap().axis.as_ref().unwrap().mimic.unwrap();
    assert_eq!((mimic.leader, mimic.multiplier, mimic.offset), (JointId(2), 0.5, 0.01));
    assert_eq!(scene.joints[2].name, "arm::left");
}

#[test]
fn gazebo_elements_reach_collisions_and_links() {
    let scene = robot(&options()).scene;
    let finger = scene.link("left_finger").unwrap();
    assert!(finger.self_collide && !scene.link("right_finger").unwrap().self_collide);
    let collision = &finger.collisions[0];
    assert_eq!((collision.surface.friction.mu, collision.surface.friction.mu2), (0.9, 0.8));
    assert_eq!((collision.surface.contact.kp, collision.surface.contact.kd), (Some(1e6), Some(10.0)));
    assert_eq!(collision.max_contacts, Some(4));
}

#[test]
fn fixed_joints_can_be_kept() {
    // A link without mass at the end of a fixed joint is left out even so.
    let scene = robot(&LoadOptions { merge_fixed_joints: false, ..options() }).scene;
    let names: Vec<&str> = scene.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(names, ["arm::base", "arm::plate", "arm::forearm", "arm::left_finger", "arm::right_finger"]);
    assert_eq!(scene.joint("plate").map(|joint| joint.kind), Some(JointKind::Fixed));
    assert!((scene.moving_mass() - 4.7).abs() < 1e-12);
}

const PAIR: &str = "<robot name='r'>
  <link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>
  <link name='b'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>
  <joint name='b' type='TYPE'><parent link='a'/><child link='b'/><origin xyz='1 0 0'/></joint>
  EXTRA
</robot>";

fn pair(kind: &str, extra: &str) -> Loaded {
    let text = PAIR.replace("TYPE", kind).replace("EXTRA", extra);
    load_str("pair.urdf", &text, &options()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_file_may_keep_single_fixed_joints() {
    assert_eq!(pair("fixed", "").scene.joints.len(), 0);
    for tag in ["disableFixedJointLumping", "preserveFixedJoint"] {
        let loaded = pair("fixed", &format!("<gazebo reference='b'><{tag}>true</{tag}></gazebo>"));
        assert_eq!(loaded.scene.joints.len(), 1, "{tag}");
        assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    }
}

#[test]
fn a_joint_may_have_its_links_name() {
    let scene = pair("continuous", "").scene;
    assert!(close(scene.link("b").unwrap().pose.position, [1.0, 0.0, 0.0]));
    assert_eq!(scene.joint("b").unwrap().axis.as_ref().unwrap().limits.upper, f64::INFINITY);
}

#[test]
fn a_floating_joint_is_none() {
    let scene = pair("floating", "").scene;
    assert_eq!((scene.links.len(), scene.joints.len()), (2, 0));
    assert!(close(scene.link("b").unwrap().pose.position, [1.0, 0.0, 0.0]));
    assert_eq!(pair("planar", "").scene.joints[0].kind, JointKind::Planar);
}

#[test]
fn loops_can_be_closed_in_sdfs_terms() {
    let extra = "<gazebo><joint name='loop' type='ball'><parent>a</parent><child>b</child></joint></gazebo>";
    let scene = pair("continuous", extra).scene;
    assert_eq!(scene.joint("loop").unwrap().kind, JointKind::Ball);
}

#[test]
fn elements_that_are_not_understood_are_warnings() {
    let warnings = pair(
        "continuous",
        "<gazebo reference='a'><mu>3</mu></gazebo><gazebo reference='aa'><mu1>3</mu1></gazebo>",
    )
    .warnings;
    let lines: Vec<(WarningKind, Option<usize>)> = warnings.iter().map(|w| (w.kind(), w.line())).collect();
    assert_eq!(lines, [(WarningKind::NotUnderstood, Some(5)), (WarningKind::Suspicious, Some(5))]);
    assert!(warnings[0].to_string().contains("did you mean `mu1`?"), "{}", warnings[0]);
}

#[test]
fn a_link_without_mass_at_the_end_of_a_joint_is_left_out_with_a_warning() {
    let extra =
        "<link name='c'/><joint name='j' type='continuous'><parent link='b'/><child link='c'/></joint>";
    let loaded = pair("continuous", extra);
    assert_eq!((loaded.scene.links.len(), loaded.scene.joints.len()), (2, 1));
    assert!(loaded.warnings[0].message().contains("link `r::c` has no mass"), "{}", loaded.warnings[0]);
}

#[test]
fn a_planar_joint_keeps_its_link_in_the_plane() {
    // The plane's normal leans by 0.5 rad from the vertical: the link slides down in it.
    let text = "<robot name='r'><link name='world'/>
      <link name='sled'><inertial><origin xyz='0.1 0 0.05'/><mass value='2'/><inertia ixx='0.1' iyy='0.2' izz='0.3'/></inertial></link>
      <joint name='table' type='planar'><parent link='world'/><child link='sled'/><origin xyz='0 0 1' rpy='0.5 0 0'/>
      <axis xyz='0 0 1'/></joint></robot>";
    let scene = load_str("sled.urdf", text, &options()).unwrap_or_else(|error| panic!("{error}")).scene;
    let mut world = build(&scene, &BuildOptions { step: Some(0.01), ..BuildOptions::default() }).unwrap();
    assert!(world.warnings.is_empty(), "{:?}", world.warnings);
    let start = world.link("sled").unwrap().pose();
    let normal = start.transform_vector(Vec3::Z);
    // A push that would tip it over, and a turn in the plane.
    let body = world.link("sled").unwrap().body().unwrap();
    let body = world.world.body_mut(body).unwrap();
    body.set_angular_velocity(normal * 2.0 + Vec3::X * 0.5).unwrap();
    for _ in 0..100 {
        world.step().unwrap();
    }
    let pose = world.link("sled").unwrap().pose();
    let moved = pose.position - start.position;
    assert!(normal.dot(moved).abs() < 1e-3, "{}", normal.dot(moved));
    assert!((pose.transform_vector(Vec3::Z) - normal).length() < 1e-3);
    let table = world.joint("table").unwrap();
    assert!((table.velocity(0).unwrap() - 2.0).abs() < 0.01, "{:?}", table.velocity(0));
    assert!((table.position(0).unwrap() - 2.0).abs() < 0.02, "{:?}", table.position(0));
    // g sin 0.5 · t²/2 down the plane.
    let fallen = 0.5 * 9.8 * ferrode::math::real::sin(0.5);
    assert!((moved.length() - fallen).abs() < 0.15 * fallen, "{} {fallen}", moved.length());
}

#[test]
fn mimicking_what_cannot_move_is_a_warning() {
    let extra =
        "<link name='c'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>
      <joint name='j' type='continuous'><parent link='b'/><child link='c'/><mimic joint='b'/></joint>";
    let loaded = pair("fixed", extra);
    assert!(loaded.scene.joint("j").unwrap().axis.as_ref().unwrap().mimic.is_none());
    assert!(loaded.warnings[0].message().contains("`r::j` mimics nothing"), "{}", loaded.warnings[0]);
}

#[test]
fn a_robot_can_be_lifted_before_it_is_built() {
    let mut scene = pair("continuous", "").scene;
    let before = (scene.links[1].pose.position, scene.joints[0].pose.position);
    scene.translate_moving(Vec3::new(0.0, 0.0, 2.5));
    assert!(close(scene.links[1].pose.position - before.0, [0.0, 0.0, 2.5]));
    assert!(close(scene.joints[0].pose.position - before.1, [0.0, 0.0, 2.5]));
    assert!(close(scene.models[0].pose.position, [0.0, 0.0, 2.5]));
}
