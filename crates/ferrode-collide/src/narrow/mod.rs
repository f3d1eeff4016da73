//! Contacts between two shapes: one file a pair, each usable alone.
//!
//! Every function adds to a [`Contacts`](crate::Contacts) list, its normals pointing into its first shape. ODE's
//! conventions for position and depth are kept pair by pair, and libode's order of contacts, because the order of
//! rows decides what `Quick` computes.

mod bodies;
mod body_trimesh;
mod capsule_capsule;
mod capsule_cuboid;
mod capsule_cylinder;
mod capsule_plane;
mod capsule_sphere;
mod closest;
mod convex;
mod convex_plane;
mod cuboid_cuboid;
mod cuboid_plane;
mod cylinder_cuboid;
mod cylinder_cylinder;
mod cylinder_plane;
mod cylinder_sphere;
mod dispatch;
mod distance;
mod epa;
mod gjk;
mod manifold;
mod ray_capsule;
mod ray_convex;
mod ray_cuboid;
mod ray_cylinder;
mod ray_plane;
mod ray_sphere;
mod ray_trimesh;
mod reduce;
mod slab;
mod sphere_cuboid;
mod sphere_plane;
mod sphere_sphere;
mod sphere_trimesh;
mod support;
mod triangle;
mod trimesh_plane;
mod trimesh_trimesh;

pub use bodies::convex_bodies;
pub use body_trimesh::body_trimesh;
pub use capsule_capsule::capsule_capsule;
pub use capsule_cuboid::capsule_cuboid;
pub use capsule_cylinder::capsule_cylinder;
pub use capsule_plane::capsule_plane;
pub use capsule_sphere::capsule_sphere;
pub use closest::{closest_line_points, closest_segment_cuboid, closest_segment_points};
pub use convex_plane::convex_plane;
pub use cuboid_cuboid::{BoxBox, cuboid_cuboid, cuboids_touch};
pub use cuboid_plane::cuboid_plane;
pub use cylinder_cuboid::cylinder_cuboid;
pub use cylinder_cylinder::cylinder_cylinder;
pub use cylinder_plane::cylinder_plane;
pub use cylinder_sphere::cylinder_sphere;
pub use dispatch::{collide, collide_frames, collides};
pub use distance::{Distance, distance};
pub use ray_capsule::ray_capsule;
pub use ray_convex::ray_convex;
pub use ray_cuboid::ray_cuboid;
pub use ray_cylinder::ray_cylinder;
pub use ray_plane::ray_plane;
pub use ray_sphere::ray_sphere;
pub use ray_trimesh::ray_trimesh;
pub use sphere_cuboid::sphere_cuboid;
pub use sphere_plane::sphere_plane;
pub use sphere_sphere::{sphere_sphere, spheres};
pub use sphere_trimesh::sphere_trimesh;
pub use trimesh_plane::trimesh_plane;
pub use trimesh_trimesh::trimesh_trimesh;
