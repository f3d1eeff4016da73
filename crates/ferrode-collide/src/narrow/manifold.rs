//! From the deepest point to all points: the features that face each other, clipped.

use super::convex::Touch;
use super::cutout::Cutout;
use super::support::{Body, Core};
use crate::Contacts;
use ferrode_math::Vec3;

/// Most corners of a clipped feature.
const CORNERS: usize = 40;
/// Most corners of a feature; a face with more is thinned out.
const FEATURE: usize = 16;
/// Most contacts of a pair.
const MOST: usize = 8;
/// Cosine of normal and face beyond which the face is what touches.
const FACE: f64 = 1.0 - 1e-6;
/// Sine of the angle between edges, or edge and face, below which they are parallel.
const PARALLEL: f64 = 1e-3;

/// The face, edge or corner of a body that faces a direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Feature {
    pub points: [Vec3; FEATURE],
    pub count: usize,
    /// Outward unit normal of a face; of an edge or corner there is none.
    pub normal: Option<Vec3>,
    /// Which of the body's features it is, from 0: the number of a face, or what tells ends and sides apart.
    pub number: u32,
}

impl Feature {
    fn corner(p: Vec3) -> Self {
        Self { points: [p; FEATURE], count: 1, normal: None, number: 0 }
    }

    fn edge(p: Vec3, q: Vec3) -> Self {
        let mut f = Self::corner(p);
        f.points[1] = q;
        f.count = 2;
        f
    }

    /// The feature of `body` that faces the unit vector `d`.
    pub fn of(body: &Body<'_>, d: Vec3) -> Self {
        let u = body.axis(2);
        let shell = d * body.margin;
        match body.core {
            Core::Point => Self::corner(body.center + shell),
            Core::Segment(half) => {
                if d.dot(u).abs() < 0.5 {
                    Self::edge(body.center + u * half + shell, body.center - u * half + shell)
                } else {
                    Self::corner(body.support(d) + shell)
                }
            }
            Core::Cuboid(h) => {
                let l = body.rotation.transpose_mul(d);
                let a = l.abs();
                let i = if a.x >= a.y && a.x >= a.z {
                    0
                } else if a.y >= a.z {
                    1
                } else {
                    2
                };
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let sign = if l[i] < 0.0 { -1.0 } else { 1.0 };
                let mut f = Self::corner(Vec3::ZERO);
                f.count = 4;
                f.normal = Some(body.axis(i) * sign);
                f.number = 2 * i as u32 + u32::from(sign < 0.0);
                // Counter-clockwise about the outward normal.
                for (m, (sj, sk)) in
                    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].into_iter().enumerate()
                {
                    let mut p = Vec3::ZERO;
                    p[i] = sign * h[i];
                    p[j] = sj * sign * h[j];
                    p[k] = sk * h[k];
                    f.points[m] = body.place(p);
                }
                f
            }
            Core::Ellipsoid(_) | Core::Custom(_) => Self::corner(body.support(d)),
            Core::Cone(radius, half) => {
                let along = d.dot(u);
                let radial = d - u * along;
                if along < -core::f64::consts::FRAC_1_SQRT_2 {
                    return disc(body.center - u * half, -u, radius, radial, body.axis(0));
                }
                // The side faces out and up: by the length across, by the radius along the axis.
                let across = radial.normalized_or(body.axis(0));
                let side = (across * (2.0 * half) + u * radius).normalized_or(across);
                if d.dot(side) > 0.9 {
                    Self::edge(body.center + u * half, body.center - u * half + across * radius)
                } else {
                    Self::corner(body.support(d))
                }
            }
            Core::Hull(hull) => {
                let l = body.rotation.transpose_mul(d);
                let i = hull.face_along(l);
                let corners = hull.face(i);
                let mut f = Self::corner(Vec3::ZERO);
                f.count = corners.len().min(FEATURE);
                f.normal = Some(body.rotation * hull.face_plane(i).0);
                f.number = i as u32;
                for (k, p) in f.points[..f.count].iter_mut().enumerate() {
                    *p = body.place(hull.points()[corners[k * corners.len() / f.count] as usize]);
                }
                f
            }
            Core::Triangle(p) => {
                let mut f = Self::corner(Vec3::ZERO);
                f.count = 3;
                for (k, p) in p.iter().enumerate() {
                    f.points[k] = body.center + *p;
                }
                // Seen from the other side a triangle turns the other way.
                f.normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
                if f.normal.is_some_and(|n| n.dot(d) < 0.0) {
                    f.points.swap(1, 2);
                    f.normal = f.normal.map(|n| -n);
                }
                f
            }
            Core::Cylinder(radius, half) => {
                let along = d.dot(u);
                let radial = d - u * along;
                if along.abs() > core::f64::consts::FRAC_1_SQRT_2 {
                    let sign = if along < 0.0 { -1.0 } else { 1.0 };
                    disc(body.center + u * (sign * half), u * sign, radius, radial, body.axis(0))
                } else {
                    let rim = body.center + radial.normalized_or(body.axis(0)) * radius;
                    Self::edge(rim + u * half, rim - u * half)
                }
            }
        }
    }
}

