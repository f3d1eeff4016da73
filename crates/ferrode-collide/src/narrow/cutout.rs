//! What planes leave of a convex polygon: as [`polygon`](super::polygon), whose order of corners is that of ODE, but for many
//! triangles.

use ferrode_math::Vec3;

/// Most corners that a polygon keeps.
const MOST: usize = 20;

/// A convex polygon of few corners, or a segment or point, and what is left of it. Corners stay in their order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cutout {
    /// The corners, and room for those left by the next cut.
    points: [[Vec3; MOST]; 2],
    now: bool,
    count: usize,
}

impl Cutout {
    /// The polygon with the given corners, the first twenty of them.
    // Where it stays: it is not small.
    #[inline(always)]
    pub fn new(corners: &[Vec3]) -> Self {
        let mut cutout = Self { points: [[Vec3::ZERO; MOST]; 2], now: false, count: 0 };
        for (to, from) in cutout.points[0].iter_mut().zip(corners) {
            *to = *from;
        }
        cutout.count = corners.len().min(MOST);
        cutout
    }

    /// The corners.
    #[inline]
    pub fn corners(&self) -> &[Vec3] {
        &self.points[usize::from(self.now)][..self.count]
    }

    /// Keeps what lies at or above the plane n · x + d = 0.
    pub fn clip(&mut self, n: Vec3, d: f64) {
        let count = self.count.min(MOST);
        let [first, second] = &mut self.points;
        let (old, new) = if self.now { (second, first) } else { (first, second) };
        let mut height = [0.0; MOST];
        let mut below = 0;
        for i in 0..count {
            height[i] = n.dot(old[i]) + d;
            below += usize::from(!(height[i] >= 0.0));
        }
        // Most planes cut nothing off, or all.
        if below == 0 {
            return;
        }
        self.count = 0;
        if below == count {
            return;
        }
        let mut kept = 0;
        let mut keep = |p: Vec3| {
            if kept < MOST {
                new[kept] = p;
                kept += 1;
            }
        };
        // A segment is walked once, a polygon round.
        let sides = if count <= 2 { count - 1 } else { count };
        for i in 0..count {
            let (p, hp) = (old[i], height[i]);
            if hp >= 0.0 {
                keep(p);
            }
            let j = if i + 1 == count { 0 } else { i + 1 };
            let (q, hq) = (old[j], height[j]);
            if i < sides && ((hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0)) {
                keep(p + (q - p) * (hp / (hp - hq)));
            }
        }
        self.count = kept;
        self.now = !self.now;
    }

    /// Keeps what lies at or below the plane n · x = level.
    #[inline]
    pub fn keep_below(&mut self, n: Vec3, level: f64) {
        self.clip(-n, level);
    }
}
