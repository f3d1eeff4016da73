//! One error for everything that a caller can get wrong.

use core::fmt;
use ferrode_collide::{ColliderError, ShapeError};

/// A call that could not be carried out, and why. Nothing was changed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// Of bodies, joints and steps.
    Dynamics(ferrode_dynamics::Error),
    /// Of geoms and spaces.
    Collider(ColliderError),
    /// Of a shape's sizes.
    Shape(ShapeError),
    /// A shape that has no volume, where mass was asked of it.
    NoVolume {
        /// The kind of shape.
        shape: &'static str,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dynamics(e) => e.fmt(f),
            Self::Collider(e) => e.fmt(f),
            Self::Shape(e) => e.fmt(f),
            Self::NoVolume { shape } => {
                write!(f, "a {shape} has no volume, so no mass: give the body a mass")
            }
        }
    }
}

impl std::error::Error for Error {}

impl From<ferrode_dynamics::Error> for Error {
    fn from(e: ferrode_dynamics::Error) -> Self {
        Self::Dynamics(e)
    }
}

impl From<ColliderError> for Error {
    fn from(e: ColliderError) -> Self {
        Self::Collider(e)
    }
}

impl From<ShapeError> for Error {
    fn from(e: ShapeError) -> Self {
        Self::Shape(e)
    }
}
