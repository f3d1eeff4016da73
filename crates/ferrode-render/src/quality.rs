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
    /// Round shapes that look small get fewer corners, surfaces no highlights.
    pub plain: bool,
}

impl Quality {
    /// For windows.
    pub const fn live() -> Self {
        Self { samples: 4, shadow_map: 1536, shadow_samples: 4, rounded_boxes: true, plain: false }
    }

    /// For pictures to keep.
    pub const fn fine() -> Self {
        Self { samples: 4, shadow_map: 4096, shadow_samples: 24, rounded_boxes: true, plain: false }
    }

    /// For windows that the processor draws: each pixel costs time there, not each triangle alone.
    pub const fn plain() -> Self {
        Self { samples: 1, shadow_map: 1024, shadow_samples: 1, rounded_boxes: false, plain: true }
    }
}
