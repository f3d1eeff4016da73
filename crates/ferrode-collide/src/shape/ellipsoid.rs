use super::{ShapeError, checked_size};
use crate::Frame;
use core::f64::consts::PI;
use ferrode_math::{Aabb, Vec3};

/// The ellipsoid (x/a)² + (y/b)² + (z/c)² ≤ 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    radii: Vec3,
}

impl Ellipsoid {
    /// An ellipsoid with the given half axes in metres, along local x, y and z.
    pub fn new(radii: Vec3) -> Result<Self, ShapeError> {
        checked_size("ellipsoid radius x", radii.x)?;
        checked_size("ellipsoid radius y", radii.y)?;
        checked_size("ellipsoid radius z", radii.z)?;
        Ok(Self { radii })
    }

    /// Half axes in metres.
    #[inline]
    pub fn radii(&self) -> Vec3 {
        self.radii
    }

    /// Distance of the furthest point from the centre.
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        self.radii.x.max(self.radii.y).max(self.radii.z)
    }

    /// Volume in cubic metres.
    pub fn volume(&self) -> f64 {
        4.0 / 3.0 * PI * self.radii.x * self.radii.y * self.radii.z
    }

    /// The point furthest along `d`, in local coordinates: r² d / |r d|.
    #[inline]
    pub fn support(&self, d: Vec3) -> Vec3 {
        let scaled = self.radii.component_mul(d);
        let length = scaled.length();
        if length > 0.0 { self.radii.component_mul(scaled) * (1.0 / length) } else { Vec3::ZERO }
    }

    /// The world box around the ellipsoid.
    pub fn aabb(&self, frame: &Frame) -> Aabb {
        let range = |i: usize| Vec3::from_array(frame.rotation.rows[i]).component_mul(self.radii).length();
        Aabb::from_center(frame.position, Vec3::new(range(0), range(1), range(2)))
    }
}
