//! What the gallery knows of a scene before it is built.

use crate::{ALL, Failure, Play};
use ferrode::Vec3;

/// Where to look from. World coordinates, z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The eye, m.
    pub eye: Vec3,
    /// The point in the middle of the picture, m.
    pub target: Vec3,
}

impl Camera {
    /// A camera at `eye` that looks at `target`.
    pub const fn new(eye: [f64; 3], target: [f64; 3]) -> Self {
        Self { eye: Vec3::new(eye[0], eye[1], eye[2]), target: Vec3::new(target[0], target[1], target[2]) }
    }
}

/// A scene of the gallery.
#[derive(Clone, Copy, Debug)]
pub struct Demo {
    /// What it is called on the command line.
    pub name: &'static str,
    /// One line on what there is to see.
    pub about: &'static str,
    /// The physical property that [`Play::verdict`] checks after [`Demo::seconds`].
    pub property: &'static str,
    /// Simulated seconds it takes.
    pub seconds: f64,
    /// The time at which a still picture says most, s.
    pub picture_at: f64,
    /// Where to look from.
    pub camera: Camera,
    /// Builds the scene.
    pub(crate) build: fn() -> Result<Play, Failure>,
}

impl Demo {
    /// The scene at its start.
    ///
    /// # Errors
    /// Whatever the engine refuses; none is known.
    pub fn start(&self) -> Result<Play, Failure> {
        (self.build)()
    }

    /// Runs the scene to its end and tells what was measured.
    ///
    /// # Errors
    /// A step that the engine refuses, or a property that does not hold.
    pub fn run(&self) -> Result<String, Failure> {
        let mut play = self.start()?;
        for _ in 0..play.steps_to(self.seconds) {
            play.step()?;
        }
        play.verdict()
    }
}

/// The scene of that name.
pub fn find(name: &str) -> Option<&'static Demo> {
    ALL.iter().copied().find(|demo| demo.name == name)
}
