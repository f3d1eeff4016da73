//! 3×3 matrices.

use crate::{Scalar, Vector3};
use core::ops::{Add, AddAssign, Mul, Neg, Sub};

/// A 3×3 matrix, row-major: `rows[i][j]` stands in row i, column j.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Matrix3<T> {
    /// The rows, from top to bottom.
    pub rows: [[T; 3]; 3],
}

impl<T: Scalar> Default for Matrix3<T> {
    fn default() -> Self {
        Self::ZERO
    }
}

impl<T: Scalar> Matrix3<T> {
    /// The zero matrix.
    pub const ZERO: Self = Self { rows: [[T::ZERO; 3]; 3] };
    /// The identity.
    pub const IDENTITY: Self =
        Self { rows: [[T::ONE, T::ZERO, T::ZERO], [T::ZERO, T::ONE, T::ZERO], [T::ZERO, T::ZERO, T::ONE]] };

    /// The matrix of the given rows.
    #[inline(always)]
    pub const fn from_rows(rows: [[T; 3]; 3]) -> Self {
        Self { rows }
    }

    /// The matrix of the given columns.
    #[inline(always)]
    pub fn from_columns(a: Vector3<T>, b: Vector3<T>, c: Vector3<T>) -> Self {
        Self { rows: [[a.x, b.x, c.x], [a.y, b.y, c.y], [a.z, b.z, c.z]] }
    }

    /// The matrix with `d` on the diagonal.
    #[inline(always)]
    pub fn from_diagonal(d: Vector3<T>) -> Self {
        let z = T::ZERO;
        Self { rows: [[d.x, z, z], [z, d.y, z], [z, z, d.z]] }
    }

    /// The cross matrix \[a\]×, for which `[a]× b = a × b`.
    #[inline(always)]
    pub fn cross(a: Vector3<T>) -> Self {
        let z = T::ZERO;
        Self { rows: [[z, -a.z, a.y], [a.z, z, -a.x], [-a.y, a.x, z]] }
    }

    /// The outer product a bᵀ.
    #[inline(always)]
    pub fn outer(a: Vector3<T>, b: Vector3<T>) -> Self {
        Self {
            rows: [
                [a.x * b.x, a.x * b.y, a.x * b.z],
                [a.y * b.x, a.y * b.y, a.y * b.z],
                [a.z * b.x, a.z * b.y, a.z * b.z],
            ],
        }
    }

    /// Row `i` as a vector.
    #[inline(always)]
    pub fn row(&self, i: usize) -> Vector3<T> {
        Vector3::from_array(self.rows[i])
    }

    /// Column `j` as a vector.
    #[inline(always)]
    pub fn column(&self, j: usize) -> Vector3<T> {
        Vector3::new(self.rows[0][j], self.rows[1][j], self.rows[2][j])
    }

    /// The transpose.
    #[inline(always)]
    pub fn transpose(&self) -> Self {
        let m = &self.rows;
        Self { rows: [[m[0][0], m[1][0], m[2][0]], [m[0][1], m[1][1], m[2][1]], [m[0][2], m[1][2], m[2][2]]] }
    }

    /// Product of the transpose with a vector: `selfᵀ v`.
    #[inline(always)]
    pub fn transpose_mul(&self, v: Vector3<T>) -> Vector3<T> {
        let m = &self.rows;
        Vector3::new(
            m[0][0] * v.x + m[1][0] * v.y + m[2][0] * v.z,
            m[0][1] * v.x + m[1][1] * v.y + m[2][1] * v.z,
            m[0][2] * v.x + m[1][2] * v.y + m[2][2] * v.z,
        )
    }

    /// Determinant.
    #[inline(always)]
    pub fn determinant(&self) -> T {
        let m = &self.rows;
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    }

    /// The inverse by cofactors, or `None` if the determinant is exactly zero.
    pub fn inverse(&self) -> Option<Self> {
        let det = self.determinant();
        if det == T::ZERO {
            return None;
        }
        Some(self.inverse_by(det))
    }

