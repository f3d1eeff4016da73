//! Joints between links, or between a link and the world.

use ferrode_math::{Pose, Vec3};

use super::{JointId, LinkId, ModelId};
use crate::source::Origin;

/// What a joint holds on to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Body {
    /// The world, which does not move.
    World,
    /// A link.
    Link(LinkId),
}

impl Body {
    /// The link, if it is one.
    pub fn link(self) -> Option<LinkId> {
        match self {
            Body::World => None,
            Body::Link(link) => Some(link),
        }
    }
}

/// A joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Scoped name.
    pub name: String,
    /// The model it belongs to; `None` for one of the world.
    pub model: Option<ModelId>,
    /// What it leaves free.
    pub kind: JointKind,
    /// The body that positions are measured from.
    pub parent: Body,
    /// The body whose motion relative to the parent is the joint's position.
    pub child: Body,
    /// The joint frame, in the world. Its origin is the anchor.
    pub pose: Pose,
    /// The first axis: of all kinds but ball and fixed.
    pub axis: Option<Axis>,
    /// The second axis: of universal, revolute2 and gearbox.
    pub axis2: Option<Axis>,
    /// Settings that SDF has for engines like this one only.
    pub advanced: JointAdvanced,
    /// Where the file says so.
    pub origin: Origin,
}

/// What a joint leaves free.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum JointKind {
    /// Rotation about `axis`. URDF's and SDF's `continuous` is a revolute joint without limits.
    Revolute,
    /// Translation along `axis`.
    Prismatic,
    /// All rotations.
    Ball,
    /// Rotations about `axis` (fixed in the parent) and `axis2` (fixed in the child), which are perpendicular.
    Universal,
    /// Two revolute joints in series: `axis` fixed in the parent, `axis2` in the child.
    Revolute2,
    /// Nothing.
    Fixed,
    /// Rotation about and translation along `axis`, coupled.
    Screw {
        /// Translation along the axis in one turn about it, m; positive for a right-handed thread.
        pitch: f64,
    },
    /// Couples θ2 = −`ratio` · θ1, where θ1 is the angle from the reference to the parent about `axis` and θ2 the
    /// one from the reference to the child about `axis2`.
    Gearbox {
        /// The ratio.
        ratio: f64,
        /// The reference body.
        reference: Body,
    },
    /// Motion in the plane whose normal is `axis` (URDF).
    Planar,
}

impl JointKind {
    /// The name of the kind, as SDF (or URDF) calls it.
    pub fn name(self) -> &'static str {
        match self {
            JointKind::Revolute => "revolute",
            JointKind::Prismatic => "prismatic",
            JointKind::Ball => "ball",
            JointKind::Universal => "universal",
            JointKind::Revolute2 => "revolute2",
            JointKind::Fixed => "fixed",
            JointKind::Screw { .. } => "screw",
            JointKind::Gearbox { .. } => "gearbox",
            JointKind::Planar => "planar",
        }
    }
}

/// An axis and what acts along it.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Unit vector, in the world, at the pose the file gives.
    pub direction: Vec3,
    /// Where it ends, and how strong and fast it may be.
    pub limits: Limits,
    /// Viscous damping, N·m·s/rad or N·s/m.
    pub damping: f64,
    /// Coulomb friction, N·m or N.
    pub friction: f64,
    /// A spring on the axis; `None`: none.
    pub spring: Option<Spring>,
    /// It follows another axis.
    pub mimic: Option<Mimic>,
}

/// A spring on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// N·m/rad or N/m.
    pub stiffness: f64,
    /// The position it pulls to, rad or m.
    pub reference: f64,
}

/// Where an axis ends, and how strong and fast it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Lowest position, rad or m; −∞ for none.
    pub lower: f64,
    /// Highest position, rad or m; ∞ for none.
    pub upper: f64,
    /// Largest force or torque of an actuator; `None`: no limit.
    pub effort: Option<f64>,
    /// Largest velocity of an actuator; `None`: no limit.
    pub velocity: Option<f64>,
    /// Stiffness of the stops, N·m/rad or N/m.
    pub stiffness: f64,
    /// Damping of the stops, N·m·s/rad or N·s/m.
    pub dissipation: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            effort: None,
            velocity: None,
            stiffness: 1e8,
            dissipation: 1.0,
        }
    }
}

/// A follower's position is `multiplier` · (leader's position − `reference`) + `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mimic {
    /// The leader.
    pub leader: JointId,
    /// The leader's second axis is meant, not its first.
    pub second_axis: bool,
    /// The factor.
    pub multiplier: f64,
    /// Added to the product, rad or m.
    pub offset: f64,
    /// Taken from the leader's position, rad or m.
    pub reference: f64,
}

/// Softness of a joint's stops or suspension in ODE's own terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopSoftness {
    /// Constraint force mixing.
    pub cfm: f64,
    /// Error reduction.
    pub erp: f64,
}

/// What SDF's `<physics><ode>` says of a joint. `None`: not given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointAdvanced {
    /// Springs and dampers are to be integrated implicitly (`implicit_spring_damper`, or 1.4's `cfm_damping`).
    pub implicit_spring_damper: bool,
    /// Constraint force mixing of the joint.
    pub cfm: Option<f64>,
    /// Error reduction of the joint.
    pub erp: Option<f64>,
    /// Restitution of the stops, 0 to 1.
    pub bounce: Option<f64>,
    /// Factor on the motor's force at a stop.
    pub fudge_factor: Option<f64>,
    /// Largest force of the joint's motor.
    pub max_force: Option<f64>,
    /// Velocity the joint's motor aims at.
    pub velocity: Option<f64>,
    /// Softness of the stops.
    pub stop: Option<StopSoftness>,
    /// Softness of a revolute2's suspension.
    pub suspension: Option<StopSoftness>,
    /// The joint's force and torque are wanted.
    pub provide_feedback: bool,
}
