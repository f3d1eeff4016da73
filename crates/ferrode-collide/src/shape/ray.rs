use super::{ShapeError, checked_size};
use crate::Frame;
use ferrode_math::{Aabb, Pose, Quat, Vec3, rotation};

/// A ray from the origin of its pose along local +z.
///
/// Its contacts are hits, not overlaps: `position` is the point hit, `depth` the distance along the ray, `normal` the
/// surface's, turned against the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    length: f64,
    /// Against a mesh: stop at whatever hit is found first. One record.
    pub first_contact: bool,
    /// Against a mesh: pass through triangles seen from behind.
    pub backface_cull: bool,
    /// Against a mesh: report the nearest hit alone.
    pub closest_hit: bool,
}

impl Ray {
    /// A ray of the given length in metres, all options off.
    pub fn new(length: f64) -> Result<Self, ShapeError> {
        Ok(Self {
            length: checked_size("ray length", length)?,
            first_contact: false,
            backface_cull: false,
            closest_hit: false,
        })
    }

    /// Of no length yet, all options off.
    pub(crate) const UNMEASURED: Self =
        Self { length: 0.0, first_contact: false, backface_cull: false, closest_hit: false };

    /// Another length in metres; the options stay.
    #[inline]
    pub(crate) fn set_length(&mut self, length: f64) -> Result<(), ShapeError> {
        self.length = checked_size("ray length", length)?;
        Ok(())
    }

    /// Length in metres.
    #[inline]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The pose of a ray from `origin` along `direction` (of any length but zero). `None` if that is zero or not
    /// finite.
    pub fn pose(origin: Vec3, direction: Vec3) -> Option<Pose> {
        let m = rotation::from_z_axis(direction)?;
        Some(Pose::new(origin, Quat::from_matrix(&m)))
    }

    /// Origin and unit direction in the world.
    #[inline]
    pub fn line(&self, frame: &Frame) -> (Vec3, Vec3) {
        (frame.position, frame.axis(2))
    }

    /// The world box around the ray.
    pub fn aabb(&self, frame: &Frame) -> Aabb {
        let (a, u) = self.line(frame);
        let b = a + u * self.length;
        Aabb::new(a.min(b), a.max(b))
    }
}
