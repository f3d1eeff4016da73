use super::manifold::Feature;
use super::support::Body;
use crate::{Contacts, Frame, Plane, Shape};
use ferrode_math::Vec3;

/// A convex shape of finite size and a half-space: the lowest point, then the other corners of the face or edge that
/// looks down, as far as they are below.
pub fn body_plane(shape: &Shape, fa: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    let n = plane.normal();
    let Some(body) = Body::of(shape, fa, fa.position) else { return };
    let level = plane.depth(fa.position);
    let depth = |p: Vec3| level - n.dot(p);
    let lowest = body.support(-n) - n * body.margin;
    let deepest = depth(lowest);
    if !(deepest >= 0.0) {
        return;
    }
    out.push(lowest + fa.position, n, deepest);
    let feature = Feature::of(&body, -n);
    let near = 1e-9 * body.reach();
    // Four corners of a disc hold it up; more would say the same.
    let step = if feature.count >= 8 { 2 } else { 1 };
    for p in feature.points[..feature.count].iter().step_by(step) {
        let d = depth(*p);
        if d >= 0.0 && (*p - lowest).length() > near {
            out.push(*p + fa.position, n, d);
        }
    }
}
