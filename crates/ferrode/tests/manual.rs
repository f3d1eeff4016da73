//! What ODE's manual promises of worlds, bodies and joint groups, in the manual's order, through the Rust interface.
//! What the book's code asserts already is not repeated here.

use ferrode::prelude::*;
use ferrode::{AutoDisable, Ball, Contact, ContactPoint, Damping, Hinge, QuickSettings, Slider, dynamics};

const H: f64 = 0.01;

/// A body that touches the ground with one point, so that it may sleep.
fn resting(world: &mut dynamics::World) -> Result<BodyKey, Error> {
    let body = world.create_body();
    let point = ContactPoint { position: Vec3::ZERO, normal: Vec3::Z, depth: 0.0 };
    let joint = world.create_contact(None, &Contact::at(point, Surface::frictionless()))?;
    world.attach(joint, Some(body), None)?;
    Ok(body)
}

fn steps_until_asleep(world: &mut dynamics::World, body: BodyKey) -> Result<usize, Error> {
    for step in 1..1000 {
        world.step(Stepper::Direct, H)?;
        if !world.body(body)?.is_enabled() {
            return Ok(step);
        }
    }
    Ok(usize::MAX)
}

#[test]
fn islands_are_stepped_apart_and_sleep_as_a_whole() -> Result<(), Error> {
    let mut world = dynamics::World::new();
    let bodies: Vec<BodyKey> = (0..6).map(|_| world.create_body()).collect();
    for pair in bodies.chunks(2) {
        let joint = world.create_joint::<Ball>(None)?;
        world.attach(joint, Some(pair[0]), Some(pair[1]))?;
    }
    assert_eq!(world.step(Stepper::Direct, H)?.islands, 3);
    // One sleeper of an island with an awake body is woken; two sleepers are not.
    world.body_mut(bodies[0])?.disable();
    world.body_mut(bodies[2])?.disable();
    world.body_mut(bodies[3])?.disable();
    assert_eq!(world.step(Stepper::Direct, H)?.islands, 2);
    assert!(world.body(bodies[0])?.is_enabled());
    assert!(!world.body(bodies[2])?.is_enabled() && !world.body(bodies[3])?.is_enabled());
    // A contact with an awake body wakes an island.
    let joint = world.create_contact(None, &Contact::default())?;
    world.attach(joint, Some(bodies[0]), Some(bodies[2]))?;
    world.step(Stepper::Direct, H)?;
    assert!(world.body(bodies[3])?.is_enabled());
    Ok(())
}

#[test]
fn defaults_are_the_manuals() {
    let world = dynamics::World::new();
    assert_eq!((world.gravity(), world.erp(), world.cfm()), (Vec3::ZERO, 0.2, 1e-10));
    let sleep = world.auto_disable();
    assert!(!sleep.enabled);
    assert_eq!((sleep.linear_threshold, sleep.angular_threshold), (0.01, 0.01));
    assert_eq!((sleep.steps, sleep.time), (10, 0.0));
    assert_eq!((world.quick().iterations, world.quick().over_relaxation), (20, 1.3));
    let damping = world.damping();
    assert_eq!((damping.linear_scale, damping.angular_scale), (0.0, 0.0));
    assert_eq!((damping.linear_threshold, damping.angular_threshold), (0.01, 0.01));
    assert_eq!(world.max_angular_speed(), f64::INFINITY);
    assert_eq!(world.contact_max_correcting_velocity(), f64::INFINITY);
    assert_eq!(world.contact_surface_layer(), 0.0);
}

#[test]
fn forces_are_cleared_by_the_step_that_they_act_in() -> Result<(), Error> {
    let mut world = dynamics::World::new();
    let body = world.create_body();
    world.body_mut(body)?.add_force(Vec3::X)?;
    world.body_mut(body)?.add_force(Vec3::X)?;
    world.step(Stepper::Quick, 1.0)?;
    assert_eq!(world.body(body)?.linear_velocity(), Vec3::new(2.0, 0.0, 0.0));
    assert_eq!(world.body(body)?.force(), Vec3::ZERO);
    world.step(Stepper::Quick, 1.0)?;
    assert_eq!(world.body(body)?.linear_velocity(), Vec3::new(2.0, 0.0, 0.0));
    Ok(())
}

