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

/// What a scene is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Stacks, heaps and what breaks them.
    Heaps,
    /// One type of joint each.
    Joints,
    /// Motors and gears.
    Motors,
    /// Friction, restitution, moving surfaces.
    Contacts,
    /// Chains, linkages and machines.
    Mechanisms,
    /// Rotation in space.
    Spin,
    /// Vehicles, robots, creatures.
    Creatures,
    /// The engine's own works.
    Engine,
}

impl Subject {
    /// All subjects, in the gallery's order.
    pub const ALL: [Self; 8] = [
        Self::Heaps,
        Self::Joints,
        Self::Motors,
        Self::Contacts,
        Self::Mechanisms,
        Self::Spin,
        Self::Creatures,
        Self::Engine,
    ];

    /// Its heading.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Heaps => "Stacks and heaps",
            Self::Joints => "Joints",
            Self::Motors => "Motors and gears",
            Self::Contacts => "Friction, restitution, moving surfaces",
            Self::Mechanisms => "Chains, linkages, machines",
            Self::Spin => "Rotation in space",
            Self::Creatures => "Vehicles, robots, creatures",
            Self::Engine => "Inside the engine",
        }
    }
}

/// A scene of the gallery.
#[derive(Clone, Copy, Debug)]
pub struct Demo {
    /// What it is called on the command line.
    pub name: &'static str,
    /// What it is about.
    pub subject: Subject,
    /// One line on what there is to see.
    pub about: &'static str,
    /// The physical property that [`Play::verdict`] checks after [`Demo::seconds`].
    pub property: &'static str,
    /// Simulated seconds it takes.
    pub seconds: f64,
    /// The time at which a still picture says most, s.
    pub picture_at: f64,
    /// What a picture shows of what bodies hide, by the names of the viewer's option `--show`.
    pub show: &'static [&'static str],
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

/// All names, one a line, each with what there is to see.
pub fn list() -> String {
    let width = ALL.iter().map(|demo| demo.name.len()).max().unwrap_or(0);
    ALL.iter().map(|demo| format!("{:width$}  {}\n", demo.name, demo.about)).collect()
}

#[cfg(test)]
mod tests {
    use super::{ALL, Subject, find, list};

    #[test]
    fn names_are_unique_and_each_has_its_line() {
        for demo in ALL {
            let namesakes = ALL.iter().filter(|other| other.name == demo.name).count();
            assert_eq!(namesakes, 1, "{}", demo.name);
            assert_eq!(find(demo.name).map(|found| found.about), Some(demo.about));
            assert!(Subject::ALL.contains(&demo.subject));
            assert!((0.0..=demo.seconds).contains(&demo.picture_at), "{}", demo.name);
        }
        assert_eq!(list().lines().count(), ALL.len());
    }
}
