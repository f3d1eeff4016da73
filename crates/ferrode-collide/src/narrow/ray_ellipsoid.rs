use crate::{Contacts, Ellipsoid, Frame, Ray};

/// A ray and an ellipsoid: where the ray enters, or leaves if it begins inside; the normal opposes the ray.
pub fn ray_ellipsoid(ray: &Ray, fr: &Frame, ellipsoid: &Ellipsoid, fe: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let r = ellipsoid.radii();
    if r.x.min(r.y).min(r.z) <= 0.0 {
        return;
    }
    // In coordinates where the ellipsoid is the unit ball.
    let scale = |p: ferrode_math::Vec3| ferrode_math::Vec3::new(p.x / r.x, p.y / r.y, p.z / r.z);
    let (start, direction) = (scale(fe.point_to_local(o)), scale(fe.vector_to_local(u)));
    let a = direction.length_squared();
    let middle = -start.dot(direction) / a;
    let square = 1.0 - (start + direction * middle).length_squared();
    if !(square >= 0.0) {
        return;
    }
    let half = (square / a).sqrt();
    let alpha = if middle - half >= 0.0 { middle - half } else { middle + half };
    if alpha >= 0.0 && alpha <= ray.length() {
        let n = fe.vector_to_world(scale(start + direction * alpha)).normalized_or(-u);
        out.push(o + u * alpha, if n.dot(u) > 0.0 { -n } else { n }, alpha);
    }
}
