//! Damping of velocities after each step (ODE manual, "Damping").

use ferrode_math::Vec3;

/// Damping of a body: above its threshold, a speed is multiplied by 1 − scale after every step.
///
/// The scale is per step, not per second. It acts after the body has moved and after its moved callback.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damping {
    /// Part of the linear velocity taken away per step; 0 for none.
    pub linear_scale: f64,
    /// Part of the angular velocity taken away per step; 0 for none.
    pub angular_scale: f64,
    /// Speed in m/s that is not damped.
    pub linear_threshold: f64,
    /// Speed in rad/s that is not damped.
    pub angular_threshold: f64,
}

impl Default for Damping {
    fn default() -> Self {
        Self { linear_scale: 0.0, angular_scale: 0.0, linear_threshold: 0.01, angular_threshold: 0.01 }
    }
}

impl Damping {
    pub(crate) fn apply(&self, linear_velocity: &mut Vec3, angular_velocity: &mut Vec3) {
        damp(linear_velocity, self.linear_scale, self.linear_threshold);
        damp(angular_velocity, self.angular_scale, self.angular_threshold);
    }
}

fn damp(velocity: &mut Vec3, scale: f64, threshold: f64) {
    if scale != 0.0 && velocity.length_squared() > threshold * threshold {
        *velocity *= 1.0 - scale;
    }
}
