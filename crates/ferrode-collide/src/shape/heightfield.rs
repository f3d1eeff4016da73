use super::height_blocks::HeightBlocks;
use super::{LARGEST, ShapeError, checked_size};
use crate::Frame;
use ferrode_math::{Aabb, Vec3};
use std::sync::Arc;

/// A grid of heights along local y, over a rectangle of x (width) and z (depth) around the origin. Copies share their
/// data.
///
/// Each cell is two triangles that meet on the diagonal from (x+1, z) to (x, z+1), as in ODE. In worlds with z up
/// the field is turned by [`Heightfield::z_up`].
#[derive(Clone, Debug)]
pub struct Heightfield {
    data: Arc<Field>,
}

#[derive(Clone, Debug)]
struct Field {
    width: f64,
    depth: f64,
    columns: usize,
    rows: usize,
    heights: Vec<f64>,
    blocks: HeightBlocks,
    low: f64,
    high: f64,
    /// The highest sample, whatever bounds are given.
    top: f64,
    thickness: f64,
    wrap: bool,
}

impl PartialEq for Heightfield {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (&self.data, &other.data);
        Arc::ptr_eq(a, b)
            || (a.heights == b.heights
                && (a.width, a.depth, a.columns, a.thickness, a.wrap)
                    == (b.width, b.depth, b.columns, b.thickness, b.wrap))
    }
}

impl Heightfield {
    /// A field of `width` by `depth` metres with `columns` samples along x and `rows` along z (at least two of each);
    /// the sample at (x, z) is `heights[x + z * columns]`, in metres.
    ///
    /// `thickness` reaches below the lowest sample in the field's box, so that spaces still report what has sunk.
    pub fn new(
        width: f64,
        depth: f64,
        columns: usize,
        rows: usize,
        heights: Vec<f64>,
        thickness: f64,
    ) -> Result<Self, ShapeError> {
        for (what, value) in [("heightfield width", width), ("heightfield depth", depth)] {
            if !(value > 0.0 && value <= LARGEST) {
                return Err(ShapeError { what, value });
            }
        }
        checked_size("heightfield thickness", thickness)?;
        for (what, count) in [("heightfield columns", columns), ("heightfield rows", rows)] {
            if count < 2 {
                return Err(ShapeError { what, value: count as f64 });
            }
        }
        if columns.checked_mul(rows) != Some(heights.len()) {
            return Err(ShapeError { what: "number of heights", value: heights.len() as f64 });
        }
        if let Some(&value) = heights.iter().find(|h| !(h.abs() <= LARGEST)) {
            return Err(ShapeError { what: "height", value });
        }
        let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let blocks = HeightBlocks::new(columns, rows, &heights);
        let (top, wrap) = (high, false);
        let data = Field { width, depth, columns, rows, heights, blocks, low, high, top, thickness, wrap };
        Ok(Self { data: Arc::new(data) })
    }

    /// The same field repeated without end in x and z; the last row and column are those of the next repetition.
    #[must_use]
    pub fn wrapped(mut self) -> Self {
        Arc::make_mut(&mut self.data).wrap = true;
        self
    }

    /// The same field with other bounds of height for its box, as ODE's `SetBounds` gives them.
    #[must_use]
    pub fn with_bounds(mut self, low: f64, high: f64) -> Self {
        let data = Arc::make_mut(&mut self.data);
        (data.low, data.high) = (low.min(high), low.max(high));
        self
    }

    /// The rotation that turns the field's y to the world's z, and its z to the world's −y.
    pub fn z_up() -> ferrode_math::Quat {
        ferrode_math::Quat::from_axis_angle(Vec3::X, core::f64::consts::FRAC_PI_2)
    }

    /// Size along x in metres.
    pub fn width(&self) -> f64 {
        self.data.width
    }

    /// Size along z in metres.
    pub fn depth(&self) -> f64 {
        self.data.depth
    }

    /// Samples along x.
    pub fn columns(&self) -> usize {
        self.data.columns
    }

    /// Samples along z.
    pub fn rows(&self) -> usize {
        self.data.rows
    }

    pub(super) fn blocks(&self) -> &HeightBlocks {
        &self.data.blocks
    }

    /// Whether the field repeats.
    pub fn is_wrapped(&self) -> bool {
        self.data.wrap
    }

