//! The nearest points of a segment, or a point, and a curved body, to the last bits.
//!
//! GJK's simplex tells the distance of curved bodies to rounding, but the points only to its root. Along a segment the
//! distance to a convex body is convex: its slope, from the point's projection to the body, has one zero.

use super::support::{Body, Core};
use ferrode_math::Vec3;

const ITERATIONS: usize = 80;

/// The nearest points of two cores, if one is a point or segment, the other a cylinder, cone or ellipsoid, and they are
/// apart.
pub(super) fn line_gap(a: &Body<'_>, b: &Body<'_>) -> Option<(Vec3, Vec3)> {
    match (&a.core, &b.core) {
        (Core::Point | Core::Segment(_), Core::Cylinder(..) | Core::Cone(..) | Core::Ellipsoid(_)) => {
            gap(a, b)
        }
        (Core::Cylinder(..) | Core::Cone(..) | Core::Ellipsoid(_), Core::Point | Core::Segment(_)) => {
            gap(b, a).map(|(pb, pa)| (pa, pb))
        }
        _ => None,
    }
}

fn gap(line: &Body<'_>, body: &Body<'_>) -> Option<(Vec3, Vec3)> {
    let half = if let Core::Segment(half) = line.core { half } else { 0.0 };
    // In the body's own coordinates.
    let center = body.rotation.transpose_mul(line.center - body.center);
    let u = body.rotation.transpose_mul(line.axis(2));
    let at = |t: f64| center + u * t;
    let slope = |t: f64| -> Option<f64> { Some(u.dot(at(t) - nearest(&body.core, at(t))?)) };
    let t = if half > 0.0 { zero(slope, half)? } else { 0.0 };
    let (p, q) = (at(t), nearest(&body.core, at(t))?);
    let scale = line.reach() + body.reach() + center.length();
    ((p - q).length() > 1e-9 * scale).then(|| (body.place(p), body.place(q)))
}

/// Where a function that does not fall changes its sign between −half and half, or the end that is nearer to it.
///
/// False position, halving the value of an end that stays (the Illinois rule), and the interval if that is slow.
fn zero(f: impl Fn(f64) -> Option<f64>, half: f64) -> Option<f64> {
    let (mut lo, mut hi) = (-half, half);
    let (mut f_lo, mut f_hi) = (f(lo)?, f(hi)?);
    if f_lo >= 0.0 {
        return Some(lo);
    }
    if f_hi <= 0.0 {
        return Some(hi);
    }
    let mut last = 0;
    for i in 0..ITERATIONS {
        let width = hi - lo;
        let cut = lo + width * (f_lo / (f_lo - f_hi));
        let t = if i % 3 == 2 || !(cut > lo && cut < hi) { lo + 0.5 * width } else { cut };
        if !(t > lo && t < hi) {
            break;
        }
        let value = f(t)?;
        if value == 0.0 {
            return Some(t);
        }
        if value < 0.0 {
            (lo, f_lo) = (t, value);
            if last == -1 {
                f_hi *= 0.5;
            }
            last = -1;
        } else {
            (hi, f_hi) = (t, value);
            if last == 1 {
                f_lo *= 0.5;
            }
            last = 1;
        }
    }
    Some(0.5 * (lo + hi))
}

/// The point of a core, in its own coordinates, nearest to a place; the place itself if that is within.
fn nearest(core: &Core<'_>, p: Vec3) -> Option<Vec3> {
    let around = (p.x * p.x + p.y * p.y).sqrt();
    match *core {
        Core::Cylinder(radius, half) => {
            let share = if around > radius { radius / around } else { 1.0 };
            Some(Vec3::new(p.x * share, p.y * share, p.z.clamp(-half, half)))
        }
        Core::Cone(radius, half) => {
            let (r, z) = if p.z <= -half {
                (around.min(radius), -half)
            } else {
                // Along the side, from the rim to the apex.
                let (dr, dz) = (-radius, 2.0 * half);
                if (around - radius) * dz - (p.z + half) * dr <= 0.0 {
                    return Some(p);
                }
                let square = dr * dr + dz * dz;
                let s = (((around - radius) * dr + (p.z + half) * dz) / square).clamp(0.0, 1.0);
                (radius + s * dr, -half + s * dz)
            };
            let share = if around > 0.0 { r / around } else { 0.0 };
            Some(Vec3::new(p.x * share, p.y * share, z))
        }
        Core::Ellipsoid(e) => {
            let e = e.radii();
            if !(e.x > 0.0 && e.y > 0.0 && e.z > 0.0) {
                return None;
            }
            let squares = e.component_mul(e);
            // The nearest point is e² p / (e² + s), on the ellipsoid.
            let on = |s: f64| {
                let d = squares + Vec3::splat(s);
                Vec3::new(p.x * squares.x / d.x, p.y * squares.y / d.y, p.z * squares.z / d.z)
            };
            let excess = |q: Vec3| {
                let r = Vec3::new(q.x / e.x, q.y / e.y, q.z / e.z);
                (r, r.length_squared() - 1.0)
            };
            if excess(p).1 <= 0.0 {
                return Some(p);
            }
            // Newton from below: the excess falls with s, ever slower.
            let least = |i: usize| e[i] * p[i].abs() - squares[i];
            let mut s = least(0).max(least(1)).max(least(2)).max(0.0);
            for _ in 0..ITERATIONS {
                let (r, over) = excess(on(s));
                let d = squares + Vec3::splat(s);
                let fall = 2.0 * (r.x * r.x / d.x + r.y * r.y / d.y + r.z * r.z / d.z);
                let next = s + over / fall;
                if !(over > 0.0 && next > s) {
                    break;
                }
                s = next;
            }
            Some(on(s))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Capsule, Cone, Cylinder, Ellipsoid, Frame, Shape};
    use ferrode_math::{Pose, Quat};
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..Default::default() })]

        /// Each point is the support of its core towards the other, and the line between them parts the cores.
        #[test]
        fn nearest_points_see_each_other(
            p in prop::array::uniform3(-2.0..2.0f64), q in prop::array::uniform4(-1.0..1.0f64), l in 0.0..2.0f64,
            s in prop::array::uniform3(0.2..1.0f64), which in 0..3usize,
        ) {
            let capsule = Capsule::new(0.1, l).unwrap();
            let turn = Quat::from_array(q).normalized().unwrap_or(Quat::IDENTITY);
            let at = Frame::from(&Pose::new(Vec3::from_array(p), turn));
            let shape: Shape = match which {
                0 => Cylinder::new(s[0], 2.0 * s[1]).unwrap().into(),
                1 => Cone::new(s[0], 2.0 * s[1]).unwrap().into(),
                _ => Ellipsoid::new(Vec3::from_array(s)).unwrap().into(),
            };
            let a = Body::capsule(&capsule, &at, Vec3::ZERO);
            let b = Body::of(&shape, &Frame::IDENTITY, Vec3::ZERO).unwrap();
            if let Some((x, y)) = line_gap(&a, &b) {
                let n = (x - y).normalized().unwrap();
                prop_assert!(n.dot(a.support(-n) - x).abs() < 1e-12, "{x:?} {y:?}");
                prop_assert!(n.dot(b.support(n) - y).abs() < 1e-12, "{x:?} {y:?}");
                // The other way round.
                prop_assert_eq!(line_gap(&b, &a), Some((y, x)));
            }
        }
    }
}
