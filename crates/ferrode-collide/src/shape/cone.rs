use super::{ShapeError, checked_size};
use crate::Frame;
use core::f64::consts::PI;
use ferrode_math::{Aabb, Vec3};

/// A cone about the local z axis: base at −length/2, tip at +length/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    radius: f64,
    length: f64,
    /// Distance of the furthest point from the centre.
    reach: f64,
}

impl Cone {
    /// A cone with the given radius of the base and height in metres.
    pub fn new(radius: f64, length: f64) -> Result<Self, ShapeError> {
        let radius = checked_size("cone radius", radius)?;
        let length = checked_size("cone length", length)?;
        let reach = (radius * radius + 0.25 * length * length).sqrt();
        Ok(Self { radius, length, reach })
    }

    /// Radius of the base in metres.
    #[inline]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Height in metres.
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
        PI / 3.0 * self.radius * self.radius * self.length
    }

    /// The world box around the cone: that of the base and the tip.
    pub fn aabb(&self, frame: &Frame) -> Aabb {
        let u = frame.axis(2);
        let (tip, base) =
            (frame.position + u * (0.5 * self.length), frame.position - u * (0.5 * self.length));
        let range = |c: f64| self.radius * (1.0 - c * c).max(0.0).sqrt();
        let disc = Aabb::from_center(base, Vec3::new(range(u.x), range(u.y), range(u.z)));
        disc.union(&Aabb::new(tip, tip))
    }
}
