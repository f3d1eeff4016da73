//! Depth of two convex bodies that overlap, by the expanding polytope (van den Bergen, *Proximity queries and
//! penetration depth computation on 3D game objects*, 2001).
//!
//! A polytope within the difference {a − b} grows around the origin at its face nearest to it, until that face lies on
//! the difference's surface: its normal is the direction of least overlap.

use super::gjk::Simplex;
use super::support::{Body, Vertex, difference};
use ferrode_math::Vec3;

const VERTICES: usize = 80;
const FACES: usize = 192;
const EDGES: usize = 128;

/// The least overlap of two cores.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Depth {
    /// Unit: moving the first body by −normal · depth separates the two.
    pub normal: Vec3,
    pub depth: f64,
    /// The points of the bodies that touch then, before that move.
    pub a: Vec3,
    pub b: Vec3,
}

#[derive(Clone, Copy, Debug, Default)]
struct Face {
    v: [u8; 3],
    normal: Vec3,
    distance: f64,
}

struct Polytope {
    vertices: [Vertex; VERTICES],
    vertex_count: usize,
    faces: [Face; FACES],
    face_count: usize,
}

impl Polytope {
    /// A face with the given corners; one without area is never the nearest.
    fn add_face(&mut self, v: [u8; 3]) -> bool {
        if self.face_count == FACES {
            return false;
        }
        let w = |i: usize| self.vertices[usize::from(v[i])].w;
        let (e, f) = (w(1) - w(0), w(2) - w(0));
        let cross = e.cross(f);
        let area = cross.length();
        let flat = !(area > 1e-14 * (e.length() * f.length()).max(f64::MIN_POSITIVE));
        let normal = if flat { Vec3::ZERO } else { cross * (1.0 / area) };
        let distance = if flat { f64::INFINITY } else { normal.dot(w(0)) };
        self.faces[self.face_count] = Face { v, normal, distance };
        self.face_count += 1;
        true
    }

    fn nearest_face(&self) -> Option<usize> {
        let mut best: Option<usize> = None;
        for (i, f) in self.faces[..self.face_count].iter().enumerate() {
            if f.distance.is_finite() && best.is_none_or(|b| f.distance < self.faces[b].distance) {
                best = Some(i);
            }
        }
        best
    }

    /// Replaces the faces that see `next` by a fan of faces to it. False if there is no room.
    ///
    /// Only faces connected to `start`, which sees it, through others that do are taken: among faces in one plane
    /// rounding decides which see the point, and taking those alone could tear a second hole.
    fn expand(&mut self, start: usize, next: Vertex, slack: f64) -> bool {
        if self.vertex_count == VERTICES {
            return false;
        }
        let apex = self.vertex_count as u8;
        let mut seen = [0u16; FACES];
        let mut marked = [false; FACES];
        seen[0] = start as u16;
        marked[start] = true;
        let (mut count, mut done) = (1, 0);
        let mut edges = [(0u8, 0u8); EDGES];
        let mut edge_count = 0;
        while done < count {
            let [a, b, c] = self.faces[usize::from(seen[done])].v;
            done += 1;
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let Some(other) = self.face_with_edge(to, from) else { return false };
                if marked[other] {
                    continue;
                }
                let f = &self.faces[other];
                let height = f.normal.dot(next.w - self.vertices[usize::from(f.v[0])].w);
                // A face without area goes with its neighbours.
                if !f.distance.is_finite() || height > slack {
                    marked[other] = true;
                    seen[count] = other as u16;
                    count += 1;
                } else if edge_count < EDGES {
                    edges[edge_count] = (from, to);
                    edge_count += 1;
                } else {
                    return false;
                }
            }
        }
        // A face may have been taken after an edge to it was noted.
        let mut kept = 0;
        for k in 0..edge_count {
            let (from, to) = edges[k];
            if self.face_with_edge(to, from).is_some_and(|f| !marked[f]) {
                edges[kept] = (from, to);
                kept += 1;
            }
        }
        if kept < 3 || self.face_count - count + kept > FACES {
            return false;
        }
        let mut remaining = 0;
        for (i, &gone) in marked[..self.face_count].iter().enumerate() {
            if !gone {
                self.faces[remaining] = self.faces[i];
                remaining += 1;
            }
        }
        self.face_count = remaining;
        self.vertices[self.vertex_count] = next;
        self.vertex_count += 1;
        edges[..kept].iter().all(|&(from, to)| self.add_face([from, to, apex]))
    }

    /// The face that has the edge in this direction.
    fn face_with_edge(&self, from: u8, to: u8) -> Option<usize> {
        self.faces[..self.face_count].iter().position(|f| {
            let [a, b, c] = f.v;
            (a == from && b == to) || (b == from && c == to) || (c == from && a == to)
        })
    }
}

