//! The triangles of a heightfield's surface.

use crate::Heightfield;
use ferrode_math::{Aabb, Vec3};

/// Cells further than this from the middle are not told apart.
pub(super) const FAR: f64 = 1e15;

impl Heightfield {
    /// Calls `found` with each triangle of the surface, in the field's coordinates, whose box touches `aabb`. Of a field
    /// without end it looks at no more than `most` cells along either axis, those in the middle.
    pub(crate) fn triangles_in(&self, aabb: &Aabb, most: i64, mut found: impl FnMut([Vec3; 3])) {
        let (sx, sz) = self.cell();
        let range = |low: f64, high: f64, whole: f64, size: f64, n: usize| {
            let (low, high) = (low.clamp(-FAR * size, FAR * size), high.clamp(-FAR * size, FAR * size));
            let (from, to) = (
                ((low + 0.5 * whole) / size).next_down().floor() as i64,
                ((high + 0.5 * whole) / size).next_up().floor() as i64,
            );
            if self.is_wrapped() {
                let (middle, half) = (from + (to - from) / 2, most / 2);
                (from.max(middle - half), to.min(middle + half))
            } else {
                (from.max(0), to.min(n as i64 - 2))
            }
        };
        if !aabb.is_finite() {
            return;
        }
        let (x0, x1) = range(aabb.min.x, aabb.max.x, self.width(), sx, self.columns());
        let (z0, z1) = range(aabb.min.z, aabb.max.z, self.depth(), sz, self.rows());
        for x in x0..=x1 {
            for z in z0..=z1 {
                for t in self.cell_triangles(x, z) {
                    let (min, max) = (t[0].min(t[1]).min(t[2]), t[0].max(t[1]).max(t[2]));
                    if aabb.overlaps(&Aabb::new(min, max)) {
                        found(t);
                    }
                }
            }
        }
    }

    /// Calls `found` with each triangle, in the field's coordinates; of a field without end, with those of one repetition.
    pub(crate) fn each_triangle(&self, mut found: impl FnMut([Vec3; 3])) {
        for z in 0..self.rows() as i64 - 1 {
            for x in 0..self.columns() as i64 - 1 {
                self.cell_triangles(x, z).into_iter().for_each(&mut found);
            }
        }
    }

    /// The two triangles of a cell, in the field's coordinates.
    #[inline]
    pub(crate) fn cell_triangles(&self, x: i64, z: i64) -> [[Vec3; 3]; 2] {
        let [a, b, c, d] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| self.vertex(x + i, z + j));
        [[a, b, c], [d, c, b]]
    }

    /// Height of the surface above a place, all in the field's coordinates; `None` beside the field.
    pub(crate) fn surface_at(&self, x: f64, z: f64) -> Option<f64> {
        let (sx, sz) = self.cell();
        let (u, v) = ((x + 0.5 * self.width()) / sx, (z + 0.5 * self.depth()) / sz);
        let inside = |u: f64, n: usize| self.is_wrapped() || (0.0..=(n - 1) as f64).contains(&u);
        if !(inside(u, self.columns()) && inside(v, self.rows())) {
            return None;
        }
        if !(u.abs() < FAR && v.abs() < FAR) {
            return None;
        }
        let (i, j) = (u.floor() as i64, v.floor() as i64);
        let (u, v) = (u - u.floor(), v - v.floor());
        let h = |di: i64, dj: i64| self.height(i + di, j + dj);
        Some(if u + v <= 1.0 {
            h(0, 0) + u * (h(1, 0) - h(0, 0)) + v * (h(0, 1) - h(0, 0))
        } else {
            h(1, 1) + (1.0 - u) * (h(0, 1) - h(1, 1)) + (1.0 - v) * (h(1, 0) - h(1, 1))
        })
    }
}
