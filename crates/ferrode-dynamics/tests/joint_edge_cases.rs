//! What joints do where ODE has undefined memory, divides by zero or asserts: errors, or finite motion.

use ferrode_dynamics::{
    AMotor, AMotorMode, AxisFrame, BodyKey, DBall, DHinge, Error, JointData, JointKey, LMotor, PR, PU, Param,
    Piston, Stepper, Transmission, TransmissionMode, World,
};
use ferrode_math::{Quat, Vec3};

const STEPPERS: [Stepper; 2] = [Stepper::Direct, Stepper::Quick];

/// Two bodies side by side along x, turning and moving, in no gravity, and a joint of a type between them.
fn pair<J: JointData>() -> Result<(World, [BodyKey; 2], JointKey), Error> {
    let mut world = World::new();
    let bodies = [world.create_body(), world.create_body()];
    for (i, body) in bodies.into_iter().enumerate() {
        let x = i as f64;
        let body = world.body_mut(body)?;
        body.set_position(Vec3::new(x, 0.1 * x, 0.0))?;
        body.set_linear_velocity(Vec3::new(0.2, -0.1 * x, 0.3))?;
        body.set_angular_velocity(Vec3::new(0.5 - x, 0.7, -0.2 * x))?;
    }
    let joint = world.create_joint::<J>(None)?;
    world.attach(joint, Some(bodies[0]), Some(bodies[1]))?;
    Ok((world, bodies, joint))
}

/// Steps a copy of the world with each stepper, and expects that no body had to be taken out.
fn stays_finite(world: &World, steps: usize) -> Result<(), Error> {
    for stepper in STEPPERS {
        let mut world = world.clone();
        for _ in 0..steps {
            let report = world.step(stepper, 0.01)?;
            assert_eq!(report.quarantined, [], "{stepper:?}");
        }
        for (key, body) in world.bodies() {
            assert!(body.position().is_finite() && body.angular_velocity().is_finite(), "{stepper:?} {key}");
            assert!(
                body.linear_velocity().length() < 10.0,
                "{stepper:?} {key}: {:?}",
                body.linear_velocity()
            );
        }
    }
    Ok(())
}

#[test]
fn double_hinge_without_an_axis_is_a_double_ball() -> Result<(), Error> {
    let (mut hinge, [a, _], _) = pair::<DHinge>()?;
    stays_finite(&hinge, 100)?;
    let (mut ball, [b, _], _) = pair::<DBall>()?;
    for _ in 0..50 {
        hinge.step(Stepper::Direct, 0.01)?;
        ball.step(Stepper::Direct, 0.01)?;
    }
    assert_eq!(hinge.body(a)?.pose(), ball.body(b)?.pose());
    Ok(())
}

#[test]
fn euler_motor_passes_its_singularity() -> Result<(), Error> {
    let (mut world, bodies, joint) = pair::<AMotor>()?;
    // No axes at all, with motors on: nothing to act about.
    world.joint_mut::<AMotor>(joint)?.set_mode(AMotorMode::Euler);
    for axis in 1..=3 {
        world.joint_mut::<AMotor>(joint)?.set_motor_of(axis, 0.3, 5.0)?;
    }
    stays_finite(&world, 10)?;
    // Axes 0 and 2 parallel: there is no direction across both.
    world.joint_mut::<AMotor>(joint)?.set_axis(0, AxisFrame::First, Vec3::X)?;
    world.joint_mut::<AMotor>(joint)?.set_axis(2, AxisFrame::Second, Vec3::Z)?;
    let turned = Quat::from_axis_angle(Vec3::Y, core::f64::consts::FRAC_PI_2);
    world.body_mut(bodies[1])?.set_quaternion(turned)?;
    for axis in 1..=3 {
        world.joint_mut::<AMotor>(joint)?.set_limits_of(axis, -0.1, 0.1)?;
    }
    stays_finite(&world, 100)
}

#[test]
fn motors_without_axes_do_nothing() -> Result<(), Error> {
    let (mut world, bodies, joint) = pair::<LMotor>()?;
    world.set_cfm(0.0)?;
    world.joint_mut::<LMotor>(joint)?.set_axis_count(3);
    for group in 1..=3 {
        world.set_joint_param(joint, Param::FMax, group, 5.0)?;
        world.set_joint_param(joint, Param::Cfm, group, 0.0)?;
    }
    stays_finite(&world, 10)?;
    let v = world.body(bodies[0])?.linear_velocity();
    world.step(Stepper::Direct, 0.01)?;
    assert_eq!(world.body(bodies[0])?.linear_velocity(), v);
    Ok(())
}

