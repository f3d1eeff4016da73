//! The command line: what can be asked for.

use crate::exit::EXIT_CODES;
use clap::{Arg, ArgAction, ArgGroup, ArgMatches, Command, value_parser};
use ferrode::Stepper;
use std::path::PathBuf;

/// What to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Task {
    /// `ferrode run`
    Run(RunArgs),
    /// `ferrode check`
    Check(FileArgs),
    /// `ferrode compare`
    Compare(CompareArgs),
    /// `ferrode view`, `ferrode render`, `ferrode replay` or `ferrode demo NAME`, with the arguments for the viewer.
    Viewer(&'static str, Vec<std::ffi::OsString>),
    /// `ferrode demo`
    Demo(DemoArgs),
}

/// The file, and how to read it.
#[derive(Clone, Debug, PartialEq)]
pub struct FileArgs {
    /// SDF or URDF.
    pub file: PathBuf,
    /// Warnings are errors.
    pub strict: bool,
    /// Folders that hold models.
    pub model_path: Vec<PathBuf>,
}

/// What to do to the file's world before it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupArgs {
    /// Adds a plane z = 0.
    pub ground: bool,
    /// Lifts everything that can move, m; `None`: on the ground plane, if that is asked for.
    pub height: Option<f64>,
    /// Links to fix to the world.
    pub fix: Vec<String>,
    /// Stiffness and damping that hold joints where they start.
    pub hold: Option<[f64; 2]>,
    /// Step size in place of the file's, s.
    pub dt: Option<f64>,
}

/// How long to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// Simulated seconds.
    Time(f64),
    /// Steps.
    Steps(u64),
}

impl Length {
    /// In whole steps of `h` seconds: to the nearest, but at least one for a positive time.
    pub fn steps(self, h: f64) -> u64 {
        match self {
            Self::Steps(steps) => steps,
            Self::Time(time) => ((time / h).round() as u64).max(u64::from(time > 0.0)),
        }
    }
}

/// `ferrode run`
#[derive(Clone, Debug, PartialEq)]
pub struct RunArgs {
    /// The file, and how to read it.
    pub file: FileArgs,
    /// What to do to it.
    pub setup: SetupArgs,
    /// How long to run.
    pub length: Length,
    /// In place of the file's stepper.
    pub stepper: Option<Stepper>,
    /// Threads for the stepper; 0 for as many as the machine has.
    pub threads: usize,
    /// Whether each step of `direct` ends with the joints closed.
    pub project: bool,
    /// Whether impacts of `direct` follow each other, pair after pair.
    pub in_turn: bool,
    /// Where to record to.
    pub record: Option<PathBuf>,
    /// Record each so many steps.
    pub every: u64,
    /// The summary as JSON.
    pub json: bool,
    /// Neither progress nor summary.
    pub quiet: bool,
}

/// `ferrode compare`
#[derive(Clone, Debug, PartialEq)]
pub struct CompareArgs {
    /// The file, and how to read it.
    pub file: FileArgs,
    /// What to do to it.
    pub setup: SetupArgs,
    /// How long to run.
    pub length: Length,
    /// The table as JSON.
    pub json: bool,
    /// No progress.
    pub quiet: bool,
}

/// `ferrode demo` without pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct DemoArgs {
    /// The one to run; none to list them.
    pub name: Option<String>,
    /// All of them.
    pub all: bool,
}

/// The steppers by the names they have here.
pub const STEPPERS: [(&str, Stepper); 3] =
    [("direct", Stepper::Direct), ("quick", Stepper::Quick), ("substep", Stepper::Substep)];

/// The name of a stepper.
pub fn stepper_name(stepper: Stepper) -> &'static str {
    STEPPERS.iter().find(|(_, known)| *known == stepper).map_or("another", |(name, _)| name)
}

const DEFAULT_SECONDS: f64 = 5.0;

/// Gains of `--hold` without a value: a robot of some tens of kilograms stands up straight with them.
const DEFAULT_GAINS: &str = "1000,30";

const DEMO_EXAMPLES: &str = "\
Examples:
  ferrode demo                                    what there is, one demo a line
  ferrode demo walker                             in a window
  ferrode demo walker -o walker.png --time 4      a picture (or walker.mp4)
  ferrode demo walker --headless                  without pictures: does it do what it should?
  ferrode demo --all --headless                   do all of them?";

