//! What SDF files say comes out as the specification means it.

use std::path::Path;

use ferrode_math::{Pose, Quat, Vec3};
use ferrode_scene::description::{
    Body, FrictionModel, Geometry, JointKind, LinkId, OdeSolver, Spring, StopSoftness,
};
use ferrode_scene::{LoadOptions, Loaded, Scene, WarningKind, load, load_str};

fn options() -> LoadOptions {
    LoadOptions { use_environment: false, ..LoadOptions::default() }
}

fn read(text: &str) -> Loaded {
    load_str("test.sdf", text, &options()).unwrap_or_else(|error| panic!("{error}"))
}

fn model(version: &str, inside: &str) -> Loaded {
    read(&format!("<sdf version='{version}'><model name='m'>{inside}</model></sdf>"))
}

#[track_caller]
fn assert_at(pose: &Pose, position: [f64; 3], yaw_degrees: f64) {
    let expected = Vec3::from_array(position);
    assert!((pose.position - expected).length() < 1e-12, "{:?} is not {expected:?}", pose.position);
    let half = 0.5 * yaw_degrees.to_radians();
    let rotation = Quat::from_axis_angle(Vec3::Z, 2.0 * half);
    assert!((pose.rotation.dot(rotation).abs() - 1.0).abs() < 1e-12, "{:?}", pose.rotation);
}

#[track_caller]
fn assert_direction(direction: Vec3, expected: [f64; 3]) {
    assert!((direction - Vec3::from_array(expected)).length() < 1e-12, "{direction:?} is not {expected:?}");
}

