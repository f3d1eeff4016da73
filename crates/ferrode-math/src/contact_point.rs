//! What collision tells dynamics.

use crate::Vec3;

/// A point where two shapes touch.
///
/// Collision writes it, dynamics reads it; neither sees the other. Programs that bring their own collision
/// detection make these themselves (ODE manual, `dContactGeom`).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactPoint {
    /// World position, in metres.
    pub position: Vec3,
    /// Unit normal in world coordinates, pointing into the first shape: moving that by `normal * depth` separates
    /// the two.
    pub normal: Vec3,
    /// Penetration depth in metres; positive when the shapes overlap.
    pub depth: f64,
}
