//! Two polyhedra of few faces, by separating axes: as [`hull_facet`](super::hull_facet), each edge of the one in place of the
//! triangle's.

use super::convex::Touch;
use super::hull_facet::{ALONE, Axes, BETTER, BEYOND, TOUCHING, is_over};
use super::support::{Body, Core};
use crate::Convex;
use crate::shape::{MOST_FACES, Ridge, Skeleton};
use ferrode_math::{Mat3, Vec3};

/// Most pairs of edges that are quicker to try than to search among.
const MOST_PAIRS: usize = 200;
/// Most corners of the one with fewer edges: with so few pairs it has no more than 17 edges.
const CORNERS: usize = 16;

/// Which axis it is.
#[derive(Clone, Copy)]
enum Axis {
    /// A face of the first, or of the second.
    First(usize),
    Second(usize),
    /// Edge of the first, edge of the second, direction into the first.
    Edges(usize, usize, Vec3),
}

/// A polyhedron and its axes.
type Hull<'a> = (&'a Convex, &'a Skeleton);

/// The least overlap of two polyhedra. `None` for other bodies, and those of many edges.
pub(super) fn hull_hull(a: &Body<'_>, b: &Body<'_>) -> Option<Axes> {
    let (Core::Hull(ha), Core::Hull(hb)) = (a.core, b.core) else { return None };
    let (sa, sb) = (ha.skeleton()?, hb.skeleton()?);
    if sa.edges.len() * sb.edges.len() > MOST_PAIRS {
        return None;
    }
    // The one with fewer edges is turned into the other's coordinates.
    let swapped = sa.edges.len() > sb.edges.len();
    let (few, many, first, second) =
        if swapped { (b, a, (hb, sb), (ha, sa)) } else { (a, b, (ha, sa), (hb, sb)) };
    if first.0.points().len() > CORNERS {
        return None;
    }
    let turn = many.rotation.transpose() * few.rotation;
    let at = many.rotation.transpose_mul(few.center - many.center);
    let size = a.reach() + b.reach();
    Some(match axes(first, second, &turn, at, size) {
        Axes::Least(t) => {
            let (normal, p, q) = (many.rotation * t.normal, many.place(t.a), many.place(t.b));
            let (normal, a, b) = if swapped { (-normal, q, p) } else { (normal, p, q) };
            Axes::Least(Touch { normal, depth: t.depth, a, b })
        }
        other => other,
    })
}

