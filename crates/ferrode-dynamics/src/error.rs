//! What can go wrong, by the caller's doing.

use crate::{BodyKey, GroupKey, JointKey, JointType, MeshError};
use core::fmt;
use ferrode_math::Vec3;

/// A call that could not be carried out. Nothing was changed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The key names no body of this world: it was destroyed, or belongs to another world.
    NoSuchBody(BodyKey),
    /// The key names no joint of this world.
    NoSuchJoint(JointKey),
    /// The key names no joint group of this world.
    NoSuchGroup(GroupKey),
    /// A number is infinite or NaN where it may not be.
    NotFinite {
        /// What the number is, e.g. "position".
        what: &'static str,
        /// The value given.
        value: Vec3,
    },
    /// A number is outside its range.
    OutOfRange {
        /// What the number is, e.g. "step size".
        what: &'static str,
        /// The value given.
        value: f64,
        /// What is accepted, e.g. "a positive number".
        expected: &'static str,
    },
    /// An axis has no direction.
    ZeroVector {
        /// What the vector is, e.g. "hinge axis".
        what: &'static str,
        /// The value given.
        value: Vec3,
    },
    /// Two axes that must span a plane are parallel.
    ParallelAxes {
        /// Which axes, e.g. "universal axes 1 and 2".
        what: &'static str,
    },
    /// A quaternion or rotation matrix that describes no rotation.
    NotARotation {
        /// What was given.
        what: &'static str,
    },
    /// A joint can't connect a body with itself.
    SameBody(BodyKey),
    /// This type of joint needs two bodies.
    NeedsTwoBodies(JointType),
    /// The call needs a joint that is attached to a body.
    NotAttached {
        /// The joint.
        joint: JointKey,
        /// What was asked of it.
        what: &'static str,
    },
    /// The joint is of another type than the call is for.
    WrongJointType {
        /// The joint.
        joint: JointKey,
        /// Its type.
        found: JointType,
        /// The type that the call is for.
        expected: JointType,
    },
    /// The call makes no sense in the joint's present mode.
    WrongMode {
        /// What was asked, and the mode that it needs.
        what: &'static str,
    },
    /// A joint of a group is destroyed by emptying the group.
    JointInGroup(JointKey),
    /// The mass is not positive.
    MassNotPositive(f64),
    /// The inertia tensor is not positive definite.
    InertiaNotPositiveDefinite {
        /// Which tensor: about the body's origin, or about the centre of mass.
        about: &'static str,
    },
    /// The centre of mass is not at the body's origin.
    CentreOfMassOffOrigin {
        /// Where it is, in body coordinates.
        centre: Vec3,
    },
    /// A triangle mesh bounds no solid.
    Mesh(MeshError),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchBody(key) => {
                write!(f, "{key} is no body of this world (destroyed, or another world's)")
            }
            Self::NoSuchJoint(key) => {
                write!(f, "{key} is no joint of this world (destroyed, or another world's)")
            }
            Self::NoSuchGroup(key) => {
                write!(f, "{key} is no joint group of this world (destroyed, or another world's)")
            }
            Self::NotFinite { what, value } => {
                write!(f, "{what} must be finite, not ({}, {}, {})", value.x, value.y, value.z)
            }
            Self::OutOfRange { what, value, expected } => write!(f, "{what} must be {expected}, not {value}"),
            Self::ZeroVector { what, value } => {
                write!(f, "{what} needs a direction, but is ({}, {}, {})", value.x, value.y, value.z)
            }
            Self::ParallelAxes { what } => write!(f, "{what} must not be parallel"),
            Self::NotARotation { what } => write!(f, "{what} describes no rotation"),
            Self::SameBody(key) => write!(f, "a joint can't connect {key} with itself"),
            Self::NeedsTwoBodies(kind) => write!(f, "a {kind} joint needs two bodies"),
            Self::NotAttached { joint, what } => write!(f, "{what} needs {joint} to be attached to a body"),
            Self::WrongJointType { joint, found, expected } => {
                write!(f, "{joint} is a {found} joint, not a {expected} joint")
            }
            Self::WrongMode { what } => f.write_str(what),
            Self::JointInGroup(key) => {
                write!(f, "{key} belongs to a joint group and is destroyed by emptying the group")
            }
            Self::MassNotPositive(m) => write!(f, "mass must be a positive number, not {m}"),
            Self::InertiaNotPositiveDefinite { about } => {
                write!(f, "the inertia tensor about {about} is not positive definite")
            }
            Self::Mesh(fault) => fault.fmt(f),
            Self::CentreOfMassOffOrigin { centre } => write!(
                f,
                "the centre of mass is at ({}, {}, {}) in the body's frame, but must be at its origin: call \
                 Mass::translate(-centre) and give the body's geoms the offset -centre",
                centre.x, centre.y, centre.z
            ),
        }
    }
}

impl std::error::Error for Error {}

/// The vector if it is finite, else the error that names it.
pub(crate) fn finite(what: &'static str, value: Vec3) -> Result<Vec3, Error> {
    if value.is_finite() { Ok(value) } else { Err(Error::NotFinite { what, value }) }
}

/// The number if it is finite, else the error that names it.
pub(crate) fn finite_number(what: &'static str, value: f64) -> Result<f64, Error> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::OutOfRange { what, value, expected: "a finite number" })
    }
}

/// The number if it is not NaN, else the error that names it.
pub(crate) fn not_nan(what: &'static str, value: f64) -> Result<f64, Error> {
    if value.is_nan() { Err(Error::OutOfRange { what, value, expected: "a number" }) } else { Ok(value) }
}

/// The unit vector along an axis, or the error that names it.
pub(crate) fn unit(what: &'static str, value: Vec3) -> Result<Vec3, Error> {
    finite(what, value)?;
    value.normalized().ok_or(Error::ZeroVector { what, value })
}
