//! Distance of two convex bodies (Gilbert, Johnson and Keerthi, *A fast procedure for computing the distance between
//! complex objects in three-dimensional space*, 1988).
//!
//! The bodies are as far apart as their difference {a − b} is from the origin. A simplex of support points of the
//! difference walks towards the origin until no support point is nearer.

use super::support::{Body, Vertex, difference};
use ferrode_math::Vec3;

const ITERATIONS: usize = 100;

/// Up to four points of the difference, and the weights of the point nearest to the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simplex {
    pub vertices: [Vertex; 4],
    pub weights: [f64; 4],
    pub count: usize,
}

/// What GJK finds about two cores.
// Lives on the stack for a moment: boxing the large variant would allocate.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug)]
pub(crate) enum Gap {
    /// Further apart than was asked about.
    Far,
    /// Apart: nearest points and the difference a − b, which is not zero.
    Apart { a: Vec3, b: Vec3, between: Vec3 },
    /// They share a point, up to rounding: a simplex that contains, or touches, the origin.
    Overlap(Simplex),
}

impl Simplex {
    /// The point with the present weights.
    fn nearest(&self) -> Vec3 {
        let mut v = Vec3::ZERO;
        for i in 0..self.count {
            v += self.vertices[i].w * self.weights[i];
        }
        v
    }

    /// The points of the two bodies with the present weights.
    pub fn witnesses(&self) -> (Vec3, Vec3) {
        let (mut a, mut b) = (Vec3::ZERO, Vec3::ZERO);
        for i in 0..self.count {
            a += self.vertices[i].a * self.weights[i];
            b += self.vertices[i].b * self.weights[i];
        }
        (a, b)
    }

    fn push(&mut self, v: Vertex) {
        self.vertices[self.count] = v;
        self.count += 1;
    }

    /// Keeps the vertices at the given places, with these weights.
    fn keep(&mut self, places: &[usize], weights: &[f64]) {
        let old = self.vertices;
        for (k, (&i, &w)) in places.iter().zip(weights).enumerate() {
            self.vertices[k] = old[i];
            self.weights[k] = w;
        }
        self.count = places.len();
    }

    /// Reduces the simplex to the part that is nearest to the origin. True if it contains the origin.
    fn reduce(&mut self) -> bool {
        let w = |i: usize| self.vertices[i].w;
        match self.count {
            1 => self.weights[0] = 1.0,
            2 => {
                let (places, weights, n) = nearest_of_segment(w(0), w(1));
                self.keep(&places[..n], &weights[..n]);
            }
            3 => {
                let (places, weights, n) = nearest_of_triangle(w(0), w(1), w(2));
                self.keep(&places[..n], &weights[..n]);
            }
            _ => {
                const FACES: [[usize; 4]; 4] = [[0, 1, 2, 3], [0, 3, 1, 2], [0, 2, 3, 1], [1, 3, 2, 0]];
                let mut best: Option<(f64, [usize; 3], [f64; 3], usize)> = None;
                for [i, j, k, l] in FACES {
                    let n = (w(j) - w(i)).cross(w(k) - w(i));
                    let (origin, other) = (-n.dot(w(i)), n.dot(w(l) - w(i)));
                    // On the other vertex's side, unless the simplex is flat.
                    if origin * other > 0.0 && other.abs() > 1e-14 * n.length() * (w(l) - w(i)).length() {
                        continue;
                    }
                    let (places, weights, count) = nearest_of_triangle(w(i), w(j), w(k));
                    let face = [i, j, k];
                    let mut v = Vec3::ZERO;
                    let mut named = [0; 3];
                    for m in 0..count {
                        named[m] = face[places[m]];
                        v += w(named[m]) * weights[m];
                    }
                    let square = v.length_squared();
                    if best.is_none_or(|b| square < b.0) {
                        best = Some((square, named, weights, count));
                    }
                }
                match best {
                    None => return true,
                    Some((_, places, weights, n)) => self.keep(&places[..n], &weights[..n]),
                }
            }
        }
        false
    }
}

fn nearest_of_segment(a: Vec3, b: Vec3) -> ([usize; 3], [f64; 3], usize) {
    let ab = b - a;
    let (along, square) = (-a.dot(ab), ab.length_squared());
    if !(along > 0.0) {
        return ([0, 0, 0], [1.0, 0.0, 0.0], 1);
    }
    if along >= square {
        return ([1, 0, 0], [1.0, 0.0, 0.0], 1);
    }
    let t = along / square;
    ([0, 1, 0], [1.0 - t, t, 0.0], 2)
}

