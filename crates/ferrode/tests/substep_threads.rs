//! `Substep` gives the same bits on any number of threads and at every width of SIMD lanes.

use ferrode::math::simd::Level;
use ferrode::prelude::*;
use ferrode::{Ball, Hinge, Slider};

const H: f64 = 1.0 / 60.0;
const STEPS: usize = 600;

fn world() -> World {
    let mut world = World::new();
    world.stepper = Stepper::Substep;
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81)).unwrap();
    let slab = Cuboid::new(Vec3::new(100.0, 100.0, 2.0)).unwrap();
    world.add_static(slab, Pose::from_position(-Vec3::Z)).unwrap();
    world
}

fn add(world: &mut World, at: Vec3, turn: Quat, shape: impl Into<Shape>) -> BodyKey {
    world.add_body(BodyBuilder::new().at(at).rotated(turn).with_shape(shape, 1000.0)).unwrap()
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

/// Steps a scene with each kind of lanes and with 1, 2 and 4 threads. At some time so many bodies are awake and so many points touch
/// that work is shared out.
fn same_bits(scene: fn() -> World, bodies: usize, points: usize, mut act: impl FnMut(&mut World, usize)) {
    let mut run = |threads: usize, lanes: Option<Level>| {
        let mut world = scene();
        world.set_threads(threads);
        let mut settings = *world.dynamics().substep();
        settings.lanes = lanes;
        world.set_substep(settings).unwrap();
        let mut most = (0, 0);
        for i in 0..STEPS {
            act(&mut world, i);
            let step = world.step(H).unwrap();
            assert!(step.dynamics.quarantined.is_empty());
            most = (most.0.max(step.dynamics.bodies), most.1.max(step.contacts));
        }
        assert!(most.0 >= bodies && most.1 >= points, "{most:?}");
        hash(&world)
    };
    let expected = run(1, None);
    assert_eq!(run(2, None), expected, "2 threads");
    let levels = Level::ALL.into_iter().filter(|level| level.is_available() && *level != Level::best());
    for (level, threads) in levels.zip([4, 1, 2].into_iter().cycle()) {
        assert_eq!(run(threads, Some(level)), expected, "{threads} threads, {level:?}");
    }
}

#[test]
fn a_pyramid() {
    let scene = || {
        let mut world = world();
        for row in 0..30 {
            for i in 0..30 - row {
                let x = (f64::from(i) - 0.5 * f64::from(29 - row)) * 1.05;
                let at = Vec3::new(x, 0.0, 0.5 + f64::from(row));
                add(&mut world, at, Quat::IDENTITY, Cuboid::new(Vec3::splat(1.0)).unwrap());
            }
        }
        world
    };
    // Enough for two parts.
    same_bits(scene, 465, 3000, |_, _| {});
}

#[test]
fn a_bin_of_mixed_shapes() {
    let scene = || {
        let mut world = world();
        for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
            let wall = Vec3::new(if x == 0.0 { 8.0 } else { 1.0 }, if y == 0.0 { 8.0 } else { 1.0 }, 12.0);
            let at = Vec3::new(x * 3.3, y * 3.3, 6.0);
            world.add_static(Cuboid::new(wall).unwrap(), Pose::from_position(at)).unwrap();
        }
        let material =
            Material { restitution: 0.3, restitution_threshold: 0.5, ..Material::with_friction(0.6) };
        for i in 0..320u32 {
            let at = Vec3::new(
                f64::from(i % 7) * 0.8 - 2.4,
                f64::from(i / 7 % 7) * 0.8 - 2.4,
                0.5 + f64::from(i / 49) * 0.85,
            );
            let turn = Quat::from_axis_angle(Vec3::new(1.0, 0.3, f64::from(i % 5)), 0.37 * f64::from(i));
            let shape: Shape = match i % 4 {
                0 => Cuboid::new(Vec3::new(0.6, 0.4, 0.5)).unwrap().into(),
                1 => Sphere::new(0.3).unwrap().into(),
                2 => Capsule::new(0.2, 0.4).unwrap().into(),
                _ => Cylinder::new(0.25, 0.5).unwrap().into(),
            };
            let mut builder = BodyBuilder::new().at(at).rotated(turn).with_shape(shape, 1000.0);
            if i % 9 == 0 {
                builder = builder.with_material(material);
            }
            world.add_body(builder).unwrap();
        }
        world
    };
    same_bits(scene, 300, 600, |_, _| {});
}

#[test]
fn ragdolls() {
    let scene = || {
        let mut world = world();
        for i in 0..24u32 {
            let origin =
                Vec3::new(f64::from(i % 5) * 0.7, f64::from(i / 5 % 4) * 0.7, 1.2 + f64::from(i / 20) * 2.0);
            ragdoll(&mut world, origin);
        }
        for i in 0..112u32 {
            let at = Vec3::new(f64::from(i % 12) * 0.5 - 1.0, f64::from(i / 12) * 0.5 - 1.0, 4.5);
            add(&mut world, at, Quat::IDENTITY, Sphere::new(0.2).unwrap());
        }
        world
    };
    same_bits(scene, 280, 150, |_, _| {});
}

