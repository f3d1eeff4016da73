//! Cylinder against box: separating axes, then clipping of what faces the other.

use super::convex::touch;
use super::manifold::add_manifold;
use super::polygon::Polygon;
use super::support::Body;
use crate::{Contacts, Cuboid, Cylinder, Frame};
use core::f64::consts::FRAC_PI_8;
use ferrode_math::{Vec3, real};

/// Axes shorter than this are left out, and edges whose cosine with the cylinder's axis is less.
const SHORTEST: f64 = 1e-5;
/// Cosine of normal and axis from which a contact is at the cap rather than the side.
const CAP: f64 = 0.9;

struct Pair<'a> {
    cylinder: &'a Cylinder,
    fc: &'a Frame,
    half: Vec3,
    fb: &'a Frame,
    /// The cylinder's axis.
    u: Vec3,
    /// From the box's centre to the cylinder's.
    between: Vec3,
}

/// The axis of least overlap so far.
struct Best {
    overlap: f64,
    /// Unit, from the box to the cylinder.
    normal: Vec3,
}

impl Pair<'_> {
    /// Half the box's extent along the unit axis `n`.
    fn box_reach(&self, n: Vec3) -> f64 {
        let h = self.half;
        (self.fb.axis(0).dot(n) * h.x).abs()
            + (self.fb.axis(1).dot(n) * h.y).abs()
            + (self.fb.axis(2).dot(n) * h.z).abs()
    }

    /// Half the cylinder's extent along the unit axis `n`.
    fn cylinder_reach(&self, n: Vec3) -> f64 {
        // The sine by the cross product: from a cosine near 1 it would be rounding's root.
        let across = self.u.cross(n).length();
        n.dot(self.u).abs() * 0.5 * self.cylinder.length() + self.cylinder.radius() * across
    }

    /// Tries an axis of any length; false if it separates.
    fn test(&self, axis: Vec3, best: &mut Best) -> bool {
        let length = axis.length();
        if !(length >= SHORTEST) {
            return true;
        }
        // Scaled before it is squared, as ODE's normaliser does: the last bit decides where faces are parallel.
        let scaled = axis / axis.abs_max();
        let n = scaled * (1.0 / scaled.length());
        let distance = self.between.dot(n);
        let overlap = self.box_reach(n) + self.cylinder_reach(n) - distance.abs();
        if overlap < 0.0 {
            return false;
        }
        if overlap < best.overlap {
            best.overlap = overlap;
            best.normal = if distance > 0.0 { n } else { -n };
        }
        true
    }

    /// Corner `i` of the box relative to its centre.
    fn corner(&self, i: usize) -> Vec3 {
        let h = self.half;
        let pick = |bit: usize, x: f64| if i & bit != 0 { x } else { -x };
        self.fb.vector_to_world(Vec3::new(pick(1, h.x), pick(2, h.y), pick(4, h.z)))
    }

    fn least_overlap(&self) -> Option<Best> {
        let mut best = Best { overlap: f64::INFINITY, normal: Vec3::ZERO };
        let u = self.u;
        for i in 0..3 {
            if !self.test(self.fb.axis(i), &mut best) {
                return None;
            }
        }
        if !self.test(u, &mut best) {
            return None;
        }
        for i in 0..3 {
            if !self.test(u.cross(self.fb.axis(i)), &mut best) {
                return None;
            }
        }
        for i in 0..8 {
            if !self.test(u.cross(u.cross(self.corner(i) - self.between)), &mut best) {
                return None;
            }
        }
        // Where the line of an edge crosses the plane of a rim, the rim's tangent and the edge span a plane that may
        // separate.
        for end in [0.5, -0.5] {
            let rim = self.between + u * (end * self.cylinder.length());
            for i in 0..3 {
                let edge = self.fb.axis(i);
                let cosine = edge.dot(u);
                if cosine.abs() < SHORTEST {
                    continue;
                }
                for k in 0..4 {
                    let low = k & ((1 << i) - 1);
                    let corner = self.corner(low | ((k & !((1 << i) - 1)) << 1));
                    let crossing = corner + edge * ((rim - corner).dot(u) / cosine);
                    let tangent = (crossing - rim).cross(u);
                    if !self.test(tangent.cross(edge), &mut best) {
                        return None;
                    }
                }
            }
        }
        (best.overlap < f64::INFINITY).then_some(best)
    }

    /// The generator of the cylinder that faces the box, as far as it runs within the box.
    fn side_contacts(&self, best: &Best, out: &mut Contacts<'_>) {
        let n = best.normal;
        let Some(outward) = (n - self.u * n.dot(self.u)).normalized() else { return };
        let middle = self.between - outward * self.cylinder.radius();
        let half = self.u * (0.5 * self.cylinder.length());
        let (a, b) = (middle + half, middle - half);
        let (mut lo, mut hi) = (0.0f64, 1.0f64);
        for i in 0..3 {
            let axis = self.fb.axis(i);
            let (start, slope) = (a.dot(axis), (b - a).dot(axis));
            for sign in [1.0, -1.0] {
                let (height, slope) = (sign * start - self.half[i], sign * slope);
                if slope == 0.0 {
                    if height > 0.0 {
                        return;
                    }
                } else if slope > 0.0 {
                    hi = hi.min(-height / slope);
                } else {
                    lo = lo.max(-height / slope);
                }
            }
        }
        if lo > hi {
            return;
        }
        let reach = self.box_reach(n);
        for t in [lo, hi] {
            let p = a + (b - a) * t;
            let depth = reach - p.dot(n);
            if depth >= 0.0 {
                out.push(p + self.fb.position, n, depth);
            }
        }
    }

    /// The face of the box that faces the cap, clipped to the cap's plane and the octagon about its circle.
    fn cap_contacts(&self, best: &Best, out: &mut Contacts<'_>) {
        let n = best.normal;
        let local = self.fb.vector_to_local(n);
        let l = local.abs();
        // The face most along the normal; of its two axes the one more along the normal first. Libode's order of
        // corners, equal components included.
        let (face, i, j) = if l.x > l.y && l.x > l.z {
            if l.y > l.z { (0, 1, 2) } else { (0, 2, 1) }
        } else if l.y > l.z {
            if l.x > l.z { (1, 0, 2) } else { (1, 2, 0) }
        } else if l.x >= l.y {
            (2, 0, 1)
        } else {
            (2, 1, 0)
        };
        let sign = if local[face] > 0.0 { 1.0 } else { -1.0 };
        let mut polygon =
            Polygon::new(&[(1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(si, sj)| {
                let mut corner = Vec3::ZERO;
                corner[face] = sign * self.half[face];
                corner[i] = si * self.half[i];
                corner[j] = sj * self.half[j];
                self.fb.vector_to_world(corner)
            }));
        // The cap that faces the box, and the inward normal of its plane.
        let inward = if n.dot(self.u) > 0.0 { self.u } else { -self.u };
        let cap = self.between - inward * (0.5 * self.cylinder.length());
        polygon.clip(inward, -inward.dot(cap));
        for k in 0..8 {
            let angle = FRAC_PI_8 + k as f64 * 2.0 * FRAC_PI_8;
            let radial = self.fc.axis(0) * real::cos(angle) + self.fc.axis(1) * real::sin(angle);
            polygon.clip(-radial, radial.dot(cap) + self.cylinder.radius());
        }
        let reach = self.cylinder_reach(n) - self.between.dot(n);
        for &p in polygon.corners() {
            let depth = reach + p.dot(n);
            if depth > 0.0 {
                out.push(p + self.fb.position, n, depth);
            }
        }
    }
}

/// A cylinder and a box: along the side up to two contacts on the cylinder, at a cap up to twelve on the box.
///
/// As in libode the cap is an octagon about its circle, so contacts may lie up to 8 % of the radius outside.
pub fn cylinder_cuboid(cylinder: &Cylinder, fc: &Frame, cuboid: &Cuboid, fb: &Frame, out: &mut Contacts<'_>) {
    let pair = Pair {
        cylinder,
        fc,
        half: cuboid.half_sides(),
        fb,
        u: fc.axis(2),
        between: fc.position - fb.position,
    };
    let Some(best) = pair.least_overlap() else { return };
    if best.normal.dot(pair.u).abs() < CAP {
        pair.side_contacts(&best, out);
    } else {
        pair.cap_contacts(&best, out);
    }
    // An edge beside the part that was clipped leaves nothing, though the bodies overlap. Libode then has no contact.
    if out.is_empty() && best.overlap > 1e-9 * cylinder.length().max(cylinder.radius()) {
        let a = Body::cylinder(cylinder, fc, fc.position);
        let b = Body::cuboid(cuboid, fb, fc.position);
        if let Some(t) = touch(&a, &b) {
            add_manifold(&a, &b, &t, fc.position, out);
        }
    }
}
