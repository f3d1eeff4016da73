use super::bodies::in_first_frame;
use super::convex::touch;
use super::manifold::add_manifold;
use super::support::Body;
use crate::{Contacts, Cylinder, Frame};
use core::f64::consts::TAU;
use ferrode_math::{Vec3, real};

/// How near the cosine of the axes must be to ±1 for discs to lie on each other.
const ALIGNED: f64 = 1e-3;

/// Two cylinders.
///
/// Discs on each other with the smaller within the larger touch at points spread evenly on the smaller rim, as in
/// libode. All else: the axis of least overlap, and a face or side clipped to the other.
pub fn cylinder_cylinder(a: &Cylinder, fa: &Frame, b: &Cylinder, fb: &Frame, out: &mut Contacts<'_>) {
    if out.options().unimportant || !nested_discs(a, fa, b, fb, out) {
        in_first_frame(fa, fb, out, |fa, fb, out| {
            let body_a = Body::cylinder(a, fa, Vec3::ZERO);
            let body_b = Body::cylinder(b, fb, Vec3::ZERO);
            if let Some(t) = touch(&body_a, &body_b) {
                add_manifold(&body_a, &body_b, &t, Vec3::ZERO, out);
            }
        });
    }
}

/// Contacts of aligned cylinders one upon the other, if the rim of one lies within the other. False if that is not the
/// case.
fn nested_discs(a: &Cylinder, fa: &Frame, b: &Cylinder, fb: &Frame, out: &mut Contacts<'_>) -> bool {
    let (ua, ub) = (fa.axis(2), fb.axis(2));
    let cosine = ua.dot(ub);
    if 1.0 - cosine.abs() >= ALIGNED {
        return false;
    }
    // The smaller cylinder stands on the larger one's disc.
    let a_small = a.radius() <= b.radius();
    let (small, fs, large, fl) = if a_small { (a, fa, b, fb) } else { (b, fb, a, fa) };
    let up = fl.axis(2);
    let between = fs.position - fl.position;
    let height = up.dot(between);
    let lateral = (between - up * height).length();
    let halves = 0.5 * (small.length() + large.length());
    let vertical = halves - height.abs() + small.radius() * (1.0 - cosine * cosine).max(0.0).sqrt();
    if vertical < 0.0 || vertical >= small.radius() + large.radius() - lateral {
        return false;
    }
    if lateral + small.radius() > large.radius() {
        return false;
    }
    let up = if height < 0.0 { -up } else { up };
    let n = if a_small { up } else { -up };
    let us = fs.axis(2);
    let disc = fs.position + us * if us.dot(up) > 0.0 { -0.5 * small.length() } else { 0.5 * small.length() };
    let count = out.capacity().min(8);
    for i in 0..count {
        let angle = TAU * i as f64 / count as f64;
        let p = disc
            + fs.axis(0) * (small.radius() * real::cos(angle))
            + fs.axis(1) * (small.radius() * real::sin(angle));
        let depth = 0.5 * large.length() - up.dot(p - fl.position);
        if depth >= 0.0 {
            out.push(p, n, depth);
        }
    }
    !out.is_empty()
}
