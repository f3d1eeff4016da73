//! The viewer in a window.

mod app;
mod interface;
mod keys;
mod meter;

use crate::demo;
use crate::failure::Failure;
use crate::overlay::Overlays;
use crate::painter::Coloring;
use crate::setup::Setup;
use crate::view_point::ViewPoint;
use crate::viewer::Viewer;
use crate::viewer::playback::Playback;
use crate::viewer::script::Script;
use crate::viewer::source::Recording;
use ferrode_demos::Demo;
use ferrode_scene::{BuildOptions, LoadOptions, build, load_str};
use std::path::PathBuf;
use winit::event_loop::EventLoop;

/// What `ferrode view` and `ferrode replay` are asked for.
#[derive(Clone, Debug)]
pub struct ViewArgs {
    /// The world.
    pub setup: Setup,
    /// A demo in place of the file's world.
    pub demo: Option<&'static Demo>,
    /// A recording to show on it; without a world file its links are small boxes.
    pub recording: Option<PathBuf>,
    /// Where the camera stands.
    pub view: ViewPoint,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// What to show of the engine.
    pub overlays: Overlays,
    /// What colours tell.
    pub coloring: Coloring,
    /// Begin paused.
    pub paused: bool,
    /// Slower (below 1) or faster than time.
    pub speed: f64,
    /// Hands written down.
    pub script: Option<PathBuf>,
    /// Values to plot from the start.
    pub plots: Vec<String>,
    /// Leave after so many frames, and tell how long they took.
    pub frames: Option<u32>,
}

/// Opens the window, and comes back when it is closed.
///
/// # Errors
/// In this order: the file is wrong (the loader's report), there is no display, there is no driver.
pub fn view(args: &ViewArgs) -> Result<(), Failure> {
    let mut playback = playback(args).map_err(Failure::file)?;
    playback.paused = args.paused;
    playback.speed = args.speed;
    let script = args.script.as_ref().map(|path| {
        let text = std::fs::read_to_string(path);
        let text = text.map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        Script::parse(&text).map_err(|error| format!("{}: {error}", path.display()))
    });
    let script = script.transpose().map_err(Failure::file)?;
    let mut viewer = Viewer::new(playback, args.size, &args.view, args.overlays);
    viewer.painter.coloring = args.coloring;
    if args.demo.is_some_and(|demo| args.view == demo::view_point(demo)) {
        // The demo's camera is that of its picture, which has no panel.
        viewer.make_room();
    }
    for value in &args.plots {
        viewer.plot_named(value).map_err(Failure::usage)?;
    }
    let events = EventLoop::new().map_err(|_| Failure::output(no_display(args)))?;
    let name = args.recording.as_ref().unwrap_or(&args.setup.file);
    let name = name.file_name().unwrap_or_default().to_string_lossy();
    let title = args.demo.map_or(name.as_ref(), |demo| demo.name);
    let meter = args.frames.map(|frames| meter::Meter::new(frames as usize));
    let title = format!("{title} – Ferrode");
    let mut app = app::App::new(viewer, script, meter, title, events.owned_display_handle());
    events.run_app(&mut app).map_err(|error| Failure::output(format!("the window failed: {error}")))?;
    app.outcome()
}

fn no_display(args: &ViewArgs) -> String {
    let (picture, window) = match args.demo {
        Some(demo) => (format!("demo {}", demo.name), format!("demo {}", demo.name)),
        None if args.recording.is_some() => ("render FILE".to_owned(), "replay RECORDING".to_owned()),
        None => ("render FILE".to_owned(), "view FILE".to_owned()),
    };
    format!(
        "there is no display for a window: draw pictures with `ferrode {picture} -o out.png` (or out.mp4), or open a virtual \
         display with `xvfb-run ferrode {window}`"
    )
}

fn playback(args: &ViewArgs) -> Result<Playback, String> {
    if let Some(demo) = args.demo {
        let (named, direction) = demo::start(demo)?;
        return Ok(Playback::of_demo(named, direction));
    }
    let Some(path) = &args.recording else {
        let (named, warnings) = args.setup.load()?;
        for warning in warnings.iter().take(5) {
            eprintln!("{warning}");
        }
        return Ok(Playback::new(args.setup.clone(), named));
    };
    let mut recording = Recording::read(path)?;
    let named = if args.setup.file.as_os_str().is_empty() {
        let text = recording.stand_in();
        recording.rename_for_stand_in();
        let loaded = load_str("recording", &text, &LoadOptions::default()).map_err(|e| e.to_string())?;
        build(&loaded.scene, &BuildOptions::default()).map_err(|error| error.to_string())?
    } else {
        args.setup.load()?.0
    };
    Playback::of_recording(named, recording).map_err(|error| error.to_string())
}
