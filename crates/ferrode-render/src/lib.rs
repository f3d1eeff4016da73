#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod camera;
mod canvas;
mod draws;
mod error;
mod gpu;
mod instance;
mod light;
mod mesh;
mod paint;
mod picture;
mod pipelines;
mod quality;
mod read_back;
mod renderer;
mod scene;
mod shadow;
mod shapes;
mod targets;
mod uniforms;
mod view_cone;
mod window;

pub use camera::Camera;
pub use canvas::Canvas;
pub use error::RenderError;
pub use gpu::Gpu;
pub use light::{Light, Sky};
pub use mesh::{Mesh, Vertex};
pub use paint::{Color, Paint, Pattern};
pub use picture::Picture;
pub use quality::Quality;
pub use renderer::Renderer;
pub use scene::{Ground, Layer, Scene};
pub use window::{Frame, Submitted, WindowSurface};

/// The renderer's own window and drawing library, for those who add passes of their own (such as a user interface).
pub use wgpu;
