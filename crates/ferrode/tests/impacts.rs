//! Restitution pair after pair: `ImpactLaw::InTurn` of `Direct`.

use ferrode::prelude::*;
use ferrode::{DirectSettings, ImpactLaw};

fn world() -> World {
    let mut world = World::new();
    world.stepper = Stepper::Direct;
    world.set_direct(DirectSettings { impacts: ImpactLaw::InTurn, ..DirectSettings::default() });
    world
}

fn bouncing(restitution: f64) -> Material {
    Material { restitution, restitution_threshold: 0.0, friction: 0.0, ..Material::default() }
}

/// Balls of a diameter of 1 m in a row along x, each touching the next, with these densities.
fn row(world: &mut World, densities: &[f64], restitution: f64) -> Vec<BodyKey> {
    let ball = |(i, density): (usize, &f64)| {
        let ball = BodyBuilder::new().at(Vec3::new(i as f64, 0.0, 0.0));
        let ball = ball.with_shape(Sphere::new(0.5).unwrap(), *density).with_material(bouncing(restitution));
        world.add_body(ball).unwrap()
    };
    densities.iter().enumerate().map(ball).collect()
}

fn speeds(world: &World, balls: &[BodyKey]) -> Vec<f64> {
    balls.iter().map(|b| world.body(*b).unwrap().linear_velocity().x).collect()
}

fn assert_near(found: &[f64], expected: &[f64]) {
    let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(near && found.len() == expected.len(), "{found:?}, expected {expected:?}");
}

#[test]
fn as_many_balls_leave_a_cradle_as_arrive() {
    for arriving in 1..5 {
        let mut world = world();
        let balls = row(&mut world, &[1.0; 5], 1.0);
        for ball in &balls[..arriving] {
            world.body_mut(*ball).unwrap().set_linear_velocity(Vec3::X).unwrap();
        }
        world.step(0.001).unwrap();
        let mut expected = [0.0; 5];
        expected[5 - arriving..].fill(1.0);
        assert_near(&speeds(&world, &balls), &expected);
        for _ in 0..100 {
            assert!(world.step(0.001).unwrap().max_depth < 1e-6);
        }
        assert_near(&speeds(&world, &balls), &expected);
    }
}

#[test]
fn unequal_balls_hand_on_what_two_alone_would() {
    let (densities, e) = ([3.0, 1.0, 0.5, 2.0], 0.8);
    let mut world = world();
    let balls = row(&mut world, &densities, e);
    world.body_mut(balls[0]).unwrap().set_linear_velocity(Vec3::X).unwrap();
    world.step(0.001).unwrap();
    // By hand: two bodies with masses a and b at speeds u and v depart with e (u − v), and keep their momentum.
    let mut v = [1.0, 0.0, 0.0, 0.0];
    loop {
        let approach = |v: &[f64; 4], i: usize| v[i] - v[i + 1];
        let fastest = (0..3).max_by(|a, b| approach(&v, *a).total_cmp(&approach(&v, *b))).unwrap();
        if approach(&v, fastest) < 1e-12 {
            break;
        }
        let (a, b) = (densities[fastest], densities[fastest + 1]);
        let impulse = (1.0 + e) * approach(&v, fastest) * a * b / (a + b);
        v[fastest] -= impulse / a;
        v[fastest + 1] += impulse / b;
    }
    assert_near(&speeds(&world, &balls), &v);
    let momentum = |v: &[f64]| v.iter().zip(densities).map(|(v, m)| v * m).sum::<f64>();
    assert!((momentum(&v) - 3.0).abs() < 1e-9);
}

#[test]
fn a_box_lands_flat_and_rises_flat() {
    let mut world = world();
    world.set_gravity(Vec3::new(0.0, 0.0, -10.0)).unwrap();
    world.set_default_material(bouncing(1.0)).unwrap();
    world.add_static(Plane::new(Vec3::Z, 0.0).unwrap(), Pose::IDENTITY).unwrap();
    let cube = BodyBuilder::new()
        .at(Vec3::new(0.0, 0.0, 1.5))
        .with_shape(Cuboid::new(Vec3::new(1.0, 1.0, 1.0)).unwrap(), 1.0);
    let cube = world.add_body(cube.with_material(bouncing(1.0))).unwrap();
    let (mut highest, mut struck) = (0.0_f64, false);
    for _ in 0..900 {
        world.step(0.001).unwrap();
        let body = world.body(cube).unwrap();
        assert!(body.angular_velocity().length() < 1e-9, "it spins: {:?}", body.angular_velocity());
        struck |= body.linear_velocity().z > 0.0;
        if struck {
            highest = highest.max(body.position().z);
        }
    }
    // The last step before it strikes, and the depth it is pushed out of, cost or give some millimetres of the metre that it fell.
    assert!(struck && (highest - 1.5).abs() < 0.03, "{highest}");
}

#[test]
fn a_heap_comes_to_rest_as_well() {
    let mut world = world();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81)).unwrap();
    let material =
        Material { restitution: 0.4, restitution_threshold: 0.2, friction: 0.5, ..Material::default() };
    world.set_default_material(material).unwrap();
    world.add_static(Plane::new(Vec3::Z, 0.0).unwrap(), Pose::IDENTITY).unwrap();
    let cubes: Vec<BodyKey> = (0..24)
        .map(|i| {
            let place =
                Vec3::new(0.52 * f64::from(i % 3), 0.53 * f64::from(i / 3 % 2), 0.4 + 0.6 * f64::from(i / 6));
            let cube = BodyBuilder::new()
                .at(place)
                .with_shape(Cuboid::new(Vec3::new(0.5, 0.5, 0.5)).unwrap(), 100.0);
            world.add_body(cube.with_material(material)).unwrap()
        })
        .collect();
    for _ in 0..1500 {
        world.step(1.0 / 240.0).unwrap();
    }
    for cube in cubes {
        let body = world.body(cube).unwrap();
        assert!(body.linear_velocity().length() < 1e-2 && body.position().z > 0.24, "{body:?}");
    }
}
