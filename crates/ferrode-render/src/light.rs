//! Sun and sky.

use crate::Color;
use ferrode_math::Vec3;

/// The sun: parallel light that throws shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it comes from.
    pub from: Vec3,
    /// How bright it is; 1 suits outdoor scenes.
    pub strength: f32,
    /// How dark its shadows are: 0 for none, 1 for all that the sky leaves.
    pub shadow: f32,
}

impl Default for Light {
    fn default() -> Self {
        Self { from: Vec3::new(-0.42, -0.50, 0.76), strength: 1.0, shadow: 1.0 }
    }
}

/// What is behind everything, and lights what the sun does not reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// Overhead.
    pub zenith: Color,
    /// At eye level; the ground fades into it.
    pub horizon: Color,
    /// How much of it clouds hide, from 0 to 1.
    pub clouds: f32,
}

impl Default for Sky {
    fn default() -> Self {
        Self { zenith: Color::rgb(148, 178, 214), horizon: Color::rgb(226, 232, 238), clouds: 0.0 }
    }
}
