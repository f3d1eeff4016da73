//! Where a moving shape first touches another.

use super::distance::{body_distance, plane_distance};
use super::support::Body;
use super::triangle::bounds;
use crate::space::Probe;
use crate::{Frame, Plane, Shape, TriMesh};
use ferrode_math::Vec3;

/// Where a moving shape met another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CastHit {
    /// The part of the path before the hit, 0 to 1; 0 for shapes that touch at the start.
    pub fraction: f64,
    /// World position of the contact.
    pub position: Vec3,
    /// Unit normal of the contact, into the moving shape.
    pub normal: Vec3,
    /// Depth at the start; 0 unless the shapes overlap there.
    pub depth: f64,
}

impl CastHit {
    /// Whether this hit is earlier than the other, or deeper at the start.
    fn before(&self, other: Option<Self>) -> bool {
        other.is_none_or(|b| {
            self.fraction < b.fraction || (self.fraction == b.fraction && self.depth > b.depth)
        })
    }
}

/// Where shape `a`, moving along `path` without turning, first touches `b`, to a millionth of the smaller one's size.
/// `None` if it does not, for rays, for two planes, and for a path that is not finite.
pub fn shape_cast(a: (&Shape, &Frame), path: Vec3, b: (&Shape, &Frame)) -> Option<CastHit> {
    if !path.is_finite() {
        return None;
    }
    let ((sa, fa), (sb, fb)) = (a, b);
    // The other shape moves the other way.
    let turned = || {
        let hit = shape_cast(b, -path, a)?;
        Some(CastHit { normal: -hit.normal, position: hit.position + path * hit.fraction, ..hit })
    };
    match (sa, sb) {
        (Shape::Plane(_), Shape::Plane(_)) => None,
        (Shape::Plane(_), _) => turned(),
        (Shape::TriMesh(mesh), Shape::Plane(plane)) => mesh_plane(mesh, fa, path, plane),
        (_, Shape::Plane(plane)) => {
            let d = plane_distance(plane, &Body::of(sa, fa, Vec3::ZERO)?);
            linear(d.distance, d.b, d.normal, path)
        }
        (Shape::TriMesh(mesh), Shape::TriMesh(other)) => {
            let mut best: Option<CastHit> = None;
            for i in 0..mesh.triangles().len() as u32 {
                let corners = mesh.corners(i).map(|p| fa.point_to_world(p));
                let limit = best.map_or(1.0, |b| b.fraction);
                let hit =
                    body_mesh(&Body::triangle(corners.map(|p| p - fb.position)), path, other, fb, limit);
                if hit.is_some_and(|h| h.before(best)) {
                    best = hit;
                }
            }
            best
        }
        (Shape::TriMesh(_), _) => turned(),
        (_, Shape::TriMesh(mesh)) => body_mesh(&Body::of(sa, fa, fb.position)?, path, mesh, fb, 1.0),
        _ => {
            let origin = fb.position;
            let (ba, bb) = (Body::of(sa, fa, origin)?, Body::of(sb, fb, origin)?);
            let hit = bodies(&ba, path, &bb)?;
            Some(CastHit { position: hit.position + origin, ..hit })
        }
    }
}

/// The hit of what is `distance` away along `normal`, if that does not change on the way.
fn linear(distance: f64, position: Vec3, normal: Vec3, path: Vec3) -> Option<CastHit> {
    if distance <= 0.0 {
        return Some(CastHit { fraction: 0.0, position, normal, depth: -distance });
    }
    let approach = -normal.dot(path);
    let fraction = distance / approach;
    // The foot moves along with the shape.
    let along = path + normal * approach;
    (approach > 0.0 && fraction <= 1.0).then(|| CastHit {
        fraction,
        position: position + along * fraction,
        normal,
        depth: 0.0,
    })
}

fn mesh_plane(mesh: &TriMesh, frame: &Frame, path: Vec3, plane: &Plane) -> Option<CastHit> {
    let mesh = Shape::TriMesh(mesh.clone());
    let d = super::distance_frames((&mesh, frame), (&Shape::Plane(*plane), &Frame::IDENTITY))?;
    linear(d.distance, d.b, d.normal, path)
}

/// The first hit with a triangle before `limit`. The body is relative to the mesh's position.
fn body_mesh(body: &Body<'_>, path: Vec3, mesh: &TriMesh, frame: &Frame, mut limit: f64) -> Option<CastHit> {
    // Boxes are compared in the mesh's coordinates.
    let turned = frame.rotation.transpose();
    let mut local = *body;
    local.center = turned * body.center;
    local.rotation = turned * body.rotation;
    if let super::support::Core::Triangle(corners) = &mut local.core {
        // Triangles are not turned by their rotation.
        *corners = corners.map(|p| turned * p);
        local.rotation = ferrode_math::Mat3::IDENTITY;
    }
    let path_there = turned * path;
    let mut best: Option<CastHit> = None;
    mesh.tree().seek(&Probe::sweep(&bounds(&local), path_there), &mut limit, |i, limit| {
        let triangle = Body::triangle(mesh.corners(i));
        if let Some(hit) = bodies(&local, path_there, &triangle)
            && hit.fraction <= *limit
            && hit.before(best)
        {
            *limit = hit.fraction;
            best = Some(hit);
        }
    });
    best.map(|hit| CastHit {
        position: frame.point_to_world(hit.position),
        normal: frame.vector_to_world(hit.normal),
        ..hit
    })
}

/// Steps before a path that grazes is given up.
const STEPS: usize = 100;

/// Conservative advancement (Mirtich, *Impulse-based Dynamic Simulation*, 1996, section 2.3): the bodies cannot touch
/// before the gap has closed along its present normal, so go there and look again. Close by, the gap is flat: the last
/// step is exact for flat faces, and for round ones to the square of what it covers.
fn bodies(a: &Body<'_>, path: Vec3, b: &Body<'_>) -> Option<CastHit> {
    let size = a.reach().min(b.reach());
    let close = (1e-6 * size).max(1e-11 * (a.reach() + b.reach()));
    let mut moving = *a;
    let mut fraction = 0.0;
    for _ in 0..STEPS {
        moving.center = a.center + path * fraction;
        let d = body_distance(&moving, b, Vec3::ZERO);
        if d.distance <= close {
            let mut hit = linear(d.distance, d.b, d.normal, path)?;
            if fraction > 0.0 {
                // Rounding may let them touch: that is not an overlap at the start.
                hit.depth = 0.0;
            }
            hit.fraction += fraction;
            return (hit.fraction <= 1.0).then_some(hit);
        }
        let approach = -d.normal.dot(path);
        if !(approach > 0.0) {
            return None;
        }
        fraction += d.distance / approach;
        if !(fraction <= 1.0) {
            return None;
        }
    }
    None
}
