//! Worlds as values: independent of each other, cloned to the same bits, stepped in small threads, and not brought down by
//! stale keys or forces that are no numbers.

use ferrode_dynamics::{
    AutoDisable, Ball, BodyKey, Contact, Error, Hinge, JointKey, Mass, Stepper, Surface, World,
};
use ferrode_math::{ContactPoint, Quat, Vec3};

const STEPPERS: [Stepper; 2] = [Stepper::Direct, Stepper::Quick];

/// A hanging chain of `length` boxes with ball joints, three rows each, pushed aside.
fn chain(length: usize) -> Result<(World, Vec<BodyKey>, Vec<JointKey>), Error> {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    let (mut bodies, mut joints) = (Vec::new(), Vec::new());
    for i in 0..length {
        let key = world.create_body();
        let body = world.body_mut(key)?;
        body.set_mass(&Mass::cuboid_total(1.0, Vec3::new(0.9, 0.3, 0.2))?)?;
        body.set_position(Vec3::new(i as f64 + 0.5, 0.0, 0.0))?;
        body.set_angular_velocity(Vec3::new(0.1, 0.2, -0.3) * (i % 7) as f64)?;
        let ball = world.create_joint::<Ball>(None)?;
        world.attach(ball, Some(key), bodies.last().copied())?;
        world.joint_mut::<Ball>(ball)?.set_anchor(Vec3::new(i as f64, 0.0, 0.0))?;
        bodies.push(key);
        joints.push(ball);
    }
    Ok((world, bodies, joints))
}

/// All that a world's bodies do, bit for bit.
fn bits(world: &World) -> Vec<u64> {
    let numbers = world.bodies().flat_map(|(_, b)| {
        let (p, q) = (b.position().to_array(), b.quaternion().to_array());
        let (v, w) = (b.linear_velocity().to_array(), b.angular_velocity().to_array());
        p.into_iter().chain(q).chain(v).chain(w)
    });
    numbers.map(f64::to_bits).chain([u64::from(world.random().seed())]).collect()
}

/// A chain that lies on a floor: its lowest boxes touch it, with contacts made anew for each step.
fn step_on_floor(world: &mut World, stepper: Stepper, h: f64) -> Result<(), Error> {
    let group = world.create_group();
    let low: Vec<(BodyKey, Vec3)> =
        world.bodies().map(|(key, b)| (key, b.position())).filter(|(_, p)| p.z < 0.05).collect();
    for (body, p) in low {
        let contact = Contact {
            surface: Surface { mu: 0.5, ..Surface::default() },
            point: ContactPoint {
                position: Vec3::new(p.x, p.y, -0.1),
                normal: Vec3::Z,
                depth: (0.05 - p.z).min(0.01),
            },
            ..Contact::default()
        };
        let joint = world.create_contact(Some(group), &contact)?;
        world.attach(joint, Some(body), None)?;
    }
    world.step(stepper, h)?;
    world.destroy_group(group)
}

#[test]
fn a_clone_steps_to_the_same_bits() -> Result<(), Error> {
    for stepper in STEPPERS {
        let (mut world, ..) = chain(12)?;
        for _ in 0..40 {
            step_on_floor(&mut world, stepper, 0.01)?;
        }
        let mut copy = world.clone();
        assert_eq!(bits(&copy), bits(&world));
        for _ in 0..40 {
            step_on_floor(&mut world, stepper, 0.01)?;
        }
        let there = bits(&world);
        for _ in 0..40 {
            step_on_floor(&mut copy, stepper, 0.01)?;
        }
        assert_eq!(bits(&copy), there, "{stepper:?}");
        // The second run has gone somewhere at all.
        assert!(world.bodies().all(|(_, b)| b.position().is_finite() && b.linear_velocity() != Vec3::ZERO));
    }
    Ok(())
}

#[test]
fn worlds_at_different_rates_are_independent() -> Result<(), Error> {
    for stepper in STEPPERS {
        let alone = |length: usize, steps: usize, h: f64| -> Result<Vec<u64>, Error> {
            let (mut world, ..) = chain(length)?;
            for _ in 0..steps {
                world.step(stepper, h)?;
            }
            Ok(bits(&world))
        };
        let (mut fast, ..) = chain(5)?;
        let (mut slow, ..) = chain(9)?;
        for i in 0..120 {
            fast.step(stepper, 1.0 / 240.0)?;
            if i % 4 == 3 {
                slow.step(stepper, 1.0 / 60.0)?;
            }
        }
        assert_eq!(bits(&fast), alone(5, 120, 1.0 / 240.0)?, "{stepper:?}");
        assert_eq!(bits(&slow), alone(9, 30, 1.0 / 60.0)?, "{stepper:?}");
    }
    Ok(())
}

