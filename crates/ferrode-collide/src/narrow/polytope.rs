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
/// Room in lists that are looked up by a byte, which needs no check then.
const ROOM: usize = 256;

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
    /// Which of their edges these are.
    edge: [u8; 3],
    /// Without area: it has no normal, and goes with its neighbours.
    flat: bool,
    seen: bool,
    pub normal: Vec3,
    /// Of its plane from the origin.
    pub distance: f64,
}

/// An edge of the hole that a new corner closes, from end to end as the faces that go had it.
#[derive(Clone, Copy, Debug)]
struct Rim {
    from: u8,
    to: u8,
    /// The face that stays, and which of its edges it is.
    beyond: u8,
    edge: u8,
}

pub(super) struct Polytope {
    vertices: [Vertex; ROOM],
    vertex_count: usize,
    faces: [Face; ROOM],
    /// As in the faces; infinite for those that are gone, flat or closed.
    distances: [f64; ROOM],
    face_count: usize,
    /// Places of faces that are gone.
    free: [u8; FACES],
    free_count: usize,
    /// Working memory: faces that go, edges to look across (face and its edge), edges of the hole, and places of new faces.
    seen: [u8; FACES],
    ahead: [(u8, u8); 2 * FACES],
    hole: [Rim; HOLE],
    places: [u8; HOLE],
}

impl Polytope {
    pub(super) const EMPTY: Self = Self {
        vertices: [Vertex { w: Vec3::ZERO, a: Vec3::ZERO, b: Vec3::ZERO }; ROOM],
        vertex_count: 0,
        faces: [Face {
            v: [0; 3],
            across: [0; 3],
            edge: [0; 3],
            flat: false,
            seen: false,
            normal: Vec3::ZERO,
            distance: 0.0,
        }; ROOM],
        distances: [0.0; ROOM],
        face_count: 0,
        free: [0; FACES],
        free_count: 0,
        seen: [0; FACES],
        ahead: [(0, 0); 2 * FACES],
        hole: [Rim { from: 0, to: 0, beyond: 0, edge: 0 }; HOLE],
        places: [0; HOLE],
    };

