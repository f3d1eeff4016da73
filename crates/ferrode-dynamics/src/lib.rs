//! Bodies, masses, joints and steppers of the [Ferrode](https://docs.rs/ferrode) rigid-body engine.
//!
//! This crate knows nothing of shapes: contacts come in as contact joints, from whatever collision detection the
//! caller uses. The `ferrode` crate puts both together.
//!
//! ```
//! use ferrode_dynamics::{Stepper, World};
//! use ferrode_math::Vec3;
//! # fn main() -> Result<(), ferrode_dynamics::Error> {
//! let mut world = World::new();
//! world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
//! let stone = world.create_body();
//! world.body_mut(stone)?.set_position(Vec3::new(0.0, 0.0, 10.0))?;
//! for _ in 0..100 {
//!     world.step(Stepper::Direct, 0.01)?;
//! }
//! assert!(world.body(stone)?.position().z < 5.1);
//! # Ok(()) }
//! ```
#![forbid(unsafe_code)]

mod arena;
mod body;
mod carried;
mod check;
mod damping;
mod ends;
mod error;
mod foreign;
mod group;
mod gyroscopic;
mod integrate;
mod island;
mod joint;
mod mass;
mod report;
mod roll;
mod rows;
mod sleep;
mod softness;
mod solve;
mod step;
mod timing;
mod world;

pub use body::{Body, BodyKey, FiniteRotation, MovedCallback};
pub use damping::Damping;
pub use error::Error;
pub use ferrode_lcp::sor::DynamicIterations;
#[doc(hidden)]
pub use foreign::{BodyState, MovedObserver};
pub use group::GroupKey;
pub use joint::*;
pub use mass::{Axis, Mass, MeshError};
pub use report::{DirectMethod, IslandSolve, StepReport};
pub use rows::{NO_FRICTION_INDEX, Row, RowKind};
pub use sleep::AutoDisable;
pub use softness::Softness;
pub use solve::direct::{DirectSettings, FrictionLaw, ImpactLaw};
pub use solve::substep::{ContactManifold, MANIFOLD_POINTS, ManifoldPoint, Spring, SubstepSettings};
pub use step::Stepper;
pub use timing::{StepClock, StepTimes};
pub use world::{QuickSettings, World};
