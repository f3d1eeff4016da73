//! What all functions share.

use crate::clock::Clock;
use crate::drawing::Drawing;
use crate::fault::{self, Outcome};
use crate::viewpoint::Viewpoint;
use std::sync::{LazyLock, Mutex, PoisonError};

/// Where the loop is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Not in it.
    Outside,
    /// In it, between frames, at its start or end.
    Inside,
    /// In a frame: things can be drawn.
    Frame,
}

/// What all functions share.
#[derive(Debug)]
pub struct State {
    /// Where the loop is.
    pub phase: Phase,
    /// The program asked to leave the loop.
    pub stop: bool,
    /// The camera.
    pub view: Viewpoint,
    /// Time.
    pub clock: Clock,
    /// The frame.
    pub drawing: Drawing,
    warned: bool,
}

static STATE: LazyLock<Mutex<State>> = LazyLock::new(|| {
    Mutex::new(State {
        phase: Phase::Outside,
        stop: false,
        view: Viewpoint::START,
        clock: Clock::Wall { asked: None },
        drawing: Drawing::new(),
        warned: false,
    })
});

/// Looks at or changes the state. Nothing of the program's may be called meanwhile.
pub fn with<T>(work: impl FnOnce(&mut State) -> T) -> T {
    work(&mut STATE.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Adds to the frame; says so once if there is none.
pub fn draw(work: impl FnOnce(&mut Drawing)) -> Outcome<()> {
    let warn = with(|state| {
        if state.phase == Phase::Frame {
            work(&mut state.drawing);
            return false;
        }
        !std::mem::replace(&mut state.warned, true)
    });
    if warn {
        fault::warn("what is drawn outside of the step callback is not shown");
    }
    Ok(())
}