    /// Size of a cell along x and z.
    pub fn cell(&self) -> (f64, f64) {
        (self.data.width / (self.data.columns - 1) as f64, self.data.depth / (self.data.rows - 1) as f64)
    }

    /// The sample at column `x` and row `z`; beyond the edge the nearest, or the repeated one if the field wraps.
    #[inline]
    pub fn height(&self, x: i64, z: i64) -> f64 {
        let d = &self.data;
        let place = |i: i64, n: usize| {
            let last = n as i64 - 1;
            (if d.wrap { i.rem_euclid(last) } else { i.clamp(0, last) }) as usize
        };
        d.heights[place(x, d.columns) + place(z, d.rows) * d.columns]
    }

    /// The corner of the grid at column `x` and row `z`, in local coordinates.
    #[inline]
    pub fn vertex(&self, x: i64, z: i64) -> Vec3 {
        let (sx, sz) = self.cell();
        Vec3::new(
            x as f64 * sx - 0.5 * self.data.width,
            self.height(x, z),
            z as f64 * sz - 0.5 * self.data.depth,
        )
    }

    /// Whether a ball in local coordinates is above all samples, or beyond the field's sides. A hair less, so that rounding
    /// never decides.
    #[inline]
    pub(crate) fn is_beside(&self, center: Vec3, radius: f64) -> bool {
        let d = &self.data;
        let reach = radius * (1.0 + 1e-9) + 1e-9 * center.abs_max();
        let beyond = |x: f64, size: f64| x.abs() - reach > 0.5 * size * (1.0 + 1e-9);
        center.y - reach > d.top + 1e-9 * d.top.abs()
            || (!d.wrap && (beyond(center.x, d.width) || beyond(center.z, d.depth)))
    }

    /// The world box around the field.
    pub fn aabb(&self, frame: &Frame) -> Aabb {
        let d = &self.data;
        if d.wrap {
            let tilted = frame.axis(1).x != 0.0 || frame.axis(1).z != 0.0 || frame.axis(1).y < 0.0;
            let mut aabb = Aabb::EVERYTHING;
            if !tilted {
                aabb.min.y = frame.position.y + d.low - d.thickness;
                aabb.max.y = frame.position.y + d.high;
            }
            return aabb;
        }
        let center = frame.point_to_world(Vec3::new(0.0, 0.5 * (d.low - d.thickness + d.high), 0.0));
        let half = Vec3::new(0.5 * d.width, 0.5 * (d.high - d.low + d.thickness), 0.5 * d.depth);
        let range = |i: usize| {
            let r = frame.rotation.rows[i];
            (r[0] * half.x).abs() + (r[1] * half.y).abs() + (r[2] * half.z).abs()
        };
        Aabb::from_center(center, Vec3::new(range(0), range(1), range(2)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_and_vertices() {
        let heights = (0..12).map(f64::from).collect::<Vec<_>>();
        let field = Heightfield::new(6.0, 2.0, 4, 3, heights.clone(), 1.0).unwrap();
        assert_eq!(field.cell(), (2.0, 1.0));
        assert_eq!(field.vertex(1, 2), Vec3::new(-1.0, 9.0, 1.0));
        assert_eq!(field.height(-3, 9), 8.0);
        let aabb = field.aabb(&Frame::IDENTITY);
        assert_eq!((aabb.min, aabb.max), (Vec3::new(-3.0, -1.0, -1.0), Vec3::new(3.0, 11.0, 1.0)));
        let endless = field.wrapped();
        assert_eq!(endless.height(3, 2), 0.0);
        assert_eq!(endless.height(-1, -1), endless.height(2, 1));
        assert!(Heightfield::new(6.0, 2.0, 4, 4, heights.clone(), 1.0).is_err());
        assert!(Heightfield::new(6.0, 2.0, 1, 12, heights.clone(), 1.0).is_err());
        assert!(Heightfield::new(0.0, 2.0, 4, 3, heights, 1.0).is_err());
        assert!(Heightfield::new(1.0, 2.0, 2, 2, vec![0.0, 1.0, f64::NAN, 0.0], 1.0).is_err());
        // y up becomes z up.
        let up = Heightfield::z_up().rotate(Vec3::Y);
        assert!((up - Vec3::Z).length() < 1e-15);
    }
}