#[test]
fn a_world_may_go_to_another_thread() -> Result<(), Error> {
    fn sendable<T: Send + 'static>(value: T) -> T {
        value
    }
    let (world, ..) = chain(6)?;
    let mut here = world.clone();
    let mut there = sendable(world);
    let there = std::thread::spawn(move || {
        for _ in 0..20 {
            there.step(Stepper::Quick, 0.01)?;
        }
        Ok::<_, Error>(there)
    });
    for _ in 0..20 {
        here.step(Stepper::Quick, 0.01)?;
    }
    let there = there.join().expect("the thread does not panic")?;
    assert_eq!(bits(&there), bits(&here));
    Ok(())
}

/// Islands are found, and systems factorised and solved, without recursion and without large arrays on the stack.
#[test]
fn thousands_of_rows_need_little_stack() -> Result<(), Error> {
    for stepper in STEPPERS {
        let (mut world, ..) = chain(1667)?;
        let thread = std::thread::Builder::new().stack_size(256 * 1024).spawn(move || {
            let report = world.step(stepper, 0.01)?;
            Ok::<_, Error>((report, world))
        });
        let (report, world) = thread.expect("a thread").join().expect("the thread does not panic")?;
        assert_eq!((report.islands, report.rows), (1, 5001));
        assert_eq!((report.lcp_failures, report.quarantined.len()), (0, 0), "{stepper:?}");
        assert!(world.bodies().all(|(_, b)| b.position().is_finite()));
    }
    Ok(())
}

#[test]
fn stale_and_foreign_keys_are_errors() -> Result<(), Error> {
    let (mut world, bodies, joints) = chain(3)?;
    let (mut other, other_bodies, other_joints) = chain(3)?;
    let group = world.create_group();

    // Another world's keys, though the same slots are in use here.
    let body = other_bodies[0];
    assert_eq!(world.body(body).err(), Some(Error::NoSuchBody(body)));
    assert_eq!(world.body_mut(body).err(), Some(Error::NoSuchBody(body)));
    assert_eq!(world.destroy_body(body), Err(Error::NoSuchBody(body)));
    assert!(!world.contains_body(body));
    let joint = other_joints[0];
    assert_eq!(world.joint::<Ball>(joint).err(), Some(Error::NoSuchJoint(joint)));
    assert_eq!(world.destroy_joint(joint), Err(Error::NoSuchJoint(joint)));
    assert_eq!(world.attach(joint, None, None), Err(Error::NoSuchJoint(joint)));
    assert_eq!(world.attach(joints[0], Some(body), None), Err(Error::NoSuchBody(body)));
    assert_eq!(other.create_joint::<Ball>(Some(group)), Err(Error::NoSuchGroup(group)));

    // Destroyed ones, also after their slots are in use again.
    let (body, joint) = (bodies[2], joints[2]);
    world.destroy_body(body)?;
    assert_eq!(world.joint_bodies(joint)?, [None, None]);
    world.destroy_joint(joint)?;
    let (new_body, new_joint) = (world.create_body(), world.create_joint::<Ball>(None)?);
    assert!(new_body != body && new_joint != joint);
    assert_eq!(world.body(body).err(), Some(Error::NoSuchBody(body)));
    assert_eq!(world.attach(new_joint, Some(body), None), Err(Error::NoSuchBody(body)));
    assert_eq!(world.joint_error(joint), Err(Error::NoSuchJoint(joint)));
    assert_eq!(world.joint_mut::<Ball>(joint).err(), Some(Error::NoSuchJoint(joint)));
    world.destroy_group(group)?;
    assert_eq!(world.create_joint::<Ball>(Some(group)), Err(Error::NoSuchGroup(group)));

    // The wrong type says what it is.
    let wrong = world.joint::<Hinge>(new_joint).map(drop);
    assert!(matches!(wrong, Err(Error::WrongJointType { joint, .. }) if joint == new_joint), "{wrong:?}");
    world.step(Stepper::Direct, 0.01)?;
    other.step(Stepper::Direct, 0.01)?;
    Ok(())
}

