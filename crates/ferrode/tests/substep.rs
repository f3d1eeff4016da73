//! Worlds stepped by `Substep`: what a physicist would look at.

use ferrode::math::simd::Level;
use ferrode::prelude::*;
use ferrode::{Ball, ContactEvent, Hinge, Slider};

const H: f64 = 1.0 / 60.0;
const G: f64 = 9.81;

fn world() -> World {
    let mut world = World::new();
    world.stepper = Stepper::Substep;
    world.set_gravity(Vec3::new(0.0, 0.0, -G)).unwrap();
    world
}

fn ground(world: &mut World, at: Vec3) -> GeomKey {
    let slab = Cuboid::new(Vec3::new(100.0, 100.0, 2.0)).unwrap();
    world.add_static(slab, Pose::from_position(at - Vec3::Z)).unwrap()
}

fn cube(world: &mut World, at: Vec3) -> BodyKey {
    let shape = Cuboid::new(Vec3::splat(1.0)).unwrap();
    world.add_body(BodyBuilder::new().at(at).with_shape(shape, 1000.0)).unwrap()
}

fn steps(world: &mut World, count: usize) {
    for _ in 0..count {
        let step = world.step(H).unwrap();
        assert!(step.dynamics.quarantined.is_empty());
    }
}

fn awake(world: &mut World) {
    let mut settings = *world.dynamics().substep();
    settings.sleep_speed = 0.0;
    world.set_substep(settings).unwrap();
}

/// A stack of ten, at the origin or far from it.
fn stack(at: Vec3) -> (World, Vec<BodyKey>) {
    let mut world = world();
    ground(&mut world, at);
    let boxes = (0..10).map(|i| cube(&mut world, at + Vec3::Z * (0.5 + f64::from(i)))).collect();
    (world, boxes)
}

#[test]
fn a_stack_stands_and_sleeps() {
    let (mut world, boxes) = stack(Vec3::ZERO);
    steps(&mut world, 240);
    for (i, key) in boxes.iter().enumerate() {
        let body = world.body(*key).unwrap();
        let rest = Vec3::Z * (0.5 + i as f64);
        // Each joint of the stack gives way by about 2N/(m ω²), N being the load and ω that of 68 Hz: 6 mm in all.
        assert!((body.position() - rest).length() < 1e-2, "{i}: {:?}", body.position());
        assert!(!body.is_enabled(), "the pile sleeps");
    }
    // Whatever touches one wakes all.
    let ball = BodyBuilder::new().at(Vec3::new(0.9, 0.0, 12.0)).with_shape(Sphere::new(0.5).unwrap(), 100.0);
    world.add_body(ball).unwrap();
    let mut woken = false;
    for _ in 0..120 {
        world.step(H).unwrap();
        woken |= boxes.iter().all(|key| world.body(*key).unwrap().is_enabled());
    }
    assert!(woken);
}

#[test]
fn a_sleeping_world_wakes_by_whatever_is_done_to_it() {
    let asleep = || {
        let (mut world, boxes) = stack(Vec3::ZERO);
        steps(&mut world, 240);
        // Some of these steps are those in which nothing is awake any more.
        let (time, pairs) = (world.time(), world.step(H).unwrap().pairs);
        assert!(pairs >= 10 && (world.time() - time - H).abs() < 1e-12);
        assert!(boxes.iter().all(|key| !world.body(*key).unwrap().is_enabled()));
        assert!(world.contact_events().is_empty());
        (world, boxes)
    };
    let touch = |world: &World| {
        let pushed = world.contacts().iter().map(|c| c.force.length()).sum::<f64>();
        assert!(pushed > 1000.0 * G * 10.0, "{pushed}");
    };
    // By hand: all wake, with the impulses that they fell asleep with, so that nothing sinks.
    let (mut world, boxes) = asleep();
    let top = world.body(boxes[9]).unwrap().position();
    world.body_mut(boxes[0]).unwrap().enable();
    steps(&mut world, 1);
    assert!(boxes.iter().all(|key| world.body(*key).unwrap().is_enabled()));
    touch(&world);
    steps(&mut world, 5);
    assert!((world.body(boxes[9]).unwrap().position() - top).length() < 1e-3);
    // By a shape that is moved into it, and one that comes by itself.
    let (mut world, boxes) = asleep();
    let (mut other, ball) = {
        let shape = Sphere::new(0.5).unwrap();
        let ball = world.add_static(shape, Pose::from_position(Vec3::new(5.0, 0.0, 9.5))).unwrap();
        (world, ball)
    };
    steps(&mut other, 2);
    assert!(!other.body(boxes[9]).unwrap().is_enabled());
    other.remove_geom(ball).unwrap();
    let shape = Sphere::new(0.5).unwrap();
    let body = other.add_body(BodyBuilder::new().at(Vec3::Z * 12.0).with_shape(shape, 100.0)).unwrap();
    steps(&mut other, 60);
    assert!(boxes.iter().all(|key| other.body(*key).unwrap().is_enabled()));
    assert!(other.body(body).unwrap().position().z > 10.0);
}

