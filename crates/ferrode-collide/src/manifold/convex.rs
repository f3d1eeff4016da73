//! Two convex bodies: how they touch by GJK and EPA, then all points by clipping the features that face each other.

use super::patch::{Patch, Spot};
use super::{Axis, Favours, Touching};
use crate::narrow::convex::{Touch, touch_within};
use crate::narrow::manifold::Feature;
use crate::narrow::support::{Body, Core};
use crate::{Cuboid, Frame, Shape, Sphere};
use ferrode_math::Vec3;

/// How much less than the least depth, in parts of the smaller body, a face may be and yet be the reference.
const PREFER: f64 = 1e-3;
/// Cosine between the normal and a face beyond which the face is not asked.
const FACING: f64 = 0.9;
/// Sine of the angle up to which two edges touch along a line.
const PARALLEL: f64 = 0.05;
/// Most corners of a feature, and of one clipped to another.
const CORNERS: usize = 40;
/// Lines from this number on are the sides of the reference face.
const SIDE: u8 = 16;

/// The manifold of two convex shapes of finite size, in the first one's coordinates.
pub(super) fn pair(
    (sa, fa): (&Shape, &Frame),
    (sb, fb): (&Shape, &Frame),
    margin: f64,
    guess: Option<Vec3>,
    axis: &mut Axis,
    patch: &mut Patch,
) -> Touching {
    let local = Frame::new(fa.point_to_local(fb.position), fa.rotation.transpose() * fb.rotation);
    patch.frames = (Frame::IDENTITY, local);
    patch.world = *fa;
    match (sa, sb) {
        (Shape::Sphere(a), Shape::Sphere(b)) => return spheres(a, b, local.position, margin, patch),
        (Shape::Cuboid(a), Shape::Sphere(b)) => {
            return cuboid_sphere(a, &Frame::IDENTITY, b, local.position, 1.0, margin, patch);
        }
        (Shape::Sphere(a), Shape::Cuboid(b)) => {
            return cuboid_sphere(b, &local, a, Vec3::ZERO, -1.0, margin, patch);
        }
        _ => {}
    }
    let (Some(a), Some(b)) = (Body::of(sa, &Frame::IDENTITY, Vec3::ZERO), Body::of(sb, &local, Vec3::ZERO))
    else {
        return Touching::Apart(f64::INFINITY);
    };
    match touch_within(&a, &b, margin, guess) {
        Ok(touch) => {
            axis.set_direction(touch.normal);
            add_points(&a, &b, &touch, margin, axis.favours, patch);
            Touching::Yes
        }
        Err(by) => Touching::Apart(by),
    }
}

fn spheres(a: &Sphere, b: &Sphere, centre: Vec3, margin: f64, patch: &mut Patch) -> Touching {
    let distance = centre.length();
    let depth = a.radius() + b.radius() - distance;
    if depth < -margin {
        return Touching::Apart(-depth - margin);
    }
    let n = -centre.normalized_or(Vec3::Z);
    patch.normal = n;
    patch.push(Spot { a: -n * a.radius(), b: centre + n * b.radius(), depth, feature: 0 });
    Touching::Yes
}

/// `sign` is 1 if the box is A, −1 if it is B.
fn cuboid_sphere(
    cuboid: &Cuboid,
    frame: &Frame,
    ball: &Sphere,
    centre: Vec3,
    sign: f64,
    margin: f64,
    patch: &mut Patch,
) -> Touching {
    let (h, c) = (cuboid.half_sides(), frame.point_to_local(centre));
    let mut on_box = c.max(-h).min(h);
    let out = c - on_box;
    let square = out.length_squared();
    let (outward, distance);
    if square > 0.0 {
        distance = square.sqrt();
        outward = out / distance;
    } else {
        // The centre is inside: out through the nearest face.
        let gap = h - c.abs();
        let i = if gap.x <= gap.y && gap.x <= gap.z {
            0
        } else if gap.y <= gap.z {
            1
        } else {
            2
        };
        let side = if c[i] < 0.0 { -1.0 } else { 1.0 };
        let mut axis = Vec3::ZERO;
        axis[i] = side;
        on_box[i] = side * h[i];
        outward = axis;
        distance = -gap[i];
    }
    let depth = ball.radius() - distance;
    if depth < -margin {
        return Touching::Apart(-depth - margin);
    }
    let (n, on_box) = (frame.vector_to_world(outward), frame.point_to_world(on_box));
    let on_ball = centre - n * ball.radius();
    patch.normal = n * -sign;
    patch.normal_of_a = sign > 0.0;
    let (a, b) = if sign > 0.0 { (on_box, on_ball) } else { (on_ball, on_box) };
    patch.push(Spot { a, b, depth, feature: 0 });
    Touching::Yes
}

