//! How far two shapes are apart.

use super::compound::compound_distance;
use super::convex::{gap, touch};
use super::custom::own_distance;
use super::gjk::Gap;
use super::support::Body;
use super::triangle::bounds;
use crate::space::Probe;
use crate::{Frame, Heightfield, Plane, Shape, TriMesh};
use ferrode_math::{Aabb, Pose, Vec3};

/// The nearest points of two shapes, or the deepest if they overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Metres between the shapes; if they overlap, minus the least depth.
    pub distance: f64,
    /// The point of the first shape, in the world.
    pub a: Vec3,
    /// The point of the second shape.
    pub b: Vec3,
    /// Unit vector from the second to the first: the way the first goes away soonest.
    pub normal: Vec3,
}

/// The distance of two shapes; meshes and heightfields are their surfaces. `None` for pairs that have none: rays, two
/// planes, two heightfields without end, and such a one with a plane that is not level with it.
///
/// A shape of one's own is asked for its [distance](crate::CustomShape::distance); if it does not tell, for its
/// [support function](crate::CustomShape::support), and from a ball for the
/// [depth](crate::CustomShape::point_depth) of its centre.
pub fn distance(a: (&Shape, &Pose), b: (&Shape, &Pose)) -> Option<Distance> {
    distance_frames((a.0, &Frame::from(a.1)), (b.0, &Frame::from(b.1)))
}

/// As [`distance`], for callers who have the rotation matrices at hand.
pub fn distance_frames(a: (&Shape, &Frame), b: (&Shape, &Frame)) -> Option<Distance> {
    let ((sa, fa), (sb, fb)) = (a, b);
    if matches!(sa, Shape::Custom(_)) || matches!(sb, Shape::Custom(_)) {
        let told = own_distance(a, b);
        if told.is_some() {
            return told;
        }
    }
    match (sa, sb) {
        (Shape::Compound(compound), _) => compound_distance(compound, fa, b),
        (_, Shape::Compound(compound)) => compound_distance(compound, fb, a).map(Distance::swapped),
        (Shape::Plane(_), Shape::Plane(_)) => None,
        (Shape::TriMesh(mesh), Shape::Plane(p)) => vertices_plane_distance(mesh.vertices(), fa, p),
        (Shape::Heightfield(field), Shape::Plane(p)) => {
            let n = fa.vector_to_local(p.normal());
            // What has no end goes through planes that lean.
            if field.is_wrapped() && (n.x != 0.0 || n.z != 0.0) {
                return None;
            }
            let (columns, rows) = (field.columns() as i64, field.rows() as i64);
            let corners = (0..rows).flat_map(|z| (0..columns).map(move |x| (x, z)));
            let lowest =
                corners.map(|(x, z)| field.vertex(x, z)).min_by(|p, q| p.dot(n).total_cmp(&q.dot(n)))?;
            vertices_plane_distance(&[lowest], fa, p)
        }
        (Shape::Heightfield(field), Shape::Heightfield(other)) if !field.is_wrapped() => {
            let mut best: Option<Distance> = None;
            let whole = other.aabb(&Frame::IDENTITY);
            field.each_triangle(|corners| {
                let body = Body::triangle(corners.map(|p| fb.point_to_local(fa.point_to_world(p))));
                let around = bounds(&body);
                let gap = (whole.min - around.max).max(around.min - whole.max).max(Vec3::ZERO).length();
                if best.is_some_and(|b| gap > b.distance.max(0.0)) {
                    return;
                }
                if let Some(d) = body_field_distance(&body, other)
                    && best.is_none_or(|b| d.distance < b.distance)
                {
                    best = Some(d);
                }
            });
            best.map(|d| d.placed(fb))
        }
        (Shape::Heightfield(_), Shape::Heightfield(other)) if other.is_wrapped() => None,
        (Shape::Heightfield(_), _) => distance_frames(b, a).map(Distance::swapped),
        (Shape::TriMesh(mesh), Shape::Heightfield(field)) => {
            let mut best: Option<Distance> = None;
            for i in 0..mesh.triangles().len() as u32 {
                let corners = mesh.corners(i).map(|p| fb.point_to_local(fa.point_to_world(p)));
                let d = body_field_distance(&Body::triangle(corners), field)?;
                if best.is_none_or(|b| d.distance < b.distance) {
                    best = Some(d);
                }
            }
            best.map(|d| d.placed(fb))
        }
        (Shape::Plane(_), _) => distance_frames(b, a).map(Distance::swapped),
        (_, Shape::Heightfield(field)) => {
            let local = Frame::new(fb.point_to_local(fa.position), fb.rotation.transpose() * fa.rotation);
            body_field_distance(&Body::of(sa, &local, Vec3::ZERO)?, field).map(|d| d.placed(fb))
        }
        (_, Shape::Plane(p)) => Some(plane_distance(p, &Body::of(sa, fa, Vec3::ZERO)?)),
        (Shape::TriMesh(mesh), Shape::TriMesh(other)) => {
            let mut best: Option<Distance> = None;
            for i in 0..mesh.triangles().len() as u32 {
                let corners = mesh.corners(i).map(|p| fa.point_to_world(p));
                let origin = corners[0];
                let body = Body::triangle(corners.map(|p| p - origin));
                best = body_mesh_distance(&body, origin, other, fb, best);
            }
            best
        }
        (Shape::TriMesh(_), _) => distance_frames(b, a).map(Distance::swapped),
        (_, Shape::TriMesh(mesh)) => {
            let origin = fa.position;
            body_mesh_distance(&Body::of(sa, fa, origin)?, origin, mesh, fb, None)
        }
        _ => {
            // In the first one's coordinates: where the pair is in the world changes nothing.
            let local = Frame::new(fa.point_to_local(fb.position), fa.rotation.transpose() * fb.rotation);
            let (ba, bb) = (Body::of(sa, &Frame::IDENTITY, Vec3::ZERO)?, Body::of(sb, &local, Vec3::ZERO)?);
            Some(body_distance(&ba, &bb, Vec3::ZERO).placed(fa))
        }
    }
}

