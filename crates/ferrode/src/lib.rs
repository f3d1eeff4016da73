#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

#[cfg(doctest)]
mod book;
mod build;
mod contacts;
mod energy;
mod error;
mod events;
mod fixed_step;
mod geoms;
mod joints;
mod material;
mod query;
mod step;
mod substep;
mod world;

/// Shapes, contacts, spaces and ray casts, without bodies.
pub use ferrode_collide as collide;
/// Bodies, joints and steppers, without shapes.
pub use ferrode_dynamics as dynamics;
/// Vectors, rotations and poses.
pub use ferrode_math as math;

pub use build::{BodyBuilder, mass_of};
pub use contacts::{ContactOwner, ContactSource, TouchingContact};
pub use energy::Energy;
pub use error::Error;
pub use events::ContactEvent;
pub use ferrode_collide::{
    Capsule, ClosestPoint, CollideOptions, Colliders, Compound, Cone, Convex, Cuboid, Cylinder, Ellipsoid,
    Geom, GeomContact, GeomKey, Heightfield, Plane, Ray, RayHit, Shape, ShapeCastHit, SpaceKey, SpaceKind,
    Sphere, TriMesh,
};
pub use ferrode_dynamics::{
    AMotor, AMotorMode, AutoDisable, AxisFrame, Ball, Body, BodyKey, Contact, DBall, DHinge, Damping,
    DirectMethod, DirectSettings, FiniteRotation, Fixed, FrictionLaw, GroupKey, Hinge, Hinge2, ImpactLaw,
    IslandSolve, JointError, JointFeedback, JointKey, JointType, LMotor, LimitMotor, LimitState, LimitedAxis,
    Mass, Null, PR, PU, Param, Piston, Plane2D, QuickSettings, Slider, Softness, Spring, StepClock,
    StepReport, StepTimes, Stepper, SubstepSettings, Surface, SurfaceMode, Transmission, TransmissionMode,
    Universal,
};
pub use ferrode_math::{Aabb, ContactPoint, Mat3, Pose, Quat, Vec3};
pub use fixed_step::FixedStep;
pub use geoms::GeomInfo;
pub use material::{Combine, CombineRules, Material};
pub use query::Queries;
pub use step::Step;
pub use world::World;

/// What most programs need: `use ferrode::prelude::*;`.
pub mod prelude {
    pub use crate::{
        BodyBuilder, BodyKey, Capsule, Cuboid, Cylinder, Error, GeomKey, JointKey, Mass, Material, Plane,
        Pose, Quat, Shape, Sphere, Stepper, Surface, Vec3, World,
    };
}
