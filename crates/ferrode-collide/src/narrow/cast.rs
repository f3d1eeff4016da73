//! Where a moving shape first touches another.

use super::distance::{body_distance, plane_distance};
use super::support::{Body, difference};
use super::triangle::bounds;
use crate::space::Probe;
use crate::{Frame, Heightfield, Plane, Shape, TriMesh};
use ferrode_math::{Aabb, Vec3};

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

/// Most stretches of a path over a field: beyond, a path over a field without end meets nothing.
const STRETCHES: usize = 4096;

/// The first hit with a triangle of a field, in whose coordinates the body is.
fn body_field(body: &Body<'_>, path: Vec3, field: &Heightfield) -> Option<CastHit> {
    let start = bounds(body);
    let (from, to) = within(&start, path, &field.aabb(&Frame::IDENTITY))?;
    // A stretch at a time, as long as the body or a cell: the box around all of a slanting path holds far more cells.
    let (sx, sz) = field.cell();
    let e = start.extent();
    let along = |p: f64, e: f64, cell: f64| p.abs() / (e + cell);
    let stretches = ((to - from) * along(path.x, e.x, sx).max(along(path.z, e.z, sz))).max(1.0);
    let step = (to - from) / stretches;
    let mut best: Option<CastHit> = None;
    for k in 0..(stretches.ceil() as usize).min(STRETCHES) {
        let (here, there) = (from + step * k as f64, (from + step * (k + 1) as f64).min(to));
        if best.is_some_and(|b| b.fraction < here) {
            break;
        }
        let at = |t: f64| Aabb::new(start.min + path * t, start.max + path * t);
        field.triangles_in(&at(here).union(&at(there)), 2000, |corners| {
            let [p, q, r] = corners;
            let around = Aabb::new(p.min(q).min(r), p.max(q).max(r));
            let limit = best.map_or(1.0, |b| b.fraction);
            if within(&start, path, &around).is_some_and(|t| t.0 <= limit) {
                let hit = bodies(body, path, &Body::triangle(corners));
                if hit.is_some_and(|h| h.before(best)) {
                    best = hit;
                }
            }
        });
    }
    best
}

/// The part of a path, 0 to 1, on which a box that moves along it shares points with another; a hair more, against
/// rounding.
fn within(moving: &Aabb, path: Vec3, fixed: &Aabb) -> Option<(f64, f64)> {
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for i in 0..3 {
        let (low, high) = (fixed.min[i] - moving.max[i], fixed.max[i] - moving.min[i]);
        if path[i] == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (s, t) = (low / path[i], high / path[i]);
        from = from.max(s.min(t) - 1e-9);
        to = to.min(s.max(t) + 1e-9);
    }
    (from <= to).then_some((from, to))
}

impl CastHit {
    /// From the coordinates of a frame to the world.
    fn placed(self, frame: &Frame) -> Self {
        let position = frame.point_to_world(self.position);
        Self { position, normal: frame.vector_to_world(self.normal), ..self }
    }

    /// Whether this hit is earlier than the other, or deeper at the start.
    fn before(&self, other: Option<Self>) -> bool {
        other.is_none_or(|b| {
            self.fraction < b.fraction || (self.fraction == b.fraction && self.depth > b.depth)
        })
    }
}

/// Where shape `a`, moving along `path` without turning, first touches `b`, to a few millionths of their sizes.
/// `None` if it does not, for rays, for two planes, for a heightfield with a plane or another heightfield, and for a path
/// that is not finite. Meshes and heightfields are their surfaces.
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
        (Shape::Heightfield(_), Shape::Plane(_) | Shape::Heightfield(_)) => None,
        (Shape::Plane(_), Shape::Heightfield(_)) => None,
        (Shape::Plane(_) | Shape::Heightfield(_), _) => turned(),
        (Shape::TriMesh(mesh), Shape::Heightfield(field)) => {
            let path = fb.vector_to_local(path);
            let mut best: Option<CastHit> = None;
            for i in 0..mesh.triangles().len() as u32 {
                let corners = mesh.corners(i).map(|p| fb.point_to_local(fa.point_to_world(p)));
                let hit = body_field(&Body::triangle(corners), path, field);
                if hit.is_some_and(|h| h.before(best)) {
                    best = hit;
                }
            }
            best.map(|hit| hit.placed(fb))
        }
        (_, Shape::Heightfield(field)) => {
            let local = Frame::new(fb.point_to_local(fa.position), fb.rotation.transpose() * fa.rotation);
            let body = Body::of(sa, &local, Vec3::ZERO)?;
            body_field(&body, fb.vector_to_local(path), field).map(|hit| hit.placed(fb))
        }
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
        return Some(CastHit { fraction: 0.0, position, normal, depth: 0.0 - distance });
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
    best.map(|hit| hit.placed(frame))
}

/// The distance of the planes across `normal` that the bodies touch from either side.
fn plane_gap(a: &Body<'_>, b: &Body<'_>, normal: Vec3) -> f64 {
    difference(a, b, -normal).w.dot(normal) - a.margin - b.margin
}

/// Steps before a path that grazes is given up.
const STEPS: usize = 100;

/// Conservative advancement (Mirtich, *Impulse-based Dynamic Simulation*, 1996, section 2.3): the bodies cannot touch
/// before the gap has closed along its present normal, so go there and look again. Close by, the gap is flat: the last
/// step is exact for flat faces, and for round ones to the square of what it covers.
fn bodies(a: &Body<'_>, path: Vec3, b: &Body<'_>) -> Option<CastHit> {
    let size = a.reach().min(b.reach());
    let close = (2e-5 * size).max(1e-11 * (a.reach() + b.reach()));
    let mut moving = *a;
    let mut fraction = 0.0;
    for _ in 0..STEPS {
        moving.center = a.center + path * fraction;
        let d = body_distance(&moving, b, Vec3::ZERO);
        if d.distance <= close {
            // Between round bodies that are close, the nearest points found are good to their distance, but the gap
            // between the planes across the normal to the square of the normal's error.
            let distance =
                if d.distance > 0.0 { plane_gap(&moving, b, d.normal).max(0.0) } else { d.distance };
            let mut hit = linear(distance, d.b, d.normal, path)?;
            if fraction > 0.0 {
                // Rounding may let them touch: that is not an overlap at the start.
                hit.depth = 0.0;
            }
            hit.fraction += fraction;
            // The nearest points have moved on meanwhile: look once more, just before they meet.
            moving.center = a.center + path * (hit.fraction - 1e-6 * size / path.length()).max(fraction);
            let last = body_distance(&moving, b, Vec3::ZERO);
            if last.distance > 0.0 && last.distance < d.distance {
                hit.position = last.b;
            }
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
