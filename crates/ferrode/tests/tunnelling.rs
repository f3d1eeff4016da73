//! Fast bodies against thin things under `Substep`: none passes, whatever its shape and however it spins. And floors of many parts:
//! what slides and rolls over them keeps its line.

use ferrode::math::random::OdeRandom;
use ferrode::prelude::*;
use ferrode::{Heightfield, TriMesh};

const H: f64 = 1.0 / 60.0;

fn world(gravity: f64) -> World {
    let mut world = World::new();
    world.stepper = Stepper::Substep;
    world.set_gravity(Vec3::new(0.0, 0.0, -gravity)).unwrap();
    let mut settings = *world.dynamics().substep();
    settings.sleep_speed = 0.0;
    world.set_substep(settings).unwrap();
    world
}

/// A number between two others.
fn between(random: &mut OdeRandom, lo: f64, hi: f64) -> f64 {
    lo + (hi - lo) * random.next_real()
}

/// Shoots 1,000 small spheres and thin plates downwards at 50 to 500 m/s, spinning, at something level at height zero that is 40 m by 40 m or more;
/// returns those whose centre comes below `floor`, a height.
fn shoot(mut world: World, floor: f64) -> Vec<String> {
    let mut random = OdeRandom::new(7);
    let mut shot = Vec::new();
    for i in 0..1000 {
        let at =
            Vec3::new(f64::from(i % 32) - 15.5, f64::from(i / 32) - 15.5, between(&mut random, 1.0, 9.0));
        let speed = between(&mut random, 50.0, 500.0);
        let aside = Vec3::new(between(&mut random, -0.1, 0.1), between(&mut random, -0.1, 0.1), -1.0);
        let spin = random.next_vector(30.0);
        let builder = BodyBuilder::new().at(at).with_velocity(aside * speed).with_spin(spin);
        let (builder, what) = if i % 2 == 0 {
            (builder.with_shape(Sphere::new(0.03).unwrap(), 1000.0), "sphere")
        } else {
            let turn = Quat::from_axis_angle(random.next_vector(1.0), random.next_signed(3.0));
            (
                builder.rotated(turn).with_shape(Cuboid::new(Vec3::new(0.2, 0.15, 0.01)).unwrap(), 1000.0),
                "plate",
            )
        };
        shot.push((world.add_body(builder).unwrap(), format!("{what} {i} at {speed:.0} m/s")));
    }
    let mut passed = Vec::new();
    for step in 0..120 {
        world.step(H).unwrap();
        shot.retain(|(body, what)| {
            let p = world.body(*body).unwrap().position();
            let through = p.z < floor && p.x.abs() < 19.0 && p.y.abs() < 19.0;
            if through {
                passed.push(format!("{what}: step {step}, {p:?}"));
            }
            !through
        });
    }
    passed
}

#[test]
fn nothing_passes_a_thin_plate() {
    let mut world = world(9.81);
    world.add_static(Cuboid::new(Vec3::new(40.0, 40.0, 0.02)).unwrap(), Pose::IDENTITY).unwrap();
    let passed = shoot(world, -0.01);
    assert!(passed.is_empty(), "{} passed: {passed:#?}", passed.len());
}

/// A flat mesh of `2 n²` triangles with sides of 40 m.
fn sheet(n: u32) -> TriMesh {
    let step = 40.0 / f64::from(n);
    let vertices = (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j)));
    let vertices: Vec<Vec3> = vertices
        .map(|(i, j)| Vec3::new(f64::from(i) * step - 20.0, f64::from(j) * step - 20.0, 0.0))
        .collect();
    let mut triangles = Vec::new();
    for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let a = j * (n + 1) + i;
        triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
    }
    TriMesh::new(vertices, triangles).unwrap()
}

#[test]
fn nothing_passes_a_mesh() {
    let mut world = world(9.81);
    world.add_static(sheet(40), Pose::IDENTITY).unwrap();
    let passed = shoot(world, 0.0);
    assert!(passed.is_empty(), "{} passed: {passed:#?}", passed.len());
}

