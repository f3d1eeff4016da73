use super::unit::{unit, unit_or};
use crate::{Contacts, Cylinder, Frame, Sphere};

/// How far the axis must lie outside the ball for the contact to be on the ball's surface.
const AXIS_OUTSIDE: f64 = 1e-7;

/// A cylinder and a ball: one contact, by rim, side or cap.
pub fn cylinder_sphere(cylinder: &Cylinder, fc: &Frame, sphere: &Sphere, fs: &Frame, out: &mut Contacts<'_>) {
    let (radius, length, r) = (cylinder.radius(), cylinder.length(), sphere.radius());
    let u = fc.axis(2);
    let center = fs.position;
    let relative = center - fc.position;
    // Height over the bottom disc, and distance from the axis.
    let height = u.dot(relative) + 0.5 * length;
    if height < -r || height > length + r {
        return;
    }
    let radial = relative - u * u.dot(relative);
    let square = radial.length_squared();
    if square > (radius + r) * (radius + r) * (1.0 + 1e-9) {
        return;
    }
    let distance = square.sqrt();
    if height < -r || height > length + r || distance > radius + r || !distance.is_finite() {
        return;
    }
    // A centre on the axis is as near to one side as to any other.
    let outward = unit(radial).unwrap_or_else(|| fc.axis(0));
    let within = height >= 0.0 && height <= length;
    if distance > radius && !within {
        let end = if height < 0.0 { -0.5 * length } else { 0.5 * length };
        let rim = fc.position + u * end + outward * radius;
        let line = rim - center;
        let depth = r - line.length();
        if depth >= 0.0 {
            out.push(rim, unit_or(line, -outward), depth);
        }
        return;
    }
    let inside = radius - distance;
    if inside <= height && inside <= length - height {
        let n = -outward;
        let position = if distance > r + AXIS_OUTSIDE { center + n * r } else { center - radial };
        out.push(position, n, r + inside);
    } else if height <= 0.5 * length {
        out.push(center + u * r, u, height + r);
    } else {
        out.push(center - u * r, -u, r + length - height);
    }
}
