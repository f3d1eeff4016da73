//! The window's life: events come in, pictures go out.

use super::interface::Interface;
use super::keys;
use super::meter::{Meter, Part};
use crate::failure::Failure;
use crate::film::save_png;
use crate::lettering::Lettering;
use crate::render::{Camera, Canvas, Gpu, Picture, Quality, RenderError, Scene, WindowSurface};
use crate::viewer::input::Input;
use crate::viewer::script::{Act, FRAME, Script};
use crate::viewer::{Viewer, Wish};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, OwnedDisplayHandle};
use winit::window::{Window, WindowId};

/// The program that runs in the window.
pub struct App {
    viewer: Viewer,
    script: Option<Script>,
    meter: Option<Meter>,
    title: String,
    display: OwnedDisplayHandle,
    open: Option<Open>,
    scene: Scene,
    last: Option<Instant>,
    /// Pictures are drawn until then, though time stands still: something happened.
    awake_until: Instant,
    /// What drawing took of the last frame, s.
    drawing: f64,
    failure: Option<Failure>,
}

/// A window that is open.
struct Open {
    window: Arc<Window>,
    surface: WindowSurface,
    interface: Interface,
}

/// Frames are to take no longer, s: what drawing leaves of it steps may take, within [`LEAST`] and [`MOST`]. Slow worlds then
/// run slower than time, but the window stays alive.
const AIM: f64 = 0.045;
const LEAST: Duration = Duration::from_millis(5);
const MOST: Duration = Duration::from_millis(25);
/// After a pause of the system (a suspended laptop) time does not jump by more, s.
const LONGEST: f64 = 0.1;
/// After an event pictures are drawn for so long: the interface may show what followed.
const AFTERMATH: Duration = Duration::from_millis(300);

impl App {
    /// A program for a viewer, perhaps driven by a script, perhaps measured.
    pub fn new(
        viewer: Viewer,
        script: Option<Script>,
        meter: Option<Meter>,
        title: String,
        display: OwnedDisplayHandle,
    ) -> Self {
        Self {
            viewer,
            script,
            meter,
            title,
            display,
            open: None,
            scene: Scene::new(),
            last: None,
            awake_until: Instant::now(),
            drawing: 0.0,
            failure: None,
        }
    }

    /// How it ended.
    ///
    /// # Errors
    /// What went wrong.
    pub fn outcome(self) -> Result<(), Failure> {
        self.failure.map_or(Ok(()), Err)
    }

    fn fail(&mut self, events: &ActiveEventLoop, failure: Failure) {
        self.failure.get_or_insert(failure);
        events.exit();
    }

    fn open(&mut self, events: &ActiveEventLoop) -> Result<Open, Failure> {
        let [width, height] = self.viewer.size();
        let attributes = Window::default_attributes()
            .with_title(self.title.clone())
            .with_inner_size(PhysicalSize::new(width, height));
        let window = Arc::new(events.create_window(attributes).map_err(Failure::output)?);
        let size: [u32; 2] = window.inner_size().into();
        let display = self.display.clone();
        let surface = WindowSurface::new(display, Arc::clone(&window), size, Quality::live());
        let surface = surface.map_err(Failure::output)?;
        let interface = Interface::new(surface.gpu(), surface.format(), &window);
        self.viewer.resize(surface.size());
        Ok(Open { window, surface, interface })
    }

    /// One picture: hands, time, drawing.
    fn frame(&mut self, events: &ActiveEventLoop) -> Result<(), Failure> {
        if let Some(meter) = &mut self.meter {
            meter.begin();
        }
        let (mut shots, mut plots) = (Vec::new(), Vec::new());
        let acts = self.script.as_mut().map(Script::before_frame).unwrap_or_default();
        let mut changed = !acts.is_empty();
        for act in acts {
            match act {
                Act::Input(input) => self.scripted(input),
                Act::Wait(_) => {}
                Act::Shot(path) => shots.push(path),
                Act::Plots(path) => plots.push(path),
                Act::Plot(value) => self.viewer.plot_named(&value).map_err(Failure::usage)?,
                Act::State(path) => {
                    save_text(&path, &self.viewer.state().to_string()).map_err(Failure::output)?;
                }
                Act::Csv(path) => {
                    let saved = self.viewer.series.save_csv(&path, &self.viewer.playback);
                    saved.map_err(Failure::output)?;
                }
                Act::Quit => events.exit(),
            }
        }
        self.pass_time();
        for wish in self.viewer.take_wishes() {
            match wish {
                Wish::Quit => events.exit(),
                Wish::Shot(path) => shots.push(path),
                Wish::Plots(path) => plots.push(path),
            }
        }
        changed |= !shots.is_empty();
        let Some(open) = &mut self.open else { return Ok(()) };
        for path in plots {
            let picture = plots_picture(open.surface.gpu(), &self.viewer).map_err(Failure::output)?;
            save_png(&path, &picture).map_err(Failure::output)?;
        }
        measured(&mut self.meter, Part::Step);
        let begun = Instant::now();
        self.viewer.fill(&mut self.scene);
        measured(&mut self.meter, Part::Scene);
        let size = open.surface.size();
        open.interface.refresh(open.surface.gpu(), &open.window, &mut self.viewer, size, changed);
        measured(&mut self.meter, Part::Panel);
        let camera = self.viewer.camera();
        open.surface.cover_right(self.viewer.panel_columns(open.interface.scale()));
        for path in shots {
            let picture = open.picture(&self.scene, &camera).map_err(Failure::output)?;
            save_png(&path, &picture).map_err(Failure::output)?;
        }
        open.show(&self.scene, &camera, &mut self.meter).map_err(Failure::output)?;
        self.drawing = begun.elapsed().as_secs_f64();
        let moving = if self.meter.is_some() { self.viewer.moving() } else { 0 };
        if self.meter.as_mut().is_some_and(|meter| meter.end(moving)) {
            self.report();
            events.exit();
        }
        Ok(())
    }