#[test]
fn transmission_survives_impossible_layouts() -> Result<(), Error> {
    for mode in
        [TransmissionMode::ParallelAxes, TransmissionMode::IntersectingAxes, TransmissionMode::ChainDrive]
    {
        let (mut world, bodies, joint) = pair::<Transmission>()?;
        world.joint_mut::<Transmission>(joint)?.set_mode(mode);
        // As created: parallel axes, wheels without radii.
        stays_finite(&world, 10)?;
        // Both wheels at the same point.
        world.joint_mut::<Transmission>(joint)?.set_anchor1(Vec3::ZERO)?;
        world.joint_mut::<Transmission>(joint)?.set_anchor2(Vec3::ZERO)?;
        for body in bodies {
            world.body_mut(body)?.set_angular_velocity(Vec3::ZERO)?;
        }
        stays_finite(&world, 10)?;
    }
    Ok(())
}

/// A pair of gears on fixed axles along z, the first driven at 3 rad/s.
fn gears() -> Result<(World, JointKey), Error> {
    let (mut world, bodies, joint) = pair::<Transmission>()?;
    world.attach(joint, None, None)?;
    for (i, body) in bodies.into_iter().enumerate() {
        world.body_mut(body)?.set_position(Vec3::new(3.0 * i as f64, 0.0, 0.0))?;
        world.body_mut(body)?.set_linear_velocity(Vec3::ZERO)?;
        world.body_mut(body)?.set_angular_velocity(Vec3::ZERO)?;
        let axle = world.create_joint::<ferrode_dynamics::Hinge>(None)?;
        world.attach(axle, Some(body), None)?;
        world.joint_mut::<ferrode_dynamics::Hinge>(axle)?.set_axis(Vec3::Z)?;
        if i == 0 {
            world.joint_mut::<ferrode_dynamics::Hinge>(axle)?.set_motor(3.0, 1e3)?;
        }
    }
    world.attach(joint, Some(bodies[0]), Some(bodies[1]))?;
    let mut gear = world.joint_mut::<Transmission>(joint)?;
    gear.set_axis(Vec3::Z)?;
    gear.set_anchor1(Vec3::ZERO)?;
    gear.set_anchor2(Vec3::new(3.0, 0.0, 0.0))?;
    gear.set_ratio(2.0)?;
    Ok((world, joint))
}

#[test]
fn transmission_counts_turns() -> Result<(), Error> {
    let (mut world, joint) = gears()?;
    for _ in 0..1000 {
        world.step(Stepper::Direct, 0.01)?;
    }
    let gear = world.joint::<Transmission>(joint)?;
    assert!((gear.radius1() - 2.0).abs() < 1e-12 && (gear.radius2() - 1.0).abs() < 1e-12);
    // 10 s at 3 rad/s; the angles are those at the start of the last step. The contact point goes backwards around a
    // wheel that turns forwards.
    assert!((gear.angle1().abs() - 30.0).abs() < 0.05, "{}", gear.angle1());
    // A step turns a wheel by 2 atan(h w/2), which is (h w)³/12 short of h w. The fast wheel loses more, and ERP corrects
    // a fifth of what is there in each step.
    let lost = (0.06_f64 * 0.06 * 0.06 - 2.0 * 0.03 * 0.03 * 0.03) / 12.0;
    let behind = gear.angle2().abs() - 2.0 * gear.angle1().abs() + lost / world.erp();
    assert!(behind.abs() < 1e-6, "{behind}");
    Ok(())
}

#[test]
fn transmission_has_no_empty_row_without_cfm() -> Result<(), Error> {
    let (mut world, joint) = gears()?;
    world.joint_mut::<Transmission>(joint)?.set_backlash(10.0)?;
    world.set_joint_param(joint, Param::Cfm, 1, 0.0)?;
    stays_finite(&world, 10)
}

