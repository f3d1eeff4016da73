//! Triangle meshes as the graphics card wants them.

use ferrode_math::Vec3;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

/// A corner of a triangle.
///
/// A shape is drawn at `local · radii + core · half`, so that one mesh serves capsules of any length and boxes whose edges
/// are rounded alike, whatever their sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position, scaled by the instance's radii.
    pub local: [f32; 3],
    /// What is scaled by the instance's half lengths and added.
    pub core: [f32; 3],
    /// Unit normal of the surface for equal radii.
    pub normal: [f32; 3],
}

impl Vertex {
    pub(crate) fn to_array(self) -> [f32; 9] {
        let ([a, b, c], [d, e, f], [g, h, i]) = (self.local, self.core, self.normal);
        [a, b, c, d, e, f, g, h, i]
    }
}

/// Triangles, counter-clockwise as seen from outside. Make it once, share it by an [`Arc`](std::sync::Arc): the renderer
/// keeps what it has seen.
#[derive(Debug)]
pub struct Mesh {
    /// Tells meshes apart.
    pub(crate) id: u64,
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) indices: Vec<u32>,
    /// Corners in model coordinates, for outlines and bounds.
    radius: f64,
    /// Its inside is never seen.
    pub(crate) closed: bool,
}

static NEXT: AtomicU64 = AtomicU64::new(1);

/// Faces that meet at a smaller angle than this (cosine) look like one bent surface.
const CREASE: f64 = 0.8;

pub(crate) fn to_f32(v: Vec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

impl Mesh {
    /// A closed surface.
    pub(crate) fn from_parts(vertices: Vec<Vertex>, indices: Vec<u32>) -> Self {
        let radius = vertices.iter().map(|v| length(v.local)).fold(0.0, f64::max);
        Self { id: NEXT.fetch_add(1, Ordering::Relaxed), vertices, indices, radius, closed: true }
    }

    /// A mesh of triangles. Edges between faces that are nearly in line are shaded smoothly, others sharply. Triangles that
    /// name a corner that is not there are left out.
    pub fn new(corners: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let there = |t: &&[u32; 3]| t.iter().all(|i| (*i as usize) < corners.len());
        let triangles: Vec<[u32; 3]> = triangles.iter().filter(there).copied().collect();
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| corners[i as usize]);
            (b - a).cross(c - a)
        };
        let areas: Vec<Vec3> = triangles.iter().map(area).collect();
        let mut around: BTreeMap<[u64; 3], Vec<usize>> = BTreeMap::new();
        let place = |p: Vec3| p.to_array().map(|x| (x + 0.0).to_bits());
        for (n, triangle) in triangles.iter().enumerate() {
            for corner in triangle {
                around.entry(place(corners[*corner as usize])).or_default().push(n);
            }
        }
        let mut vertices = Vec::with_capacity(triangles.len() * 3);
        for (triangle, own) in triangles.iter().zip(&areas) {
            let flat = own.normalized_or(Vec3::Z);
            for corner in triangle {
                let p = corners[*corner as usize];
                let faces = around.get(&place(p)).map_or(&[][..], Vec::as_slice);
                let smooth = faces.iter().map(|n| areas[*n]);
                let smooth = smooth.filter(|a| a.dot(flat) > CREASE * a.length());
                let normal = smooth.fold(Vec3::ZERO, |sum, a| sum + a).normalized_or(flat);
                vertices.push(Vertex { local: to_f32(p), core: [0.0; 3], normal: to_f32(normal) });
            }
        }
        let indices = (0..vertices.len() as u32).collect();
        Self { closed: false, ..Self::from_parts(vertices, indices) }
    }

    /// How far its corners are from its origin.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }
}

fn length([x, y, z]: [f32; 3]) -> f64 {
    Vec3::new(f64::from(x), f64::from(y), f64::from(z)).length()
}

#[cfg(test)]
mod tests {
    use super::Mesh;
    use ferrode_math::Vec3;

    #[test]
    fn sharp_edges_stay_sharp_and_flat_ones_smooth() {
        // Two triangles of a nearly flat roof, and one standing up.
        let corners = [
            Vec3::ZERO,
            Vec3::X,
            Vec3::new(1.0, 1.0, 0.0),
            Vec3::new(0.0, 1.0, 0.1),
            Vec3::new(0.5, 0.0, -1.0),
        ];
        let mesh = Mesh::new(&corners, &[[0, 1, 2], [0, 2, 3], [1, 0, 4], [0, 9, 1]]);
        assert_eq!(mesh.triangle_count(), 3);
        let normal = |n: usize| mesh.vertices[n].normal;
        assert_eq!(normal(0), normal(3), "the corner at the origin of both flat triangles");
        assert_ne!(normal(0), normal(1));
        assert_eq!(normal(6), normal(8), "the standing triangle is flat");
        assert!((mesh.radius() - 2.0_f64.sqrt()).abs() < 1e-6);
    }
}
