//! What `Direct` must solve where libode's exact solver gives up: stacks in exact contact, extreme masses, redundant supports.

use ferrode::prelude::*;
use ferrode_dynamics::{DirectSettings, StepReport};

const G: f64 = 9.81;

fn ground() -> Result<World, Error> {
    let mut world = World::new();
    world.stepper = Stepper::Direct;
    world.set_gravity(Vec3::new(0.0, 0.0, -G))?;
    world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    Ok(world)
}

fn cube(world: &mut World, at: Vec3, mass: f64) -> Result<BodyKey, Error> {
    world.add_body(BodyBuilder::new().at(at).with_shape(Cuboid::new(Vec3::splat(1.0))?, mass))
}

/// Every island certified, without help, in a few factorisations.
fn check(report: &StepReport, what: &str) {
    check_forces(report, what);
    assert!(report.solves.iter().all(|solve| !solve.fell_back), "{what}: {:?}", report.solves);
}

/// The same, but another method may have helped: Dantzig's gives up at ties on small islands.
fn check_forces(report: &StepReport, what: &str) {
    for solve in &report.solves {
        assert!(solve.certified(), "{what}: {solve:?}");
        assert!(solve.factorisations <= 200, "{what}: {solve:?}");
    }
    assert_eq!(report.lcp_failures, 0, "{what}");
    assert!(report.quarantined.is_empty(), "{what}");
}

/// Steps, checks each step, and returns the largest speed at the end.
fn settle(world: &mut World, steps: usize, h: f64, what: &str) -> Result<f64, Error> {
    for _ in 0..steps {
        check(&world.step(h)?.dynamics, what);
    }
    let speeds = world.bodies().map(|(_, b)| b.linear_velocity().length().max(b.angular_velocity().length()));
    Ok(speeds.fold(0.0, f64::max))
}

#[test]
fn four_equal_boxes_in_exact_contact_come_to_rest() -> Result<(), Error> {
    for h in [1.0 / 60.0, 1.0 / 240.0] {
        let mut world = ground()?;
        for i in 0..4 {
            cube(&mut world, Vec3::new(0.0, 0.0, 0.5 + f64::from(i)), 1.0)?;
        }
        let speed = settle(&mut world, 1000, h, "four boxes")?;
        println!("four boxes at h = {h:.4}: {speed:.1e} m/s");
        assert!(speed <= 1e-9);
        let mut square = ground()?;
        for i in 0..4 {
            cube(&mut square, Vec3::new(f64::from(i % 2), 0.0, 0.5 + f64::from(i / 2)), 1.0)?;
        }
        let speed = settle(&mut square, 1000, h, "a square of boxes")?;
        println!("a square of boxes at h = {h:.4}: {speed:.1e} m/s");
        assert!(speed <= 1e-9);
    }
    Ok(())
}

#[test]
fn an_aligned_tower_of_ten_stands() -> Result<(), Error> {
    for h in [1.0 / 60.0, 1.0 / 240.0] {
        let mut world = ground()?;
        let boxes: Vec<BodyKey> = (0..10)
            .map(|i| cube(&mut world, Vec3::new(0.0, 0.0, 0.5 + f64::from(i)), 1.0))
            .collect::<Result<_, _>>()?;
        let speed = settle(&mut world, 1000, h, "tower")?;
        println!("tower of ten at h = {h:.4}: {speed:.1e} m/s");
        assert!(speed <= 1e-9);
        for (i, key) in boxes.iter().enumerate() {
            let p = world.body(*key)?.position();
            assert!((p - Vec3::new(0.0, 0.0, 0.5 + i as f64)).length() < 1e-3, "box {i} at {p:?}");
        }
    }
    Ok(())
}

