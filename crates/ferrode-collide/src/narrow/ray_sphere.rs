use super::facet_axes::lesser;
use super::unit::unit_of_length;
use crate::{Contacts, Frame, Ray, Sphere};

/// A ray and a ball: the first point hit; from within, the point where the ray leaves, with the normal inward.
pub fn ray_sphere(ray: &Ray, fr: &Frame, sphere: &Sphere, fs: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let r = sphere.radius();
    let q = o - fs.position;
    let to_nearest = -q.dot(u);
    // From the ray's point nearest to the centre: far origins would lose the small difference of squares.
    let square = r * r - (q + u * to_nearest).length_squared();
    if !(square >= 0.0) {
        return;
    }
    let half_chord = square.sqrt();
    let (entry, exit) = (to_nearest - half_chord, to_nearest + half_chord);
    let alpha = if entry >= 0.0 { entry } else { exit };
    if !(lesser(alpha, ray.length() - alpha) >= 0.0) {
        return;
    }
    let outward = unit_of_length(q + u * alpha, r).unwrap_or(-u);
    // From within the other way; not by a branch, which could not be foretold.
    let side = 1f64.copysign(q.length_squared() - r * r);
    out.push_sound(o + u * alpha, outward * side, alpha);
}