/// In the coordinates of the second, where the first is at `at`.
fn axes((few, bones): Hull<'_>, (many, others): Hull<'_>, turn: &Mat3, at: Vec3, size: f64) -> Axes {
    let slack = TOUCHING * size;
    let mut corners = [Vec3::ZERO; CORNERS];
    let count = few.points().len().min(CORNERS);
    for (to, from) in corners.iter_mut().zip(few.points()) {
        *to = *turn * *from + at;
    }
    let corners = &corners[..count];
    let mut least = (f64::INFINITY, Axis::First(0));
    for (i, [x, y, z, d]) in others.blocks.iter().enumerate() {
        let mut low = [f64::INFINITY; 4];
        for p in corners {
            for l in 0..4 {
                let along = x[l] * p.x + y[l] * p.y + z[l] * p.z;
                low[l] = if along < low[l] { along } else { low[l] };
            }
        }
        for l in 0..4 {
            let overlap = d[l] - low[l];
            if overlap < -slack {
                return Axes::Apart;
            }
            if overlap < least.0 {
                least = (overlap, Axis::Second(4 * i + l));
            }
        }
    }
    let mut normals = [Vec3::ZERO; MOST_FACES];
    for (f, (to, from)) in normals.iter_mut().zip(&bones.normals).enumerate() {
        let n = *turn * *from;
        *to = n;
        let mut low = [f64::INFINITY; 4];
        for [x, y, z] in many.blocks() {
            for l in 0..4 {
                let along = x[l] * n.x + y[l] * n.y + z[l] * n.z;
                low[l] = if along < low[l] { along } else { low[l] };
            }
        }
        let overlap = few.face_plane(f).1 + n.dot(at) - low[0].min(low[1]).min(low[2].min(low[3]));
        if overlap < -slack {
            return Axes::Apart;
        }
        if overlap < least.0 {
            least = (overlap, Axis::First(f));
        }
    }
    // Products of the second's faces with an edge of the first, and with the directions from either of its normals to the
    // other.
    let mut dots = [[[0.0; 4]; 3]; MOST_FACES / 4];
    for (i, ridge) in bones.edges.iter().enumerate() {
        let [f, g] = ridge.faces.map(|f| normals[usize::from(f) & (MOST_FACES - 1)]);
        let along = *turn * ridge.along;
        let start = *turn * ridge.start + at;
        let cosine = f.dot(g);
        let (to_g, to_f) = (g - f * cosine, f - g * cosine);
        // One bit for each face whose back the edge leads to.
        let mut back = 0u64;
        for (k, (dots, [x, y, z, _])) in dots.iter_mut().zip(&others.blocks).enumerate() {
            for (dots, v) in dots.iter_mut().zip([along, to_g, to_f]) {
                for l in 0..4 {
                    dots[l] = x[l] * v.x + y[l] * v.y + z[l] * v.z;
                }
            }
            let below = |l: usize| u64::from(dots[0][l] < 0.0) << l;
            back |= (below(0) | below(1) | below(2) | below(3)) << (4 * k);
        }
        for (j, other) in others.edges.iter().enumerate() {
            let [h, k] = other.faces;
            if (back >> (h & 63) ^ back >> (k & 63)) & 1 == 0 {
                continue;
            }
            let of = |f: u8| (&dots[usize::from(f >> 2) & (MOST_FACES / 4 - 1)], usize::from(f & 3));
            let ((c, m), (d, n)) = (of(other.faces[0]), of(other.faces[1]));
            let (a, b) = (c[0][m], d[0][n]);
            if a * b >= 0.0 {
                continue;
            }
            let (p, q) = (b.abs(), a.abs());
            if c[1][m] * p + d[1][n] * q >= 0.0 || c[2][m] * p + d[2][n] * q >= 0.0 {
                continue;
            }
            let [h, k] = other.faces.map(usize::from);
            // Into the first.
            let axis = others.normals[h] * p + others.normals[k] * q;
            let square = axis.length_squared();
            let overlap = axis.dot(other.start - start);
            if overlap < 0.0 && overlap * overlap > slack * slack * square {
                return Axes::Apart;
            }
            let better = least.0 - BETTER * size;
            if better > 0.0 && (overlap < 0.0 || overlap * overlap < better * better * square) {
                let inverse = 1.0 / square.sqrt();
                least = (overlap * inverse, Axis::Edges(i, j, axis * inverse));
            }
        }
    }
    let depth = if least.0 > 0.0 { least.0 } else { 0.0 };
    let near = ALONE * size;
    match least.1 {
        Axis::Second(i) => {
            let i = i.min(others.normals.len() - 1);
            let n = others.normals[i];
            let found = lowest(corners.iter().copied(), n, near, |p| is_over(many, i, n, p));
            found.map_or(Axes::Overlap, |a| Axes::Least(Touch { normal: n, depth, a, b: a + n * depth }))
        }
        Axis::First(f) => {
            let n = normals[f];
            let own = |p: Vec3| turn.transpose_mul(p - at);
            let over = |p: Vec3| is_over(few, f, bones.normals[f], own(p));
            let found = lowest(many.points().iter().copied(), n, near, over);
            found.map_or(Axes::Overlap, |b| Axes::Least(Touch { normal: -n, depth, a: b + n * depth, b }))
        }
        Axis::Edges(i, j, m) => {
            let (start, along) = (*turn * bones.edges[i].start + at, *turn * bones.edges[i].along);
            let Ridge { start: from, along: edge, .. } = others.edges[j];
            // Where the planes through either edge and the axis cut the other.
            let (u, v) = (along.cross(m), edge.cross(m));
            let between = from - start;
            let (x, y) = (between.dot(v) / along.dot(v), -between.dot(u) / edge.dot(u));
            let within = |x: f64| (-BEYOND..=1.0 + BEYOND).contains(&x);
            if within(x) && within(y) {
                Axes::Least(Touch { normal: m, depth, a: start + along * x, b: from + edge * y })
            } else {
                Axes::Overlap
            }
        }
    }
}

/// The point furthest against a direction, or of several as far, within `near`, one that is over the other's face.
fn lowest(
    points: impl Iterator<Item = Vec3> + Clone,
    n: Vec3,
    near: f64,
    over: impl Fn(Vec3) -> bool,
) -> Option<Vec3> {
    let level = points.clone().map(|p| n.dot(p)).fold(f64::INFINITY, f64::min) + near;
    let mut found = points.filter(|p| n.dot(*p) <= level);
    let first = found.next()?;
    match found.next() {
        None => Some(first),
        Some(second) => [first, second].into_iter().chain(found).find(|&p| over(p)),
    }
}
