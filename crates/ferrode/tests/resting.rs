//! Everything that can lie on something lies still on it: each shape on each other, with both steppers.
//!
//! ODE's defaults (ERP 0.2, CFM 1e-10) with a contact surface layer of 1 mm. A body is put down 1 mm above its base,
//! turned by 0.3 rad about the vertical so that nothing is aligned, and has 10 s of simulated time. Then it must be
//! slower than 1 mm/s and within 5 mm and one degree of where it was put. Each run prints its table.

use ferrode::prelude::*;
use ferrode::{Cone, Convex, Ellipsoid, Heightfield, TriMesh};

const SECONDS: f64 = 10.0;
const SPEED: f64 = 1e-3;
const DRIFT: f64 = 5e-3;
const TILT: f64 = 1.0;

/// A body: its name, its shape, how it is turned, and the height of its origin when it lies at zero.
struct Top {
    name: &'static str,
    shape: Shape,
    rotation: Quat,
    height: f64,
}

/// What is lain upon: its top is at zero, its origin at `height`.
struct Base {
    name: &'static str,
    shape: Shape,
    rotation: Quat,
    height: f64,
}

fn icosahedron(radius: f64) -> Vec<Vec3> {
    let g = 0.5 * (1.0 + 5.0_f64.sqrt());
    let s = radius / (1.0 + g * g).sqrt();
    let mut points = Vec::new();
    for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        points.push(Vec3::new(0.0, a, b) * s);
        points.push(Vec3::new(a, b, 0.0) * s);
        points.push(Vec3::new(b, 0.0, a) * s);
    }
    points
}

/// A face of the convex hull of `points` turned down, and how far it is from the origin.
fn on_a_face(convex: &Convex) -> (Quat, f64) {
    let (n, d) = convex.face_plane(0);
    let half = (n - Vec3::Z) * 0.5;
    // The half turn about the direction midway between the normal and down.
    let axis = half.normalized().unwrap_or(Vec3::X);
    (Quat::from_axis_angle(axis, core::f64::consts::PI), d)
}

/// A box of `sides` about the origin, its faces cut into `n` × `n` squares, as a closed mesh.
fn box_mesh(sides: Vec3, n: u32) -> Result<TriMesh, Error> {
    let mut soup = Vec::new();
    let h = sides * 0.5;
    // The same bits from either end, so that the faces meet.
    let place = |u: u32| (2.0 * f64::from(u) - f64::from(n)) / f64::from(n);
    for axis in 0..3 {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        for sign in [-1.0, 1.0] {
            let at = |u: u32, v: u32| {
                let mut p = Vec3::ZERO;
                p[axis] = sign * h[axis];
                p[j] = sign * h[j] * place(u);
                p[k] = h[k] * place(v);
                p
            };
            for u in 0..n {
                for v in 0..n {
                    let [a, b, c, d] = [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)];
                    soup.push([a, b, c]);
                    soup.push([a, c, d]);
                }
            }
        }
    }
    Ok(TriMesh::from_triangles(&soup)?)
}

fn tops() -> Result<Vec<Top>, Error> {
    let lying = Quat::from_axis_angle(Vec3::Y, core::f64::consts::FRAC_PI_2);
    let ico = Convex::from_points(&icosahedron(0.3))?;
    let (ico_turn, ico_height) = on_a_face(&ico);
    let wedge: Vec<Vec3> = [(-0.3, -0.15), (0.3, -0.15), (-0.3, 0.15)]
        .into_iter()
        .flat_map(|(x, z)| [Vec3::new(x, -0.2, z), Vec3::new(x, 0.2, z)])
        .collect();
    let top = |name, shape, rotation, height| Top { name, shape, rotation, height };
    let up = Quat::IDENTITY;
    Ok(vec![
        top("box", Cuboid::new(Vec3::new(0.5, 0.4, 0.3))?.into(), up, 0.15),
        top("cylinder standing", Cylinder::new(0.2, 0.5)?.into(), up, 0.25),
        top("cylinder lying", Cylinder::new(0.2, 0.5)?.into(), lying, 0.2),
        top("capsule lying", Capsule::new(0.15, 0.4)?.into(), lying, 0.15),
        top("icosahedron", ico.into(), ico_turn, ico_height),
        top("wedge", Convex::from_points(&wedge)?.into(), up, 0.15),
        top("mesh", box_mesh(Vec3::new(0.5, 0.4, 0.3), 3)?.into(), up, 0.15),
        top("sphere", Sphere::new(0.2)?.into(), up, 0.2),
        top("ellipsoid", Ellipsoid::new(Vec3::new(0.3, 0.25, 0.15))?.into(), up, 0.15),
        top("cone", Cone::new(0.2, 0.4)?.into(), up, 0.2),
    ])
}