/// An octagon within a disc; a corner of it points along `radial`, where the disc reaches furthest, or along
/// `fallback` if that is nothing.
fn disc(center: Vec3, normal: Vec3, radius: f64, radial: Vec3, fallback: Vec3) -> Feature {
    let x = if radial.length() > 1e-9 { radial.normalized_or(fallback) } else { fallback };
    let y = normal.cross(x);
    let s = core::f64::consts::FRAC_1_SQRT_2;
    let mut f = Feature::corner(center);
    f.count = 8;
    f.normal = Some(normal);
    for (k, (c, t)) in [(1.0, 0.0), (s, s), (0.0, 1.0), (-s, s), (-1.0, 0.0), (-s, -s), (0.0, -1.0), (s, -s)]
        .into_iter()
        .enumerate()
    {
        f.points[k] = center + (x * c + y * t) * radius;
    }
    f
}

/// A few contacts, before those wanted are chosen.
pub(super) struct Found {
    list: [(Vec3, f64); CORNERS],
    count: usize,
}

impl Default for Found {
    fn default() -> Self {
        Self { list: [(Vec3::ZERO, 0.0); CORNERS], count: 0 }
    }
}

impl Found {
    fn push(&mut self, position: Vec3, depth: f64) {
        if self.count < CORNERS {
            self.list[self.count] = (position, depth);
            self.count += 1;
        }
    }

    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    fn deepest(&self) -> usize {
        let mut best = 0;
        for i in 1..self.count {
            if self.list[i].1 > self.list[best].1 {
                best = i;
            }
        }
        best
    }
}

/// Adds the contacts of two bodies that touch. `origin` is added to all positions.
///
/// A face that touches is the reference: the other body's feature is clipped to it, and each corner left below it is a
/// contact with its own depth, midway between the two surfaces. Parallel edges touch at both ends of their common
/// stretch. Everything else touches at one point. If there are more than wanted, the deepest stays, and those furthest
/// from the ones that stay.
pub(crate) fn add_manifold(a: &Body<'_>, b: &Body<'_>, touch: &Touch, origin: Vec3, out: &mut Contacts<'_>) {
    let n = touch.normal;
    let single = ((touch.a + touch.b) * 0.5, touch.depth);
    let mut found = Found::default();
    if out.capacity() > 1 && !out.options().unimportant {
        let (fa, fb) = (Feature::of(a, -n), Feature::of(b, n));
        let aligned_a = fa.normal.map_or(0.0, |m| -m.dot(n));
        let aligned_b = fb.normal.map_or(0.0, |m| m.dot(n));
        if aligned_a.max(aligned_b) > FACE {
            let (face, other) = if aligned_a >= aligned_b { (&fa, &fb) } else { (&fb, &fa) };
            clip_to_face(face, other, &mut found);
        } else if fa.count == 2 && fb.count == 2 {
            clip_edges(&fa, &fb, n, &mut found);
        }
    }
    let scale = 1e-6 * (a.reach() + b.reach());
    if found.count == 0 {
        found.push(single.0, single.1);
    } else if found.list[found.deepest()].1 < touch.depth - scale {
        // The features are flatter than the bodies: keep the point that decides.
        found.count = found.count.min(CORNERS - 1);
        found.push(single.0, single.1);
    }
    add(&found, n, origin, out);
}

