use super::unit::unit_of_length;
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
    let Some(alpha) = first_end(start, direction, r, half) else { return };
    if !(alpha <= ray.length()) {
        return;
    }
    let from_axis = |p: Vec3| {
        let z = if p.z > half {
            p.z - half
        } else if p.z < -half {
            p.z + half
        } else {
            0.0
        };
        Vec3::new(p.x, p.y, z)
    };
    let outward = unit_of_length(from_axis(start + direction * alpha), r).unwrap_or(-direction);
    let outward = fc.vector_to_world(outward);
    let inside = from_axis(start).length_squared() < r * r;
    out.push_sound(o + u * alpha, if inside { -outward } else { outward }, alpha);
}

/// Where the line start + t direction enters, or if that is before its start, where it leaves.
fn first_end(start: Vec3, direction: Vec3, r: f64, half: f64) -> Option<f64> {
    // Of the ball about the end at height z, to the one side or the other.
    let ball = |z: f64, sign: f64| {
        let q = start - Vec3::new(0.0, 0.0, z);
        let nearest = -q.dot(direction);
        let square = r * r - (q + direction * nearest).length_squared();
        (square >= 0.0).then(|| nearest + sign * square.sqrt())
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
        let end = |sign: f64| {
            let t = middle + sign * chord;
            let z = start.z + direction.z * t;
            if z.abs() <= half { Some(t) } else { ball(if z > 0.0 { half } else { -half }, sign) }
        };
        let entry = end(-1.0)?;
        if entry >= 0.0 { Some(entry) } else { end(1.0).filter(|&exit| exit >= 0.0) }
    } else {
        // Along the axis.
        let entry = ball(-half, -1.0)?.min(ball(half, -1.0)?);
        let exit = ball(-half, 1.0)?.max(ball(half, 1.0)?);
        Some(if entry >= 0.0 { entry } else { exit }).filter(|&t| t >= 0.0)
    }
}
