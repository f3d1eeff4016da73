use crate::{Contacts, Frame, Plane, Ray};

/// A ray and a plane: the point hit, from either side, with the normal on the side of the origin.
pub fn ray_plane(ray: &Ray, fr: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let slope = plane.normal().dot(u);
    if slope == 0.0 {
        return;
    }
    let depth = plane.depth(o);
    // Before the division: most miss.
    if (depth < 0.0) != (slope < 0.0) && depth != 0.0
        || depth.abs() > ray.length() * slope.abs() * (1.0 + 1e-9)
    {
        return;
    }
    let alpha = depth / slope;
    if alpha >= 0.0 && alpha <= ray.length() {
        let n = if depth > 0.0 { -plane.normal() } else { plane.normal() };
        out.push(o + u * alpha, n, alpha);
    }
}
