//! A polyhedron of few faces and a triangle, by separating axes.
//!
//! Their overlap along a direction is least at a direction that is the triangle's normal, a face's, or the product of two edges.
//! Of the many products only those count whose edges face each other: both are edges of the difference of the two, where the
//! arcs between the normals of the faces at either edge cross (Gregorius, *The separating axis test between convex polyhedra*,
//! Game Developers Conference 2013). The triangle's arcs are half circles from its normal to the opposite one.

use super::convex::Touch;
use super::facet_axes::lesser;
use super::support::{Body, Core};
use super::triangle::Facet;
use crate::Convex;
use crate::shape::{MOST_FACES, Ridge, Skeleton};
use ferrode_math::Vec3;

/// Part of the sizes by which two must be apart to count so: rounding.
pub(super) const TOUCHING: f64 = 1e-13;
/// Part of the sizes by which one corner must be deeper than the others to be the one that touches.
pub(super) const ALONE: f64 = 1e-7;
/// Part of the sizes by which two edges must be better than a face.
pub(super) const BETTER: f64 = 1e-9;
/// Part of an edge's length that the point that touches may be beyond its end.
pub(super) const BEYOND: f64 = 1e-9;

/// What axes tell of a polyhedron and a triangle.
pub(super) enum Axes {
    /// They do not touch.
    Apart,
    /// They overlap least here.
    Least(Touch),
    /// They overlap; where they touch is a matter of more than a corner or two edges.
    Overlap,
}

/// Which axis it is.
#[derive(Clone, Copy)]
enum Axis {
    /// The triangle's normal: up, or down.
    Up,
    Down,
    Face(usize),
    /// Edge of the triangle, edge of the polyhedron, direction into the polyhedron.
    Edges(usize, usize, Vec3),
}

/// The least overlap of a polyhedron and a triangle whose plane it reaches, with its middle before it; `lowest` is its point
/// furthest against the triangle's normal. `None` for other bodies, and polyhedra of many faces.
pub(super) fn hull_facet(body: &Body<'_>, middle: Vec3, facet: &Facet, lowest: Vec3) -> Option<Axes> {
    let Core::Hull(hull) = body.core else { return None };
    let skeleton = hull.skeleton()?;
    // Clearing much room would take longer than the axes of few faces.
    Some(match skeleton.blocks.len() {
        0..=2 => axes::<2>(body, hull, skeleton, middle, facet, lowest),
        3..=6 => axes::<6>(body, hull, skeleton, middle, facet, lowest),
        _ => axes::<{ MOST_FACES / 4 }>(body, hull, skeleton, middle, facet, lowest),
    })
}

