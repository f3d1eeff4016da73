//! Quaternions.

use crate::{Matrix3, Scalar, Vector3, real};
use core::ops::{Add, Mul, Neg};

/// A quaternion `w + x i + y j + z k`. A unit quaternion is the rotation from body to world coordinates.
///
/// `a * b` is Hamilton's product: the rotation b followed by a.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Quaternion<T> {
    /// Real part.
    pub w: T,
    /// First imaginary part.
    pub x: T,
    /// Second imaginary part.
    pub y: T,
    /// Third imaginary part.
    pub z: T,
}

impl<T: Scalar> Default for Quaternion<T> {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl<T: Scalar> Quaternion<T> {
    /// No rotation.
    pub const IDENTITY: Self = Self { w: T::ONE, x: T::ZERO, y: T::ZERO, z: T::ZERO };

    /// The quaternion `w + x i + y j + z k`.
    #[inline(always)]
    pub const fn new(w: T, x: T, y: T, z: T) -> Self {
        Self { w, x, y, z }
    }

    /// The quaternion of an array, real part first.
    #[inline(always)]
    pub const fn from_array(a: [T; 4]) -> Self {
        let [w, x, y, z] = a;
        Self { w, x, y, z }
    }

    /// The components, real part first.
    #[inline(always)]
    pub const fn to_array(self) -> [T; 4] {
        [self.w, self.x, self.y, self.z]
    }

    /// The quaternion with real part `w` and imaginary part `v`.
    #[inline(always)]
    pub fn from_parts(w: T, v: Vector3<T>) -> Self {
        Self { w, x: v.x, y: v.y, z: v.z }
    }

    /// The imaginary part.
    #[inline(always)]
    pub fn imaginary(self) -> Vector3<T> {
        Vector3::new(self.x, self.y, self.z)
    }

    /// The conjugate, which for a unit quaternion is the inverse.
    #[inline(always)]
    pub fn conjugate(self) -> Self {
        Self { w: self.w, x: -self.x, y: -self.y, z: -self.z }
    }

    /// Four-dimensional scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> T {
        self.w * b.w + self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// Product with every component.
    #[inline(always)]
    pub fn scale(self, s: T) -> Self {
        Self { w: self.w * s, x: self.x * s, y: self.y * s, z: self.z * s }
    }

    /// The rotation matrix of a unit quaternion (ODE manual, `dRfromQ`).
    #[inline(always)]
    pub fn to_matrix(self) -> Matrix3<T> {
        let two = T::ONE + T::ONE;
        let Self { w, x, y, z } = self;
        let (xx, yy, zz) = (two * x * x, two * y * y, two * z * z);
        Matrix3::from_rows([
            [T::ONE - yy - zz, two * (x * y - w * z), two * (x * z + w * y)],
            [two * (x * y + w * z), T::ONE - xx - zz, two * (y * z - w * x)],
            [two * (x * z - w * y), two * (y * z + w * x), T::ONE - xx - yy],
        ])
    }

    /// Time derivative of a body's orientation: ½ (0, w) q, with the angular velocity `w` in the world frame
    /// (ODE manual, `dDQfromW`).
    #[inline(always)]
    #[must_use]
    pub fn derivative(self, w: Vector3<T>) -> Self {
        (Self::from_parts(T::ZERO, w) * self).scale(T::from_f64(0.5))
    }

    /// Rotates a vector by a unit quaternion.
    #[inline(always)]
    pub fn rotate(self, v: Vector3<T>) -> Vector3<T> {
        let u = self.imaginary();
        let t = u.cross(v);
        let t = t + t;
        v + t * self.w + u.cross(t)
    }

    /// Rotates a vector by the inverse of a unit quaternion.
    #[inline(always)]
    pub fn inverse_rotate(self, v: Vector3<T>) -> Vector3<T> {
        self.conjugate().rotate(v)
    }
}

impl Quaternion<f64> {
    /// Whether no component is infinite or NaN.
    pub fn is_finite(self) -> bool {
        self.w.is_finite() && self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }

    /// The square of a length up to which squares may have lost digits: they come close to the least normal number.
    pub const LEAST_SQUARE: f64 = f64::MIN_POSITIVE / f64::EPSILON;

    /// The unit quaternion along `self`, or `None` if `self` is zero or not finite.
    pub fn normalized(self) -> Option<Self> {
        let l = self.dot(self);
        if l > Self::LEAST_SQUARE && l.is_finite() {
            return Some(self.scale(1.0 / l.sqrt()));
        }
        // The square over- or underflowed: scale first.
        let largest = self.w.abs().max(self.x.abs()).max(self.y.abs()).max(self.z.abs());
        if !self.is_finite() || largest == 0.0 {
            return None;
        }
        let q = Self::new(self.w / largest, self.x / largest, self.y / largest, self.z / largest);
        Some(q.scale(1.0 / q.dot(q).sqrt()))
    }

    /// Rotation by `angle` radians about `axis`, which need not be a unit vector; a zero axis gives the identity
    /// (ODE manual, `dQFromAxisAndAngle`).
    pub fn from_axis_angle(axis: Vector3<f64>, angle: f64) -> Self {
        match axis.normalized() {
            Some(n) => {
                let half = 0.5 * angle;
                Self::from_parts(real::cos(half), n * real::sin(half))
            }
            None => Self::IDENTITY,
        }
    }