fn data(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn sink() -> Loaded {
    load(data("kitchen_sink.sdf"), &options()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_world_with_one_of_everything_has_its_parts() {
    let Loaded { scene, warnings } = sink();
    assert_eq!(scene.name.as_deref(), Some("sink"));
    let names = |names: Vec<&str>| names.join(" ");
    assert_eq!(names(scene.models.iter().map(|m| m.name.as_str()).collect()), "ground arm arm::hand shapes");
    assert_eq!(
        names(scene.links.iter().map(|l| l.name.as_str()).collect()),
        "ground::link arm::base arm::upper arm::hand::palm arm::hand::finger shapes::all"
    );
    assert_eq!(
        names(scene.joints.iter().map(|j| j.name.as_str()).collect()),
        "arm::shoulder arm::wrist arm::hand::grip tether"
    );
    assert_eq!(names(scene.frames.iter().map(|f| f.name.as_str()).collect()), "arm::foot table");
    let lines: Vec<(WarningKind, &str)> = warnings.iter().map(|w| (w.kind(), w.message())).collect();
    assert_eq!(
        lines,
        [
            (WarningKind::Ignored, "plugins ignored: 1"),
            (WarningKind::Ignored, "settings for other engines ignored: 2"),
            (WarningKind::Ignored, "sensors ignored: 1"),
        ]
    );
    assert!(scene.is_static(LinkId(0)) && !scene.is_static(LinkId(1)));
    assert_eq!(scene.link("palm").map(|link| link.model.0), Some(2));
}

#[test]
fn physics_settings_are_read() {
    let scene = sink().scene;
    assert_eq!(scene.gravity, Vec3::new(0.0, 0.0, -9.81));
    let physics = &scene.physics;
    assert_eq!((physics.engine.as_str(), physics.max_step_size, physics.max_contacts), ("ode", 0.002, 8));
    assert_eq!(physics.real_time_factor, 0.0);
    let ode = &physics.ode;
    assert_eq!((ode.solver, ode.iterations, ode.sor), (OdeSolver::World, 20, 1.1));
    assert_eq!((ode.cfm, ode.erp, ode.friction_model), (1e-6, 0.3, FrictionModel::Cone));
    assert_eq!((ode.contact_max_correcting_vel, ode.contact_surface_layer), (10.0, 0.002));
}

#[test]
fn poses_follow_frames_placement_and_joints() {
    let scene = sink().scene;
    let link = |name: &str| scene.link(name).expect(name).pose;
    assert_at(&scene.frame("table").unwrap().pose, [1.0, 2.0, 3.0], 90.0);
    // The foot is placed 1 above the table and turned by another 90°; the model stands 0.5 above its foot.
    assert_at(&scene.frame("foot").unwrap().pose, [1.0, 2.0, 4.0], 180.0);
    assert_at(&scene.model("arm").unwrap().pose, [1.0, 2.0, 4.5], 180.0);
    assert_at(&link("arm::base"), [1.0, 2.0, 4.5], 180.0);
    let shoulder = scene.joint("shoulder").unwrap();
    assert_at(&shoulder.pose, [1.0, 2.0, 5.0], 180.0);
    assert_at(&link("upper"), [1.0, 2.0, 5.25], 180.0);
    assert_at(&link("palm"), [1.0, 2.0, 5.5], 180.0);
    assert_at(&link("finger"), [0.9, 2.0, 5.5], 180.0);
    assert_at(&scene.joint("wrist").unwrap().pose, [1.0, 2.0, 5.5], 180.0);
    assert_at(&scene.joint("tether").unwrap().pose, [0.0, 0.0, 4.0], 0.0);
    assert_direction(shoulder.axis.as_ref().unwrap().direction, [0.0, -1.0, 0.0]);
    assert_direction(scene.joint("grip").unwrap().axis.as_ref().unwrap().direction, [-1.0, 0.0, 0.0]);
}

#[test]
fn joints_know_their_links_limits_and_dynamics() {
    let scene = sink().scene;
    let body = |name: &str| Body::Link(LinkId(scene.links.iter().position(|l| l.name == name).unwrap()));
    let shoulder = scene.joint("shoulder").unwrap();
    assert_eq!(
        (shoulder.kind, shoulder.parent, shoulder.child),
        (JointKind::Revolute, body("arm::base"), body("arm::upper"))
    );
    let axis = shoulder.axis.as_ref().unwrap();
    let limits = axis.limits;
    assert_eq!(
        (limits.lower, limits.upper, limits.effort, limits.velocity),
        (-1.5, 2.5, Some(30.0), Some(4.0))
    );
    assert_eq!((limits.stiffness, limits.dissipation), (1e5, 10.0));
    assert_eq!((axis.damping, axis.friction), (0.5, 0.25));
    assert_eq!(axis.spring, Some(Spring { stiffness: 7.0, reference: 0.1 }));
    assert_eq!(shoulder.advanced.stop, Some(StopSoftness { cfm: 0.1, erp: 0.6 }));
    assert!(shoulder.advanced.implicit_spring_damper);

    let wrist = scene.joint("wrist").unwrap();
    assert_eq!((wrist.kind, wrist.child), (JointKind::Universal, body("arm::hand::palm")));
    assert!(wrist.axis.is_some() && wrist.axis2.is_some());
    let grip = scene.joint("arm::hand::grip").unwrap().axis.as_ref().unwrap().limits;
    assert_eq!(
        (grip.lower, grip.upper, grip.effort, grip.velocity),
        (f64::NEG_INFINITY, f64::INFINITY, None, None)
    );
    let tether = scene.joint("tether").unwrap();
    assert_eq!((tether.kind, tether.parent, tether.model), (JointKind::Ball, Body::World, None));
}

#[test]
fn links_have_their_inertia_and_collisions_their_surface() {
    let scene = sink().scene;
    let base = scene.link("arm::base").unwrap();
    let (cube, ball) = (200.0, 4.0 / 3.0 * std::f64::consts::PI * 0.125 * 400.0);
    assert!((base.inertial.mass - (cube + ball)).abs() < 1e-9);
    let centre = 2.0 * ball / (cube + ball);
    assert!((base.inertial.pose.position - Vec3::new(0.0, 0.0, centre)).length() < 1e-12);
    let expected = cube / 6.0 + cube * centre * centre + 0.1 * ball + ball * (2.0 - centre) * (2.0 - centre);
    assert!((base.inertial.inertia.rows[0][0] - expected).abs() < 1e-9);
    assert!(base.self_collide);

    let upper = scene.link("upper").unwrap();
    assert_eq!(upper.inertial.mass, 2.0);
    assert_eq!(upper.inertial.inertia.rows, [[0.1, 0.01, 0.0], [0.01, 0.2, -0.02], [0.0, -0.02, 0.15]]);
    assert_eq!((upper.gravity, upper.linear_damping, upper.angular_damping), (false, 0.01, 0.02));
    let rod = &upper.collisions[0];
    assert_eq!(rod.geometry, Geometry::Capsule { radius: 0.05, length: 0.4 });
    assert_eq!(rod.max_contacts, Some(3));
    let friction = &rod.surface.friction;
    assert_eq!((friction.mu, friction.mu2, friction.slip1, friction.slip2), (0.5, 0.25, 0.1, 0.2));
    assert_eq!((friction.fdir1, friction.rolling), (Some(Vec3::Y), Some(0.03)));
    let torsional = friction.torsional.as_ref().unwrap();
    assert_eq!((torsional.coefficient, torsional.use_patch_radius, torsional.slip), (0.7, false, 0.5));
    assert_eq!((rod.surface.bounce.restitution, rod.surface.bounce.threshold), (0.4, 0.1));
    let contact = &rod.surface.contact;
    assert_eq!((contact.kp, contact.kd, contact.collide_bitmask), (Some(1e6), Some(100.0), 15));
    assert_eq!((contact.soft_cfm, contact.soft_erp), (Some(0.001), Some(0.4)));
    assert_eq!((contact.max_vel, contact.min_depth), (Some(0.5), Some(0.001)));

    let shapes = scene.link("all").unwrap();
    assert_eq!((shapes.inertial.mass, shapes.inertial.inertia.rows[2][2]), (1.0, 1.0));
    let kinds: Vec<&str> = shapes.collisions.iter().map(|c| c.geometry.kind()).collect();
    assert_eq!(kinds, ["cylinder", "ellipsoid", "cone", "polyline", "empty"]);
    let plane = &scene.link("ground::link").unwrap().collisions[0];
    assert_eq!(plane.geometry, Geometry::Plane { normal: Vec3::Z });
    assert_eq!(plane.surface.friction.mu, 1.0);
}

#[test]
fn defaults_are_those_of_the_specification() {
    let scene = read("<sdf version='1.7'><world name='w'/></sdf>").scene;
    assert_eq!(scene.gravity, Vec3::new(0.0, 0.0, -9.8));
    let physics = &scene.physics;
    assert_eq!((physics.max_step_size, physics.max_contacts), (0.001, 20));
    let ode = &physics.ode;
    assert_eq!(
        (ode.solver, ode.iterations, ode.sor, ode.cfm, ode.erp),
        (OdeSolver::Quick, 50, 1.3, 0.0, 0.2)
    );
    assert_eq!((ode.contact_max_correcting_vel, ode.contact_surface_layer), (100.0, 0.001));
    let link =
        &model("1.7", "<link name='l'><collision name='c'><geometry><box/></geometry></collision></link>")
            .scene
            .links[0];
    assert!(link.gravity && !link.self_collide && !link.kinematic);
    assert_eq!(link.collisions[0].geometry, Geometry::Cuboid { size: Vec3::splat(1.0) });
    assert_eq!(link.collisions[0].surface.contact.kp, None);
}

#[test]
fn gravity_stands_in_physics_in_old_files() {
    let text = "<sdf version='1.4'><world name='w'><physics type='ode'><gravity>0 0 -1.6</gravity></physics></world></sdf>";
    let loaded = read(text);
    assert_eq!(loaded.scene.gravity.z, -1.6);
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
}

#[test]
fn the_marked_physics_profile_counts() {
    let profile = |name: &str, default: &str, step: f64| {
        format!("<physics name='{name}' {default} type='ode'><max_step_size>{step}</max_step_size></physics>")
    };
    let world = |inside: String| read(&format!("<sdf version='1.7'><world name='w'>{inside}</world></sdf>"));
    let step = |inside: String| world(inside).scene.physics.max_step_size;
    let (a, b) = (profile("a", "", 0.01), profile("b", "", 0.02));
    let (c, d) = (profile("c", "default='1'", 0.03), profile("d", "default='true'", 0.04));
    assert_eq!(step(format!("{a}{b}")), 0.01);
    assert_eq!(step(format!("{a}{c}{d}")), 0.03);
}

#[test]
fn an_axis_is_in_the_joint_frame_but_in_old_files_in_the_models() {
    let joint = |version: &str, axis: &str| {
        let text = format!(
            "<link name='a'/><link name='b'><pose>0 0 0 0 0 1.5707963267948966</pose></link>
             <joint name='j' type='revolute'><parent>a</parent><child>b</child><axis>{axis}</axis></joint>"
        );
        model(version, &text).scene.joints[0].axis.as_ref().unwrap().direction
    };
    assert_direction(joint("1.4", "<xyz>1 0 0</xyz>"), [1.0, 0.0, 0.0]);
    assert_direction(joint("1.5", "<xyz>1 0 0</xyz>"), [0.0, 1.0, 0.0]);
    assert_direction(
        joint("1.6", "<xyz>1 0 0</xyz><use_parent_model_frame>1</use_parent_model_frame>"),
        [1.0, 0.0, 0.0],
    );
    assert_direction(joint("1.7", "<xyz expressed_in='a'>1 0 0</xyz>"), [1.0, 0.0, 0.0]);
    assert_direction(joint("1.7", ""), [0.0, 0.0, 1.0]);
}

#[test]
fn the_rotations_of_a_pose_are_about_fixed_axes() {
    // Roll by 90° takes y to z; yaw by 90° then takes x to y and leaves z.
    let loaded = model(
        "1.9",
        "<link name='l'><pose degrees='1'>0 0 0 90 0 90</pose></link><link name='q'><pose rotation_format='quat_xyzw'>1 2 3 0 0 2 2</pose></link>",
    );
    let pose = loaded.scene.links[0].pose;
    assert_direction(pose.transform_vector(Vec3::Y), [0.0, 0.0, 1.0]);
    assert_direction(pose.transform_vector(Vec3::X), [0.0, 1.0, 0.0]);
    assert_at(&loaded.scene.links[1].pose, [1.0, 2.0, 3.0], 90.0);
}

#[test]
fn frames_move_with_what_they_are_attached_to() {
    let scene = model(
        "1.7",
        "<link name='a'/><link name='b'><pose>1 0 0 0 0 0</pose></link>
         <frame name='own'/><frame name='on_b' attached_to='b'><pose>0 1 0 0 0 0</pose></frame>
         <frame name='far' attached_to='on_b'><pose relative_to='a'>5 0 0 0 0 0</pose></frame>
         <frame name='at_joint' attached_to='j'/>
         <joint name='j' type='fixed'><parent>a</parent><child>on_b</child></joint>",
    )
    .scene;
    let frame = |name: &str| scene.frame(name).unwrap();
    let (a, b) = (Body::Link(LinkId(0)), Body::Link(LinkId(1)));
    assert_eq!(frame("own").attached_to, a);
    assert_eq!((frame("on_b").attached_to, frame("far").attached_to), (b, b));
    assert_eq!(frame("at_joint").attached_to, b);
    assert_at(&frame("far").pose, [5.0, 0.0, 0.0], 0.0);
    // The joint sits at its child, which is a frame here.
    assert_at(&scene.joints[0].pose, [1.0, 1.0, 0.0], 0.0);
    assert_eq!(scene.joints[0].child, b);
}

#[test]
fn a_static_model_makes_those_in_it_static() {
    let text = "<static>true</static><link name='l'><inertial><mass>0</mass></inertial></link>
                <model name='n'><link name='k'/></model>";
    let scene = model("1.8", text).scene;
    assert!(scene.models[1].is_static && scene.is_static(LinkId(1)));
    assert_eq!(scene.moving_mass(), 0.0);
}

#[test]
fn screws_have_their_pitch_in_metres_per_turn() {
    let pitch = |version: &str, tag: &str| {
        let text = format!(
            "<link name='l'/><joint name='j' type='screw'><parent>world</parent><child>l</child><axis/>{tag}</joint>"
        );
        match model(version, &text).scene.joints[0].kind {
            JointKind::Screw { pitch } => pitch,
            other => panic!("{other:?}"),
        }
    };
    let turn = 2.0 * std::f64::consts::PI;
    assert_eq!(pitch("1.10", "<screw_thread_pitch>0.01</screw_thread_pitch>"), 0.01);
    // 100 rad/m, left-handed.
    assert!((pitch("1.6", "<thread_pitch>100</thread_pitch>") + turn / 100.0).abs() < 1e-15);
    assert_eq!(pitch("1.10", ""), 1.0);
    assert_eq!(pitch("1.6", ""), -turn);
}

#[test]
fn old_ways_to_write_no_limit_are_understood() {
    let text = "<link name='l'/><joint name='j' type='revolute'><parent>world</parent><child>l</child><axis><limit>
        <lower>-1e16</lower><upper>1e+16</upper><effort>-1</effort><velocity>-1</velocity></limit></axis></joint>
        <link name='k'/><joint name='i' type='revolute'><parent>world</parent><child>k</child><axis><limit>
        <lower>-inf</lower><upper>inf</upper><effort>0</effort></limit></axis></joint>";
    let scene = model("1.6", text).scene;
    let limits = |index: usize| scene.joints[index].axis.as_ref().unwrap().limits;
    assert_eq!((limits(0).lower, limits(0).upper), (f64::NEG_INFINITY, f64::INFINITY));
    assert_eq!((limits(0).effort, limits(0).velocity), (None, None));
    assert_eq!((limits(1).lower, limits(1).effort), (f64::NEG_INFINITY, Some(0.0)));
}

#[test]
fn what_is_not_understood_is_a_warning_and_under_strict_an_error() {
    let text = "<sdf version='1.7'><model name='m'>\n<link name='l'>\n<gravty>false</gravty>\n</link><plugin name='p' filename='f'/></model></sdf>";
    let loaded = read(text);
    let first = &loaded.warnings[0];
    assert_eq!(
        (first.kind(), first.line(), first.element()),
        (WarningKind::NotUnderstood, Some(3), Some("gravty"))
    );
    assert!(first.to_string().contains("did you mean `gravity`?"), "{first}");
    assert_eq!(loaded.warnings[1].message(), "plugins ignored: 1");
    let strict = LoadOptions { strict: true, ..options() };
    let error = load_str("test.sdf", text, &strict).expect_err("strict");
    assert_eq!((error.line(), error.element()), (Some(3), Some("gravty")));
    // A plugin alone is no reason.
    assert!(load_str("test.sdf", &text.replace("gravty", "gravity"), &strict).is_ok());
}

#[test]
fn what_cannot_be_followed_is_a_warning() {
    let warns = |inside: &str| -> Vec<String> {
        model("1.12", inside)
            .warnings
            .iter()
            .map(|w| format!("{}: {}", w.element().unwrap_or(""), w.message()))
            .collect()
    };
    assert_eq!(warns("<enable_wind>true</enable_wind><link name='l'/>"), ["enable_wind: wind has no effect"]);
    assert_eq!(warns("<enable_wind>false</enable_wind><link name='l'/>"), [""; 0]);
    assert_eq!(
        warns("<link name='l'><inertial><mass>1</mass><mass>2</mass></inertial></link>"),
        ["mass: <mass> is given twice in <inertial>: the first one counts"]
    );
    assert_eq!(
        warns("<link name='l' mass='3'/>"),
        ["link: attribute `mass` of <link> is not understood and has no effect"]
    );
    assert_eq!(
        warns("<link name='l'/><gz:thing><x/></gz:thing>"),
        [": elements of other tools (with a prefix) ignored: 1"]
    );
    assert_eq!(
        warns("<link name='l'><experimental:x/></link>"),
        ["experimental:x: <experimental:x> is not supported and has no effect"]
    );
    let mesh = "<link name='l'><collision name='c'><geometry><mesh><uri>model://no/x.stl</uri></mesh></geometry></collision></link>";
    assert!(warns(mesh)[0].starts_with("uri: the mesh has no file: `model://no/x.stl` is not found"));
}

#[test]
fn automatic_inertia_can_be_scaled_to_a_mass() {
    let link = |inertial: &str| {
        let text = format!(
            "<link name='l'>{inertial}<collision name='c'><geometry><box><size>1 2 3</size></box></geometry></collision></link>"
        );
        model("1.12", &text).scene.links[0].inertial.clone()
    };
    let water = link("<inertial auto='true'/>");
    assert!((water.mass - 6000.0).abs() < 1e-9);
    let light = link("<inertial auto='true'><mass>3</mass></inertial>");
    assert_eq!(light.mass, 3.0);
    assert!((light.inertia.rows[0][0] - 3.0 * 13.0 / 12.0).abs() < 1e-12);
    assert!((water.inertia.rows[0][0] - 6000.0 * 13.0 / 12.0).abs() < 1e-8);
}

fn include(scene: &str) -> Scene {
    let options = LoadOptions { model_paths: vec![data("models")], ..options() };
    let loaded = load(data(scene), &options).unwrap_or_else(|error| panic!("{error}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    loaded.scene
}

#[test]
fn included_models_are_named_placed_and_nested() {
    let scene = include("include.sdf");
    let names: Vec<&str> = scene.models.iter().map(|model| model.name.as_str()).collect();
    assert_eq!(names, ["cart", "cart::left", "cart::right", "spare"]);
    assert_at(&scene.model("cart").unwrap().pose, [10.0, 0.0, 0.0], 90.0);
    assert_at(&scene.link("cart::left::rim").unwrap().pose, [9.5, 0.0, 0.25], 90.0);
    assert_at(&scene.link("cart::right::rim").unwrap().pose, [10.5, 0.0, 0.25], 90.0);
    let axle = scene.joint("cart::right_axle").unwrap();
    assert_at(&axle.pose, [10.5, 0.0, 0.25], 90.0);
    assert_direction(axle.axis.as_ref().unwrap().direction, [-1.0, 0.0, 0.0]);
    assert!(scene.model("spare").unwrap().is_static);
}

#[test]
fn merged_models_bring_their_links_into_the_one_around() {
    let scene = include("merge.sdf");
    assert_eq!(scene.models.len(), 1);
    // The wheel's own frame lies 0.25 below its rim; the rim is what the include places.
    assert_at(&scene.link("m::rim").unwrap().pose, [0.0, 3.0, 2.0], 0.0);
    assert_at(&scene.frame("m::ground").unwrap().pose, [0.0, 3.0, 1.75], 0.0);
    assert_eq!(scene.joints.len(), 1);
    assert!(scene.frames.iter().all(|frame| !frame.name.contains("_merged_")));
}

#[test]
fn errors_in_included_files_are_placed_in_them() {
    let options = LoadOptions { model_paths: vec![data("models")], ..options() };
    let world = |name: &str| {
        let text = format!(
            "<sdf version='1.8'><world name='w'>\n<include><uri>model://{name}</uri></include></world></sdf>"
        );
        load_str("world.sdf", &text, &options).expect_err(name)
    };
    let broken = world("broken");
    assert!(broken.file().unwrap().ends_with("broken.sdf"), "{broken}");
    assert_eq!(broken.line(), Some(3));
    let itself = world("itself");
    assert!(itself.message().contains("includes itself"), "{itself}");
    assert_eq!(itself.line(), Some(4));
}

#[test]
fn a_file_that_is_not_there_is_an_error() {
    let error = load(data("nothing.sdf"), &options()).expect_err("nothing");
    assert!(error.message().contains("cannot be read") && error.file().unwrap().ends_with("nothing.sdf"));
    let error = load(data("models"), &options()).expect_err("a folder");
    assert!(error.message().contains("cannot be read"), "{error}");
}

/// Makes a binary STL file of the box in `box.obj`, and says where it is.
fn binary_stl() -> std::path::PathBuf {
    let text = std::fs::read_to_string(data("meshes").join("box.obj")).unwrap();
    let words = |kind: &str| -> Vec<Vec<f32>> {
        let lines = text.lines().filter_map(|line| line.strip_prefix(kind));
        lines.map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect()).collect()
    };
    let (corners, faces) = (words("v "), words("f "));
    let mut bytes = vec![b' '; 80];
    bytes.extend((faces.len() as u32).to_le_bytes());
    for face in faces {
        bytes.extend([0; 12]);
        for corner in face {
            bytes.extend(corners[corner as usize - 1].iter().flat_map(|x| x.to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("box.stl");
    std::fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn meshes_are_read_scaled_and_weighed() {
    let stl = binary_stl();
    let mesh = |file: &str, more: &str, auto: &str| {
        let uri = if file == "box.stl" { stl.clone() } else { data("meshes").join(file) };
        let text = format!(
            "<sdf version='1.12'><model name='m'><link name='l'><inertial auto='{auto}'/><collision name='c'><geometry><mesh>
             <uri>{}</uri>{more}</mesh></geometry></collision></link></model></sdf>",
            uri.display()
        );
        read(&text)
    };
    // A box of 1 × 2 × 3 with a corner at the origin, as binary and ASCII STL, OBJ and COLLADA (in centimetres).
    for file in ["box.stl", "box_ascii.stl", "box.obj", "box.dae"] {
        let loaded = mesh(file, "", "true");
        assert!(loaded.warnings.is_empty(), "{file}: {:?}", loaded.warnings);
        let link = &loaded.scene.links[0];
        let inertial = &link.inertial;
        assert!((inertial.mass - 6000.0).abs() < 1e-3, "{file}: {}", inertial.mass);
        assert!((inertial.pose.position - Vec3::new(0.5, 1.0, 1.5)).length() < 1e-6, "{file}");
        assert!((inertial.inertia.rows[0][0] - 6000.0 * 13.0 / 12.0).abs() < 1e-2, "{file}");
        let triangles = link.collisions[0].geometry.triangles().unwrap().unwrap();
        assert_eq!(triangles.triangles.len(), 12, "{file}");
    }
    // Mirrored and twice as long: still right side out.
    let loaded = mesh("box.stl", "<scale>-1 2 1</scale>", "true");
    let inertial = &loaded.scene.links[0].inertial;
    assert!((inertial.mass - 12_000.0).abs() < 1e-2, "{}", inertial.mass);
    assert!((inertial.pose.position - Vec3::new(-0.5, 2.0, 1.5)).length() < 1e-6);
    let geometry = &mesh("box.obj", "<submesh><name>lid</name></submesh>", "false").scene.links[0].collisions
        [0]
    .geometry;
    let error = geometry.triangles().unwrap().unwrap_err();
    assert!(error.contains("has no part `lid`"), "{error}");
}

#[test]
fn an_open_mesh_has_no_automatic_inertia() {
    let uri = data("meshes").join("open.obj");
    let text = format!(
        "<sdf version='1.12'><model name='m'><link name='l'>\n<inertial auto='true'/><collision name='c'><geometry><mesh>
         <uri>{}</uri></mesh></geometry></collision></link></model></sdf>",
        uri.display()
    );
    let error = load_str("t", &text, &options()).expect_err("open");
    assert!(error.message().contains("no collision gives it a volume"), "{error}");
    assert_eq!(error.line(), Some(2));
}

/// Pseudo-random numbers by linear congruence: the same trees in every run.
struct Dice(u32);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as usize % n
    }

    fn number(&mut self) -> f64 {
        self.below(2001) as f64 / 1000.0 - 1.0
    }
}

/// Links, frames and joints that are relative to one another in any order, also through nested models: each pose is the
/// product along its chain.
#[test]
fn poses_are_products_along_their_chains() {
    let mut dice = Dice(7);
    for _ in 0..50 {
        let mut items: Vec<String> = Vec::new();
        // Name as the outer model sees it, and pose in the outer model's frame.
        let mut known: Vec<(String, Pose)> = vec![("__model__".to_owned(), Pose::IDENTITY)];
        for index in 0..12 {
            let (base, base_pose) = known[dice.below(known.len())].clone();
            let [x, y, z, roll, pitch, yaw] = [(); 6].map(|()| dice.number());
            let turn = |axis, angle| Quat::from_axis_angle(axis, angle);
            let rotation = turn(Vec3::Z, yaw) * turn(Vec3::Y, pitch) * turn(Vec3::X, roll);
            let own = base_pose * Pose::new(Vec3::new(x, y, z), rotation);
            let pose = format!("<pose relative_to='{base}'>{x} {y} {z} {roll} {pitch} {yaw}</pose>");
            match dice.below(3) {
                0 => items.push(format!("<link name='n{index}'>{pose}</link>")),
                1 => items.push(format!("<frame name='n{index}'>{pose}</frame>")),
                _ => {
                    // A model placed by a link in it, which stands off the model's own frame.
                    items.push(format!(
                        "<model name='n{index}' placement_frame='in'>{pose}<link name='in'><pose>{y} {z} {x} 0 0 {roll}</pose></link></model>"
                    ));
                    let inner = Pose::new(Vec3::new(y, z, x), turn(Vec3::Z, roll));
                    known.push((format!("n{index}::in"), own));
                    known.push((format!("n{index}"), own * inner.inverse()));
                    continue;
                }
            }
            known.push((format!("n{index}"), own));
        }
        // The order of the file does not matter.
        for index in (1..items.len()).rev() {
            items.swap(index, dice.below(index + 1));
        }
        let scene = model("1.9", &format!("<link name='base'/>{}", items.concat())).scene;
        for (name, pose) in known.iter().skip(1) {
            let full = format!("m::{name}");
            let found = scene
                .link(&full)
                .map(|link| link.pose)
                .or_else(|| scene.frame(&full).map(|frame| frame.pose))
                .or_else(|| scene.model(&full).map(|model| model.pose))
                .unwrap_or_else(|| panic!("{full}"));
            assert!((found.position - pose.position).length() < 1e-12, "{full}");
            assert!((found.rotation.dot(pose.rotation).abs() - 1.0).abs() < 1e-12, "{full}");
        }
    }
}
