//! Meshes whose vertices move while the triangles stay: cloth, terrain that is dug, animated bodies.

use super::{
    Edge, MeshData, Neighbour, PaddedFacet, ShapeError, TriMesh, check_vertices, edges_by_ends, place,
};
use ferrode_math::{Aabb, Vec3};
use std::sync::Arc;

/// Which edges are one, worked out when vertices first move.
#[derive(Clone, Debug)]
pub(super) struct Links {
    /// Vertices that lie where another one of a lower number does, with that number.
    welded: Vec<[u32; 2]>,
    /// Pairs of edges with the same ends, in the order in which [`TriMesh::new`] looks at them.
    pairs: Vec<[Side; 2]>,
}

/// An edge as one of its triangles has it.
#[derive(Clone, Copy, Debug)]
struct Side {
    triangle: u32,
    edge: u8,
    /// Vertices: the edge's ends, and the triangle's third corner.
    start: u32,
    end: u32,
    apex: u32,
}

impl Links {
    fn of(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let (place_of, edges) = edges_by_ends(vertices, triangles);
        let mut first = vec![u32::MAX; vertices.len()];
        let mut welded = Vec::new();
        for (i, &p) in place_of.iter().enumerate() {
            let first = &mut first[p as usize];
            if *first == u32::MAX {
                *first = i as u32;
            } else {
                welded.push([i as u32, *first]);
            }
        }
        let side = |&(_, _, triangle, edge): &Edge| {
            let corner = |k: u8| triangles[triangle as usize][usize::from((edge + k) % 3)];
            Side { triangle, edge, start: corner(0), end: corner(1), apex: corner(2) }
        };
        let same_ends = edges.windows(2).filter(|pair| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1));
        Self { welded, pairs: same_ends.map(|pair| [side(&pair[0]), side(&pair[1])]).collect() }
    }
}

impl TriMesh {
    /// Moves the vertices: as many as there are, the triangles stay. What a triangle has beyond its edges stays too, whether
    /// that rises or falls is found anew; vertices that come to lie at the same place do not become one. Use flags stay as
    /// they are. Copies of the mesh keep the old vertices; if there are any, the data are copied first.
    ///
    /// Takes a small part of the time of [`TriMesh::new`]; casts and collisions take longer if parts of the mesh have moved
    /// far relative to each other.
    pub fn set_vertices(&mut self, vertices: &[Vec3]) -> Result<(), ShapeError> {
        if vertices.len() != self.data.vertices.len() {
            return Err(ShapeError { what: "number of a mesh's vertices", value: vertices.len() as f64 });
        }
        check_vertices(vertices)?;
        let data = Arc::make_mut(&mut self.data);
        let links = data.links.take().unwrap_or_else(|| Links::of(&data.vertices, &data.triangles).into());
        if links.welded.iter().any(|&[i, j]| place(vertices[i as usize]) != place(vertices[j as usize])) {
            // A seam opens: other triangles meet.
            let mut other =
                Self::new(vertices.to_vec(), data.triangles.clone())?.with_sphere_merge(self.sphere_merge);
            let flags = core::mem::take(&mut data.use_flags);
            Arc::make_mut(&mut other.data).use_flags = flags;
            *self = other;
            return Ok(());
        }
        data.vertices.copy_from_slice(vertices);
        data.refit(&links);
        data.links = Some(links);
        Ok(())
    }
}

