//! The user interface over the picture: egui's events in, egui's triangles out.

use crate::render::Gpu;
use crate::render::wgpu;
use crate::viewer::Viewer;
use crate::viewer::input::{Button, Input};
use egui_wgpu::ScreenDescriptor;
use std::time::{Duration, Instant};
use winit::event::WindowEvent;
use winit::window::Window;

/// egui on a window.
pub struct Interface {
    ctx: egui::Context,
    state: egui_winit::State,
    renderer: egui_wgpu::Renderer,
    /// Place of scripted hands.
    pointer: egui::Pos2,
    painted: Option<Painted>,
    painted_at: Instant,
    /// Something happened since it was painted.
    stale: bool,
}

/// Numbers that change all the time are shown anew so often only: the eye can't follow anyway.
const EVERY: Duration = Duration::from_millis(100);

/// An interface ready to be drawn.
struct Painted {
    primitives: Vec<egui::ClippedPrimitive>,
    screen: ScreenDescriptor,
    free: Vec<egui::TextureId>,
}

impl Interface {
    /// For pictures of a format, in a window.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat, window: &Window) -> Self {
        let ctx = egui::Context::default();
        ctx.set_theme(egui::Theme::Light);
        let most = Some(gpu.largest() as usize);
        let scale = Some(window.scale_factor() as f32);
        let state =
            egui_winit::State::new(ctx.clone(), egui::ViewportId::ROOT, window, scale, window.theme(), most);
        let renderer = egui_wgpu::Renderer::new(&gpu.device, format, egui_wgpu::RendererOptions::default());
        Self {
            ctx,
            state,
            renderer,
            pointer: egui::Pos2::ZERO,
            painted: None,
            painted_at: Instant::now(),
            stale: true,
        }
    }

    /// Takes an event; `true` if it was for the interface alone.
    pub fn event(&mut self, window: &Window, event: &WindowEvent) -> bool {
        self.state.on_window_event(window, event).consumed
    }

    /// Takes what scripted hands do.
    pub fn scripted(&mut self, input: &Input) {
        let scale = self.ctx.pixels_per_point();
        let event = match *input {
            Input::Move([x, y]) => {
                self.pointer = egui::pos2(x as f32 / scale, y as f32 / scale);
                egui::Event::PointerMoved(self.pointer)
            }
            Input::Button(button, pressed) => egui::Event::PointerButton {
                pos: self.pointer,
                button: match button {
                    Button::Left => egui::PointerButton::Primary,
                    Button::Right => egui::PointerButton::Secondary,
                    Button::Middle => egui::PointerButton::Middle,
                },
                pressed,
                modifiers: egui::Modifiers::NONE,
            },
            Input::Key(..) | Input::Wheel(_) => return,
        };
        self.state.egui_input_mut().events.push(event);
    }

    /// Points of the interface a pixel.
    pub fn scale(&self) -> f32 {
        self.ctx.pixels_per_point()
    }

    /// Whether the user writes into a field, so that keys are not for the viewer.
    pub fn is_writing(&self) -> bool {
        self.ctx.egui_wants_keyboard_input()
    }

    /// Whether a slider, say, is being dragged.
    pub fn is_dragging(&self) -> bool {
        self.ctx.egui_is_using_pointer()
    }

    /// Something happened that it may show.
    pub fn expire(&mut self) {
        self.stale = true;
    }

    /// Whether something in it moves by itself.
    pub fn wants_repaint(&self) -> bool {
        self.ctx.has_requested_repaint()
    }

    /// Lays the interface out anew, if something happened (or `changed`), or it shows what is long past.
    pub fn refresh(
        &mut self,
        gpu: &Gpu,
        window: &Window,
        viewer: &mut Viewer,
        size: [u32; 2],
        changed: bool,
    ) {
        let old = self.painted.as_ref().is_none_or(|painted| painted.screen.size_in_pixels != size);
        let late = self.painted_at.elapsed() > EVERY;
        // Names go along with bodies.
        if !(old || changed || self.stale || late || viewer.overlays.names || self.wants_repaint()) {
            return;
        }
        (self.stale, self.painted_at) = (false, Instant::now());
        let painted = self.run(gpu, window, viewer, size);
        self.painted = Some(painted);
    }

    fn run(&mut self, gpu: &Gpu, window: &Window, viewer: &mut Viewer, size: [u32; 2]) -> Painted {
        let input = self.state.take_egui_input(window);
        let mut output = self.ctx.run_ui(input, |ui| viewer.interface(ui));
        self.state.handle_platform_output(window, output.platform_output);
        for (id, images) in output.textures_delta.set.drain() {
            for image in &images {
                self.renderer.update_texture(&gpu.device, &gpu.queue, id, image);
            }
        }
        let scale = output.pixels_per_point;
        Painted {
            primitives: self.ctx.tessellate(output.shapes, scale),
            screen: ScreenDescriptor { size_in_pixels: size, pixels_per_point: scale },
            free: output.textures_delta.free.drain().collect(),
        }
    }

    /// Draws it over what is in a texture.
    pub fn draw(&mut self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, into: &wgpu::TextureView) {
        let Some(painted) = &self.painted else { return };
        let more = self.renderer.update_buffers(
            &gpu.device,
            &gpu.queue,
            encoder,
            &painted.primitives,
            &painted.screen,
        );
        gpu.queue.submit(more);
        let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
        let color =
            wgpu::RenderPassColorAttachment { view: into, depth_slice: None, resolve_target: None, ops };
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("interface"),
            color_attachments: &[Some(color)],
            ..Default::default()
        });
        self.renderer.render(&mut pass.forget_lifetime(), &painted.primitives, &painted.screen);
    }

    /// Forgets textures that are not drawn any more; after the picture was handed over.
    pub fn clean_up(&mut self) {
        for id in self.painted.iter_mut().flat_map(|painted| painted.free.drain(..)) {
            self.renderer.free_texture(&id);
        }
    }
}
