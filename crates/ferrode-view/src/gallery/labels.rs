//! Words over a picture.

use egui::{Align2, Color32, FontId, Pos2, Rect, pos2, vec2};
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use ferrode_math::Vec3;
use ferrode_render::{Camera, Gpu, wgpu};

/// A word beside a point of the world.
#[derive(Clone, Debug)]
pub struct Label {
    /// The point.
    pub at: Vec3,
    /// The word.
    pub text: String,
    /// Where it stands.
    pub side: Side,
}

/// Where a word stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// On the point.
    On,
    /// Above it, on the right.
    Above,
    /// Below it, on the right.
    Below,
}

/// Height of letters, pixels.
const HEIGHT: f32 = 16.0;

/// Draws labels over a picture of a size in a texture.
pub fn draw(
    labels: &[Label],
    camera: &Camera,
    size: [u32; 2],
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    into: &wgpu::TextureView,
    format: wgpu::TextureFormat,
) {
    let ctx = egui::Context::default();
    let screen = Rect::from_min_size(Pos2::ZERO, vec2(size[0] as f32, size[1] as f32));
    let input = egui::RawInput { screen_rect: Some(screen), ..egui::RawInput::default() };
    let mut output = ctx.run_ui(input, |ui| {
        for label in labels {
            let Some(([x, y], _)) = camera.project(label.at, size) else { continue };
            let point = pos2(x as f32, y as f32);
            let (place, align) = match label.side {
                Side::On => (point, Align2::CENTER_CENTER),
                Side::Above => (point + vec2(7.0, -3.0), Align2::LEFT_BOTTOM),
                Side::Below => (point + vec2(7.0, 4.0), Align2::LEFT_TOP),
            };
            let write = |dx: f32, dy: f32, color: Color32| {
                let font = FontId::proportional(HEIGHT);
                ui.painter().text(place + vec2(dx, dy), align, &label.text, font, color);
            };
            // A pale rim, for words over dark things.
            for (dx, dy) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
                write(dx, dy, Color32::from_white_alpha(200));
            }
            write(0.0, 0.0, Color32::from_rgb(24, 26, 30));
        }
    });
    let mut renderer = Renderer::new(&gpu.device, format, RendererOptions::default());
    for (id, images) in output.textures_delta.set.drain() {
        for image in &images {
            renderer.update_texture(&gpu.device, &gpu.queue, id, image);
        }
    }
    let screen = ScreenDescriptor { size_in_pixels: size, pixels_per_point: output.pixels_per_point };
    let primitives = ctx.tessellate(output.shapes, output.pixels_per_point);
    let more = renderer.update_buffers(&gpu.device, &gpu.queue, encoder, &primitives, &screen);
    gpu.queue.submit(more);
    let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
    let color = wgpu::RenderPassColorAttachment { view: into, depth_slice: None, resolve_target: None, ops };
    let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("labels"),
        color_attachments: &[Some(color)],
        ..Default::default()
    });
    renderer.render(&mut pass.forget_lifetime(), &primitives, &screen);
}
