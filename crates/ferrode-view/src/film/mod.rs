//! Pictures to files: one PNG, a folder of them, a GIF or an MP4.

mod gif;
mod mp4;
mod png;

use ferrode_render::Picture;
use std::path::{Path, PathBuf};

pub use png::save as save_png;

/// What a path asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// One picture.
    Png,
    /// A folder of numbered pictures.
    Folder,
    /// A looping film of 256 colours a frame, for web pages.
    Gif,
    /// A film in AV1.
    Mp4,
}

impl Format {
    /// The format that a name asks for: by its ending, `…/` and names without one being folders.
    pub fn of(path: &Path) -> Option<Self> {
        if path.as_os_str().to_string_lossy().ends_with(['/', '\\']) {
            return Some(Self::Folder);
        }
        match path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).as_deref() {
            Some("png") => Some(Self::Png),
            Some("gif") => Some(Self::Gif),
            Some("mp4") => Some(Self::Mp4),
            None => Some(Self::Folder),
            Some(_) => None,
        }
    }

    /// Whether it shows more than one moment.
    pub fn moves(self) -> bool {
        self != Self::Png
    }
}

/// A film (or picture) that is being written. What is written is complete only after [`Film::finish`].
pub trait Film {
    /// Adds a frame.
    ///
    /// # Errors
    /// It cannot be written.
    fn add(&mut self, picture: &Picture) -> Result<(), String>;

    /// Writes what is left.
    ///
    /// # Errors
    /// It cannot be written.
    fn finish(self: Box<Self>) -> Result<(), String>;
}

/// Begins a film of a size in pixels and a number of frames a second.
///
/// # Errors
/// The file cannot be made, or the encoder refuses the size.
pub fn create(path: &Path, format: Format, size: [u32; 2], rate: f64) -> Result<Box<dyn Film>, String> {
    Ok(match format {
        Format::Png => Box::new(png::Still::create(path)?),
        Format::Folder => Box::new(png::Folder::create(path)?),
        Format::Gif => Box::new(gif::Gif::create(path, size, rate)?),
        Format::Mp4 => Box::new(mp4::Mp4::create(path, size, rate)?),
    })
}

fn cannot_write(path: &Path, error: impl std::fmt::Display) -> String {
    format!("cannot write {}: {error}", path.display())
}

fn make_file(path: &PathBuf) -> Result<std::io::BufWriter<std::fs::File>, String> {
    let file = std::fs::File::create(path).map_err(|error| cannot_write(path, error))?;
    Ok(std::io::BufWriter::new(file))
}

#[cfg(test)]
mod tests {
    use super::Format;
    use std::path::Path;

    #[test]
    fn names_tell_formats() {
        let of = |name: &str| Format::of(Path::new(name));
        assert_eq!(of("a.PNG"), Some(Format::Png));
        assert_eq!(of("a/b.gif"), Some(Format::Gif));
        assert_eq!(of("b.mp4"), Some(Format::Mp4));
        assert_eq!(of("frames/"), Some(Format::Folder));
        assert_eq!(of("frames"), Some(Format::Folder));
        assert_eq!(of("a.avi"), None);
    }
}
