//! Links: rigid bodies with their mass and collisions.

use ferrode_math::{Mat3, Pose};

use super::{Geometry, ModelId, Surface};
use crate::source::Origin;

/// A rigid body.
#[derive(Clone, Debug)]
pub struct Link {
    /// Scoped name.
    pub name: String,
    /// The model it belongs to.
    pub model: ModelId,
    /// The link frame, in the world.
    pub pose: Pose,
    /// Mass and inertia.
    pub inertial: Inertial,
    /// Its collisions.
    pub collisions: Vec<Collision>,
    /// Gravity acts on it.
    pub gravity: bool,
    /// Forces don't move it; it moves with the velocity it is given.
    pub kinematic: bool,
    /// It collides with other links of its model (not with those it is joined to).
    pub self_collide: bool,
    /// Linear velocity decay.
    pub linear_damping: f64,
    /// Angular velocity decay.
    pub angular_damping: f64,
    /// Where the file says so.
    pub origin: Origin,
}

/// Mass and inertia.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertial {
    /// Mass, kg.
    pub mass: f64,
    /// The frame of the centre of mass, in the link frame.
    pub pose: Pose,
    /// Moments and (with their minus sign) products of inertia about the centre of mass, along the axes of
    /// [`Inertial::pose`], kg·m².
    pub inertia: Mat3,
}

impl Default for Inertial {
    /// SDF's default: 1 kg with unit moments of inertia, centred on the link's origin.
    fn default() -> Self {
        Self { mass: 1.0, pose: Pose::IDENTITY, inertia: Mat3::IDENTITY }
    }
}

/// A shape that touches others.
#[derive(Clone, Debug)]
pub struct Collision {
    /// Name within the link.
    pub name: String,
    /// The collision frame, in the link frame.
    pub pose: Pose,
    /// Its shape.
    pub geometry: Geometry,
    /// Its surface.
    pub surface: Surface,
    /// Most contacts with another collision; `None`: what the physics settings say.
    pub max_contacts: Option<u32>,
    /// Density for automatic inertia, kg/m³; `None`: what the link says, or 1000.
    pub density: Option<f64>,
    /// Where the file says so.
    pub origin: Origin,
}
