//! PNGs of at most 256 colours, for repositories and web pages: a third of the size.

use color_quant::NeuQuant;
use ferrode_render::Picture;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};

/// A picture's PNG.
///
/// # Errors
/// The encoder refuses the size.
pub fn encode(picture: &Picture) -> Result<Vec<u8>, String> {
    // Best colours: each pixel is looked at.
    let colors = NeuQuant::new(1, 256, &picture.pixels);
    let indices: Vec<u8> = picture.pixels.chunks_exact(4).map(|pixel| colors.index_of(pixel) as u8).collect();
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_palette(colors.color_map_rgb());
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::NoFilter);
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(&indices)?;
        writer.finish()
    });
    written.map_err(|error| error.to_string())?;
    Ok(bytes)
}
