//! A surface of many triangles is as smooth as a plane: nothing that slides over it notices the edges within.

use ferrode::TriMesh;
use ferrode::prelude::*;

/// The most that the path over the mesh may differ from that over the plane, in metres.
const SAME: f64 = 1e-6;

/// A flat mesh of 1,000 triangles, 10 m by 5 m, at height zero. Its corners are shifted within the plane, so that edges run
/// in all directions.
fn floor() -> Result<TriMesh, Error> {
    let (columns, rows) = (25_u32, 20_u32);
    let mut vertices = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            let shift = |k: u32| 0.06 * (f64::from((i * 7 + j * 13 + k * 5) % 11) / 5.0 - 1.0);
            vertices.push(Vec3::new(
                f64::from(i) * 0.4 - 1.0 + shift(0),
                f64::from(j) * 0.25 - 2.5 + shift(1),
                0.0,
            ));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let a = j * (columns + 1) + i;
            let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    assert_eq!(triangles.len(), 1000);
    Ok(TriMesh::new(vertices, triangles)?)
}

/// Where a body is after each step, and how it is turned.
fn path(shape: &Shape, ground: Shape, stepper: Stepper) -> Result<Vec<Pose>, Error> {
    let mut world = World::new();
    world.stepper = stepper;
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    world.set_contact_surface_layer(1e-3)?;
    world.set_default_material(Material::with_friction(0.3))?;
    world.add_static(ground, Pose::IDENTITY)?;
    let height = -shape.aabb(&Pose::IDENTITY).min.z;
    let body = BodyBuilder::new()
        .at(Vec3::new(0.0, 0.0, height + 0.002))
        .with_velocity(Vec3::new(4.0, 0.7, 0.0))
        .with_shape(shape.clone(), 500.0);
    let body = world.add_body(body)?;
    let mut poses = Vec::new();
    for _ in 0..300 {
        world.step(0.005)?;
        let b = world.body(body)?;
        poses.push(Pose::new(b.position(), b.quaternion()));
    }
    Ok(poses)
}

fn compare(name: &str, shape: Shape) -> Result<(), Error> {
    for stepper in [Stepper::Direct, Stepper::Quick] {
        let plane = path(&shape, Plane::new(Vec3::Z, 0.0)?.into(), stepper)?;
        let mesh = path(&shape, floor()?.into(), stepper)?;
        let mut worst: f64 = 0.0;
        for (p, m) in plane.iter().zip(&mesh) {
            let turned = (p.rotation.conjugate() * m.rotation).imaginary().length() * 2.0;
            worst = worst.max((p.position - m.position).length()).max(turned);
        }
        let way = (plane[plane.len() - 1].position - plane[0].position).length();
        println!("{name}, {stepper:?}: {way:.3} m of way, {worst:.2e} apart at most");
        assert!(way > 1.0, "{name}, {stepper:?}: {way}");
        assert!(worst < SAME, "{name}, {stepper:?}: {worst}");
    }
    Ok(())
}

#[test]
fn a_sphere_does_not_notice_edges() -> Result<(), Error> {
    compare("sphere", Sphere::new(0.2)?.into())
}

#[test]
fn a_box_does_not_notice_edges() -> Result<(), Error> {
    compare("box", Cuboid::new(Vec3::new(0.5, 0.4, 0.3))?.into())
}
