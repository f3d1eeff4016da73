use super::facet_axes::{greater, lesser};
use crate::{Contacts, Cuboid, Frame, Ray};
use ferrode_math::Vec3;

/// A ray and a box: the face where the ray enters, or leaves if it begins inside; the normal opposes the ray.
pub fn ray_cuboid(ray: &Ray, fr: &Frame, cuboid: &Cuboid, fb: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    if let Some((normal, alpha)) = first_hit(o, u, ray.length(), cuboid, fb) {
        out.push(o + u * alpha, normal, alpha);
    }
}

/// The normal and the distance of the hit of a ray from `o` along the unit vector `u`.
#[inline]
pub(crate) fn first_hit(o: Vec3, u: Vec3, length: f64, cuboid: &Cuboid, fb: &Frame) -> Option<(Vec3, f64)> {
    let (start, direction) = (fb.point_to_local(o), fb.vector_to_local(u));
    let half = cuboid.half_sides();
    // Where the line enters and leaves the slab between each two faces. No branch on what cannot be foretold.
    let mut enter = [f64::NEG_INFINITY; 3];
    let mut leave = [f64::INFINITY; 3];
    for i in 0..3 {
        let (s, d, h) = (start[i], direction[i], half[i]);
        if d == 0.0 {
            if s.abs() > h {
                return None;
            }
            continue;
        }
        let inverse = 1.0 / d;
        let (a, b) = ((-h - s) * inverse, (h - s) * inverse);
        enter[i] = lesser(a, b);
        leave[i] = greater(a, b);
    }
    let lo = greater(greater(enter[0], enter[1]), enter[2]);
    let hi = lesser(lesser(leave[0], leave[1]), leave[2]);
    let inside = !(lo >= 0.0);
    let alpha = if inside { hi } else { lo };
    ((lo <= hi) & (alpha >= 0.0) & (alpha <= length)).then(|| {
        // Of faces that it enters at once the first.
        let of = if inside { leave } else { enter };
        let axis = if alpha == of[0] {
            0
        } else if alpha == of[1] {
            1
        } else {
            2
        };
        (fb.axis(axis) * if direction[axis] > 0.0 { -1.0 } else { 1.0 }, alpha)
    })
}
