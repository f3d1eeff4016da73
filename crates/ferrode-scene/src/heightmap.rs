//! Terrain from a greyscale image.

use std::path::Path;

use ferrode_math::Vec3;

use crate::mesh::Triangles;

/// More pixels than this are taken for a mistake: a surface of them would need gigabytes.
const MOST_PIXELS: u64 = 1 << 22;

/// The surface of a terrain: a corner for each pixel, black at height 0 and white at `size.z`, the image's top towards
/// +y, its middle at `position`.
///
/// # Errors
/// Why the image cannot be read.
pub(crate) fn surface(path: &Path, size: Vec3, position: Vec3) -> Result<Triangles, String> {
    let unreadable = |error: &dyn std::fmt::Display| format!("`{}` cannot be read: {error}", path.display());
    let reader = image::ImageReader::open(path).map_err(|error| unreadable(&error))?;
    let reader = reader.with_guessed_format().map_err(|error| unreadable(&error))?;
    let (columns, rows) = reader.into_dimensions().map_err(|error| unreadable(&error))?;
    if columns < 2 || rows < 2 || u64::from(columns) * u64::from(rows) > MOST_PIXELS {
        return Err(unreadable(&format!("{columns} × {rows} pixels are too few or too many")));
    }
    let image = image::open(path).map_err(|error| unreadable(&error))?.into_luma16();
    let (columns, rows) = image.dimensions();
    let along = |index: u32, count: u32| f64::from(index) / f64::from(count - 1) - 0.5;
    let mut surface = Triangles::default();
    surface.vertices.extend(image.enumerate_pixels().map(|(x, y, pixel)| {
        let height = f64::from(pixel.0[0]) / f64::from(u16::MAX);
        let unit = Vec3::new(along(x, columns), -along(y, rows), height);
        position + unit.component_mul(size)
    }));
    for y in 0..rows - 1 {
        for x in 0..columns - 1 {
            let corner = y * columns + x;
            let (right, below) = (corner + 1, corner + columns);
            surface.triangles.push([corner, below, right]);
            surface.triangles.push([right, below, below + 1]);
        }
    }
    Ok(surface)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_become_corners() {
        let path = std::env::temp_dir().join("ferrode-scene-heightmap.png");
        // A wedge that rises towards the right, and one bright pixel in the top row.
        let image = image::ImageBuffer::<image::Luma<u16>, Vec<u16>>::from_fn(3, 2, |x, y| {
            image::Luma([if (x, y) == (0, 0) { u16::MAX } else { (x * 0x8000).min(0xffff) as u16 }])
        });
        image.save(&path).unwrap();
        let terrain = surface(&path, Vec3::new(4.0, 2.0, 10.0), Vec3::new(100.0, 0.0, 1.0)).unwrap();
        assert_eq!((terrain.vertices.len(), terrain.triangles.len()), (6, 4));
        assert_eq!(terrain.vertices[0], Vec3::new(98.0, 1.0, 11.0));
        assert_eq!(terrain.vertices[5], Vec3::new(102.0, -1.0, 11.0));
        assert_eq!(terrain.vertices[3], Vec3::new(98.0, -1.0, 1.0));
        for corners in &terrain.triangles {
            let [a, b, c] = corners.map(|corner| terrain.vertices[corner as usize]);
            assert!((b - a).cross(c - a).z > 0.0);
        }
        assert!(surface(Path::new("no.png"), Vec3::splat(1.0), Vec3::ZERO).is_err());
        std::fs::write(&path, b"no image").unwrap();
        assert!(surface(&path, Vec3::splat(1.0), Vec3::ZERO).unwrap_err().contains("cannot be read"));
    }
}
