mod refit;

use super::{LARGEST, ShapeError};
use crate::Frame;
use crate::narrow::ContactMerge;
use crate::space::tree::AabbTree;
use ferrode_math::{Aabb, Vec3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A surface of triangles, counter-clockwise as seen from outside. Copies share their data.
///
/// The surface has one side: bodies whose centre is behind a triangle pass through it.
#[derive(Clone, Debug)]
pub struct TriMesh {
    data: Arc<MeshData>,
    /// Of this handle, not of the data.
    sphere_merge: ContactMerge,
}

#[derive(Clone, Debug)]
struct MeshData {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// By triangles.
    facets: Vec<PaddedFacet>,
    neighbours: Vec<[Neighbour; 3]>,
    /// See [`TriMesh::use_flags`].
    use_flags: Vec<u8>,
    /// The first triangle at each vertex.
    first_triangle: Vec<u32>,
    tree: AabbTree,
    bounds: Aabb,
    /// Of a mesh whose vertices have moved.
    links: Option<Box<refit::Links>>,
}

/// A triangle's corners and normal as searches read them, four numbers at a time: two cache lines.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(crate) struct PaddedFacet {
    pub corners: [[f64; 4]; 3],
    /// Zero for a triangle without area, which touches nothing.
    pub normal: [f64; 4],
}

impl PaddedFacet {
    fn new(corners: [Vec3; 3]) -> Self {
        let padded = |Vec3 { x, y, z }| [x, y, z, 0.0];
        Self { corners: corners.map(padded), normal: padded(normal_of(corners)) }
    }

    #[inline(always)]
    fn corner(&self, k: usize) -> Vec3 {
        let [x, y, z, _] = self.corners[k];
        Vec3::new(x, y, z)
    }

    #[inline(always)]
    fn normal(&self) -> Vec3 {
        let [x, y, z, _] = self.normal;
        Vec3::new(x, y, z)
    }
}

/// What lies beyond an edge of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Neighbour {
    /// Nothing.
    None,
    /// A triangle in the same plane, or one that rises: nothing can touch the edge without touching a triangle.
    FlatOrConcave,
    /// A triangle that falls away, with this normal.
    Convex(Vec3),
}

impl Neighbour {
    /// What a triangle with the given normal has beyond its edge from `start` to `end`: a triangle with the third corner
    /// `apex` and the normal `other`.
    pub(crate) fn across(start: Vec3, end: Vec3, apex: Vec3, normal: Vec3, other: Vec3) -> Self {
        let (along, to_apex) = (end - start, apex - start);
        let rise = normal.dot(to_apex);
        // The apex is |along x to_apex| / |along| from the edge.
        let least = FLAT * FLAT * along.cross(to_apex).length_squared();
        if rise < 0.0 && rise * rise * along.length_squared() > least {
            Self::Convex(other)
        } else {
            Self::FlatOrConcave
        }
    }
}

impl PartialEq for TriMesh {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.data, &other.data)
            || (self.data.vertices == other.data.vertices && self.data.triangles == other.data.triangles)
    }
}

/// Sine of the angle up to which two triangles are one plane.
const FLAT: f64 = 1e-6;

