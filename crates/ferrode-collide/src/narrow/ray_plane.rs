use super::facet_axes::lesser;
use crate::{Contacts, Frame, Plane, Ray};

/// A ray and a plane: the point hit, from either side, with the normal on the side of the origin.
pub fn ray_plane(ray: &Ray, fr: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let slope = plane.normal().dot(u);
    // Divided before anything is asked, and little asked: branches that cannot be foretold cost more. Along the plane the
    // quotient is infinite, or no number. A direction that is no unit vector is none.
    let (depth, alpha) = (plane.depth(o), plane.depth(o) / slope);
    if lesser(alpha, ray.length() - alpha) >= 0.0 && slope.abs() < 2.0 {
        // From below the other way.
        let side = 1f64.copysign(0.0 - depth);
        out.push_sound(o + u * alpha, plane.normal() * side, alpha);
    }
}
