//! Coulomb's cone in `Direct`: friction is the same in every direction.

use ferrode::prelude::*;
use ferrode::{Convex, DirectSettings, FrictionLaw};
use ferrode_math::real;

const G: f64 = 9.81;
const HEADINGS: [f64; 4] = [0.0, 15.0, 30.0, 45.0];

/// A block on the ground, whose gravity leans by `slope` (as a tangent) toward a heading in degrees: a slope that runs down
/// across the block at any angle.
fn block(law: FrictionLaw, material: Material, slope: f64, heading: f64) -> Result<(World, BodyKey), Error> {
    let mut world = World::new();
    world.stepper = Stepper::Direct;
    let settings = DirectSettings { friction: law, ..*world.direct() };
    world.set_direct(settings);
    let lean = real::atan(slope);
    let (sin, cos) = (real::sin(heading.to_radians()), real::cos(heading.to_radians()));
    let down = real::sin(lean);
    world.set_gravity(Vec3::new(down * cos, down * sin, -real::cos(lean)) * G)?;
    world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    for geom in world.geoms().map(|geom| geom.key).collect::<Vec<_>>() {
        world.set_material(geom, Material::with_friction(f64::INFINITY))?;
    }
    let block = BodyBuilder::new()
        .at(Vec3::new(0.0, 0.0, 0.1 - 1e-6))
        .with_shape(Cuboid::new(Vec3::new(0.6, 0.4, 0.2))?, 500.0)
        .with_material(material);
    let key = world.add_body(block)?;
    Ok((world, key))
}

#[test]
fn a_block_sticks_and_slides_at_the_same_slope_whatever_its_heading() -> Result<(), Error> {
    let (h, mu) = (0.005, 0.5);
    for heading in HEADINGS {
        for (part, slides) in [(0.99, false), (1.01, true)] {
            let (mut world, key) = block(FrictionLaw::Cone, Material::with_friction(mu), part * mu, heading)?;
            for _ in 0..400 {
                world.step(h)?;
            }
            let body = world.body(key)?;
            let v = body.linear_velocity();
            let speed = (v.x * v.x + v.y * v.y).sqrt();
            println!("{heading}° at {part} µ: {speed:.2e} m/s");
            if slides {
                // g (sin θ − µ cos θ) for two seconds.
                let lean = real::atan(part * mu);
                let expected = 2.0 * G * (real::sin(lean) - mu * real::cos(lean));
                assert!((speed - expected).abs() < 0.01 * expected, "{heading}: {speed} of {expected}");
            } else {
                assert!(speed < 1e-6, "{heading}: creeps at {speed}");
            }
        }
    }
    Ok(())
}

#[test]
fn a_block_slides_down_with_the_same_acceleration_whatever_its_heading() -> Result<(), Error> {
    let (h, mu, slope) = (0.005, 0.4, 0.8);
    for heading in HEADINGS {
        let (mut world, key) = block(FrictionLaw::Cone, Material::with_friction(mu), slope, heading)?;
        let mut sweeps = 0;
        for _ in 0..200 {
            let report = world.step(h)?.dynamics;
            sweeps = sweeps.max(report.solves.iter().map(|solve| solve.friction_sweeps).max().unwrap_or(0));
            assert_eq!(report.lcp_failures, 0, "{heading}: {:?}", report.solves);
        }
        let v = world.body(key)?.linear_velocity();
        let lean = real::atan(slope);
        let expected = G * (real::sin(lean) - mu * real::cos(lean));
        let (sin, cos) = (real::sin(heading.to_radians()), real::cos(heading.to_radians()));
        let (along, across) = (v.x * cos + v.y * sin, v.y * cos - v.x * sin);
        println!("{heading}°: {along:.5} of {expected:.5} m/s, {across:.1e} across, {sweeps} sweeps at most");
        assert!((along - expected).abs() < 0.01 * expected, "{heading}: {along} of {expected}");
        assert!(across.abs() < 0.01 * expected, "{heading}: {across} across");
    }
    // The pyramid, ODE's law, is stronger across its tangents.
    let (mut world, key) = block(FrictionLaw::Pyramid, Material::with_friction(mu), slope, 45.0)?;
    for _ in 0..200 {
        world.step(h)?;
    }
    let lean = real::atan(slope);
    let expected = G * (real::sin(lean) - mu * real::cos(lean));
    assert!(world.body(key)?.linear_velocity().length() < 0.8 * expected);
    Ok(())
}

/// Different coefficients along and across a direction: the cone is elliptic, and friction is that of the greatest dissipation.
#[test]
fn an_elliptic_cone_turns_a_sliding_block_to_its_smooth_side() -> Result<(), Error> {
    let material = Material {
        friction: 0.6,
        friction2: Some(0.3),
        friction_direction: Some(Vec3::X),
        ..Material::default()
    };
    // Along each axis its own coefficient.
    for (heading, mu) in [(0.0, 0.6), (90.0, 0.3)] {
        let (mut world, key) = block(FrictionLaw::Cone, material, 1.0, heading)?;
        for _ in 0..200 {
            world.step(0.005)?;
        }
        let lean = real::atan(1.0);
        let expected = G * (real::sin(lean) - mu * real::cos(lean));
        let speed = world.body(key)?.linear_velocity().length();
        assert!((speed - expected).abs() < 0.01 * expected, "{heading}: {speed} of {expected}");
    }
    Ok(())
}