#[test]
fn a_sleeping_world_refuses_impossible_steps() {
    let (mut world, boxes) = stack(Vec3::ZERO);
    steps(&mut world, 240);
    assert!(boxes.iter().all(|key| !world.body(*key).unwrap().is_enabled()));
    let time = world.time();
    for h in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        assert!(world.step(h).is_err(), "{h}");
        assert_eq!(world.time(), time);
    }
}

#[test]
fn manifolds_that_are_not_awake_are_not_looked_at() {
    use ferrode::dynamics::{ContactManifold, ManifoldPoint};
    let mut world = ferrode::dynamics::World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -G)).unwrap();
    let bodies = [world.create_body(), world.create_body()];
    let surfaces = [ferrode::Surface::with_friction(0.5)];
    let mut manifolds = bodies.map(|body| {
        let mut manifold = ContactManifold::new(Some(body), None, 0);
        manifold.set_normal(Vec3::Z);
        manifold.push(ManifoldPoint { arm1: [0.0, 0.0, -0.5], ..ManifoldPoint::default() });
        manifold
    });
    // One that counts for nothing may name any surface.
    manifolds[1].set_surface(7);
    assert!(world.step_with_manifolds(H, &mut manifolds, &surfaces).is_err());
    // Bits beyond the last manifold count for nothing either.
    world.step_with_awake_manifolds(H, &mut manifolds, &[!0b10], &surfaces).unwrap();
    let speed = bodies.map(|body| world.body(body).unwrap().linear_velocity().z);
    assert!(speed[0].abs() < 1e-3, "{speed:?}");
    assert!((speed[1] + G * H).abs() < 1e-12, "{speed:?}");
    assert!(manifolds[0].normal_impulse() > 0.0 && manifolds[1].normal_impulse() == 0.0);
}

/// Boxes poured into a bin, a little askew: faces lie on faces in all ways, and rocking on a single point would show.
#[test]
fn boxes_poured_into_a_bin_come_to_rest() {
    let mut world = world();
    ground(&mut world, Vec3::ZERO);
    for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let wall = Vec3::new(if x == 0.0 { 9.0 } else { 1.0 }, if y == 0.0 { 9.0 } else { 1.0 }, 20.0);
        let at = Vec3::new(x * 3.85, y * 3.85, 10.0);
        world.add_static(Cuboid::new(wall).unwrap(), Pose::from_position(at)).unwrap();
    }
    for i in 0..396usize {
        let (x, y, z) = (i % 6, i / 6 % 6, i / 36);
        let jitter = |k: usize| ((i * 7919 + k * 104_729) % 1000) as f64 * 1e-4 - 0.05;
        let at = Vec3::new(x as f64 - 2.5, y as f64 - 2.5, 0.7 + z as f64 * 1.2) * 1.05;
        let turn = Quat::from_axis_angle(Vec3::new(1.0, 0.3, 0.2), jitter(3) * 4.0);
        let shape = Cuboid::new(Vec3::splat(0.9)).unwrap();
        let at = at + Vec3::new(jitter(1), jitter(2), 0.0);
        world.add_body(BodyBuilder::new().at(at).rotated(turn).with_shape(shape, 1000.0)).unwrap();
    }
    steps(&mut world, 60);
    for _ in 0..240 {
        assert!(world.step(H).unwrap().max_depth < 0.05);
    }
    for _ in 0..600 {
        assert!(world.step(H).unwrap().max_depth < 0.01);
    }
    for (_, body) in world.bodies() {
        assert!(!body.is_enabled(), "{:?} {:?}", body.position(), body.linear_velocity());
        let at = body.position();
        assert!(at.x.abs() < 3.0 && at.y.abs() < 3.0 && at.z > 0.4 && at.z < 12.0, "{at:?}");
    }
}

