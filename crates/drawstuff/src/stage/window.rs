//! Frames in a window.

use super::Input;
use crate::fault::{Fault, Outcome, say};
use crate::keys::Key;
use crate::picture_file;
use crate::state::State;
use crate::viewpoint::Drag;
use ferrode_render::{Camera, Canvas, Quality, Scene, WindowSurface};
use std::cell::RefCell;
use std::mem::ManuallyDrop;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, KeyEvent, MouseButton, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::Key as Logical;
use winit::platform::pump_events::EventLoopExtPumpEvents;
use winit::window::{Window, WindowId};

thread_local! {
    /// There can be one a process, ever; it is kept for programs that loop twice, and left alone at the process's end.
    static EVENTS: RefCell<ManuallyDrop<Option<EventLoop<()>>>> = const { RefCell::new(ManuallyDrop::new(None)) };
}

/// Time from frame to frame: programs simulate a fixed time a frame, and should not run faster on faster screens.
const FRAME: Duration = Duration::from_nanos(16_666_667);
/// The folder of pictures that Ctrl-W writes.
const FOLDER: &str = "frame";

/// A window.
pub struct WindowStage {
    hands: Hands,
    /// For pictures of the size of the window.
    canvas: Option<Canvas>,
    written: u64,
    next: Instant,
}

/// What the event loop calls.
struct Hands {
    title: String,
    size: [u32; 2],
    open: Option<(Arc<Window>, WindowSurface)>,
    inputs: Vec<Input>,
    control: bool,
    /// Left, middle, right.
    buttons: [bool; 3],
    pointer: Option<[f64; 2]>,
    failure: Option<String>,
}

fn event_loop() -> Outcome<EventLoop<()>> {
    let mut builder = EventLoop::builder();
    // Any thread may show a window where the system allows it.
    #[cfg(target_os = "linux")]
    winit::platform::x11::EventLoopBuilderExtX11::with_any_thread(&mut builder, true);
    #[cfg(windows)]
    winit::platform::windows::EventLoopBuilderExtWindows::with_any_thread(&mut builder, true);
    builder.build().map_err(|error| {
        let help = "there is no display for a window: set DRAWSTUFF_HEADLESS=FOLDER for pictures in a folder, or use xvfb-run";
        Fault::circumstance(format!("{help} ({error})"))
    })
}

impl WindowStage {
    /// Opens a window of a size in pixels.
    ///
    /// # Errors
    /// There is no display, or no driver.
    pub fn open(title: &str, size: [u32; 2]) -> Outcome<Self> {
        let hands = Hands {
            title: title.to_owned(),
            size,
            open: None,
            inputs: Vec::new(),
            control: false,
            buttons: [false; 3],
            pointer: None,
            failure: None,
        };
        let mut stage = Self { hands, canvas: None, written: 0, next: Instant::now() };
        EVENTS.with_borrow_mut(|events| {
            if events.is_none() {
                **events = Some(event_loop()?);
            }
            Ok(())
        })?;
        stage.pump()?;
        Ok(stage)
    }

    fn pump(&mut self) -> Outcome<()> {
        EVENTS.with_borrow_mut(|events| {
            if let Some(events) = events.as_mut() {
                events.pump_app_events(Some(Duration::ZERO), &mut self.hands);
            }
        });
        self.hands.failure.take().map_or(Ok(()), |failure| Err(Fault::Circumstance(failure)))
    }

    /// What hands did since this was last asked, after waiting for the time of the next frame.
    ///
    /// # Errors
    /// The window failed.
    pub fn input(&mut self) -> Outcome<Vec<Input>> {
        let now = Instant::now();
        if self.next > now {
            std::thread::sleep(self.next - now);
        }
        self.next = Instant::now() + FRAME;
        self.pump()?;
        Ok(std::mem::take(&mut self.hands.inputs))
    }

    /// Shows a frame; `write` asks for a picture file too.
    ///
    /// # Errors
    /// The driver failed, or a file can't be written.
    pub fn show(&mut self, state: &mut State, write: bool) -> Outcome<()> {
        let camera = state.view.camera();
        let scene = state.drawing.scene();
        let Some((window, surface)) = &mut self.hands.open else { return Ok(()) };
        if let Some(mut frame) = surface.begin().map_err(Fault::circumstance)? {
            surface.draw(&mut frame, scene, &camera);
            window.pre_present_notify();
            surface.show(frame);
        }
        if write { self.write(scene, &camera) } else { Ok(()) }
    }

