//! The shapes of collisions.

use std::path::PathBuf;

use ferrode_math::Vec3;

/// The shape of a collision, in the collision's own frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Geometry {
    /// A box centred on the origin.
    Cuboid {
        /// Side lengths.
        size: Vec3,
    },
    /// A sphere centred on the origin.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// A cylinder along z, centred on the origin.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Length.
        length: f64,
    },
    /// A capsule along z, centred on the origin.
    Capsule {
        /// Radius.
        radius: f64,
        /// Length between the centres of its half-spheres.
        length: f64,
    },
    /// An ellipsoid centred on the origin, its axes along x, y and z.
    Ellipsoid {
        /// Half axes.
        radii: Vec3,
    },
    /// A cone along z, its tip up, the middle of its height at the origin.
    Cone {
        /// Radius of the base.
        radius: f64,
        /// Height.
        length: f64,
    },
    /// The half-space below the plane through the origin.
    Plane {
        /// Unit vector out of the half-space.
        normal: Vec3,
    },
    /// Triangles from a file.
    Mesh(Mesh),
    /// Closed outlines in the xy plane, drawn up from z = 0; those inside others are holes.
    Polyline {
        /// The outlines' corners.
        outlines: Vec<Vec<[f64; 2]>>,
        /// Height.
        height: f64,
    },
    /// Terrain from a greyscale image, centred on `position`.
    Heightmap {
        /// The image as the file names it.
        uri: String,
        /// The image's file, if it was found.
        path: Option<PathBuf>,
        /// Extent in x and y, and the height of white.
        size: Vec3,
        /// Offset of the terrain's middle.
        position: Vec3,
    },
    /// Boxes drawn from a greyscale image (SDF's `<image>`).
    Image {
        /// The image as the file names it.
        uri: String,
    },
    /// No shape at all.
    Empty,
}

impl Geometry {
    /// The name of the kind, as SDF calls it.
    pub fn kind(&self) -> &'static str {
        match self {
            Geometry::Cuboid { .. } => "box",
            Geometry::Sphere { .. } => "sphere",
            Geometry::Cylinder { .. } => "cylinder",
            Geometry::Capsule { .. } => "capsule",
            Geometry::Ellipsoid { .. } => "ellipsoid",
            Geometry::Cone { .. } => "cone",
            Geometry::Plane { .. } => "plane",
            Geometry::Mesh(_) => "mesh",
            Geometry::Polyline { .. } => "polyline",
            Geometry::Heightmap { .. } => "heightmap",
            Geometry::Image { .. } => "image",
            Geometry::Empty => "empty",
        }
    }
}

/// A mesh named by a file; it is loaded by whoever needs its triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The mesh as the file names it: `model://…`, `package://…`, a relative or absolute path.
    pub uri: String,
    /// The mesh's file, if it was found.
    pub path: Option<PathBuf>,
    /// Factors along x, y and z.
    pub scale: Vec3,
    /// The part of the mesh to use; `None` for the whole.
    pub submesh: Option<String>,
    /// The part is to be moved so that its middle is at the origin.
    pub center_submesh: bool,
    /// Its convex hull is meant (SDF's `optimization="convex_hull"`).
    pub convex_hull: bool,
}