/// Adds the contacts of `a` with the face of `b` that has the normal `n`, and no others.
pub(super) fn add_face_contacts(a: &Body<'_>, b: &Body<'_>, n: Vec3, out: &mut Contacts<'_>) {
    let face = Feature::of(b, n);
    let mut found = Found::default();
    clip_to_face(&face, &Feature::of(a, -n), &mut found);
    // The lowest corner need not be one of the face that looks most downward.
    let lowest = a.support(-n) - n * a.margin;
    let depth = n.dot(face.points[0] - lowest);
    // Over the edge between two faces it is over both, whatever the rounding.
    let over = (0..face.count).all(|i| {
        let (p, q) = (face.points[i], face.points[(i + 1) % face.count]);
        n.cross(q - p).dot(lowest - p) >= -1e-9 * (q - p).length_squared()
    });
    let enough = depth - 1e-6 * (a.reach() + b.reach());
    if over && depth >= 0.0 && (found.is_empty() || found.list[found.deepest()].1 < enough) {
        found.push(lowest + n * (0.5 * depth), depth);
    }
    if !found.is_empty() {
        add(&found, n, Vec3::ZERO, out);
    }
}

/// Tells of the contacts of a body with a triangle along its unit normal `n`: places on the body's surface over the triangle,
/// and how deep they are, at most eight. As [`add_face_contacts`], for many triangles.
pub(super) fn add_part_over(a: &Body<'_>, corners: &[Vec3; 3], n: Vec3, mut add: impl FnMut(Vec3, f64)) {
    let feature = Feature::of(a, -n);
    let level = n.dot(corners[0]);
    let mut part = Cutout::new(&feature.points[..feature.count]);
    part.keep_below(n, level);
    let mut lowest = a.support(-n) - n * a.margin;
    let mut over = true;
    for e in 0..3 {
        // Out over the edge, as long as that is.
        let side = corners[(e + 1) % 3] - corners[e];
        let outward = side.cross(n);
        let edge = outward.dot(corners[e]);
        part.keep_below(outward, edge);
        // Over the edge between two triangles it is over both, whatever the rounding.
        over &= outward.dot(lowest) - edge <= 1e-9 * side.length_squared();
    }
    let points = part.corners();
    let depth = |p: Vec3| level - n.dot(p);
    // The lowest corner need not be one of the face that looks most downward.
    let deepest = points.iter().map(|&p| depth(p)).fold(f64::NEG_INFINITY, f64::max);
    let own = over && depth(lowest) >= 0.0 && deepest < depth(lowest) - 1e-6 * a.reach();
    if points.len() + usize::from(own) <= MOST {
        for &p in points {
            add(p, depth(p).max(0.0));
        }
        if own {
            add(lowest, depth(lowest));
        }
        return;
    }
    // The deepest first, then whatever is furthest from those told of.
    if !own {
        lowest =
            points.iter().copied().reduce(|p, q| if depth(q) > depth(p) { q } else { p }).unwrap_or(lowest);
    }
    let mut nearest = [f64::INFINITY; FEATURE + 8];
    let mut next = lowest;
    for _ in 0..MOST {
        add(next, depth(next).max(0.0));
        let mut furthest = 0;
        for (i, &p) in points.iter().enumerate() {
            nearest[i] = nearest[i].min((p - next).length_squared());
            if nearest[i] > nearest[furthest] {
                furthest = i;
            }
        }
        next = points[furthest];
    }
}

