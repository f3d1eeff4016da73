use super::slab::Span;
use crate::{Cone, Contacts, Frame, Ray};
use ferrode_math::Vec3;

/// A ray and a cone: where the ray enters, or leaves if it begins inside; the normal opposes the ray.
pub fn ray_cone(ray: &Ray, fr: &Frame, cone: &Cone, fc: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let (start, direction) = (fc.point_to_local(o), fc.vector_to_local(u));
    let half = 0.5 * cone.length();
    if cone.length() <= 0.0 || cone.radius() <= 0.0 {
        return;
    }
    // Inside: x² + y² ≤ k² (half − z)², between base and tip. Along the line, a t² + 2 b t + c ≤ 0.
    let k = cone.radius() / cone.length();
    let (h, dh) = (half - start.z, -direction.z);
    let a = direction.x * direction.x + direction.y * direction.y - k * k * dh * dh;
    let b = start.x * direction.x + start.y * direction.y - k * k * h * dh;
    let c = start.x * start.x + start.y * start.y - k * k * h * h;
    let mut slab = Span::ALL;
    slab.clip_slab(start.z, direction.z, half, Vec3::Z);
    let normal = |t: f64| {
        let p = start + direction * t;
        Vec3::new(p.x, p.y, k * k * (half - p.z)).normalized_or(Vec3::Z)
    };
    let within = |lo: f64, hi: f64| {
        let mut span = slab;
        if lo > span.lo {
            (span.lo, span.lo_normal) = (lo, normal(lo));
        }
        if hi < span.hi {
            (span.hi, span.hi_normal) = (hi, normal(hi));
        }
        span
    };
    let square = b * b - a * c;
    let spans = if a.abs() < 1e-14 {
        // Parallel to a line on the cone: one crossing.
        if b > 0.0 {
            [within(f64::NEG_INFINITY, -c / (2.0 * b)), Span::ALL]
        } else if b < 0.0 {
            [within(-c / (2.0 * b), f64::INFINITY), Span::ALL]
        } else {
            return;
        }
    } else if square < 0.0 {
        if a > 0.0 {
            return;
        }
        [slab, Span::ALL]
    } else {
        // The root of larger size first, the other from the product: no difference of near numbers.
        let q = if b < 0.0 { -b + square.sqrt() } else { -b - square.sqrt() };
        let (t0, t1) = if q != 0.0 { (q / a, c / q) } else { (0.0, 0.0) };
        let (lo, hi) = (t0.min(t1), t0.max(t1));
        if a > 0.0 {
            [within(lo, hi), Span::ALL]
        } else {
            // Outside the roots, on two halves of the double cone; the slab leaves one.
            [within(f64::NEG_INFINITY, lo), within(hi, f64::INFINITY)]
        }
    };
    let count = if a < -1e-14 && square >= 0.0 { 2 } else { 1 };
    let span = spans[..count].iter().find(|s| !s.is_empty());
    if let Some((alpha, local)) = span.and_then(|s| s.first_hit(ray.length())) {
        let n = fc.vector_to_world(local);
        out.push(o + u * alpha, if n.dot(u) > 0.0 { -n } else { n }, alpha);
    }
}
