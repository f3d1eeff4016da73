//! Pictures without a window.

use crate::targets::texture;
use crate::{Camera, Gpu, Picture, Quality, RenderError, Renderer, Scene};

/// The format of pictures in memory.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Draws scenes into pictures of one size.
#[derive(Debug)]
pub struct Canvas {
    gpu: Gpu,
    renderer: Renderer,
    size: [u32; 2],
    target: wgpu::Texture,
    /// The picture's rows, each padded to a multiple of 256 bytes.
    rows: wgpu::Buffer,
}

fn padded(width: u32) -> u32 {
    (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
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
        let rows = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: u64::from(padded(width)) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let quality = Quality { shadow_map: quality.shadow_map.min(most), ..quality };
        let renderer = Renderer::new(&gpu, FORMAT, quality);
        Ok(Self { gpu, renderer, size: [width, height], target, rows })
    }

    /// The driver.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
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
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let mut encoder = device.create_command_encoder(&Default::default());
        self.renderer.draw(&mut encoder, &view, self.size, scene, camera);
        more(&self.gpu, &mut encoder, &view);
        let [width, height] = self.size;
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(padded(width)),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            self.target.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &self.rows, layout },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
        queue.submit([encoder.finish()]);
        self.read()
    }

    fn read(&self) -> Result<Picture, RenderError> {
        let failed = |error: &dyn std::fmt::Display| RenderError::ReadBack(error.to_string());
        let (send, receive) = std::sync::mpsc::channel();
        let slice = self.rows.slice(..);
        slice.map_async(wgpu::MapMode::Read, move |result| {
            // Nobody waits any more if this fails.
            let _ = send.send(result);
        });
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
        receive.recv().map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
        let [width, height] = self.size;
        let mut pixels = Vec::with_capacity(width as usize * height as usize * 4);
        {
            let bytes = slice.get_mapped_range().map_err(|error| failed(&error))?;
            for row in bytes.chunks_exact(padded(width) as usize) {
                pixels.extend_from_slice(&row[..width as usize * 4]);
            }
        }
        self.rows.unmap();
        Ok(Picture { width, height, pixels })
    }
}
