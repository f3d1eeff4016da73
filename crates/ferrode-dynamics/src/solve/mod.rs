//! From rows to forces and velocities: one file per stepper.

pub(crate) mod direct;
pub(crate) mod quick;
pub(crate) mod substep;

use crate::rows::Row;
use crate::step::{JointSpan, SolverBody};
use ferrode_math::Vec3;

/// How the solution of an island ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Solved {
    /// Every row has its force.
    #[default]
    Completely,
    /// Some rows got no force.
    Partly,
}

/// What a body's velocity would change by per second and constraint-free, plus its velocity per step:
/// V/h + M⁻¹ f, the vector that J multiplies on the right-hand side.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FreeMotion {
    linear: Vec3,
    angular: Vec3,
}

impl FreeMotion {
    /// The linear part, then the angular one.
    #[inline(always)]
    pub(crate) fn to_array(self) -> [f64; 6] {
        let ([a, b, c], [d, e, f]) = (self.linear.to_array(), self.angular.to_array());
        [a, b, c, d, e, f]
    }
}

pub(crate) fn free_motions(bodies: &[SolverBody], fps: f64, out: &mut Vec<FreeMotion>) {
    out.clear();
    out.extend(bodies.iter().map(|b| FreeMotion {
        linear: b.frame.linear_velocity * fps + b.force * b.inv_mass,
        angular: b.frame.angular_velocity * fps + b.inv_inertia * b.torque,
    }));
}

/// c/h − J (V/h + M⁻¹ f) of a row.
#[inline(always)]
pub(crate) fn right_hand_side(row: &Row, span: &JointSpan, fps: f64, free: &[FreeMotion]) -> f64 {
    let mut rhs = row.c * fps;
    if let Some(f) = free.get(span.bodies[0] as usize) {
        rhs -= row.linear1.dot(f.linear) + row.angular1.dot(f.angular);
    }
    if let Some(f) = free.get(span.bodies[1] as usize) {
        rhs -= row.linear2.dot(f.linear) + row.angular2.dot(f.angular);
    }
    rhs
}

/// [`right_hand_side`] of a row that only the first body has a part in.
#[inline(always)]
pub(crate) fn right_hand_side_of_one(row: &Row, fps: f64, free: &FreeMotion) -> f64 {
    row.c * fps - (row.linear1.dot(free.linear) + row.angular1.dot(free.angular))
}
