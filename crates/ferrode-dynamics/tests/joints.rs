//! What joints do that the recordings don't show: closed-form motion, what is refused, and the quirks that are kept.

use ferrode_dynamics::*;
use ferrode_math::{Quat, Vec3};

const H: f64 = 0.01;

/// A world without gravity, and a body of 2 kg and unit inertia at the origin.
fn body() -> (World, BodyKey) {
    let mut world = World::new();
    let body = world.create_body();
    let mass = Mass::parameters(2.0, Vec3::ZERO, [1.0; 3], [0.0; 3]).unwrap();
    world.body_mut(body).unwrap().set_mass(&mass).unwrap();
    (world, body)
}

/// The body hinged to the world about z through its centre; `reverse` attaches it as (world, body).
fn hinge(reverse: bool) -> (World, BodyKey, JointKey) {
    let (mut world, body) = body();
    let joint = world.create_joint::<Hinge>(None).unwrap();
    let ends = if reverse { [None, Some(body)] } else { [Some(body), None] };
    world.attach(joint, ends[0], ends[1]).unwrap();
    let mut hinge = world.joint_mut::<Hinge>(joint).unwrap();
    hinge.set_anchor(Vec3::ZERO).unwrap();
    hinge.set_axis(Vec3::Z).unwrap();
    (world, body, joint)
}

fn slider() -> (World, BodyKey, JointKey) {
    let (mut world, body) = body();
    let joint = world.create_joint::<Slider>(None).unwrap();
    world.attach(joint, Some(body), None).unwrap();
    world.joint_mut::<Slider>(joint).unwrap().set_axis(Vec3::X).unwrap();
    (world, body, joint)
}

fn steps(world: &mut World, n: usize) {
    for _ in 0..n {
        world.step(Stepper::Direct, H).unwrap();
    }
}

fn near(x: f64, y: f64, tolerance: f64) {
    assert!((x - y).abs() <= tolerance, "{x} instead of {y}, off by {:e}", (x - y).abs());
}

// ---- motion ----

/// With torque T on inertia I the angular velocity grows by T/I h a step until it is the motor's, and stays there.
#[test]
fn a_motor_accelerates_by_its_torque_and_then_holds_its_velocity() {
    let (mut world, _, joint) = hinge(false);
    world.joint_mut::<Hinge>(joint).unwrap().set_motor(1.0, 5.0).unwrap();
    steps(&mut world, 10);
    near(world.joint::<Hinge>(joint).unwrap().angle_rate(), 5.0 * 10.0 * H, 1e-9);
    steps(&mut world, 90);
    near(world.joint::<Hinge>(joint).unwrap().angle_rate(), 1.0, 1e-9);
}

/// m g sin of a slope: here g along the axis, against a motor of less and of more force than the weight.
#[test]
fn a_linear_motor_carries_the_weight_or_slips() {
    for (force, acceleration) in [(15.0, 10.0 - 15.0 / 2.0), (25.0, 0.0)] {
        let (mut world, _, joint) = slider();
        world.set_gravity(Vec3::new(10.0, 0.0, 0.0)).unwrap();
        world.joint_mut::<Slider>(joint).unwrap().set_motor(0.0, force).unwrap();
        steps(&mut world, 50);
        let rate = world.joint::<Slider>(joint).unwrap().position_rate().unwrap();
        near(rate, acceleration * 50.0 * H, 1e-7);
    }
}

/// A stop returns the part `bounce` of the speed, in one step.
#[test]
fn a_stop_bounces() {
    for bounce in [0.25, 1.0] {
        let (mut world, body, joint) = slider();
        let mut slider = world.joint_mut::<Slider>(joint).unwrap();
        slider.set_limits(f64::NEG_INFINITY, 0.1).unwrap();
        slider.limit_motor_mut().set_bounce(bounce).unwrap();
        slider.limit_motor_mut().set_stop_softness(Softness { erp: 0.0, cfm: 0.0 }).unwrap();
        world.body_mut(body).unwrap().set_linear_velocity(Vec3::new(3.0, 0.0, 0.0)).unwrap();
        steps(&mut world, 10);
        let slider = world.joint::<Slider>(joint).unwrap();
        near(slider.position_rate().unwrap(), -3.0 * bounce, 1e-9);
        assert!(slider.position().unwrap() < 0.13);
    }
}

