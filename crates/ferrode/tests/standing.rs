//! Big piles under `Substep`: what is stacked stands, what is poured comes to rest and sleeps.

use ferrode::prelude::*;

const H: f64 = 1.0 / 60.0;

fn world() -> World {
    let mut world = World::new();
    world.stepper = Stepper::Substep;
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81)).unwrap();
    world.set_default_material(Material::with_friction(0.6)).unwrap();
    let slab = Cuboid::new(Vec3::new(200.0, 200.0, 2.0)).unwrap();
    world.add_static(slab, Pose::from_position(-Vec3::Z)).unwrap();
    world
}

/// 820 boxes, kept awake.
#[test]
fn a_pyramid_of_forty_rows_stands_for_a_minute() {
    let mut world = world();
    let mut settings = *world.dynamics().substep();
    settings.sleep_speed = 0.0;
    world.set_substep(settings).unwrap();
    let cube = Cuboid::new(Vec3::splat(1.0)).unwrap();
    let mut bodies = Vec::new();
    for row in 0..40 {
        for i in 0..40 - row {
            let x = (f64::from(i) - 0.5 * f64::from(39 - row)) * 1.02;
            let at = Vec3::new(x, 0.0, 0.5 + f64::from(row));
            let body = world.add_body(BodyBuilder::new().at(at).with_shape(cube, 1000.0)).unwrap();
            bodies.push((body, at));
        }
    }
    let moved = |world: &World| {
        let far = bodies.iter().map(|(b, at)| (world.body(*b).unwrap().position() - *at).length());
        far.fold(0.0, f64::max)
    };
    for _ in 0..600 {
        world.step(H).unwrap();
    }
    let early = moved(&world);
    for _ in 600..3600 {
        world.step(H).unwrap();
    }
    let late = moved(&world);
    println!("moved by {early:.4} m in 10 s, {late:.4} m in 60 s");
    assert!(late < 0.1, "{late}");
}

/// 400 boxes of different sizes, poured onto a heap.
#[test]
fn a_heap_comes_to_rest_and_sleeps() {
    let mut world = world();
    let mut bodies = Vec::new();
    for i in 0..400 {
        let size = 0.3 + 0.1 * f64::from(i % 5);
        let cube = Cuboid::new(Vec3::new(size, 0.8 * size, 0.6 * size)).unwrap();
        let turn = Quat::from_axis_angle(Vec3::new(1.0, 0.3, f64::from(i % 7)), 0.37 * f64::from(i));
        let at = Vec3::new(f64::from(i % 5) * 0.8, f64::from(i / 5 % 5) * 0.8, 1.0 + f64::from(i / 25) * 0.9);
        bodies.push(world.add_body(BodyBuilder::new().at(at).rotated(turn).with_shape(cube, 500.0)).unwrap());
    }
    let asleep =
        |world: &World| bodies.iter().filter(|body| !world.body(**body).unwrap().is_enabled()).count();
    let mut steps = 0;
    while asleep(&world) < bodies.len() && steps < 1800 {
        world.step(H).unwrap();
        steps += 1;
    }
    println!("all asleep after {:.1} s", f64::from(steps) * H);
    assert_eq!(asleep(&world), bodies.len());
    assert!(bodies.iter().all(|body| world.body(*body).unwrap().position().z > 0.0));
}