#[test]
fn far_from_the_origin_it_is_the_same() {
    let far = Vec3::new(1e7, -2e7, 1e7);
    let ((mut near, a), (mut away, b)) = (stack(Vec3::ZERO), stack(far));
    awake(&mut near);
    awake(&mut away);
    steps(&mut near, 120);
    steps(&mut away, 120);
    for (a, b) in a.iter().zip(&b) {
        let difference = away.body(*b).unwrap().position() - far - near.body(*a).unwrap().position();
        // A position of 2e7 m is known to 4e-9 m.
        assert!(difference.length() < 1e-6, "{difference:?}");
    }
}

#[test]
fn friction_holds_up_to_its_angle_in_every_heading() {
    let mu = 0.5;
    for heading in [0.0, 0.4, 0.785, 1.2] {
        for (tangent, slides) in [(0.47, false), (0.6, true)] {
            let angle = ferrode::math::real::atan(tangent);
            let tilt = Quat::from_axis_angle(Vec3::Z, heading) * Quat::from_axis_angle(Vec3::Y, angle);
            let mut world = world();
            awake(&mut world);
            world.set_default_material(Material::with_friction(mu)).unwrap();
            let slab = Cuboid::new(Vec3::new(100.0, 100.0, 2.0)).unwrap();
            world.add_static(slab, Pose::new(tilt.rotate(-Vec3::Z), tilt)).unwrap();
            let shape = Cuboid::new(Vec3::new(1.0, 1.0, 0.2)).unwrap();
            let body = world
                .add_body(
                    BodyBuilder::new().at(tilt.rotate(Vec3::Z * 0.1)).rotated(tilt).with_shape(shape, 1000.0),
                )
                .unwrap();
            steps(&mut world, 120);
            let moved = (world.body(body).unwrap().position() - tilt.rotate(Vec3::Z * 0.1)).length();
            if slides {
                // ½ g (sin − μ cos) t²
                let c = 1.0 / (1.0 + tangent * tangent).sqrt();
                let expected = 0.5 * G * (tangent - mu) * c * 4.0;
                assert!((moved / expected - 1.0).abs() < 0.03, "{heading}: {moved} of {expected}");
            } else {
                assert!(moved < 2e-3, "{heading}: {moved}");
            }
        }
    }
}

#[test]
fn balls_bounce_to_the_height_that_restitution_says() {
    for e in [0.0, 0.5, 0.9] {
        let mut world = world();
        world.set_default_material(Material::with_friction(0.5).with_restitution(e)).unwrap();
        ground(&mut world, Vec3::ZERO);
        let ball = BodyBuilder::new().at(Vec3::Z * 3.0).with_shape(Sphere::new(0.5).unwrap(), 1000.0);
        let ball = world.add_body(ball).unwrap();
        let (mut fell, mut highest) = (false, 0.0f64);
        for _ in 0..120 {
            world.step(H).unwrap();
            let body = world.body(ball).unwrap();
            fell |= body.linear_velocity().z >= 0.0 && body.position().z < 1.0;
            if fell {
                highest = highest.max(body.position().z - 0.5);
            }
        }
        let expected = e * e * 2.5;
        assert!((highest - expected).abs() < 0.05 * 2.5, "{e}: {highest} of {expected}");
    }
}