impl TriMesh {
    /// A mesh of the given vertices and triangles. Vertices at the same place count as one where triangles meet.
    pub fn new(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, ShapeError> {
        if triangles.is_empty() {
            return Err(ShapeError { what: "number of triangles of a mesh", value: 0.0 });
        }
        check_vertices(&vertices)?;
        let bad = triangles.iter().flatten().find(|&&i| i as usize >= vertices.len());
        if let Some(bad) = bad {
            return Err(ShapeError { what: "vertex number of a triangle", value: f64::from(*bad) });
        }
        let at = |i: u32| vertices[i as usize];
        let facets: Vec<PaddedFacet> = triangles.iter().map(|t| PaddedFacet::new(t.map(at))).collect();
        let normals: Vec<Vec3> = facets.iter().map(PaddedFacet::normal).collect();
        let neighbours = neighbours(&vertices, &triangles, &normals);
        let use_flags = use_flags(&vertices, &triangles, &normals);
        let mut first_triangle = vec![u32::MAX; vertices.len()];
        for (i, t) in triangles.iter().enumerate().rev() {
            for &v in t {
                first_triangle[v as usize] = i as u32;
            }
        }
        let mut bounds = Aabb::EMPTY;
        let boxes: Vec<Aabb> = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(at);
                let aabb = Aabb::new(a.min(b).min(c), a.max(b).max(c));
                bounds = bounds.union(&aabb);
                aabb
            })
            .collect();
        let tree = AabbTree::build(&boxes);
        Ok(Self {
            sphere_merge: ContactMerge::None,
            data: Arc::new(MeshData {
                vertices,
                triangles,
                facets,
                neighbours,
                use_flags,
                first_triangle,
                tree,
                bounds,
                links: None,
            }),
        })
    }

    /// A mesh of loose triangles, as an STL file has them.
    pub fn from_triangles(soup: &[[Vec3; 3]]) -> Result<Self, ShapeError> {
        let mut vertices = Vec::new();
        let mut numbers = BTreeMap::new();
        let mut number = |p: Vec3| {
            *numbers.entry(place(p)).or_insert_with(|| {
                vertices.push(p);
                (vertices.len() - 1) as u32
            })
        };
        let triangles = soup.iter().map(|t| t.map(&mut number)).collect();
        Self::new(vertices, triangles)
    }

    /// The vertices.
    pub fn vertices(&self) -> &[Vec3] {
        &self.data.vertices
    }

    /// The vertex numbers of the triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.data.triangles
    }

    /// The corners of triangle `i`.
    #[inline]
    pub fn corners(&self, i: u32) -> [Vec3; 3] {
        let facet = self.padded(i);
        [facet.corner(0), facet.corner(1), facet.corner(2)]
    }

    /// Triangle `i` as searches read it.
    #[inline(always)]
    pub(crate) fn padded(&self, i: u32) -> &PaddedFacet {
        &self.data.facets[i as usize]
    }

    /// Corner `k` of triangle `i`.
    #[inline(always)]
    pub(crate) fn corner(&self, i: u32, k: usize) -> Vec3 {
        self.padded(i).corner(k)
    }

    /// Unit normal of triangle `i`; zero if it has no area.
    #[inline]
    pub fn normal(&self, i: u32) -> Vec3 {
        self.padded(i).normal()
    }

    /// What lies beyond the edges 0–1, 1–2 and 2–0 of triangle `i`.
    #[inline]
    pub fn neighbours(&self, i: u32) -> &[Neighbour; 3] {
        &self.data.neighbours[i as usize]
    }

    /// The same mesh, whose contacts with balls are merged that way; other shapes' are not.
    #[must_use]
    pub fn with_sphere_merge(mut self, merge: ContactMerge) -> Self {
        self.sphere_merge = merge;
        self
    }

    /// How contacts with balls are merged.
    pub fn sphere_merge(&self) -> ContactMerge {
        self.sphere_merge
    }

    /// The same mesh with other edges and vertices to touch than [`TriMesh::new`] finds: for each triangle bits 0 to 2 the
    /// edges, bits 3 to 5 the vertices (ODE's `dGeomTriMeshDataSet` with use flags). Only capsules ask for them.
    pub fn with_use_flags(mut self, flags: Vec<u8>) -> Result<Self, ShapeError> {
        if flags.len() != self.triangles().len() {
            return Err(ShapeError { what: "number of use flags of a mesh", value: flags.len() as f64 });
        }
        Arc::make_mut(&mut self.data).use_flags = flags;
        Ok(self)
    }

    /// Which edges and vertices of triangle `i` are its own to touch: bits 0 to 2 the edges, bits 3 to 5 the vertices. Each
    /// edge that is not concave is one triangle's, and each vertex without concave edges (ODE's use flags).
    pub(crate) fn use_flags(&self, i: u32) -> u8 {
        self.data.use_flags[i as usize]
    }

    /// The first triangle that has vertex `v`, if any has.
    pub fn first_triangle(&self, v: u32) -> Option<u32> {
        Some(self.data.first_triangle[v as usize]).filter(|&t| t != u32::MAX)
    }

    /// The boxes of the triangles.
    pub fn tree(&self) -> &AabbTree {
        &self.data.tree
    }

    /// The local box around all triangles.
    pub fn bounds(&self) -> &Aabb {
        &self.data.bounds
    }

    /// Volume in cubic metres, if the surface is closed.
    pub fn volume(&self) -> f64 {
        let triangle = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| self.data.vertices[v as usize]);
            a.dot(b.cross(c)) / 6.0
        };
        self.data.triangles.iter().map(triangle).sum()
    }

    /// The world box around the local box: ODE's, not the tightest.
    pub fn aabb(&self, frame: &Frame) -> Aabb {
        let (center, half) = (self.data.bounds.center(), self.data.bounds.extent() * 0.5);
        let range = |i: usize| {
            let r = frame.rotation.rows[i];
            (r[0] * half.x).abs() + (r[1] * half.y).abs() + (r[2] * half.z).abs()
        };
        Aabb::from_center(frame.point_to_world(center), Vec3::new(range(0), range(1), range(2)))
    }
}