#[test]
fn a_thousandfold_mass_rests_on_a_light_one() -> Result<(), Error> {
    for h in [1.0 / 60.0, 1.0 / 240.0] {
        let mut world = ground()?;
        for (i, mass) in [1.0, 10.0, 100.0, 1000.0].into_iter().enumerate() {
            cube(&mut world, Vec3::new(0.0, 0.0, 0.5 + i as f64), mass)?;
        }
        let speed = settle(&mut world, 2000, h, "masses 1:10:100:1000")?;
        println!("masses 1:10:100:1000 at h = {h:.4}: {speed:.1e} m/s");
        assert!(speed <= 1e-9);
    }
    Ok(())
}

#[test]
fn a_touching_cradle_collides_all_at_once() -> Result<(), Error> {
    let mut world = World::new();
    world.stepper = Stepper::Direct;
    // The usual CFM of 1e-10 gives way by 1e-7 m/s under the force of 1,200 N that turns the ball round in a millisecond.
    world.parts_mut().0.set_cfm(0.0)?;
    let material =
        Material { restitution: 1.0, restitution_threshold: 0.0, friction: 0.0, ..Material::default() };
    let balls: Vec<BodyKey> = (0..5)
        .map(|i| {
            let ball =
                BodyBuilder::new().at(Vec3::new(f64::from(i), 0.0, 0.0)).with_shape(Sphere::new(0.5)?, 1.0);
            world.add_body(ball.with_material(material))
        })
        .collect::<Result<_, Error>>()?;
    world.body_mut(balls[0])?.set_linear_velocity(Vec3::new(1.0, 0.0, 0.0))?;
    check_forces(&world.step(0.001)?.dynamics, "cradle");
    let speeds: Vec<f64> =
        balls.iter().map(|b| Ok(world.body(*b)?.linear_velocity().x)).collect::<Result<_, Error>>()?;
    println!("cradle: {speeds:?}");
    // The four resting balls move as one of four times the mass: (1 − 4)/(1 + 4) and 2/(1 + 4).
    for (speed, expected) in speeds.iter().zip([-0.6, 0.4, 0.4, 0.4, 0.4]) {
        assert!((speed - expected).abs() < 1e-9, "{speeds:?}");
    }
    for _ in 0..200 {
        let step = world.step(0.001)?;
        assert!(step.max_depth < 1e-3);
    }
    Ok(())
}

#[test]
fn a_table_stands_on_four_legs_with_the_least_forces() -> Result<(), Error> {
    let mut world = ground()?;
    // 20 kg of table, its centre of mass off the middle; legs of 0.1 m at the corners of 2 m by 1 m.
    let mass = ferrode_dynamics::Mass::cuboid_total(20.0, Vec3::new(2.0, 1.0, 0.8))?;
    let off = Vec3::new(0.31, -0.12, 0.0);
    let mut table = BodyBuilder::new().at(Vec3::new(0.0, 0.0, 0.4)).with_mass(mass);
    for (sx, sy) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let place = Pose::new(Vec3::new(0.95 * sx, 0.45 * sy, 0.0) - off, Quat::IDENTITY);
        table = table.with_shape_at(Cuboid::new(Vec3::new(0.1, 0.1, 0.8))?, 1.0, place);
    }
    let frictionless = Material { friction: 0.0, ..Material::default() };
    let body = world.add_body(table.with_material(frictionless))?;
    for _ in 0..500 {
        check(&world.step(1.0 / 60.0)?.dynamics, "table");
    }
    let centre = world.body(body)?.position();
    let weight = world.body(body)?.mass().mass * G;
    let upward = |c: &ferrode::TouchingContact| if c.first.body.is_some() { c.force.z } else { -c.force.z };
    let points: Vec<(Vec3, f64)> =
        world.contacts().iter().map(|c| (c.point.position - centre, upward(c))).collect();
    assert_eq!(points.len(), 16);
    let sum: f64 = points.iter().map(|(_, f)| f).sum();
    let moment = points.iter().fold(Vec3::ZERO, |m, (p, f)| m + p.cross(Vec3::Z * *f));
    println!(
        "table: force {:.1e}, moment {:.1e} of weight and width",
        (sum - weight) / weight,
        moment.length() / (weight * 2.0)
    );
    assert!((sum - weight).abs() <= 1e-9 * weight);
    assert!(moment.length() <= 1e-9 * weight * 2.0);
    // The least forces of a given sum and moments are linear in the place: f = (1, x, y) · k, where k solves
    // Σ (1, x, y)(1, x, y)ᵀ k = (weight, 0, 0).
    let mut normal = [[0.0; 3]; 3];
    for (p, _) in &points {
        let row = [1.0, p.x, p.y];
        for i in 0..3 {
            for j in 0..3 {
                normal[i][j] += row[i] * row[j];
            }
        }
    }
    let inverse = ferrode_math::Mat3::from_rows(normal).inverse();
    let k = inverse.map_or(Vec3::ZERO, |m| m * Vec3::new(weight, 0.0, 0.0));
    let worst =
        points.iter().map(|(p, f)| (f - (k.x + k.y * p.x + k.z * p.y)).abs() / weight).fold(0.0, f64::max);
    println!("table: forces within {worst:.1e} of the weight from the least ones");
    assert!(worst <= 1e-6);
    Ok(())
}