/// Of a field without end, the cells along either axis that a distance looks at: what is wider than these, or further
/// away, gets the distance to the part below its middle.
const MOST_CELLS: i64 = 16;

/// Part of a body's size by which two distances are one.
const EQUAL: f64 = 1e-12;

/// The least distance to a triangle of a field, in whose coordinates the body is.
fn body_field_distance(body: &Body<'_>, field: &Heightfield) -> Option<Distance> {
    let (sx, sz) = field.cell();
    let around = bounds(body);
    let whole = field.aabb(&Frame::IDENTITY);
    // What is further than this has nothing nearer beyond.
    let last = match field.is_wrapped() {
        false => around.union(&whole).extent().length(),
        true => (around.extent() + whole.extent().min(Vec3::splat(1e150))).y + 100.0 * sx.max(sz),
    };
    if !(around.is_finite() && last.is_finite()) {
        return None;
    }
    let mut margin = sx.max(sz);
    loop {
        let mut best: Option<Distance> = None;
        field.triangles_in(&around.expanded(margin), MOST_CELLS, |corners| {
            let [p, q, r] = corners;
            let (min, max) = (p.min(q).min(r), p.max(q).max(r));
            let gap = (min - around.max).max(around.min - max).max(Vec3::ZERO).length();
            if best.is_some_and(|b| gap > b.distance.max(0.0)) {
                return;
            }
            let d = body_distance(body, &Body::triangle(corners), Vec3::ZERO);
            // Of equals the first, whatever rounding makes of them.
            if best.is_none_or(|b| d.distance < b.distance - EQUAL * body.reach()) {
                best = Some(d);
            }
        });
        // Nothing outside the box looked at is nearer than the margin.
        if best.is_some_and(|b| b.distance <= margin) || margin > last {
            return best;
        }
        margin *= 2.0;
    }
}

impl Distance {
    /// From the coordinates of a frame to the world.
    fn placed(self, frame: &Frame) -> Self {
        let (a, b) = (frame.point_to_world(self.a), frame.point_to_world(self.b));
        Self { a, b, normal: frame.vector_to_world(self.normal), ..self }
    }

    /// The same seen from the other shape.
    #[must_use]
    pub fn swapped(self) -> Self {
        Self { a: self.b, b: self.a, normal: -self.normal, ..self }
    }
}

/// The lowest vertex.
fn vertices_plane_distance(vertices: &[Vec3], frame: &Frame, plane: &Plane) -> Option<Distance> {
    let n = frame.vector_to_local(plane.normal());
    let lowest = vertices.iter().min_by(|p, q| p.dot(n).total_cmp(&q.dot(n)))?;
    let a = frame.point_to_world(*lowest);
    let depth = plane.depth(a);
    Some(Distance { distance: -depth, a, b: a + plane.normal() * depth, normal: plane.normal() })
}

