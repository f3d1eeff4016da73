//! Where a moving shape first touches another.

use super::compound::compound_cast;
use super::custom::{is_marched, march};
use super::distance::{body_distance, plane_distance};
use super::field_cells::FAR;
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

/// Of a field without end: cells along either axis below the body that a cast looks at, those below its middle, and how
/// many cells in all, where one that passes over its block counts for all of it.
const MOST_ACROSS: f64 = 32.0;
const MOST_CELLS: usize = 1 << 16;

/// The first hit with a triangle of a field, in whose coordinates the body is; before `best`, if there is one. Of a field
/// without end it looks at no more than `cells`.
///
/// The cells come in the order in which the body's box gets to them: strip by strip across the longer part of the path, in
/// each the cells that the box passes while it is over the strip. Blocks of cells that are all lower or all higher than the
/// box at that time are passed over, those of sixteen strips at once if there is none else.
fn body_field(
    body: &Body<'_>,
    path: Vec3,
    field: &Heightfield,
    mut cells: usize,
    mut best: Option<CastHit>,
) -> Option<CastHit> {
    let start = bounds(body);
    let Some(mut whole) = within(&start, path, &field.aabb(&Frame::IDENTITY)) else { return best };
    if !start.is_finite() {
        return best;
    }
    // While it is neither above nor below all samples.
    let hair = |low: f64, high: f64| {
        1e-8 * (path.y.abs() + start.min.y.abs() + start.max.y.abs() + low.abs() + high.abs())
    };
    let (low, high) = field.all_heights();
    let slack = hair(low, high);
    if !overlap(&mut whole, low - start.max.y - slack, high - start.min.y + slack, path.y) {
        return best;
    }
    let (sx, sz) = field.cell();
    let (size, sides) = ([sx, sz], [field.width(), field.depth()]);
    let counts = [field.columns(), field.rows()];
    let along = [path.x, path.z];
    // In cells from the field's corner.
    let lows = [start.min.x, start.min.z];
    let highs = [start.max.x, start.max.z];
    let at = [0, 1].map(|k| (0.5 * (lows[k] + highs[k]) + 0.5 * sides[k]) / size[k]);
    let speed = [0, 1].map(|k| along[k] / size[k]);
    let half = [0, 1].map(|k| {
        let half = 0.5 * (highs[k] - lows[k]) / size[k];
        // A hair more, against rounding.
        let half = if field.is_wrapped() { half.min(0.5 * MOST_ACROSS) } else { half };
        half * (1.0 + 1e-9) + 1e-9 * (1.0 + at[k].abs().min(1e6))
    });
    // The numbers of the cells along axis `k` that the box passes between two times, in its order.
    let range = |k: usize, from: f64, to: f64| {
        let (p, q) = (at[k] + speed[k] * from, at[k] + speed[k] * to);
        let (low, high) = ((p.min(q) - half[k]).floor(), (p.max(q) + half[k]).floor());
        let (low, high) = if field.is_wrapped() {
            (low.max(-FAR), high.min(FAR))
        } else {
            (low.max(0.0), high.min(counts[k] as f64 - 2.0))
        };
        (low as i64, high as i64)
    };
    // When the box is between two grid lines.
    let during = |k: usize, i: i64| -> Option<(f64, f64)> {
        let (low, high) = (i as f64 - half[k] - at[k], (i + 1) as f64 + half[k] - at[k]);
        if speed[k] == 0.0 {
            return (low <= 0.0 && high >= 0.0).then_some(whole);
        }
        let (s, t) = (low / speed[k], high / speed[k]);
        let (from, to) = (s.min(t).max(whole.0), s.max(t).min(whole.1));
        (from <= to).then_some((from, to))
    };
    let outer = usize::from(speed[1].abs() > speed[0].abs());
    let inner = 1 - outer;
    let back = [0, 1].map(|k| speed[k] < 0.0);
    let (rest, toward) = (
        |i: i64, k: usize| field.rest_of_block(i, counts[k], back[k]),
        |i: i64, by: i64, k: usize| if back[k] { i - by } else { i + by },
    );
    // How far it is from one number to the last, in the order of the path.
    let left = |i: i64, (low, high): (i64, i64), k: usize| if back[k] { i - low } else { high - i };
    let first = |(low, high): (i64, i64), k: usize| if back[k] { high } else { low };
    let place = |i: i64, j: i64| if outer == 0 { (i, j) } else { (j, i) };
    // Whether the box is above or below all of a block between two times, or until the best hit; a hair less, against rounding.
    let passes = |i: i64, j: i64, (from, to): (f64, f64), best: Option<CastHit>| {
        let (x, z) = place(i, j);
        let (low, high) = field.block_heights(x, z);
        let to = best.map_or(to, |b| to.min(b.fraction).max(from));
        let (rise, rise_to) = (path.y * from, path.y * to);
        let (lowest, highest) = (start.min.y + rise.min(rise_to), start.max.y + rise.max(rise_to));
        let hair = hair(low, high);
        lowest - hair > high || highest + hair < low
    };
    let strips = range(outer, whole.0, whole.1);
    let mut i = first(strips, outer);
    // Strips that are known not to be passed over together.
    let mut looked_at = 0;
    while left(i, strips, outer) >= 0 {
        cells = if field.is_wrapped() { cells.saturating_sub(1) } else { cells };
        if cells == 0 {
            break;
        }
        let strip = i;
        if looked_at == 0 {
            looked_at = rest(i, outer).min(left(i, strips, outer) + 1);
            let times = (during(outer, i), during(outer, toward(i, looked_at - 1, outer)));
            if let (Some((from, _)), Some((_, to))) = times {
                let row = range(inner, from, to);
                let mut j = first(row, inner);
                while left(j, row, inner) >= 0 && passes(i, j, (from, to), best) {
                    j = toward(j, rest(j, inner), inner);
                }
                if left(j, row, inner) < 0 {
                    i = toward(i, looked_at, outer);
                    looked_at = 0;
                    continue;
                }
            }
        }
        looked_at -= 1;
        i = toward(i, 1, outer);
        let Some((from, to)) = during(outer, strip) else { continue };
        if best.is_some_and(|b| b.fraction < from - 1e-9) {
            break;
        }
        let row = range(inner, from, to);
        let mut j = first(row, inner);
        // Cells of the block that the box is not above or below.
        let mut open = 0;
        while left(j, row, inner) >= 0 {
            if field.is_wrapped() {
                if cells == 0 {
                    break;
                }
                cells -= 1;
            }
            if open == 0 {
                open = rest(j, inner);
                if passes(strip, j, (from, to), best) {
                    j = toward(j, open, inner);
                    open = 0;
                    continue;
                }
            }
            let (x, z) = place(strip, j);
            for corners in field.cell_triangles(x, z) {
                best = triangle_hit(body, &start, path, corners, best);
            }
            open -= 1;
            j = toward(j, 1, inner);
        }
    }
    best
}