    /// The quaternion of a rotation matrix (ODE manual, `dQfromR`). Not renormalised; its sign is not canonical.
    pub fn from_matrix(m: &Matrix3<f64>) -> Self {
        let r = &m.rows;
        let trace = m.trace();
        if trace >= 0.0 {
            let s = (trace + 1.0).sqrt();
            let k = 0.5 / s;
            return Self::new(
                0.5 * s,
                (r[2][1] - r[1][2]) * k,
                (r[0][2] - r[2][0]) * k,
                (r[1][0] - r[0][1]) * k,
            );
        }
        // The largest diagonal entry picks the imaginary part that is computed by a square root.
        let i = if r[1][1] > r[0][0] {
            if r[2][2] > r[1][1] { 2 } else { 1 }
        } else if r[2][2] > r[0][0] {
            2
        } else {
            0
        };
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let s = ((r[i][i] - (r[j][j] + r[k][k])) + 1.0).sqrt();
        let t = 0.5 / s;
        let mut v = Vector3::ZERO;
        v[i] = 0.5 * s;
        v[j] = (r[i][j] + r[j][i]) * t;
        v[k] = (r[k][i] + r[i][k]) * t;
        Self::from_parts((r[k][j] - r[j][k]) * t, v)
    }

    /// Interpolates on the shorter arc: `self` at `t = 0`, `b` at `t = 1`. Both must be unit quaternions.
    pub fn slerp(self, b: Self, t: f64) -> Self {
        let d = self.dot(b);
        let (b, d) = if d < 0.0 { (-b, -d) } else { (b, d) };
        if d > 1.0 - 1e-9 {
            let q = self.scale(1.0 - t) + b.scale(t);
            return q.normalized().unwrap_or(self);
        }
        let angle = real::acos(d);
        let s = 1.0 / real::sin(angle);
        self.scale(real::sin((1.0 - t) * angle) * s) + b.scale(real::sin(t * angle) * s)
    }
}

impl<T: Scalar> Mul for Quaternion<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self {
            w: self.w * b.w - self.x * b.x - self.y * b.y - self.z * b.z,
            x: self.w * b.x + self.x * b.w + self.y * b.z - self.z * b.y,
            y: self.w * b.y + self.y * b.w + self.z * b.x - self.x * b.z,
            z: self.w * b.z + self.z * b.w + self.x * b.y - self.y * b.x,
        }
    }
}

impl<T: Scalar> Add for Quaternion<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { w: self.w + b.w, x: self.x + b.x, y: self.y + b.y, z: self.z + b.z }
    }
}

impl<T: Scalar> Neg for Quaternion<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { w: -self.w, x: -self.x, y: -self.y, z: -self.z }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Quat, Vec3};

    #[test]
    fn normalized_survives_extreme_lengths() {
        for scale in
            [1e-320, 1e-300, 1e-170, 1e-161, 1e-160, 1e-155, 1e-149, 1e-140, 1.0, 1e150, 1e200, 1e300]
        {
            let q = Quat::new(0.0, 3.0 * scale, 0.0, 4.0 * scale).normalized().unwrap();
            assert!((q.dot(q) - 1.0).abs() < 1e-15, "scale {scale}: {q:?}");
            assert!((q.x - 0.6).abs() < 1e-3 && (q.z - 0.8).abs() < 1e-3, "scale {scale}: {q:?}");
        }
        assert_eq!(Quat::new(0.0, 0.0, 0.0, 0.0).normalized(), None);
        assert_eq!(Quat::new(f64::NAN, 1.0, 0.0, 0.0).normalized(), None);
    }

    #[test]
    fn products_match_the_recorded_ones() {
        // dynamics.md 4.2: all four sign combinations, recorded from libode 0.16.2.
        let (b, c) = (Quat::new(0.5, 0.5, 0.5, 0.5), Quat::new(0.8, 0.6, 0.0, 0.0));
        let near = |q: Quat, want: [f64; 4]| {
            for (a, b) in q.to_array().iter().zip(want) {
                assert!((a - b).abs() < 1e-15, "{q:?} {want:?}");
            }
        };
        near(b * c, [0.1, 0.7, 0.7, 0.1]);
        near(b.conjugate() * c, [0.7, -0.1, -0.7, -0.1]);
        near(b * c.conjugate(), [0.7, 0.1, 0.1, 0.7]);
        near(b.conjugate() * c.conjugate(), [0.1, -0.7, -0.1, -0.7]);
    }

    #[test]
    fn matrix_and_back_in_every_branch() {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(1.0, -2.0, 0.5)] {
            for angle in [0.0, 0.3, 2.5, 3.1, -3.1] {
                let q = Quat::from_axis_angle(axis, angle);
                let p = Quat::from_matrix(&q.to_matrix());
                assert!((p.dot(q).abs() - 1.0).abs() < 1e-14, "{axis:?} {angle}");
                let v = Vec3::new(0.3, -1.0, 2.0);
                assert!((q.rotate(v) - q.to_matrix() * v).length() < 1e-14);
            }
        }
    }
}