#[test]
fn a_belt_carries_a_box_and_friction_stops_a_ball() {
    let mut world = world();
    let belt = ground(&mut world, Vec3::ZERO);
    let moving =
        Material { motion: [1.5, 0.0], friction_direction: Some(Vec3::X), ..Material::with_friction(0.8) };
    world.set_material(belt, moving).unwrap();
    let carried = cube(&mut world, Vec3::Z * 0.5);
    steps(&mut world, 120);
    let v = world.body(carried).unwrap().linear_velocity();
    assert!((v.x.abs() - 1.5).abs() < 0.01 && v.y.abs() < 0.01, "{v:?}");

    let mut world = self::world();
    let rolling = Material { rolling: 0.02, ..Material::with_friction(0.8) };
    world.set_default_material(rolling).unwrap();
    ground(&mut world, Vec3::ZERO);
    let ball = BodyBuilder::new()
        .at(Vec3::Z * 0.5)
        .with_velocity(Vec3::X)
        .with_spin(Vec3::Y * 2.0)
        .with_shape(Sphere::new(0.5).unwrap(), 1000.0);
    let ball = world.add_body(ball).unwrap();
    steps(&mut world, 300);
    let body = world.body(ball).unwrap();
    // Deceleration g ρ/(r (1 + 2/5)), so v²/2a = 1.78 m.
    let expected = 0.5 / (G * 0.02 / (0.5 * 1.4));
    assert!(body.linear_velocity().length() < 0.01);
    assert!((body.position().x / expected - 1.0).abs() < 0.05, "{} of {expected}", body.position().x);
}

#[test]
fn joints_hold_limits_stop_and_motors_drive() {
    let mut world = world();
    awake(&mut world);
    // A pendulum of ten balls and sockets.
    let mut before = None;
    for i in 0..10 {
        let at = Vec3::new(f64::from(i) * 0.4 + 0.2, 0.0, 5.0);
        let shape = Sphere::new(0.1).unwrap();
        let body = world.add_body(BodyBuilder::new().at(at).with_shape(shape, 1000.0)).unwrap();
        let joint = world.create_joint::<Ball>(None).unwrap();
        world.attach(joint, Some(body), before).unwrap();
        world.joint_mut::<Ball>(joint).unwrap().set_anchor(Vec3::new(f64::from(i) * 0.4, 0.0, 5.0)).unwrap();
        before = Some(body);
    }
    // A wheel that a motor drives, and a door that falls to its stop.
    let wheel = cube(&mut world, Vec3::new(0.0, 10.0, 5.0));
    let axle = world.create_joint::<Hinge>(None).unwrap();
    world.attach(axle, Some(wheel), None).unwrap();
    let mut hinge = world.joint_mut::<Hinge>(axle).unwrap();
    hinge.set_anchor(Vec3::new(0.0, 10.0, 5.0)).unwrap();
    hinge.set_axis(Vec3::X).unwrap();
    hinge.set_motor(3.0, 1e4).unwrap();
    let door = cube(&mut world, Vec3::new(0.0, 20.0, 5.0));
    let pin = world.create_joint::<Hinge>(None).unwrap();
    world.attach(pin, Some(door), None).unwrap();
    let mut hinge = world.joint_mut::<Hinge>(pin).unwrap();
    hinge.set_anchor(Vec3::new(0.0, 20.5, 5.0)).unwrap();
    hinge.set_axis(Vec3::X).unwrap();
    hinge.set_limits(-0.5, 0.5).unwrap();
    let slide = cube(&mut world, Vec3::new(0.0, 30.0, 5.0));
    let rail = world.create_joint::<Slider>(None).unwrap();
    world.attach(rail, Some(slide), None).unwrap();
    world.joint_mut::<Slider>(rail).unwrap().set_axis(Vec3::Z).unwrap();
    world.joint_mut::<Slider>(rail).unwrap().set_limits(-1.0, 1.0).unwrap();
    let (mut worst, mut whip, mut angle) = (0.0f64, 0.0f64, 0.0f64);
    for _ in 0..300 {
        world.step(H).unwrap();
        for joint in world.joints().collect::<Vec<_>>() {
            let error = world.joint_error(joint).unwrap();
            if world.joint_type(joint).unwrap() == ferrode::JointType::Ball {
                whip = whip.max(error.position);
            } else {
                worst = worst.max(error.position);
            }
            angle = angle.max(error.angle);
        }
    }
    assert!(worst < 5e-3 && angle < 5e-3, "{worst} m, {angle} rad");
    // The chain cracks like a whip when it has fallen.
    assert!(whip < 0.03, "{whip} m");
    let rate = world.joint::<Hinge>(axle).unwrap().angle_rate();
    assert!((rate - 3.0).abs() < 1e-3, "{rate}");
    let stopped = world.joint::<Hinge>(pin).unwrap();
    assert!((stopped.angle().abs() - 0.5).abs() < 0.01, "{}", stopped.angle());
    let slid = 5.0 - world.body(slide).unwrap().position().z;
    assert!((slid - 1.0).abs() < 0.01, "{slid}");
}

