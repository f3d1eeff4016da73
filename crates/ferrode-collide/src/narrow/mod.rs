//! Contacts between two shapes: one file a pair, each usable alone.
//!
//! Every function adds to a [`Contacts`](crate::Contacts) list, its normals pointing into its first shape. ODE's
//! conventions for position and depth are kept pair by pair, and libode's order of contacts, because the order of
//! rows decides what `Quick` computes.

mod capsule_capsule;
mod capsule_cuboid;
mod capsule_plane;
mod capsule_sphere;
mod closest;
mod cuboid_cuboid;
mod cuboid_plane;
mod dispatch;
mod sphere_cuboid;
mod sphere_plane;
mod sphere_sphere;

pub use capsule_capsule::capsule_capsule;
pub use capsule_cuboid::capsule_cuboid;
pub use capsule_plane::capsule_plane;
pub use capsule_sphere::capsule_sphere;
pub use closest::{closest_line_points, closest_segment_cuboid, closest_segment_points};
pub use cuboid_cuboid::{BoxBox, cuboid_cuboid, cuboids_touch};
pub use cuboid_plane::cuboid_plane;
pub use dispatch::{collide, collide_frames, collides};
pub use sphere_cuboid::sphere_cuboid;
pub use sphere_plane::sphere_plane;
pub use sphere_sphere::{sphere_sphere, spheres};
