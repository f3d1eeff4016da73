//! Joints under `Direct` with `project_joints`: bodies end each step where their joints hold together.

use ferrode::math::real;
use ferrode::prelude::*;
use ferrode::{DirectSettings, mass_of};

const G: f64 = 9.81;

fn world(project_joints: bool) -> World {
    let mut world = World::new();
    world.stepper = Stepper::Direct;
    world.set_gravity(Vec3::new(0.0, 0.0, -G)).unwrap();
    let settings = DirectSettings { project_joints, ..*world.dynamics().direct() };
    world.parts_mut().0.set_direct(settings);
    world
}

/// A box that meets nothing.
fn link(world: &mut World, at: Vec3, sides: Vec3, mass: f64) -> BodyKey {
    let shape: Shape = Cuboid::new(sides).unwrap().into();
    let mass = mass_of(&shape, mass / (sides.x * sides.y * sides.z)).unwrap();
    world.add_body(BodyBuilder::new().at(at).with_mass(mass)).unwrap()
}

/// Links of 0.2 m on ball joints, horizontal at first, hung up at one end.
fn chain(world: &mut World, n: usize) -> Vec<BodyKey> {
    let mut last = None;
    (0..n)
        .map(|i| {
            let x = 0.2 * i as f64;
            let body = link(world, Vec3::new(x + 0.1, 0.0, 0.0), Vec3::new(0.2, 0.05, 0.05), 0.2);
            world.add_ball(Some(body), last, Vec3::new(x, 0.0, 0.0)).unwrap();
            last = Some(body);
            body
        })
        .collect()
}

/// Largest error of all joints, in metres and radians.
fn errors(world: &World) -> (f64, f64) {
    let all = world.joints().map(|joint| world.joint_error(joint).unwrap());
    all.fold((0.0, 0.0), |worst: (f64, f64), e| (worst.0.max(e.position), worst.1.max(e.angle)))
}

/// Steps, and finds the largest errors on the way.
fn run(world: &mut World, h: f64, seconds: f64) -> (f64, f64) {
    let mut worst = (0.0f64, 0.0f64);
    for _ in 0..(seconds / h) as usize {
        let step = world.step(h).unwrap().dynamics;
        assert!(step.quarantined.is_empty());
        assert!(step.solves.iter().all(|solve| solve.certified()));
        let (position, angle) = errors(world);
        worst = (worst.0.max(position), worst.1.max(angle));
    }
    worst
}

#[test]
fn long_and_coarse_chains_stay_together() {
    for (n, h) in [(320, 1.0 / 400.0), (20, 1.0 / 60.0)] {
        let [plain, projected] = [false, true].map(|project| {
            let mut world = world(project);
            chain(&mut world, n);
            run(&mut world, h, 5.0).0
        });
        println!(
            "chain of {n} at {h:.4} s: joints within {projected:.1e} m, without projection {plain:.1e} m"
        );
        assert!(projected < 1e-4, "{projected:e}");
        assert!(projected < 0.1 * plain);
    }
}

/// The angle of a link to the x axis about y, which points down for positive angles.
fn angle(world: &World, body: BodyKey) -> f64 {
    let x = world.body(body).unwrap().rotation() * Vec3::X;
    real::atan2(-x.z, x.x)
}

#[test]
fn a_projected_pendulum_moves_as_the_law_says() {
    // A rod of length l on a hinge at its end: θ'' = 3 g / (2 l) cos θ. By Runge and Kutta, and by steps that get smaller.
    let (l, end) = (1.0, 1.0);
    let exact = {
        let (mut theta, mut omega, n) = (0.0f64, 0.0f64, 100_000);
        let h = end / f64::from(n);
        let f = |theta: f64| 1.5 * G / l * real::cos(theta);
        for _ in 0..n {
            let [k1, m1] = [omega, f(theta)];
            let [k2, m2] = [omega + 0.5 * h * m1, f(theta + 0.5 * h * k1)];
            let [k3, m3] = [omega + 0.5 * h * m2, f(theta + 0.5 * h * k2)];
            let [k4, m4] = [omega + h * m3, f(theta + h * k3)];
            theta += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            omega += h / 6.0 * (m1 + 2.0 * m2 + 2.0 * m3 + m4);
        }
        theta
    };
    let errors: Vec<f64> = [200.0, 400.0, 800.0]
        .map(|per_second| {
            let mut world = world(true);
            // Thin enough for the inertia of a rod to 1e-6.
            let rod = link(&mut world, Vec3::new(0.5 * l, 0.0, 0.0), Vec3::new(l, 1e-3, 1e-3), 1.0);
            world.add_hinge(Some(rod), None, Vec3::ZERO, Vec3::Y).unwrap();
            let (position, _) = run(&mut world, 1.0 / per_second, end);
            assert!(position < 1e-7, "{position:e}");
            (angle(&world, rod) - exact).abs()
        })
        .to_vec();
    println!("errors of the angle after {end} s: {errors:?}");
    // First order, and no worse than the step allows.
    for pair in errors.windows(2) {
        assert!((1.7..2.3).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
    assert!(errors[2] < 0.02);
}

/// Two arms and a coupler on four hinges, one of them more than the plane needs: redundant rows.
fn four_bar(world: &mut World) -> BodyKey {
    let arm = Vec3::new(0.05, 0.05, 1.0);
    let a = link(world, Vec3::new(0.0, 0.0, 0.5), arm, 1.0);
    let b = link(world, Vec3::new(1.5, 0.0, 0.5), arm, 1.0);
    let coupler = link(world, Vec3::new(0.75, 0.0, 1.0), Vec3::new(1.5, 0.05, 0.05), 2.0);
    let mut hinge = |first, second, at| world.add_hinge(Some(first), second, at, Vec3::Y).unwrap();
    hinge(a, None, Vec3::ZERO);
    hinge(b, None, Vec3::new(1.5, 0.0, 0.0));
    hinge(coupler, Some(a), Vec3::Z);
    hinge(coupler, Some(b), Vec3::new(1.5, 0.0, 1.0));
    coupler
}

#[test]
fn redundant_loops_close() {
    let mut world = world(true);
    let coupler = four_bar(&mut world);
    world.body_mut(coupler).unwrap().set_linear_velocity(Vec3::new(3.0, 0.0, 0.0)).unwrap();
    let (position, angle) = run(&mut world, 1.0 / 60.0, 10.0);
    println!("four-bar: {position:.1e} m, {angle:.1e} rad");
    assert!(position < 1e-3 && angle < 1e-3);
}
