//! The world with shapes: resting, touching, sleeping, joined bodies, keys, clones.

use ferrode::prelude::*;
use ferrode::{AutoDisable, ContactEvent, Step};

fn ground(world: &mut World) -> Result<GeomKey, Error> {
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)
}

fn cube(world: &mut World, position: Vec3) -> Result<BodyKey, Error> {
    world.add_body(BodyBuilder::new().at(position).with_shape(Cuboid::new(Vec3::splat(1.0))?, 1000.0))
}

fn run(world: &mut World, steps: usize) -> Result<Step, Error> {
    let mut last = Step::default();
    for _ in 0..steps {
        last = world.step(0.01)?;
    }
    Ok(last)
}

#[test]
fn a_dropped_ball_comes_to_rest_on_the_plane() -> Result<(), Error> {
    for stepper in [Stepper::Direct, Stepper::Quick] {
        let mut world = World::new();
        world.stepper = stepper;
        ground(&mut world)?;
        let ball = BodyBuilder::new().at(Vec3::new(0.0, 0.0, 2.0)).with_shape(Sphere::new(0.5)?, 1000.0);
        let ball = world.add_body(ball)?;
        let report = run(&mut world, 500)?;
        let body = world.body(ball)?;
        assert!((body.position().z - 0.5).abs() < 1e-3, "{stepper:?}: {:?}", body.position());
        assert!(body.linear_velocity().length() < 1e-6);
        assert_eq!(report.contacts, 1);
        let force = world.contacts()[0].force.length();
        let weight = body.mass().mass * 9.81;
        assert!(
            (force - weight).abs() < 1e-6 * weight,
            "{stepper:?}: contact force {force}, weight {weight}"
        );
    }
    Ok(())
}

#[test]
fn a_stack_of_boxes_stands() -> Result<(), Error> {
    let mut world = World::new();
    ground(&mut world)?;
    let boxes: Vec<BodyKey> = (0..5)
        .map(|i| cube(&mut world, Vec3::new(0.0, 0.0, 0.5 + f64::from(i))))
        .collect::<Result<_, _>>()?;
    run(&mut world, 1000)?;
    for (i, key) in boxes.iter().enumerate() {
        let p = world.body(*key)?.position();
        assert!((p - Vec3::new(0.0, 0.0, 0.5 + i as f64)).length() < 0.02, "box {i} at {p:?}");
    }
    Ok(())
}

#[test]
fn events_tell_who_begins_and_ends_to_touch() -> Result<(), Error> {
    let mut world = World::new();
    let plane = ground(&mut world)?;
    world.set_default_material(Material::default().with_restitution(0.8))?;
    let ball = BodyBuilder::new().at(Vec3::new(0.0, 0.0, 1.0)).with_shape(Sphere::new(0.5)?, 1000.0);
    let ball = world.add_body(ball)?;
    let geom = world.body_geoms(ball)?[0];
    let mut events = Vec::new();
    for _ in 0..60 {
        world.step(0.01)?;
        events.extend_from_slice(world.contact_events());
    }
    let pair = |a: GeomKey, b: GeomKey| (a == plane && b == geom) || (a == geom && b == plane);
    assert!(matches!(events[0], ContactEvent::Begin(a, b) if pair(a, b)), "{events:?}");
    assert!(matches!(events[1], ContactEvent::End(a, b) if pair(a, b)), "{events:?}");
    Ok(())
}

#[test]
fn joined_bodies_do_not_collide_unless_asked() -> Result<(), Error> {
    let mut world = World::new();
    let a = cube(&mut world, Vec3::ZERO)?;
    let b = cube(&mut world, Vec3::new(0.9, 0.0, 0.0))?;
    let joint = world.add_ball(Some(a), Some(b), Vec3::new(0.45, 0.0, 0.0))?;
    assert_eq!(world.step(0.01)?.contacts, 0);
    world.set_joined_bodies_collide(joint, true)?;
    assert!(world.step(0.01)?.contacts > 0);
    world.set_joined_bodies_collide(joint, false)?;
    world.destroy_joint(joint)?;
    assert!(world.step(0.01)?.contacts > 0);
    Ok(())
}

#[test]
fn pair_rules_override_materials() -> Result<(), Error> {
    let mut world = World::new();
    let plane = ground(&mut world)?;
    let body = cube(&mut world, Vec3::new(0.0, 0.0, 0.5))?;
    let geom = world.body_geoms(body)?[0];
    world.set_pair_surface(plane, geom, None)?;
    run(&mut world, 50)?;
    assert!(world.body(body)?.position().z < 0.0, "without contacts the box falls through");
    world.clear_pair_surface(plane, geom);
    assert!(world.step(0.01)?.contacts > 0);
    Ok(())
}

#[test]
fn sleepers_sleep_and_wake() -> Result<(), Error> {
    let mut world = World::new();
    ground(&mut world)?;
    world.set_auto_disable(AutoDisable { enabled: true, ..AutoDisable::default() })?;
    let sleeper = cube(&mut world, Vec3::new(0.0, 0.0, 0.5))?;
    let report = run(&mut world, 300)?;
    assert!(!world.body(sleeper)?.is_enabled());
    assert_eq!((report.contacts, report.dynamics.bodies), (0, 0), "what sleeps costs nothing");
    assert!(world.contact_events().is_empty(), "sleepers go on touching");
    let visitor = cube(&mut world, Vec3::new(0.3, 0.0, 1.6))?;
    run(&mut world, 20)?;
    assert!(world.body(sleeper)?.is_enabled(), "a touch wakes");
    world.destroy_body(visitor)?;
    run(&mut world, 300)?;
    assert!(!world.body(sleeper)?.is_enabled());
    Ok(())
}

