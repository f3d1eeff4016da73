//! Rigid transforms.

use crate::{Quaternion, Scalar, Vector3};
use core::ops::Mul;

/// A rigid transform: rotation, then translation. As the pose of a body it takes body coordinates to world
/// coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Transform<T> {
    /// Position of the origin.
    pub position: Vector3<T>,
    /// Unit quaternion of the rotation.
    pub rotation: Quaternion<T>,
}

impl<T: Scalar> Default for Transform<T> {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl<T: Scalar> Transform<T> {
    /// The transform that changes nothing.
    pub const IDENTITY: Self = Self { position: Vector3::ZERO, rotation: Quaternion::IDENTITY };

    /// The transform with the given position and unit quaternion.
    #[inline(always)]
    pub const fn new(position: Vector3<T>, rotation: Quaternion<T>) -> Self {
        Self { position, rotation }
    }

    /// A pure translation.
    #[inline(always)]
    pub const fn from_position(position: Vector3<T>) -> Self {
        Self { position, rotation: Quaternion::IDENTITY }
    }

    /// A point from local to world coordinates.
    #[inline(always)]
    pub fn transform_point(&self, p: Vector3<T>) -> Vector3<T> {
        self.position + self.rotation.rotate(p)
    }

    /// A point from world to local coordinates.
    #[inline(always)]
    pub fn inverse_transform_point(&self, p: Vector3<T>) -> Vector3<T> {
        self.rotation.inverse_rotate(p - self.position)
    }

    /// A direction from local to world coordinates.
    #[inline(always)]
    pub fn transform_vector(&self, v: Vector3<T>) -> Vector3<T> {
        self.rotation.rotate(v)
    }

    /// A direction from world to local coordinates.
    #[inline(always)]
    pub fn inverse_transform_vector(&self, v: Vector3<T>) -> Vector3<T> {
        self.rotation.inverse_rotate(v)
    }

    /// The inverse transform.
    #[inline(always)]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self { position: -rotation.rotate(self.position), rotation }
    }
}

impl Transform<f64> {
    /// Whether no component is infinite or NaN.
    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.rotation.is_finite()
    }

    /// Interpolates position linearly and rotation on the shorter arc; `self` at `t = 0`, `b` at `t = 1`.
    pub fn interpolate(&self, b: &Self, t: f64) -> Self {
        Self { position: self.position.lerp(b.position, t), rotation: self.rotation.slerp(b.rotation, t) }
    }
}

impl<T: Scalar> Mul for Transform<T> {
    type Output = Self;
    /// `a * b` applies b first: with a the pose of a parent and b a pose in the parent, the pose in the world.
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self { position: self.transform_point(b.position), rotation: self.rotation * b.rotation }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Pose, Quat, Vec3};

    #[test]
    fn inverse_undoes_the_transform() {
        let t = Pose::new(Vec3::new(1.0, -2.0, 0.3), Quat::from_axis_angle(Vec3::new(1.0, 1.0, 0.2), 1.1));
        let p = Vec3::new(0.2, 5.0, -1.0);
        assert!((t.inverse().transform_point(t.transform_point(p)) - p).length() < 1e-14);
        assert!((t.inverse_transform_point(t.transform_point(p)) - p).length() < 1e-14);
        let i = t * t.inverse();
        assert!(i.position.length() < 1e-14 && (i.rotation.w.abs() - 1.0).abs() < 1e-14);
    }
}
