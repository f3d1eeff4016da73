//! The loop's own state: what it is between two calls of the program's functions.

use crate::clock::Clock;
use crate::environment::Environment;
use crate::fault::{Fault, Outcome, say};
use crate::keys::Key;
use crate::options::Options;
use crate::stage::{FolderStage, Input, Stage, WindowStage};
use crate::state::{Phase, with};
use crate::switches::{Switches, Wish};
use core::ffi::c_int;
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::mem::ManuallyDrop;
use std::time::Instant;

struct Session {
    stage: Stage,
    switches: Switches,
    environment: Environment,
    /// Characters for the program.
    commands: VecDeque<c_int>,
    /// Frames that are over.
    frame: u64,
}

thread_local! {
    /// Loops that have begun.
    static LOOPS: Cell<u32> = const { Cell::new(0) };
    /// Not on the stack, so that a program may jump over it; not dropped by a program's `exit`, when drivers may be gone.
    static SESSION: RefCell<ManuallyDrop<Option<Session>>> = const { RefCell::new(ManuallyDrop::new(None)) };
}

fn session<T>(work: impl FnOnce(&mut Session) -> Outcome<T>) -> Outcome<T> {
    SESSION.with_borrow_mut(|session| match session.as_mut() {
        Some(session) => work(session),
        None => Err(Fault::misuse("a loop that has ended, or belongs to another thread,")),
    })
}

const HELP: &str = "\
drawstuff: keys and mouse
  Ctrl-P  pause, and go on          Ctrl-O  one step while paused
  Ctrl-T  textures                  Ctrl-S  shadows
  Ctrl-V  print the viewpoint       Ctrl-W  write pictures to the folder \"frame\"
  Ctrl-X  exit                      other keys go to the program
  drag    left: look around; right: walk; middle, or left and right: sideways and up
options: -notex -noshadow -pause -texturepath DIR
";

/// The largest window that is asked for, pixels a side.
const LARGEST: i32 = 16_384;

/// Begins: opens a window, or a folder.
///
/// # Errors
/// The loop runs already; the environment makes no sense; there is no display, no driver, no folder.
pub fn begin(arguments: &[String], width: c_int, height: c_int, title: &str) -> Outcome<()> {
    if with(|state| state.phase) != Phase::Outside {
        return Err(Fault::misuse("a second loop inside the first"));
    }
    let mut environment = Environment::read(|name| std::env::var(name).ok())?;
    let asked = [width, height].map(|side| side.clamp(1, LARGEST).unsigned_abs());
    let size = environment.size.unwrap_or(asked);
    // A program that loops again keeps what it drew before.
    if let (Some(headless), earlier @ 1..) = (&mut environment.headless, LOOPS.get()) {
        headless.folder.push(format!("loop-{}", earlier + 1));
    }
    let stage = match &environment.headless {
        Some(headless) => Stage::Folder(Box::new(FolderStage::open(headless, size, environment.every)?)),
        None => Stage::Window(Box::new(WindowStage::open(title, size)?)),
    };
    match &environment.headless {
        Some(headless) => say(&format!("drawstuff: frames go to {}\n", headless.folder.display())),
        None => say(HELP),
    }
    with(|state| {
        state.phase = Phase::Inside;
        state.stop = false;
        let headless = environment.headless.as_ref();
        state.drawing.noted = headless.is_some_and(|headless| headless.text);
        state.drawing.shown = headless.is_none_or(|headless| headless.pictures);
        state.clock = match headless {
            Some(_) => Clock::Frames { step: environment.step, begun: 0, asked: 0 },
            None => Clock::Wall { asked: Some(Instant::now()) },
        };
    });
    LOOPS.set(LOOPS.get() + 1);
    let switches = Switches::new(Options::parse(arguments));
    let session = Session { stage, switches, environment, commands: VecDeque::new(), frame: 0 };
    SESSION.with_borrow_mut(|place| **place = Some(session));
    Ok(())
}

/// Begins a frame, unless the loop is to end.
///
/// # Errors
/// The window failed.
pub fn begin_frame() -> Outcome<bool> {
    session(|session| {
        let Session { environment, switches, frame, commands, .. } = session;
        if environment.frames.is_some_and(|frames| *frame >= frames) || with(|state| state.stop) {
            return Ok(false);
        }
        let planned = environment.keys.iter().filter(|(when, _)| when == frame);
        let mut inputs: Vec<Input> = planned.map(|(_, key)| Input::Key(*key)).collect();
        inputs.extend(session.stage.input()?);
        for input in inputs {
            match input {
                Input::Key(key) => press(switches, commands, key),
                Input::Drag(how, right, down) => with(|state| state.view.drag(how, right, down)),
                Input::Close => switches.stop = true,
            }
        }
        if switches.stop {
            return Ok(false);
        }
        with(|state| {
            state.phase = Phase::Frame;
            state.clock.begin_frame();
            state.drawing.begin(switches);
        });
        Ok(true)
    })
}

fn press(switches: &mut Switches, commands: &mut VecDeque<c_int>, key: Key) {
    match switches.press(key) {
        Wish::Nothing => {}
        Wish::Command(sign) => commands.push_back(sign),
        Wish::Viewpoint => {
            let view = with(|state| state.view);
            let [x, y, z] = view.xyz;
            let [h, p, r] = view.hpr;
            say(&format!(
                "viewpoint: xyz {{{x:.4}f, {y:.4}f, {z:.4}f}}, hpr {{{h:.4}f, {p:.4}f, {r:.4}f}}\n"
            ));
        }
    }
}

/// The next character for the program.
///
/// # Errors
/// There is no loop.
pub fn next_command() -> Outcome<Option<c_int>> {
    session(|session| Ok(session.commands.pop_front()))
}

/// Whether this frame is a paused one; asked once a frame.
///
/// # Errors
/// There is no loop.
pub fn pause() -> Outcome<bool> {
    session(|session| Ok(session.switches.pause_of_frame()))
}

/// Ends a frame: shows it.
///
/// # Errors
/// The driver failed, or a file can't be written.
pub fn end_frame() -> Outcome<()> {
    session(|session| {
        let Session { stage, frame, switches, .. } = session;
        with(|state| {
            state.phase = Phase::Inside;
            stage.show(state, *frame, switches.writing)
        })?;
        *frame += 1;
        Ok(())
    })
}

/// Ends: closes the window.
///
/// # Errors
/// None.
pub fn end() -> Outcome<()> {
    let session = SESSION.with_borrow_mut(|place| place.take());
    if let Some(Session { stage: Stage::Window(window), .. }) = session {
        window.close();
    }
    with(|state| (state.phase, state.stop) = (Phase::Outside, false));
    Ok(())
}
