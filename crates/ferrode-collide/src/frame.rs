//! A pose with its rotation as a matrix.

use ferrode_math::{Mat3, Pose, Vec3};

/// Where a shape is: position and rotation matrix, whose columns are the local axes in the world.
///
/// The narrow phase reads axes by the dozen, so it works on this rather than on a quaternion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// World position of the local origin, in metres.
    pub position: Vec3,
    /// Rotation from local to world coordinates.
    pub rotation: Mat3,
}

impl Frame {
    /// The frame of the world.
    pub const IDENTITY: Self = Self { position: Vec3::ZERO, rotation: Mat3::IDENTITY };

    /// A frame at `position` with the given rotation matrix.
    #[inline]
    pub const fn new(position: Vec3, rotation: Mat3) -> Self {
        Self { position, rotation }
    }

    /// Local axis `i` (0, 1, 2) in the world.
    #[inline(always)]
    pub fn axis(&self, i: usize) -> Vec3 {
        self.rotation.column(i)
    }

    /// A point from local to world coordinates.
    #[inline(always)]
    pub fn point_to_world(&self, p: Vec3) -> Vec3 {
        self.position + self.rotation * p
    }

    /// A point from world to local coordinates.
    #[inline(always)]
    pub fn point_to_local(&self, p: Vec3) -> Vec3 {
        self.rotation.transpose_mul(p - self.position)
    }

    /// A direction from local to world coordinates.
    #[inline(always)]
    pub fn vector_to_world(&self, v: Vec3) -> Vec3 {
        self.rotation * v
    }

    /// A direction from world to local coordinates.
    #[inline(always)]
    pub fn vector_to_local(&self, v: Vec3) -> Vec3 {
        self.rotation.transpose_mul(v)
    }
}

impl Default for Frame {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl From<&Pose> for Frame {
    #[inline]
    fn from(pose: &Pose) -> Self {
        Self { position: pose.position, rotation: pose.rotation.to_matrix() }
    }
}
