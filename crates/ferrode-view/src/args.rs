//! The command line: what can be asked for.

use crate::demo;
use crate::overlay::Overlays;
use crate::painter::Coloring;
use crate::render_command::RenderArgs;
use crate::setup::Setup;
use crate::view_point::ViewPoint;
use crate::viewer::input::KEYS;
use crate::window::ViewArgs;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use ferrode::Stepper;
use ferrode_demos::Demo;
use std::path::PathBuf;

/// What to do.
#[derive(Clone, Debug)]
pub enum Task {
    /// `ferrode-view render`
    Render(Box<RenderArgs>),
    /// `ferrode-view view` and `ferrode-view replay`
    View(Box<ViewArgs>),
    /// `ferrode-view demo` without a name
    List,
    /// `ferrode-view gallery`
    Gallery(PathBuf),
}

/// Switches an overlay on.
type Switch = fn(&mut Overlays);

/// Names of overlays on the command line, and what they switch on.
const OVERLAYS: [(&str, Switch); 10] = [
    ("contacts", |o| o.contacts = true),
    ("forces", |o| o.forces = true),
    ("joints", |o| o.joints = true),
    ("joint-forces", |o| o.joint_forces = true),
    ("centres", |o| o.centres = true),
    ("inertia", |o| o.inertia = true),
    ("boxes", |o| o.boxes = true),
    ("tree", |o| o.tree = true),
    ("names", |o| o.names = true),
    ("time", |o| o.time = true),
];

fn number(text: &str) -> Result<f64, String> {
    text.trim().parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(|| "expected a number".to_owned())
}

fn positive(text: &str) -> Result<f64, String> {
    number(text).ok().filter(|x| *x > 0.0).ok_or_else(|| "expected a number above 0".to_owned())
}

fn not_negative(text: &str) -> Result<f64, String> {
    number(text).ok().filter(|x| *x >= 0.0).ok_or_else(|| "expected a number of at least 0".to_owned())
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let expected = || "expected WIDTHxHEIGHT, such as 1280x720".to_owned();
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(expected)?;
    let side = |text: &str| text.trim().parse::<u32>().ok().filter(|side| *side > 0).ok_or_else(expected);
    Ok([side(width)?, side(height)?])
}

fn overlay(text: &str) -> Result<usize, String> {
    OVERLAYS.iter().position(|(name, _)| *name == text).ok_or_else(|| {
        let names: Vec<&str> = OVERLAYS.iter().map(|(name, _)| *name).collect();
        format!("expected one of {}", names.join(", "))
    })
}

fn coloring(text: &str) -> Result<Coloring, String> {
    match text {
        "bodies" => Ok(Coloring::Bodies),
        "sleep" => Ok(Coloring::Sleep),
        "islands" => Ok(Coloring::Islands),
        _ => Err("expected bodies, sleep or islands".to_owned()),
    }
}

fn known_demo(text: &str) -> Result<&'static Demo, String> {
    ferrode_demos::find(text).ok_or_else(|| "no demo is called that; `ferrode demo` lists them".to_owned())
}

/// Switches on the overlay of a name, if there is one.
pub(crate) fn switch_on(overlays: &mut Overlays, name: &str) {
    if let Ok(index) = overlay(name) {
        OVERLAYS[index].1(overlays);
    }
}

fn stepper(text: &str) -> Result<Stepper, String> {
    match text {
        "direct" => Ok(Stepper::Direct),
        "quick" => Ok(Stepper::Quick),
        "substep" => Ok(Stepper::Substep),
        _ => Err("expected direct, quick or substep".to_owned()),
    }
}

fn option(name: &'static str, value: &'static str, help: &'static str) -> Arg {
    Arg::new(name).long(name).value_name(value).help(help)
}

fn flag(name: &'static str, help: &'static str) -> Arg {
    Arg::new(name).long(name).action(ArgAction::SetTrue).help(help)
}

fn world_args(command: Command) -> Command {
    command
        .arg(
            Arg::new("file")
                .value_name("FILE")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("SDF world or model, or URDF robot"),
        )
        .arg(flag("strict", "Stop at what is not understood or looks like a mistake"))
        .arg(
            option(
                "model-path",
                "DIR",
                "Folder to look in for model:// and package:// names; may be repeated",
            )
            .action(ArgAction::Append)
            .value_parser(value_parser!(PathBuf)),
        )
        .arg(flag("ground", "Add the plane z = 0 to stand on"))
        .arg(
            option("fix", "LINK", "Fix a link to the world where it starts; may be repeated")
                .action(ArgAction::Append),
        )
        .arg(option("dt", "H", "Step size in seconds [default: the file's]").value_parser(positive))
        .arg(
            option("stepper", "NAME", "direct, quick or substep, in place of the file's")
                .value_parser(stepper),
        )
}