#[test]
fn nothing_passes_a_thin_wall() {
    let mut world = world();
    world.set_gravity(Vec3::ZERO).unwrap();
    let wall = Cuboid::new(Vec3::new(0.02, 400.0, 400.0)).unwrap();
    world.add_static(wall, Pose::from_position(Vec3::X * 10.0)).unwrap();
    let mut bodies = Vec::new();
    for i in 0..200 {
        let speed = 50.0 + 2.25 * f64::from(i);
        let at = Vec3::new(-f64::from(i % 7), f64::from(i % 20) * 2.0 - 20.0, f64::from(i / 20) * 2.0 - 10.0);
        let builder = BodyBuilder::new().at(at).with_velocity(Vec3::new(speed, 0.0, 0.0));
        let builder = if i % 2 == 0 {
            builder.with_shape(Sphere::new(0.05).unwrap(), 1000.0)
        } else {
            let turn = Quat::from_axis_angle(Vec3::new(1.0, f64::from(i), 0.5), f64::from(i));
            builder.rotated(turn).with_shape(Cuboid::new(Vec3::splat(0.1)).unwrap(), 1000.0)
        };
        bodies.push(world.add_body(builder).unwrap());
    }
    for _ in 0..60 {
        world.step(H).unwrap();
        for body in &bodies {
            assert!(world.body(*body).unwrap().position().x < 10.01);
        }
    }
}

#[test]
fn sliding_over_tiles_keeps_its_line() {
    let mut world = world();
    awake(&mut world);
    world.set_default_material(Material::with_friction(0.0)).unwrap();
    for i in 0..25 {
        let tile = Cuboid::new(Vec3::new(1.0, 4.0, 1.0)).unwrap();
        world.add_static(tile, Pose::from_position(Vec3::new(f64::from(i), 0.0, -0.5))).unwrap();
    }
    let slider = BodyBuilder::new()
        .at(Vec3::new(0.0, 0.0, 0.1))
        .with_velocity(Vec3::X * 5.0)
        .with_shape(Cuboid::new(Vec3::new(0.4, 0.4, 0.2)).unwrap(), 1000.0);
    let slider = world.add_body(slider).unwrap();
    for _ in 0..240 {
        world.step(H).unwrap();
        let p = world.body(slider).unwrap().position();
        assert!(p.y.abs() < 1e-3 && (p.z - 0.1).abs() < 1e-3, "{p:?}");
    }
    assert!(world.body(slider).unwrap().position().x > 19.9);
}

/// Bits of all poses and velocities.
fn hash(world: &World) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    for (_, body) in world.bodies() {
        let (p, q) = (body.position(), body.quaternion());
        let (v, w) = (body.linear_velocity(), body.angular_velocity());
        for x in [p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z] {
            hash = (hash ^ x.to_bits()).wrapping_mul(0x0100_0000_01b3);
        }
    }
    hash
}

