//! Pictures as PNG files.

use crate::fault::{Fault, Outcome};
use ferrode_render::Picture;
use std::path::Path;

/// Creates a folder.
///
/// # Errors
/// It can't be created.
pub fn folder(path: &Path) -> Outcome<()> {
    std::fs::create_dir_all(path)
        .map_err(|error| Fault::circumstance(format!("cannot create the folder {}: {error}", path.display())))
}

/// Writes a picture, without its opacity.
///
/// # Errors
/// The file can't be written.
pub fn save(path: &Path, picture: &Picture) -> Outcome<()> {
    let failed = |error: &dyn std::fmt::Display| {
        Fault::circumstance(format!("cannot write {}: {error}", path.display()))
    };
    // Written at once, so that a file that is there is nearly always whole.
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(|error| failed(&error))?;
    let bytes: Vec<u8> =
        picture.pixels.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    writer.write_image_data(&bytes).map_err(|error| failed(&error))?;
    writer.finish().map_err(|error| failed(&error))?;
    std::fs::write(path, file).map_err(|error| failed(&error))
}
