//! From the driver's memory to ours.

use crate::{Gpu, Picture, RenderError};

/// A buffer that takes a picture's rows, each padded to a multiple of 256 bytes.
#[derive(Debug)]
pub struct ReadBack {
    size: [u32; 2],
    rows: wgpu::Buffer,
}

fn padded(width: u32) -> u32 {
    (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

impl ReadBack {
    /// For pictures of a size.
    pub fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let rows = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: u64::from(padded(size[0])) * u64::from(size[1]),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        Self { size, rows }
    }

    /// Submits the commands, and fetches what they drew into a texture.
    pub fn fetch(
        &self,
        gpu: &Gpu,
        mut encoder: wgpu::CommandEncoder,
        texture: &wgpu::Texture,
    ) -> Result<Picture, RenderError> {
        let [width, height] = self.size;
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(padded(width)),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &self.rows, layout },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
        gpu.queue.submit([encoder.finish()]);
        let mut pixels = self.wait(gpu)?;
        use wgpu::TextureFormat::{Bgra8Unorm, Bgra8UnormSrgb};
        if matches!(texture.format(), Bgra8Unorm | Bgra8UnormSrgb) {
            pixels.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
        }
        Ok(Picture { width, height, pixels })
    }

    fn wait(&self, gpu: &Gpu) -> Result<Vec<u8>, RenderError> {
        let failed = |error: &dyn std::fmt::Display| RenderError::ReadBack(error.to_string());
        let (send, receive) = std::sync::mpsc::channel();
        let slice = self.rows.slice(..);
        slice.map_async(wgpu::MapMode::Read, move |result| {
            // Nobody waits any more if this fails.
            let _ = send.send(result);
        });
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
        receive.recv().map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
        let [width, height] = self.size.map(|side| side as usize);
        let mut pixels = Vec::with_capacity(width * height * 4);
        {
            let bytes = slice.get_mapped_range().map_err(|error| failed(&error))?;
            for row in bytes.chunks_exact(padded(self.size[0]) as usize) {
                pixels.extend_from_slice(&row[..width * 4]);
            }
        }
        self.rows.unmap();
        Ok(pixels)
    }
}
