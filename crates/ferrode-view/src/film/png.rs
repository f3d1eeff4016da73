//! PNG pictures.

use super::{Film, cannot_write};
use ferrode_render::Picture;
use std::path::{Path, PathBuf};

/// Writes a picture as PNG.
///
/// # Errors
/// It cannot be written.
pub fn save(path: &Path, picture: &Picture) -> Result<(), String> {
    let color = image::ColorType::Rgba8;
    image::save_buffer_with_format(
        path,
        &picture.pixels,
        picture.width,
        picture.height,
        color,
        image::ImageFormat::Png,
    )
    .map_err(|error| cannot_write(path, error))
}

/// One picture; of several the last.
pub struct Still {
    path: PathBuf,
}

impl Still {
    /// Tells before anything is simulated that there is no such folder.
    pub fn create(path: &Path) -> Result<Self, String> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder {
            std::fs::metadata(folder).map_err(|error| cannot_write(path, error))?;
        }
        Ok(Self { path: path.to_owned() })
    }
}

impl Film for Still {
    fn add(&mut self, picture: &Picture) -> Result<(), String> {
        save(&self.path, picture)
    }

    fn finish(self: Box<Self>) -> Result<(), String> {
        Ok(())
    }
}

/// Pictures `00000.png`, `00001.png`, … in a folder.
pub struct Folder {
    path: PathBuf,
    count: usize,
}

impl Folder {
    pub fn create(path: &Path) -> Result<Self, String> {
        std::fs::create_dir_all(path).map_err(|error| cannot_write(path, error))?;
        Ok(Self { path: path.to_owned(), count: 0 })
    }
}

impl Film for Folder {
    fn add(&mut self, picture: &Picture) -> Result<(), String> {
        let path = self.path.join(format!("{:05}.png", self.count));
        self.count += 1;
        save(&path, picture)
    }

    fn finish(self: Box<Self>) -> Result<(), String> {
        Ok(())
    }
}
