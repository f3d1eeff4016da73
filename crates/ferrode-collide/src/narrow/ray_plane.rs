use super::facet_axes::lesser;
use crate::{Contacts, Frame, Plane, Ray};

/// A ray and a plane: the point hit, from either side, with the normal on the side of the origin.
pub fn ray_plane(ray: &Ray, fr: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let slope = plane.normal().dot(u);
    // A direction that is no unit vector is none.
    if !(slope != 0.0 && slope.abs() < 2.0) {
        return;
    }
    // Divided before anything is asked, and only one thing asked: branches cost more.
    let (depth, alpha) = (plane.depth(o), plane.depth(o) / slope);
    if lesser(alpha, ray.length() - alpha) >= 0.0 {
        let n = if depth > 0.0 { -plane.normal() } else { plane.normal() };
        out.push_sound(o + u * alpha, n, alpha);
    }
}
