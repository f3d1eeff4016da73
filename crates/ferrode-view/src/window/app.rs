//! The window's life: events come in, pictures go out.

use super::interface::{Interface, Painted};
use super::keys;
use crate::film::save_png;
use crate::render::{Picture, Quality, Scene, WindowSurface};
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
    title: String,
    display: OwnedDisplayHandle,
    open: Option<Open>,
    scene: Scene,
    last: Option<Instant>,
    failure: Option<String>,
}

/// A window that is open.
struct Open {
    window: Arc<Window>,
    surface: WindowSurface,
    interface: Interface,
}

/// Steps may take so much of a frame: slow worlds then run slower than time, but the window stays alive.
const MOST: Duration = Duration::from_millis(25);
/// After a pause of the system (a suspended laptop) time does not jump by more, s.
const LONGEST: f64 = 0.1;

impl App {
    /// A program for a viewer, perhaps driven by a script.
    pub fn new(viewer: Viewer, script: Option<Script>, title: String, display: OwnedDisplayHandle) -> Self {
        Self { viewer, script, title, display, open: None, scene: Scene::new(), last: None, failure: None }
    }

    /// How it ended.
    ///
    /// # Errors
    /// What went wrong.
    pub fn outcome(self) -> Result<(), String> {
        self.failure.map_or(Ok(()), Err)
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: impl std::fmt::Display) {
        self.failure.get_or_insert(error.to_string());
        events.exit();
    }

    fn open(&mut self, events: &ActiveEventLoop) -> Result<Open, String> {
        let [width, height] = self.viewer.size();
        let attributes = Window::default_attributes()
            .with_title(self.title.clone())
            .with_inner_size(PhysicalSize::new(width, height));
        let window = events.create_window(attributes).map_err(|error| error.to_string())?;
        let window = Arc::new(window);
        let size: [u32; 2] = window.inner_size().into();
        let display = self.display.clone();
        let surface = WindowSurface::new(display, Arc::clone(&window), size, Quality::live());
        let surface = surface.map_err(|error| error.to_string())?;
        let interface = Interface::new(surface.gpu(), surface.format(), &window);
        self.viewer.resize(surface.size());
        Ok(Open { window, surface, interface })
    }

    /// One picture: hands, time, drawing.
    fn frame(&mut self, events: &ActiveEventLoop) -> Result<(), String> {
        let acts = self.script.as_mut().map(Script::before_frame).unwrap_or_default();
        let mut shots = Vec::new();
        for act in acts {
            match act {
                Act::Input(input) => self.scripted(input),
                Act::Wait(_) => {}
                Act::Shot(path) => shots.push((path, None)),
                Act::State(path) => save_text(&path, &self.viewer.state().to_string())?,
                Act::Csv(path) => self.viewer.series.save_csv(&path, &self.viewer.playback)?,
                Act::Quit => events.exit(),
            }
        }
        let now = Instant::now();
        let passed = self.last.replace(now).map_or(0.0, |last| (now - last).as_secs_f64());
        self.viewer.count_frame(passed);
        match self.script {
            Some(_) => self.viewer.advance(FRAME, Duration::MAX),
            None => self.viewer.advance(passed.min(LONGEST), MOST),
        }
        for wish in self.viewer.take_wishes() {
            match wish {
                Wish::Quit => events.exit(),
                Wish::Shot(path, part) => shots.push((path, part)),
            }
        }
        let Some(open) = &mut self.open else { return Ok(()) };
        self.viewer.fill(&mut self.scene);
        let size = open.surface.size();
        let painted = open.interface.run(open.surface.gpu(), &open.window, &mut self.viewer, size);
        let camera = self.viewer.camera();
        open.surface.cover_right(self.viewer.panel_columns(open.interface.scale()));
        for (path, part) in shots {
            let interface = &mut open.interface;
            let picture = open.surface.picture(&self.scene, &camera, |gpu, encoder, view| {
                interface.draw(gpu, encoder, view, &painted);
            });
            let picture = picture.map_err(|error| error.to_string())?;
            let picture =
                part.map_or(picture.clone(), |part| cropped(&picture, part, open.interface.scale()));
            save_png(&path, &picture)?;
        }
        open.show(&self.scene, &camera, &painted)
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
}

impl Open {
    fn show(
        &mut self,
        scene: &Scene,
        camera: &crate::render::Camera,
        painted: &Painted,
    ) -> Result<(), String> {
        let Some(mut frame) = self.surface.begin().map_err(|error| error.to_string())? else { return Ok(()) };
        self.surface.draw(&mut frame, scene, camera);
        self.interface.draw(self.surface.gpu(), &mut frame.encoder, &frame.view, painted);
        self.window.pre_present_notify();
        self.surface.show(frame);
        self.interface.clean_up(painted);
        Ok(())
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_none() {
            match self.open(events) {
                Ok(open) => self.open = Some(open),
                Err(error) => self.fail(events, error),
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        let scripted = self.script.is_some();
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
                if let Err(error) = self.frame(events) {
                    self.fail(events, error);
                }
            }
            _ if scripted => {}
            WindowEvent::Focused(false) => self.viewer.release_all(),
            WindowEvent::KeyboardInput { event, .. } if !writing || !event.state.is_pressed() => {
                if let Some(key) = keys::key(event.physical_key).filter(|_| !event.repeat) {
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
        if let Some(open) = &self.open {
            open.window.request_redraw();
        }
    }
}

fn save_text(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("cannot write {}: {error}", path.display()))
}

/// The part of a picture between two corners, in points of `scale` pixels.
fn cropped(picture: &Picture, part: [[f32; 2]; 2], scale: f32) -> Picture {
    let pixel = |point: f32, most: u32| ((point * scale).max(0.0) as u32).min(most);
    let [x, y] = [pixel(part[0][0], picture.width), pixel(part[0][1], picture.height)];
    let [right, bottom] = [pixel(part[1][0], picture.width), pixel(part[1][1], picture.height)];
    let (width, height) = (right.saturating_sub(x).max(1), bottom.saturating_sub(y).max(1));
    let row = |n: u32| {
        let at = (n as usize * picture.width as usize + x as usize) * 4;
        picture.pixels.get(at..at + 4 * width as usize).unwrap_or_default()
    };
    let pixels: Vec<u8> = (y..y + height).flat_map(row).copied().collect();
    if pixels.len() == width as usize * height as usize * 4 {
        Picture { width, height, pixels }
    } else {
        picture.clone()
    }
}