/// A corner of a clipped feature, and the line to the next one.
#[derive(Clone, Copy)]
struct Corner {
    p: Vec3,
    line: u8,
}

/// The name of a place between two lines of two features.
fn name(kind: u32, face: u32, other: u32, x: u8, y: u8) -> u32 {
    let (x, y) = if x < y { (x, y) } else { (y, x) };
    kind << 30 | (face & 0x3ff) << 20 | (other & 0x3ff) << 10 | u32::from(x) << 5 | u32::from(y)
}

/// The feature of a body along a direction. The corners of a disc stay on the body, whichever way it leans.
pub(super) fn feature(body: &Body<'_>, d: Vec3) -> Feature {
    let mut f = Feature::of(body, d);
    if let (Core::Cylinder(radius, _) | Core::Cone(radius, _), Some(n)) = (body.core, f.normal) {
        let mut middle = Vec3::ZERO;
        for p in &f.points[..f.count] {
            middle += *p;
        }
        middle *= 1.0 / f.count as f64;
        let (x, y) = (body.axis(0), body.axis(1));
        let s = core::f64::consts::FRAC_1_SQRT_2;
        let turn = if n.dot(body.axis(2)) < 0.0 { -1.0 } else { 1.0 };
        let octagon = [(1.0, 0.0), (s, s), (0.0, 1.0), (-s, s), (-1.0, 0.0), (-s, -s), (0.0, -1.0), (s, -s)];
        for (p, (c, t)) in f.points.iter_mut().zip(octagon) {
            *p = middle + (x * c + y * (turn * t)) * radius;
        }
        f.number = u32::from(turn < 0.0);
    }
    f
}

/// Adds the points of two bodies that touch as `t` tells, and are apart by no more than `margin`.
///
/// The reference is the face along which they overlap least, if that is no more than a hair beyond the least of all
/// directions: a body on a face has a whole patch, whichever of nearly equal directions GJK ended with.
pub(super) fn add_points(
    a: &Body<'_>,
    b: &Body<'_>,
    t: &Touch,
    margin: f64,
    favours: Favours,
    patch: &mut Patch,
) {
    let n = t.normal;
    patch.normal = n;
    patch.normal_of_a = false;
    let prefer = PREFER * a.reach().min(b.reach());
    let (fa, fb) = (feature(a, -n), feature(b, n));
    // Depth along the normal of a face of `x`.
    let along = |f: &Feature, x: &Body<'_>, y: &Body<'_>, d: Vec3| {
        f.normal
            .filter(|m| m.dot(d) > FACING)
            .map(|m| (x.margin + m.dot(f.points[0]) - (m.dot(y.support(-m)) - y.margin), m))
    };
    let (da, db) = (along(&fa, a, b, -n), along(&fb, b, a, n));
    let good = |d: &Option<(f64, Vec3)>| d.filter(|d| d.0 <= t.depth + prefer);
    let (da, db) = (good(&da), good(&db));
    let lead = prefer
        * match favours {
            Favours::None => 1e-3,
            Favours::A => 1.0,
            Favours::B => -1.0,
        };
    match (da, db) {
        (Some((x, m)), y) if y.is_none_or(|y| x <= y.0 + lead) => {
            patch.normal = -m;
            patch.normal_of_a = true;
            let other = feature(b, -m);
            clip(&fa, &other, m, margin, |p, depth, feature| {
                patch.push(Spot { a: p + m * depth, b: p, depth, feature })
            });
        }
        (_, Some((_, m))) => {
            patch.normal = m;
            let other = feature(a, -m);
            clip(&fb, &other, m, margin, |p, depth, feature| {
                patch.push(Spot { a: p, b: p + m * depth, depth, feature: feature | 1 << 31 })
            });
        }
        _ => {
            if fa.count == 2 && fb.count == 2 {
                edges(&fa, &fb, n, margin, patch);
            }
        }
    }
    if patch.depth() < t.depth - prefer {
        if patch.spots().is_empty() {
            patch.normal = n;
            patch.normal_of_a = false;
        }
        let depth = patch.normal.dot(t.b - t.a);
        patch.push(Spot { a: t.a, b: t.b, depth, feature: name(1, fa.number, fb.number, 31, 31) });
    }
}