fn picture_args(command: Command) -> Command {
    command
        .arg(
            option(
                "camera",
                "VIEW",
                "HEADING,PITCH in degrees (and a factor of the distance), or the eye's\n\
                 and the target's coordinates EX,EY,EZ,TX,TY,TZ [default: -58,20]",
            )
            .allow_hyphen_values(true)
            .value_parser(ViewPoint::parse),
        )
        .arg(option("size", "WxH", "Size in pixels [default: 1280x720]").value_parser(size))
        .arg(
            option(
                "show",
                "WHAT",
                "Show what bodies hide: contacts, forces, joints, joint-forces, centres,\n\
                 inertia, boxes, tree, and as text names, time; several with commas",
            )
            .action(ArgAction::Append)
            .value_delimiter(',')
            .value_parser(overlay),
        )
        .arg(
            option("colors", "BY", "Colour by bodies, sleep (who is awake) or islands [default: bodies]")
                .value_parser(coloring),
        )
}

fn window_args(command: Command) -> Command {
    let keys: Vec<String> = KEYS.iter().map(|(key, what)| format!("  {key:<14}{what}")).collect();
    picture_args(command)
        .arg(flag("paused", "Begin paused"))
        .arg(option("speed", "X", "Slower (0.2) or faster (3) than time [default: 1]").value_parser(positive))
        .arg(
            option("script", "FILE", "Do what a file says with keys and mouse (docs/viewer.md)")
                .value_parser(value_parser!(PathBuf)),
        )
        .arg(
            option("plot", "VALUE", "Plot a value, such as link.NAME.z or joint.NAME.force; may be repeated")
                .action(ArgAction::Append),
        )
        .arg(
            option("frames", "N", "Leave after so many frames, and print how long their parts took")
                .value_parser(value_parser!(u32).range(1..)),
        )
        .after_help(format!("Keys:\n{}", keys.join("\n")))
}

fn film_args(command: Command) -> Command {
    command
        .arg(
            Arg::new("out")
                .short('o')
                .long("out")
                .value_name("OUT")
                .value_parser(value_parser!(PathBuf))
                .help("out.png, out.gif, out.mp4, or a folder for numbered pictures"),
        )
        .arg(
            option(
                "time",
                "S",
                "The picture's moment, or the film's length [default: 0 and 5,\nor a demo's own]",
            )
            .value_parser(not_negative),
        )
        .arg(option("start", "S", "Where the film begins [default: 0]").value_parser(not_negative))
        .arg(option("fps", "N", "Frames a second [default: 30, GIF 20]").value_parser(positive))
        .arg(flag("draft", "Draw as windows do: quicker, with harder shadows"))
        .arg(flag("quiet", "No progress bar, no warnings").short('q'))
}

/// The grammar.
pub fn command() -> Command {
    let view = window_args(world_args(
        Command::new("view").about("Shows a world in a window while it is simulated"),
    ));
    let replay = window_args(Command::new("replay").about("Shows a recording of `ferrode run --record`"))
        .arg(
            Arg::new("recording")
                .value_name("RECORDING")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("out.jsonl or out.csv"),
        )
        .arg(
            Arg::new("world")
                .value_name("FILE")
                .value_parser(value_parser!(PathBuf))
                .help("The world that was recorded; without it, each link is a small box"),
        );
    let render = film_args(picture_args(world_args(
        Command::new("render").about("Draws a picture or a film, without a window"),
    )))
    .arg(option("speed", "X", "Slower (0.2) or faster (3) than time [default: 1]").value_parser(positive))
    .mut_arg("out", |out| out.required(true));
    let demo = film_args(window_args(
        Command::new("demo")
            .about("Shows a demo of the gallery in a window, or draws it; without a name, lists them"),
    ))
    .arg(
        Arg::new("name")
            .value_name("NAME")
            .value_parser(known_demo)
            .help("The demo; its own camera and moment are the defaults"),
    );
    let gallery = Command::new("gallery")
        .about("Draws all pictures of the documentation: of each demo, and of each joint for the book")
        .arg(
            Arg::new("docs")
                .value_name("DOCS")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("The folder that holds gallery.md, img/ and book/img/"),
        );
    Command::new("ferrode-view")
        .about("Shows SDF worlds and URDF robots as they are simulated")
        .version(env!("CARGO_PKG_VERSION"))
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand(view)
        .subcommand(render)
        .subcommand(replay)
        .subcommand(demo)
        .subcommand(gallery)
}

