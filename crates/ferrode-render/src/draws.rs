//! The draws of a picture, and the programs that they need.

use crate::Scene;
use crate::instance::Instance;
use crate::pipelines::{Kind, Look, pattern_level};

/// What to draw: so many corners of a mesh or of the loose triangles, for a range of instances.
#[derive(Clone, Debug)]
pub enum Draw {
    Mesh { look: Look, id: u64, instances: std::ops::Range<u32> },
    Loose { look: Look, corners: std::ops::Range<u32>, instance: u32 },
}

/// The draws of a picture by their kind.
#[derive(Debug, Default)]
pub struct Draws {
    pub solid: Vec<Draw>,
    pub shadow: Vec<Draw>,
    pub glass: Vec<Draw>,
    pub over: Vec<Draw>,
    /// What throws shadows: mesh and instance.
    pub casters: Vec<(u64, Instance)>,
    /// Loose triangles throw some, too.
    pub loose_casters: bool,
}

/// Kinds of shapes, in the order in which they are uploaded, after solid ones with a shadow (0) and without (1).
pub const GLASS: u8 = 2;
pub const OVER: u8 = 3;
/// Beside the picture, but its shadow may be in it.
pub const SHADOW_ONLY: u8 = 4;

/// What a shadow map was drawn from.
pub type Shadowed = ([[f32; 4]; 4], Vec<(u64, Instance)>);

/// The looks of grounds, sky and lines.
pub fn backdrop_looks(scene: &Scene) -> [Look; 3] {
    let patterns =
        scene.grounds.iter().map(|ground| pattern_level(f32::from(ground.pattern as u8))).max().unwrap_or(0);
    let clouds = scene.sky.clouds > 0.0;
    let plain = Look { kind: Kind::Lines, patterns: 0, clouds: false };
    [Look { kind: Kind::Ground, patterns, clouds }, Look { kind: Kind::Sky, clouds, ..plain }, plain]
}

/// Adds an instance to the last draw if that has the same mesh and ends there, else a new draw.
pub fn append(list: &mut Vec<Draw>, wanted: Look, mesh: u64, at: u32) {
    if let Some(Draw::Mesh { look, id, instances }) = list.last_mut()
        && (*look, *id) == (wanted, mesh)
        && instances.end == at
    {
        instances.end += 1;
        return;
    }
    list.push(Draw::Mesh { look: wanted, id: mesh, instances: at..at + 1 });
}
