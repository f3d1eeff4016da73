//! Frames as pictures and as text, without a display.

use crate::environment::Headless;
use crate::fault::{Fault, Outcome};
use crate::note;
use crate::picture_file;
use crate::state::State;
use ferrode_render::{Canvas, Quality};
use std::io::Write;
use std::path::PathBuf;

/// A folder for frames: `00000.png`, … and `calls.txt`.
pub struct FolderStage {
    folder: PathBuf,
    canvas: Option<Canvas>,
    every: u64,
    text: Option<std::io::BufWriter<std::fs::File>>,
}

const TEXT: &str = "calls.txt";

impl FolderStage {
    /// Creates the folder; opens a driver if pictures are wanted.
    ///
    /// # Errors
    /// The folder can't be written to; there is no driver.
    pub fn open(headless: &Headless, size: [u32; 2], every: u64) -> Outcome<Self> {
        let folder = headless.folder.clone();
        picture_file::folder(&folder)?;
        let canvas = match headless.pictures {
            true => Some(Canvas::new(size[0], size[1], Quality::live()).map_err(Fault::circumstance)?),
            false => None,
        };
        let text = match headless.text {
            true => {
                let path = folder.join(TEXT);
                let file = std::fs::File::create(&path).map_err(|error| {
                    Fault::circumstance(format!("cannot write {}: {error}", path.display()))
                })?;
                Some(std::io::BufWriter::new(file))
            }
            false => None,
        };
        Ok(Self { folder, canvas, every, text })
    }

    /// Writes a frame.
    ///
    /// # Errors
    /// The driver failed, or a file can't be written.
    pub fn show(&mut self, state: &mut State, frame: u64) -> Outcome<()> {
        if let Some(file) = &mut self.text {
            let mut head = format!("frame {frame}\n");
            note::line(&mut head, "view", &[("from", &state.view.xyz), ("angles", &state.view.hpr)], "");
            let written = file.write_all(head.as_bytes());
            // Flushed each time: the program may leave by `exit` at any moment.
            let written = written.and_then(|()| file.write_all(state.drawing.text().as_bytes()));
            written
                .and_then(|()| file.flush())
                .map_err(|error| Fault::circumstance(format!("cannot write {TEXT}: {error}")))?;
        }
        if let Some(canvas) = &mut self.canvas
            && frame.is_multiple_of(self.every)
        {
            let camera = state.view.camera();
            let picture = canvas.draw(state.drawing.scene(), &camera).map_err(Fault::circumstance)?;
            picture_file::save(&self.folder.join(format!("{frame:05}.png")), &picture)?;
        }
        Ok(())
    }
}