/// Clips `other` to the sides of `face`, whose outward normal is `m`, and reports what is below it or no further above
/// than `margin`: place on the other, depth, and name.
pub(super) fn clip(
    face: &Feature,
    other: &Feature,
    m: Vec3,
    margin: f64,
    mut found: impl FnMut(Vec3, f64, u32),
) {
    let zero = Corner { p: Vec3::ZERO, line: 0 };
    let mut list = [zero; CORNERS];
    let mut count = other.count;
    for (i, (corner, p)) in list.iter_mut().zip(&other.points[..count]).enumerate() {
        *corner = Corner { p: *p, line: i as u8 };
    }
    let open = count <= 2;
    // The ends of a segment are known by themselves.
    let mut ends = [0u8, 1];
    for i in 0..face.count {
        let (p, q) = (face.points[i], face.points[if i + 1 == face.count { 0 } else { i + 1 }]);
        let outward = (q - p).cross(m);
        let beyond = |x: Vec3| outward.dot(x - p);
        let line = SIDE + i as u8;
        if open {
            let (h0, h1) = (beyond(list[0].p), beyond(list[count - 1].p));
            match (h0 > 0.0, h1 > 0.0) {
                (true, true) => return,
                (false, false) => {}
                (first, _) => {
                    let cut = list[0].p + (list[1].p - list[0].p) * (h0 / (h0 - h1));
                    let k = usize::from(!first);
                    list[k].p = cut;
                    ends[k] = line;
                }
            }
            continue;
        }
        let mut kept = [zero; CORNERS];
        let mut n = 0;
        let mut push = |c: Corner| {
            if n < CORNERS {
                kept[n] = c;
                n += 1;
            }
        };
        let mut here = beyond(list[0].p);
        for k in 0..count {
            let (c, next) = (list[k], list[if k + 1 == count { 0 } else { k + 1 }]);
            let there = beyond(next.p);
            if here <= 0.0 {
                push(c);
            }
            if (here <= 0.0) != (there <= 0.0) {
                let p = c.p + (next.p - c.p) * (here / (here - there));
                push(Corner { p, line: if here <= 0.0 { line } else { c.line } });
            }
            here = there;
        }
        if n == 0 {
            return;
        }
        list = kept;
        count = n;
    }
    let level = m.dot(face.points[0]);
    for k in 0..count {
        let depth = level - m.dot(list[k].p);
        if depth >= -margin {
            let (x, y) = if open {
                (ends[k.min(1)], 30)
            } else {
                (list[if k == 0 { count - 1 } else { k - 1 }].line, list[k].line)
            };
            found(list[k].p, depth, name(0, face.number, other.number, x, y));
        }
    }
}

/// Two edges that are nearly parallel touch at both ends of their common stretch.
fn edges(fa: &Feature, fb: &Feature, n: Vec3, margin: f64, patch: &mut Patch) {
    let (sa, sb) = (fa.points[1] - fa.points[0], fb.points[1] - fb.points[0]);
    let (Some(ua), Some(ub)) = (sa.normalized(), sb.normalized()) else { return };
    if ua.cross(ub).length() > PARALLEL || ua.dot(n).abs() > PARALLEL {
        return;
    }
    let along = |p: Vec3| ua.dot(p - fa.points[0]);
    let (b0, b1) = (along(fb.points[0]), along(fb.points[1]));
    let (lo, hi) = (b0.min(b1).max(0.0), b0.max(b1).min(sa.length()));
    if !(lo < hi) {
        return;
    }
    for (x, end) in [(lo, 0), (hi, 1)] {
        let a = fa.points[0] + ua * x;
        let b = fb.points[0] + sb * ((x - b0) / (b1 - b0));
        let depth = n.dot(b - a);
        if depth >= -margin {
            patch.push(Spot { a, b, depth, feature: name(1, fa.number, fb.number, 30, end) });
        }
    }
}