#[test]
fn nothing_passes_a_heightfield() {
    let mut world = world(9.81);
    let heights = (0..81 * 81).map(|i| 0.2 * f64::from((i % 81 * 7 + i / 81 * 3) % 5)).collect();
    let field = Heightfield::new(40.0, 40.0, 81, 81, heights, 0.0).unwrap();
    world.add_static(field, Pose::new(Vec3::ZERO, Heightfield::z_up())).unwrap();
    // The lowest samples are at zero.
    let passed = shoot(world, 0.0);
    assert!(passed.is_empty(), "{} passed: {passed:#?}", passed.len());
}

/// A floor of tiles of 1 m, or of triangles half a tile each whose corners are shifted so that edges run in all directions.
fn floor(world: &mut World, triangles: bool) {
    if triangles {
        let (columns, rows) = (26_u32, 6_u32);
        let corner = |i: u32, j: u32| {
            let shift = |k: u32| 0.15 * (f64::from((i * 7 + j * 13 + k * 5) % 11) / 5.0 - 1.0);
            Vec3::new(f64::from(i) - 2.0 + shift(0), f64::from(j) - 3.0 + shift(1), 0.0)
        };
        let vertices = (0..=rows).flat_map(|j| (0..=columns).map(move |i| corner(i, j))).collect();
        let mut triangles = Vec::new();
        for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
            let a = j * (columns + 1) + i;
            triangles.extend([[a, a + 1, a + columns + 2], [a, a + columns + 2, a + columns + 1]]);
        }
        world.add_static(TriMesh::new(vertices, triangles).unwrap(), Pose::IDENTITY).unwrap();
    } else {
        for (i, j) in (0..26).flat_map(|i| (0..6).map(move |j| (i, j))) {
            let at = Vec3::new(f64::from(i) - 2.0, f64::from(j) - 2.63, -0.5);
            world.add_static(Cuboid::new(Vec3::splat(1.0)).unwrap(), Pose::from_position(at)).unwrap();
        }
    }
}

/// Largest distance from its line of a body that goes 20 m along a floor, from a place and turned about the vertical.
fn stray(triangles: bool, rolls: bool, (speed, at, turn): (f64, Vec3, f64)) -> f64 {
    let mut world = world(9.81);
    world.set_default_material(Material::with_friction(if rolls { 0.8 } else { 0.0 })).unwrap();
    floor(&mut world, triangles);
    let turn = Quat::from_axis_angle(Vec3::Z, turn);
    let builder = BodyBuilder::new().at(at).rotated(turn).with_velocity(Vec3::X * speed);
    let builder = if rolls {
        builder.with_spin(Vec3::Y * (speed / 0.2)).with_shape(Sphere::new(0.2).unwrap(), 1000.0)
    } else {
        builder.with_shape(Cuboid::new(Vec3::new(0.6, 0.5, 0.4)).unwrap(), 1000.0)
    };
    let body = world.add_body(builder).unwrap();
    let mut worst = 0.0f64;
    for step in 1..=(20.0 / (speed * H)) as u32 {
        world.step(H).unwrap();
        let p = world.body(body).unwrap().position();
        let line = at + Vec3::X * (speed * H * f64::from(step));
        worst = worst.max((p.y - line.y).abs()).max((p.z - line.z).abs());
        assert!((p.x - line.x).abs() < 0.02, "{triangles} {rolls} {step}: {p:?}");
    }
    worst
}

#[test]
fn floors_of_many_parts_are_flat() {
    let ways = [
        (5.0, Vec3::new(0.0, 0.0, 0.2), 0.0),
        (3.3, Vec3::new(0.21, 0.04, 0.2), 0.4),
        (8.7, Vec3::new(-0.13, -0.2, 0.2), 1.1),
    ];
    for (triangles, rolls) in [(false, false), (false, true), (true, false), (true, true)] {
        let worst = ways.iter().fold(0.0f64, |worst, way| worst.max(stray(triangles, rolls, *way)));
        let (what, of) =
            (if rolls { "sphere" } else { "box" }, if triangles { "triangles" } else { "tiles" });
        println!("{what} over {of}: {worst:.1e} m off its line in 20 m");
        assert!(worst < 1e-3, "{what} over {of}: {worst}");
    }
}
