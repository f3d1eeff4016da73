//! Nearest points of lines, segments and boxes.

use crate::{Cuboid, Frame};
use ferrode_math::Vec3;

/// Parameters of the nearest points of two lines pa + α ua, pb + β ub with unit directions.
///
/// Lines within a hundredth of a radian of parallel get (0, 0), as in ODE's edge contacts.
pub fn closest_line_points(pa: Vec3, ua: Vec3, pb: Vec3, ub: Vec3) -> (f64, f64) {
    let p = pb - pa;
    let c = ua.dot(ub);
    let (qa, qb) = (ua.dot(p), -ub.dot(p));
    let d = 1.0 - c * c;
    if d <= 1e-4 {
        return (0.0, 0.0);
    }
    ((qa + c * qb) / d, (c * qa + qb) / d)
}

/// Nearest points of the segments a1 a2 and b1 b2, on each its own (ODE's `dClosestLineSegmentPoints`).
///
/// Corners are tried first, then a corner against the inside of the other segment, then both insides; of several
/// nearest pairs (parallel segments) it is one that has an end point. Segments may be points.
pub fn closest_segment_points(a1: Vec3, a2: Vec3, b1: Vec3, b2: Vec3) -> (Vec3, Vec3) {
    let a = a2 - a1;
    let b = b2 - b1;
    let a1b1 = b1 - a1;
    let a1b2 = b2 - a1;
    let a2b1 = b1 - a2;
    let a2b2 = b2 - a2;
    // A pair of corners is nearest if each lies beyond the other's end (Voronoi regions of the corners).
    let (da11, db11) = (a.dot(a1b1), b.dot(a1b1));
    if da11 <= 0.0 && db11 >= 0.0 {
        return (a1, b1);
    }
    let (da12, db12) = (a.dot(a1b2), b.dot(a1b2));
    if da12 <= 0.0 && db12 <= 0.0 {
        return (a1, b2);
    }
    let (da21, db21) = (a.dot(a2b1), b.dot(a2b1));
    if da21 >= 0.0 && db21 >= 0.0 {
        return (a2, b1);
    }
    let (da22, db22) = (a.dot(a2b2), b.dot(a2b2));
    if da22 >= 0.0 && db22 <= 0.0 {
        return (a2, b2);
    }
    let la = a.length_squared();
    let lb = b.length_squared();
    // A corner of b over the inside of a: the corner must also lie beyond its own end as seen from its foot.
    let onto_a = |corner: Vec3, t: f64, outward: Vec3| {
        let foot = a1 + a * t;
        (outward.dot(foot - corner) >= 0.0).then_some((foot, corner))
    };
    if la > 0.0 {
        if da11 >= 0.0
            && da21 <= 0.0
            && let Some(hit) = onto_a(b1, da11 / la, -b)
        {
            return hit;
        }
        if da12 >= 0.0
            && da22 <= 0.0
            && let Some(hit) = onto_a(b2, da12 / la, b)
        {
            return hit;
        }
    }
    let onto_b = |corner: Vec3, t: f64, outward: Vec3| {
        let foot = b1 + b * t;
        (outward.dot(foot - corner) >= 0.0).then_some((corner, foot))
    };
    if lb > 0.0 {
        if db11 <= 0.0
            && db12 >= 0.0
            && let Some(hit) = onto_b(a1, -db11 / lb, -a)
        {
            return hit;
        }
        if db21 <= 0.0
            && db22 >= 0.0
            && let Some(hit) = onto_b(a2, -db21 / lb, a)
        {
            return hit;
        }
    }
    let ab = a.dot(b);
    let det = la * lb - ab * ab;
    let (s, t) = ((lb * da11 - ab * db11) / det, (ab * da11 - la * db11) / det);
    if det > 1e-14 * la * lb && (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
        return (a1 + a * s, b1 + b * t);
    }
    // Parallel up to rounding, which may fail every test above: the best of the corners and their feet. (ODE answers
    // a1, b1, which need not be near.)
    let foot = |corner: Vec3, start: Vec3, along: Vec3, square: f64| {
        let t = if square > 0.0 { (along.dot(corner - start) / square).clamp(0.0, 1.0) } else { 0.0 };
        start + along * t
    };
    let pairs = [
        (a1, foot(a1, b1, b, lb)),
        (a2, foot(a2, b1, b, lb)),
        (foot(b1, a1, a, la), b1),
        (foot(b2, a1, a, la), b2),
    ];
    let mut best = pairs[0];
    for pair in &pairs[1..] {
        if (pair.0 - pair.1).length_squared() < (best.0 - best.1).length_squared() {
            best = *pair;
        }
    }
    best
}

/// Nearest points of the segment p1 p2 and a box: first on the segment, then in or on the box.
///
/// Half the derivative of the squared distance along the segment is piecewise linear and does not fall; the point
/// sought is where it first reaches zero, found by walking over the crossings of the box's face planes. Where the
/// segment runs alongside the box that is the nearest point next to p1; inside, both points coincide.
pub fn closest_segment_cuboid(p1: Vec3, p2: Vec3, cuboid: &Cuboid, fb: &Frame) -> (Vec3, Vec3) {
    let half = cuboid.half_sides();
    let s = fb.point_to_local(p1);
    let v = fb.vector_to_local(p2 - p1);
    // Half the derivative of the squared distance from s + t v to the box.
    let derivative = |t: f64| {
        let mut d = 0.0;
        for i in 0..3 {
            let x = s[i] + t * v[i];
            let beyond = if x > half[i] {
                x - half[i]
            } else if x < -half[i] {
                x + half[i]
            } else {
                0.0
            };
            d += v[i] * beyond;
        }
        d
    };
    let mut t = 0.0;
    let at_start = derivative(0.0);
    if at_start < 0.0 {
        t = 1.0;
        let at_end = derivative(1.0);
        if at_end >= 0.0 {
            // Between two places where the segment passes a face's plane it is linear: narrowed down to these.
            let (mut left, mut slope_left) = (0.0, at_start);
            let (mut right, mut slope_right) = (1.0, at_end);
            for i in 0..3 {
                if v[i].abs() > 1e-307 {
                    for side in [-half[i], half[i]] {
                        let at = (side - s[i]) / v[i];
                        if at > left && at < right {
                            let slope = derivative(at);
                            if slope >= 0.0 {
                                (right, slope_right) = (at, slope);
                            } else {
                                (left, slope_left) = (at, slope);
                            }
                        }
                    }
                }
            }
            t = if slope_right > slope_left {
                left - slope_left * (right - left) / (slope_right - slope_left)
            } else {
                right
            };
        }
    }
    let on_segment = p1 + (p2 - p1) * t;
    let local = s + v * t;
    let clamped = local.max(-half).min(half);
    if clamped == local {
        return (on_segment, on_segment);
    }
    (on_segment, fb.point_to_world(clamped))
}
