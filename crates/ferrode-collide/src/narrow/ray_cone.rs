use super::slab::Span;
use crate::{Cone, Contacts, Frame, Ray};
use ferrode_math::Vec3;

/// Cones that are so many times as wide as high are discs: rounding of where they are met is of the size of their height.
const FLAT: f64 = 1e12;

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
    if k > FLAT {
        if let Some((alpha, normal)) = ray_disc(start, direction, cone.radius(), ray.length()) {
            out.push(o + u * alpha, fc.vector_to_world(normal), alpha);
        }
        return;
    }
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
    // b² − a c, without the difference of near numbers that this is for flat cones.
    let across = start.x * direction.y - start.y * direction.x;
    let (mx, my) = (dh * start.x - h * direction.x, dh * start.y - h * direction.y);
    let square = k * k * (mx * mx + my * my) - across * across;
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

/// A ray and a disc about the origin in the plane of x and y: how far along the ray, and the normal that opposes it.
fn ray_disc(start: Vec3, direction: Vec3, radius: f64, length: f64) -> Option<(f64, Vec3)> {
    if direction.z == 0.0 {
        return None;
    }
    let t = -start.z / direction.z;
    let p = start + direction * t;
    let hits = (0.0..=length).contains(&t) && p.x * p.x + p.y * p.y <= radius * radius;
    hits.then_some((t, if direction.z > 0.0 { -Vec3::Z } else { Vec3::Z }))
}

#[cfg(test)]
mod tests {
    use super::ray_cone;
    use crate::{CollideOptions, Cone, Contacts, Frame, Ray};
    use ferrode_math::{Pose, Quat, Vec3, real};

    /// Where a ray from a point in a direction hits a cone at the origin.
    fn hit(cone: &Cone, from: Vec3, direction: Vec3) -> Option<f64> {
        let ray = Ray::new(10.0).unwrap();
        let axis = Vec3::Z.cross(direction);
        let turn =
            Quat::from_axis_angle(axis.normalized_or(Vec3::X), real::atan2(axis.length(), direction.z));
        let (fr, fc) = (Frame::from(&Pose::new(from, turn)), Frame::from(&Pose::IDENTITY));
        let mut list = Vec::new();
        ray_cone(&ray, &fr, cone, &fc, &mut Contacts::new(&mut list, CollideOptions::default()));
        list.first().map(|c| c.point.depth)
    }

    #[test]
    fn a_cone_without_height_is_a_disc() {
        for length in [1e-3, 1e-9, 1e-60, 1e-140, 5e-198, 1e-300] {
            let cone = Cone::new(1.5, length).unwrap();
            let down = hit(&cone, Vec3::new(0.2, 0.3, 2.0), -Vec3::Z).unwrap();
            assert!((down - 2.0).abs() <= length + 1e-15, "{length}: {down}");
            let slant = Vec3::new(1.0, 0.0, -1.0).normalized_or(Vec3::Z);
            assert!(hit(&cone, Vec3::new(-1.5, 0.0, 2.0), slant).is_some(), "{length}");
            assert_eq!(hit(&cone, Vec3::new(-4.5, -0.7, 2.0), slant), None, "{length}");
            // In its plane, beside it.
            let beside = Vec3::new(-4.5, -0.7, 0.0);
            assert_eq!(hit(&cone, beside, Vec3::new(0.0, 0.6, 0.8)), None, "{length}");
        }
    }
}