const EXAMPLES: &str = "\
Examples:
  ferrode run worlds/workshop.sdf                         five seconds, then a summary
  ferrode run arm.urdf --fix base --hold 200,10           a robot that holds its pose
  ferrode run anymal.urdf --ground --hold 300,10 --time 10  a robot that stands
  ferrode run world.sdf --record out.csv --every 10       places and velocities, each tenth step
  ferrode run world.sdf --json | jq .real_time_factor
  ferrode check world.sdf                                 is the file right, and what is in it?
  ferrode compare world.sdf                               which stepper suits this world?
  ferrode demo --all --headless                           does all of the gallery do what it should?";

fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err("expected a number".to_owned()),
    }
}

/// A step size: also its reciprocal must be a number.
fn step_size(text: &str) -> Result<f64, String> {
    let usable = |value: &f64| *value > 0.0 && value.recip().is_finite();
    number(text).ok().filter(usable).ok_or_else(|| "expected a number of seconds above 0".to_owned())
}

fn not_negative(text: &str) -> Result<f64, String> {
    number(text)
        .ok()
        .filter(|value| *value >= 0.0)
        .ok_or_else(|| "expected a number of at least 0".to_owned())
}

fn gains(text: &str) -> Result<[f64; 2], String> {
    let expected = || "expected KP,KD: two numbers of at least 0, not both 0, such as 200,10".to_owned();
    let (kp, kd) = text.split_once(',').ok_or_else(expected)?;
    let gains = [not_negative(kp).map_err(|_| expected())?, not_negative(kd).map_err(|_| expected())?];
    if gains == [0.0; 2] { Err(expected()) } else { Ok(gains) }
}

fn recording(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match crate::record::Format::of(&path) {
        Some(_) => Ok(path),
        None if crate::record::is_rerun(&path) => {
            Err("this ferrode cannot write .rrd; built with `--features rerun`, it can".to_owned())
        }
        None => Err("the name must end in .csv, .jsonl or .rrd, which says how to write it".to_owned()),
    }
}

fn file_args(command: Command) -> Command {
    command
        .arg(
            Arg::new("file")
                .value_name("FILE")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("SDF world or model, or URDF robot"),
        )
        .arg(
            Arg::new("strict")
                .long("strict")
                .action(ArgAction::SetTrue)
                .help("Stop at what is not understood or looks like a mistake,\ninstead of warning of it"),
        )
        .arg(
            Arg::new("model-path")
                .long("model-path")
                .value_name("DIR")
                .action(ArgAction::Append)
                .value_parser(value_parser!(PathBuf))
                .help(
                    "Folder to look in for model:// and package:// names; may be repeated.\n\
                     Those of GZ_SIM_RESOURCE_PATH and GAZEBO_MODEL_PATH come next",
                ),
        )
}

fn setup_args(command: Command) -> Command {
    command
        .arg(
            Arg::new("time")
                .long("time")
                .value_name("S")
                .value_parser(not_negative)
                .help("Simulated seconds to run [default: 5]"),
        )
        .arg(
            Arg::new("steps")
                .long("steps")
                .value_name("N")
                .value_parser(value_parser!(u64))
                .help("Steps to run, instead of a time"),
        )
        .group(ArgGroup::new("length").args(["time", "steps"]))
        .arg(
            Arg::new("dt")
                .long("dt")
                .value_name("H")
                .value_parser(step_size)
                .help("Step size in seconds\n[default: the file's, else 0.001 for SDF and 0.0005 for URDF]"),
        )
        .arg(
            Arg::new("ground")
                .long("ground")
                .action(ArgAction::SetTrue)
                .help("Add the plane z = 0 to stand on"),
        )
        .arg(
            Arg::new("height")
                .long("height")
                .value_name("Z")
                .value_parser(number)
                .allow_negative_numbers(true)
                .help(
                    "Lift everything that can move by Z metres before the start [default: 0;\n\
                     with --ground, as far as it takes for nothing to start below the ground]",
                ),
        )
        .arg(
            Arg::new("fix")
                .long("fix")
                .value_name("LINK")
                .action(ArgAction::Append)
                .help("Fix a link to the world where it starts; may be repeated"),
        )
        .arg(
            Arg::new("hold")
                .long("hold")
                .value_name("KP,KD")
                .value_parser(gains)
                .num_args(0..=1)
                .default_missing_value(DEFAULT_GAINS)
                .allow_hyphen_values(false)
                .help(
                    "Hold each joint where it starts by its motor, like a spring of\n\
                     KP N·m/rad (N/m) and a damper of KD N·m·s/rad (N·s/m), with no\n\
                     more force than the file allows (effort); without gains, 1000,30",
                ),
        )
}

