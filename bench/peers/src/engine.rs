//! What the runner asks of an engine.

use crate::scene::Scene;
use ferrode_math::Pose;

/// A world in one engine.
pub trait Engine {
    /// The engine's name with its version, and the settings that are not its defaults.
    fn about(&self) -> String;
    /// Advances by [`STEP`](crate::scene::STEP).
    fn step(&mut self);
    /// Poses of all solids, in the scene's order.
    fn poses(&self, out: &mut Vec<Pose>);
}

/// An engine by its name on the command line.
pub struct Choice {
    /// The name.
    pub name: &'static str,
    /// Whether it can use several threads.
    pub threads: bool,
    /// Why it does not run a scene, if so.
    pub refuses: fn(&Scene) -> Option<String>,
    /// Builds a scene in it.
    pub build: fn(&Scene, usize) -> Box<dyn Engine>,
}
