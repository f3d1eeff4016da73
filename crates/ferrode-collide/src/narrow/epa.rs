//! Depth of two convex bodies that overlap, by the expanding polytope (van den Bergen, *Proximity queries and
//! penetration depth computation on 3D game objects*, 2001).
//!
//! A polytope within the difference {a − b} grows around the origin at its face nearest to it, until that face lies on
//! the difference's surface: its normal is the direction of least overlap. Where surfaces are curved that takes long, so
//! there a [descent](super::descent) goes on from the polytope's best normal, and the polytope has but to grow until no
//! face away from there is nearer.

use super::descent::descend;
use super::gjk::Simplex;
use super::polytope::{Face, POLYTOPE, Polytope};
use super::stationary::{Least, least_near};
use super::support::{Body, Core, Vertex, difference};
use ferrode_math::Vec3;

/// The least overlap of two cores.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Depth {
    /// Unit: moving the first body by −normal · depth separates the two.
    pub normal: Vec3,
    pub depth: f64,
    /// The points of the bodies that touch then, before that move.
    pub a: Vec3,
    pub b: Vec3,
}

/// Part of the bodies' size to which depths are found.
const TOLERANCE: f64 = 1e-9;
/// Part of the bodies' size within which the polytope must be of the surface before a descent is worth while.
const NEAR: f64 = 0.1;
/// Cosine between the normal that a descent found and those of faces at its point beyond which these count as found.
const SAME_PLACE: f64 = 0.98;
/// As that, if the surface there is flat, or curved, hardly enough to be a way out: another may be close by.
const SAME_SPOT: f64 = 0.9999;
/// Most descents.
const DESCENTS: usize = 8;

/// Completes a simplex to a tetrahedron; `None` if the difference is flat.
fn tetrahedron(a: &Body<'_>, b: &Body<'_>, simplex: &Simplex, scale: f64) -> Option<[Vertex; 4]> {
    let small = 1e-12 * scale;
    let mut v = simplex.vertices;
    let mut n = simplex.count;
    if n == 1 {
        let far = |p: &Vertex| (p.w - v[0].w).length() > small;
        let axes = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
        v[1] = axes.iter().map(|&d| difference(a, b, d)).find(far)?;
        n = 2;
    }
    if n == 2 {
        let line = (v[1].w - v[0].w).normalized()?;
        let (p, q) = ferrode_math::plane_space(line);
        let far = |x: &Vertex| (x.w - v[0].w).cross(line).length() > small;
        v[2] = [p, -p, q, -q, p + q, p - q, q - p, -p - q].iter().map(|&d| difference(a, b, d)).find(far)?;
        n = 3;
    }
    if n == 3 {
        let normal = (v[1].w - v[0].w).cross(v[2].w - v[0].w).normalized()?;
        let far = |x: &Vertex| (x.w - v[0].w).dot(normal).abs() > small;
        v[3] = [normal, -normal].iter().map(|&d| difference(a, b, d)).find(far)?;
    }
    Some(v)
}

/// The least overlap of two cores that share a point. `None` if their difference is flat, and so the overlap nil.
pub(crate) fn epa(a: &Body<'_>, b: &Body<'_>, simplex: &Simplex) -> Option<Depth> {
    let scale = a.reach() + b.reach();
    let corners = tetrahedron(a, b, simplex, scale)?;
    let by_kept = POLYTOPE.try_with(|p| match p.try_borrow_mut() {
        Ok(mut p) => expand(a, b, corners, scale, &mut p),
        // Not reached: nothing within asks for a depth again.
        Err(_) => None,
    });
    // When a thread ends, its memory goes first; what is destroyed after may still collide.
    by_kept.unwrap_or_else(|_| {
        let mut polytope = Polytope::EMPTY;
        expand(a, b, corners, scale, &mut polytope)
    })
}

/// The least overlap near the normal of a face, whose support point is `next`, if it is no more than `most`.
fn local(
    a: &Body<'_>,
    b: &Body<'_>,
    p: &Polytope,
    face: &Face,
    next: Vertex,
    scale: f64,
    most: f64,
) -> Option<Least> {
    let own = |body: &Body<'_>| matches!(body.core, Core::Custom(_));
    if own(a) || own(b) {
        return descend(a, b, face.normal, next, scale).filter(|l| l.depth <= most);
    }
    least_near(a, b, face.normal, &face.v.map(|i| p.vertex(i)), scale, most)
}

fn expand(a: &Body<'_>, b: &Body<'_>, corners: [Vertex; 4], scale: f64, p: &mut Polytope) -> Option<Depth> {
    p.start(corners);
    let tolerance = TOLERANCE * scale;
    let slack = 1e-15 * scale;
    let round = a.is_round() || b.is_round();
    let mut least: Option<Least> = None;
    let mut descents = 0;
    let mut nearest = p.nearest()?;
    let mut upper = f64::INFINITY;
    let mut result = p.face(nearest);
    loop {
        let best = p.face(nearest);
        if let Some(l) = &least
            && best.distance >= l.depth - tolerance
        {
            break;
        }
        let next = difference(a, b, best.normal);
        let reach = best.normal.dot(next.w);
        // Of all normals tried, the one along which the bodies overlap least; of equals the last, whose face touches the
        // surface and so has the points that touch.
        if reach <= upper + tolerance {
            upper = reach.min(upper);
            result = best;
        }
        if least.is_some_and(|l| reach < l.depth - tolerance) {
            // A better way out than the descent's.
            least = None;
        }
        if reach - best.distance <= tolerance {
            break;
        }
        if let Some(l) = &least
            && best.normal.dot(l.normal) > if l.firm { SAME_PLACE } else { SAME_SPOT }
            && p.has_point(nearest, l.w)
        {
            // Beside the least overlap, and no better: the surface curves away from there.
            p.close(nearest);
            match p.nearest() {
                Some(f) => nearest = f,
                None => break,
            }
            continue;
        }
        let mut added = next;
        if round && least.is_none() && descents < DESCENTS && reach - best.distance < NEAR * scale {
            descents += 1;
            if let Some(l) = local(a, b, p, &best, next, scale, upper) {
                // The point that touches, unless the nearest face does not see it.
                if best.normal.dot(l.w) > best.distance + tolerance {
                    added = Vertex { w: l.w, a: l.a, b: l.b };
                }
                upper = l.depth;
                least = Some(l);
            }
        }
        if !p.expand(nearest, added, slack) {
            break;
        }
        match p.nearest() {
            Some(f) => nearest = f,
            None => break,
        }
    }
    if least.is_none() && round {
        // The last face has the normal to the root of its distance's error.
        let at = difference(a, b, result.normal);
        least = local(a, b, p, &result, at, scale, upper + tolerance);
    }
    if let Some(l) = least {
        return Some(Depth { normal: l.normal, depth: l.depth.max(0.0), a: l.a, b: l.b });
    }
    let foot = result.normal * result.distance;
    // A flat face is several triangles: the one that has the foot of the origin knows the points that touch.
    let corner = p.at_point(result, foot, tolerance).v.map(|i| p.vertex(i));
    let [i, j, k] = corner.map(|v| v.w - foot);
    let (places, weights, n) = super::gjk::nearest_of_triangle(i, j, k);
    let (mut pa, mut pb) = (Vec3::ZERO, Vec3::ZERO);
    for m in 0..n {
        pa += corner[places[m]].a * weights[m];
        pb += corner[places[m]].b * weights[m];
    }
    Some(Depth { normal: result.normal, depth: upper.max(0.0), a: pa, b: pb })
}
