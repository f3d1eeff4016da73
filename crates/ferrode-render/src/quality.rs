//! How much work a picture may make.

/// How much work a picture may make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// Samples per pixel that smooth edges: 1 or 4.
    pub samples: u32,
    /// Side of the shadow map in texels; 0 for no shadows.
    pub shadow_map: u32,
    /// Samples of the shadow map per pixel: the more, the softer the shadows' edges.
    pub shadow_samples: u32,
    /// Boxes get rounded edges, that catch the light.
    pub rounded_boxes: bool,
}

impl Quality {
    /// For windows.
    pub const fn live() -> Self {
        Self { samples: 4, shadow_map: 1536, shadow_samples: 4, rounded_boxes: true }
    }

    /// For pictures to keep.
    pub const fn fine() -> Self {
        Self { samples: 4, shadow_map: 4096, shadow_samples: 24, rounded_boxes: true }
    }
}