#[test]
fn a_chain_carries_a_hundredfold_mass() -> Result<(), Error> {
    let mut world = World::new();
    world.stepper = Stepper::Direct;
    world.set_gravity(Vec3::new(0.0, 0.0, -G))?;
    let (mut last, mut joints) = (None, Vec::new());
    for i in 0..20 {
        let mass = if i == 19 { 100.0 } else { 1.0 };
        let shape = Cuboid::new(Vec3::new(0.05, 0.05, 0.2))?;
        let link = BodyBuilder::new().at(Vec3::new(0.0, 0.0, -0.2 * (f64::from(i) + 0.5)));
        let link = world.add_body(link.with_shape(shape, mass / (0.2 * 0.05 * 0.05)))?;
        joints.push(world.add_ball(Some(link), last, Vec3::new(0.0, 0.0, -0.2 * f64::from(i)))?);
        last = Some(link);
    }
    // The mass swings by a radian or so.
    if let Some(mass) = last {
        world.body_mut(mass)?.set_linear_velocity(Vec3::new(5.0, 1.0, 0.0))?;
    }
    let h = 1.0 / 240.0;
    let mut worst: f64 = 0.0;
    for _ in 0..1200 {
        check(&world.step(h)?.dynamics, "chain");
        for joint in &joints {
            worst = worst.max(world.dynamics().joint_error(*joint)?.position);
        }
    }
    println!("chain with an end mass of 100: joints within {worst:.1e} m");
    assert!(worst < 5e-3);
    Ok(())
}

#[test]
fn caches_change_no_bit() -> Result<(), Error> {
    let build = || -> Result<World, Error> {
        let mut world = ground()?;
        for i in 0..12 {
            let at = Vec3::new(
                1.02 * f64::from(i % 4) + 0.5 * f64::from(i / 4 % 2),
                0.0,
                0.499 + 0.998 * f64::from(i / 4),
            );
            cube(&mut world, at, 1.0 + f64::from(i % 3))?;
        }
        Ok(world)
    };
    let (mut warm, mut cold) = (build()?, build()?);
    cold.parts_mut().0.set_direct(DirectSettings { warm_start: false, ..DirectSettings::default() });
    for step in 0..150 {
        check(&warm.step(0.01)?.dynamics, "warm");
        check(&cold.step(0.01)?.dynamics, "cold");
        for ((_, a), (_, b)) in warm.bodies().zip(cold.bodies()) {
            assert_eq!(a.position(), b.position(), "step {step}");
            assert_eq!(a.angular_velocity(), b.angular_velocity(), "step {step}");
        }
        if step % 50 == 20 {
            // A clone has no caches.
            warm = warm.clone();
        }
    }
    Ok(())
}
