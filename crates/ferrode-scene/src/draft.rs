//! What the files say before their references are resolved: poses still relative to named frames, joints still
//! naming what they join. Both readers produce this; [`crate::resolve`] makes a [`crate::description::Scene`] of it.

use ferrode_math::{Pose, Vec3};

use crate::description::{Collision, Inertial, JointAdvanced, Limits, Physics, Spring};
use crate::source::Origin;

/// A name and where it was written.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    pub name: String,
    pub origin: Origin,
}

/// A pose relative to a named frame; without a name, to the frame that the element's kind implies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Placement {
    pub pose: Pose,
    pub relative_to: Option<Reference>,
}

#[derive(Debug)]
pub(crate) struct Scene {
    pub name: Option<String>,
    pub gravity: Vec3,
    pub physics: Physics,
    pub models: Vec<Model>,
    pub joints: Vec<Joint>,
    pub frames: Vec<Frame>,
}

#[derive(Debug)]
pub(crate) struct Model {
    pub name: String,
    pub origin: Origin,
    pub placement: Placement,
    pub placement_frame: Option<Reference>,
    pub canonical_link: Option<Reference>,
    pub is_static: bool,
    pub self_collide: bool,
    pub allow_auto_disable: bool,
    pub links: Vec<Link>,
    pub joints: Vec<Joint>,
    pub frames: Vec<Frame>,
    pub models: Vec<Model>,
    /// Siblings of different kinds may share a name (SDF up to 1.6, URDF).
    pub shared_names: bool,
    /// Fixed joints are to be merged away, but for those named here (URDF).
    pub lump_fixed: Option<Vec<String>>,
}

#[derive(Debug)]
pub(crate) struct Link {
    pub name: String,
    pub origin: Origin,
    pub placement: Placement,
    /// A mass of 0 says that the file gives none (URDF only).
    pub inertial: Inertial,
    pub collisions: Vec<PlacedCollision>,
    pub gravity: bool,
    pub kinematic: bool,
    pub self_collide: Option<bool>,
    pub linear_damping: f64,
    pub angular_damping: f64,
    /// The inertial follows from the collisions, whose poses must be resolved first.
    pub automatic: Option<Automatic>,
}

#[derive(Debug)]
pub(crate) struct PlacedCollision {
    /// With the identity for a pose.
    pub collision: Collision,
    pub placement: Placement,
}

/// `<inertial auto="true">`.
#[derive(Clone, Debug)]
pub(crate) struct Automatic {
    pub origin: Origin,
    /// Density of collisions that give none.
    pub density: f64,
    /// The total, if it is prescribed; densities then give the proportions only.
    pub mass: Option<f64>,
}

#[derive(Debug)]
pub(crate) struct Joint {
    pub name: String,
    pub origin: Origin,
    pub kind: JointKind,
    pub parent: Reference,
    pub child: Reference,
    pub placement: Placement,
    pub axis: Option<Axis>,
    pub axis2: Option<Axis>,
    pub advanced: JointAdvanced,
}

#[derive(Clone, Debug)]
pub(crate) enum JointKind {
    Revolute,
    Prismatic,
    Ball,
    Universal,
    Revolute2,
    Fixed,
    Screw { pitch: f64 },
    Gearbox { ratio: f64, reference: Reference },
    Planar,
}

#[derive(Debug)]
pub(crate) struct Axis {
    /// Unit vector in `expressed_in`, or in the joint frame.
    pub xyz: Vec3,
    pub expressed_in: Option<Reference>,
    pub limits: Limits,
    pub damping: f64,
    pub friction: f64,
    pub spring: Option<Spring>,
    pub mimic: Option<Mimic>,
}

#[derive(Debug)]
pub(crate) struct Mimic {
    pub leader: Reference,
    pub second_axis: bool,
    pub multiplier: f64,
    pub offset: f64,
    pub reference: f64,
}

#[derive(Debug)]
pub(crate) struct Frame {
    pub name: String,
    pub origin: Origin,
    pub attached_to: Option<Reference>,
    pub placement: Placement,
    /// Not in the file: stands for the frame of a model that was merged into another.
    pub proxy: bool,
}