fn output_args(command: Command) -> Command {
    command
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print the result as JSON"))
        .arg(
            Arg::new("quiet")
                .long("quiet")
                .short('q')
                .action(ArgAction::SetTrue)
                .help("Print errors only (and what --json asks for)"),
        )
}

/// The viewer's commands, which it reads the arguments of by itself.
const VIEWER: [(&str, &str); 3] = [
    ("view", "Show a world in a window while it is simulated"),
    ("render", "Draw a picture or a film of a world, without a window"),
    ("replay", "Show a recording made with `run --record`"),
];

fn viewer_command((name, about): (&'static str, &'static str)) -> Command {
    let arguments = Arg::new("arguments")
        .num_args(0..)
        .trailing_var_arg(true)
        .allow_hyphen_values(true)
        .value_parser(value_parser!(std::ffi::OsString));
    Command::new(name).about(about).disable_help_flag(true).arg(arguments)
}

/// The command line's grammar.
pub fn command() -> Command {
    let run = Command::new("run")
        .about("Simulate a world or robot, and say how it went")
        .after_help(EXIT_CODES)
        .arg(
            Arg::new("stepper")
                .long("stepper")
                .value_name("NAME")
                .value_parser(STEPPERS.map(|(name, _)| name))
                .hide_possible_values(true)
                .help("direct: exact, for mechanisms; quick: iterative, for crowds\n[default: the file's, else quick]"),
        )
        .arg(
            Arg::new("threads")
                .long("threads")
                .value_name("N")
                .value_parser(value_parser!(u16))
                .default_value("1")
                .help("Threads for the steppers substep and direct, 0 for all of the machine's; results are the same"),
        )
        .arg(
            Arg::new("project")
                .long("project")
                .action(ArgAction::SetTrue)
                .help("With the stepper direct: bodies end each step where their joints hold together"),
        )
        .arg(
            Arg::new("in-turn")
                .long("in-turn")
                .action(ArgAction::SetTrue)
                .help("With the stepper direct: what bounces does so in turn, the fastest pair first, and not all at once"),
        )
        .arg(
            Arg::new("record").long("record").value_name("OUT").value_parser(recording).help(
                "Write places and velocities of links and joints to OUT.csv,\nor to OUT.jsonl (a JSON object a line), or for Rerun to OUT.rrd\n(if built with the feature rerun)",
            ),
        )
        .arg(
            Arg::new("every")
                .long("every")
                .value_name("N")
                .requires("record")
                .value_parser(value_parser!(u64).range(1..))
                .default_value("1")
                .help("Record each N-th step"),
        );
    let check = Command::new("check")
        .about("Read a file, say what is wrong with it, and print its tree of links and joints")
        .after_help(EXIT_CODES);
    let compare = Command::new("compare")
        .about("Run a world with each stepper, and set their times and errors side by side")
        .after_help(EXIT_CODES);
    let demo = Command::new("demo")
        .about("Show a scene of the gallery, or list them, or check the physical property that each shows")
        .after_help(format!("{DEMO_EXAMPLES}\n\n{EXIT_CODES}"))
        .arg(Arg::new("name").value_name("NAME").help("The demo to show; without a name they are listed"))
        .arg(
            Arg::new("arguments")
                .value_name("OPTIONS")
                .num_args(0..)
                .trailing_var_arg(true)
                .allow_hyphen_values(true)
                .value_parser(value_parser!(std::ffi::OsString))
                .help("For the viewer: see `ferrode-view demo --help`"),
        )
        .arg(
            Arg::new("all")
                .long("all")
                .action(ArgAction::SetTrue)
                .conflicts_with("name")
                .help("Run all demos without pictures, and check each one's property"),
        )
        .arg(
            Arg::new("headless")
                .long("headless")
                .action(ArgAction::SetTrue)
                .help("Run the demo without pictures, and check its property"),
        );
    Command::new("ferrode")
        .about("Rigid-body dynamics from the command line: runs SDF worlds and URDF robots.")
        .version(env!("CARGO_PKG_VERSION"))
        .long_version(crate::version::long())
        .after_help(format!("{EXAMPLES}\n\n{EXIT_CODES}"))
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand(output_args(setup_args(file_args(run))))
        .subcommand(file_args(check))
        .subcommand(output_args(setup_args(file_args(compare))))
        .subcommands(VIEWER.map(viewer_command))
        .subcommand(demo)
}

