//! Vectors of three components.

use crate::Scalar;
use core::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, MulAssign, Neg, Sub, SubAssign};

/// A vector of three components.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Vector3<T> {
    /// First component.
    pub x: T,
    /// Second component.
    pub y: T,
    /// Third component.
    pub z: T,
}

impl<T: Scalar> Vector3<T> {
    /// The zero vector.
    pub const ZERO: Self = Self { x: T::ZERO, y: T::ZERO, z: T::ZERO };
    /// The unit vector along x.
    pub const X: Self = Self { x: T::ONE, y: T::ZERO, z: T::ZERO };
    /// The unit vector along y.
    pub const Y: Self = Self { x: T::ZERO, y: T::ONE, z: T::ZERO };
    /// The unit vector along z.
    pub const Z: Self = Self { x: T::ZERO, y: T::ZERO, z: T::ONE };

    /// The vector `(x, y, z)`.
    #[inline(always)]
    pub const fn new(x: T, y: T, z: T) -> Self {
        Self { x, y, z }
    }

    /// The vector with all three components `s`.
    #[inline(always)]
    pub const fn splat(s: T) -> Self {
        Self { x: s, y: s, z: s }
    }

    /// The vector of an array's components.
    #[inline(always)]
    pub const fn from_array(a: [T; 3]) -> Self {
        let [x, y, z] = a;
        Self { x, y, z }
    }

    /// The components as an array.
    #[inline(always)]
    pub const fn to_array(self) -> [T; 3] {
        [self.x, self.y, self.z]
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> T {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// Vector product `self × b`.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        Self::new(self.y * b.z - self.z * b.y, self.z * b.x - self.x * b.z, self.x * b.y - self.y * b.x)
    }

    /// Squared Euclidean length.
    #[inline(always)]
    pub fn length_squared(self) -> T {
        self.dot(self)
    }

    /// Euclidean length.
    #[inline(always)]
    pub fn length(self) -> T {
        self.dot(self).sqrt()
    }

    /// Component-wise product.
    #[inline(always)]
    pub fn component_mul(self, b: Self) -> Self {
        Self::new(self.x * b.x, self.y * b.y, self.z * b.z)
    }
}

impl Vector3<f64> {
    /// Whether no component is infinite or NaN.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }

    /// The unit vector along `self`, or `None` if `self` is zero or not finite.
    ///
    /// The vector is first divided by its largest component, so that neither tiny nor huge vectors lose their
    /// direction (ODE's `dSafeNormalize3`, without its overflow for subnormal vectors).
    pub fn normalized(self) -> Option<Self> {
        let largest = self.abs_max();
        if !self.is_finite() || largest == 0.0 {
            return None;
        }
        // Subnormal numbers have no finite reciprocal: lift them into the normal range first.
        let (v, largest) = if largest < f64::MIN_POSITIVE {
            let lift = 1.0 / f64::MIN_POSITIVE;
            (self * lift, largest * lift)
        } else {
            (self, largest)
        };
        let s = 1.0 / largest;
        let v = if s.is_finite() { v * s } else { v / largest };
        Some(v * (1.0 / v.length()))
    }

    /// The unit vector along `self`, or `fallback` if `self` is zero or not finite.
    pub fn normalized_or(self, fallback: Self) -> Self {
        self.normalized().unwrap_or(fallback)
    }

    /// Component-wise smaller of two vectors.
    #[inline]
    pub fn min(self, b: Self) -> Self {
        Self::new(self.x.min(b.x), self.y.min(b.y), self.z.min(b.z))
    }

    /// Component-wise larger of two vectors.
    #[inline]
    pub fn max(self, b: Self) -> Self {
        Self::new(self.x.max(b.x), self.y.max(b.y), self.z.max(b.z))
    }

    /// Component-wise absolute value.
    #[inline]
    pub fn abs(self) -> Self {
        Self::new(self.x.abs(), self.y.abs(), self.z.abs())
    }

    /// Largest absolute component.
    #[inline]
    pub fn abs_max(self) -> f64 {
        self.x.abs().max(self.y.abs()).max(self.z.abs())
    }

    /// Linear interpolation: `self` at `t = 0`, `b` at `t = 1`.
    #[inline]
    pub fn lerp(self, b: Self, t: f64) -> Self {
        self + (b - self) * t
    }
}

impl<T: Scalar> Add for Vector3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.y + b.y, self.z + b.z)
    }
}

impl<T: Scalar> Sub for Vector3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.y - b.y, self.z - b.z)
    }
}

impl<T: Scalar> Mul<T> for Vector3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: T) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }
}

impl Mul<Vector3<f64>> for f64 {
    type Output = Vector3<f64>;
    #[inline(always)]
    fn mul(self, v: Vector3<f64>) -> Vector3<f64> {
        v * self
    }
}

impl<T: Scalar> Div<T> for Vector3<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, s: T) -> Self {
        Self::new(self.x / s, self.y / s, self.z / s)
    }
}

impl<T: Scalar> Neg for Vector3<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<T: Scalar> AddAssign for Vector3<T> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<T: Scalar> SubAssign for Vector3<T> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl<T: Scalar> MulAssign<T> for Vector3<T> {
    #[inline(always)]
    fn mul_assign(&mut self, s: T) {
        *self = *self * s;
    }
}

impl<T> Index<usize> for Vector3<T> {
    type Output = T;
    /// Component 0, 1 or 2.
    ///
    /// # Panics
    /// If `i` is larger than 2.
    #[inline(always)]
    fn index(&self, i: usize) -> &T {
        match i {
            0 => &self.x,
            1 => &self.y,
            2 => &self.z,
            _ => panic!("a vector has components 0, 1 and 2, not {i}"),
        }
    }
}

impl<T> IndexMut<usize> for Vector3<T> {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut T {
        match i {
            0 => &mut self.x,
            1 => &mut self.y,
            2 => &mut self.z,
            _ => panic!("a vector has components 0, 1 and 2, not {i}"),
        }
    }
}

impl<T> From<[T; 3]> for Vector3<T> {
    fn from([x, y, z]: [T; 3]) -> Self {
        Self { x, y, z }
    }
}

impl<T> From<Vector3<T>> for [T; 3] {
    fn from(v: Vector3<T>) -> [T; 3] {
        [v.x, v.y, v.z]
    }
}

#[cfg(test)]
mod tests {
    use crate::Vec3;

    #[test]
    fn cross_is_right_handed() {
        assert_eq!(Vec3::X.cross(Vec3::Y), Vec3::Z);
        assert_eq!(Vec3::Y.cross(Vec3::Z), Vec3::X);
    }

    #[test]
    fn normalized_survives_extreme_lengths() {
        for scale in [1e-320, 1e-300, 1.0, 1e300] {
            let n = Vec3::new(3.0 * scale, 0.0, 4.0 * scale).normalized().unwrap();
            assert!((n - Vec3::new(0.6, 0.0, 0.8)).length() < 1e-3, "scale {scale}: {n:?}");
            assert!((n.length() - 1.0).abs() < 1e-15);
        }
        assert_eq!(Vec3::ZERO.normalized(), None);
        assert_eq!(Vec3::new(f64::NAN, 1.0, 0.0).normalized(), None);
        assert_eq!(Vec3::new(f64::INFINITY, 1.0, 0.0).normalized(), None);
    }
}
