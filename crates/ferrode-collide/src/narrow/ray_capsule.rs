use super::unit::unit_or;
use crate::{Capsule, Contacts, Frame, Ray};
use ferrode_math::Vec3;

/// A ray and a capsule: where the ray enters, or leaves if it begins inside, with the normal then inward.
///
/// A capsule is the union of two balls and a cylinder; being convex it meets a line in one interval. Its end is on the
/// cylinder if the line crosses that between the discs, else on the ball beyond the disc.
pub fn ray_capsule(ray: &Ray, fr: &Frame, capsule: &Capsule, fc: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let (r, half) = (capsule.radius(), 0.5 * capsule.length());
    // From the line's point nearest to the centre: far origins would lose the small difference of squares.
    let between = o - fc.position;
    let nearest = -between.dot(u);
    let reach = (half + r) * (1.0 + 1e-9);
    if (between + u * nearest).length_squared() > reach * reach
        || nearest + reach < 0.0
        || nearest - reach > ray.length()
    {
        return;
    }
    let (start, direction) = (fc.vector_to_local(between), fc.vector_to_local(u));
    let Some((entry, exit)) = span(start, direction, r, half) else { return };
    let alpha = if entry >= 0.0 { entry } else { exit };
    if !(alpha >= 0.0 && alpha <= ray.length()) {
        return;
    }
    let from_axis = |p: Vec3| p - Vec3::new(0.0, 0.0, p.z.clamp(-half, half));
    let outward = fc.vector_to_world(unit_or(from_axis(start + direction * alpha), -direction));
    let inside = from_axis(start).length_squared() < r * r;
    out.push(o + u * alpha, if inside { -outward } else { outward }, alpha);
}

/// Where the line start + t direction enters and leaves.
fn span(start: Vec3, direction: Vec3, r: f64, half: f64) -> Option<(f64, f64)> {
    // Of the ball about the end at height z.
    let ball = |z: f64| {
        let q = start - Vec3::new(0.0, 0.0, z);
        let nearest = -q.dot(direction);
        let square = r * r - (q + direction * nearest).length_squared();
        (square >= 0.0).then(|| (nearest - square.sqrt(), nearest + square.sqrt()))
    };
    let a = direction.x * direction.x + direction.y * direction.y;
    if a > 1e-300 {
        let middle = -(start.x * direction.x + start.y * direction.y) / a;
        let p = start + direction * middle;
        let square = r * r - (p.x * p.x + p.y * p.y);
        if !(square >= 0.0) {
            return None;
        }
        let chord = (square / a).sqrt();
        let end = |t: f64, sign: f64| {
            let z = start.z + direction.z * t;
            if z.abs() <= half {
                return Some(t);
            }
            ball(if z > 0.0 { half } else { -half }).map(|b| if sign < 0.0 { b.0 } else { b.1 })
        };
        Some((end(middle - chord, -1.0)?, end(middle + chord, 1.0)?))
    } else {
        // Along the axis.
        let (low, high) = (ball(-half)?, ball(half)?);
        Some((low.0.min(high.0), low.1.max(high.1)))
    }
}
