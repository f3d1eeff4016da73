//! From velocities to poses: semi-implicit Euler, with the new velocities.

use crate::body::{Body, FiniteRotation};
use ferrode_math::{Quat, Vec3, real};

/// Moves a body by `h` seconds at its present velocity: speed limit, position, rotation.
pub(crate) fn advance_pose(body: &mut Body, h: f64) {
    limit_angular_speed(body);
    let mode = body.finite_rotation();
    let frame = &mut body.frame;
    frame.position += frame.linear_velocity * h;
    let q = rotate(frame.quaternion, frame.angular_velocity, h, mode);
    // A quaternion that can't be normalised leaves the pose non-finite; the quarantine catches that.
    frame.quaternion = q.normalized().unwrap_or(q);
    frame.rotation = frame.quaternion.to_matrix();
    body.pose_version = body.pose_version.wrapping_add(1);
}

/// Moves a body and turns it about its centre of mass, both in the world frame, without a change of its velocity.
pub(crate) fn displace(body: &mut Body, linear: Vec3, angular: Vec3) {
    let frame = &mut body.frame;
    frame.position += linear;
    let q = finite_part(angular, angular.length(), 1.0) * frame.quaternion;
    frame.quaternion = q.normalized().unwrap_or(q);
    frame.rotation = frame.quaternion.to_matrix();
}

/// Slows a body down that spins faster than it may.
pub(crate) fn limit_angular_speed(body: &mut Body) {
    let limit = body.max_angular_speed;
    if limit < f64::INFINITY {
        let speed_squared = body.frame.angular_velocity.length_squared();
        if speed_squared > limit * limit {
            body.frame.angular_velocity *= limit / speed_squared.sqrt();
        }
    }
}

/// The quaternion after rotating with the angular velocity `w` for `h` seconds, not normalised (ODE manual,
/// `dBodySetFiniteRotationMode`).
fn rotate(q: Quat, w: Vec3, h: f64, mode: FiniteRotation) -> Quat {
    match mode {
        FiniteRotation::Off => q + q.derivative(w).scale(h),
        FiniteRotation::Full => finite_part(w, w.length(), h) * q,
        FiniteRotation::Axis { axis, full_rate } => {
            let rate = axis.dot(w);
            let along = axis * rate;
            let turned = finite_part(along, rate, h) * q;
            // ODE halves the step twice here, so the part across the axis turns at half its rate.
            let across = if full_rate { h } else { 0.5 * h };
            turned + turned.derivative(w - along).scale(across)
        }
    }
}

/// The rotation about the vector `w` by `rate · h`, where `rate` is ±|w|.
fn finite_part(w: Vec3, rate: f64, h: f64) -> Quat {
    let half = 0.5 * h;
    let theta = rate * half;
    Quat::from_parts(real::cos(theta), w * (real::sinc(theta) * half))
}
