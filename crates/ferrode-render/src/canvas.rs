//! Pictures without a window.

use crate::read_back::ReadBack;
use crate::targets::texture;
use crate::{Camera, Gpu, Picture, Quality, RenderError, Renderer, Scene};

/// The format of pictures in memory.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Draws scenes into pictures of one size.
#[derive(Debug)]
pub struct Canvas {
    gpu: Gpu,
    renderer: Renderer,
    size: [u32; 2],
    target: wgpu::Texture,
    read_back: ReadBack,
}

impl Canvas {
    /// Opens a driver for pictures of a size.
    ///
    /// # Errors
    /// [`RenderError::NoDriver`] or [`RenderError::Device`] without a working driver, [`RenderError::Size`] for a size that
    /// it can't do.
    pub fn new(width: u32, height: u32, quality: Quality) -> Result<Self, RenderError> {
        Self::on(Gpu::offscreen()?, width, height, quality)
    }

    /// As [`Canvas::new`], on a driver that is open already.
    ///
    /// # Errors
    /// [`RenderError::Size`].
    pub fn on(gpu: Gpu, width: u32, height: u32, quality: Quality) -> Result<Self, RenderError> {
        let most = gpu.largest();
        if width == 0 || height == 0 || width > most || height > most {
            return Err(RenderError::Size { width, height, most });
        }
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let target = texture(&gpu.device, [width, height], 1, FORMAT, usage);
        let read_back = ReadBack::new(&gpu.device, [width, height]);
        let quality = Quality { shadow_map: quality.shadow_map.min(most), ..quality };
        let renderer = Renderer::new(&gpu, FORMAT, quality);
        Ok(Self { gpu, renderer, size: [width, height], target, read_back })
    }

    /// The driver.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The format of the texture that is drawn into, for what draws over scenes.
    pub const fn format() -> wgpu::TextureFormat {
        FORMAT
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Width to height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }

    /// Draws a scene as a camera sees it.
    ///
    /// # Errors
    /// [`RenderError::ReadBack`] if the driver fails.
    pub fn draw(&mut self, scene: &Scene, camera: &Camera) -> Result<Picture, RenderError> {
        self.draw_with(scene, camera, |_, _, _| {})
    }

    /// As [`Canvas::draw`]; `more` may draw over the scene, into the texture that it is given.
    ///
    /// # Errors
    /// [`RenderError::ReadBack`] if the driver fails.
    pub fn draw_with(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        more: impl FnOnce(&Gpu, &mut wgpu::CommandEncoder, &wgpu::TextureView),
    ) -> Result<Picture, RenderError> {
        let view = self.target.create_view(&Default::default());
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.renderer.draw(&mut encoder, &view, self.size, scene, camera);
        more(&self.gpu, &mut encoder, &view);
        self.read_back.fetch(&self.gpu, encoder, &self.target)
    }
}