    fn pass_time(&mut self) {
        let now = Instant::now();
        let passed = self.last.replace(now).map_or(0.0, |last| (now - last).as_secs_f64());
        self.viewer.count_frame(passed);
        match self.script {
            Some(_) => self.viewer.advance(FRAME, Duration::MAX),
            None => {
                let left = Duration::from_secs_f64((AIM - self.drawing).max(0.0)).clamp(LEAST, MOST);
                self.viewer.advance(passed.min(LONGEST), left);
            }
        }
    }

    fn report(&mut self) {
        if let (Some(meter), Some(open)) = (self.meter.take(), &self.open) {
            let [width, height] = open.surface.size();
            let bodies = self.viewer.playback.named.world.body_count();
            let what = format!("{width}x{height} on {}, {bodies} bodies", open.surface.gpu().name());
            print!("{}", meter.report(&what));
        }
    }

    fn scripted(&mut self, input: Input) {
        if let Some(open) = &mut self.open {
            open.interface.scripted(&input);
        }
        self.hand(input);
    }

    /// Gives what a hand did to the viewer, unless it is for the panel.
    fn hand(&mut self, input: Input) {
        let dragging = self.open.as_ref().is_some_and(|open| open.interface.is_dragging());
        let scale = self.open.as_ref().map_or(1.0, |open| open.interface.scale());
        let on_panel = dragging || self.viewer.pointer_is_on_panel(scale);
        match input {
            Input::Button(_, true) | Input::Wheel(_) if on_panel => {}
            _ => self.viewer.input(input),
        }
    }

    /// Whether the next picture may differ from the last one.
    fn is_awake(&self) -> bool {
        self.script.is_some()
            || self.meter.is_some()
            || self.viewer.is_alive()
            || Instant::now() < self.awake_until
            || self.open.as_ref().is_some_and(|open| open.interface.wants_repaint())
    }
}

fn measured(meter: &mut Option<Meter>, part: Part) {
    if let Some(meter) = meter {
        meter.spent_on(part);
    }
}

impl Open {
    fn show(&mut self, scene: &Scene, camera: &Camera, meter: &mut Option<Meter>) -> Result<(), RenderError> {
        let Some(mut frame) = self.surface.begin()? else { return Ok(()) };
        measured(meter, Part::Acquire);
        self.surface.draw(&mut frame, scene, camera);
        self.interface.draw(self.surface.gpu(), &mut frame.encoder, &frame.view);
        measured(meter, Part::Upload);
        let submitted = self.surface.submit(frame);
        if meter.is_some() {
            submitted.wait(&self.surface)?;
        }
        measured(meter, Part::Render);
        self.window.pre_present_notify();
        submitted.show(&self.surface);
        self.interface.clean_up();
        measured(meter, Part::Present);
        Ok(())
    }

    fn picture(&mut self, scene: &Scene, camera: &Camera) -> Result<Picture, RenderError> {
        let interface = &mut self.interface;
        self.surface.picture(scene, camera, |gpu, encoder, view| interface.draw(gpu, encoder, view))
    }
}

/// All plots that are shown, on a sheet of their own.
fn plots_picture(gpu: &Gpu, viewer: &Viewer) -> Result<Picture, RenderError> {
    let size = viewer.plots_size();
    let mut canvas = Canvas::on(gpu.clone(), size[0], size[1], Quality::plain())?;
    let mut letters = Lettering::new(gpu, Canvas::format());
    canvas.draw_with(&Scene::new(), &viewer.camera(), |gpu, encoder, view| {
        letters.draw(gpu, encoder, view, size, |ui| viewer.plots_sheet(ui));
    })
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_none() {
            match self.open(events) {
                Ok(open) => self.open = Some(open),
                Err(failure) => self.fail(events, failure),
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        let scripted = self.script.is_some();
        if event != WindowEvent::RedrawRequested {
            self.awake_until = Instant::now() + AFTERMATH;
            open.interface.expire();
        }
        if !scripted && event != WindowEvent::RedrawRequested {
            open.interface.event(&open.window, &event);
        }
        let writing = open.interface.is_writing();
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => {
                open.surface.resize(size.into());
                let size = open.surface.size();
                self.viewer.resize(size);
            }
            WindowEvent::RedrawRequested => {
                if let Err(failure) = self.frame(events) {
                    self.fail(events, failure);
                }
            }
            _ if scripted => {}
            WindowEvent::Focused(false) => self.viewer.release_all(),
            WindowEvent::KeyboardInput { event, .. } if !writing || !event.state.is_pressed() => {
                if let Some(key) = keys::key(event.physical_key).filter(|key| !event.repeat || key.repeats())
                {
                    self.hand(Input::Key(key, event.state.is_pressed()));
                }
            }
            WindowEvent::CursorMoved { position, .. } => self.hand(Input::Move([position.x, position.y])),
            WindowEvent::MouseInput { state, button, .. } => {
                if let Some(button) = keys::button(button) {
                    self.hand(Input::Button(button, state == ElementState::Pressed));
                }
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, y) => f64::from(y),
                    MouseScrollDelta::PixelDelta(by) => by.y / 40.0,
                };
                self.hand(Input::Wheel(notches));
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, _: &ActiveEventLoop) {
        let Some(open) = &self.open else { return };
        if self.is_awake() {
            open.window.request_redraw();
        } else {
            // Time stands still until something happens.
            self.last = None;
        }
    }
}

fn save_text(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("cannot write {}: {error}", path.display()))
}