    /// The inverse by cofactors, given the determinant; of no use where that is zero.
    #[inline(always)]
    #[must_use]
    pub fn inverse_by(&self, determinant: T) -> Self {
        let m = &self.rows;
        let s = T::ONE / determinant;
        Self {
            rows: [
                [
                    (m[1][1] * m[2][2] - m[1][2] * m[2][1]) * s,
                    (m[0][2] * m[2][1] - m[0][1] * m[2][2]) * s,
                    (m[0][1] * m[1][2] - m[0][2] * m[1][1]) * s,
                ],
                [
                    (m[1][2] * m[2][0] - m[1][0] * m[2][2]) * s,
                    (m[0][0] * m[2][2] - m[0][2] * m[2][0]) * s,
                    (m[0][2] * m[1][0] - m[0][0] * m[1][2]) * s,
                ],
                [
                    (m[1][0] * m[2][1] - m[1][1] * m[2][0]) * s,
                    (m[0][1] * m[2][0] - m[0][0] * m[2][1]) * s,
                    (m[0][0] * m[1][1] - m[0][1] * m[1][0]) * s,
                ],
            ],
        }
    }

    /// Sum of the diagonal.
    #[inline(always)]
    pub fn trace(&self) -> T {
        self.rows[0][0] + self.rows[1][1] + self.rows[2][2]
    }
}

impl Matrix3<f64> {
    /// Whether no entry is infinite or NaN.
    pub fn is_finite(&self) -> bool {
        self.rows.iter().flatten().all(|x| x.is_finite())
    }

    /// Whether the (symmetric) matrix is positive definite, by its leading minors.
    pub fn is_positive_definite(&self) -> bool {
        let m = &self.rows;
        m[0][0] > 0.0 && m[0][0] * m[1][1] - m[0][1] * m[1][0] > 0.0 && self.determinant() > 0.0
    }
}

impl<T: Scalar> Mul<Vector3<T>> for Matrix3<T> {
    type Output = Vector3<T>;
    #[inline(always)]
    fn mul(self, v: Vector3<T>) -> Vector3<T> {
        let m = &self.rows;
        Vector3::new(
            m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
            m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
            m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z,
        )
    }
}

impl<T: Scalar> Mul for Matrix3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        let mut rows = [[T::ZERO; 3]; 3];
        for (out, a) in rows.iter_mut().zip(&self.rows) {
            for (j, o) in out.iter_mut().enumerate() {
                *o = a[0] * b.rows[0][j] + a[1] * b.rows[1][j] + a[2] * b.rows[2][j];
            }
        }
        Self { rows }
    }
}

impl<T: Scalar> Mul<T> for Matrix3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: T) -> Self {
        Self { rows: self.rows.map(|r| r.map(|x| x * s)) }
    }
}

impl<T: Scalar> Add for Matrix3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        let mut rows = self.rows;
        for (r, s) in rows.iter_mut().zip(&b.rows) {
            for (x, y) in r.iter_mut().zip(s) {
                *x += *y;
            }
        }
        Self { rows }
    }
}

impl<T: Scalar> Sub for Matrix3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        let mut rows = self.rows;
        for (r, s) in rows.iter_mut().zip(&b.rows) {
            for (x, y) in r.iter_mut().zip(s) {
                *x -= *y;
            }
        }
        Self { rows }
    }
}

impl<T: Scalar> Neg for Matrix3<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { rows: self.rows.map(|r| r.map(|x| -x)) }
    }
}

impl<T: Scalar> AddAssign for Matrix3<T> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

#[cfg(test)]
mod tests {
    use crate::{Mat3, Vec3};

    #[test]
    fn inverse_undoes_the_matrix() {
        let m = Mat3::from_rows([[4.0, 1.0, 0.5], [1.0, 3.0, 0.2], [0.5, 0.2, 2.0]]);
        let p = m * m.inverse().unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let want = if i == j { 1.0 } else { 0.0 };
                assert!((p.rows[i][j] - want).abs() < 1e-15);
            }
        }
        assert_eq!(Mat3::ZERO.inverse(), None);
    }

    #[test]
    fn cross_matrix_is_the_cross_product() {
        let (a, b) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-2.0, 0.5, 4.0));
        assert_eq!(Mat3::cross(a) * b, a.cross(b));
    }
}
