use super::{ShapeError, checked_size};
use crate::Frame;
use ferrode_math::{Aabb, Vec3};

/// A ball around the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    radius: f64,
}

impl Sphere {
    /// A ball of the given radius in metres.
    pub fn new(radius: f64) -> Result<Self, ShapeError> {
        Ok(Self { radius: checked_size("sphere radius", radius)? })
    }

    /// Radius in metres.
    #[inline]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Distance of the furthest point from the centre.
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        self.radius
    }

    /// Volume in cubic metres.
    pub fn volume(&self) -> f64 {
        4.0 / 3.0 * core::f64::consts::PI * self.radius * self.radius * self.radius
    }

    /// The world box around the ball.
    pub fn aabb(&self, frame: &Frame) -> Aabb {
        Aabb::from_center(frame.position, Vec3::splat(self.radius))
    }
}
