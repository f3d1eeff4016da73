//! The textures that a picture is drawn into before it is shown.

use crate::Quality;

/// Format of depths.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Textures of a picture's size.
#[derive(Debug)]
pub struct Targets {
    /// Width and height.
    pub size: [u32; 2],
    /// Several samples a pixel; `None` if one is enough.
    pub samples: Option<wgpu::TextureView>,
    /// Depths.
    pub depth: wgpu::TextureView,
}

/// Makes a texture and a view of the whole of it.
pub fn texture(
    device: &wgpu::Device,
    size: [u32; 2],
    samples: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

impl Targets {
    /// Textures for pictures of a size and format.
    pub fn new(
        device: &wgpu::Device,
        size: [u32; 2],
        quality: &Quality,
        format: wgpu::TextureFormat,
    ) -> Self {
        let attached = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let view = |samples, format| {
            texture(device, size, samples, format, attached).create_view(&Default::default())
        };
        Self {
            size,
            samples: (quality.samples > 1).then(|| view(quality.samples, format)),
            depth: view(quality.samples, DEPTH),
        }
    }
}
