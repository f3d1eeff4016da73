//! The book's migration table has a row for every function of ODE's manual, and every method that it names exists.

use ferrode::collide::{Colliders, Geom, Item};
use ferrode::dynamics::{JointMut, JointRef, World};
use ferrode::math::rotation;
use ferrode::*;
use std::collections::BTreeSet;

const TABLE: &str = include_str!("../../../docs/book/migrating.md");
const MANUAL: &str = include_str!("data/manual_functions.txt");

/// The rows of the tables as (ODE's functions, what replaces them).
fn rows() -> Vec<(Vec<&'static str>, &'static str)> {
    let row = |line: &'static str| {
        let (left, right) = line.strip_prefix("| ")?.strip_suffix(" |")?.split_once(" | ")?;
        let names: Vec<_> = code(left).collect();
        names.iter().any(|name| name.starts_with('d')).then_some((names, right))
    };
    TABLE.lines().filter_map(row).collect()
}

/// What stands between backticks.
fn code(text: &'static str) -> impl Iterator<Item = &'static str> {
    text.split('`').skip(1).step_by(2)
}

#[test]
fn every_function_of_the_manual_has_a_row() {
    let rows = rows();
    let named: BTreeSet<_> = rows.iter().flat_map(|(names, _)| names).copied().collect();
    let wanted: Vec<_> = MANUAL.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(wanted.len() > 300, "the list is whole: {}", wanted.len());
    let missing: Vec<_> = wanted.iter().filter(|name| !named.contains(**name)).collect();
    assert!(missing.is_empty(), "functions without a row: {missing:?}");
    assert!(rows.iter().all(|(_, right)| !right.trim().is_empty()), "every row says what to call");
}

/// Notes the methods, and does not compile unless they exist.
macro_rules! exist {
    ($known:ident, $name:literal, $type:ty: $($method:ident),+ $(,)?) => {
        $(
            let _ = <$type>::$method;
            $known.insert(format!("{}::{}", $name, stringify!($method)));
        )+
    };
}

/// The methods that take an `impl Trait`, which can't be named without being called.
#[allow(dead_code)]
fn called(
    world: &mut ferrode::World,
    bodies: &mut World,
    c: &mut Colliders,
    key: GeomKey,
    body: BodyKey,
    s: SpaceKey,
) {
    let sphere = Sphere::new(1.0).unwrap();
    let _ = world.add_geom(body, sphere, Pose::IDENTITY);
    let _ = world.add_static(sphere, Pose::IDENTITY);
    let _ = bodies.create_joint::<Hinge>(None);
    let _ = (bodies.step(Stepper::Direct, 0.01), world.step(0.01));
    let _ = c.collide(s, |_: &Colliders, _: Item, _: Item| {});
    let _ = c.collide2(s, s, |_: &Colliders, _: Item, _: Item| {});
    let _ = c.contacts(key, key, CollideOptions::default(), &mut Vec::new());
    let _ = c.aabb(key);
    let _ = c.parent(key);
    let _ = c.set_parent(key, None);
    let _ = Convex::from_faces(&[], &[[0, 1, 2]]);
    let _ = world.ray_cast(Vec3::ZERO, Vec3::Z, 1.0, |_| true);
    let _ = c.ray_cast(s, Vec3::ZERO, Vec3::Z, 1.0, |_, _| true);
}

const CALLED: [&str; 13] = [
    "World::add_geom",
    "World::add_static",
    "World::create_joint",
    "World::step",
    "Colliders::collide",
    "Colliders::collide2",
    "Colliders::contacts",
    "Colliders::aabb",
    "Colliders::parent",
    "Colliders::set_parent",
    "Convex::from_faces",
    "World::ray_cast",
    "Colliders::ray_cast",
];

#[test]
fn every_method_that_the_table_names_exists() {
    let mut known: BTreeSet<String> = CALLED.map(String::from).into();
    exist!(known, "AMotorMode", AMotorMode: Euler, User);
    exist!(
        known, "Body", Body:
        add_force, add_force_at_position, add_force_at_relative_position, add_relative_force,
        add_relative_force_at_position, add_relative_force_at_relative_position, add_relative_torque,
        add_torque, angular_velocity, auto_disable, damping, disable, enable, finite_rotation_axis,
        finite_rotation_mode, force, gravity_mode, gyroscopic_mode, is_enabled, is_kinematic,
        joint_count, linear_velocity, mass, max_angular_speed, point_velocity, position,
        position_relative_point, quaternion, relative_point_position, relative_point_velocity, rotation,
        set_angular_velocity, set_auto_disable, set_damping, set_dynamic, set_finite_rotation_axis,
        set_finite_rotation_mode, set_force, set_gravity_mode, set_gyroscopic_mode, set_kinematic,
        set_linear_velocity, set_mass, set_max_angular_speed, set_moved_callback, set_position,
        set_quaternion, set_rotation, set_torque, set_user_data, torque, user_data, vector_from_world,
        vector_to_world
    );
    exist!(known, "Capsule", Capsule: new);
    exist!(
        known, "Colliders", Colliders:
        add_geom, add_space, cleanup, member_count, members, point_depth, remove_geom, remove_space,
        set_bits, set_body, set_cleanup, set_hash_levels, set_offset, set_pose, set_sublevel, sublevel
    );
    exist!(known, "Convex", Convex: from_points);
    exist!(known, "Cuboid", Cuboid: new);
    exist!(known, "Cylinder", Cylinder: new);
    exist!(
        known, "Geom", Geom:
        aabb, category_bits, collide_bits, is_enabled, pose
    );
    exist!(known, "Heightfield", Heightfield: new, with_bounds, wrapped);
    exist!(
        known, "JointMut<AMotor>", JointMut<AMotor>:
        add_torques, set_angle, set_axis, set_axis_count, set_limits_of, set_mode, set_motor_of
    );
    exist!(known, "JointMut<Ball>", JointMut<Ball>: set_anchor, set_anchor2);
    exist!(known, "JointMut<DBall>", JointMut<DBall>: set_anchor1, set_anchor2, set_distance);
    exist!(known, "JointMut<DHinge>", JointMut<DHinge>: set_anchor1, set_anchor2, set_axis);
    exist!(known, "JointMut<Fixed>", JointMut<Fixed>: set_fixed);
    exist!(
        known, "JointMut<Hinge2>", JointMut<Hinge2>:
        add_torques, set_anchor, set_axes, set_axis1, set_axis2, set_limits_of, set_motor_of,
        set_suspension
    );
    exist!(
        known, "JointMut<Hinge>", JointMut<Hinge>:
        add_torque, attach, set_anchor, set_anchor_delta, set_axis, set_axis_offset, set_limits,
        set_motor
    );
    exist!(known, "JointMut<LMotor>", JointMut<LMotor>: set_axis, set_axis_count, set_motor_of);
    exist!(
        known, "JointMut<PR>", JointMut<PR>:
        add_torque, set_anchor, set_axis1, set_axis2, set_limits_of, set_motor_of
    );
    exist!(
        known, "JointMut<PU>", JointMut<PU>:
        add_torques, set_anchor, set_anchor_delta, set_anchor_offset, set_axis1, set_axis2, set_axis_p,
        set_limits_of, set_motor_of
    );
    exist!(
        known, "JointMut<Piston>", JointMut<Piston>:
        add_force, set_anchor, set_anchor_offset, set_axis, set_axis_delta, set_limits_of, set_motor_of
    );
    exist!(known, "JointMut<Plane2D>", JointMut<Plane2D>: set_angle_param, set_x_param, set_y_param);
    exist!(
        known, "JointMut<Slider>", JointMut<Slider>:
        add_force, set_axis, set_axis_delta, set_limits, set_motor
    );
    exist!(
        known, "JointMut<Transmission>", JointMut<Transmission>:
        set_anchor1, set_anchor2, set_axis, set_axis1, set_axis2, set_backlash, set_mode, set_radius1,
        set_radius2, set_ratio
    );
    exist!(
        known, "JointMut<Universal>", JointMut<Universal>:
        add_torques, set_anchor, set_axis1, set_axis1_offset, set_axis2, set_axis2_offset,
        set_limits_of, set_motor_of
    );
    exist!(
        known, "JointRef<AMotor>", JointRef<AMotor>:
        angle, angle_rate, axis, axis_count, axis_frame, mode
    );
    exist!(known, "JointRef<Ball>", JointRef<Ball>: anchor, anchor2);
    exist!(known, "JointRef<DBall>", JointRef<DBall>: anchor1, anchor2, distance);
    exist!(
        known, "JointRef<DHinge>", JointRef<DHinge>:
        anchor1, anchor2, axis, distance
    );
    exist!(
        known, "JointRef<Hinge2>", JointRef<Hinge2>:
        anchor, anchor2, angle1, angle1_rate, angle2, angle2_rate, axis1, axis2
    );
    exist!(
        known, "JointRef<Hinge>", JointRef<Hinge>:
        anchor, anchor2, angle, angle_rate, axis
    );
    exist!(known, "JointRef<LMotor>", JointRef<LMotor>: axis, axis_count);
    exist!(
        known, "JointRef<PR>", JointRef<PR>:
        anchor, angle, angle_rate, axis1, axis2, position, position_rate
    );
    exist!(
        known, "JointRef<PU>", JointRef<PU>:
        anchor, angle1, angle1_rate, angle2, angle2_rate, angles, axis1, axis2, axis_p, position,
        position_rate
    );
    exist!(
        known, "JointRef<Piston>", JointRef<Piston>:
        anchor, anchor2, angle, angle_rate, axis, position, position_rate
    );
    exist!(known, "JointRef<Slider>", JointRef<Slider>: axis, position, position_rate);
    exist!(
        known, "JointRef<Transmission>", JointRef<Transmission>:
        anchor1, anchor2, angle1, angle2, axis, axis1, axis2, backlash, contact_point1, contact_point2,
        mode, radius1, radius2, ratio
    );
    exist!(
        known, "JointRef<Universal>", JointRef<Universal>:
        anchor, anchor2, angle1, angle1_rate, angle2, angle2_rate, angles, axis1, axis2
    );
    exist!(known, "JointType", JointType: Ball, Hinge);
    exist!(
        known, "LimitMotor", LimitMotor:
        set_bounce, set_fudge_factor, set_motor_cfm, set_stop_softness
    );
    exist!(
        known, "Mass", Mass:
        ZERO, adjust, capsule, capsule_total, check, cuboid, cuboid_total, cylinder, cylinder_total,
        parameters, rotate, sphere, sphere_total, translate, trimesh, trimesh_total
    );
    exist!(known, "Mat3", Mat3: IDENTITY);
    exist!(
        known, "Param", Param:
        Bounce, Cfm, Erp, FMax, FudgeFactor, HiStop, LoStop, StopCfm, StopErp, SuspensionCfm,
        SuspensionErp, Vel
    );
    exist!(known, "Plane", Plane: new);
    exist!(
        known, "Quat", Quat:
        IDENTITY, conjugate, derivative, from_axis_angle, from_matrix, to_matrix
    );
    exist!(known, "Ray", Ray: new, pose);
    let quadtree = SpaceKind::Quadtree { center: [0.0; 2], half_sides: [1.0; 2], depth: 1 };
    let _ = (SpaceKind::Simple, SpaceKind::HASH, quadtree, SpaceKind::SweepAndPrune);
    known.extend(["Simple", "HASH", "Quadtree", "SweepAndPrune"].map(|kind| format!("SpaceKind::{kind}")));
    exist!(known, "Sphere", Sphere: new);
    exist!(known, "Stepper", Stepper: Direct, Quick);
    exist!(
        known, "SurfaceMode", SurfaceMode:
        APPROX1, APPROX1_1, APPROX1_2, APPROX1_N, BOUNCE, FDIR1, MOTION1, MOTION2, MOTION_N, MU2,
        ROLLING, SLIP1, SLIP2, SOFT_CFM, SOFT_ERP
    );
    exist!(known, "TriMesh", TriMesh: new);
    exist!(known, "Vec3", Vec3: normalized);
    exist!(
        known, "World", World:
        are_connected, are_connected_excluding, attach, auto_disable, body_joints, cfm,
        connecting_joints, contact_max_correcting_velocity, contact_surface_layer, contains_body,
        create_body, create_contact, create_group, damping, destroy_body, destroy_group, destroy_joint,
        empty_group, erp, gravity, impulse_to_force, is_joint_enabled, joint_bodies, joint_feedback,
        joint_param, joint_type, joint_user_data, max_angular_speed, new, quick, random,
        set_auto_disable, set_body_auto_disable_defaults, set_body_auto_disable_flag,
        set_body_damping_defaults, set_cfm, set_contact_max_correcting_velocity,
        set_contact_surface_layer, set_damping, set_erp, set_gravity, set_joint_enabled,
        set_joint_feedback, set_joint_param, set_joint_user_data, set_max_angular_speed, set_quick,
        set_random
    );
    exist!(
        known, "World", ferrode::World:
        add_body, body_geoms, geom_info, remove_geom, set_geom_bits, set_geom_enabled, set_geom_pose,
        set_geom_user_data
    );
    exist!(known, "f64", f64: INFINITY);
    let _ = rotation::from_axis_and_angle;
    known.insert("rotation::from_axis_and_angle".into());
    let _ = rotation::from_euler_angles;
    known.insert("rotation::from_euler_angles".into());
    let _ = rotation::from_roll_pitch_yaw;
    known.insert("rotation::from_roll_pitch_yaw".into());
    let _ = rotation::from_two_axes;
    known.insert("rotation::from_two_axes".into());
    let _ = rotation::from_z_axis;
    known.insert("rotation::from_z_axis".into());
    let _ = rotation::orthogonalize;
    known.insert("rotation::orthogonalize".into());
    let _ = rotation::orthogonalize_as_ode;
    known.insert("rotation::orthogonalize_as_ode".into());
    let _ = rotation::plane_space;
    known.insert("rotation::plane_space".into());
    let mut count = 0;
    for (names, right) in rows() {
        for path in code(right).filter(|path| path.contains("::")) {
            assert!(known.contains(path), "{names:?}: {path} is not known to exist");
            count += 1;
        }
    }
    assert!(count > 250, "the table names methods: {count}");
}
