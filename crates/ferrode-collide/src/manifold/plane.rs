//! A convex body and a half-space: the corners that are below it, or nearly.

use super::Touching;
use super::convex::feature;
use super::patch::{Patch, Spot};
use crate::narrow::support::{Body, Core};
use crate::{Frame, Plane, Shape};
use ferrode_math::Vec3;

/// Corners of a box by their bits, half sides positive where a bit is set.
fn corner(h: Vec3, i: u32) -> Vec3 {
    let sign = |bit: u32, x: f64| if i >> bit & 1 == 1 { x } else { -x };
    Vec3::new(sign(0, h.x), sign(1, h.y), sign(2, h.z))
}

/// The manifold of a convex shape of finite size and a plane, in the shape's coordinates.
pub(super) fn body_plane(
    shape: &Shape,
    frame: &Frame,
    plane: &Plane,
    margin: f64,
    patch: &mut Patch,
) -> Touching {
    let Some(body) = Body::of(shape, &Frame::IDENTITY, Vec3::ZERO) else {
        return Touching::Apart(f64::INFINITY);
    };
    let n = frame.vector_to_local(plane.normal());
    // Height of the shape's origin over the plane.
    let level = -plane.depth(frame.position);
    let lowest = body.support(-n) - n * body.margin;
    let depth = -(level + n.dot(lowest));
    if depth < -margin {
        return Touching::Apart(-depth - margin);
    }
    patch.normal = n;
    patch.world = *frame;
    // The plane's own coordinates are the world's.
    patch.frames = (
        Frame::IDENTITY,
        Frame::new(-frame.rotation.transpose_mul(frame.position), frame.rotation.transpose()),
    );
    let mut push = |p: Vec3, feature: u32| {
        let depth = -(level + n.dot(p));
        if depth >= -margin {
            patch.push(Spot { a: p, b: p + n * depth, depth, feature });
        }
    };
    match body.core {
        Core::Cuboid(h) => (0..8).for_each(|i| push(corner(h, i), i)),
        Core::Hull(hull) => {
            for (i, p) in hull.points().iter().enumerate() {
                push(*p, i as u32);
            }
        }
        Core::Segment(half) => {
            for (z, i) in [(half, 0), (-half, 1)] {
                push(Vec3::Z * z - n * body.margin, i);
            }
        }
        Core::Cylinder(..) | Core::Cone(..) => {
            let f = feature(&body, -n);
            for (i, p) in f.points[..f.count].iter().enumerate() {
                push(*p, f.number << 4 | i as u32);
            }
            // The rim between two corners of the disc, or the side.
            if patch.depth() < depth - 1e-3 * body.reach() {
                patch.push(Spot { a: lowest, b: lowest + n * depth, depth, feature: 1 << 16 });
            }
        }
        Core::Point | Core::Ellipsoid(_) | Core::Triangle(_) | Core::Custom(_) => push(lowest, 0),
    }
    if patch.spots().is_empty() {
        patch.push(Spot { a: lowest, b: lowest + n * depth, depth, feature: 1 << 17 });
    }
    Touching::Yes
}