/// The least distance to a triangle, or `best` if that is less. The body is relative to `origin`.
fn body_mesh_distance(
    body: &Body<'_>,
    origin: Vec3,
    mesh: &TriMesh,
    frame: &Frame,
    mut best: Option<Distance>,
) -> Option<Distance> {
    // Bodies that overlap are at no distance, but some overlap more.
    let mut limit = best.map_or(f64::INFINITY, |b| b.distance.max(0.0));
    // In the mesh's coordinates: the box around the ball around the body.
    let reach = Vec3::splat(body.reach());
    let center = frame.point_to_local(body.center + origin);
    // Boxes are compared with the body's box, which is no nearer than the body.
    let probe = Probe::near(&Aabb::new(center - reach, center + reach));
    mesh.tree().seek(&probe, &mut limit, |i, limit| {
        let triangle = Body::triangle(mesh.corners(i).map(|p| frame.point_to_world(p) - origin));
        let d = body_distance(body, &triangle, origin);
        if best.is_none_or(|b| d.distance < b.distance) {
            *limit = d.distance.max(0.0);
            best = Some(d);
        }
    });
    best
}

pub(super) fn plane_distance(plane: &Plane, body: &Body<'_>) -> Distance {
    let n = plane.normal();
    let a = body.support(-n) - n * body.margin;
    let depth = plane.depth(a);
    Distance { distance: -depth, a, b: a + n * depth, normal: n }
}

pub(super) fn body_distance(a: &Body<'_>, b: &Body<'_>, origin: Vec3) -> Distance {
    if let Some(t) = touch(a, b) {
        return Distance { distance: -t.depth, a: t.a + origin, b: t.b + origin, normal: t.normal };
    }
    let (pa, pb, between) = match gap(a, b, f64::INFINITY) {
        Gap::Apart { a, b, between, .. } => (a, b, between),
        // Between touching and not, to the last bit.
        Gap::Overlap(simplex) => {
            let (a, b) = simplex.witnesses();
            (a, b, Vec3::ZERO)
        }
        Gap::Far => (a.center, b.center, a.center - b.center),
    };
    let normal = between.normalized().unwrap_or_else(|| (a.middle() - b.middle()).normalized_or(Vec3::X));
    Distance {
        distance: between.length() - a.margin - b.margin,
        a: pa - normal * a.margin + origin,
        b: pb + normal * b.margin + origin,
        normal,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cuboid, Cylinder, Sphere};

    #[test]
    fn known_distances() {
        let ball = Shape::from(Sphere::new(0.5).unwrap());
        let cube = Shape::from(Cuboid::new(Vec3::splat(2.0)).unwrap());
        let disc = Shape::from(Cylinder::new(1.0, 0.2).unwrap());
        let ground = Shape::from(Plane::new(Vec3::Z, 0.0).unwrap());
        let at = |x: f64, y: f64, z: f64| Pose::from_position(Vec3::new(x, y, z));
        let d = distance((&ball, &at(3.0, 0.0, 0.0)), (&cube, &at(0.0, 0.0, 0.0))).unwrap();
        assert!((d.distance - 1.5).abs() < 1e-12 && (d.a - Vec3::new(2.5, 0.0, 0.0)).length() < 1e-12);
        assert!((d.b - Vec3::X).length() < 1e-12 && (d.normal - Vec3::X).length() < 1e-12);
        let d = distance((&disc, &at(0.0, 0.0, 3.0)), (&ground, &Pose::IDENTITY)).unwrap();
        assert!((d.distance - 2.9).abs() < 1e-12 && d.normal == Vec3::Z);
        let d = distance((&disc, &at(3.0, 0.0, 0.0)), (&disc, &Pose::IDENTITY)).unwrap();
        assert!((d.distance - 1.0).abs() < 1e-9, "{d:?}");
        // Far from the origin nothing is lost but the rounding of the positions.
        let d = distance((&cube, &at(1e6 + 1.5, 0.0, 0.0)), (&cube, &at(1e6, 0.0, 0.0))).unwrap();
        assert!((d.distance + 0.5).abs() < 1e-12, "{d:?}");
        assert_eq!(distance((&ground, &Pose::IDENTITY), (&ground, &Pose::IDENTITY)), None);
    }
}