/// For polyhedra of at most `N` blocks of faces.
fn axes<const N: usize>(
    body: &Body<'_>,
    hull: &Convex,
    skeleton: &Skeleton,
    middle: Vec3,
    facet: &Facet,
    lowest: Vec3,
) -> Axes {
    let local = |p: Vec3| body.rotation.transpose_mul(p - body.center);
    let c = [local(facet.corners[0]), local(facet.corners[1]), local(facet.corners[2])];
    let n = body.rotation.transpose_mul(facet.normal);
    let size = body.reach() + facet.scale();
    let slack = TOUCHING * size;
    let e = [c[1] - c[0], c[2] - c[1], c[0] - c[2]];
    let out = [e[0].cross(n), e[1].cross(n)];
    // Products of the faces' normals with two edges of the triangle, and with the directions out over these.
    let mut dots = [[[0.0; 4]; 4]; N];
    // Of each face, which of the edges lead to its back.
    let mut back = [[0u8; 4]; N];
    let mut least = (facet.normal.dot(facet.corners[0] - lowest), Axis::Up);
    for (i, (([x, y, z, d], dots), back)) in skeleton.blocks.iter().zip(&mut dots).zip(&mut back).enumerate()
    {
        let dot = |v: Vec3| {
            let mut r = [0.0; 4];
            for l in 0..4 {
                r[l] = x[l] * v.x + y[l] * v.y + z[l] * v.z;
            }
            r
        };
        let at = dot(c[0]);
        *dots = [dot(e[0]), dot(e[1]), dot(out[0]), dot(out[1])];
        let mut low = [0.0; 4];
        for l in 0..4 {
            let first = at[l] - d[l];
            let second = first + dots[0][l];
            let third = second + dots[1][l];
            low[l] = lesser(lesser(first, second), third);
            back[l] = signs([dots[0][l], dots[1][l], -dots[0][l] - dots[1][l]]);
        }
        for (l, low) in low.into_iter().enumerate() {
            if low > slack {
                return Axes::Apart;
            }
            if -low < least.0 {
                least = (-low, Axis::Face(4 * i + l));
            }
        }
    }
    let back = back.as_flattened();
    for (i, ridge) in skeleton.edges.iter().enumerate() {
        // Most edges' two faces look the same way along all three.
        let [f, g] = ridge.faces.map(usize::from);
        if back.get(f) == back.get(g) {
            continue;
        }
        // Of the faces at the edge: products with the triangle's edges, and with the directions out.
        let of = |f: u8| {
            let (block, l) = (&dots[usize::from(f >> 2).min(N - 1)], usize::from(f & 3));
            let [p, q, r, s] = [block[0][l], block[1][l], block[2][l], block[3][l]];
            ([p, q, -p - q], [r, s, -r - s])
        };
        let ((a, over_a), (b, over_b)) = (of(ridge.faces[0]), of(ridge.faces[1]));
        for k in 0..3 {
            let (p, q) = (b[k].abs(), a[k].abs());
            if a[k] * b[k] >= 0.0 || over_a[k] * p + over_b[k] * q >= 0.0 {
                continue;
            }
            // Against the direction into the polyhedron.
            let axis = skeleton.normals[f] * p + skeleton.normals[g] * q;
            let square = axis.length_squared();
            let overlap = axis.dot(ridge.start - c[k]);
            if overlap < 0.0 && overlap * overlap > slack * slack * square {
                return Axes::Apart;
            }
            let better = least.0 - BETTER * size;
            if better > 0.0 && (overlap < 0.0 || overlap * overlap < better * better * square) {
                let inverse = 1.0 / square.sqrt();
                least = (overlap * inverse, Axis::Edges(k, i, axis * -inverse));
            }
        }
    }
    // The overlap along the other normal is no less than the height of the middle.
    if facet.height(middle) < least.0 {
        let down = facet.height(body.support(facet.normal));
        if down < least.0 {
            least = (down, Axis::Down);
        }
    }
    let depth = least.0.max(0.0);
    let touch = |normal: Vec3, a: Vec3, b: Vec3| {
        let world = |p: Vec3| body.place(p);
        Axes::Least(Touch { normal: body.rotation * normal, depth, a: world(a), b: world(b) })
    };
    match least.1 {
        Axis::Up => {
            let low = local(lowest);
            let level = n.dot(low) + ALONE * size;
            let alone = hull.points().iter().filter(|p| n.dot(**p) <= level).count() == 1;
            let foot = low + n * depth;
            let over = (0..3).all(|k| e[k].cross(n).dot(foot - c[k]) <= 0.0);
            if alone && over {
                Axes::Least(Touch {
                    normal: facet.normal,
                    depth,
                    a: lowest,
                    b: lowest + facet.normal * depth,
                })
            } else {
                Axes::Overlap
            }
        }
        Axis::Down => Axes::Overlap,
        Axis::Face(i) => {
            let f = skeleton.normals[i.min(skeleton.normals.len() - 1)];
            let at = [f.dot(c[0]), f.dot(c[1]), f.dot(c[2])];
            let k = (1..3).fold(0, |k, j| if at[j] < at[k] { j } else { k });
            if (0..3).all(|j| j == k || at[j] > at[k] + ALONE * size) {
                touch(-f, c[k] + f * depth, c[k])
            } else {
                Axes::Overlap
            }
        }
        Axis::Edges(k, i, m) => {
            let Ridge { start, along, .. } = skeleton.edges[i];
            // Where the planes through either edge and the axis cut the other.
            let (u, v) = (along.cross(m), e[k].cross(m));
            let between = c[k] - start;
            let (x, y) = (between.dot(v) / along.dot(v), -between.dot(u) / e[k].dot(u));
            let within = |x: f64| (-BEYOND..=1.0 + BEYOND).contains(&x);
            if within(x) && within(y) { touch(m, start + along * x, c[k] + e[k] * y) } else { Axes::Overlap }
        }
    }
}

