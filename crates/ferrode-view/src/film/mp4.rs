//! MP4 films in AV1.
//!
//! Both the encoder (rav1e) and the muxer (muxide) are Rust throughout, so that the viewer needs no C++ compiler and no
//! system library. Browsers, VLC, mpv and FFmpeg play AV1.

use super::{Film, cannot_write, make_file};
use ferrode_render::Picture;
use muxide::api::{Muxer, MuxerBuilder, VideoCodec};
use rav1e::prelude::*;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// A film in AV1.
pub struct Mp4 {
    path: PathBuf,
    size: [usize; 2],
    rate: f64,
    encoder: Context<u8>,
    muxer: Muxer<BufWriter<File>>,
}

/// An AV1 temporal delimiter, which marks frames in streams of their own and has no place in MP4 (AV1 codec ISO media file
/// format binding, 2.4).
const DELIMITER: [u8; 2] = [0x12, 0x00];

impl Mp4 {
    pub fn create(path: &Path, size: [u32; 2], rate: f64) -> Result<Self, String> {
        let [width, height] = size;
        if width % 2 == 1 || height % 2 == 1 || width < 16 || height < 16 {
            return Err("an MP4 film must have even sides of at least 16 pixels".to_owned());
        }
        let wrong = |error: &dyn std::fmt::Display| cannot_write(path, error);
        let mut config = EncoderConfig::with_speed_preset(10);
        (config.width, config.height) = (width as usize, height as usize);
        let thousandths = (rate * 1000.0).round().max(1.0) as u64;
        config.time_base = Rational::new(1000, thousandths);
        config.quantizer = 80;
        config.low_latency = true;
        config.max_key_frame_interval = 120;
        config.chroma_sampling = ChromaSampling::Cs420;
        config.pixel_range = PixelRange::Limited;
        config.color_description = Some(ColorDescription {
            color_primaries: ColorPrimaries::BT709,
            transfer_characteristics: TransferCharacteristics::BT709,
            matrix_coefficients: MatrixCoefficients::BT709,
        });
        config.tiles = 4;
        let encoder =
            Config::new().with_encoder_config(config).new_context().map_err(|error| wrong(&error))?;
        let muxer = MuxerBuilder::new(make_file(&path.to_owned())?)
            .video(VideoCodec::Av1, width, height, rate)
            .build()
            .map_err(|error| wrong(&error))?;
        Ok(Self { path: path.to_owned(), size: size.map(|side| side as usize), rate, encoder, muxer })
    }

    fn take_packets(&mut self) -> Result<(), String> {
        loop {
            match self.encoder.receive_packet() {
                Ok(packet) => {
                    let data = packet.data.strip_prefix(&DELIMITER).unwrap_or(&packet.data);
                    let time = packet.input_frameno as f64 / self.rate;
                    let key = packet.frame_type == FrameType::KEY;
                    self.muxer
                        .write_video(time, data, key)
                        .map_err(|error| cannot_write(&self.path, error))?;
                }
                Err(EncoderStatus::Encoded) => {}
                Err(EncoderStatus::NeedMoreData | EncoderStatus::LimitReached) => return Ok(()),
                Err(error) => return Err(cannot_write(&self.path, error)),
            }
        }
    }
}

impl Film for Mp4 {
    fn add(&mut self, picture: &Picture) -> Result<(), String> {
        let mut frame = self.encoder.new_frame();
        let [width, height] = self.size;
        let planes = to_yuv(&picture.pixels, width, height);
        for ((plane, bytes), stride) in
            frame.planes.iter_mut().zip(&planes).zip([width, width / 2, width / 2])
        {
            plane.copy_from_raw_u8(bytes, stride, 1);
        }
        self.encoder.send_frame(frame).map_err(|error| cannot_write(&self.path, error))?;
        self.take_packets()
    }

    fn finish(mut self: Box<Self>) -> Result<(), String> {
        self.encoder.flush();
        self.take_packets()?;
        self.muxer.finish().map_err(|error| cannot_write(&self.path, error))
    }
}

/// Luma of each pixel and chroma of each two by two (ITU-R BT.709, limited range).
fn to_yuv(rgba: &[u8], width: usize, height: usize) -> [Vec<u8>; 3] {
    let rgb = |x: usize, y: usize| {
        let at = 4 * (y * width + x);
        [f32::from(rgba[at]), f32::from(rgba[at + 1]), f32::from(rgba[at + 2])]
    };
    let luma = |[r, g, b]: [f32; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let mut planes = [
        Vec::with_capacity(width * height),
        Vec::with_capacity(width * height / 4),
        Vec::with_capacity(width * height / 4),
    ];
    for y in 0..height {
        for x in 0..width {
            planes[0].push((16.5 + luma(rgb(x, y)) * (219.0 / 255.0)) as u8);
        }
    }
    for y in (0..height).step_by(2) {
        for x in (0..width).step_by(2) {
            let four = [rgb(x, y), rgb(x + 1, y), rgb(x, y + 1), rgb(x + 1, y + 1)];
            let mean: [f32; 3] = core::array::from_fn(|i| four.iter().map(|c| c[i]).sum::<f32>() / 4.0);
            let y = luma(mean);
            planes[1].push((128.5 + (mean[2] - y) / 1.8556 * (224.0 / 255.0)) as u8);
            planes[2].push((128.5 + (mean[0] - y) / 1.5748 * (224.0 / 255.0)) as u8);
        }
    }
    planes
}

#[cfg(test)]
mod tests {
    use super::to_yuv;

    #[test]
    fn white_black_and_red_are_those_of_bt_709() {
        let of = |color: [u8; 4]| to_yuv(&color.repeat(4), 2, 2).map(|plane| plane[0]);
        assert_eq!(of([255, 255, 255, 255]), [235, 128, 128]);
        assert_eq!(of([0, 0, 0, 255]), [16, 128, 128]);
        assert_eq!(of([255, 0, 0, 255]), [63, 102, 240]);
    }
}
