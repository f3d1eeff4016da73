//! A ball rolls down a chute of triangles and jumps into a basket.

use super::prelude::*;
use ferrode::TriMesh;
use ferrode_math::real;

const SECTIONS: usize = 40;
const RADIUS: f64 = 0.15;

pub(super) const DEMO: Demo = Demo {
    name: "basket",
    subject: Subject::Contacts,
    about: "a ball rolls down a chute and jumps into a basket",
    property: "it flies off the lip at the speed that rolling gives, within 5 %, and ends in the basket",
    seconds: 7.0,
    picture_at: 2.15,
    show: &[],
    camera: Camera::new([2.2, -7.7, 3.1], [1.85, 0.0, 1.25]),
    build,
};

/// The chute's lowest line: a half wave down from 3 m to 1.5 m, then level.
fn line(s: f64) -> Vec3 {
    let x = 4.0 * s - 2.0;
    let z = 1.5 + 0.75 * (1.0 + real::cos(core::f64::consts::PI * (s * 1.25).min(1.0)));
    at(x, 0.0, z)
}

#[derive(Clone)]
struct Throw {
    ball: BodyKey,
    fastest: f64,
    trail: Trail,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    world.set_default_material(Material::with_friction(1.0))?;
    // Across, the chute is a shallow gutter of four strips.
    let across: [(f64, f64); 5] = [(-0.4, 0.25), (-0.2, 0.06), (0.0, 0.0), (0.2, 0.06), (0.4, 0.25)];
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..=SECTIONS {
        let middle = line(i as f64 / SECTIONS as f64);
        points.extend(across.iter().map(|(y, z)| middle + at(0.0, *y, *z)));
    }
    let columns = across.len() as u32;
    for i in 0..SECTIONS as u32 {
        for j in 0..columns - 1 {
            let a = i * columns + j;
            triangles.push([a, a + columns, a + columns + 1]);
            triangles.push([a, a + columns + 1, a + 1]);
        }
    }
    world.add_static(TriMesh::new(points, triangles)?, Pose::IDENTITY)?;
    // The basket: a floor and four walls.
    let middle = at(4.9, 0.0, 0.0);
    add_wall(&mut world, at(1.6, 1.2, 0.1), Pose::from_position(middle + at(0.0, 0.0, 0.05)))?;
    for (dx, dy) in [(0.8, 0.0), (-0.8, 0.0), (0.0, 0.6), (0.0, -0.6)] {
        let sides = if dx == 0.0 { at(1.7, 0.1, 0.6) } else { at(0.1, 1.2, 0.6) };
        add_wall(&mut world, sides, Pose::from_position(middle + at(dx, dy, 0.3)))?;
    }
    let ball = add_ball(&mut world, RADIUS, 800.0, line(0.06) + at(0.0, 0.0, RADIUS + 0.02))?;
    world.body_mut(ball)?.set_linear_velocity(at(0.3, 0.0, 0.0))?;
    damp(&mut world, 0.0, 0.0005)?;
    Stage::new(world, 0.002, Throw { ball, fastest: 0.0, trail: Trail::default() })
        .after(|throw, world| {
            let ball = body(world, throw.ball)?;
            throw.trail.follow(ball.position(), 10);
            if ball.position().x < 2.0 {
                throw.fastest = throw.fastest.max(ball.linear_velocity().length());
            }
            Ok(())
        })
        .draw(|throw, _, drawing| {
            drawing.path(&throw.trail);
        })
        .check(|throw, world| {
            let p = place(world, throw.ball)?;
            // A ball that rolls keeps 5/7 of its energy in its motion; in the gutter it touches beside its lowest point.
            let drop = line(0.06).z - 1.5;
            Ok(Findings::new()
                .near("speed at the lip (m/s)", throw.fastest, (10.0 / 7.0 * G * drop).sqrt(), 0.05)
                .at_most("from the basket's middle (m)", (p.x - 4.9).abs(), 0.65)
                .at_most("aside (m)", p.y.abs(), 0.45)
                .at_most("height (m)", p.z, 0.3))
        })
}
