//! Pictures in a window. The window itself is the caller's (winit's, say).

use crate::read_back::ReadBack;
use crate::targets::texture;
use crate::{Camera, Gpu, Picture, Quality, RenderError, Renderer, Scene};

/// The surface of a window, and a renderer for it.
#[derive(Debug)]
pub struct WindowSurface {
    gpu: Gpu,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    renderer: Renderer,
}

/// A picture on its way to the window. What is drawn into it appears with [`WindowSurface::show`].
#[derive(Debug)]
pub struct Frame {
    texture: wgpu::SurfaceTexture,
    /// Where to draw.
    pub view: wgpu::TextureView,
    /// Takes commands.
    pub encoder: wgpu::CommandEncoder,
}

impl WindowSurface {
    /// A renderer for a window of a size in pixels; where the processor draws, a plain one. `display` is what the window belongs to (winit's `OwnedDisplayHandle`).
    ///
    /// # Errors
    /// [`RenderError::NoDriver`], [`RenderError::Device`] or [`RenderError::Surface`].
    pub fn new(
        display: impl wgpu::wgt::WgpuHasDisplayHandle + Clone,
        window: impl Into<wgpu::SurfaceTarget<'static>> + Clone,
        size: [u32; 2],
        quality: Quality,
    ) -> Result<Self, RenderError> {
        let (gpu, surface) = Gpu::for_window(display, window)?;
        let unsupported = || RenderError::Surface("the driver can't show pictures in it".to_owned());
        let [width, height] = size.map(|side| side.clamp(1, gpu.largest()));
        let mut config = surface.get_default_config(&gpu.adapter, width, height).ok_or_else(unsupported)?;
        let formats = surface.get_capabilities(&gpu.adapter).formats;
        if let Some(format) = formats.iter().find(|format| format.is_srgb()) {
            config.format = *format;
        }
        config.present_mode = wgpu::PresentMode::AutoVsync;
        surface.configure(&gpu.device, &config);
        let quality = if gpu.is_software() { Quality::plain() } else { quality };
        let quality = Quality { shadow_map: quality.shadow_map.min(gpu.largest()), ..quality };
        let renderer = Renderer::new(&gpu, config.format, quality);
        Ok(Self { gpu, surface, config, renderer })
    }

    /// The quality that it draws with.
    pub fn quality(&self) -> Quality {
        self.renderer.quality()
    }

    /// The driver.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The format of the window's pictures.
    pub fn format(&self) -> wgpu::TextureFormat {
        self.config.format
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    /// Tells how many columns on the right are covered by something else, such as a panel: nothing is drawn there.
    pub fn cover_right(&mut self, columns: u32) {
        self.renderer.covered = columns;
    }

    /// Tells that the window has another size.
    pub fn resize(&mut self, size: [u32; 2]) {
        [self.config.width, self.config.height] = size.map(|side| side.clamp(1, self.gpu.largest()));
        self.surface.configure(&self.gpu.device, &self.config);
    }

    /// Begins a picture; `None` if the window can't take one now (hidden, say): try again later.
    ///
    /// # Errors
    /// [`RenderError::Surface`] if the surface is lost for good.
    pub fn begin(&mut self) -> Result<Option<Frame>, RenderError> {
        use wgpu::CurrentSurfaceTexture as Current;
        let texture = match self.surface.get_current_texture() {
            Current::Success(texture) | Current::Suboptimal(texture) => texture,
            Current::Outdated => {
                self.surface.configure(&self.gpu.device, &self.config);
                return Ok(None);
            }
            Current::Timeout | Current::Occluded => return Ok(None),
            Current::Lost => return Err(RenderError::Surface("it was lost".to_owned())),
            other => return Err(RenderError::Surface(format!("{other:?}"))),
        };
        let view = texture.texture.create_view(&Default::default());
        let encoder = self.gpu.device.create_command_encoder(&Default::default());
        Ok(Some(Frame { texture, view, encoder }))
    }

    /// Draws a scene as a camera sees it.
    pub fn draw(&mut self, frame: &mut Frame, scene: &Scene, camera: &Camera) {
        let size = [self.config.width, self.config.height];
        self.renderer.draw(&mut frame.encoder, &frame.view, size, scene, camera);
    }

    /// Draws a scene into a picture instead of the window; `more` may draw over it, into the texture that it is given.
    ///
    /// # Errors
    /// [`RenderError::ReadBack`] if the driver fails.
    pub fn picture(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        more: impl FnOnce(&Gpu, &mut wgpu::CommandEncoder, &wgpu::TextureView),
    ) -> Result<Picture, RenderError> {
        let size = self.size();
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let target = texture(&self.gpu.device, size, 1, self.config.format, usage);
        let view = target.create_view(&Default::default());
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.renderer.draw(&mut encoder, &view, size, scene, camera);
        more(&self.gpu, &mut encoder, &view);
        ReadBack::new(&self.gpu.device, size).fetch(&self.gpu, encoder, &target)
    }

    /// Shows a picture.
    pub fn show(&self, frame: Frame) {
        self.submit(frame).show(self);
    }

    /// Hands a picture's commands to the driver, but does not show it yet.
    pub fn submit(&self, frame: Frame) -> Submitted {
        self.gpu.queue.submit([frame.encoder.finish()]);
        Submitted(frame.texture)
    }
}

/// A picture that the driver is drawing, or has drawn.
#[derive(Debug)]
pub struct Submitted(wgpu::SurfaceTexture);

impl Submitted {
    /// Waits until it is drawn; to measure how long that takes.
    ///
    /// # Errors
    /// [`RenderError::Device`] if the driver fails.
    pub fn wait(&self, surface: &WindowSurface) -> Result<(), RenderError> {
        let done = surface.gpu.device.poll(wgpu::PollType::wait_indefinitely());
        done.map(|_| ()).map_err(|error| RenderError::Device(error.to_string()))
    }

    /// Shows it.
    pub fn show(self, surface: &WindowSurface) {
        surface.gpu.queue.present(self.0);
    }
}