/// A heap with a chain in it.
fn heap() -> World {
    let mut world = world();
    awake(&mut world);
    ground(&mut world, Vec3::ZERO);
    for i in 0..60 {
        let turn = Quat::from_axis_angle(Vec3::new(1.0, 0.3, f64::from(i % 5)), 0.37 * f64::from(i));
        let at = Vec3::new(f64::from(i % 4) * 0.9, f64::from(i / 4 % 4) * 0.9, 1.0 + f64::from(i / 16) * 1.3);
        let builder = BodyBuilder::new().at(at).rotated(turn);
        let builder = match i % 3 {
            0 => builder.with_shape(Cuboid::new(Vec3::new(0.8, 0.5, 0.6)).unwrap(), 1000.0),
            1 => builder.with_shape(Sphere::new(0.35).unwrap(), 1000.0),
            _ => builder.with_shape(Capsule::new(0.2, 0.5).unwrap(), 1000.0),
        };
        world.add_body(builder).unwrap();
    }
    let bodies: Vec<BodyKey> = world.bodies().map(|(key, _)| key).collect();
    for pair in bodies[..8].windows(2) {
        let joint = world.create_joint::<Ball>(None).unwrap();
        world.attach(joint, Some(pair[0]), Some(pair[1])).unwrap();
        let middle =
            (world.body(pair[0]).unwrap().position() + world.body(pair[1]).unwrap().position()) * 0.5;
        world.joint_mut::<Ball>(joint).unwrap().set_anchor(middle).unwrap();
    }
    world
}

#[test]
fn lanes_of_every_width_give_the_same_bits_and_so_does_a_clone() {
    let run = |lanes: Option<Level>| {
        let mut world = heap();
        let mut settings = *world.dynamics().substep();
        settings.lanes = lanes;
        world.set_substep(settings).unwrap();
        steps(&mut world, 150);
        hash(&world)
    };
    let expected = run(None);
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        assert_eq!(run(Some(level)), expected, "{level:?}");
    }
    let mut world = heap();
    steps(&mut world, 70);
    let mut copy = world.clone();
    steps(&mut world, 80);
    steps(&mut copy, 80);
    assert_eq!((hash(&world), hash(&copy)), (expected, expected));
}

#[test]
fn geoms_come_and_go_and_events_tell() {
    let mut world = world();
    let floor = ground(&mut world, Vec3::ZERO);
    let body = cube(&mut world, Vec3::Z * 0.6);
    let geom = world.body_geoms(body).unwrap()[0];
    let mut began = 0;
    for _ in 0..30 {
        world.step(H).unwrap();
        let begin = |e: &&ContactEvent| matches!(e, ContactEvent::Begin(a, b) if [*a, *b].contains(&geom));
        began += world.contact_events().iter().filter(begin).count();
    }
    assert_eq!(began, 1);
    let force: Vec3 = world
        .contacts()
        .iter()
        .fold(Vec3::ZERO, |f, c| f + if c.first.body == Some(body) { c.force } else { -c.force });
    assert!((force - Vec3::Z * 1000.0 * G).length() < 20.0, "{force:?}");
    steps(&mut world, 90);
    assert!(!world.body(body).unwrap().is_enabled());
    // Without its floor the sleeper falls.
    world.remove_geom(floor).unwrap();
    steps(&mut world, 30);
    assert!(world.body(body).unwrap().position().z < 0.0);
    assert!(world.contacts().is_empty());
}

#[test]
fn contacts_made_by_hand_work() {
    use ferrode::dynamics;
    let mut world = dynamics::World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -G)).unwrap();
    let body = world.create_body();
    world.body_mut(body).unwrap().set_position(Vec3::Z).unwrap();
    let group = world.create_group();
    for _ in 0..240 {
        let at = world.body(body).unwrap().position();
        for (x, y) in [(0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)] {
            let position = at + Vec3::new(x, y, -0.5);
            let point = ferrode::ContactPoint { position, normal: Vec3::Z, depth: -position.z };
            if point.depth > -0.02 {
                let contact = dynamics::Contact::at(point, dynamics::Surface::with_friction(0.5));
                let joint = world.create_contact(Some(group), &contact).unwrap();
                world.attach(joint, Some(body), None).unwrap();
            }
        }
        world.step(Stepper::Substep, H).unwrap();
        world.empty_group(group).unwrap();
    }
    let z = world.body(body).unwrap().position().z;
    assert!((z - 0.5).abs() < 2e-3, "{z}");
}
