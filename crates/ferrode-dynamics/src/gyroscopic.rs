//! The gyroscopic torque of a spinning body, linearly implicit.

use ferrode_math::{Mat3, Vec3};

/// Torque that makes a free body spin as ω' = (I − h [L]×)⁻¹ I ω, with L = I ω.
///
/// That is one Newton-like step of the implicit Euler equation I (ω' − ω) + h ω' × L = 0, stable for any spin
/// (C. Lacoursière, "Stabilizing gyroscopic forces in rigid multibody simulations", 2006). `inertia` is in the world
/// frame, at the start of the step.
pub(crate) fn torque(inertia: &Mat3, w: Vec3, h: f64) -> Vec3 {
    let momentum = *inertia * w;
    let implicit = *inertia - Mat3::cross(momentum * h);
    match implicit.inverse() {
        Some(inverse) => {
            let l = momentum * (1.0 / h);
            *inertia * (inverse * l) - l
        }
        None => Vec3::ZERO,
    }
}
