//! A box and a polyhedron of few faces, by separating axes: as [`hull_facet`](super::hull_facet), but that the arcs of the box's
//! edges make up whole circles, so that each edge of the polyhedron whose arc crosses one faces an edge of the box.

use super::convex::Touch;
use super::facet_axes::greater;
use super::hull_facet::{ALONE, Axes, BETTER, BEYOND, TOUCHING, is_over, signs};
use super::support::{Body, Core};
use crate::Convex;
use crate::shape::{MOST_FACES, Ridge, Skeleton};
use ferrode_math::{Mat3, Vec3};

/// Which axis it is.
#[derive(Clone, Copy)]
enum Axis {
    /// An axis of the box, and the sign of the direction into the box along it.
    Side(usize, f64),
    /// A face of the polyhedron.
    Face(usize),
    /// Axis of the box, edge of the polyhedron, direction into the box.
    Edges(usize, usize, Vec3),
}

/// The least overlap of a box and a polyhedron, the box first. `None` for other bodies, and polyhedra of many faces.
pub(super) fn hull_cuboid(a: &Body<'_>, b: &Body<'_>) -> Option<Axes> {
    let (Core::Cuboid(half), Core::Hull(hull)) = (a.core, b.core) else { return None };
    let skeleton = hull.skeleton()?;
    let turn = a.rotation.transpose() * b.rotation;
    let at = a.rotation.transpose_mul(b.center - a.center);
    let size = a.reach() + b.reach();
    let found = match skeleton.blocks.len() {
        0..=2 => axes::<2>(half, hull, skeleton, &turn, at, size),
        3..=6 => axes::<6>(half, hull, skeleton, &turn, at, size),
        _ => axes::<{ MOST_FACES / 4 }>(half, hull, skeleton, &turn, at, size),
    };
    // From the box's own coordinates.
    Some(match found {
        Axes::Least(t) => Axes::Least(Touch {
            normal: a.rotation * t.normal,
            depth: t.depth,
            a: a.place(t.a),
            b: a.place(t.b),
        }),
        other => other,
    })
}