/// The spring of a suspension gives way by m g / kp, whatever the step size.
#[test]
fn a_suspension_sags_by_its_spring_constant() {
    for h in [0.002, 0.01, 0.02] {
        let (mut world, chassis) = body();
        world.set_gravity(Vec3::new(0.0, 0.0, -10.0)).unwrap();
        let wheel = world.create_body();
        world.body_mut(wheel).unwrap().set_kinematic();
        let joint = world.create_joint::<Hinge2>(None).unwrap();
        world.attach(joint, Some(chassis), Some(wheel)).unwrap();
        let mut hinge2 = world.joint_mut::<Hinge2>(joint).unwrap();
        hinge2.set_anchor(Vec3::ZERO).unwrap();
        hinge2.set_axes(Some(Vec3::Z), Some(Vec3::Y)).unwrap();
        hinge2.set_suspension(Softness::from_spring(200.0, 40.0, h).unwrap()).unwrap();
        for _ in 0..(5.0 / h) as usize {
            world.step(Stepper::Direct, h).unwrap();
        }
        near(world.body(chassis).unwrap().position().z, -2.0 * 10.0 / 200.0, 1e-6);
        // The travel is no error of the joint.
        let error = world.joint_error(joint).unwrap();
        assert!(error.position < 1e-9 && error.angle < 1e-9, "{error:?}");
    }
}

/// Equal stops lock an axis.
#[test]
fn equal_stops_lock() {
    let (mut world, body, joint) = hinge(false);
    world.joint_mut::<Hinge>(joint).unwrap().set_limits(0.0, 0.0).unwrap();
    for _ in 0..50 {
        world.body_mut(body).unwrap().add_torque(Vec3::new(0.0, 0.0, 7.0)).unwrap();
        steps(&mut world, 1);
    }
    near(world.joint::<Hinge>(joint).unwrap().angle(), 0.0, 1e-8);
}

/// Both steppers keep a joint together. A point on a circle leaves it by ½ a h² a step, of which ERP corrects a fifth; at
/// the bottom a = 2 g at most, so that 5 · ½ · 2 g h² is left.
#[test]
fn joints_hold_in_both_steppers() {
    let tolerance = 5.0 * 9.81 * H * H;
    for stepper in [Stepper::Direct, Stepper::Quick] {
        let (mut world, body) = body();
        world.set_gravity(Vec3::new(0.0, 0.0, -9.81)).unwrap();
        let joint = world.create_joint::<Universal>(None).unwrap();
        world.attach(joint, Some(body), None).unwrap();
        let mut universal = world.joint_mut::<Universal>(joint).unwrap();
        universal.set_anchor(Vec3::new(-0.5, 0.0, 0.0)).unwrap();
        universal.set_axis1(Vec3::X).unwrap();
        universal.set_axis2(Vec3::Y).unwrap();
        for _ in 0..300 {
            world.step(stepper, H).unwrap();
            let error = world.joint_error(joint).unwrap();
            assert!(error.position < tolerance && error.angle < tolerance, "{stepper:?} {error:?}");
        }
        assert!(world.body(body).unwrap().position().z.abs() > 0.01, "it swings");
    }
}

// ---- errors that are left ----

#[test]
fn a_joint_measures_how_far_its_bodies_are_off() {
    let (mut world, body, joint) = hinge(false);
    assert_eq!(world.joint_error(joint).unwrap(), JointError::default());
    let tilt = Quat::from_axis_angle(Vec3::X, 0.2);
    world.body_mut(body).unwrap().set_position(Vec3::new(0.3, 0.0, 0.4)).unwrap();
    world.body_mut(body).unwrap().set_quaternion(tilt).unwrap();
    let error = world.joint_error(joint).unwrap();
    near(error.position, 0.5, 1e-15);
    near(error.angle, 0.2, 1e-15);

    let (mut world, body) = self::body();
    let fixed = world.create_joint::<Fixed>(None).unwrap();
    world.attach(fixed, Some(body), None).unwrap();
    world.joint_mut::<Fixed>(fixed).unwrap().set_fixed();
    world.body_mut(body).unwrap().set_position(Vec3::new(0.0, -0.1, 0.0)).unwrap();
    world.body_mut(body).unwrap().set_quaternion(Quat::from_axis_angle(Vec3::Y, -2.5)).unwrap();
    let error = world.joint_error(fixed).unwrap();
    near(error.position, 0.1, 1e-15);
    near(error.angle, 2.5, 1e-14);

    // Along its axis a slider is free.
    let (mut world, body, joint) = slider();
    world.body_mut(body).unwrap().set_position(Vec3::new(9.0, 0.03, -0.04)).unwrap();
    near(world.joint_error(joint).unwrap().position, 0.05, 1e-15);
}