    fn write(&mut self, scene: &Scene, camera: &Camera) -> Outcome<()> {
        let Some((_, surface)) = &self.hands.open else { return Ok(()) };
        let size = surface.size();
        if self.canvas.as_ref().is_none_or(|canvas| canvas.size() != size) {
            let canvas = Canvas::on(surface.gpu().clone(), size[0], size[1], surface.quality());
            self.canvas = Some(canvas.map_err(Fault::circumstance)?);
        }
        let Some(canvas) = &mut self.canvas else { return Ok(()) };
        let folder = Path::new(FOLDER);
        if self.written == 0 {
            picture_file::folder(folder)?;
            say("writing pictures to the folder \"frame\"\n");
        }
        let picture = canvas.draw(scene, camera).map_err(Fault::circumstance)?;
        picture_file::save(&folder.join(format!("{:05}.png", self.written)), &picture)?;
        self.written += 1;
        Ok(())
    }

    /// Closes the window.
    pub fn close(mut self) {
        self.hands.open = None;
        self.hands.size = [0; 2];
        // The window system is told now, not when the process ends; that it fails no longer matters.
        let _ = self.pump();
    }
}

impl Hands {
    fn open(&mut self, events: &ActiveEventLoop) -> Result<(Arc<Window>, WindowSurface), String> {
        let attributes = Window::default_attributes()
            .with_title(self.title.clone())
            .with_inner_size(PhysicalSize::new(self.size[0], self.size[1]));
        let window = Arc::new(events.create_window(attributes).map_err(|error| error.to_string())?);
        let size = window.inner_size().into();
        let display = events.owned_display_handle();
        let surface = WindowSurface::new(display, Arc::clone(&window), size, Quality::live());
        Ok((window, surface.map_err(|error| error.to_string())?))
    }

    /// Opens the window unless it is open, or was closed.
    fn ensure(&mut self, events: &ActiveEventLoop) {
        if self.open.is_none() && self.size != [0; 2] && self.failure.is_none() {
            match self.open(events) {
                Ok(open) => self.open = Some(open),
                Err(error) => self.failure = Some(error),
            }
        }
    }

    fn key(&mut self, event: &KeyEvent) {
        if self.control {
            // Held keys go on stepping, but don't switch to and fro.
            if let Logical::Character(text) = &event.logical_key
                && let Some(letter) = text.chars().next().map(|letter| letter.to_ascii_lowercase())
                && (!event.repeat || letter == 'o')
            {
                self.inputs.push(Input::Key(Key::Control(letter)));
            }
        } else {
            let signs = event.text.iter().flat_map(|text| text.chars());
            self.inputs.extend(signs.map(|sign| Input::Key(Key::Plain(sign))));
        }
    }

    fn moved(&mut self, to: [f64; 2]) {
        let from = self.pointer.replace(to).unwrap_or(to);
        let [left, middle, right] = self.buttons;
        if let Some(drag) = Drag::of(left, middle, right) {
            let [across, down] = [to[0] - from[0], to[1] - from[1]].map(|by| by as f32);
            self.inputs.push(Input::Drag(drag, across, down));
        }
    }
}

impl ApplicationHandler for Hands {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        self.ensure(events);
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        // A second loop of the program's: the system has resumed long ago.
        self.ensure(events);
    }

    fn window_event(&mut self, _: &ActiveEventLoop, id: WindowId, event: WindowEvent) {
        let Some((window, surface)) = &mut self.open else { return };
        if window.id() != id {
            return;
        }
        match event {
            WindowEvent::CloseRequested => self.inputs.push(Input::Close),
            WindowEvent::Resized(size) => surface.resize(size.into()),
            WindowEvent::ModifiersChanged(modifiers) => self.control = modifiers.state().control_key(),
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } if event.state.is_pressed() => {
                self.key(&event);
            }
            WindowEvent::Focused(false) => (self.buttons, self.control) = ([false; 3], false),
            WindowEvent::MouseInput { state, button, .. } => {
                let n = match button {
                    MouseButton::Left => 0,
                    MouseButton::Middle => 1,
                    MouseButton::Right => 2,
                    _ => return,
                };
                self.buttons[n] = state == ElementState::Pressed;
            }
            WindowEvent::CursorMoved { position, .. } => self.moved([position.x, position.y]),
            _ => {}
        }
    }
}