#[test]
fn erp_is_the_part_of_the_error_that_a_step_removes() -> Result<(), Error> {
    for erp in [0.0, 0.1, 0.5, 0.8] {
        let mut world = dynamics::World::new();
        world.set_erp(erp)?;
        let body = world.create_body();
        let joint = world.create_joint::<Ball>(None)?;
        world.attach(joint, Some(body), None)?;
        world.joint_mut::<Ball>(joint)?.set_anchor(Vec3::ZERO)?;
        world.body_mut(body)?.set_position(Vec3::new(1.0, 0.0, 0.0))?;
        world.step(Stepper::Direct, H)?;
        let left = world.joint_error(joint)?.position;
        assert!((left - (1.0 - erp)).abs() < 1e-6, "ERP {erp} left {left}");
    }
    Ok(())
}

#[test]
fn cfm_gives_way_in_proportion_to_the_force() -> Result<(), Error> {
    // At rest ERP/h · error = CFM · force: a weight of 10 N sinks by CFM · 10 · h / ERP.
    for cfm in [1e-4, 1e-3] {
        let mut world = dynamics::World::new();
        world.set_cfm(cfm)?;
        world.set_gravity(Vec3::new(0.0, 0.0, -10.0))?;
        let body = world.create_body();
        let joint = world.create_joint::<Ball>(None)?;
        world.attach(joint, Some(body), None)?;
        world.joint_mut::<Ball>(joint)?.set_anchor(Vec3::ZERO)?;
        for _ in 0..500 {
            world.step(Stepper::Direct, H)?;
        }
        let sunk = -world.body(body)?.position().z;
        assert!((sunk - cfm * 10.0 * H / 0.2).abs() < 1e-9, "CFM {cfm}: {sunk}");
    }
    Ok(())
}

#[test]
fn quick_converges_to_direct() -> Result<(), Error> {
    let velocity = |stepper, settings: QuickSettings| -> Result<Vec3, Error> {
        let mut world = dynamics::World::new();
        world.set_quick(settings)?;
        world.set_gravity(Vec3::new(0.0, 0.0, -10.0))?;
        let mut previous = None;
        for i in 0..4 {
            let body = world.create_body();
            let x = f64::from(i);
            world.body_mut(body)?.set_position(Vec3::new(x + 0.5, 0.0, 0.0))?;
            let joint = world.create_joint::<Ball>(None)?;
            world.attach(joint, Some(body), previous)?;
            world.joint_mut::<Ball>(joint)?.set_anchor(Vec3::new(x, 0.0, 0.0))?;
            previous = Some(body);
        }
        world.step(stepper, H)?;
        let last = world.bodies().next().map(|(_, body)| body.linear_velocity());
        Ok(last.unwrap_or_default())
    };
    let exact = velocity(Stepper::Direct, QuickSettings::default())?;
    let error = |iterations, over_relaxation| -> Result<f64, Error> {
        let settings = QuickSettings { iterations, over_relaxation, ..QuickSettings::default() };
        Ok((velocity(Stepper::Quick, settings)? - exact).length())
    };
    assert!(error(20, 1.3)? < error(5, 1.3)?, "more iterations are more exact");
    assert!(error(500, 1.3)? < 1e-9);
    assert!(error(500, 1.0)? < 1e-6, "other relaxations converge to the same");
    Ok(())
}