// ---- stops ----

/// ODE keeps the state of a stop that was removed while engaged, and writes a row that it has no room for.
#[test]
fn a_removed_stop_lets_go() {
    let (mut world, _, joint) = hinge(false);
    world.joint_mut::<Hinge>(joint).unwrap().set_limits(0.1, 0.5).unwrap();
    steps(&mut world, 1);
    assert_eq!(world.joint::<Hinge>(joint).unwrap().limit_motor().state(), LimitState::AtLow);
    near(world.joint::<Hinge>(joint).unwrap().limit_motor().excess(), -0.1, 1e-15);
    for (low, high) in [(f64::NEG_INFINITY, f64::INFINITY), (0.5, 0.1)] {
        world.joint_mut::<Hinge>(joint).unwrap().set_limits(low, high).unwrap();
        steps(&mut world, 1);
        let limit_motor = *world.joint::<Hinge>(joint).unwrap().limit_motor();
        assert_eq!((limit_motor.state(), limit_motor.excess()), (LimitState::Free, 0.0));
    }
}

/// ODE adds a motor's force as it is at a stop: an infinite one would leave no finite state.
#[test]
fn an_unlimited_motor_leaves_a_stop_and_rests_at_it() {
    for (velocity, rate) in [(0.5, 0.5), (-0.5, 0.0), (0.0, 0.0)] {
        let (mut world, body, joint) = slider();
        let mut slider = world.joint_mut::<Slider>(joint).unwrap();
        slider.set_limits(0.0, 1.0).unwrap();
        slider.set_motor(velocity, f64::INFINITY).unwrap();
        let report = world.step(Stepper::Direct, H).unwrap();
        assert!(report.quarantined.is_empty());
        // The world's CFM of 1e-10 gives way by 1e-8 m/s to the 100 N that this takes.
        near(world.body(body).unwrap().linear_velocity().x, rate, 2e-8);
    }
}

/// ODE takes an infinite stop on the wrong side for an infinite error.
#[test]
fn an_infinite_stop_is_none() {
    for (low, high) in [(f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY)] {
        let (mut world, body, joint) = slider();
        world.joint_mut::<Slider>(joint).unwrap().set_limits(low, high).unwrap();
        world.body_mut(body).unwrap().set_linear_velocity(Vec3::X).unwrap();
        assert!(world.step(Stepper::Direct, H).unwrap().quarantined.is_empty());
        near(world.body(body).unwrap().position().x, H, 1e-15);
    }
}

/// Angles wrap: a low stop of −4 is never reached, but the high one acts.
#[test]
fn a_stop_beyond_a_half_turn_does_not_switch_the_other_off() {
    let (mut world, body, joint) = hinge(false);
    world.joint_mut::<Hinge>(joint).unwrap().set_limits(-4.0, 0.2).unwrap();
    world.body_mut(body).unwrap().set_angular_velocity(Vec3::new(0.0, 0.0, 1.0)).unwrap();
    steps(&mut world, 100);
    assert!(world.joint::<Hinge>(joint).unwrap().angle() < 0.22);
}

// ---- kept quirks ----

/// Attached as (world, body), a hinge reports the opposite angle, but its stops and motor keep the joint's own sense.
#[test]
fn a_reversed_hinge_has_its_stops_the_other_way() {
    let (mut world, body, joint) = hinge(true);
    world.joint_mut::<Hinge>(joint).unwrap().set_limits(-0.1, 0.3).unwrap();
    world.body_mut(body).unwrap().set_angular_velocity(Vec3::new(0.0, 0.0, 2.0)).unwrap();
    // 0.02 rad are a step's way.
    let mut least: f64 = 0.0;
    for _ in 0..100 {
        steps(&mut world, 1);
        least = least.min(world.joint::<Hinge>(joint).unwrap().angle());
    }
    assert!((-0.32..-0.30).contains(&least), "{least}");
}

