//! The polytope that grows in [EPA](super::epa): triangles that know their neighbours.

use super::support::Vertex;
use core::cell::RefCell;
use ferrode_math::Vec3;

const VERTICES: usize = 96;
/// Euler: a closed surface of triangles over v corners has 2 v − 4.
const FACES: usize = 2 * VERTICES;
/// Cosine of the normals of faces in one plane.
const ONE_PLANE: f64 = 1.0 - 1e-9;
/// Most edges of the hole that a new corner closes.
const HOLE: usize = 96;

thread_local! {
    /// One for each thread: to fill it with zeros at every call would take longer than most calls.
    pub(super) static POLYTOPE: RefCell<Polytope> = const { RefCell::new(Polytope::EMPTY) };
}

/// A triangle, counter-clockwise as seen from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub v: [u8; 3],
    /// The faces across the edges 0–1, 1–2 and 2–0.
    across: [u8; 3],
    /// Without area: it has no normal, and goes with its neighbours.
    flat: bool,
    seen: bool,
    pub normal: Vec3,
    /// Of its plane from the origin.
    pub distance: f64,
}

pub(super) struct Polytope {
    vertices: [Vertex; VERTICES],
    vertex_count: usize,
    faces: [Face; FACES],
    /// As in the faces; infinite for those that are gone, flat or closed.
    distances: [f64; FACES],
    face_count: usize,
    /// Places of faces that are gone.
    free: [u8; FACES],
    free_count: usize,
}

impl Polytope {
    pub(super) const EMPTY: Self = Self {
        vertices: [Vertex { w: Vec3::ZERO, a: Vec3::ZERO, b: Vec3::ZERO }; VERTICES],
        vertex_count: 0,
        faces: [Face {
            v: [0; 3],
            across: [0; 3],
            flat: false,
            seen: false,
            normal: Vec3::ZERO,
            distance: 0.0,
        }; FACES],
        distances: [0.0; FACES],
        face_count: 0,
        free: [0; FACES],
        free_count: 0,
    };

    /// A tetrahedron.
    pub fn start(&mut self, corners: [Vertex; 4]) {
        self.vertices[..4].copy_from_slice(&corners);
        (self.vertex_count, self.face_count, self.free_count) = (4, 4, 0);
        let w = |i: usize| corners[i].w;
        let volume = (w(1) - w(0)).cross(w(2) - w(0)).dot(w(3) - w(0));
        // Faces counter-clockwise seen from outside, and their neighbours.
        let faces: [([u8; 3], [u8; 3]); 4] = if volume < 0.0 {
            [([0, 1, 2], [1, 3, 2]), ([0, 3, 1], [2, 3, 0]), ([0, 2, 3], [0, 3, 1]), ([1, 3, 2], [1, 2, 0])]
        } else {
            [([0, 2, 1], [2, 3, 1]), ([0, 1, 3], [0, 3, 2]), ([0, 3, 2], [1, 3, 0]), ([1, 2, 3], [0, 2, 1])]
        };
        for (i, (v, across)) in faces.into_iter().enumerate() {
            self.set(i, v, across);
        }
    }

    pub fn face(&self, i: usize) -> Face {
        self.faces[i]
    }

    pub fn vertex(&self, i: u8) -> Vertex {
        self.vertices[usize::from(i)]
    }

    /// Whether a face has a corner at this point.
    pub fn has_point(&self, face: usize, w: Vec3) -> bool {
        self.faces[face].v.iter().any(|&i| self.vertices[usize::from(i)].w == w)
    }

    /// Of the faces in the plane of another, up to `slack`, the one that comes nearest to a point of it.
    pub fn at_point(&self, face: Face, point: Vec3, slack: f64) -> Face {
        let beside = |f: &Face| {
            let [i, j, k] = f.v.map(|v| self.vertices[usize::from(v)].w - point);
            let (places, weights, n) = super::gjk::nearest_of_triangle(i, j, k);
            let corner = [i, j, k];
            (0..n).fold(Vec3::ZERO, |s, m| s + corner[places[m]] * weights[m]).length_squared()
        };
        let mut best = (beside(&face), face);
        if best.0 <= slack * slack {
            return face;
        }
        for (f, &distance) in self.faces[..self.face_count].iter().zip(&self.distances) {
            if (distance - face.distance).abs() <= slack && f.normal.dot(face.normal) > ONE_PLANE {
                let off = beside(f);
                if off < best.0 {
                    best = (off, *f);
                }
            }
        }
        best.1
    }

    /// Has a face never be the nearest.
    pub fn close(&mut self, face: usize) {
        self.distances[face] = f64::INFINITY;
    }

