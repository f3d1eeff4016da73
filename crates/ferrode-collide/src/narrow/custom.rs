//! Distances and casts of shapes of one's own that are not convex.

use super::cast::{CastHit, linear};
use super::distance::{Distance, distance_frames};
use crate::{Custom, Frame, Shape, Sphere};
use ferrode_math::Vec3;

/// What a shape of one's own says of its distance from another, or the other of it; the distance of a ball by the depth of
/// its centre. `None` if neither is one's own, and for convex ones that leave the question to their support functions.
pub(super) fn own_distance((sa, fa): (&Shape, &Frame), (sb, fb): (&Shape, &Frame)) -> Option<Distance> {
    let told = |s: &Shape, fs: &Frame, t: &Shape, ft: &Frame| match s {
        Shape::Custom(own) => own.get().distance(fs, t, ft),
        _ => None,
    };
    told(sa, fa, sb, fb).or_else(|| told(sb, fb, sa, fa).map(Distance::swapped)).or_else(|| match (sa, sb) {
        (Shape::Custom(own), Shape::Sphere(ball)) => ball_distance(own, fa, ball, fb.position),
        (Shape::Sphere(ball), Shape::Custom(own)) => {
            ball_distance(own, fb, ball, fa.position).map(Distance::swapped)
        }
        _ => None,
    })
}

/// The distance from a ball: the depth of its centre, and the direction in which that changes.
fn ball_distance(own: &Custom, frame: &Frame, ball: &Sphere, center: Vec3) -> Option<Distance> {
    let own = own.get();
    if own.support(Vec3::X).is_some() {
        return None;
    }
    let away = |p: Vec3| own.point_depth(frame, p).map(|d| -d);
    let distance = away(center)?;
    // Differences over so much that neither rounding nor bends show.
    let h = 1e-5 * (distance.abs() + ball.radius()) + 1e-7 * (1.0 + center.abs_max());
    let slope = |at: Vec3, d: Vec3| Some(away(at + d * h)? - away(at - d * h)?);
    let outward = Vec3::new(slope(center, Vec3::X)?, slope(center, Vec3::Y)?, slope(center, Vec3::Z)?);
    // As near to one side as to another: any will do.
    let outward = outward.normalized_or(Vec3::Z);
    Some(Distance {
        distance: distance - ball.radius(),
        a: center - outward * distance,
        b: center - outward * ball.radius(),
        normal: -outward,
    })
}

/// Whether a pair is to be cast by its distances: one of the two is one's own and not convex.
pub(super) fn is_marched(a: &Shape, b: &Shape) -> bool {
    [a, b].iter().any(|s| matches!(s, Shape::Custom(own) if own.get().support(Vec3::X).is_none()))
}

/// Looks before a path that grazes is given up.
const LOOKS: usize = 1000;

/// Goes as far along the path as the distance at each place lets it (sphere tracing: Hart, *Sphere Tracing*, 1996): right for
/// any shapes, if slow where the path grazes.
pub(super) fn march(a: (&Shape, &Frame), path: Vec3, b: (&Shape, &Frame)) -> Option<CastHit> {
    let length = path.length();
    let close = 1e-7 * length;
    let mut fraction = 0.0;
    for _ in 0..LOOKS {
        let here = Frame::new(a.1.position + path * fraction, a.1.rotation);
        let d = distance_frames((a.0, &here), b)?;
        if d.distance <= close {
            if fraction == 0.0 && d.distance <= 0.0 {
                return linear(d.distance, d.b, d.normal, path);
            }
            // So close, the surfaces are flat.
            if let Some(mut hit) = linear(d.distance.max(0.0), d.b, d.normal, path) {
                (hit.fraction, hit.depth) = (hit.fraction + fraction, 0.0);
                return (hit.fraction <= 1.0).then_some(hit);
            }
        }
        fraction += d.distance.max(close) / length;
        if !(fraction <= 1.0) {
            return None;
        }
    }
    None
}