/// Twenty-five balls on a box that is pulled over the ground (the rolling test of SimBenchmark): the balls roll, so that the
/// box feels 2/7 of their mass.
#[test]
fn a_box_that_carries_balls_is_pulled_as_its_closed_form_says() -> Result<(), Error> {
    let (h, force, seconds) = (0.002, 150.0, 1.0);
    for heading in [0.0, 60.0_f64] {
        let mut world = World::new();
        world.stepper = Stepper::Direct;
        let settings = DirectSettings { friction: FrictionLaw::Cone, ..*world.direct() };
        world.set_direct(settings);
        world.set_gravity(Vec3::new(0.0, 0.0, -G))?;
        let ground = world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
        world.set_material(ground, Material::with_friction(0.4))?;
        let sides = Vec3::new(20.0, 20.0, 1.0);
        let rough = Material::with_friction(0.8);
        let plate = BodyBuilder::new()
            .at(Vec3::new(0.0, 0.0, 0.5))
            .with_mass(Mass::cuboid_total(10.0, sides)?)
            .with_shape(Cuboid::new(sides)?, 0.0)
            .with_material(rough);
        let plate = world.add_body(plate)?;
        for i in 0..25 {
            let (x, y) = (f64::from(i % 5) - 2.0, f64::from(i / 5) - 2.0);
            let ball = BodyBuilder::new()
                .at(Vec3::new(2.0 * x, 2.0 * y, 1.5))
                .with_mass(Mass::sphere_total(1.0, 0.5)?)
                .with_shape(Sphere::new(0.5)?, 0.0)
                .with_material(rough);
            world.add_body(ball)?;
        }
        let pull = Vec3::new(real::cos(heading.to_radians()), real::sin(heading.to_radians()), 0.0);
        for _ in 0..(seconds / h) as u32 {
            world.body_mut(plate)?.add_force(pull * force)?;
            world.step(h)?;
        }
        let expected = (force - 0.4 * 35.0 * G) / (10.0 + 25.0 * 2.0 / 7.0) * seconds;
        let v = world.body(plate)?.linear_velocity();
        println!("{heading}°: {:.5} of {expected:.5} m/s", v.dot(pull));
        assert!((v.dot(pull) - expected).abs() < 0.01 * expected, "{heading}: {v:?} of {expected}");
        assert!((v - pull * v.dot(pull)).length() < 0.01 * expected, "{heading}: {v:?}");
    }
    Ok(())
}

/// A heap at rest: the cone's forces hold it as the pyramid's do.
#[test]
fn a_heap_comes_to_rest_in_the_cone() -> Result<(), Error> {
    let mut world = World::new();
    world.stepper = Stepper::Direct;
    let settings = DirectSettings { friction: FrictionLaw::Cone, ..*world.direct() };
    world.set_direct(settings);
    world.set_gravity(Vec3::new(0.0, 0.0, -G))?;
    world.set_contact_surface_layer(1e-3)?;
    world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    let wedge: Vec<Vec3> = [
        [-0.5, -0.4, 0.0],
        [0.5, -0.4, 0.0],
        [-0.5, 0.4, 0.0],
        [0.5, 0.4, 0.0],
        [-0.2, 0.0, 0.5],
        [0.3, 0.0, 0.5],
    ]
    .map(|[x, y, z]| Vec3::new(x, y, z))
    .into();
    let wedge = Convex::from_points(&wedge)?;
    for i in 0..12 {
        let place = Vec3::new(0.15 * f64::from(i % 3), 0.1 * f64::from(i % 2), 0.4 + 0.7 * f64::from(i));
        let builder = BodyBuilder::new().at(place);
        let builder = if i % 2 == 0 {
            builder.with_shape(wedge.clone(), 300.0)
        } else {
            builder.with_shape(Cuboid::new(Vec3::new(0.6, 0.5, 0.4))?, 300.0)
        };
        world.add_body(builder)?;
    }
    let (mut partly, mut solves) = (0, 0);
    for _ in 0..1000 {
        let report = world.step(0.005)?.dynamics;
        partly += report.lcp_failures;
        solves += report.solves.len();
    }
    let fastest = world.bodies().map(|(_, b)| b.linear_velocity().length()).fold(0.0, f64::max);
    println!("{fastest:.2e} m/s, {partly} of {solves} islands in part");
    assert!(fastest < 1e-3, "{fastest}");
    assert!(20 * partly < solves, "{partly} of {solves} islands in part");
    Ok(())
}
