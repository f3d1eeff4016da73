use super::slab::Span;
use crate::{Capsule, Contacts, Frame, Ray};
use ferrode_math::Vec3;

/// A ray and a capsule: where the ray enters, or leaves if it begins inside, with the normal then inward.
///
/// A capsule is the union of two balls and a cylinder; being convex it meets a line in one interval, from the least
/// entry to the greatest exit of the three.
pub fn ray_capsule(ray: &Ray, fr: &Frame, capsule: &Capsule, fc: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let (start, direction) = (fc.point_to_local(o), fc.vector_to_local(u));
    let (r, half) = (capsule.radius(), 0.5 * capsule.length());
    let mut body = Span::ALL;
    body.clip_cylinder(start, direction, r);
    body.clip_slab(start.z, direction.z, half, Vec3::Z);
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    if !body.is_empty() {
        (lo, hi) = (body.lo, body.hi);
    }
    for end in [half, -half] {
        let q = start - Vec3::new(0.0, 0.0, end);
        let nearest = -q.dot(direction);
        let square = r * r - (q + direction * nearest).length_squared();
        if square >= 0.0 {
            lo = lo.min(nearest - square.sqrt());
            hi = hi.max(nearest + square.sqrt());
        }
    }
    let span = Span { lo, hi, ..Span::ALL };
    if let Some((alpha, _)) = span.first_hit(ray.length()) {
        let from_axis = |p: Vec3| p - Vec3::new(0.0, 0.0, p.z.clamp(-half, half));
        let outward = fc.vector_to_world(from_axis(start + direction * alpha).normalized_or(-direction));
        let inside = from_axis(start).length_squared() < r * r;
        out.push(o + u * alpha, if inside { -outward } else { outward }, alpha);
    }
}
