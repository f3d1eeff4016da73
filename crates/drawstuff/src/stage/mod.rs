//! Where frames go: to a window, or to a folder.

mod folder;
mod window;

use crate::fault::Outcome;
use crate::keys::Key;
use crate::state::State;
use crate::viewpoint::Drag;

pub use folder::FolderStage;
pub use window::WindowStage;

/// What hands did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Input {
    /// A key was pressed.
    Key(Key),
    /// The mouse was dragged by so many pixels to the right and down.
    Drag(Drag, f32, f32),
    /// The window was closed.
    Close,
}

/// Where frames go.
pub enum Stage {
    /// To a window.
    Window(Box<WindowStage>),
    /// To a folder.
    Folder(Box<FolderStage>),
}

impl Stage {
    /// What hands did since this was last asked.
    ///
    /// # Errors
    /// The window failed.
    pub fn input(&mut self) -> Outcome<Vec<Input>> {
        match self {
            Self::Window(window) => window.input(),
            Self::Folder(_) => Ok(Vec::new()),
        }
    }

    /// Shows the frame of a number; `write` asks for a picture file.
    ///
    /// # Errors
    /// The driver failed, or a file can't be written.
    pub fn show(&mut self, state: &mut State, frame: u64, write: bool) -> Outcome<()> {
        match self {
            Self::Window(window) => window.show(state, write),
            Self::Folder(folder) => folder.show(state, frame),
        }
    }
}