/// A key that is the same for points at the same place: the two zeros are one.
fn place(p: Vec3) -> [u64; 3] {
    p.to_array().map(|x| (x + 0.0).to_bits())
}

fn check_vertices(vertices: &[Vec3]) -> Result<(), ShapeError> {
    match vertices.iter().find(|p| !(p.is_finite() && p.abs_max() <= LARGEST)) {
        Some(p) => Err(ShapeError { what: "coordinate of a mesh's vertex", value: p.abs_max() }),
        None => Ok(()),
    }
}

/// Unit normal of a triangle; zero if it has no area.
fn normal_of([a, b, c]: [Vec3; 3]) -> Vec3 {
    let (e, f) = (b - a, c - a);
    let n = e.cross(f);
    if n.length() > 1e-14 * e.length() * f.length() { n.normalized_or(Vec3::ZERO) } else { Vec3::ZERO }
}

/// An edge: its ends, the triangle, and which of its edges it is.
type Edge = (u32, u32, u32, u8);

/// The number of each vertex's place, and all edges, those with the same ends side by side.
fn edges_by_ends(vertices: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<Edge>) {
    let mut numbers = BTreeMap::new();
    let place_of: Vec<u32> = vertices
        .iter()
        .map(|&p| {
            let next = numbers.len() as u32;
            *numbers.entry(place(p)).or_insert(next)
        })
        .collect();
    let mut edges: Vec<Edge> = Vec::with_capacity(3 * triangles.len());
    for (i, t) in triangles.iter().enumerate() {
        for e in 0..3 {
            let (a, b) = (place_of[t[e] as usize], place_of[t[(e + 1) % 3] as usize]);
            edges.push((a.min(b), a.max(b), i as u32, e as u8));
        }
    }
    edges.sort_unstable();
    (place_of, edges)
}

fn neighbours(vertices: &[Vec3], triangles: &[[u32; 3]], normals: &[Vec3]) -> Vec<[Neighbour; 3]> {
    let (_, edges) = edges_by_ends(vertices, triangles);
    let mut found = vec![[Neighbour::None; 3]; triangles.len()];
    for pair in edges.windows(2) {
        let [(a0, b0, t0, e0), (a1, b1, t1, e1)] = [pair[0], pair[1]];
        if (a0, b0) != (a1, b1) || normals[t0 as usize] == Vec3::ZERO || normals[t1 as usize] == Vec3::ZERO {
            continue;
        }
        for (t, e, other, f) in [(t0, e0, t1, e1), (t1, e1, t0, e0)] {
            let corners = triangles[t as usize].map(|v| vertices[v as usize]);
            let apex = vertices[triangles[other as usize][(usize::from(f) + 2) % 3] as usize];
            let start = corners[usize::from(e)];
            let end = corners[(usize::from(e) + 1) % 3];
            found[t as usize][usize::from(e)] =
                Neighbour::across(start, end, apex, normals[t as usize], normals[other as usize]);
        }
    }
    found
}