/// A force that overflows takes its body out; what hangs on it stays attached to where it was, and other islands don't
/// notice.
#[test]
fn an_infinite_force_is_quarantined() -> Result<(), Error> {
    for stepper in STEPPERS {
        let (mut world, bodies, _) = chain(4)?;
        let free = world.create_body();
        world.body_mut(free)?.set_position(Vec3::new(0.0, 50.0, 0.0))?;
        world.body_mut(free)?.set_angular_velocity(Vec3::new(1.0, 2.0, 3.0))?;
        let mut undisturbed = world.clone();

        let sick = bodies[2];
        let pose = world.body(sick)?.pose();
        world.body_mut(sick)?.add_force(Vec3::new(f64::MAX, 0.0, 0.0))?;
        world.body_mut(sick)?.add_force(Vec3::new(f64::MAX, 0.0, 0.0))?;
        assert_eq!(world.step(stepper, 0.01)?.quarantined, [sick], "{stepper:?}");
        undisturbed.step(stepper, 0.01)?;
        for _ in 0..200 {
            assert_eq!(world.step(stepper, 0.01)?.quarantined, [], "{stepper:?}");
            undisturbed.step(stepper, 0.01)?;
        }
        assert!(world.body(sick)?.is_quarantined());
        assert_eq!(world.body(sick)?.pose(), pose);
        for body in bodies.iter().filter(|body| **body != sick) {
            let body = world.body(*body)?;
            assert!(body.position().is_finite() && body.linear_velocity().length() < 50.0);
            assert!(body.position() != pose.position);
        }
        // The fourth box swings on the third one's place: its anchor is still there.
        let reach = (world.body(bodies[3])?.position() - Vec3::new(3.0, 0.0, 0.0)).length();
        assert!((reach - 0.5).abs() < 0.02, "{stepper:?}: {reach}");
        assert_eq!(world.body(free)?.pose(), undisturbed.body(free)?.pose());

        // Once its state is good again it can come back.
        world.body_mut(sick)?.release();
        assert_eq!(world.step(stepper, 0.01)?.quarantined, []);
        assert!(!world.body(sick)?.is_quarantined());
    }
    Ok(())
}

/// A force so large that the new velocity or pose overflows is caught after the step, at the last good state.
#[test]
fn an_overflow_within_the_step_is_quarantined() -> Result<(), Error> {
    for stepper in STEPPERS {
        let mut world = World::new();
        let body = world.create_body();
        world.body_mut(body)?.set_mass(&Mass::sphere_total(1e-3, 0.1)?)?;
        world.body_mut(body)?.set_position(Vec3::new(1.0, 2.0, 3.0))?;
        world.body_mut(body)?.add_force(Vec3::new(0.0, f64::MAX, 0.0))?;
        assert_eq!(world.step(stepper, 1.0)?.quarantined, [body]);
        assert_eq!(world.body(body)?.position(), Vec3::new(1.0, 2.0, 3.0));
        assert_eq!(world.step(stepper, 1.0)?.quarantined, []);
    }
    Ok(())
}

#[test]
fn setters_refuse_what_is_no_number() -> Result<(), Error> {
    let (mut world, bodies, joints) = chain(2)?;
    let before = bits(&world);
    let nan = Vec3::new(0.0, f64::NAN, 0.0);
    let body = world.body_mut(bodies[0])?;
    assert!(matches!(body.set_position(nan), Err(Error::NotFinite { .. })));
    assert!(matches!(body.add_force(Vec3::splat(f64::INFINITY)), Err(Error::NotFinite { .. })));
    assert!(matches!(body.set_linear_velocity(nan), Err(Error::NotFinite { .. })));
    assert!(matches!(body.set_quaternion(Quat::new(0.0, 0.0, 0.0, 0.0)), Err(Error::NotARotation { .. })));
    assert!(body.set_auto_disable(AutoDisable { time: f64::NAN, ..AutoDisable::default() }).is_err());
    assert!(matches!(world.joint_mut::<Ball>(joints[0])?.set_anchor(nan), Err(Error::NotFinite { .. })));
    for h in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        assert!(matches!(world.step(Stepper::Direct, h), Err(Error::OutOfRange { .. })), "{h}");
    }
    assert_eq!(bits(&world), before);
    Ok(())
}
