//! Text over pictures: names of bodies where they are, and the time. The same in windows and offscreen.

use crate::overlay::Overlays;
use egui::{Align2, Color32, FontId, LayerId, Pos2};
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use ferrode_render::wgpu;
use ferrode_render::{Camera, Gpu};
use ferrode_scene::NamedWorld;
use ferrode_scene::description::LinkId;

/// A piece of text.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The text.
    pub text: String,
    /// The pixel of its middle, or of its upper left corner.
    pub at: [f64; 2],
    /// Whether `at` is its middle.
    pub centred: bool,
    /// Height of the letters in pixels.
    pub size: f32,
}

/// The labels that overlays ask for, as a camera sees the world: names of links (of the model, if the link is its only one), of
/// joints if these are shown, and the time.
pub fn labels(
    named: &NamedWorld,
    overlays: &Overlays,
    time: f64,
    camera: &Camera,
    size: [u32; 2],
) -> Vec<Label> {
    let mut list = Vec::new();
    if overlays.time {
        list.push(Label { text: format!("{time:.3} s"), at: [10.0, 8.0], centred: false, size: 17.0 });
    }
    if !overlays.names {
        return list;
    }
    let mut add = |text: &str, place| {
        let Some((at, _)) = camera.project(place, size) else { return };
        let inside = (0..2).all(|i| at[i] >= 0.0 && at[i] < f64::from(size[i]));
        if inside {
            list.push(Label { text: text.to_owned(), at, centred: true, size: 13.0 });
        }
    };
    let scene = &named.scene;
    let mut links_of = vec![0_usize; scene.models.len()];
    for link in &scene.links {
        links_of[link.model.0] += 1;
    }
    for (index, link) in scene.links.iter().enumerate() {
        let body = named.link_body(LinkId(index)).and_then(|key| named.world.body(key).ok());
        let Some(body) = body else { continue };
        let alone = links_of[link.model.0] == 1;
        let parts: Vec<&str> = link.name.rsplit("::").collect();
        let short = if alone { parts.get(1) } else { None }.or(parts.first());
        add(short.copied().unwrap_or(&link.name), body.position());
    }
    if overlays.joints {
        for (index, joint) in scene.joints.iter().enumerate() {
            let key = named.joint_key(ferrode_scene::description::JointId(index));
            let marks = key.and_then(|key| crate::joint_marks::joint_marks(named.world.dynamics(), key));
            let place = marks.and_then(|marks| {
                marks.anchors.first().copied().or_else(|| marks.axes.first().map(|axis| axis.at))
            });
            if let Some(place) = place {
                add(joint.name.rsplit("::").next().unwrap_or(&joint.name), place);
            }
        }
    }
    list
}

/// Paints labels behind all panels.
pub fn paint(ctx: &egui::Context, labels: &[Label]) {
    let painter = ctx.layer_painter(LayerId::background());
    let scale = ctx.pixels_per_point();
    for label in labels {
        let at = Pos2::new(label.at[0] as f32 / scale, label.at[1] as f32 / scale);
        let align = if label.centred { Align2::CENTER_CENTER } else { Align2::LEFT_TOP };
        let font = FontId::proportional(label.size);
        // A pale rim, so that it can be read on everything.
        for (dx, dy) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
            let rim = Color32::from_white_alpha(170);
            painter.text(at + egui::vec2(dx, dy), align, &label.text, font.clone(), rim);
        }
        painter.text(at, align, &label.text, font, Color32::from_rgb(30, 36, 46));
    }
}

/// A user interface that is drawn into pictures, without a window.
pub struct Lettering {
    ctx: egui::Context,
    renderer: Renderer,
}

impl std::fmt::Debug for Lettering {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Lettering")
    }
}

impl Lettering {
    /// For textures of a format.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let ctx = egui::Context::default();
        ctx.set_theme(egui::Theme::Light);
        Self { ctx, renderer: Renderer::new(&gpu.device, format, RendererOptions::default()) }
    }

    /// Lays out what `contents` adds, and draws it over what is in a texture of a size.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        into: &wgpu::TextureView,
        size: [u32; 2],
        mut contents: impl FnMut(&mut egui::Ui),
    ) {
        let [width, height] = size.map(|side| side as f32);
        let rect = egui::Rect::from_min_size(Pos2::ZERO, egui::vec2(width, height));
        let input = egui::RawInput { screen_rect: Some(rect), ..egui::RawInput::default() };
        let mut output = self.ctx.run_ui(input, &mut contents);
        for (id, images) in output.textures_delta.set.drain() {
            for image in &images {
                self.renderer.update_texture(&gpu.device, &gpu.queue, id, image);
            }
        }
        let screen = ScreenDescriptor { size_in_pixels: size, pixels_per_point: output.pixels_per_point };
        let primitives = self.ctx.tessellate(output.shapes, output.pixels_per_point);
        let more = self.renderer.update_buffers(&gpu.device, &gpu.queue, encoder, &primitives, &screen);
        gpu.queue.submit(more);
        let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
        let color =
            wgpu::RenderPassColorAttachment { view: into, depth_slice: None, resolve_target: None, ops };
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("lettering"),
            color_attachments: &[Some(color)],
            ..Default::default()
        });
        self.renderer.render(&mut pass.forget_lifetime(), &primitives, &screen);
        for id in output.textures_delta.free.drain() {
            self.renderer.free_texture(&id);
        }
    }
}
