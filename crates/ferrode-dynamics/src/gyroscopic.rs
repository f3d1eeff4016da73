//! The gyroscopic torque of a spinning body, linearly implicit.

use crate::body::Body;
use ferrode_math::simd::Ordered;
use ferrode_math::{Matrix3, Vec3, Vector3};

impl Body {
    /// The gyroscopic torque on the body in a step of `h` seconds; zero if that is switched off, and for bodies that are
    /// equally heavy to turn about all axes.
    pub(crate) fn gyroscopic(&self, h: f64) -> Vec3 {
        let w = self.frame.angular_velocity;
        if !self.gyroscopic_mode || self.is_kinematic() || w == Vec3::ZERO {
            return Vec3::ZERO;
        }
        let i = &self.mass.inertia.rows;
        let off_diagonal = [i[0][1], i[0][2], i[1][2]];
        if i[0][0] == i[1][1] && i[1][1] == i[2][2] && off_diagonal == [0.0; 3] {
            return Vec3::ZERO;
        }
        torque(&self.inertia_world(), w, h)
    }
}

/// Torque that makes a free body spin as ω' = (I − h [L]×)⁻¹ I ω, with L = I ω.
///
/// That is one Newton-like step of the implicit Euler equation I (ω' − ω) + h ω' × L = 0, stable for any spin
/// (C. Lacoursière, "Stabilizing gyroscopic forces in rigid multibody simulations", 2006). `inertia` is in the world
/// frame, at the start of the step.
#[inline(always)]
pub(crate) fn torque<T: Ordered>(inertia: &Matrix3<T>, w: Vector3<T>, h: T) -> Vector3<T> {
    let momentum = *inertia * w;
    let implicit = *inertia - Matrix3::cross(momentum * h);
    let determinant = implicit.determinant();
    let l = momentum * (T::ONE / h);
    let torque = *inertia * (implicit.inverse_by(determinant) * l) - l;
    // None where the matrix can't be inverted.
    let zero = determinant.le(T::ZERO) & T::ZERO.le(determinant);
    Vector3::new(
        T::select(zero, T::ZERO, torque.x),
        T::select(zero, T::ZERO, torque.y),
        T::select(zero, T::ZERO, torque.z),
    )
}
