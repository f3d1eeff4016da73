//! A convex body and a surface of triangles; and all pairs for which contacts are grouped.

use super::candidates::{Candidate, Workspace, group};
use super::convex::{add_points, clip, feature};
use super::patch::{Patch, Spot};
use super::{Manifold, Vec3f};
use crate::narrow::collide_frames;
use crate::narrow::convex::{Touch, touch_within};
use crate::narrow::heightfield_shape::Zone;
use crate::narrow::support::Body;
use crate::narrow::triangle::{Facet, SAME, allowed, at_inner_edge, bounds, nearer_elsewhere};
use crate::shape::Neighbour;
use crate::{CollideOptions, Frame, Shape};
use ferrode_math::Vec3;

/// Points of a body nearer to each other than this part of its size are one.
const ONE_PLACE: f64 = 1e-4;

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
        Shape::TriMesh(mesh) => mesh.tree().query(&around, |i| {
            if let Some(facet) = mesh.facet(i) {
                body_facet(&body, middle, &facet, i, margin, &mut patch, &mut work.list);
            }
        }),
        Shape::Heightfield(field) => {
            if let Some(zone) = Zone::under(field, &around).filter(|zone| around.min.y <= zone.high) {
                for x in zone.x[0]..zone.x[1] {
                    for z in zone.z[0]..zone.z[1] {
                        for upper in [false, true] {
                            if let Some(facet) = field.facet(x, z, upper) {
                                let number =
                                    (x as u32).wrapping_mul(0x9e37_79b1) ^ (z as u32) << 1 ^ u32::from(upper);
                                body_facet(&body, middle, &facet, number, margin, &mut patch, &mut work.list);
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

/// Adds the points of a body over one triangle, normals into the body, if the body's middle is before the triangle.
///
/// A body that slides over a surface must not be caught by the edges within it. So a normal at an edge is kept only if
/// it lies between those of the two triangles there; else the triangle's own normal counts, with the part of the body's
/// face that is over the triangle.
fn body_facet(
    body: &Body<'_>,
    middle: Vec3,
    facet: &Facet,
    number: u32,
    margin: f64,
    patch: &mut Patch,
    list: &mut Vec<Candidate>,
) {
    let n = facet.normal;
    if facet.height(middle) < 0.0 || facet.height(body.support(-n)) - body.margin > margin {
        return;
    }
    let triangle = Body::triangle(facet.corners);
    patch.clear();
    patch.normal = n;
    match touch_within(body, &triangle, margin) {
        // Beyond an edge within the surface the neighbour bears the body.
        Ok(t) if t.normal.dot(n) > 1.0 - SAME && !at_inner_edge(facet, &t) => {
            add_points(body, &triangle, &Touch { normal: n, ..t }, margin, patch);
        }
        Ok(t) if t.normal.dot(n) <= 1.0 - SAME && allowed(facet, &t) => {
            add_points(body, &triangle, &t, margin, patch);
            // Of a body with edges the face that looks at an edge must be one of those allowed, too.
            if patch.normal.dot(n) < t.normal.dot(n) - SAME
                && !allowed(facet, &Touch { normal: patch.normal, ..t })
            {
                patch.clear();
                patch.normal = t.normal;
                patch.push(Spot { a: t.a, b: t.b, depth: t.depth, feature: 3 << 30 });
            }
        }
        Ok(_) => add_face_points(body, &triangle, n, margin, patch),
        Err(_) => add_hidden_point(body, middle, facet, patch),
    }
    let normal = patch.normal;
    for spot in patch.spots() {
        if !nearer_elsewhere(body, facet, middle, normal, spot.depth) {
            let feature = number.wrapping_mul(0x85eb_ca6b) ^ spot.feature;
            list.push(Candidate { spot: Spot { feature, ..*spot }, normal, parts: (-1, facet.index) });
        }
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