fn bases() -> Result<Vec<Base>, Error> {
    let base = |name, shape, height| Base { name, shape, rotation: Quat::IDENTITY, height };
    let slab: Vec<Vec3> = (0..8_u8)
        .map(|i| Vec3::new(f64::from(i & 1) - 0.5, f64::from(i >> 1 & 1) - 0.5, f64::from(i >> 2) - 1.0))
        .collect();
    Ok(vec![
        base("plane", Plane::new(Vec3::Z, 0.0)?.into(), 0.0),
        base("box", Cuboid::new(Vec3::splat(1.0))?.into(), -0.5),
        base("mesh", box_mesh(Vec3::splat(1.0), 7)?.into(), -0.5),
        Base {
            name: "field",
            shape: Heightfield::new(2.0, 2.0, 21, 21, vec![0.0; 21 * 21], 1.0)?.into(),
            rotation: Heightfield::z_up(),
            height: 0.0,
        },
        base("cylinder", Cylinder::new(0.6, 1.0)?.into(), -0.5),
        base("convex", Convex::from_points(&slab)?.into(), 0.0),
    ])
}

/// How a body lay at the end.
struct Outcome {
    speed: f64,
    drift: f64,
    tilt: f64,
    contacts: usize,
}

impl Outcome {
    fn rests(&self) -> bool {
        self.speed < SPEED && self.drift < DRIFT && self.tilt < TILT
    }
}

fn lay_down(top: &Top, base: &Base, stepper: Stepper, h: f64, friction: f64) -> Result<Outcome, Error> {
    let mut world = World::new();
    world.stepper = stepper;
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    world.set_contact_surface_layer(1e-3)?;
    world.set_default_material(Material::with_friction(friction))?;
    world.add_static(base.shape.clone(), Pose::new(Vec3::new(0.0, 0.0, base.height), base.rotation))?;
    let start = Vec3::new(0.03, 0.02, top.height + 1e-3);
    let turn = Quat::from_axis_angle(Vec3::Z, 0.3) * top.rotation;
    let body = BodyBuilder::new().at(start).rotated(turn).with_shape(top.shape.clone(), 1000.0);
    let body = world.add_body(body)?;
    // A body's frame is at its centre of mass, which need not be the shape's origin.
    let start = world.body(body)?.position();
    let mut contacts = 0;
    for _ in 0..(SECONDS / h).round() as usize {
        contacts = world.step(h)?.contacts;
    }
    let body = world.body(body)?;
    let turned = body.quaternion() * turn.conjugate();
    Ok(Outcome {
        speed: body.linear_velocity().length() + 0.3 * body.angular_velocity().length(),
        drift: (body.position() - start).length(),
        tilt: 2.0 * ferrode::math::real::atan2(turned.imaginary().length(), turned.w.abs()).to_degrees(),
        contacts,
    })
}

/// Lays every body picked on every base and prints how each fares; the failures.
fn table(stepper: Stepper, h: f64, friction: f64, pick: impl Fn(&str) -> bool) -> Result<Vec<String>, Error> {
    let mut failures = Vec::new();
    println!("{stepper:?}, h = {h}, friction {friction}: speed mm/s, drift mm, turn °, contacts");
    for base in &bases()? {
        for top in tops()?.iter().filter(|top| pick(top.name)) {
            let o = lay_down(top, base, stepper, h, friction)?;
            let line = format!(
                "{:18} on {:9} {:9.2e} {:7.3} {:7.3} {:3}{}",
                top.name,
                base.name,
                o.speed * 1e3,
                o.drift * 1e3,
                o.tilt,
                o.contacts,
                if o.rests() { "" } else { "  does not rest" }
            );
            println!("{line}");
            if !o.rests() {
                failures.push(line);
            }
        }
    }
    Ok(failures)
}

#[test]
fn all_lies_still_under_direct() -> Result<(), Error> {
    let failures = table(Stepper::Direct, 0.01, 0.5, |_| true)?;
    assert!(failures.is_empty(), "{failures:#?}");
    Ok(())
}

#[test]
fn all_lies_still_under_quick() -> Result<(), Error> {
    let failures = table(Stepper::Quick, 0.01, 0.5, |_| true)?;
    assert!(failures.is_empty(), "{failures:#?}");
    Ok(())
}

#[test]
fn all_lies_still_with_a_rough_surface_and_a_millisecond() -> Result<(), Error> {
    let pick = |name: &str| ["box", "cylinder lying", "capsule lying", "icosahedron"].contains(&name);
    let failures = table(Stepper::Quick, 0.001, 1.0, pick)?;
    assert!(failures.is_empty(), "{failures:#?}");
    Ok(())
}