/// Completes a simplex to a tetrahedron; `None` if the difference is flat.
fn tetrahedron(a: &Body<'_>, b: &Body<'_>, simplex: &Simplex, scale: f64) -> Option<[Vertex; 4]> {
    let small = 1e-12 * scale;
    let mut v = simplex.vertices;
    let mut n = simplex.count;
    if n == 1 {
        let far = |p: &Vertex| (p.w - v[0].w).length() > small;
        let axes = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
        v[1] = axes.iter().map(|&d| difference(a, b, d)).find(far)?;
        n = 2;
    }
    if n == 2 {
        let line = (v[1].w - v[0].w).normalized()?;
        let (p, q) = ferrode_math::plane_space(line);
        let far = |x: &Vertex| (x.w - v[0].w).cross(line).length() > small;
        v[2] = [p, -p, q, -q, p + q, p - q, q - p, -p - q].iter().map(|&d| difference(a, b, d)).find(far)?;
        n = 3;
    }
    if n == 3 {
        let normal = (v[1].w - v[0].w).cross(v[2].w - v[0].w).normalized()?;
        let far = |x: &Vertex| (x.w - v[0].w).dot(normal).abs() > small;
        v[3] = [normal, -normal].iter().map(|&d| difference(a, b, d)).find(far)?;
    }
    Some(v)
}

/// The least overlap of two cores that share a point. `None` if their difference is flat, and so the overlap nil.
pub(crate) fn epa(a: &Body<'_>, b: &Body<'_>, simplex: &Simplex) -> Option<Depth> {
    epa_to(a, b, simplex, EXACT)
}

/// How near to the least depth the search comes, in parts of the bodies' size.
const EXACT: f64 = 1e-9;

/// As [`epa`], but the polytope need not come nearer to the least depth than `rest` of the bodies' size.
pub(crate) fn epa_to(a: &Body<'_>, b: &Body<'_>, simplex: &Simplex, rest: f64) -> Option<Depth> {
    let scale = a.reach() + b.reach();
    let corners = tetrahedron(a, b, simplex, scale)?;
    let mut p = Polytope {
        vertices: [Vertex::default(); VERTICES],
        vertex_count: 4,
        faces: [Face::default(); FACES],
        face_count: 0,
    };
    p.vertices[..4].copy_from_slice(&corners);
    let w = |i: usize| corners[i].w;
    let volume = (w(1) - w(0)).cross(w(2) - w(0)).dot(w(3) - w(0));
    // Faces counter-clockwise seen from outside.
    let faces = if volume < 0.0 {
        [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    } else {
        [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    };
    for f in faces {
        p.add_face(f);
    }
    let tolerance = rest * scale;
    let slack = 1e-15 * scale;
    let mut nearest = p.nearest_face()?;
    let mut upper = f64::INFINITY;
    let mut result = p.faces[nearest];
    for _ in 0..VERTICES {
        let best = p.faces[nearest];
        let next = difference(a, b, best.normal);
        let reach = best.normal.dot(next.w);
        // Of all normals tried, the one along which the bodies overlap least; of equals the last, whose face touches the
        // surface and so has the points that touch.
        if reach <= upper + tolerance {
            upper = reach.min(upper);
            result = best;
        }
        if reach - best.distance <= tolerance || !p.expand(nearest, next, slack) {
            break;
        }
        match p.nearest_face() {
            Some(f) => nearest = f,
            None => break,
        }
    }
    let [i, j, k] = result.v.map(|i| p.vertices[usize::from(i)]);
    let (places, weights, n) = nearest_on_face(&i, &j, &k, result.normal * result.distance);
    let corner = [i, j, k];
    let (mut pa, mut pb) = (Vec3::ZERO, Vec3::ZERO);
    for m in 0..n {
        pa += corner[places[m]].a * weights[m];
        pb += corner[places[m]].b * weights[m];
    }
    let depth = Depth { normal: result.normal, depth: upper.max(0.0), a: pa, b: pb };
    // What was left is mostly the lean of the normal on surfaces that are curved.
    let rough = rest > EXACT || upper - result.distance > tolerance;
    Some(if rough { polish(a, b, depth, EXACT * scale) } else { depth })
}

/// Improves a normal that ran out of faces, on surfaces curved both ways.
///
/// The reach h(n) = n · w(n) of the difference changes along a great circle with direction t at the rate t · w, and that
/// rate at ρ − h, where ρ = t · dw/dθ is the radius of curvature: Newton steps down the steepest direction.
fn polish(a: &Body<'_>, b: &Body<'_>, start: Depth, tolerance: f64) -> Depth {
    const PROBE: f64 = 1e-4;
    let mut best = start;
    for _ in 0..16 {
        let n = best.normal;
        let at = difference(a, b, n);
        let h = n.dot(at.w);
        let Some(t) = (at.w - n * h).normalized() else { break };
        let slope = t.dot(at.w);
        let probe = difference(a, b, (n - t * PROBE).normalized_or(n));
        let radius = t.dot(at.w - probe.w) / PROBE;
        if slope <= 0.0 || !(radius > h) {
            break;
        }
        let step = slope / (radius - h);
        let m = (n - t * step.min(0.1)).normalized_or(n);
        let next = difference(a, b, m);
        let reach = m.dot(next.w);
        if !(reach < best.depth - 1e-3 * tolerance) {
            break;
        }
        best = Depth { normal: m, depth: reach.max(0.0), a: next.a, b: next.b };
    }
    best
}

fn nearest_on_face(i: &Vertex, j: &Vertex, k: &Vertex, p: Vec3) -> ([usize; 3], [f64; 3], usize) {
    super::gjk::nearest_of_triangle(i.w - p, j.w - p, k.w - p)
}
