use super::slab::Span;
use crate::{Contacts, Convex, Frame, Ray};

/// A ray and a polyhedron: the face where the ray enters, or leaves if it begins inside; the normal opposes the ray.
///
/// (Libode's answer is mostly wrong: it takes distances from the planes for distances along the ray.)
pub fn ray_convex(ray: &Ray, fr: &Frame, convex: &Convex, fc: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let (start, direction) = (fc.point_to_local(o), fc.vector_to_local(u));
    let mut span = Span::ALL;
    for i in 0..convex.face_count() {
        let (n, d) = convex.face_plane(i);
        span.clip_plane(n.dot(start) - d, n.dot(direction), n);
    }
    if let Some((alpha, local)) = span.first_hit(ray.length()) {
        let n = fc.vector_to_world(local);
        out.push(o + u * alpha, if n.dot(u) > 0.0 { -n } else { n }, alpha);
    }
}
