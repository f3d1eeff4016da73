//! What the rows of common joints are made of, so that a solver can carry them along as the bodies move.
//!
//! Balls and hinges make up nearly all chains, ragdolls and robots. Between substeps their rows change by the motion of the bodies
//! alone: arms and axes turn with them, and errors change by their displacements. All vectors are in the world frame at the
//! start of a step; errors are differences of close points and directions, small whatever the distance from the origin.

use crate::ends::{Ends, StepContext};
use ferrode_math::Vec3;

/// A ball or hinge at the start of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried {
    /// From each body's centre to its anchor.
    pub arms: [Vec3; 2],
    /// From the first body's anchor to the second's.
    pub gap: Vec3,
    /// Constraint force mixing of the rows that hold the joint together.
    pub cfm: f64,
    /// Of a hinge.
    pub hinge: Option<CarriedHinge>,
}

/// The rows of a hinge about its axis and across it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CarriedHinge {
    /// The axis, fixed in the first body.
    pub axis: Vec3,
    /// The second body's axis less the first's.
    pub slip: Vec3,
    /// Unit vectors across the axis, fixed in the first body.
    pub across: [Vec3; 2],
    /// What acts about the axis.
    pub drive: Drive,
}

/// What acts about or along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Drive {
    /// Nothing.
    Free,
    /// A motor.
    Motor {
        /// Wanted velocity.
        velocity: f64,
        /// Largest force.
        force: f64,
        /// Constraint force mixing.
        cfm: f64,
    },
    /// The nearer of the stops, that does not bounce.
    Stop {
        /// How far the axis is inside it; negative beyond.
        room: f64,
        /// Whether it is the upper one.
        upper: bool,
        /// Constraint force mixing.
        cfm: f64,
    },
}

impl Carried {
    /// What holds two anchors together, given by their arms.
    pub fn anchors(ends: &Ends<'_>, arms: [Vec3; 2], cfm: f64) -> Self {
        let gap = (ends.b().position + arms[1]) - (ends.a().position + arms[0]);
        Self { arms, gap, cfm, hinge: None }
    }
}

/// Whether a row of this CFM is a spring of its own rather than as soft as the world's constraints.
pub(crate) fn is_spring(cfm: f64, ctx: &StepContext) -> bool {
    cfm > ctx.cfm.max(1e-9)
}