/// From aligned bodies `set_axis_offset` reads back the opposite of what was given.
#[test]
fn a_hinge_axis_offset_has_odes_sign() {
    for reverse in [false, true] {
        let (mut world, _, joint) = hinge(reverse);
        world.joint_mut::<Hinge>(joint).unwrap().set_axis_offset(Vec3::Z, 0.4).unwrap();
        near(world.joint::<Hinge>(joint).unwrap().angle(), -0.4, 1e-15);
    }
}

/// Joints copy the world's softness when they are created.
#[test]
fn softness_is_the_worlds_at_creation() {
    let mut world = World::new();
    world.set_erp(0.7).unwrap();
    world.set_cfm(0.03).unwrap();
    let ball = world.create_joint::<Ball>(None).unwrap();
    let hinge = world.create_joint::<Hinge>(None).unwrap();
    world.set_erp(0.1).unwrap();
    world.set_cfm(0.0).unwrap();
    let softness = Softness { erp: 0.7, cfm: 0.03 };
    assert_eq!(world.joint::<Ball>(ball).unwrap().softness(), softness);
    assert_eq!(world.joint::<Hinge>(hinge).unwrap().limit_motor().stop_softness(), softness);
    assert_eq!(world.joint::<Hinge>(hinge).unwrap().limit_motor().motor_cfm(), 0.03);
    world.joint_mut::<Ball>(ball).unwrap().set_softness(Softness { erp: 0.5, cfm: 0.25 }).unwrap();
    assert_eq!(world.joint_param(ball, Param::Erp, 1), Ok(0.5));
    assert_eq!(world.joint_param(ball, Param::Cfm, 1), Ok(0.25));
}

// ---- what is refused ----

#[test]
fn numbers_out_of_range_are_refused_and_change_nothing() {
    let (mut world, _, joint) = hinge(false);
    let before = *world.joint::<Hinge>(joint).unwrap().limit_motor();
    let mut hinge = world.joint_mut::<Hinge>(joint).unwrap();
    assert!(hinge.set_limits(f64::NAN, 1.0).is_err());
    assert!(hinge.set_limits(0.0, f64::NAN).is_err());
    assert!(hinge.set_motor(f64::INFINITY, 1.0).is_err());
    assert!(hinge.set_motor(1.0, -1.0).is_err());
    assert!(hinge.set_motor(1.0, f64::NAN).is_err());
    let limit_motor = hinge.limit_motor_mut();
    assert!(limit_motor.set_fudge_factor(1.5).is_err());
    assert!(limit_motor.set_bounce(f64::NAN).is_err());
    assert!(limit_motor.set_motor_cfm(f64::INFINITY).is_err());
    assert!(limit_motor.set_stop_softness(Softness { erp: f64::NAN, cfm: 0.0 }).is_err());
    assert_eq!(*limit_motor, before);
    assert!(matches!(hinge.set_axis(Vec3::ZERO), Err(Error::ZeroVector { what: "hinge axis", .. })));
    assert!(matches!(hinge.set_axis(Vec3::new(f64::NAN, 0.0, 0.0)), Err(Error::NotFinite { .. })));
    assert!(hinge.set_anchor(Vec3::new(0.0, f64::INFINITY, 0.0)).is_err());
    assert!(hinge.set_axis_offset(Vec3::X, f64::NAN).is_err());
    assert!(hinge.add_torque(f64::NAN).is_err());
    assert_eq!(hinge.as_ref().axis(), Vec3::Z);
}

#[test]
fn axes_with_limits_are_numbered_from_1() {
    let mut world = World::new();
    let joint = world.create_joint::<Universal>(None).unwrap();
    let mut universal = world.joint_mut::<Universal>(joint).unwrap();
    universal.set_limits_of(1, -1.0, 1.0).unwrap().set_motor_of(2, 3.0, 4.0).unwrap();
    for axis in [0, 3] {
        assert!(matches!(universal.set_limits_of(axis, 0.0, 0.0), Err(Error::OutOfRange { .. })));
        assert!(universal.as_ref().limit_motor_of(axis).is_err());
    }
    assert_eq!(world.joint_param(joint, Param::LoStop, 1), Ok(-1.0));
    assert_eq!(world.joint_param(joint, Param::FMax, 2), Ok(4.0));
    assert_eq!(world.joint_param(joint, Param::Vel, 2), Ok(3.0));
}