/// Torso, head, and limbs of one part each on hinges.
fn ragdoll(world: &mut World, at: Vec3) {
    let mut part = |centre: Vec3, radius, length| {
        add(world, at + centre, Quat::IDENTITY, Capsule::new(radius, length).unwrap())
    };
    let torso = part(Vec3::ZERO, 0.15, 0.4);
    let head = part(Vec3::Z * 0.55, 0.12, 0.1);
    let limbs: Vec<BodyKey> = [(-0.28, 0.1), (0.28, 0.1), (-0.12, -0.7), (0.12, -0.7)]
        .map(|(x, z)| part(Vec3::new(x, 0.0, z), 0.07, 0.4))
        .to_vec();
    let feet = part(Vec3::new(0.12, 0.1, -1.05), 0.06, 0.1);
    let neck = world.create_joint::<Ball>(None).unwrap();
    world.attach(neck, Some(torso), Some(head)).unwrap();
    world.joint_mut::<Ball>(neck).unwrap().set_anchor(at + Vec3::Z * 0.4).unwrap();
    let ends = [(-0.2, 0.3), (0.2, 0.3), (-0.12, -0.4), (0.12, -0.4)];
    let mut hinges: Vec<(BodyKey, BodyKey, Vec3)> =
        limbs.iter().zip(ends).map(|(limb, (x, z))| (torso, *limb, Vec3::new(x, 0.0, z))).collect();
    hinges.push((limbs[3], feet, Vec3::new(0.12, 0.0, -1.0)));
    for (a, b, anchor) in hinges {
        let joint = world.create_joint::<Hinge>(None).unwrap();
        world.attach(joint, Some(a), Some(b)).unwrap();
        let mut hinge = world.joint_mut::<Hinge>(joint).unwrap();
        hinge.set_anchor(at + anchor).unwrap();
        hinge.set_axis(Vec3::X).unwrap();
        hinge.set_limits(-1.5, 1.0).unwrap();
    }
}

/// A motor on a slider, a chain, a turning kinematic paddle, fast balls against thin walls, a body that is moved by hand.
#[test]
fn joints_kinematic_and_fast_bodies() {
    let scene = || {
        let mut world = world();
        let paddle = add(
            &mut world,
            Vec3::new(0.0, 0.0, 0.6),
            Quat::IDENTITY,
            Cuboid::new(Vec3::new(6.0, 0.3, 1.0)).unwrap(),
        );
        let body = world.body_mut(paddle).unwrap();
        body.set_kinematic();
        body.set_angular_velocity(Vec3::Z * 1.5).unwrap();
        let mut before = None;
        for i in 0..12u32 {
            let at = Vec3::new(f64::from(i) * 0.5 - 3.0, 4.0, 4.0);
            let link = add(&mut world, at, Quat::IDENTITY, Sphere::new(0.2).unwrap());
            let joint = world.create_joint::<Ball>(None).unwrap();
            world.attach(joint, Some(link), before).unwrap();
            world.joint_mut::<Ball>(joint).unwrap().set_anchor(at - Vec3::X * 0.25).unwrap();
            before = Some(link);
        }
        let car = add(
            &mut world,
            Vec3::new(0.0, -4.0, 0.5),
            Quat::IDENTITY,
            Cuboid::new(Vec3::splat(1.0)).unwrap(),
        );
        let rail = world.create_joint::<Slider>(None).unwrap();
        world.attach(rail, Some(car), None).unwrap();
        let mut slider = world.joint_mut::<Slider>(rail).unwrap();
        slider.set_axis(Vec3::X).unwrap();
        slider.set_limits(-3.0, 3.0).unwrap();
        slider.set_motor(1.0, 1e5).unwrap();
        for y in [-6.0, 6.0] {
            let wall = Cuboid::new(Vec3::new(12.0, 0.05, 6.0)).unwrap();
            world.add_static(wall, Pose::from_position(Vec3::new(0.0, y, 3.0))).unwrap();
        }
        for i in 0..240u32 {
            let at = Vec3::new(
                f64::from(i % 12) * 0.6 - 3.3,
                f64::from(i / 12 % 4) - 1.5,
                1.6 + f64::from(i / 48) * 0.7,
            );
            let ball = add(&mut world, at, Quat::IDENTITY, Sphere::new(0.25).unwrap());
            let speed = if i % 3 == 0 { 80.0 } else { 2.0 };
            let side = if i % 2 == 0 { Vec3::Y } else { -Vec3::Y };
            world.body_mut(ball).unwrap().set_linear_velocity(side * speed).unwrap();
        }
        world
    };
    same_bits(scene, 240, 100, |world, step| {
        if step % 100 == 50 {
            let key = world.bodies().map(|(key, _)| key).nth(step / 10).unwrap();
            let body = world.body_mut(key).unwrap();
            body.set_position(Vec3::new(0.5, 0.5, 5.0)).unwrap();
            body.set_linear_velocity(Vec3::Z * -3.0).unwrap();
            body.enable();
        }
    });
}

#[test]
fn worlds_share_helpers_and_clones_go_on_alike() {
    let mut world = world();
    // Enough for four parts.
    for i in 0..900u32 {
        let layer = f64::from(i / 100);
        let at = Vec3::new(f64::from(i % 10) * 0.9 + 0.3 * layer, f64::from(i / 10 % 10) * 0.9, 0.5 + layer);
        add(&mut world, at, Quat::IDENTITY, Cuboid::new(Vec3::splat(0.85)).unwrap());
    }
    world.set_threads(2);
    assert_eq!(world.threads(), 2);
    for _ in 0..20 {
        world.step(H).unwrap();
    }
    // Four at a time have one helper between them.
    let mut copies = vec![world.clone(), world.clone(), world.clone(), world.clone()];
    copies[3].set_threads(1);
    std::thread::scope(|scope| {
        for copy in &mut copies {
            scope.spawn(|| (0..60).for_each(|_| drop(copy.step(H).unwrap())));
        }
    });
    (0..60).for_each(|_| drop(world.step(H).unwrap()));
    assert!(copies.iter().all(|copy| hash(copy) == hash(&world)));
}
