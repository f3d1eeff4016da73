//! A convex body and a surface of triangles; and all pairs for which contacts are grouped.

use super::candidates::{Candidate, Workspace, group};
use super::convex::{add_points, clip, feature};
use super::patch::{Patch, Spot};
use super::{Favours, Manifold, Vec3f};
use crate::narrow::collide_frames;
use crate::narrow::convex::{Touch, touch_within};
use crate::narrow::heightfield_shape::Zone;
use crate::narrow::support::{Body, Core};
use crate::narrow::triangle::{Facet, SAME, allowed, at_inner_edge, bounds, nearer_elsewhere};
use crate::shape::Neighbour;
use crate::{CollideOptions, Frame, Shape};
use ferrode_math::{Aabb, Vec3};

/// Points of a body nearer to each other than this part of its size are one.
const ONE_PLACE: f64 = 1e-4;

/// How deep, in parts of its size, a body over a triangle may be without a look at the ways out past the edges.
const SHALLOW: f64 = 0.05;

/// The manifolds of a pair of which one is not convex.
pub(super) fn manifolds(
    a: (&Shape, &Frame),
    b: (&Shape, &Frame),
    margin: f64,
    work: &mut Workspace,
    out: &mut Vec<Manifold>,
) {
    let surface = |s: &Shape| matches!(s, Shape::TriMesh(_) | Shape::Heightfield(_));
    let first = out.len();
    if surface(a.0) && !surface(b.0) && body_surface(b, a, margin, work, out) {
        for m in &mut out[first..] {
            *m = m.swapped();
        }
        return;
    }
    if surface(b.0) && !surface(a.0) && body_surface(a, b, margin, work, out) {
        return;
    }
    grouped(a, b, work, out);
}

/// A convex body and a surface; false if the shape is no such body.
fn body_surface(
    (shape, fa): (&Shape, &Frame),
    (surface, fb): (&Shape, &Frame),
    margin: f64,
    work: &mut Workspace,
    out: &mut Vec<Manifold>,
) -> bool {
    // All in the surface's coordinates.
    let local = Frame::new(fb.point_to_local(fa.position), fb.rotation.transpose() * fa.rotation);
    // Relative to the body's place: large surfaces lose nothing.
    let Some(body) = Body::of(shape, &local, Vec3::ZERO) else { return false };
    let middle = body.middle();
    let around = bounds(&body).expanded(margin);
    work.list.clear();
    let mut patch = Patch::new();
    match surface {
        Shape::TriMesh(mesh) => {
            let bears = |place: Vec3, n: Vec3| {
                let mut bears = true;
                let here = Aabb::new(place, place).expanded(NEAR * place.abs_max().max(1.0));
                mesh.tree().query(&here, |i| {
                    if let Some(facet) = mesh.facet(i) {
                        bears &= below(&facet, place, n);
                    }
                });
                bears
            };
            let over = Over { body: &body, middle, margin, bears };
            mesh.tree().query(&around, |i| {
                if let Some(facet) = mesh.facet(i) {
                    body_facet(&over, &facet, i, &mut patch, &mut work.list);
                }
            });
        }
        Shape::Heightfield(field) => {
            let bears = |place: Vec3, n: Vec3| {
                let here = Aabb::new(place, place).expanded(NEAR * place.abs_max().max(1.0));
                let Some(zone) = Zone::under(field, &here) else { return true };
                let cells = |[low, high]: [i64; 2]| low..high;
                cells(zone.x).all(|x| {
                    cells(zone.z).all(|z| {
                        let halves = [false, true].map(|upper| field.facet(x, z, upper));
                        halves.iter().flatten().all(|facet| below(facet, place, n))
                    })
                })
            };
            let over = Over { body: &body, middle, margin, bears };
            if let Some(zone) = Zone::under(field, &around).filter(|zone| around.min.y <= zone.high) {
                for x in zone.x[0]..zone.x[1] {
                    for z in zone.z[0]..zone.z[1] {
                        for upper in [false, true] {
                            if let Some(facet) = field.facet(x, z, upper) {
                                let number =
                                    (x as u32).wrapping_mul(0x9e37_79b1) ^ (z as u32) << 1 ^ u32::from(upper);
                                body_facet(&over, &facet, number, &mut patch, &mut work.list);
                            }
                        }
                    }
                }
                if work.list.is_empty() {
                    // Sunk below the surface: the field is solid all the way down.
                    grouped((shape, fa), (surface, fb), work, out);
                    return true;
                }
            }
        }
        _ => return false,
    }
    patch.frames = (local, Frame::IDENTITY);
    patch.world = *fb;
    group(&mut work.list, ONE_PLACE * body.reach(), &mut patch, |patch| {
        let mut m = Manifold::default();
        patch.write(&mut m);
        out.push(m);
    });
    true
}