#[test]
fn a_surface_layer_is_sunk_into() -> Result<(), Error> {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -10.0))?;
    world.set_contact_surface_layer(0.01)?;
    world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    let ball = BodyBuilder::new().at(Vec3::new(0.0, 0.0, 0.495)).with_shape(Sphere::new(0.5)?, 1.0);
    let ball = world.add_body(ball)?;
    for _ in 0..300 {
        assert!(world.step(H)?.contacts == 1, "the contact is never broken");
    }
    let z = world.body(ball)?.position().z;
    assert!(z > 0.4899 && z < 0.4951, "{z}");
    Ok(())
}

#[test]
fn bodies_fall_asleep_after_idle_steps_and_idle_time() -> Result<(), Error> {
    let asleep = |steps, time, average_samples| -> Result<usize, Error> {
        let mut world = dynamics::World::new();
        let settings = AutoDisable { enabled: true, steps, time, average_samples, ..AutoDisable::default() };
        world.set_auto_disable(settings)?;
        let body = resting(&mut world)?;
        steps_until_asleep(&mut world, body)
    };
    assert_eq!(asleep(10, 0.0, 1)?, 10);
    assert_eq!(asleep(0, 0.055, 1)?, 6, "by time alone");
    assert_eq!(asleep(10, 0.2, 1)?, 20, "both must have passed");
    assert_eq!(asleep(10, 0.0, 4)?, 13, "the first samples are gathered first");
    Ok(())
}

#[test]
fn a_body_faster_than_its_thresholds_stays_awake() -> Result<(), Error> {
    for (linear, angular, sleeps) in [(0.005, 0.0, true), (0.02, 0.0, false), (0.0, 0.02, false)] {
        let mut world = dynamics::World::new();
        world.set_auto_disable(AutoDisable { enabled: true, ..AutoDisable::default() })?;
        let body = resting(&mut world)?;
        world.body_mut(body)?.set_linear_velocity(Vec3::new(linear, 0.0, 0.0))?;
        world.body_mut(body)?.set_angular_velocity(Vec3::new(0.0, 0.0, angular))?;
        assert_eq!(steps_until_asleep(&mut world, body)? < 1000, sleeps, "{linear} m/s, {angular} rad/s");
        // An infinite threshold takes the speed out of consideration.
        let settings = AutoDisable {
            linear_threshold: f64::INFINITY,
            angular_threshold: f64::INFINITY,
            ..*world.body(body)?.auto_disable()
        };
        world.body_mut(body)?.set_auto_disable(settings)?;
        assert!(steps_until_asleep(&mut world, body)? < 1000);
    }
    Ok(())
}

#[test]
fn damping_acts_after_the_move_and_above_the_threshold() -> Result<(), Error> {
    let mut world = dynamics::World::new();
    world.set_damping(Damping { linear_scale: 0.1, angular_scale: 0.2, ..Damping::default() })?;
    let body = world.create_body();
    world.body_mut(body)?.set_linear_velocity(Vec3::X)?;
    world.body_mut(body)?.set_angular_velocity(Vec3::Z)?;
    world.step(Stepper::Quick, H)?;
    let damped = world.body(body)?;
    assert!((damped.position().x - H).abs() < 1e-15, "moved at the whole speed");
    assert!((damped.linear_velocity().x - 0.9).abs() < 1e-15);
    assert!((damped.angular_velocity().z - 0.8).abs() < 1e-12);
    world.set_damping(Damping::default())?;
    world.set_body_damping_defaults(body)?;
    world.step(Stepper::Quick, H)?;
    assert!((world.body(body)?.linear_velocity().x - 0.9).abs() < 1e-15, "the world's damping is none now");
    Ok(())
}

#[test]
fn the_speed_limit_acts_before_the_move() -> Result<(), Error> {
    let mut world = dynamics::World::new();
    world.set_max_angular_speed(2.0)?;
    let body = world.create_body();
    world.body_mut(body)?.set_finite_rotation_mode(true);
    world.body_mut(body)?.set_angular_velocity(Vec3::new(0.0, 0.0, 10.0))?;
    world.step(Stepper::Quick, 0.1)?;
    let body = world.body(body)?;
    assert!((body.angular_velocity().z - 2.0).abs() < 1e-12);
    let turned = Quat::from_axis_angle(Vec3::Z, 0.2);
    assert!((body.quaternion().dot(turned) - 1.0).abs() < 1e-12, "turned by 2 rad/s, not 10");
    Ok(())
}

