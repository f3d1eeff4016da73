use crate::{Contacts, Cuboid, Frame, Ray};

/// A ray and a box: the face where the ray enters, or leaves if it begins inside; the normal opposes the ray.
pub fn ray_cuboid(ray: &Ray, fr: &Frame, cuboid: &Cuboid, fb: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let (start, direction) = (fb.point_to_local(o), fb.vector_to_local(u));
    let half = cuboid.half_sides();
    // The part of the line between each two faces, and the axes of those where it enters and leaves.
    let (mut lo, mut hi) = (f64::NEG_INFINITY, f64::INFINITY);
    let (mut first, mut last) = (0, 0);
    for i in 0..3 {
        let (s, d, h) = (start[i], direction[i], half[i]);
        if d == 0.0 {
            if s.abs() > h {
                return;
            }
            continue;
        }
        let inverse = 1.0 / d;
        let (a, b) = ((-h - s) * inverse, (h - s) * inverse);
        let (near, far) = if d > 0.0 { (a, b) } else { (b, a) };
        if near > lo {
            (lo, first) = (near, i);
        }
        if far < hi {
            (hi, last) = (far, i);
        }
    }
    if !(lo <= hi) {
        return;
    }
    let (alpha, axis) = if lo >= 0.0 { (lo, first) } else { (hi, last) };
    if alpha >= 0.0 && alpha <= ray.length() {
        out.push(o + u * alpha, fb.axis(axis) * if direction[axis] > 0.0 { -1.0 } else { 1.0 }, alpha);
    }
}