/// Adds what was found, or if that is more than wanted, the deepest and the furthest from those that stay.
fn add(found: &Found, n: Vec3, origin: Vec3, out: &mut Contacts<'_>) {
    let wanted = out.capacity().min(MOST);
    if found.count <= wanted {
        for &(p, depth) in &found.list[..found.count] {
            out.push(origin + p, n, depth);
        }
        return;
    }
    let mut nearest = [f64::INFINITY; CORNERS];
    let mut next = found.deepest();
    for _ in 0..wanted {
        let (p, depth) = found.list[next];
        out.push(origin + p, n, depth);
        nearest[next] = f64::NEG_INFINITY;
        let mut furthest = next;
        for i in 0..found.count {
            nearest[i] = nearest[i].min((found.list[i].0 - p).length_squared());
            if nearest[i] > nearest[furthest] {
                furthest = i;
            }
        }
        next = furthest;
    }
}

/// Clips `other` to the sides of `face` and keeps what is below it.
fn clip_to_face(face: &Feature, other: &Feature, found: &mut Found) {
    let Some(normal) = face.normal else { return };
    let mut points = [Vec3::ZERO; CORNERS];
    points[..other.count].copy_from_slice(&other.points[..other.count]);
    let mut count = other.count;
    for i in 0..face.count {
        let (p, q) = (face.points[i], face.points[(i + 1) % face.count]);
        // Into the face, across this side.
        let Some(inward) = normal.cross(q - p).normalized() else { continue };
        count = clip(&mut points, count, inward, inward.dot(p));
    }
    let level = normal.dot(face.points[0]);
    for p in &points[..count] {
        let depth = level - normal.dot(*p);
        if depth >= 0.0 {
            found.push(*p + normal * (0.5 * depth), depth);
        }
    }
}

/// Keeps the part of a polygon, segment or point with n · x ≥ level.
fn clip(points: &mut [Vec3; CORNERS], count: usize, n: Vec3, level: f64) -> usize {
    let mut kept = [Vec3::ZERO; CORNERS];
    let mut m = 0;
    let mut keep = |p: Vec3| {
        if m < CORNERS {
            kept[m] = p;
            m += 1;
        }
    };
    // A segment is walked once, a polygon round.
    let sides = if count <= 2 { count.saturating_sub(1) } else { count };
    for i in 0..count {
        let p = points[i];
        let hp = n.dot(p) - level;
        if hp >= 0.0 {
            keep(p);
        }
        if i < sides {
            let q = points[(i + 1) % count];
            let hq = n.dot(q) - level;
            if (hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0) {
                keep(p + (q - p) * (hp / (hp - hq)));
            }
        }
    }
    *points = kept;
    m
}

/// The common stretch of two parallel edges.
fn clip_edges(a: &Feature, b: &Feature, n: Vec3, found: &mut Found) {
    let (sa, sb) = (a.points[1] - a.points[0], b.points[1] - b.points[0]);
    let (Some(ua), Some(ub)) = (sa.normalized(), sb.normalized()) else { return };
    if ua.cross(ub).length() > PARALLEL || ua.dot(n).abs() > PARALLEL {
        return;
    }
    let along = |p: Vec3| ua.dot(p - a.points[0]);
    let (b0, b1) = (along(b.points[0]), along(b.points[1]));
    let (lo, hi) = (b0.min(b1).max(0.0), b0.max(b1).min(sa.length()));
    if !(lo < hi) {
        return;
    }
    for x in [lo, hi] {
        let pa = a.points[0] + ua * x;
        let pb = b.points[0] + sb * ((x - b0) / (b1 - b0));
        let depth = n.dot(pb - pa);
        if depth >= 0.0 {
            found.push((pa + pb) * 0.5, depth);
        }
    }
}