#[test]
fn finite_rotation_about_an_axis_is_exact_about_it() -> Result<(), Error> {
    let mut world = dynamics::World::new();
    let wheel = world.create_body();
    let body = world.body_mut(wheel)?;
    body.set_finite_rotation_mode(true);
    body.set_finite_rotation_axis(Vec3::new(0.0, 3.0, 0.0))?;
    assert_eq!(body.finite_rotation_axis(), Vec3::Y, "kept as a unit vector");
    body.set_angular_velocity(Vec3::new(0.0, 100.0, 0.0))?;
    world.step(Stepper::Quick, H)?;
    let turned = Quat::from_axis_angle(Vec3::Y, 1.0);
    assert!((world.body(wheel)?.quaternion().dot(turned) - 1.0).abs() < 1e-12);
    Ok(())
}

#[test]
fn joints_begin_in_limbo_and_go_back_there() -> Result<(), Error> {
    let mut world = dynamics::World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -10.0))?;
    let (a, b) = (world.create_body(), world.create_body());
    let joint = world.create_joint::<Slider>(None)?;
    assert_eq!(world.step(Stepper::Direct, H)?.rows, 0, "a joint in limbo has no effect");
    world.attach(joint, Some(a), Some(b))?;
    assert_eq!(world.step(Stepper::Direct, H)?.rows, 5);
    world.attach(joint, None, Some(b))?;
    assert_eq!(world.body(a)?.joint_count(), 0, "it is taken off the bodies that it had");
    world.destroy_body(b)?;
    assert_eq!(world.joint_bodies(joint)?, [None, None]);
    assert_eq!(world.step(Stepper::Direct, H)?.rows, 0);
    world.attach(joint, Some(a), None)?;
    assert_eq!(world.step(Stepper::Direct, H)?.rows, 5, "and can be attached again");
    Ok(())
}

#[test]
fn groups_are_emptied_all_at_once() -> Result<(), Error> {
    let mut world = dynamics::World::new();
    let body = world.create_body();
    let group = world.create_group();
    for _ in 0..10 {
        let joint = world.create_joint::<Hinge>(Some(group))?;
        world.attach(joint, Some(body), None)?;
        assert!(world.destroy_joint(joint).is_err(), "no joint of a group can be destroyed alone");
    }
    let alone = world.create_joint::<Hinge>(None)?;
    assert_eq!(world.joint_count(), 11);
    world.empty_group(group)?;
    assert_eq!((world.joint_count(), world.body(body)?.joint_count()), (1, 0));
    world.create_joint::<Hinge>(Some(group))?;
    world.destroy_group(group)?;
    assert_eq!(world.joint_count(), 1);
    assert!(world.contains_joint(alone) && world.empty_group(group).is_err());
    Ok(())
}

#[test]
fn the_moved_callback_may_damp_by_its_own_rule() -> Result<(), Error> {
    let mut world = dynamics::World::new();
    let body = world.create_body();
    world.body_mut(body)?.set_linear_velocity(Vec3::X)?;
    world.body_mut(body)?.set_moved_callback(Some(std::sync::Arc::new(|_, body| {
        let v = body.linear_velocity() * 0.5;
        body.set_linear_velocity(v).expect("half of a finite velocity is finite");
    })));
    world.step(Stepper::Quick, 1.0)?;
    world.step(Stepper::Quick, 1.0)?;
    assert_eq!(world.body(body)?.linear_velocity().x, 0.25);
    world.body_mut(body)?.disable();
    world.step(Stepper::Quick, 1.0)?;
    assert_eq!(world.body(body)?.linear_velocity().x, 0.25, "not called for disabled bodies");
    Ok(())
}