#[test]
fn limbo_answers_or_refuses_but_never_panics() {
    let mut world = World::new();
    let slider = world.create_joint::<Slider>(None).unwrap();
    assert!(matches!(world.joint::<Slider>(slider).unwrap().position(), Err(Error::NotAttached { .. })));
    assert!(matches!(world.joint::<Slider>(slider).unwrap().position_rate(), Err(Error::NotAttached { .. })));
    world.joint_mut::<Slider>(slider).unwrap().set_axis(Vec3::Y).unwrap();
    world.joint_mut::<Slider>(slider).unwrap().add_force(1.0).unwrap();

    let hinge2 = world.create_joint::<Hinge2>(None).unwrap();
    let mut joint = world.joint_mut::<Hinge2>(hinge2).unwrap();
    assert!(matches!(joint.set_axis1(Vec3::Z), Err(Error::NotAttached { .. })));
    assert!(matches!(joint.set_axes(None, None), Err(Error::WrongMode { .. })));
    joint.set_anchor(Vec3::X).unwrap();
    joint.add_torques(1.0, 2.0).unwrap();
    assert_eq!(joint.as_ref().angle1(), 0.0);

    let universal = world.create_joint::<Universal>(None).unwrap();
    let mut joint = world.joint_mut::<Universal>(universal).unwrap();
    joint.set_axis1_offset(Vec3::X, 0.1, 0.2).unwrap();
    assert_eq!(joint.as_ref().angles(), [0.0; 2]);
    for joint_type in JointType::ALL {
        let joint = world.create_joint_of_type(*joint_type, None).unwrap();
        world.joint_error(joint).unwrap();
    }
    steps(&mut world, 1);
}

/// ODE divides by zero for parallel axes; here the joint drives them apart, and all stays finite.
#[test]
fn parallel_axes_are_refused_or_driven_apart() {
    let (mut world, a) = body();
    let b = world.create_body();
    let joint = world.create_joint::<Hinge2>(None).unwrap();
    world.attach(joint, Some(a), Some(b)).unwrap();
    let mut hinge2 = world.joint_mut::<Hinge2>(joint).unwrap();
    let parallel = hinge2.set_axes(Some(Vec3::Z), Some(Vec3::new(0.0, 0.0, -2.0)));
    assert_eq!(parallel, Err(Error::ParallelAxes { what: "hinge-2 axes 1 and 2" }));
    hinge2.set_axes(Some(Vec3::Y), None).unwrap();
    hinge2.set_axes(None, Some(Vec3::X)).unwrap();
    near(hinge2.as_ref().angle1(), 0.0, 1e-15);

    let (mut world, body) = body();
    let joint = world.create_joint::<Universal>(None).unwrap();
    world.attach(joint, Some(body), None).unwrap();
    let mut universal = world.joint_mut::<Universal>(joint).unwrap();
    universal.set_axis1(Vec3::Y).unwrap();
    assert_eq!(
        universal.set_axis1_offset(Vec3::Y, 0.1, 0.0),
        Err(Error::ParallelAxes { what: "universal axes 1 and 2" })
    );
    steps(&mut world, 200);
    let universal = world.joint::<Universal>(joint).unwrap();
    near(universal.axis1().dot(universal.axis2()), 0.0, 1e-3);
}

#[test]
fn a_reversed_universal_has_no_first_offset() {
    let (mut world, body) = body();
    let joint = world.create_joint::<Universal>(None).unwrap();
    world.attach(joint, None, Some(body)).unwrap();
    let mut universal = world.joint_mut::<Universal>(joint).unwrap();
    assert!(matches!(universal.set_axis1_offset(Vec3::X, 0.1, 0.2), Err(Error::WrongMode { .. })));
    universal.set_axis1(Vec3::X).unwrap();
    universal.set_axis2_offset(Vec3::Y, 0.1, 0.2).unwrap();
    near(universal.as_ref().angle1(), 0.0, 1e-15);
    near(universal.as_ref().angle2(), 0.2, 1e-15);
}
