//! Rows: the contract between joints and solvers.
//!
//! A row is one scalar constraint. With the generalised velocity v of the two bodies it asks for
//!
//! ```text
//! J v = c − cfm λ      at the end of the step, with   lo ≤ λ ≤ hi
//! ```
//!
//! where λ is a force or torque (not an impulse) that acts on the bodies as Jᵀλ. A joint says how many rows it has and
//! writes them; it never knows the solver, and a solver never knows a joint's type.

use ferrode_math::Vec3;

/// What a row does, for solvers that treat kinds differently and for reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum RowKind {
    /// Holds a joint together.
    #[default]
    Joint,
    /// Stops a joint at the end of its range.
    Limit,
    /// Drives a joint.
    Motor,
    /// Keeps two bodies from penetrating.
    Normal,
    /// Friction along the first tangent.
    Tangent1,
    /// Friction along the second tangent.
    Tangent2,
    /// Rolling or spinning friction.
    Roll,
}

/// No other row's force scales the bounds of this one.
pub const NO_FRICTION_INDEX: i32 = -1;

/// One scalar constraint between two bodies, or a body and the world.
#[derive(Clone, Copy, Debug, PartialEq)]
// The Jacobian's twelve numbers one after the other.
#[repr(C)]
pub struct Row {
    /// Jacobian of the first body's linear velocity.
    pub linear1: Vec3,
    /// Jacobian of the first body's angular velocity (world frame).
    pub angular1: Vec3,
    /// Jacobian of the second body's linear velocity; zero without a second body.
    pub linear2: Vec3,
    /// Jacobian of the second body's angular velocity; zero without a second body.
    pub angular2: Vec3,
    /// Wanted velocity J v after the step, position correction included (ODE's c).
    pub c: f64,
    /// Constraint force mixing: velocity given way per unit of force.
    pub cfm: f64,
    /// Smallest force.
    pub lo: f64,
    /// Largest force.
    pub hi: f64,
    /// The row, counted from the joint's first, whose force scales this row's bounds to ±|hi λ|; or
    /// [`NO_FRICTION_INDEX`].
    pub friction_index: i32,
    /// What the row does.
    pub kind: RowKind,
    /// The row's stable number within its joint: absent rows keep theirs.
    pub slot: u8,
    /// Position error that `c` corrects, in metres or radians, with the sign of the correction; 0 if none.
    pub position_error: f64,
    /// The part of `c` that is a wanted velocity (motors, surface motion).
    pub velocity_target: f64,
    /// The part of `c` that restitution asks for.
    pub restitution_target: f64,
}

impl Row {
    /// A row before its joint fills it: no Jacobian, no bounds, the world's `cfm`.
    #[inline]
    pub fn blank(cfm: f64) -> Self {
        Self {
            linear1: Vec3::ZERO,
            angular1: Vec3::ZERO,
            linear2: Vec3::ZERO,
            angular2: Vec3::ZERO,
            c: 0.0,
            cfm,
            lo: f64::NEG_INFINITY,
            hi: f64::INFINITY,
            friction_index: NO_FRICTION_INDEX,
            kind: RowKind::Joint,
            slot: 0,
            position_error: 0.0,
            velocity_target: 0.0,
            restitution_target: 0.0,
        }
    }

    /// Sets the Jacobian.
    #[inline]
    pub(crate) fn set_jacobian(&mut self, linear1: Vec3, angular1: Vec3, linear2: Vec3, angular2: Vec3) {
        self.linear1 = linear1;
        self.angular1 = angular1;
        self.linear2 = linear2;
        self.angular2 = angular2;
    }

    /// Makes this a row about the world axis `a` that compares angular velocities.
    #[inline]
    pub(crate) fn set_angular(&mut self, a: Vec3, two_bodies: bool) {
        self.angular1 = a;
        if two_bodies {
            self.angular2 = -a;
        }
    }

    /// Corrects a position error with the factor `k` = fps · ERP.
    #[inline]
    pub(crate) fn correct(&mut self, k: f64, error: f64) {
        self.c = k * error;
        self.position_error = error;
    }
}

/// How many rows a joint has in this step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RowCount {
    /// All rows.
    pub rows: usize,
    /// Those without bounds, as far as the type tells: decides the order of rows in `Direct`.
    pub unbounded: usize,
}

impl RowCount {
    pub const fn new(rows: usize, unbounded: usize) -> Self {
        Self { rows, unbounded }
    }
}

/// A force and a torque (about the centre of mass), in the world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Wrench {
    pub force: Vec3,
    pub torque: Vec3,
}

/// The rows of one joint, to be filled, and the forces that it may add to its bodies meanwhile.
pub(crate) struct JointRows<'a> {
    /// As many as the joint announced, each blank.
    pub rows: &'a mut [Row],
    /// Forces on the joint's first and second body, that enter the right-hand side of this very step.
    pub forces: [Wrench; 2],
}