/// A body over a surface, in the surface's coordinates.
struct Over<'a, F: Fn(Vec3, Vec3) -> bool> {
    body: &'a Body<'a>,
    middle: Vec3,
    margin: f64,
    /// Whether all triangles at a place of the surface are below the plane with a normal there.
    bears: F,
}

/// Places nearer to each other than this part of their coordinates are one.
const NEAR: f64 = 1e-7;

/// Whether a triangle, if it has a place on its edge or corner, lies below the plane with the normal `n` there.
fn below(facet: &Facet, place: Vec3, n: Vec3) -> bool {
    let scale = facet.scale();
    (facet.nearest(place) - place).abs_max() > 1e-6 * scale
        || facet.corners.iter().all(|&c| n.dot(c - place) <= 1e-5 * scale)
}

/// Adds the points of a body over one triangle, normals into the body, if the body's middle is before the triangle.
///
/// A body that slides over a surface must not be caught by the edges within it. So a normal at an edge is kept only if
/// it lies between those of the two triangles there, or if all triangles there are below the plane that it stands on, which
/// `bears` tells; else the triangle's own normal counts, with the part of the body's
/// face that is over the triangle.
fn body_facet(
    over: &Over<'_, impl Fn(Vec3, Vec3) -> bool>,
    facet: &Facet,
    number: u32,
    patch: &mut Patch,
    list: &mut Vec<Candidate>,
) {
    let &Over { body, middle, margin, .. } = over;
    let n = facet.normal;
    if facet.height(middle) < 0.0 {
        return;
    }
    let lowest = body.support(-n) - n * body.margin;
    let depth = -facet.height(lowest);
    if depth < -margin {
        return;
    }
    // The ball around the body is easily told to be away; of a ball that is all there is to know.
    let from = body.center - facet.nearest(body.center);
    let far = body.reach() + margin;
    if from.length_squared() > far * far {
        return;
    }
    let mut inside = true;
    let mut bends = false;
    for e in 0..3 {
        let outward = facet.outward(e);
        // Beside the triangle altogether.
        let gap = outward.dot(body.support(-outward) - facet.corners[e]) - body.margin;
        if gap > margin {
            return;
        }
        inside &= outward.dot(lowest - facet.corners[e]) <= 0.0;
        bends |= facet.neighbours[e] != Neighbour::FlatOrConcave;
    }
    let triangle = Body::triangle(facet.corners);
    patch.clear();
    patch.normal = n;
    if !bends || (inside && depth < SHALLOW * body.reach()) {
        // Over the triangle, or on a surface that goes on level or rises: only its own normal can be.
        add_face_points(body, &triangle, n, margin, patch);
        if patch.spots().is_empty() {
            add_hidden_point(body, middle, facet, patch);
        }
    } else {
        add_touch_points(over, &triangle, facet, patch);
    }
    let normal = patch.normal;
    for spot in patch.spots() {
        if !nearer_elsewhere(body, facet, middle, normal, spot.depth) {
            let feature = number.wrapping_mul(0x85eb_ca6b) ^ spot.feature;
            list.push(Candidate { spot: Spot { feature, ..*spot }, normal, parts: (-1, facet.index) });
        }
    }
}

/// A ball, its centre before the triangle, and the triangle's nearest point.
fn ball_touch(body: &Body<'_>, facet: &Facet, margin: f64) -> Option<Touch> {
    let b = facet.nearest(body.center);
    let between = body.center - b;
    let normal = between.normalized_or(facet.normal);
    let depth = body.margin - between.length();
    let a = body.center - normal * body.margin;
    (depth >= -margin).then_some(Touch { normal, depth, a, b })
}

/// The points of a body at a triangle with an edge or corner that may touch.
fn add_touch_points(
    over: &Over<'_, impl Fn(Vec3, Vec3) -> bool>,
    triangle: &Body<'_>,
    facet: &Facet,
    patch: &mut Patch,
) {
    let &Over { body, middle, margin, .. } = over;
    let n = facet.normal;
    let touch = match body.core {
        Core::Point => ball_touch(body, facet, margin),
        _ => touch_within(body, triangle, margin, Some(n)).ok(),
    };
    match touch {
        // Beyond an edge within the surface the neighbour bears the body.
        Some(t) if t.normal.dot(n) > 1.0 - SAME && !at_inner_edge(facet, &t) => {
            add_points(body, triangle, &Touch { normal: n, ..t }, margin, Favours::B, patch);
        }
        Some(t)
            if t.normal.dot(n) <= 1.0 - SAME
                && (allowed(facet, &t) || (t.normal.dot(n) > 0.0 && (over.bears)(t.b, t.normal))) =>
        {
            add_points(body, triangle, &t, margin, Favours::B, patch);
            // Of a body with edges the face that looks at an edge must be one of those allowed, too.
            if patch.normal.dot(n) < t.normal.dot(n) - SAME
                && !allowed(facet, &Touch { normal: patch.normal, ..t })
                && !(over.bears)(t.b, patch.normal)
            {
                patch.clear();
                patch.normal = t.normal;
                patch.push(Spot { a: t.a, b: t.b, depth: t.depth, feature: 3 << 30 });
            }
        }
        Some(_) => add_face_points(body, triangle, n, margin, patch),
        None => add_hidden_point(body, middle, facet, patch),
    }
}

