//! The graphics driver.

use crate::RenderError;

/// A driver that draws.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// For surfaces of windows.
    pub instance: wgpu::Instance,
    /// What draws.
    pub adapter: wgpu::Adapter,
    /// Makes things to draw with.
    pub device: wgpu::Device,
    /// Takes what is to be drawn.
    pub queue: wgpu::Queue,
}

/// OpenGL last: where there is no display, merely asking for it makes some systems print complaints.
const BACKENDS: [wgpu::Backends; 2] = [wgpu::Backends::PRIMARY, wgpu::Backends::GL];

fn narrowed(mut descriptor: wgpu::InstanceDescriptor, backends: wgpu::Backends) -> wgpu::InstanceDescriptor {
    descriptor.backends &= backends;
    descriptor
}

fn first_that_works<T>(open: impl Fn(wgpu::Backends) -> Result<T, RenderError>) -> Result<T, RenderError> {
    let [first, second] = BACKENDS;
    // What the better one says is what the user can help.
    open(first).or_else(|error| open(second).map_err(|_| error))
}

impl Gpu {
    /// Opens a driver for pictures, without display or window. The variables `WGPU_BACKEND` (`vulkan`, `gl`, `metal`, `dx12`)
    /// and `WGPU_ADAPTER_NAME` choose among several.
    ///
    /// # Errors
    /// [`RenderError::NoDriver`], [`RenderError::Device`].
    pub fn offscreen() -> Result<Self, RenderError> {
        first_that_works(|backends| {
            let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
            Self::open(wgpu::Instance::new(narrowed(descriptor, backends)), None)
        })
    }

    /// Opens a driver for a window, and the window's surface. `display` is what the window belongs to, which OpenGL asks for.
    ///
    /// # Errors
    /// As [`Gpu::offscreen`], and [`RenderError::Surface`].
    pub fn for_window(
        display: impl wgpu::wgt::WgpuHasDisplayHandle + Clone,
        window: impl Into<wgpu::SurfaceTarget<'static>> + Clone,
    ) -> Result<(Self, wgpu::Surface<'static>), RenderError> {
        first_that_works(|backends| {
            let display = Box::new(display.clone());
            let descriptor = wgpu::InstanceDescriptor::new_with_display_handle_from_env(display);
            let instance = wgpu::Instance::new(narrowed(descriptor, backends));
            let surface = match instance.create_surface(window.clone()) {
                Ok(surface) => surface,
                // Without any driver there is no surface either: that is what the user can help.
                Err(error) => match Self::open(instance, None) {
                    Err(missing @ RenderError::NoDriver(_)) => return Err(missing),
                    _ => return Err(RenderError::Surface(error.to_string())),
                },
            };
            let gpu = Self::open(instance, Some(&surface))?;
            Ok((gpu, surface))
        })
    }

    fn open(instance: wgpu::Instance, surface: Option<&wgpu::Surface<'_>>) -> Result<Self, RenderError> {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: surface,
            ..wgpu::RequestAdapterOptions::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|error| RenderError::NoDriver(error.to_string()))?;
        // OpenGL ES 3 has no more than this; pictures may be as large as the driver allows.
        let limits = wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits());
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("ferrode"),
            required_limits: limits,
            ..wgpu::DeviceDescriptor::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| RenderError::Device(error.to_string()))?;
        Ok(Self { instance, adapter, device, queue })
    }

    /// The driver's own name, such as `llvmpipe`.
    pub fn name(&self) -> String {
        let info = self.adapter.get_info();
        format!("{} ({:?})", info.name, info.backend)
    }

    /// Whether the processor draws, in software.
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// The largest side that a picture can have.
    pub fn largest(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }
}