/// One bit for each number below zero.
#[inline(always)]
pub(super) fn signs(x: [f64; 3]) -> u8 {
    u8::from(x[0] < 0.0) | u8::from(x[1] < 0.0) << 1 | u8::from(x[2] < 0.0) << 2
}

/// Whether a point is over a face of a polyhedron, in that one's coordinates.
pub(super) fn is_over(hull: &Convex, face: usize, normal: Vec3, p: Vec3) -> bool {
    let corners = hull.face(face);
    let at = |k: usize| hull.points()[corners[k % corners.len()] as usize];
    (0..corners.len()).all(|k| normal.cross(at(k + 1) - at(k)).dot(p - at(k)) >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::super::convex::touch;
    use super::*;
    use crate::shape::Neighbour;
    use crate::{Frame, Shape};
    use ferrode_math::random::OdeRandom;
    use ferrode_math::{Pose, Quat};

    /// Against GJK and the expanding polytope.
    #[test]
    fn axes_agree_with_support_points() {
        let mut random = OdeRandom::new(5);
        let mut number = || f64::from(random.next_u32()) / 4294967296.0 - 0.5;
        let (mut apart, mut clear) = (0, 0);
        for round in 0..6000 {
            let points: Vec<_> =
                (0..4 + round % 20).map(|_| Vec3::new(number(), number(), number())).collect();
            let shape = Shape::from(Convex::from_points(&points).unwrap());
            let turn = Quat::from_axis_angle(Vec3::new(number(), number(), number()), 6.0 * number());
            let frame = Frame::from(&Pose::new(Vec3::new(number(), number(), number()), turn));
            let body = Body::of(&shape, &frame, Vec3::ZERO).unwrap();
            let corners = [0; 3].map(|_| Vec3::new(number(), number(), number()) * 1.5);
            let Some(normal) = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized() else {
                continue;
            };
            let facet = Facet { corners, normal, neighbours: [Neighbour::None; 3], index: 0 };
            let (middle, lowest) = (body.middle(), body.support(-normal));
            if facet.height(middle) < 0.0 || facet.height(lowest) > 0.0 {
                continue;
            }
            let want = touch(&body, &Body::triangle(corners));
            match hull_facet(&body, middle, &facet, lowest) {
                None => assert!(matches!(&shape, Shape::Convex(c) if c.face_count() > MOST_FACES)),
                Some(Axes::Apart) => {
                    apart += 1;
                    assert!(want.is_none_or(|t| t.depth < 1e-9), "{want:?}");
                }
                Some(Axes::Overlap) => assert!(want.is_some()),
                Some(Axes::Least(t)) => {
                    clear += 1;
                    let want = want.map_or(0.0, |t| t.depth);
                    assert!((t.depth - want).abs() < 1e-8, "{t:?} {want}");
                    assert!((t.b - t.a - t.normal * t.depth).length() < 1e-9, "{t:?}");
                    assert!(t.normal.dot(t.a - body.support(-t.normal)).abs() < 1e-9);
                    let top = corners.iter().map(|p| t.normal.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
                    assert!((top - t.normal.dot(t.b)).abs() < 1e-9);
                }
            }
        }
        assert!(apart > 300 && clear > 300, "{apart} {clear}");
    }
}
