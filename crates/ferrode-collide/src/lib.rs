//! Shapes, contacts, spaces and ray casts of the [Ferrode](https://docs.rs/ferrode) rigid-body engine.
//!
//! Three layers, each usable without the next:
//!
//! 1. **Shapes and pairs.** A [`Shape`] is a value; [`narrow::collide`] gives the contacts of two shapes at two
//!    poses, in ODE's conventions: the normal points into the first shape.
//!    [`manifold`] has our own answer, which a solver can keep from step to step.
//! 2. **Spaces** ([`space`]): which of many boxes overlap, reported in ODE's order.
//! 3. **[`Colliders`]**: geoms with keys in a tree of spaces, ready to use.
//!
//! ```
//! use ferrode_collide::{CollideOptions, Cuboid, Plane, Shape, narrow};
//! use ferrode_math::{Pose, Vec3};
//! # fn main() -> Result<(), ferrode_collide::ShapeError> {
//! let die = Shape::from(Cuboid::new(Vec3::splat(1.0))?);
//! let ground = Shape::from(Plane::new(Vec3::Z, 0.0)?);
//! let at = Pose::from_position(Vec3::new(0.0, 0.0, 0.4));
//! let mut contacts = Vec::new();
//! narrow::collide((&die, &at), (&ground, &Pose::IDENTITY), CollideOptions::default(), &mut contacts);
//! assert_eq!(contacts.len(), 4);
//! assert!((contacts[0].point.depth - 0.1).abs() < 1e-15);
//! # Ok(()) }
//! ```
#![forbid(unsafe_code)]
// `!(depth >= 0.0)` is meant: it also turns away what is no number.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

mod arena;
mod colliders;
mod contact;
pub mod filter;
mod frame;
mod geom;
pub mod manifold;
pub mod narrow;
pub mod pairs;
pub mod query;
pub mod shape;
pub mod space;

pub use colliders::{ColliderError, Colliders, GeomKey, Item, SpaceKey, SpaceKind};
pub use contact::{CollideOptions, Contacts, GeomContact};
pub use frame::Frame;
pub use geom::Geom;
pub use query::{
    ClosestPoint, Queries, RayHit, ShapeCastHit, ShapeRayHit, closest_point, point_depth, ray_cast,
};
pub use shape::{
    Capsule, Compound, Cone, Convex, Cuboid, Custom, CustomShape, Cylinder, Ellipsoid, Heightfield, Plane,
    Ray, Shape, ShapeError, ShapeKind, Sphere, TriMesh,
};
