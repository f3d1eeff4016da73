//! `ferrode render`: a world's picture or film, without a window.

use crate::demo::{self, Direction};
use crate::failure::Failure;
use crate::film::{self, Format};
use crate::lettering::{self, Lettering};
use crate::overlay::{self, Overlays, Scale};
use crate::painter::{Coloring, Painter, bounds};
use crate::setup::Setup;
use crate::view_point::ViewPoint;
use ferrode_demos::Demo;
use ferrode_math::{Aabb, Vec3};
use ferrode_render::{Camera, Canvas, Picture, Quality, RenderError, Scene};
use ferrode_scene::NamedWorld;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::path::PathBuf;

/// What `ferrode render` is asked for.
#[derive(Clone, Debug)]
pub struct RenderArgs {
    /// The world.
    pub setup: Setup,
    /// A demo in place of the file's world.
    pub demo: Option<&'static Demo>,
    /// Where the picture or film goes.
    pub out: PathBuf,
    /// The picture's moment, or the film's length, s.
    pub time: f64,
    /// Where the film begins, s.
    pub start: f64,
    /// Frames a second of films.
    pub rate: Option<f64>,
    /// Slower (below 1) or faster than time.
    pub speed: f64,
    /// Where the camera stands.
    pub view: ViewPoint,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// What to show of the engine.
    pub overlays: Overlays,
    /// What colours tell.
    pub coloring: Coloring,
    /// As windows draw, for speed.
    pub draft: bool,
    /// No progress bar.
    pub quiet: bool,
}

/// Draws pictures of a world from one camera.
#[derive(Debug)]
pub struct Photographer {
    canvas: Canvas,
    scene: Scene,
    /// How worlds are drawn.
    pub painter: Painter,
    /// What is shown of the engine.
    pub overlays: Overlays,
    /// How long arrows are.
    pub scale: Scale,
    /// Where the camera stands.
    pub camera: Camera,
    lettering: Option<Lettering>,
}

impl Photographer {
    /// Opens a driver for pictures of a size, and sets up the camera for a world as it is now.
    ///
    /// # Errors
    /// As [`Canvas::new`].
    pub fn new(
        named: &NamedWorld,
        size: [u32; 2],
        quality: Quality,
        view: &ViewPoint,
    ) -> Result<Self, RenderError> {
        let canvas = Canvas::new(size[0], size[1], quality)?;
        let (painter, around) = staged(named);
        let camera = view.camera(&around, canvas.aspect());
        let scale = Scale::of(&named.world);
        Ok(Self {
            canvas,
            scene: Scene::new(),
            painter,
            overlays: Overlays::default(),
            scale,
            camera,
            lettering: None,
        })
    }

    /// A picture of the world as it is now.
    ///
    /// # Errors
    /// As [`Canvas::draw`].
    pub fn picture(&mut self, world: &ferrode::World) -> Result<Picture, RenderError> {
        self.fill(world, None);
        self.canvas.draw(&self.scene, &self.camera)
    }

    /// A picture of a named world as it is now, with the text that overlays ask for, and what a demo draws beside it.
    ///
    /// # Errors
    /// As [`Canvas::draw`].
    pub fn lettered_picture(
        &mut self,
        named: &NamedWorld,
        direction: Option<&Direction>,
    ) -> Result<Picture, RenderError> {
        self.fill(&named.world, direction);
        let size = self.canvas.size();
        let labels = lettering::labels(named, &self.overlays, named.world.time(), &self.camera, size);
        if labels.is_empty() {
            return self.canvas.draw(&self.scene, &self.camera);
        }
        let letters =
            self.lettering.get_or_insert_with(|| Lettering::new(self.canvas.gpu(), Canvas::format()));
        self.canvas.draw_with(&self.scene, &self.camera, |gpu, encoder, view| {
            letters.draw(gpu, encoder, view, size, |ui| lettering::paint(ui.ctx(), &labels));
        })
    }

