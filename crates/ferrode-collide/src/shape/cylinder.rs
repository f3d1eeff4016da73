use super::{ShapeError, checked_size};
use crate::Frame;
use core::f64::consts::PI;
use ferrode_math::{Aabb, Vec3};

/// A cylinder with flat ends along the local z axis, centred at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    radius: f64,
    length: f64,
    /// Distance of the furthest point from the centre.
    reach: f64,
}

impl Cylinder {
    /// A cylinder of the given radius and length in metres.
    pub fn new(radius: f64, length: f64) -> Result<Self, ShapeError> {
        let radius = checked_size("cylinder radius", radius)?;
        let length = checked_size("cylinder length", length)?;
        let reach = (radius * radius + 0.25 * length * length).sqrt();
        Ok(Self { radius, length, reach })
    }

    /// Radius in metres.
    #[inline]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Length in metres.
    #[inline]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Distance of the furthest point from the centre.
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// Volume in cubic metres.
    pub fn volume(&self) -> f64 {
        PI * self.radius * self.radius * self.length
    }

    /// The world box around the cylinder: on each axis half the length's share plus the disc's.
    pub fn aabb(&self, frame: &Frame) -> Aabb {
        let range = |u: f64| (u * 0.5 * self.length).abs() + self.radius * (1.0 - u * u).max(0.0).sqrt();
        let u = frame.axis(2);
        Aabb::from_center(frame.position, Vec3::new(range(u.x), range(u.y), range(u.z)))
    }
}