/// The part of a triangle nearest to the origin, by the Voronoi regions of its features (Ericson, *Real-Time
/// Collision Detection*, 5.1.5).
pub(super) fn nearest_of_triangle(a: Vec3, b: Vec3, c: Vec3) -> ([usize; 3], [f64; 3], usize) {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (-ab.dot(a), -ac.dot(a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ([0, 0, 0], [1.0, 0.0, 0.0], 1);
    }
    let (d3, d4) = (-ab.dot(b), -ac.dot(b));
    if d3 >= 0.0 && d4 <= d3 {
        return ([1, 0, 0], [1.0, 0.0, 0.0], 1);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = if d1 - d3 > 0.0 { d1 / (d1 - d3) } else { 0.0 };
        return ([0, 1, 0], [1.0 - t, t, 0.0], 2);
    }
    let (d5, d6) = (-ab.dot(c), -ac.dot(c));
    if d6 >= 0.0 && d5 <= d6 {
        return ([2, 0, 0], [1.0, 0.0, 0.0], 1);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = if d2 - d6 > 0.0 { d2 / (d2 - d6) } else { 0.0 };
        return ([0, 2, 0], [1.0 - t, t, 0.0], 2);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let sum = (d4 - d3) + (d5 - d6);
        let t = if sum > 0.0 { (d4 - d3) / sum } else { 0.0 };
        return ([1, 2, 0], [1.0 - t, t, 0.0], 2);
    }
    let sum = va + vb + vc;
    let (v, w) = (vb / sum, vc / sum);
    ([0, 1, 2], [1.0 - v - w, v, w], 3)
}

/// The nearest points of two cores, or a simplex about the origin if they overlap. Cores known to be further apart
/// than `limit` are not looked at closely.
pub(crate) fn gjk(a: &Body<'_>, b: &Body<'_>, limit: f64) -> Gap {
    gjk_from(a, b, limit, a.center - b.center, EXACT)
}

/// What is left of the squared distance to gain when the search ends: all but rounding.
const EXACT: f64 = 1e-13;

/// As [`gjk`], from a direction that may be near the answer, until no more than `rest` of the squared distance is left
/// to gain.
pub(crate) fn gjk_from(a: &Body<'_>, b: &Body<'_>, limit: f64, start: Vec3, rest: f64) -> Gap {
    let scale = a.reach() + b.reach() + (a.center - b.center).length();
    let touching = 1e-26 * scale * scale;
    let mut d = start;
    if !(d.length_squared() > 0.0) {
        d = Vec3::X;
    }
    let mut simplex = Simplex { vertices: [Vertex::default(); 4], weights: [0.0; 4], count: 0 };
    simplex.push(difference(a, b, -d));
    simplex.reduce();
    let mut v = simplex.nearest();
    let mut best = simplex;
    // The normal of the furthest support plane: slivers lose the direction before the distance.
    let (mut best_direction, mut bound) = (v.normalized_or(Vec3::X), f64::NEG_INFINITY);
    for _ in 0..ITERATIONS {
        let square = v.length_squared();
        if square <= touching {
            return Gap::Overlap(best);
        }
        let next = difference(a, b, -v);
        let along = v.dot(next.w);
        if along > 0.0 && along * along > limit * limit * square {
            return Gap::Far;
        }
        if along > bound * square.sqrt() {
            bound = along / square.sqrt();
            best_direction = v * (1.0 / square.sqrt());
        }
        // No support point is nearer, or it is one we have.
        if square - along <= rest * square || simplex.vertices[..simplex.count].iter().any(|x| x.w == next.w)
        {
            break;
        }
        simplex.push(next);
        if simplex.reduce() {
            // A support plane between the origin and the difference was found: the tetrahedron is a sliver, and rounding
            // alone puts the origin within.
            if along > 0.0 {
                break;
            }
            return Gap::Overlap(simplex);
        }
        let nearer = simplex.nearest();
        if !(nearer.length_squared() < square) {
            break;
        }
        v = nearer;
        best = simplex;
    }
    let (pa, pb) = best.witnesses();
    let between = best_direction * v.length();
    Gap::Apart { a: pa, b: pb, between }
}
