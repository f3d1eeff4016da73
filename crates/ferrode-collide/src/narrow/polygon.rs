//! Clipping of convex polygons by planes.

use ferrode_math::Vec3;

/// Most corners that a polygon keeps.
const MOST: usize = 16;

/// A convex polygon of few corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polygon {
    points: [Vec3; MOST],
    count: usize,
}

impl Polygon {
    /// The polygon with the given corners, the first sixteen of them.
    pub fn new(corners: &[Vec3]) -> Self {
        let mut polygon = Self { points: [Vec3::ZERO; MOST], count: 0 };
        corners.iter().for_each(|&p| polygon.push(p));
        polygon
    }

    /// The corners.
    pub fn corners(&self) -> &[Vec3] {
        &self.points[..self.count]
    }

    fn push(&mut self, p: Vec3) {
        if self.count < MOST {
            self.points[self.count] = p;
            self.count += 1;
        }
    }

    /// Keeps what lies at or above the plane n · x + d = 0.
    pub fn clip(&mut self, n: Vec3, d: f64) {
        let mut kept = Self::new(&[]);
        for i in 0..self.count {
            let (p, q) = (self.points[(i + self.count - 1) % self.count], self.points[i]);
            let (hp, hq) = (n.dot(p) + d, n.dot(q) + d);
            if hp >= 0.0 {
                kept.push(p);
            }
            if (hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0) {
                kept.push(p - (p - q) * (hp / (hp - hq)));
            }
        }
        *self = kept;
    }
}