/// The hit with a triangle, if it is before `best`, else that.
fn triangle_hit(
    body: &Body<'_>,
    start: &Aabb,
    path: Vec3,
    corners: [Vec3; 3],
    best: Option<CastHit>,
) -> Option<CastHit> {
    let [p, q, r] = corners;
    let limit = best.map_or(1.0, |b| b.fraction);
    let around = Aabb::new(p.min(q).min(r), p.max(q).max(r));
    let Some((from, to)) = within(start, path, &around) else { return best };
    // The same across the triangle's plane.
    let n = (q - p).cross(r - p);
    let far = n.length() * body.margin;
    let (low, high) = (n.dot(body.support(-n)) - far, n.dot(body.support(n)) + far);
    let (mut times, slack) = ((from, to), 1e-9 * (low.abs() + high.abs() + n.dot(p).abs()));
    let level = n.dot(p);
    if !overlap(&mut times, level - high - slack, level - low + slack, n.dot(path)) || times.0 > limit {
        return best;
    }
    // Touching at the start, only the deepest counts: if some way out is no longer than that of the best, it is not this one.
    if let Some(b) = best
        && b.fraction == 0.0
    {
        let out = (start.max - around.min).min(around.max - start.min);
        let top = b.normal.dot(p).max(b.normal.dot(q)).max(b.normal.dot(r));
        let over = top - b.normal.dot(body.support(-b.normal)) + body.margin;
        if (level - low).min(high - level) <= b.depth * n.length()
            || out.x.min(out.y).min(out.z) <= b.depth
            || over <= b.depth
        {
            return best;
        }
    }
    match bodies_until(body, path, &Body::triangle(corners), times.1.min(limit)) {
        Some(hit) if hit.before(best) => Some(hit),
        _ => best,
    }
}