#[test]
fn stale_and_foreign_keys_are_errors() -> Result<(), Error> {
    let mut world = World::new();
    let mut other = World::new();
    let body = cube(&mut world, Vec3::ZERO)?;
    let geom = world.body_geoms(body)?[0];
    cube(&mut other, Vec3::ZERO)?;
    assert!(other.body(body).is_err() && other.geom(geom).is_err());
    assert!(other.destroy_body(body).is_err() && other.remove_geom(geom).is_err());
    world.destroy_body(body)?;
    assert!(world.body(body).is_err() && world.geom(geom).is_err());
    assert!(world.add_geom(body, Sphere::new(1.0)?, Pose::IDENTITY).is_err());
    assert_eq!((world.body_count(), world.geom_count()), (0, 0));
    assert!(world.step(f64::NAN).is_err() && world.step(0.0).is_err() && world.step(-0.1).is_err());
    Ok(())
}

#[test]
fn a_plane_can_not_ride_on_a_body() -> Result<(), Error> {
    let mut world = World::new();
    let body = cube(&mut world, Vec3::ZERO)?;
    assert!(world.add_geom(body, Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY).is_err());
    assert_eq!(world.geom_count(), 1);
    Ok(())
}

#[test]
fn a_clone_steps_to_the_same_bits() -> Result<(), Error> {
    fn send<T: Send>(_: &T) {}
    for stepper in [Stepper::Quick, Stepper::Direct] {
        let mut world = World::new();
        world.stepper = stepper;
        ground(&mut world)?;
        for i in 0..20 {
            let x = 0.3 * f64::from(i % 5);
            cube(&mut world, Vec3::new(x, 0.1 * f64::from(i), 1.0 + 1.1 * f64::from(i)))?;
        }
        run(&mut world, 150)?;
        let mut copy = world.clone();
        send(&copy);
        run(&mut world, 100)?;
        let copy = std::thread::spawn(move || run(&mut copy, 100).map(|_| copy)).join().expect("no panic")?;
        for ((ka, a), (kb, b)) in world.bodies().zip(copy.bodies()) {
            assert_eq!(ka, kb);
            assert_eq!(a.position(), b.position(), "{stepper:?}");
            assert_eq!(a.quaternion(), b.quaternion(), "{stepper:?}");
            assert_eq!(a.angular_velocity(), b.angular_velocity(), "{stepper:?}");
        }
    }
    Ok(())
}

#[test]
fn off_centre_shapes_shift_the_body_not_the_shapes() -> Result<(), Error> {
    let mut world = World::new();
    let bar = Cuboid::new(Vec3::new(1.0, 0.1, 0.1))?;
    let body = BodyBuilder::new().with_shape_at(bar, 100.0, Pose::from_position(Vec3::new(0.5, 0.0, 0.0)));
    let body = world.add_body(body)?;
    assert!((world.body(body)?.position() - Vec3::new(0.5, 0.0, 0.0)).length() < 1e-15);
    let geom = world.geom(world.body_geoms(body)?[0])?;
    assert!((geom.pose().position - Vec3::new(0.5, 0.0, 0.0)).length() < 1e-15);
    let inertia = world.body(body)?.mass().inertia;
    assert!((inertia.rows[1][1] - 1.0 / 12.0 * (1.0 + 0.01)).abs() < 1e-12);
    Ok(())
}

#[test]
fn a_belt_carries_what_lies_on_it_whichever_geom_is_found_first() -> Result<(), Error> {
    // Made before and after its load, fixed and on a kinematic body.
    for (belt_first, on_body) in [(true, false), (false, false), (true, true), (false, true)] {
        let mut world = World::new();
        world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
        let make_belt = |world: &mut World| -> Result<(), Error> {
            let shape = Cuboid::new(Vec3::new(20.0, 1.0, 0.2))?;
            let geom = if on_body {
                let body = world.add_body(BodyBuilder::new().with_shape(shape, 1.0).kinematic())?;
                world.body_geoms(body)?[0]
            } else {
                world.add_static(shape, Pose::IDENTITY)?
            };
            let rubber =
                Material { friction_direction: Some(Vec3::X), motion: [1.5, 0.0], ..Material::default() };
            world.set_material(geom, rubber)
        };
        if belt_first {
            make_belt(&mut world)?;
        }
        let load = BodyBuilder::new().at(Vec3::new(0.0, 0.0, 0.35));
        let load = world.add_body(load.with_shape(Cuboid::new(Vec3::splat(0.5))?, 100.0))?;
        if !belt_first {
            make_belt(&mut world)?;
        }
        for _ in 0..200 {
            world.step(0.01)?;
        }
        let v = world.body(load)?.linear_velocity();
        assert!((v.x - 1.5).abs() < 1e-3 && v.y.abs() < 1e-3, "{belt_first} {on_body}: {v:?}");
    }
    Ok(())
}
