//! Axis-aligned boxes.

use crate::Vec3;

/// An axis-aligned box in world coordinates; may be unbounded. A box whose `min` exceeds its `max` is empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self { min: Vec3::splat(f64::INFINITY), max: Vec3::splat(f64::NEG_INFINITY) };
    /// All of space.
    pub const EVERYTHING: Self =
        Self { min: Vec3::splat(f64::NEG_INFINITY), max: Vec3::splat(f64::INFINITY) };

    /// The box from `min` to `max`.
    pub const fn new(min: Vec3, max: Vec3) -> Self {
        Self { min, max }
    }

    /// The box with the given centre and half side lengths.
    #[inline]
    pub fn from_center(center: Vec3, half: Vec3) -> Self {
        Self { min: center - half, max: center + half }
    }

    /// Whether the boxes share a point; touching counts.
    #[inline]
    pub fn overlaps(&self, b: &Self) -> bool {
        self.min.x <= b.max.x
            && self.max.x >= b.min.x
            && self.min.y <= b.max.y
            && self.max.y >= b.min.y
            && self.min.z <= b.max.z
            && self.max.z >= b.min.z
    }

    /// Whether `b` lies wholly within `self`.
    #[inline]
    pub fn contains(&self, b: &Self) -> bool {
        self.min.x <= b.min.x
            && self.min.y <= b.min.y
            && self.min.z <= b.min.z
            && self.max.x >= b.max.x
            && self.max.y >= b.max.y
            && self.max.z >= b.max.z
    }

    /// Whether the point lies within the box or on its surface.
    #[inline]
    pub fn contains_point(&self, p: Vec3) -> bool {
        self.contains(&Self { min: p, max: p })
    }

    /// The smallest box around both.
    #[inline]
    pub fn union(&self, b: &Self) -> Self {
        Self { min: self.min.min(b.min), max: self.max.max(b.max) }
    }

    /// The box grown by `margin` on every side.
    #[inline]
    pub fn expanded(&self, margin: f64) -> Self {
        Self { min: self.min - Vec3::splat(margin), max: self.max + Vec3::splat(margin) }
    }

    /// Centre of a bounded box.
    pub fn center(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// Side lengths.
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// Surface area of a bounded box.
    pub fn surface_area(&self) -> f64 {
        let e = self.extent();
        2.0 * (e.x * e.y + e.y * e.z + e.z * e.x)
    }

    /// Whether all six bounds are finite.
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }
}