/// Reads a command line, the program's name first.
///
/// # Errors
/// What `clap` finds wrong with it, or the help or version that was asked for.
pub fn parse<I>(line: I) -> Result<Task, clap::Error>
where
    I: IntoIterator,
    I::Item: Into<std::ffi::OsString> + Clone,
{
    let matches = command().try_get_matches_from(line)?;
    Ok(match matches.subcommand() {
        Some(("check", m)) => Task::Check(file_of(m)),
        Some(("compare", m)) => Task::Compare(CompareArgs {
            file: file_of(m),
            setup: setup_of(m),
            length: length_of(m),
            json: m.get_flag("json"),
            quiet: m.get_flag("quiet"),
        }),
        Some((name, m)) if VIEWER.iter().any(|(known, _)| *known == name) => {
            let known = VIEWER.iter().find(|(known, _)| *known == name).map_or("view", |(known, _)| known);
            let arguments = m.get_many::<std::ffi::OsString>("arguments").unwrap_or_default();
            Task::Viewer(known, arguments.cloned().collect())
        }
        Some(("demo", m)) => demo_of(m)?,
        Some(("run", m)) => {
            let stepper = m.get_one::<String>("stepper");
            Task::Run(RunArgs {
                file: file_of(m),
                setup: setup_of(m),
                length: length_of(m),
                stepper: stepper.and_then(|given| {
                    STEPPERS.iter().find(|(name, _)| name == given).map(|(_, stepper)| *stepper)
                }),
                threads: m.get_one::<u16>("threads").copied().unwrap_or(1).into(),
                project: m.get_flag("project"),
                in_turn: m.get_flag("in-turn"),
                record: m.get_one::<PathBuf>("record").cloned(),
                every: m.get_one("every").copied().unwrap_or(1),
                json: m.get_flag("json"),
                quiet: m.get_flag("quiet"),
            })
        }
        _ => return Err(command().error(clap::error::ErrorKind::MissingSubcommand, "nothing to do")),
    })
}

/// A demo by name is shown, unless it is to run headless; what the viewer is told may come before that word.
fn demo_of(m: &ArgMatches) -> Result<Task, clap::Error> {
    let name = m.get_one::<String>("name").cloned();
    let given = m.get_many::<std::ffi::OsString>("arguments").unwrap_or_default();
    let (own, arguments): (Vec<_>, Vec<_>) =
        given.cloned().partition(|argument| argument == "--headless" || argument == "--all");
    let wrong = |what: &str| command().error(clap::error::ErrorKind::ArgumentConflict, what);
    if own.iter().any(|argument| argument == "--all") {
        return Err(wrong("--all is for all demos: leave out the name"));
    }
    let headless = m.get_flag("headless") || !own.is_empty();
    match name {
        Some(name) if !headless => {
            Ok(Task::Viewer("demo", std::iter::once(name.into()).chain(arguments).collect()))
        }
        _ if !arguments.is_empty() => Err(wrong("a demo that runs without pictures has no further options")),
        name => Ok(Task::Demo(DemoArgs { name, all: m.get_flag("all") })),
    }
}

fn file_of(m: &ArgMatches) -> FileArgs {
    FileArgs {
        file: m.get_one::<PathBuf>("file").cloned().unwrap_or_default(),
        strict: m.get_flag("strict"),
        model_path: m.get_many::<PathBuf>("model-path").unwrap_or_default().cloned().collect(),
    }
}

fn setup_of(m: &ArgMatches) -> SetupArgs {
    SetupArgs {
        ground: m.get_flag("ground"),
        height: m.get_one("height").copied(),
        fix: m.get_many::<String>("fix").unwrap_or_default().cloned().collect(),
        hold: m.get_one("hold").copied(),
        dt: m.get_one("dt").copied(),
    }
}

fn length_of(m: &ArgMatches) -> Length {
    match m.get_one::<u64>("steps") {
        Some(&steps) => Length::Steps(steps),
        None => Length::Time(m.get_one("time").copied().unwrap_or(DEFAULT_SECONDS)),
    }
}

#[cfg(test)]
mod tests {
    use super::{DemoArgs, Length, Task, command, parse};
    use ferrode::Stepper;

