//! What geoms are made of.

mod capsule;
mod compound;
mod cone;
mod convex;
mod cuboid;
mod custom;
mod cylinder;
mod ellipsoid;
mod height_blocks;
mod heightfield;
mod hull;
mod plane;
mod ray;
mod skeleton;
mod sphere;
mod surface;
mod trimesh;

pub use capsule::Capsule;
pub use compound::Compound;
pub(crate) use compound::{seen_from, within};
pub use cone::Cone;
pub use convex::Convex;
pub use cuboid::Cuboid;
pub use custom::{Custom, CustomShape};
pub use cylinder::Cylinder;
pub use ellipsoid::Ellipsoid;
pub use heightfield::Heightfield;
pub use plane::Plane;
pub use ray::Ray;
pub(crate) use skeleton::{MOST_FACES, Ridge, Skeleton};
pub use sphere::Sphere;
pub use trimesh::{Neighbour, TriMesh};

use crate::Frame;
use core::fmt;
use ferrode_math::{Aabb, Pose};

/// A shape in its own coordinates; its place in the world comes with a pose.
///
/// Sizes are checked when a shape is made, so every value of this type can be collided.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Shape {
    /// A ball.
    Sphere(Sphere),
    /// A box.
    Cuboid(Cuboid),
    /// A cylinder with hemispherical ends.
    Capsule(Capsule),
    /// A cylinder with flat ends.
    Cylinder(Cylinder),
    /// A half-space, fixed to the world.
    Plane(Plane),
    /// A ray of finite length.
    Ray(Ray),
    /// A convex polyhedron.
    Convex(Convex),
    /// A surface of triangles.
    TriMesh(TriMesh),
    /// An ellipsoid.
    Ellipsoid(Ellipsoid),
    /// A cone.
    Cone(Cone),
    /// A grid of heights.
    Heightfield(Heightfield),
    /// A kind of one's own.
    Custom(Custom),
    /// Several shapes as one.
    Compound(Compound),
}

/// The kind of a shape: its row and column in the pair matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ShapeKind {
    /// [`Sphere`].
    Sphere,
    /// [`Cuboid`].
    Cuboid,
    /// [`Capsule`].
    Capsule,
    /// [`Cylinder`].
    Cylinder,
    /// [`Plane`].
    Plane,
    /// [`Ray`].
    Ray,
    /// [`Convex`].
    Convex,
    /// [`TriMesh`].
    TriMesh,
    /// [`Ellipsoid`].
    Ellipsoid,
    /// [`Cone`].
    Cone,
    /// [`Heightfield`].
    Heightfield,
    /// [`Custom`]: pairs with it are not in the matrix.
    Custom,
    /// [`Compound`]: pairs with it are those of its parts.
    Compound,
}

impl Shape {
    /// Which kind of shape this is.
    pub fn kind(&self) -> ShapeKind {
        match self {
            Self::Sphere(_) => ShapeKind::Sphere,
            Self::Cuboid(_) => ShapeKind::Cuboid,
            Self::Capsule(_) => ShapeKind::Capsule,
            Self::Cylinder(_) => ShapeKind::Cylinder,
            Self::Plane(_) => ShapeKind::Plane,
            Self::Ray(_) => ShapeKind::Ray,
            Self::Convex(_) => ShapeKind::Convex,
            Self::TriMesh(_) => ShapeKind::TriMesh,
            Self::Ellipsoid(_) => ShapeKind::Ellipsoid,
            Self::Cone(_) => ShapeKind::Cone,
            Self::Heightfield(_) => ShapeKind::Heightfield,
            Self::Custom(_) => ShapeKind::Custom,
            Self::Compound(_) => ShapeKind::Compound,
        }
    }

    /// The world box around the shape at `pose`.
    pub fn aabb(&self, pose: &Pose) -> Aabb {
        self.aabb_in(&Frame::from(pose))
    }

