//! A body over the middle of a triangle: the common case, without iteration.

use super::convex::Touch;
use super::support::Body;
use super::triangle::Facet;
use super::unit::unit;
use ferrode_math::Vec3;

/// The contact of a body with a triangle that it leaves soonest straight up. `None` if that is not certain.
///
/// The difference of body and triangle contains the prism between two copies of the triangle, one about the body's lowest
/// point and one about its middle. If the origin is no nearer to another face of the prism than to the lower one, which
/// is on the difference's surface, then that one is the way out.
///
/// `core` is the core's lowest point.
pub(super) fn over_face(body: &Body<'_>, middle: Vec3, facet: &Facet, core: Vec3) -> Option<Touch> {
    let n = facet.normal;
    // Of the core below the plane.
    let depth = -facet.height(core);
    let spine = middle - core;
    let above = n.dot(spine) - depth;
    if !(above >= depth && above > 0.0) {
        return None;
    }
    let inside = |out: Vec3, e: usize, p: Vec3| out.dot(facet.corners[e] - p);
    let side = |e: usize| facet.corners[(e + 1) % 3] - facet.corners[e];
    let certain = if depth > 0.0 {
        // Where the line from the middle to the lowest point crosses the plane; walls at least as far as the way out.
        let across = spine * (1.0 / (above + depth));
        let foot = core + across * depth;
        (0..3).all(|e| {
            let wall = side(e).cross(across);
            let far = inside(wall, e, foot);
            far > 0.0 && far * far >= depth * depth * wall.length_squared()
        })
    } else {
        // The core is above: its lowest point is the nearest if it is over the triangle.
        (0..3).all(|e| inside(side(e).cross(n), e, core) >= 0.0)
    };
    if !certain {
        return None;
    }
    let n = unit(n)?;
    let lowest = core - n * body.margin;
    Some(Touch { normal: n, depth: depth + body.margin, a: lowest, b: core + n * depth })
}
