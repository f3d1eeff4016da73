//! Scenes: what a file of `scenes/` says, laid out into solids and joints that every engine builds.

use crate::arrange;
use ferrode_math::{Pose, Quat, Vec3};
use serde::Deserialize;
use std::path::Path;

/// A shape about its own origin; capsules and cylinders along z. Metres.
#[derive(Clone, Debug)]
pub enum Form {
    /// Full sides.
    Cuboid(Vec3),
    /// Its radius.
    Sphere(f64),
    /// Radius, and the length between the centres of its caps.
    Capsule(f64, f64),
    /// Radius and length.
    Cylinder(f64, f64),
    /// Vertices and triangles, counterclockwise from above.
    Mesh(Vec<Vec3>, Vec<[u32; 3]>),
}

/// A body of one shape.
#[derive(Clone, Debug)]
pub struct Solid {
    /// What it is.
    pub form: Form,
    /// Where it starts.
    pub pose: Pose,
    /// kg/m³; none for what never moves.
    pub density: Option<f64>,
    /// Velocity at the start, m/s.
    pub velocity: Vec3,
    /// Whether it passes through others of its kind. Solids with a joint between them always do.
    pub ghost: bool,
}

/// What holds two solids together.
#[derive(Clone, Copy, Debug)]
pub enum Link {
    /// A ball and socket.
    Ball,
    /// A hinge about an axis (unit, world frame at the start), with stops in radians and the torque of a brake in N m.
    Hinge {
        /// The axis.
        axis: Vec3,
        /// Lowest and highest angle, from the start.
        stops: Option<(f64, f64)>,
        /// The largest torque of a motor that wants no motion.
        brake: Option<f64>,
    },
}

/// A joint between two solids, or between one and the world.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// The first solid.
    pub a: usize,
    /// The second; none for the world.
    pub b: Option<usize>,
    /// In the world at the start.
    pub anchor: Vec3,
    /// Its kind.
    pub link: Link,
}

/// Everything an engine is given.
#[derive(Clone, Debug)]
pub struct Scene {
    /// For the tables.
    pub name: String,
    /// Number of steps, and the first that is timed.
    pub steps: usize,
    /// Steps before it settle the scene.
    pub first: usize,
    /// Coefficient of friction of all pairs.
    pub friction: f64,
    /// m/s², downwards along z.
    pub gravity: f64,
    /// Whether bodies may fall asleep.
    pub sleeping: bool,
    /// All solids.
    pub solids: Vec<Solid>,
    /// All joints.
    pub joints: Vec<Joint>,
}

/// Step of all scenes, in seconds.
pub const STEP: f64 = 1.0 / 60.0;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: String,
    steps: usize,
    first: usize,
    friction: f64,
    #[serde(default = "earth")]
    gravity: f64,
    #[serde(default)]
    sleeping: bool,
    part: Vec<arrange::Part>,
}

fn earth() -> f64 {
    9.81
}

impl Scene {
    /// Reads a scene.
    ///
    /// # Errors
    /// Names the file, and what is wrong with it.
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let file: File = toml::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
        let mut scene = Self {
            name: file.name,
            steps: file.steps,
            first: file.first,
            friction: file.friction,
            gravity: file.gravity,
            sleeping: file.sleeping,
            solids: Vec::new(),
            joints: Vec::new(),
        };
        for part in &file.part {
            part.lay_out(&mut scene);
        }
        Ok(scene)
    }

    /// Adds a solid, and tells its number.
    pub fn add(&mut self, form: Form, at: Vec3, density: Option<f64>) -> usize {
        let pose = Pose::new(at, Quat::IDENTITY);
        self.solids.push(Solid { form, pose, density, velocity: Vec3::ZERO, ghost: false });
        self.solids.len() - 1
    }
}