/// Cuts a time down to that in which something that moves at `speed` is between `low` and `high`; false if there is none.
fn overlap(times: &mut (f64, f64), low: f64, high: f64, speed: f64) -> bool {
    if speed == 0.0 {
        return !(low > 0.0 || high < 0.0);
    }
    let (s, t) = (low / speed, high / speed);
    *times = (times.0.max(s.min(t) - 1e-9), times.1.min(s.max(t) + 1e-9));
    // Not numbers: nothing is known.
    !(times.0 > times.1)
}

/// The part of a path, 0 to 1, on which a box that moves along it shares points with another; a hair more, against
/// rounding.
fn within(moving: &Aabb, path: Vec3, fixed: &Aabb) -> Option<(f64, f64)> {
    let mut times = (0.0f64, 1.0f64);
    let all = (0..3)
        .all(|i| overlap(&mut times, fixed.min[i] - moving.max[i], fixed.max[i] - moving.min[i], path[i]));
    (all && times.0 <= times.1).then_some(times)
}

impl CastHit {
    /// From the coordinates of a frame to the world.
    fn placed(self, frame: &Frame) -> Self {
        let position = frame.point_to_world(self.position);
        Self { position, normal: frame.vector_to_world(self.normal), ..self }
    }

    /// Whether this hit is earlier than the other, or deeper at the start.
    pub(super) fn before(&self, other: Option<Self>) -> bool {
        other.is_none_or(|b| {
            self.fraction < b.fraction || (self.fraction == b.fraction && self.depth > b.depth)
        })
    }
}

/// Where shape `a`, moving along `path` without turning, first touches `b`, to a few millionths of their sizes.
/// `None` if it does not, for rays, for two planes, and for a path that is not finite. Meshes and heightfields are their
/// surfaces. Of a heightfield without end it looks at what lies below the middle 32 cells of the other shape, along a path of
/// some thousands of cells, or of some hundred thousands over plains; with a plane or another such field there is no answer.
///
/// A shape of one's own takes part if it has a [support function](crate::CustomShape::support) or knows its
/// [distance](crate::CustomShape::distance) from the other shape.
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
        (Shape::Compound(compound), _) => compound_cast(compound, fa, path, b),
        (_, Shape::Compound(_)) => turned(),
        (Shape::Plane(_), Shape::Plane(_)) => None,
        _ if is_marched(sa, sb) => march(a, path, b),
        (Shape::Heightfield(_), Shape::Plane(_)) => {
            let d = super::distance_frames(a, b)?;
            linear(d.distance, d.b, d.normal, path)
        }
        (Shape::Heightfield(field), Shape::Heightfield(other)) if !field.is_wrapped() => {
            let path = fb.vector_to_local(path);
            let mut best: Option<CastHit> = None;
            field.each_triangle(|corners| {
                let corners = corners.map(|p| fb.point_to_local(fa.point_to_world(p)));
                best = body_field(&Body::triangle(corners), path, other, 4096, best);
            });
            best.map(|hit| hit.placed(fb))
        }
        (Shape::Heightfield(_), Shape::Heightfield(other)) if other.is_wrapped() => None,
        (Shape::Plane(_) | Shape::Heightfield(_), _) => turned(),
        (Shape::TriMesh(mesh), Shape::Heightfield(field)) => {
            let path = fb.vector_to_local(path);
            let count = mesh.triangles().len();
            let cells = (MOST_CELLS / count).max(4096);
            let mut best: Option<CastHit> = None;
            for i in 0..count as u32 {
                let corners = mesh.corners(i).map(|p| fb.point_to_local(fa.point_to_world(p)));
                best = body_field(&Body::triangle(corners), path, field, cells, best);
            }
            best.map(|hit| hit.placed(fb))
        }
        (_, Shape::Heightfield(field)) => {
            let local = Frame::new(fb.point_to_local(fa.position), fb.rotation.transpose() * fa.rotation);
            let body = Body::of(sa, &local, Vec3::ZERO)?;
            body_field(&body, fb.vector_to_local(path), field, MOST_CELLS, None).map(|hit| hit.placed(fb))
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
pub(super) fn linear(distance: f64, position: Vec3, normal: Vec3, path: Vec3) -> Option<CastHit> {
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
    bodies_until(a, path, b, 1.0)
}

/// As [`bodies`], if what they touch after that part of the path does not count.
fn bodies_until(a: &Body<'_>, path: Vec3, b: &Body<'_>, until: f64) -> Option<CastHit> {
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
        if !(fraction <= until) {
            return None;
        }
    }
    None
}
