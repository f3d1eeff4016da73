//! Boxes turned any way, in single precision: what a ray is tested against before a shape itself is asked.

use super::probe::Line;
use crate::Frame;
use ferrode_math::Vec3;

/// A box turned any way, which holds all of a shape.
#[derive(Clone, Copy, Debug)]
pub struct TurnedBox {
    /// Where the middle of the box is, and how it is turned.
    pub frame: Frame,
    /// Half its sides, in metres.
    pub half: Vec3,
}

/// The same in single precision, with a number of its own: as large as a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeafBox {
    /// In the world, one after the other.
    pub axes: [[f32; 3]; 3],
    pub half: [f32; 3],
    pub center: [f32; 3],
    pub payload: u32,
}

impl LeafBox {
    pub fn new(payload: u32, turned: &TurnedBox) -> Self {
        let single = |v: Vec3| v.to_array().map(|x| x as f32);
        Self {
            axes: [0, 1, 2].map(|k| single(turned.frame.axis(k))),
            half: single(turned.half),
            center: single(turned.frame.position),
            payload,
        }
    }

    /// Met by every ray.
    pub fn anywhere(payload: u32) -> Self {
        Self { axes: [[0.0; 3]; 3], half: [f32::INFINITY; 3], center: [0.0; 3], payload }
    }

    /// Whether the line may meet the box. It errs on the side of meeting, by what [`Line::pad`] allows for rounding.
    ///
    /// A line misses a box if it does so as seen along it: in the projections along the line's own cross products with the axes
    /// (Gottschalk, Lin and Manocha, *OBBTree*, 1996).
    #[inline(always)]
    pub fn is_met(&self, line: &Line) -> bool {
        let (mut s, mut u) = ([0.0f32; 3], [0.0f32; 3]);
        for j in 0..3 {
            let d = line.origin[j] - self.center[j];
            for k in 0..3 {
                s[k] += self.axes[k][j] * d;
                u[k] += self.axes[k][j] * line.direction[j];
            }
        }
        let passes_by = |a: usize, b: usize| {
            let gap = (s[a] * u[b] - s[b] * u[a]).abs();
            gap > self.half[a] * u[b].abs() + self.half[b] * u[a].abs() + line.pad
        };
        !(passes_by(0, 1) | passes_by(1, 2) | passes_by(2, 0))
    }
}