    #[test]
    fn the_grammar_is_sound() {
        command().debug_assert();
    }

    #[test]
    fn everything_is_taken_over() {
        let line = "ferrode run a.sdf --steps 7 --dt 2e-3 --stepper direct --project --in-turn --threads 3 --record o.csv --every 3 --ground \
                    --height -0.5 --fix base --fix tip --hold 20,0.5 --json --quiet --strict --model-path m";
        let Task::Run(run) = parse(line.split_whitespace()).unwrap() else { panic!("another task") };
        assert_eq!(run.length, Length::Steps(7));
        assert_eq!((run.stepper, run.threads), (Some(Stepper::Direct), 3));
        assert!(run.project && run.in_turn);
        assert_eq!((run.setup.dt, run.setup.height, run.setup.ground), (Some(0.002), Some(-0.5), true));
        assert_eq!((run.setup.fix.len(), run.setup.hold), (2, Some([20.0, 0.5])));
        assert_eq!((run.every, run.json, run.quiet, run.file.strict), (3, true, true, true));
        assert_eq!(run.record.unwrap().to_str(), Some("o.csv"));
        let Task::Run(run) = parse(["ferrode", "run", "a.sdf"]).unwrap() else { panic!("another task") };
        assert_eq!((run.length, run.stepper, run.every, run.threads), (Length::Time(5.0), None, 1, 1));
        assert!(!run.project && !run.in_turn);
    }

    #[test]
    fn the_viewers_arguments_are_handed_on_as_they_are() {
        let line = "ferrode render a.sdf -o out.png --camera -30,20 --help";
        let Task::Viewer(name, arguments) = parse(line.split_whitespace()).unwrap() else {
            panic!("another task")
        };
        let text: Vec<&str> = arguments.iter().filter_map(|argument| argument.to_str()).collect();
        assert_eq!((name, text.join(" ").as_str()), ("render", "a.sdf -o out.png --camera -30,20 --help"));
    }

    #[test]
    fn a_demo_is_shown_unless_it_is_headless() {
        let task = |line: &str| parse(line.split_whitespace());
        let Ok(Task::Viewer("demo", arguments)) = task("ferrode demo hinge -o out.png --camera -30,20")
        else {
            panic!("another task")
        };
        let text: Vec<&str> = arguments.iter().filter_map(|argument| argument.to_str()).collect();
        assert_eq!(text.join(" "), "hinge -o out.png --camera -30,20");
        let headless = |name: Option<&str>, all| Task::Demo(DemoArgs { name: name.map(str::to_owned), all });
        for (line, want) in [
            ("ferrode demo", headless(None, false)),
            ("ferrode demo hinge --headless", headless(Some("hinge"), false)),
            ("ferrode demo --headless hinge", headless(Some("hinge"), false)),
            ("ferrode demo --all --headless", headless(None, true)),
        ] {
            assert_eq!(task(line).unwrap(), want, "{line}");
        }
    }

    #[test]
    fn nonsense_is_refused() {
        for line in [
            "ferrode run",
            "ferrode run a.sdf --time -1",
            "ferrode run a.sdf --time nan",
            "ferrode run a.sdf --time 1 --steps 3",
            "ferrode run a.sdf --dt 0",
            "ferrode run a.sdf --dt 1e-320",
            "ferrode run a.sdf --hold 5",
            "ferrode run a.sdf --hold 0,0",
            "ferrode run a.sdf --hold 5,-1",
            "ferrode run a.sdf --record out.xls",
            "ferrode run a.sdf --record o.csv --every 0",
            "ferrode run a.sdf --every 2",
            "ferrode run a.sdf --stepper slow",
            "ferrode run a.sdf --threads -1",
            "ferrode run a.sdf --threads many",
            "ferrode fly a.sdf",
            "ferrode demo hinge --all",
            "ferrode demo hinge --headless -o out.png",
            "ferrode demo hinge -o out.png --headless",
        ] {
            assert!(parse(line.split_whitespace()).is_err(), "{line}");
        }
    }

    #[test]
    fn times_become_whole_steps() {
        assert_eq!(Length::Time(5.0).steps(0.001), 5000);
        assert_eq!(Length::Time(0.1).steps(0.03), 3);
        assert_eq!(Length::Time(1e-9).steps(0.001), 1);
        assert_eq!(Length::Time(0.0).steps(0.001), 0);
    }
}
