//! Shapes and poses from bytes.

use arbitrary::{Arbitrary, Result, Unstructured};
use ferrode_collide::{
    Capsule, Compound, Cone, Contacts, Convex, Custom, CustomShape, Frame, Cuboid, Cylinder, Ellipsoid, Heightfield, Plane, Ray, Shape, Sphere, TriMesh,
};
use ferrode_math::{Aabb, Pose, Quat, Vec3};

/// A number: mostly of a few metres in steps of a millimetre or so, sometimes any bits.
pub fn number(u: &mut Unstructured<'_>) -> Result<f64> {
    Ok(match u8::arbitrary(u)? {
        0 => f64::arbitrary(u)?,
        1 => 1e-6 * f64::from(i8::arbitrary(u)?),
        2 => 1e6 * f64::from(i8::arbitrary(u)?),
        3..=30 => f64::from(i8::arbitrary(u)?) / 16.0,
        _ => f64::from(i16::arbitrary(u)?) / 8192.0,
    })
}

pub fn vector(u: &mut Unstructured<'_>) -> Result<Vec3> {
    Ok(Vec3::new(number(u)?, number(u)?, number(u)?))
}

/// A size, most of the time a positive one.
pub fn size(u: &mut Unstructured<'_>) -> Result<f64> {
    let x = number(u)?;
    Ok(if u8::arbitrary(u)? == 0 { x } else { x.abs() * 0.25 })
}

fn sizes(u: &mut Unstructured<'_>) -> Result<Vec3> {
    Ok(Vec3::new(size(u)?, size(u)?, size(u)?))
}

pub fn pose(u: &mut Unstructured<'_>) -> Result<Pose> {
    // Engines refuse poses that are no numbers before a pair is asked.
    let position = vector(u)?.to_array().map(|x| if x.is_finite() { x.clamp(-1e9, 1e9) } else { 0.0 });
    let position = Vec3::from_array(position);
    let turn = match u8::arbitrary(u)? {
        0..=63 => Quat::IDENTITY,
        _ => Quat::from_array([number(u)?, number(u)?, number(u)?, number(u)?]),
    };
    Ok(Pose::new(position, turn.normalized().unwrap_or(Quat::IDENTITY)))
}

pub fn mesh(u: &mut Unstructured<'_>) -> Result<Option<TriMesh>> {
    let vertices: Vec<Vec3> = (0..u.int_in_range(0..=12)?).map(|_| vector(u)).collect::<Result<_>>()?;
    let triangles = (0..u.int_in_range(0..=16)?)
        .map(|_| Ok([0; 3].map(|_: u32| u.int_in_range(0..=12u32).unwrap_or(0))))
        .collect::<Result<Vec<_>>>()?;
    Ok(TriMesh::new(vertices, triangles).ok())
}

pub fn hull(u: &mut Unstructured<'_>) -> Result<Option<Convex>> {
    let points: Vec<Vec3> = (0..u.int_in_range(0..=20)?).map(|_| vector(u)).collect::<Result<_>>()?;
    Ok(Convex::from_points(&points).ok())
}

pub fn field(u: &mut Unstructured<'_>) -> Result<Option<Heightfield>> {
    let (columns, rows) = (u.int_in_range(0..=6usize)?, u.int_in_range(0..=6usize)?);
    let heights = (0..columns * rows).map(|_| number(u)).collect::<Result<Vec<_>>>()?;
    let field = Heightfield::new(size(u)? * 8.0, size(u)? * 8.0, columns, rows, heights, size(u)?);
    Ok(field.ok().map(|f| if u8::arbitrary(u).unwrap_or(0) & 1 == 1 { f.wrapped() } else { f }))
}

/// A double pyramid, known by its support function alone.
#[derive(Debug)]
struct Pyramids(Vec3);

impl CustomShape for Pyramids {
    fn aabb(&self, frame: &Frame) -> Aabb {
        let reach = Vec3::splat(self.0.length());
        Aabb::new(frame.position - reach, frame.position + reach)
    }

    fn collide(&self, _: &Frame, _: &Shape, _: &Frame, _: &mut Contacts<'_>) -> bool {
        false
    }

    fn support(&self, d: Vec3) -> Option<Vec3> {
        let along = d.component_mul(self.0);
        let mut best = 0;
        for i in 1..3 {
            if along[i].abs() > along[best].abs() {
                best = i;
            }
        }
        let mut tip = Vec3::ZERO;
        tip[best] = if along[best] < 0.0 { -self.0[best] } else { self.0[best] };
        Some(tip)
    }
}

/// A ball known by the depth of points, and by its contacts with balls.
#[derive(Debug)]
struct Orb(f64);

impl CustomShape for Orb {
    fn aabb(&self, frame: &Frame) -> Aabb {
        Aabb::new(frame.position - Vec3::splat(self.0), frame.position + Vec3::splat(self.0))
    }

    fn collide(&self, frame: &Frame, other: &Shape, at: &Frame, out: &mut Contacts<'_>) -> bool {
        let Shape::Sphere(ball) = other else { return false };
        let away = frame.position - at.position;
        let depth = ball.radius() + self.0 - away.length();
        if depth >= 0.0 {
            out.push(at.position, away.normalized_or(Vec3::Z), depth);
        }
        true
    }

    fn point_depth(&self, frame: &Frame, point: Vec3) -> Option<f64> {
        Some(self.0 - (point - frame.position).length())
    }
}

/// Up to four shapes as one, unless the numbers of one are refused.
pub fn compound(u: &mut Unstructured<'_>) -> Result<Option<Compound>> {
    let mut parts = Vec::new();
    for _ in 0..u.int_in_range(1..=4)? {
        let Some(part) = shape(u)? else { return Ok(None) };
        parts.push((part, pose(u)?));
    }
    Ok(Compound::new(parts).ok())
}

/// A shape of any kind, unless its numbers are refused.
pub fn shape(u: &mut Unstructured<'_>) -> Result<Option<Shape>> {
    Ok(match u.int_in_range(0..=13)? {
        0 => Sphere::new(size(u)?).ok().map(Shape::from),
        1 => Cuboid::new(sizes(u)?).ok().map(Shape::from),
        2 => Capsule::new(size(u)?, size(u)?).ok().map(Shape::from),
        3 => Cylinder::new(size(u)?, size(u)?).ok().map(Shape::from),
        4 => Plane::new(vector(u)?, number(u)?).ok().map(Shape::from),
        5 => Ray::new(size(u)?).ok().map(Shape::from),
        6 => hull(u)?.map(Shape::from),
        7 => mesh(u)?.map(Shape::from),
        8 => Ellipsoid::new(sizes(u)?).ok().map(Shape::from),
        9 => Cone::new(size(u)?, size(u)?).ok().map(Shape::from),
        10 => compound(u)?.map(Shape::from),
        11 => Some(sizes(u)?)
            .filter(|s| s.abs_max() <= 1e100)
            .map(|s| Custom::new(Pyramids(s.abs())).into()),
        12 => Some(size(u)?).filter(|r| (0.0..=1e100).contains(r)).map(|r| Custom::new(Orb(r)).into()),
        _ => field(u)?.map(Shape::from),
    })
}

/// Whether a vector is a unit vector.
pub fn is_unit(n: Vec3) -> bool {
    (n.length() - 1.0).abs() < 1e-5
}
