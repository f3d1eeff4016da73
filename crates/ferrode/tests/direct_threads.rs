//! `Direct` gives the same bits on any number of threads.

use ferrode::Hinge;
use ferrode::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const STEPS: usize = 240;

/// Arms of six hinges with motors and limits, each on a foot of its own, heaps of boxes that overlap in part, and boxes by themselves:
/// more islands than are solved at a time, of every method.
fn scene() -> World {
    let mut world = World::new();
    world.stepper = Stepper::Direct;
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81)).unwrap();
    let slab = Cuboid::new(Vec3::new(100.0, 100.0, 2.0)).unwrap();
    world.add_static(slab, Pose::from_position(-Vec3::Z)).unwrap();
    let shape = Cuboid::new(Vec3::new(0.1, 0.1, 0.3)).unwrap();
    for arm in 0..24 {
        let x = 2.0 * f64::from(arm);
        let mut before = None;
        for i in 0..6 {
            let z = 0.5 + 0.35 * f64::from(i);
            let link = BodyBuilder::new().at(Vec3::new(x, 0.0, z)).with_shape(shape, 1000.0);
            let link = world.add_body(link).unwrap();
            let axis = if i % 2 == 0 { Vec3::X } else { Vec3::Y };
            let anchor = Vec3::new(x, 0.0, z - 0.175);
            let hinge = world.add_hinge(Some(link), before, anchor, axis).unwrap();
            let mut hinge = world.joint_mut::<Hinge>(hinge).unwrap();
            hinge.set_limits(-0.6, 0.4 + 0.01 * f64::from(arm)).unwrap();
            hinge.set_motor(0.3 - 0.02 * f64::from(arm), 0.5 * f64::from(i)).unwrap();
            before = Some(link);
        }
    }
    for heap in 0..10 {
        for i in 0..heap {
            let turn = Quat::from_axis_angle(Vec3::new(1.0, 0.3, 0.2 * f64::from(i)), 0.4 * f64::from(i));
            let at = Vec3::new(3.0 * f64::from(heap), 5.0, 0.4 + 0.45 * f64::from(i));
            let cube = Cuboid::new(Vec3::splat(0.4)).unwrap();
            world.add_body(BodyBuilder::new().at(at).rotated(turn).with_shape(cube, 700.0)).unwrap();
        }
    }
    world
}

/// Bits of all poses, velocities, forces of joints, and of what the report says of each island.
fn run(threads: usize) -> (u64, usize) {
    let mut world = scene();
    world.set_threads(threads);
    let (mut hash, mut most) = (0xcbf2_9ce4_8422_2325u64, 0);
    let mut add = |x: f64| hash = (hash ^ x.to_bits()).wrapping_mul(0x0100_0000_01b3);
    for _ in 0..STEPS {
        let step = world.step(1.0 / 240.0).unwrap();
        assert!(step.dynamics.quarantined.is_empty());
        most = most.max(step.dynamics.islands);
        for solve in &step.dynamics.solves {
            let told =
                [solve.rows as f64, f64::from(solve.factorisations), solve.residual, solve.largest_force];
            told.into_iter().for_each(&mut add);
        }
    }
    for (_, body) in world.bodies() {
        let (p, q) = (body.position(), body.quaternion());
        let (v, w) = (body.linear_velocity(), body.angular_velocity());
        let state = [p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z];
        state.into_iter().for_each(&mut add);
    }
    (hash, most)
}

#[test]
fn islands_are_solved_to_the_same_bits() {
    let (expected, islands) = run(1);
    assert!(islands > 32, "{islands}");
    for threads in [2, 3, 4] {
        assert_eq!(run(threads).0, expected, "{threads} threads");
    }
}

/// Worlds with callbacks are stepped island after island; here only that each is called once a step, to the same end.
#[test]
fn worlds_with_callbacks_end_alike() {
    let run = |threads: usize| {
        let mut world = scene();
        world.set_threads(threads);
        let heard = Arc::new(AtomicUsize::new(0));
        let counter = heard.clone();
        let key = world.bodies().map(|(key, _)| key).next().unwrap();
        let slow_down = move |_: BodyKey, body: &mut ferrode::Body| {
            counter.fetch_add(1, Ordering::Relaxed);
            let v = body.linear_velocity();
            body.set_linear_velocity(v * 0.5).unwrap();
        };
        world.body_mut(key).unwrap().set_moved_callback(Some(Arc::new(slow_down)));
        for _ in 0..60 {
            world.step(1.0 / 240.0).unwrap();
        }
        let speed: f64 = world.bodies().map(|(_, body)| body.linear_velocity().length()).sum();
        (heard.load(Ordering::Relaxed), speed.to_bits())
    };
    let alone = run(1);
    assert_eq!(alone.0, 60);
    assert_eq!(run(2), alone);
}