impl MeshData {
    fn refit(&mut self, links: &Links) {
        let (vertices, triangles) = (&self.vertices, &self.triangles);
        let at = |v: u32| vertices[v as usize];
        for (facet, t) in self.facets.iter_mut().zip(triangles) {
            *facet = PaddedFacet::new(t.map(at));
        }
        self.neighbours.fill([Neighbour::None; 3]);
        for [a, b] in &links.pairs {
            let normal = |side: &Side| self.facets[side.triangle as usize].normal();
            let (na, nb) = (normal(a), normal(b));
            if na == Vec3::ZERO || nb == Vec3::ZERO {
                continue;
            }
            for (here, there, n, other) in [(a, b, na, nb), (b, a, nb, na)] {
                self.neighbours[here.triangle as usize][usize::from(here.edge)] =
                    Neighbour::across(at(here.start), at(here.end), at(there.apex), n, other);
            }
        }
        self.bounds = Aabb::EMPTY;
        for (p, _) in vertices.iter().zip(&self.first_triangle).filter(|(_, t)| **t != u32::MAX) {
            self.bounds = self.bounds.union(&Aabb::new(*p, *p));
        }
        self.tree.refit(|t| {
            let [a, b, c] = triangles[t as usize].map(at);
            Aabb::new(a.min(b).min(c), a.max(b).max(c))
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ferrode_math::real::sin;

    /// A sheet of `n` by `n` cells, waving.
    fn sheet(n: u32, t: f64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let at = |i: u32| {
            let (x, y) = (f64::from(i % (n + 1)), f64::from(i / (n + 1)));
            Vec3::new(x, y, sin(x + 2.0 * t) * sin(0.7 * y - t) * t)
        };
        let cell = |i: u32| {
            let a = i / n * (n + 1) + i % n;
            [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
        };
        ((0..(n + 1) * (n + 1)).map(at).collect(), (0..n * n).flat_map(cell).collect())
    }

    fn same(a: &TriMesh, b: &TriMesh) {
        assert_eq!(a.vertices(), b.vertices());
        assert_eq!(a.bounds(), b.bounds());
        for t in 0..a.triangles().len() as u32 {
            assert_eq!(a.normal(t), b.normal(t));
            let corners = a.triangles()[t as usize].map(|v| a.vertices()[v as usize]);
            assert_eq!((a.corners(t), b.corners(t)), (corners, corners));
            assert_eq!(a.neighbours(t), b.neighbours(t), "triangle {t}");
        }
    }

    #[test]
    fn a_moved_mesh_is_as_a_new_one() {
        let (vertices, triangles) = sheet(9, 0.0);
        let mut mesh = TriMesh::new(vertices, triangles.clone()).unwrap();
        let copy = mesh.clone();
        for step in 1..20 {
            let (vertices, _) = sheet(9, 0.1 * f64::from(step));
            mesh.set_vertices(&vertices).unwrap();
            same(&mesh, &TriMesh::new(vertices, triangles.clone()).unwrap());
        }
        assert_eq!(copy.bounds().max.z, 0.0);
        // Flat again, and with triangles without area.
        let (flat, _) = sheet(9, 0.0);
        mesh.set_vertices(&flat).unwrap();
        same(&mesh, &copy);
        let mut folded = flat.clone();
        (folded[11], folded[12]) = (flat[1] + Vec3::Z * 1e-9, flat[1] + Vec3::Z * 2e-9);
        mesh.set_vertices(&folded).unwrap();
        same(&mesh, &TriMesh::new(folded, triangles).unwrap());
    }

    #[test]
    fn seams_that_open_are_seen() {
        let (vertices, triangles) = sheet(3, 0.4);
        // Each triangle with vertices of its own.
        let soup: Vec<Vec3> = triangles.iter().flatten().map(|&v| vertices[v as usize]).collect();
        let numbers: Vec<[u32; 3]> =
            (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let mut mesh = TriMesh::new(soup.clone(), numbers.clone()).unwrap();
        let moved: Vec<Vec3> = soup.iter().map(|p| *p + Vec3::X * p.z).collect();
        mesh.set_vertices(&moved).unwrap();
        same(&mesh, &TriMesh::new(moved.clone(), numbers.clone()).unwrap());
        let mut open = moved;
        open[0].z += 0.5;
        mesh.set_vertices(&open).unwrap();
        same(&mesh, &TriMesh::new(open, numbers).unwrap());
    }

    #[test]
    fn bad_vertices_change_nothing() {
        let (vertices, triangles) = sheet(2, 0.2);
        let mut mesh = TriMesh::new(vertices.clone(), triangles).unwrap();
        let before = mesh.clone();
        assert!(mesh.set_vertices(&vertices[1..]).is_err());
        let mut bad = vertices;
        bad[3].y = f64::NAN;
        assert!(mesh.set_vertices(&bad).is_err());
        same(&mesh, &before);
    }
}
