use super::slab::Span;
use crate::{Contacts, Cuboid, Frame, Ray};
use ferrode_math::Vec3;

/// A ray and a box: the face where the ray enters, or leaves if it begins inside; the normal opposes the ray.
pub fn ray_cuboid(ray: &Ray, fr: &Frame, cuboid: &Cuboid, fb: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let (start, direction) = (fb.point_to_local(o), fb.vector_to_local(u));
    let half = cuboid.half_sides();
    let mut span = Span::ALL;
    for i in 0..3 {
        let mut axis = Vec3::ZERO;
        axis[i] = 1.0;
        span.clip_slab(start[i], direction[i], half[i], axis);
    }
    if let Some((alpha, local)) = span.first_hit(ray.length()) {
        let n = fb.vector_to_world(local);
        out.push(o + u * alpha, if n.dot(u) > 0.0 { -n } else { n }, alpha);
    }
}