    /// The world box around the shape in `frame`.
    pub fn aabb_in(&self, frame: &Frame) -> Aabb {
        match self {
            Self::Sphere(s) => s.aabb(frame),
            Self::Cuboid(s) => s.aabb(frame),
            Self::Capsule(s) => s.aabb(frame),
            Self::Cylinder(s) => s.aabb(frame),
            Self::Plane(s) => s.aabb(),
            Self::Ray(s) => s.aabb(frame),
            Self::Convex(s) => s.aabb(frame),
            Self::TriMesh(s) => s.aabb(frame),
            Self::Ellipsoid(s) => s.aabb(frame),
            Self::Cone(s) => s.aabb(frame),
            Self::Heightfield(s) => s.aabb(frame),
            Self::Custom(s) => s.get().aabb(frame),
            Self::Compound(s) => s.aabb(frame),
        }
    }

    /// Distance from the origin of its frame that no part of the shape is beyond; infinite if there is none, or none is
    /// known.
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        match self {
            Self::Sphere(s) => s.reach(),
            Self::Cuboid(s) => s.reach(),
            Self::Capsule(s) => s.reach(),
            Self::Cylinder(s) => s.reach(),
            Self::Ellipsoid(s) => s.reach(),
            Self::Cone(s) => s.reach(),
            Self::Convex(s) => s.reach(),
            Self::Compound(s) => s.reach(),
            Self::TriMesh(_) | Self::Plane(_) | Self::Ray(_) | Self::Heightfield(_) | Self::Custom(_) => {
                f64::INFINITY
            }
        }
    }

    /// Volume in cubic metres; infinite for a plane, zero for a ray and for a heightfield, which is a surface.
    pub fn volume(&self) -> f64 {
        match self {
            Self::Sphere(s) => s.volume(),
            Self::Cuboid(s) => s.volume(),
            Self::Capsule(s) => s.volume(),
            Self::Cylinder(s) => s.volume(),
            Self::Plane(_) => f64::INFINITY,
            Self::Ray(_) | Self::Heightfield(_) => 0.0,
            Self::Convex(s) => s.volume(),
            Self::TriMesh(s) => s.volume(),
            Self::Ellipsoid(s) => s.volume(),
            Self::Cone(s) => s.volume(),
            Self::Custom(s) => s.get().volume(),
            Self::Compound(s) => s.volume(),
        }
    }

    /// Whether the shape can be moved; a plane cannot.
    pub fn is_placeable(&self) -> bool {
        !matches!(self, Self::Plane(_))
    }

    /// Whether a size is zero such that spaces skip the shape (ODE's zero-sized geoms): a sphere or capsule without
    /// radius, a box without a side, a cylinder without radius or length.
    pub fn is_zero_sized(&self) -> bool {
        match self {
            Self::Sphere(s) => s.radius() == 0.0,
            Self::Cuboid(s) => s.sides().to_array().contains(&0.0),
            Self::Capsule(s) => s.radius() == 0.0,
            Self::Cylinder(s) => s.radius() == 0.0 || s.length() == 0.0,
            Self::Ellipsoid(s) => s.radii().to_array().contains(&0.0),
            Self::Cone(s) => s.radius() == 0.0 || s.length() == 0.0,
            _ => false,
        }
    }
}

/// A shape that cannot be: names the size that is wrong and its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeError {
    /// What is wrong, as `sphere radius`.
    pub what: &'static str,
    /// The value that was given.
    pub value: f64,
}

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} cannot be {}", self.what, self.value)
    }
}

impl core::error::Error for ShapeError {}

/// Largest size: its square, and the square of a sum of a few such, stays finite.
const LARGEST: f64 = 1e150;

/// A size must be finite and not negative.
fn checked_size(what: &'static str, value: f64) -> Result<f64, ShapeError> {
    if (0.0..=LARGEST).contains(&value) { Ok(value) } else { Err(ShapeError { what, value }) }
}