    fn set(&mut self, i: usize, v: [u8; 3], across: [u8; 3]) {
        let [p, q, r] = v.map(|k| self.vertices[usize::from(k)].w);
        let (e, f) = (q - p, r - p);
        let cross = e.cross(f);
        let area2 = cross.length_squared();
        // Below the second bound squares have lost digits.
        let flat = !(area2 > (1e-28 * e.length_squared() * f.length_squared()).max(1e-290));
        let normal = if flat { Vec3::ZERO } else { cross * (1.0 / area2.sqrt()) };
        let distance = if flat { f64::INFINITY } else { normal.dot(p) };
        self.distances[i] = distance;
        self.faces[i] = Face { v, across, flat, seen: false, normal, distance };
    }

    /// The face that is nearest to the origin.
    pub fn nearest(&self) -> Option<usize> {
        let mut best = (f64::INFINITY, usize::MAX);
        for (i, &d) in self.distances[..self.face_count].iter().enumerate() {
            if d < best.0 {
                best = (d, i);
            }
        }
        (best.1 != usize::MAX).then_some(best.1)
    }

    /// Replaces the faces that see `next` by a fan of faces to it. False if there is no room, or rounding makes no hole of
    /// one edge of what is seen.
    ///
    /// Only faces connected to `start`, which sees it, through others that do are taken: among faces in one plane
    /// rounding decides which see the point, and taking those alone could tear a second hole.
    pub fn expand(&mut self, start: usize, next: Vertex, slack: f64) -> bool {
        if self.vertex_count == VERTICES {
            return false;
        }
        let mut seen = [0u8; FACES];
        seen[0] = start as u8;
        self.faces[start].seen = true;
        let (mut count, mut done, mut rim) = (1, 0, 0);
        let mut edge = (start, 0);
        while done < count {
            let i = usize::from(seen[done]);
            done += 1;
            for k in 0..3 {
                let other = usize::from(self.faces[i].across[k]);
                let f = &self.faces[other];
                if f.seen {
                    continue;
                }
                let height = f.normal.dot(next.w - self.vertices[usize::from(f.v[0])].w);
                if f.flat || height > slack {
                    self.faces[other].seen = true;
                    seen[count] = other as u8;
                    count += 1;
                } else {
                    rim += 1;
                    edge = (i, k);
                }
            }
        }
        // An edge to a face that was seen later is none.
        let room = FACES - self.face_count + self.free_count + count;
        let mut hole = [(0u8, 0u8, 0u8); HOLE];
        let length = self.walk_round(edge, rim, &mut hole);
        for &i in &seen[..count] {
            self.faces[usize::from(i)].seen = false;
        }
        if length < 3 || length > room {
            return false;
        }
        for &i in &seen[..count] {
            self.close(usize::from(i));
            self.free[self.free_count] = i;
            self.free_count += 1;
        }
        let apex = self.vertex_count as u8;
        self.vertices[self.vertex_count] = next;
        self.vertex_count += 1;
        // Places first: each new face names the ones before and after it.
        let mut places = [0u8; HOLE];
        for place in &mut places[..length] {
            *place = if self.free_count > 0 {
                self.free_count -= 1;
                self.free[self.free_count]
            } else {
                self.face_count += 1;
                (self.face_count - 1) as u8
            };
        }
        for m in 0..length {
            let (from, to, beyond) = hole[m];
            let (before, after) = (
                places[if m == 0 { length - 1 } else { m - 1 }],
                places[if m + 1 == length { 0 } else { m + 1 }],
            );
            self.set(usize::from(places[m]), [from, to, apex], [beyond, after, before]);
            let f = &mut self.faces[usize::from(beyond)];
            for k in 0..3 {
                if f.v[k] == to && f.v[(k + 1) % 3] == from {
                    f.across[k] = places[m];
                }
            }
        }
        true
    }

    /// The edges around what is seen, in order, each with the face beyond, beginning with one of them; their number, or 0
    /// if they are not `rim` edges in one round.
    fn walk_round(&self, edge: (usize, usize), rim: usize, hole: &mut [(u8, u8, u8); HOLE]) -> usize {
        let (mut i, mut k) = edge;
        // The last one noted may have been seen later.
        if rim == 0 || self.faces[usize::from(self.faces[i].across[k])].seen {
            return 0;
        }
        let mut length = 0;
        loop {
            let f = &self.faces[i];
            if length == HOLE || length > rim {
                return 0;
            }
            hole[length] = (f.v[k], f.v[(k + 1) % 3], f.across[k]);
            length += 1;
            // On from the edge's end: across faces that are seen to the next one that is not.
            k = (k + 1) % 3;
            let mut turns = 0;
            while self.faces[usize::from(self.faces[i].across[k])].seen {
                let (from, other) = (self.faces[i].v[k], usize::from(self.faces[i].across[k]));
                let g = &self.faces[other];
                // The common edge ends where ours begins; on with the one after it.
                let Some(m) = (0..3).find(|&m| g.v[(m + 1) % 3] == from && usize::from(g.across[m]) == i)
                else {
                    return 0;
                };
                (i, k) = (other, (m + 1) % 3);
                turns += 1;
                if turns > FACES {
                    return 0;
                }
            }
            if (i, k) == edge {
                break;
            }
        }
        if length == rim { length } else { 0 }
    }
}
