use super::{ShapeError, checked_size};
use crate::Frame;
use ferrode_math::{Aabb, Vec3};

/// A box centred at the origin, its edges along the local axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    half: Vec3,
    /// Distance of the corners from the centre.
    reach: f64,
}

impl Cuboid {
    /// A box with the given full side lengths in metres, as ODE counts them.
    pub fn new(sides: Vec3) -> Result<Self, ShapeError> {
        checked_size("box side x", sides.x)?;
        checked_size("box side y", sides.y)?;
        checked_size("box side z", sides.z)?;
        Ok(Self::with_half(sides * 0.5))
    }

    /// A box with the given half side lengths in metres.
    pub fn from_half_sides(half: Vec3) -> Result<Self, ShapeError> {
        checked_size("box half side x", half.x)?;
        checked_size("box half side y", half.y)?;
        checked_size("box half side z", half.z)?;
        Ok(Self::with_half(half))
    }

    fn with_half(half: Vec3) -> Self {
        Self { half, reach: half.length() }
    }

    /// Distance of the furthest point from the centre.
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// Full side lengths in metres.
    #[inline]
    pub fn sides(&self) -> Vec3 {
        self.half * 2.0
    }

    /// Half side lengths in metres.
    #[inline]
    pub fn half_sides(&self) -> Vec3 {
        self.half
    }

    /// Volume in cubic metres.
    pub fn volume(&self) -> f64 {
        8.0 * self.half.x * self.half.y * self.half.z
    }

    /// The world box around the shape.
    pub fn aabb(&self, frame: &Frame) -> Aabb {
        let range = |i: usize| {
            let r = frame.rotation.rows[i];
            (r[0] * self.half.x).abs() + (r[1] * self.half.y).abs() + (r[2] * self.half.z).abs()
        };
        Aabb::from_center(frame.position, Vec3::new(range(0), range(1), range(2)))
    }
}
