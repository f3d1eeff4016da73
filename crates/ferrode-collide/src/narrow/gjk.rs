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
    /// Apart: nearest points, the difference a − b, which is not zero, and the simplex that has it.
    Apart { a: Vec3, b: Vec3, between: Vec3, simplex: Simplex },
    /// They share a point, up to rounding: a simplex that contains, or touches, the origin.
    Overlap(Simplex),
}

impl Simplex {
    /// The points of the two bodies with the present weights.
    pub fn witnesses(&self) -> (Vec3, Vec3) {
        let (mut a, mut b) = (Vec3::ZERO, Vec3::ZERO);
        for i in 0..self.count {
            a += self.vertices[i].a * self.weights[i];
            b += self.vertices[i].b * self.weights[i];
        }
        (a, b)
    }
}

/// Up to three of four vertices, and the weights of their point nearest to the origin. Vertices stay where they are while
/// the simplex walks; only this list changes.
#[derive(Clone, Copy)]
struct Part {
    places: [usize; 3],
    weights: [f64; 3],
    count: usize,
}

impl Part {
    /// Of a segment or triangle whose vertices are at the places `of`.
    #[inline(always)]
    fn new((places, weights, count): ([usize; 3], [f64; 3], usize), of: [usize; 3]) -> Self {
        Self { places: places.map(|p| of[p]), weights, count }
    }

    #[inline(always)]
    fn nearest(&self, vertices: &[Vertex; 4]) -> Vec3 {
        let mut v = vertices[self.places[0]].w * self.weights[0];
        for k in 1..self.count {
            v += vertices[self.places[k]].w * self.weights[k];
        }
        v
    }

    /// With the vertex at `new` added: the part of that which is nearest to the origin. `None` if it contains the origin.
    #[inline]
    fn with(&self, vertices: &[Vertex; 4], new: usize) -> Option<Self> {
        let w = |i: usize| vertices[i].w;
        let ([i, j, k], new_place) = (self.places, new);
        Some(match self.count {
            1 => Self::new(nearest_of_segment(w(i), w(new)), [i, new, new]),
            2 => Self::new(nearest_of_triangle(w(i), w(j), w(new)), [i, j, new]),
            // The origin is on the new vertex's side of the other three but for rounding: their face comes last.
            _ => {
                let mut best: Option<(f64, Self)> = None;
                for [p, q, new, r] in [[i, j, new, k], [j, k, new, i], [k, i, new, j], [i, j, k, new]] {
                    if r == new_place && best.is_some() {
                        break;
                    }
                    let n = (w(q) - w(p)).cross(w(new) - w(p));
                    let to_other = w(r) - w(p);
                    let (origin, other) = (-n.dot(w(p)), n.dot(to_other));
                    // On the other vertex's side, unless the simplex is flat.
                    let thick = other * other > 1e-28 * n.length_squared() * to_other.length_squared();
                    if origin * other > 0.0 && thick {
                        continue;
                    }
                    let part = Self::new(nearest_of_triangle(w(p), w(q), w(new)), [p, q, new]);
                    let square = part.nearest(vertices).length_squared();
                    if best.is_none_or(|b| square < b.0) {
                        best = Some((square, part));
                    }
                }
                best?.1
            }
        })
    }

    /// The vertices of this part, and perhaps one more.
    fn simplex(&self, vertices: &[Vertex; 4], new: Option<usize>) -> Simplex {
        let mut s = Simplex { vertices: [Vertex::default(); 4], weights: [0.0; 4], count: self.count };
        for k in 0..self.count {
            s.vertices[k] = vertices[self.places[k]];
            s.weights[k] = self.weights[k];
        }
        if let Some(new) = new {
            s.vertices[s.count] = vertices[new];
            s.count += 1;
        }
        s
    }
}

#[inline(always)]
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
#[inline]
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

/// What is left of the squared distance to gain when the search ends: all but rounding.
pub(crate) const EXACT: f64 = 1e-13;

/// The nearest points of two cores, or a simplex about the origin if they overlap. Cores known to be further apart
/// than `limit` are not looked at closely.
///
/// Begins with a direction that may be near the answer, and ends when no more than `rest` of the squared distance is left
/// to gain.
pub(crate) fn gjk_from(a: &Body<'_>, b: &Body<'_>, limit: f64, start: Vec3, rest: f64) -> Gap {
    let mut d = start;
    let scale = a.reach() + b.reach() + (a.center - b.center).length();
    let touching = 1e-26 * scale * scale;
    if !(d.length_squared() > 0.0) {
        d = Vec3::X;
    }
    let mut vertices = [Vertex::default(); 4];
    vertices[0] = difference(a, b, -d);
    let mut part = Part { places: [0; 3], weights: [1.0, 0.0, 0.0], count: 1 };
    let mut v = vertices[0].w;
    // The normal of the furthest support plane, and how far: slivers lose the direction before the distance.
    let (mut furthest, mut bound) = (v, (0.0, 1.0));
    for _ in 0..ITERATIONS {
        let square = v.length_squared();
        if square <= touching {
            return Gap::Overlap(part.simplex(&vertices, None));
        }
        let next = difference(a, b, -v);
        let along = v.dot(next.w);
        if along > 0.0 && along * along > limit * limit * square {
            return Gap::Far;
        }
        // By squares: along / |v|.
        if if along > 0.0 { along * along * bound.1 > bound.0 * square } else { bound.0 == 0.0 } {
            bound = (if along > 0.0 { along * along } else { 0.0 }, square);
            furthest = v;
        }
        // No support point is nearer, or it is one we have.
        if square - along <= rest * square
            || part.places[..part.count].iter().any(|&i| vertices[i].w == next.w)
        {
            break;
        }
        let used = part.places[..part.count].iter().fold(0u32, |bits, &i| bits | 1 << i);
        let new = (used.trailing_ones() & 3) as usize;
        vertices[new] = next;
        let Some(reduced) = part.with(&vertices, new) else {
            // A support plane between the origin and the difference was found: the tetrahedron is a sliver, and rounding
            // alone puts the origin within.
            if along > 0.0 {
                break;
            }
            return Gap::Overlap(part.simplex(&vertices, Some(new)));
        };
        let nearer = reduced.nearest(&vertices);
        if !(nearer.length_squared() < square) {
            break;
        }
        v = nearer;
        part = reduced;
    }
    let best = part.simplex(&vertices, None);
    let (pa, pb) = best.witnesses();
    let between = furthest.normalized_or(Vec3::X) * v.length();
    Gap::Apart { a: pa, b: pb, between, simplex: best }
}
