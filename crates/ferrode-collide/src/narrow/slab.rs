//! The part of a line that lies within a convex body, found by intersecting intervals.

use ferrode_math::Vec3;

/// An interval of the parameter along a line, with the normals of the surfaces that bound it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub lo: f64,
    pub hi: f64,
    pub lo_normal: Vec3,
    pub hi_normal: Vec3,
}

impl Span {
    /// The whole line.
    pub const ALL: Self =
        Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY, lo_normal: Vec3::ZERO, hi_normal: Vec3::ZERO };

    /// Nothing of the line.
    pub fn clear(&mut self) {
        (self.lo, self.hi) = (f64::INFINITY, f64::NEG_INFINITY);
    }

    pub fn is_empty(&self) -> bool {
        !(self.lo <= self.hi)
    }

    /// Keeps what lies below the plane: its outward normal, the signed height of the line's start above it, and the
    /// slope of the line along the normal.
    #[inline]
    pub fn clip_plane(&mut self, height: f64, slope: f64, normal: Vec3) {
        if slope == 0.0 {
            if height > 0.0 {
                self.clear();
            }
            return;
        }
        let t = -height / slope;
        if slope < 0.0 {
            if t > self.lo {
                (self.lo, self.lo_normal) = (t, normal);
            }
        } else if t < self.hi {
            (self.hi, self.hi_normal) = (t, normal);
        }
    }

    /// Keeps what lies within ±half of a coordinate.
    #[inline]
    pub fn clip_slab(&mut self, start: f64, slope: f64, half: f64, axis: Vec3) {
        self.clip_plane(start - half, slope, axis);
        self.clip_plane(-start - half, -slope, -axis);
    }

    /// Where a ray of the given length first meets the surface, and the outward normal there: the entry, or from
    /// within the exit.
    pub fn first_hit(&self, length: f64) -> Option<(f64, Vec3)> {
        if self.is_empty() {
            return None;
        }
        let (alpha, normal) =
            if self.lo >= 0.0 { (self.lo, self.lo_normal) } else { (self.hi, self.hi_normal) };
        (alpha >= 0.0 && alpha <= length).then_some((alpha, normal))
    }
}
