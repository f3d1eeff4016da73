//! Which of the triangles near a body are worth a closer look.

use super::facet_axes::{greater, lesser};
use crate::{Frame, TriMesh};
use ferrode_math::Vec3;

/// A box around a body, in the mesh's coordinates.
pub(super) struct Sieve<'a> {
    mesh: &'a TriMesh,
    /// Where its middle is, and its axes.
    frame: Frame,
    half: Vec3,
    /// More than rounding, in metres.
    slack: f64,
    /// Whether triangles that do not face the box's middle count too.
    both_sides: bool,
}

/// A triangle in the coordinates of the box.
pub(super) struct Sieved {
    pub normal: Vec3,
    pub corners: [Vec3; 3],
    /// Of the box's middle over the triangle's plane.
    pub height: f64,
    /// Whether the triangle meets the box, as far as the box's own axes tell.
    pub meets_box: bool,
}

impl<'a> Sieve<'a> {
    pub fn new(mesh: &'a TriMesh, frame: Frame, half: Vec3, both_sides: bool) -> Self {
        Self { mesh, frame, half, slack: 1e-9 * (half.x + half.y + half.z), both_sides }
    }

    /// Looks at triangle `i`; `None` unless it faces the middle, the box reaches its plane, and it meets the box or is beside
    /// it but perhaps over its lowest point.
    #[inline(always)]
    pub fn sift(&self, i: u32) -> Option<Sieved> {
        let at = self.frame.position;
        let normal = self.mesh.normal(i);
        let first = self.mesh.corner(i, 0) - at;
        let height = -normal.dot(first);
        if !self.both_sides && height < 0.0 {
            return None;
        }
        let n = self.frame.vector_to_local(normal);
        let steep = n.abs();
        let depth = steep.dot(self.half) + self.slack - height;
        if !(depth >= 0.0) {
            return None;
        }
        // One by one: mapping the array is a call.
        let local = |p: Vec3| self.frame.vector_to_local(p);
        let own = [local(first), local(self.mesh.corner(i, 1) - at), local(self.mesh.corner(i, 2) - at)];
        let mut widest = f64::NEG_INFINITY;
        for k in 0..3 {
            let (p, q, r) = (own[0][k], own[1][k], own[2][k]);
            let (low, high) = (lesser(lesser(p, q), r), greater(greater(p, q), r));
            let gap = greater(low - self.half[k], -high - self.half[k]);
            // The body's lowest point may be below a triangle beside the box. It is not deeper than the box is, and the gap
            // along an axis is no wider than what a move up the normal bridges.
            if gap > depth * steep[k] + self.slack {
                return None;
            }
            widest = greater(widest, gap);
        }
        Some(Sieved { normal: n, corners: own, height, meets_box: widest <= 0.0 })
    }
}