/// The points of a body over a triangle along the triangle's normal.
fn add_face_points(body: &Body<'_>, triangle: &Body<'_>, n: Vec3, margin: f64, patch: &mut Patch) {
    let face = feature(triangle, n);
    patch.normal = n;
    clip(&face, &feature(body, -n), n, margin, |p, depth, feature| {
        patch.push(Spot { a: p, b: p + n * depth, depth, feature });
    });
    // The lowest corner need not be one of the face that looks most downward.
    let lowest = body.support(-n) - n * body.margin;
    let depth = n.dot(face.points[0] - lowest);
    // Over the edge between two faces it is over both, whatever the rounding.
    let over = (0..face.count).all(|i| {
        let (p, q) = (face.points[i], face.points[(i + 1) % face.count]);
        n.cross(q - p).dot(lowest - p) >= -1e-9 * (q - p).length_squared()
    });
    if over && depth >= -margin && patch.depth() < depth - 1e-6 * (body.reach() + triangle.reach()) {
        patch.push(Spot { a: lowest, b: lowest + n * depth, depth, feature: 1 << 30 });
    }
}

/// The lowest point of a body that entered the surface over a neighbour and so does not meet this triangle, although it
/// lies below it.
fn add_hidden_point(body: &Body<'_>, middle: Vec3, facet: &Facet, patch: &mut Patch) {
    let n = facet.normal;
    let lowest = body.support(-n) - n * body.margin;
    let (above, depth) = (facet.height(middle), -facet.height(lowest));
    if depth <= 0.0 {
        return;
    }
    let entry = middle + (lowest - middle) * (above / (above + depth));
    for e in 0..3 {
        let outward = facet.outward(e);
        let beyond = |p: Vec3| outward.dot(p - facet.corners[e]) > 0.0;
        if beyond(lowest) || (beyond(entry) && facet.neighbours[e] != Neighbour::FlatOrConcave) {
            return;
        }
    }
    patch.normal = n;
    patch.push(Spot { a: lowest, b: lowest + n * depth, depth, feature: 2 << 30 });
}

/// The contacts of [`collide`](crate::narrow::collide()), grouped by normal. They are known again by place alone.
fn grouped(
    (sa, fa): (&Shape, &Frame),
    (sb, fb): (&Shape, &Frame),
    work: &mut Workspace,
    out: &mut Vec<Manifold>,
) {
    let Workspace { list, contacts } = work;
    contacts.clear();
    list.clear();
    // Near the pair, so that what is far from the world's origin loses nothing.
    let middle = if matches!(sa, Shape::Plane(_)) { fb.position } else { fa.position };
    collide_frames((sa, fa), (sb, fb), CollideOptions::default(), contacts);
    let size = contacts.iter().fold(0.0f64, |s, c| s.max((c.point.position - middle).abs_max()));
    for c in contacts.iter() {
        let (p, half) = (c.point.position - middle, c.point.normal * (0.5 * c.point.depth));
        // Names that small motions keep: the triangles.
        let feature = (c.side1 as u32).wrapping_mul(0x9e37_79b1) ^ (c.side2 as u32).wrapping_mul(0x85eb_ca6b);
        let clash = list.iter().filter(|k| k.parts == (c.side1, c.side2)).count() as u32;
        let spot = Spot { a: p - half, b: p + half, depth: c.point.depth, feature: feature ^ clash << 28 };
        list.push(Candidate { spot, normal: c.point.normal, parts: (c.side1, c.side2) });
    }
    let mut patch = Patch::new();
    patch.world = Frame::new(middle, ferrode_math::Mat3::IDENTITY);
    let relative = |s: &Shape, f: &Frame| {
        // A plane's own coordinates are the world's, wherever its geom says it is.
        let f = if matches!(s, Shape::Plane(_)) { &Frame::IDENTITY } else { f };
        Frame::new(f.position - middle, f.rotation)
    };
    patch.frames = (relative(sa, fa), relative(sb, fb));
    group(list, ONE_PLACE * size, &mut patch, |patch| {
        let mut m = Manifold::default();
        patch.write(&mut m);
        debug_assert!(m.normal != Vec3f::ZERO);
        out.push(m);
    });
}
