//! Surfaces that consist of triangles, for those who draw or export shapes.

use super::Shape;
use ferrode_math::Vec3;

impl Shape {
    /// The surface as corners, in the shape's coordinates, and triangles of them, counterclockwise seen from outside:
    /// of meshes, polyhedra (each face a fan) and heightfields. `None` for curved shapes, boxes, planes, rays, compounds
    /// and shapes of one's own.
    #[must_use]
    pub fn triangles(&self) -> Option<(Vec<Vec3>, Vec<[u32; 3]>)> {
        match self {
            Shape::TriMesh(mesh) => Some((mesh.vertices().to_vec(), mesh.triangles().to_vec())),
            Shape::Convex(hull) => {
                let fan = |face: &[u32]| -> Vec<[u32; 3]> {
                    face[1..].windows(2).map(|edge| [face[0], edge[0], edge[1]]).collect()
                };
                let triangles = (0..hull.face_count()).flat_map(|i| fan(hull.face(i))).collect();
                Some((hull.points().to_vec(), triangles))
            }
            Shape::Heightfield(field) => {
                let (columns, rows) = (field.columns(), field.rows());
                let corners = (0..rows)
                    .flat_map(|z| (0..columns).map(move |x| field.vertex(x as i64, z as i64)))
                    .collect();
                let at = |x: usize, z: usize| (z * columns + x) as u32;
                let mut triangles = Vec::with_capacity(2 * columns * rows);
                for z in 0..rows.saturating_sub(1) {
                    for x in 0..columns.saturating_sub(1) {
                        triangles.push([at(x, z), at(x, z + 1), at(x + 1, z)]);
                        triangles.push([at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)]);
                    }
                }
                Some((corners, triangles))
            }
            _ => None,
        }
    }
}