#[test]
fn transmission_functions_belong_to_modes() -> Result<(), Error> {
    let (mut world, _, joint) = pair::<Transmission>()?;
    let mut gear = world.joint_mut::<Transmission>(joint)?;
    assert!(matches!(gear.set_axis1(Vec3::X), Err(Error::WrongMode { .. })));
    assert!(matches!(gear.set_axis2(Vec3::X), Err(Error::WrongMode { .. })));
    assert!(matches!(gear.set_radius1(1.0), Err(Error::WrongMode { .. })));
    assert!(matches!(gear.set_ratio(0.0), Err(Error::OutOfRange { .. })));
    gear.set_mode(TransmissionMode::IntersectingAxes);
    assert!(matches!(gear.set_axis(Vec3::X), Err(Error::WrongMode { .. })));
    assert!(matches!(gear.set_ratio(1.0), Err(Error::WrongMode { .. })));
    assert!(matches!(gear.as_ref().axis(), Err(Error::WrongMode { .. })));
    gear.set_mode(TransmissionMode::ChainDrive);
    assert!(matches!(gear.set_radius2(-1.0), Err(Error::OutOfRange { .. })));
    gear.set_radius2(1.0)
}

#[test]
fn limbo_is_an_error_where_a_body_is_needed() -> Result<(), Error> {
    let mut world = World::new();
    let pr = world.create_joint::<PR>(None)?;
    let pu = world.create_joint::<PU>(None)?;
    let piston = world.create_joint::<Piston>(None)?;
    let dhinge = world.create_joint::<DHinge>(None)?;
    let amotor = world.create_joint::<AMotor>(None)?;
    let lmotor = world.create_joint::<LMotor>(None)?;
    let not_attached = |result: Result<(), Error>, key: JointKey| {
        assert!(matches!(result, Err(Error::NotAttached { joint, .. }) if joint == key), "{result:?}");
    };
    not_attached(world.joint::<PR>(pr)?.position().map(drop), pr);
    not_attached(world.joint::<PR>(pr)?.position_rate().map(drop), pr);
    not_attached(world.joint::<PU>(pu)?.position().map(drop), pu);
    not_attached(world.joint_mut::<Piston>(piston)?.set_axis_delta(Vec3::X, Vec3::Y), piston);
    not_attached(world.joint_mut::<DHinge>(dhinge)?.set_axis(Vec3::X), dhinge);
    not_attached(world.joint_mut::<AMotor>(amotor)?.set_axis(0, AxisFrame::First, Vec3::X), amotor);
    not_attached(world.joint_mut::<LMotor>(lmotor)?.set_axis(0, AxisFrame::Second, Vec3::X), lmotor);
    // These do nothing, or work without a body.
    world.joint_mut::<PR>(pr)?.set_anchor(Vec3::X)?;
    assert_eq!(world.joint::<PR>(pr)?.anchor(), Vec3::ZERO);
    world.joint_mut::<AMotor>(amotor)?.set_axis(0, AxisFrame::World, Vec3::X)?;
    world.joint_mut::<LMotor>(lmotor)?.set_axis(0, AxisFrame::World, Vec3::X)?;
    assert_eq!(world.joint::<Piston>(piston)?.position(), 0.0);
    assert_eq!(world.joint::<PU>(pu)?.angles(), [0.0; 2]);
    Ok(())
}

#[test]
fn bad_numbers_are_errors_that_change_nothing() -> Result<(), Error> {
    let (mut world, _, joint) = pair::<PU>()?;
    let mut pu = world.joint_mut::<PU>(joint)?;
    let axis = pu.as_ref().axis3();
    assert!(matches!(pu.set_axis3(Vec3::ZERO), Err(Error::ZeroVector { what: "prismatic axis", .. })));
    assert!(matches!(pu.set_axis1(Vec3::new(f64::NAN, 0.0, 0.0)), Err(Error::NotFinite { .. })));
    assert!(matches!(
        pu.set_anchor_offset(Vec3::X, Vec3::splat(f64::INFINITY)),
        Err(Error::NotFinite { .. })
    ));
    assert!(matches!(pu.add_torques(1.0, f64::NAN), Err(Error::OutOfRange { .. })));
    assert_eq!(pu.as_ref().axis3(), axis);
    let (mut world, _, joint) = pair::<DBall>()?;
    let result = world.joint_mut::<DBall>(joint)?.set_distance(-1.0);
    assert!(matches!(result, Err(Error::OutOfRange { value: -1.0, .. })));
    let (mut world, _, joint) = pair::<AMotor>()?;
    let mut motor = world.joint_mut::<AMotor>(joint)?;
    motor.set_mode(AMotorMode::Euler);
    assert!(matches!(motor.set_angle(0, 1.0), Err(Error::WrongMode { .. })));
    assert!(matches!(motor.set_axis(0, AxisFrame::Second, Vec3::X), Err(Error::WrongMode { .. })));
    Ok(())
}