fn setup_of(m: &ArgMatches) -> Setup {
    Setup {
        file: m.get_one::<PathBuf>("file").cloned().unwrap_or_default(),
        strict: m.get_flag("strict"),
        model_path: m.get_many::<PathBuf>("model-path").unwrap_or_default().cloned().collect(),
        ground: m.get_flag("ground"),
        fix: m.get_many::<String>("fix").unwrap_or_default().cloned().collect(),
        dt: m.get_one("dt").copied(),
        stepper: m.get_one("stepper").copied(),
    }
}

fn overlays_of(m: &ArgMatches) -> Overlays {
    let mut overlays = Overlays::default();
    for index in m.get_many::<usize>("show").unwrap_or_default() {
        OVERLAYS[*index].1(&mut overlays);
    }
    overlays
}

fn coloring_of(m: &ArgMatches) -> Coloring {
    m.get_one("colors").copied().unwrap_or_default()
}

fn view_of(m: &ArgMatches, setup: Setup, recording: Option<PathBuf>) -> ViewArgs {
    ViewArgs {
        setup,
        demo: None,
        recording,
        view: m.get_one("camera").copied().unwrap_or_default(),
        size: m.get_one("size").copied().unwrap_or(SIZE),
        overlays: overlays_of(m),
        coloring: coloring_of(m),
        paused: m.get_flag("paused"),
        speed: m.get_one("speed").copied().unwrap_or(1.0),
        script: m.get_one::<PathBuf>("script").cloned(),
        plots: m.get_many::<String>("plot").unwrap_or_default().cloned().collect(),
        frames: m.get_one::<u32>("frames").copied(),
    }
}

fn render_of(m: &ArgMatches, setup: Setup, out: PathBuf) -> RenderArgs {
    let moves = crate::film::Format::of(&out).is_some_and(crate::film::Format::moves);
    RenderArgs {
        setup,
        demo: None,
        time: m.get_one("time").copied().unwrap_or(if moves { 5.0 } else { 0.0 }),
        start: m.get_one("start").copied().unwrap_or(0.0),
        rate: m.get_one("fps").copied(),
        speed: m.get_one("speed").copied().unwrap_or(1.0),
        view: m.get_one("camera").copied().unwrap_or_default(),
        size: m.get_one("size").copied().unwrap_or(SIZE),
        overlays: overlays_of(m),
        coloring: coloring_of(m),
        draft: m.get_flag("draft"),
        quiet: m.get_flag("quiet"),
        out,
    }
}

fn demo_of(m: &ArgMatches) -> Task {
    let Some(&demo) = m.get_one::<&'static Demo>("name") else { return Task::List };
    let view = m.get_one("camera").copied().unwrap_or_else(|| demo::view_point(demo));
    let mut overlays = demo::overlays(demo);
    for index in m.get_many::<usize>("show").unwrap_or_default() {
        OVERLAYS[*index].1(&mut overlays);
    }
    let demo_itself = Some(demo);
    let Some(out) = m.get_one::<PathBuf>("out").cloned() else {
        let args = view_of(m, Setup::default(), None);
        return Task::View(Box::new(ViewArgs { demo: demo_itself, view, overlays, ..args }));
    };
    let args = render_of(m, Setup::default(), out);
    let moves = crate::film::Format::of(&args.out).is_some_and(crate::film::Format::moves);
    let usual = if moves { demo.seconds } else { demo.picture_at };
    let time = m.get_one("time").copied().unwrap_or(usual);
    Task::Render(Box::new(RenderArgs { demo: demo_itself, view, overlays, time, ..args }))
}

const SIZE: [u32; 2] = [1280, 720];

/// Reads a command line.
///
/// # Errors
/// It cannot be followed, or asks for help.
pub fn parse(
    line: impl IntoIterator<Item = impl Into<std::ffi::OsString> + Clone>,
) -> Result<Task, clap::Error> {
    let matches = command().try_get_matches_from(line)?;
    match matches.subcommand() {
        Some(("render", m)) => {
            let out = m.get_one::<PathBuf>("out").cloned().unwrap_or_default();
            Ok(Task::Render(Box::new(render_of(m, setup_of(m), out))))
        }
        Some(("demo", m)) => Ok(demo_of(m)),
        Some(("gallery", m)) => Ok(Task::Gallery(m.get_one::<PathBuf>("docs").cloned().unwrap_or_default())),
        Some(("view", m)) => Ok(Task::View(Box::new(view_of(m, setup_of(m), None)))),
        Some(("replay", m)) => {
            let file = m.get_one::<PathBuf>("world").cloned().unwrap_or_default();
            let recording = m.get_one::<PathBuf>("recording").cloned();
            Ok(Task::View(Box::new(view_of(m, Setup { file, ..Setup::default() }, recording))))
        }
        _ => Err(command().error(clap::error::ErrorKind::MissingSubcommand, "nothing to do")),
    }
}
