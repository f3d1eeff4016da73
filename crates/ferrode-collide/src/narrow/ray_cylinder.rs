use super::unit::unit_of_length;
use crate::{Contacts, Cylinder, Frame, Ray};
use ferrode_math::Vec3;

/// A ray and a cylinder: where the ray enters, or leaves if it begins inside; the normal opposes the ray.
pub fn ray_cylinder(ray: &Ray, fr: &Frame, cylinder: &Cylinder, fc: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let (radius, half) = (cylinder.radius(), 0.5 * cylinder.length());
    let between = o - fc.position;
    let nearest = -between.dot(u);
    let reach = cylinder.reach() * (1.0 + 1e-9);
    if (between + u * nearest).length_squared() > reach * reach
        || nearest + reach < 0.0
        || nearest - reach > ray.length()
    {
        return;
    }
    let (start, direction) = (fc.vector_to_local(between), fc.vector_to_local(u));
    // The part of the line within the side.
    let a = direction.x * direction.x + direction.y * direction.y;
    let (mut lo, mut hi) = (f64::NEG_INFINITY, f64::INFINITY);
    if a > 1e-300 {
        let inverse = 1.0 / a;
        let middle = -(start.x * direction.x + start.y * direction.y) * inverse;
        let p = start + direction * middle;
        let square = radius * radius - (p.x * p.x + p.y * p.y);
        if !(square >= 0.0) {
            return;
        }
        let chord = (square * inverse).sqrt();
        (lo, hi) = (middle - chord, middle + chord);
    } else if start.x * start.x + start.y * start.y > radius * radius {
        return;
    }
    // And between the caps.
    let (mut lo_cap, mut hi_cap) = (false, false);
    if direction.z != 0.0 {
        let inverse = 1.0 / direction.z;
        let (s, t) = ((-half - start.z) * inverse, (half - start.z) * inverse);
        let (s, t) = if s < t { (s, t) } else { (t, s) };
        if s > lo {
            (lo, lo_cap) = (s, true);
        }
        if t < hi {
            (hi, hi_cap) = (t, true);
        }
    } else if start.z.abs() > half {
        return;
    }
    if !(lo <= hi) {
        return;
    }
    let (alpha, cap) = if lo >= 0.0 { (lo, lo_cap) } else { (hi, hi_cap) };
    if !(alpha >= 0.0 && alpha <= ray.length()) {
        return;
    }
    let n = if cap {
        fc.axis(2)
    } else {
        let p = start + direction * alpha;
        // As long as the radius, but for rounding.
        unit_of_length(fc.axis(0) * p.x + fc.axis(1) * p.y, radius).unwrap_or(Vec3::X)
    };
    out.push(o + u * alpha, if n.dot(u) > 0.0 { -n } else { n }, alpha);
}