    fn fill(&mut self, world: &ferrode::World, direction: Option<&Direction>) {
        self.scene.clear(self.camera.target);
        if let Some(direction) = direction {
            direction.draw(world, &mut self.painter, &mut self.scene);
        }
        self.painter.paint(world, &mut self.scene);
        overlay::draw(world, &self.overlays, &self.scale, &mut self.scene);
    }

    /// What draws.
    pub fn canvas(&self) -> &Canvas {
        &self.canvas
    }
}

/// A painter for a world, and what the camera is to see at the start.
pub(crate) fn staged(named: &NamedWorld) -> (Painter, Aabb) {
    let mut painter = Painter::for_named(named);
    let unit = Aabb { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
    let around = bounds(&named.world).unwrap_or(unit);
    // What hangs in the world gets a floor for its shadow; what falls freely would fall through it.
    let world = &named.world;
    let held = |joint| world.joint_bodies(joint).is_ok_and(|bodies| bodies.contains(&None));
    if world.joints().any(held) || world.geoms().any(|info| info.body.is_none()) {
        painter.floor = Some(around.min.z - 0.4 * around.extent().abs_max().max(0.1));
    }
    (painter, around)
}

/// Does what `ferrode render` is asked for.
///
/// # Errors
/// The world is wrong, there is no driver, or the result cannot be written: one line (or the loader's report).
pub fn render(args: &RenderArgs) -> Result<(), Failure> {
    let format = Format::of(&args.out).ok_or_else(|| {
        Failure::usage("the name must end in .png, .gif, .mp4, or be a folder, which says what to write")
    })?;
    let (mut named, mut direction) = match args.demo {
        Some(demo) => demo::start(demo).map(|(named, direction)| (named, Some(direction))),
        None => load(args).map(|named| (named, None)),
    }
    .map_err(Failure::file)?;
    let quality = if args.draft { Quality::live() } else { Quality::fine() };
    let mut photographer =
        Photographer::new(&named, args.size, quality, &args.view).map_err(Failure::output)?;
    photographer.overlays = args.overlays;
    photographer.painter.coloring = args.coloring;
    if args.overlays.joint_forces {
        overlay::record_joint_forces(&mut named.world).map_err(Failure::file)?;
    }
    let rate = args.rate.unwrap_or(if format == Format::Gif { 20.0 } else { 30.0 });
    let moments: Vec<f64> = if format.moves() {
        let count = (args.time / args.speed * rate).round() as u64;
        (0..=count).map(|n| args.start + n as f64 * args.speed / rate).collect()
    } else {
        vec![args.start + args.time]
    };
    let mut film = film::create(&args.out, format, args.size, rate).map_err(Failure::output)?;
    let last = moments.last().copied().unwrap_or(0.0);
    let progress = progress_bar(last, args.quiet);
    for moment in moments {
        // To the step that is nearest.
        while named.world.time() + 0.5 * named.step_size() < moment {
            match &mut direction {
                Some(direction) => direction.step(&mut named).map_err(Failure::file)?,
                None => named.step().map_err(Failure::file)?,
            };
            progress.set_position((named.world.time() * 1e3) as u64);
        }
        named.world.sync_geoms();
        let picture = photographer.lettered_picture(&named, direction.as_ref()).map_err(Failure::output)?;
        film.add(&picture).map_err(Failure::output)?;
    }
    film.finish().map_err(Failure::output)?;
    progress.finish_and_clear();
    Ok(())
}

fn load(args: &RenderArgs) -> Result<NamedWorld, String> {
    let (named, warnings) = args.setup.load()?;
    if !args.quiet {
        for warning in warnings.iter().take(5) {
            eprintln!("{warning}");
        }
    }
    Ok(named)
}

/// A bar over milliseconds of simulated time, on a terminal only.
fn progress_bar(seconds: f64, quiet: bool) -> ProgressBar {
    let visible = !quiet && std::io::stderr().is_terminal();
    let target = if visible { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(Some((seconds * 1e3) as u64), target);
    if let Ok(style) = ProgressStyle::with_template("rendering {wide_bar} {percent:>3} % ({eta} left)") {
        bar.set_style(style);
    }
    bar
}