/// For polyhedra of at most `N` blocks of faces; in the coordinates of the box, where the polyhedron is at `at`.
fn axes<const N: usize>(
    half: Vec3,
    hull: &Convex,
    skeleton: &Skeleton,
    turn: &Mat3,
    at: Vec3,
    size: f64,
) -> Axes {
    let slack = TOUCHING * size;
    let (low, high) = hull.extent(turn);
    let mut least = (f64::INFINITY, Axis::Side(0, 1.0));
    for k in 0..3 {
        for (overlap, sign) in [(at[k] + high[k] + half[k], 1.0), (half[k] - at[k] - low[k], -1.0)] {
            if overlap < -slack {
                return Axes::Apart;
            }
            if overlap < least.0 {
                least = (overlap, Axis::Side(k, sign));
            }
        }
    }
    // The normals of the faces.
    let mut normals = [[[0.0; 4]; 3]; N];
    // Which of their components are below zero.
    let mut back = [[0u8; 4]; N];
    let rows = &turn.rows;
    for (i, (([x, y, z, d], normals), back)) in
        skeleton.blocks.iter().zip(&mut normals).zip(&mut back).enumerate()
    {
        let mut reach = *d;
        for k in 0..3 {
            for l in 0..4 {
                let n = rows[k][0] * x[l] + rows[k][1] * y[l] + rows[k][2] * z[l];
                reach[l] += n * at[k] + n.abs() * half[k];
                normals[k][l] = n;
            }
        }
        for l in 0..4 {
            back[l] = signs([normals[0][l], normals[1][l], normals[2][l]]);
        }
        for (l, overlap) in reach.into_iter().enumerate() {
            if overlap < -slack {
                return Axes::Apart;
            }
            if overlap < least.0 {
                least = (overlap, Axis::Face(4 * i + l));
            }
        }
    }
    let normal = |f: u8| {
        let (block, l) = (&normals[usize::from(f >> 2).min(N - 1)], usize::from(f & 3));
        [block[0][l], block[1][l], block[2][l]]
    };
    let back = back.as_flattened();
    for (i, ridge) in skeleton.edges.iter().enumerate() {
        if back.get(usize::from(ridge.faces[0])) == back.get(usize::from(ridge.faces[1])) {
            continue;
        }
        let (f, g) = (normal(ridge.faces[0]), normal(ridge.faces[1]));
        for k in 0..3 {
            if f[k] * g[k] >= 0.0 {
                continue;
            }
            let (p, q) = (g[k].abs(), f[k].abs());
            let mut axis = Vec3::from_array(f) * p + Vec3::from_array(g) * q;
            axis[k] = 0.0;
            let square = axis.length_squared();
            let overlap = axis.dot(*turn * ridge.start + at) + axis.abs().dot(half);
            if overlap < 0.0 && overlap * overlap > slack * slack * square {
                return Axes::Apart;
            }
            let better = least.0 - BETTER * size;
            if better > 0.0 && (overlap < 0.0 || overlap * overlap < better * better * square) {
                let inverse = 1.0 / square.sqrt();
                least = (overlap * inverse, Axis::Edges(k, i, axis * inverse));
            }
        }
    }
    let depth = greater(least.0, 0.0);
    let near = ALONE * size;
    match least.1 {
        Axis::Side(k, sign) => {
            let m = turn.row(k) * sign;
            let level = greater(sign * high[k], sign * low[k]) - near;
            let mut found = hull.points().iter().filter(|p| m.dot(**p) >= level).map(|p| *turn * *p + at);
            let first = found.next();
            let over = |p: &Vec3| (0..3).all(|j| j == k || p[j].abs() <= half[j]);
            let b = match (first, found.next()) {
                (Some(p), None) => Some(p),
                (Some(p), Some(q)) => [p, q].into_iter().chain(found).find(over),
                _ => None,
            };
            let Some(b) = b else { return Axes::Overlap };
            let mut normal = Vec3::ZERO;
            normal[k] = sign;
            Axes::Least(Touch { normal, depth, a: b - normal * depth, b })
        }
        Axis::Face(i) => {
            let i = i.min(skeleton.normals.len() - 1);
            let n = *turn * skeleton.normals[i];
            let mut corner = Vec3::ZERO;
            let mut level = [false; 3];
            for j in 0..3 {
                corner[j] = -half[j].copysign(n[j]);
                level[j] = 2.0 * half[j] * n[j].abs() <= near;
            }
            let a = if level == [false; 3] {
                Some(corner)
            } else {
                // Of several corners at this height one over the face.
                (0..8usize).find_map(|bits| {
                    let mut p = corner;
                    for j in 0..3 {
                        if bits >> j & 1 == 1 {
                            if !level[j] {
                                return None;
                            }
                            p[j] = -p[j];
                        }
                    }
                    let own = turn.transpose_mul(p - at);
                    is_over(hull, i, skeleton.normals[i], own).then_some(p)
                })
            };
            let Some(a) = a else { return Axes::Overlap };
            Axes::Least(Touch { normal: n, depth, a, b: a + n * depth })
        }
        Axis::Edges(k, i, m) => {
            let Ridge { start, along, .. } = skeleton.edges[i];
            let (start, along) = (*turn * start + at, *turn * along);
            let mut corner = Vec3::ZERO;
            for j in (0..3).filter(|&j| j != k) {
                corner[j] = -half[j].copysign(m[j]);
            }
            let mut edge = Vec3::ZERO;
            edge[k] = 1.0;
            // Where the planes through either edge and the axis cut the other.
            let (u, v) = (along.cross(m), edge.cross(m));
            let between = corner - start;
            let (x, y) = (between.dot(v) / along.dot(v), -between.dot(u) / edge.dot(u));
            if (-BEYOND..=1.0 + BEYOND).contains(&x) && y.abs() <= half[k] * (1.0 + BEYOND) {
                Axes::Least(Touch { normal: m, depth, a: corner + edge * y, b: start + along * x })
            } else {
                Axes::Overlap
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::convex::touch;
    use super::super::hull_hull::hull_hull;
    use super::*;
    use crate::{Cuboid, Frame};
    use ferrode_math::random::OdeRandom;
    use ferrode_math::{Pose, Quat};

    /// Against GJK and the expanding polytope.
    #[test]
    fn axes_agree_with_support_points() {
        let mut random = OdeRandom::new(11);
        let mut number = || f64::from(random.next_u32()) / 4294967296.0 - 0.5;
        let (mut apart, mut clear) = (0, 0);
        for round in 0..4000 {
            let points: Vec<_> =
                (0..4 + round % 20).map(|_| Vec3::new(number(), number(), number())).collect();
            let hull = Convex::from_points(&points).unwrap();
            let cuboid = Cuboid::from_half_sides(Vec3::new(
                0.3 + 0.4 * number(),
                0.3 + 0.4 * number(),
                0.3 + 0.4 * number(),
            ))
            .unwrap();
            let mut frame = || {
                let turn = Quat::from_axis_angle(Vec3::new(number(), number(), number()), 6.0 * number());
                Frame::from(&Pose::new(Vec3::new(number(), number(), number()) * 1.4, turn))
            };
            let (fa, fb) = (frame(), frame());
            let first = Convex::from_points(&[0, 1, 2, 3, 4, 5, 6, 7].map(|i: u8| {
                let side = |bit: u8| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
                // Wedges, beside boxes.
                let x = if round % 2 == 0 { side(0) } else { 0.5 * side(0) * (1.0 - side(2)) };
                cuboid.half_sides().component_mul(Vec3::new(x, side(1), side(2)))
            }));
            let first = crate::Shape::from(first.unwrap());
            let a = Body::cuboid(&cuboid, &fa, Vec3::ZERO);
            let other = Body::of(&first, &fa, Vec3::ZERO).unwrap();
            let shape = crate::Shape::from(hull);
            let b = Body::of(&shape, &fb, Vec3::ZERO).unwrap();
            check(&a, &b, hull_cuboid(&a, &b), &mut apart, &mut clear);
            check(&other, &b, hull_hull(&other, &b), &mut apart, &mut clear);
            check(&b, &other, hull_hull(&b, &other), &mut apart, &mut clear);
        }
        assert!(apart > 3000 && clear > 1500, "{apart} {clear}");
    }

    fn check(a: &Body<'_>, b: &Body<'_>, found: Option<Axes>, apart: &mut u32, clear: &mut u32) {
        let want = touch(a, b);
        match found {
            // Too many edges.
            None => {}
            Some(Axes::Apart) => {
                *apart += 1;
                assert!(want.is_none_or(|t| t.depth < 1e-9), "{want:?}");
            }
            Some(Axes::Overlap) => assert!(want.is_some()),
            Some(Axes::Least(t)) => {
                *clear += 1;
                let want = want.map_or(0.0, |t| t.depth);
                assert!((t.depth - want).abs() < 1e-8, "{t:?} {want}");
                assert!((t.normal.length() - 1.0).abs() < 1e-12);
                assert!((t.b - t.a - t.normal * t.depth).length() < 1e-9, "{t:?}");
                // The points lie on both bodies.
                assert!(t.normal.dot(t.a - a.support(-t.normal)).abs() < 1e-9);
                assert!(t.normal.dot(t.b - b.support(t.normal)).abs() < 1e-9);
            }
        }
    }
}