    /// A tetrahedron.
    pub fn start(&mut self, corners: [Vertex; 4]) {
        self.vertices[..4].copy_from_slice(&corners);
        (self.vertex_count, self.face_count, self.free_count) = (4, 4, 0);
        let w = |i: usize| corners[i].w;
        let volume = (w(1) - w(0)).cross(w(2) - w(0)).dot(w(3) - w(0));
        for (i, (v, across, edge)) in tetrahedron(volume < 0.0).into_iter().enumerate() {
            self.set(i, v, across, edge);
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

    #[inline]
    fn set(&mut self, i: usize, v: [u8; 3], across: [u8; 3], edge: [u8; 3]) {
        let [p, q, r] = v.map(|k| self.vertices[usize::from(k)].w);
        let (e, f) = (q - p, r - p);
        let cross = e.cross(f);
        let area2 = cross.length_squared();
        // Below the second bound squares have lost digits.
        let flat = !(area2 > (1e-28 * e.length_squared() * f.length_squared()).max(1e-290));
        let normal = if flat { Vec3::ZERO } else { cross * (1.0 / area2.sqrt()) };
        let distance = if flat { f64::INFINITY } else { normal.dot(p) };
        self.distances[i] = distance;
        self.faces[i] = Face { v, across, edge, flat, seen: false, normal, distance };
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
        let (count, length) = self.cut(start, next.w, slack);
        let count = count.min(FACES);
        for &i in &self.seen[..count] {
            self.faces[usize::from(i)].seen = false;
        }
        let room = FACES - self.face_count + self.free_count + count;
        let Some(hole) = self.hole.get(..length) else { return false };
        let closed = (1..length).all(|m| hole[m - 1].to == hole[m].from);
        if length < 3 || length > room || !closed || hole[length - 1].to != hole[0].from {
            return false;
        }
        for &i in &self.seen[..count] {
            self.distances[usize::from(i)] = f64::INFINITY;
            self.free[self.free_count] = i;
            self.free_count += 1;
        }
        let apex = self.vertex_count as u8;
        self.vertices[self.vertex_count] = next;
        self.vertex_count += 1;
        // Places first: each new face names the ones before and after it.
        for place in &mut self.places[..length] {
            *place = if self.free_count > 0 {
                self.free_count -= 1;
                self.free[self.free_count]
            } else {
                self.face_count += 1;
                (self.face_count - 1) as u8
            };
        }
        let mut before = self.places[length - 1];
        for m in 0..length {
            let Rim { from, to, beyond, edge } = self.hole[m];
            let place = self.places[m];
            let after = self.places[if m + 1 == length { 0 } else { m + 1 }];
            self.set(usize::from(place), [from, to, apex], [beyond, after, before], [edge, 2, 1]);
            let f = &mut self.faces[usize::from(beyond)];
            f.across[usize::from(edge % 3)] = place;
            f.edge[usize::from(edge % 3)] = 0;
            before = place;
        }
        true
    }

    /// Notes the faces that see a point, from one that does on, and the edges around them in their order, counter-clockwise;
    /// returns how many there are of either. Too many edges are more than [`HOLE`].
    fn cut(&mut self, start: usize, w: Vec3, slack: f64) -> (usize, usize) {
        let (mut count, mut length, mut waiting) = (1, 0, 0);
        let first = &mut self.faces[start];
        first.seen = true;
        self.seen[0] = start as u8;
        // The edges of a face in their order: the last is put down first.
        for k in [2, 1, 0] {
            self.ahead[waiting] = (first.across[k], first.edge[k]);
            waiting += 1;
        }
        while waiting > 0 {
            waiting -= 1;
            let (i, e) = self.ahead[waiting];
            let f = &mut self.faces[usize::from(i)];
            if f.seen {
                continue;
            }
            let (here, on) = (usize::from(e % 3), if e == 2 { 0 } else { usize::from(e) + 1 });
            if f.flat || f.normal.dot(w - self.vertices[usize::from(f.v[0])].w) > slack {
                f.seen = true;
                self.seen[count] = i;
                count += 1;
                let then = if on == 2 { 0 } else { on + 1 };
                self.ahead[waiting] = (f.across[then], f.edge[then]);
                self.ahead[waiting + 1] = (f.across[on], f.edge[on]);
                waiting += 2;
            } else {
                if length == HOLE {
                    return (count, HOLE + 1);
                }
                self.hole[length] = Rim { from: f.v[on], to: f.v[here], beyond: i, edge: e };
                length += 1;
            }
        }
        (count, length)
    }
}

/// The faces of a tetrahedron, counter-clockwise seen from outside: corners, neighbours, and which of their edges these meet.
/// `below` says on which side of the first three corners the fourth is.
const fn tetrahedron(below: bool) -> [([u8; 3], [u8; 3], [u8; 3]); 4] {
    if below {
        [
            ([0, 1, 2], [1, 3, 2], [2, 2, 0]),
            ([0, 3, 1], [2, 3, 0], [2, 0, 0]),
            ([0, 2, 3], [0, 3, 1], [2, 1, 0]),
            ([1, 3, 2], [1, 2, 0], [1, 1, 1]),
        ]
    } else {
        [
            ([0, 2, 1], [2, 3, 1], [2, 0, 0]),
            ([0, 1, 3], [0, 3, 2], [2, 2, 0]),
            ([0, 3, 2], [1, 3, 0], [2, 1, 0]),
            ([1, 2, 3], [0, 2, 1], [1, 1, 1]),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each face names the neighbours with which it shares the ends of its edges.
    fn check(p: &Polytope) {
        let gone = &p.free[..p.free_count];
        let faces: Vec<_> = (0..p.face_count).filter(|&i| !gone.contains(&(i as u8))).collect();
        let mut corners: Vec<u8> = faces.iter().flat_map(|&i| p.faces[i].v).collect();
        corners.sort_unstable();
        corners.dedup();
        assert_eq!(faces.len(), 2 * corners.len() - 4);
        for &i in &faces {
            let f = p.faces[i];
            for k in 0..3 {
                let (g, m) = (p.faces[usize::from(f.across[k])], usize::from(f.edge[k]));
                assert_eq!((usize::from(g.across[m]), usize::from(g.edge[m])), (i, k));
                assert_eq!((g.v[m], g.v[(m + 1) % 3]), (f.v[(k + 1) % 3], f.v[k]));
            }
        }
    }

    #[test]
    fn faces_know_their_neighbours() {
        let at = |x: f64, y: f64, z: f64| {
            let w = Vec3::new(x, y, z);
            Vertex { w, a: w, b: Vec3::ZERO }
        };
        for z in [1.0, -1.0] {
            let mut p = Polytope::EMPTY;
            let base = [at(1.0, 0.0, -0.3 * z), at(-0.5, 0.8, -0.3 * z), at(-0.5, -0.8, -0.3 * z)];
            p.start([base[0], base[1], base[2], at(0.0, 0.0, z)]);
            check(&p);
            for i in 0..30 {
                let (t, h) = (2.4 * f64::from(i), -0.95 + 0.06 * f64::from(i));
                let r = (1.0 - h * h).sqrt() * 1.2;
                let (s, c) = (ferrode_math::real::sin(t), ferrode_math::real::cos(t));
                let next = at(r * c, r * s, 1.2 * h);
                let sees = |f: &Face| f.normal.dot(next.w) - f.distance;
                let (count, gone) = (p.face_count, p.free[..p.free_count].to_vec());
                let best = (0..count)
                    .filter(|&i| !gone.contains(&(i as u8)))
                    .max_by(|&i, &j| sees(&p.faces[i]).total_cmp(&sees(&p.faces[j])));
                let best = best.filter(|&i| sees(&p.faces[i]) > 0.0).unwrap();
                assert!(p.expand(best, next, 1e-15));
                check(&p);
            }
        }
    }
}