fn use_flags(vertices: &[Vec3], triangles: &[[u32; 3]], normals: &[Vec3]) -> Vec<u8> {
    let mut numbers = BTreeMap::new();
    let place_of: Vec<u32> = vertices
        .iter()
        .map(|&v| {
            let next = numbers.len() as u32;
            *numbers.entry(place(v)).or_insert(next)
        })
        .collect();
    let mut edges: BTreeMap<(u32, u32), Vec<(usize, usize)>> = BTreeMap::new();
    for (i, t) in triangles.iter().enumerate() {
        for e in 0..3 {
            let (a, b) = (place_of[t[e] as usize], place_of[t[(e + 1) % 3] as usize]);
            edges.entry((a.min(b), a.max(b))).or_default().push((i, e));
        }
    }
    let mut flags = vec![0u8; triangles.len()];
    let mut concave = vec![false; numbers.len()];
    for ((a, b), users) in &edges {
        let is_concave = users.len() >= 2 && {
            let [(i, e), (j, f)] = [users[0], users[1]];
            let p = |t: usize, k: usize| vertices[triangles[t][k % 3] as usize];
            let (start, end, apex) = (p(i, e), p(i, e + 1), p(j, f + 2));
            let along = (end - start).normalized_or(Vec3::ZERO);
            let h = (apex - start) - along * along.dot(apex - start);
            let rise = normals[i].dot(h);
            rise > 0.0 && rise * rise >= 1e-12 * h.length_squared()
        };
        if is_concave {
            concave[*a as usize] = true;
            concave[*b as usize] = true;
        } else {
            let (i, e) = users[0];
            flags[i] |= 1 << e;
        }
    }
    let mut used = vec![false; numbers.len()];
    for (i, t) in triangles.iter().enumerate() {
        for k in 0..3 {
            let v = place_of[t[k] as usize] as usize;
            if !concave[v] && !used[v] {
                used[v] = true;
                flags[i] |= 8 << k;
            }
        }
    }
    flags
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The unit cube's surface.
    fn cube() -> TriMesh {
        let vertices =
            (0..8u8).map(|i| Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)));
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
        TriMesh::new(vertices.collect(), triangles).unwrap()
    }

    #[test]
    fn edges_of_a_cube() {
        let mesh = cube();
        assert!((mesh.volume() - 1.0).abs() < 1e-15);
        for i in 0..12 {
            let n = mesh.neighbours(i);
            assert_eq!(n.iter().filter(|e| matches!(e, Neighbour::Convex(_))).count(), 2);
            assert_eq!(n.iter().filter(|e| **e == Neighbour::FlatOrConcave).count(), 1);
        }
        // Loose triangles find each other again.
        let soup: Vec<_> = (0..12).map(|i| mesh.corners(i)).collect();
        let welded = TriMesh::from_triangles(&soup).unwrap();
        assert_eq!(welded.vertices().len(), 8);
        assert_eq!(welded.neighbours(0), mesh.neighbours(0));
    }

    #[test]
    fn bad_meshes_are_errors() {
        assert!(TriMesh::new(vec![Vec3::ZERO; 3], vec![]).is_err());
        assert!(TriMesh::new(vec![Vec3::ZERO; 3], vec![[0, 1, 3]]).is_err());
        assert!(TriMesh::new(vec![Vec3::X * f64::NAN; 3], vec![[0, 1, 2]]).is_err());
        // In one coordinate only.
        assert!(TriMesh::new(vec![Vec3::new(1.0, f64::NAN, 0.0); 3], vec![[0, 1, 2]]).is_err());
        // A triangle without area is kept, but has no normal.
        let line = TriMesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::X * 2.0], vec![[0, 1, 2]]).unwrap();
        assert_eq!(line.normal(0), Vec3::ZERO);
    }
}
