//! The triangles of two meshes that may cross.

use crate::{Frame, TriMesh};
use ferrode_math::{Aabb, Vec3};

/// Calls `found` with each triangle of `a` and triangle of `b` of which neither is to one side of the other's plane, and
/// whose boxes overlap. `local` is where `b` is in a's coordinates.
pub(super) fn triangle_pairs(a: &TriMesh, b: &TriMesh, local: &Frame, mut found: impl FnMut(u32, u32)) {
    // The larger triangles one by one, each with the tree of the other mesh: of these the box of that mesh leaves few.
    let size = |m: &TriMesh| m.bounds().extent().length_squared() / m.triangles().len() as f64;
    if size(a) > size(b) {
        larger(a, b, local, found);
    } else {
        let rotation = local.rotation.transpose();
        let inverse = Frame::new(-(rotation * local.position), rotation);
        larger(b, a, &inverse, |j, i| found(i, j));
    }
}

/// `local` is where `inner` is in the coordinates of `outer`.
#[inline]
fn larger(outer: &TriMesh, inner: &TriMesh, local: &Frame, mut found: impl FnMut(u32, u32)) {
    // Boxes either way: one mesh may be large and thin.
    let inverse = Frame::new(-local.vector_to_local(local.position), local.rotation.transpose());
    if !outer.aabb(&inverse).overlaps(inner.bounds()) {
        return;
    }
    outer.tree().query(&inner.aabb(local), |i| {
        let n = local.vector_to_local(outer.normal(i));
        if n == Vec3::ZERO {
            return;
        }
        let p = outer.corners(i).map(|p| local.point_to_local(p));
        let around = Aabb::new(p[0].min(p[1]).min(p[2]), p[0].max(p[1]).max(p[2]));
        if !around.overlaps(inner.bounds()) {
            return;
        }
        // As far as rounding lets heights be wrong.
        let slack =
            1e-12 * (p[0].abs_max() + p[1].abs_max() + p[2].abs_max() + inner.bounds().extent().abs_max());
        let (level, box_of_all) = (n.dot(p[0]), inner.bounds());
        let (centre, half) = (box_of_all.center(), box_of_all.extent() * 0.5);
        if (n.dot(centre) - level).abs() > n.abs().dot(half) + slack {
            return;
        }
        inner.tree().query(&around, |j| {
            let q = inner.corners(j);
            if !astride(q.map(|x| n.dot(x) - level), slack) {
                return;
            }
            let m = inner.normal(j);
            if m != Vec3::ZERO && astride(p.map(|x| m.dot(x - q[0])), slack) {
                found(i, j);
            }
        });
    });
}

/// Whether heights are not all on one side of zero.
#[inline(always)]
fn astride(h: [f64; 3], slack: f64) -> bool {
    !((h[0] > slack && h[1] > slack && h[2] > slack) || (h[0] < -slack && h[1] < -slack && h[2] < -slack))
}
