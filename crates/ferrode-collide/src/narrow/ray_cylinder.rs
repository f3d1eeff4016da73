use super::slab::Span;
use crate::{Contacts, Cylinder, Frame, Ray};
use ferrode_math::Vec3;

/// A ray and a cylinder: where the ray enters, or leaves if it begins inside; the normal opposes the ray.
pub fn ray_cylinder(ray: &Ray, fr: &Frame, cylinder: &Cylinder, fc: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let (start, direction) = (fc.point_to_local(o), fc.vector_to_local(u));
    let mut span = Span::ALL;
    span.clip_cylinder(start, direction, cylinder.radius());
    span.clip_slab(start.z, direction.z, 0.5 * cylinder.length(), Vec3::Z);
    if let Some((alpha, local)) = span.first_hit(ray.length()) {
        let n = fc.vector_to_world(local);
        out.push(o + u * alpha, if n.dot(u) > 0.0 { -n } else { n }, alpha);
    }
}
