//! GIF films.

use super::{Film, cannot_write, make_file};
use ferrode_render::Picture;
use gif::{Encoder, Frame, Repeat};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// A looping film.
pub struct Gif {
    path: PathBuf,
    encoder: Encoder<BufWriter<File>>,
    /// Seconds a frame.
    period: f64,
    count: u32,
}

impl Gif {
    pub fn create(path: &Path, size: [u32; 2], rate: f64) -> Result<Self, String> {
        let wrong = |error: &dyn std::fmt::Display| cannot_write(path, error);
        let side =
            |side: u32| u16::try_from(side).map_err(|_| wrong(&"a side of a GIF has at most 65535 pixels"));
        let (width, height) = (side(size[0])?, side(size[1])?);
        let file = make_file(&path.to_owned())?;
        let mut encoder = Encoder::new(file, width, height, &[]).map_err(|error| wrong(&error))?;
        encoder.set_repeat(Repeat::Infinite).map_err(|error| wrong(&error))?;
        Ok(Self { path: path.to_owned(), encoder, period: 1.0 / rate, count: 0 })
    }
}

impl Film for Gif {
    fn add(&mut self, picture: &Picture) -> Result<(), String> {
        // Delays are whole hundredths of a second: each frame gets those that keep the film in time.
        let hundredths = |n: u32| (f64::from(n) * self.period * 100.0).round() as u32;
        let delay = hundredths(self.count + 1) - hundredths(self.count);
        self.count += 1;
        let mut pixels = picture.pixels.clone();
        // Speed 10 of 1 (best colours) to 30.
        let mut frame = Frame::from_rgba_speed(picture.width as u16, picture.height as u16, &mut pixels, 10);
        frame.delay = u16::try_from(delay).unwrap_or(u16::MAX);
        self.encoder.write_frame(&frame).map_err(|error| cannot_write(&self.path, error))
    }

    fn finish(self: Box<Self>) -> Result<(), String> {
        let mut file = self.encoder.into_inner().map_err(|error| cannot_write(&self.path, error))?;
        file.flush().map_err(|error| cannot_write(&self.path, error))
    }
}
