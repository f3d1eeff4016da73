use super::{ShapeError, checked_size};
use crate::Frame;
use core::f64::consts::PI;
use ferrode_math::{Aabb, Vec3};

/// All points within `radius` of a segment on the local z axis, centred at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    radius: f64,
    length: f64,
}

impl Capsule {
    /// A capsule whose cylindrical part has the given length; with its ends it measures `length + 2 radius`.
    pub fn new(radius: f64, length: f64) -> Result<Self, ShapeError> {
        Ok(Self {
            radius: checked_size("capsule radius", radius)?,
            length: checked_size("capsule length", length)?,
        })
    }

    /// Radius in metres.
    #[inline]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Length of the cylindrical part in metres.
    #[inline]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Distance of the furthest point from the centre.
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        0.5 * self.length + self.radius
    }

    /// Volume in cubic metres.
    pub fn volume(&self) -> f64 {
        PI * self.radius * self.radius * (self.length + 4.0 / 3.0 * self.radius)
    }

    /// The ends of the axis segment in the world: the one at +z, then the one at −z.
    #[inline]
    pub fn segment(&self, frame: &Frame) -> (Vec3, Vec3) {
        let half = frame.axis(2) * (0.5 * self.length);
        (frame.position + half, frame.position - half)
    }

    /// The world box around the capsule.
    pub fn aabb(&self, frame: &Frame) -> Aabb {
        Aabb::from_center(
            frame.position,
            frame.axis(2).abs() * (0.5 * self.length) + Vec3::splat(self.radius),
        )
    }
}
