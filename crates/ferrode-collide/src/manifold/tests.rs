use super::*;
use crate::narrow::{Distance, distance_frames};
use crate::{Capsule, Cone, Convex, Cuboid, Cylinder, Ellipsoid, Heightfield, Plane, Sphere, TriMesh};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Pose, Quat};

struct Dice(OdeRandom);

impl Dice {
    fn number(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / 4294967296.0 * 2.0 - 1.0
    }
    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.number(), self.number(), self.number())
    }
    fn turn(&mut self) -> Quat {
        let q = [self.number(), self.number(), self.number(), self.number()];
        Quat::from_array(q).normalized().unwrap_or(Quat::IDENTITY)
    }
    fn cuboid(&mut self) -> Cuboid {
        Cuboid::from_half_sides(self.vector() * 0.4 + Vec3::splat(0.5)).unwrap()
    }
}

fn cube_mesh(half: f64) -> TriMesh {
    let vertices = (0..8u8).map(|i| {
        Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * (2.0 * half)
            - Vec3::splat(half)
    });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
    TriMesh::new(vertices.collect(), triangles).unwrap()
}

fn solids() -> Vec<Shape> {
    let points: Vec<Vec3> = (0..12)
        .map(|i| {
            let t = f64::from(i);
            Vec3::new(
                (t * 1.7).rem_euclid(1.0) - 0.5,
                (t * 0.37).rem_euclid(1.0) - 0.5,
                (t * 0.61).rem_euclid(1.0) - 0.5,
            )
        })
        .collect();
    vec![
        Sphere::new(0.4).unwrap().into(),
        Cuboid::new(Vec3::new(0.6, 0.8, 1.0)).unwrap().into(),
        Capsule::new(0.3, 0.8).unwrap().into(),
        Cylinder::new(0.35, 0.7).unwrap().into(),
        Convex::from_points(&points).unwrap().into(),
        Ellipsoid::new(Vec3::new(0.3, 0.4, 0.5)).unwrap().into(),
        Cone::new(0.4, 0.8).unwrap().into(),
    ]
}

fn fresh(a: (&Shape, &Frame), b: (&Shape, &Frame), margin: f64) -> Result<Manifold, f64> {
    let mut m = Manifold::default();
    match convex_manifold(a, b, margin, &mut Axis::default(), &mut m) {
        Touching::Yes => Ok(m),
        Touching::Apart(by) => Err(by),
    }
}

/// Unit normal, depths that are those of the anchors, anchors on the surfaces.
fn check(m: &Manifold, a: (&Shape, &Frame), b: (&Shape, &Frame), name: &str) {
    let n = double(m.normal);
    assert!((n.length() - 1.0).abs() < 1e-6, "{name}: {n:?}");
    for (i, p) in m.points().iter().enumerate() {
        let (pa, pb) = (m.place_a(i, a.1), m.place_b(i, b.1));
        assert!((n.dot(pb - pa) - f64::from(p.depth)).abs() < 1e-5, "{name}: {m:?}");
        for q in &m.points()[..i] {
            assert_ne!(q.feature, p.feature, "{name}: {m:#?}");
        }
    }
}

fn truth_normal(truth: &Distance) -> Vec3f {
    Vec3f::new(truth.normal.x as f32, truth.normal.y as f32, truth.normal.z as f32)
}

#[test]
fn boxes_agree_with_gjk() {
    let mut dice = Dice(OdeRandom::new(7));
    let margin = 0.05;
    let (mut counts, mut lent) = ([0; 3], 0);
    for round in 0..20_000 {
        let (ca, cb) = (dice.cuboid(), dice.cuboid());
        let (a, b) = (Shape::from(ca), Shape::from(cb));
        let fa = Frame::from(&Pose::new(dice.vector(), dice.turn()));
        let fb = Frame::from(&Pose::new(fa.position + dice.vector() * 1.2, dice.turn()));
        let truth = distance_frames((&a, &fa), (&b, &fb)).unwrap();
        let least = ca.half_sides().min(cb.half_sides());
        let least = least.x.min(least.y).min(least.z);
        let slack = 1.001e-3 * least + 2e-6;
        match fresh((&a, &fa), (&b, &fb), margin) {
            Err(by) => {
                counts[0] += 1;
                assert!(truth.distance - margin >= by - 1e-6, "{round}: {by} {truth:?}");
            }
            Ok(m) => {
                counts[if m.points().len() > 1 { 2 } else { 1 }] += 1;
                check(&m, (&a, &fa), (&b, &fb), "boxes");
                let depth = f64::from(m.depth());
                // The preferred faces may be a hair from the least depth; the deepest point along them is in. A face that
                // leans by less than eight degrees from the normal of the least depth may be a little deeper.
                let stands_in =
                    m.points().len() > 2 && f64::from(m.normal.dot(truth_normal(&truth))).abs() > 0.99;
                let more = if stands_in { 0.05 * depth.max(0.0) + 1e-2 * least } else { 0.0 };
                let over = depth + truth.distance;
                assert!(-2.0 * slack < over && over < 2.0 * slack + more, "{round}: {depth} {truth:?} {m:?}");
                lent += usize::from(over > 2.0 * slack);
                for (i, _) in m.points().iter().enumerate() {
                    for (s, f, p) in [(&ca, &fa, m.place_a(i, &fa)), (&cb, &fb, m.place_b(i, &fb))] {
                        let gap = s.half_sides() - f.point_to_local(p).abs();
                        assert!(gap.x.min(gap.y).min(gap.z) > -2e-3, "{round}: {gap:?} {m:?}");
                    }
                }
            }
        }
    }
    assert!(counts.iter().all(|&c| c > 1000), "{counts:?}");
    // About one in twenty of these, which lie at any angle.
    assert!(lent < 1500, "{lent}");
}

#[test]
fn convex_pairs_agree_with_the_distance() {
    let mut dice = Dice(OdeRandom::new(11));
    let (list, margin) = (solids(), 0.05);
    for (i, a) in list.iter().enumerate() {
        for (j, b) in list.iter().enumerate() {
            let mut touched = 0;
            for _ in 0..300 {
                let fa = Frame::from(&Pose::new(dice.vector(), dice.turn()));
                let fb = Frame::from(&Pose::new(fa.position + dice.vector() * 0.7, dice.turn()));
                let truth: Distance = distance_frames((a, &fa), (b, &fb)).unwrap();
                match fresh((a, &fa), (b, &fb), margin) {
                    Err(by) => assert!(truth.distance - margin >= by - 1e-6, "{by} {truth:?}"),
                    Ok(m) => {
                        touched += 1;
                        check(&m, (a, &fa), (b, &fb), "convex");
                        let depth = f64::from(m.depth());
                        let leaning = f64::from(m.normal.dot(truth_normal(&truth))).abs() > 0.99;
                        let boxes = matches!((a, b), (Shape::Cuboid(_), Shape::Cuboid(_)));
                        // As above.
                        let more = if boxes && leaning && m.points().len() > 2 {
                            0.05 * depth.max(0.0) + 5e-3
                        } else {
                            0.0
                        };
                        let over = depth + truth.distance;
                        assert!(-3e-3 < over && over < 3e-3 + more, "{i} {j} {depth} {truth:?} {m:?}");
                        let (sa, sb) = (fa, fb);
                        let turned = fresh((b, &sb), (a, &sa), margin).unwrap();
                        assert!((turned.depth() - m.depth()).abs() < 2e-3);
                    }
                }
            }
            assert!(touched > 30, "{i} {j} {touched}");
        }
    }
}

#[test]
fn everything_rests_on_every_ground() {
    // Flat ground 2 mm below, or in, a body laid on it: the same depth everywhere, one manifold, up to four points.
    let grid: Vec<f64> = vec![0.0; 21 * 21];
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..11u32 {
        for j in 0..11u32 {
            vertices.push(Vec3::new(f64::from(i) * 0.31 - 1.5, f64::from(j) * 0.29 - 1.5, 0.0));
            if i < 10 && j < 10 {
                let k = i * 11 + j;
                triangles.extend([[k, k + 11, k + 12], [k, k + 12, k + 1]]);
            }
        }
    }
    let up = Frame::IDENTITY;
    let field_frame = Frame::from(&Pose::new(Vec3::ZERO, Heightfield::z_up()));
    let grounds: Vec<(Shape, Frame, &str)> = vec![
        (Plane::new(Vec3::Z, 0.0).unwrap().into(), up, "plane"),
        (
            Cuboid::new(Vec3::new(8.0, 8.0, 2.0)).unwrap().into(),
            Frame::from(&Pose::from_position(-Vec3::Z)),
            "box",
        ),
        (TriMesh::new(vertices, triangles).unwrap().into(), up, "mesh"),
        (Heightfield::new(6.0, 6.0, 21, 21, grid, 1.0).unwrap().into(), field_frame, "field"),
    ];
    let mut work = Workspace::default();
    // Height of the middle when it touches, and points.
    let bodies: Vec<(Shape, f64, usize)> = vec![
        (Sphere::new(0.4).unwrap().into(), 0.4, 1),
        (Cuboid::new(Vec3::new(0.6, 0.8, 1.0)).unwrap().into(), 0.5, 4),
        (Cylinder::new(0.35, 0.7).unwrap().into(), 0.35, 4),
        (Cone::new(0.4, 0.8).unwrap().into(), 0.4, 4),
        (Capsule::new(0.3, 0.8).unwrap().into(), 0.7, 1),
        (Ellipsoid::new(Vec3::new(0.3, 0.4, 0.5)).unwrap().into(), 0.5, 1),
    ];
    for (ground, fg, name) in &grounds {
        for (body, height, points) in &bodies {
            for depth in [0.002, -0.002] {
                let turn = Quat::from_axis_angle(Vec3::Z, 0.3);
                let at = Frame::from(&Pose::new(Vec3::new(0.05, 0.03, height - depth), turn));
                let mut list = Vec::new();
                manifolds((body, &at), (ground, fg), 0.01, &mut work, &mut list);
                let what = format!("{body:?} on {name} by {depth}: {list:#?}");
                assert_eq!(list.len(), 1, "{what}");
                assert_eq!(list[0].points().len(), *points, "{what}");
                assert!((double(list[0].normal) - Vec3::Z).length() < 1e-6, "{what}");
                for p in list[0].points() {
                    assert!((f64::from(p.depth) - depth).abs() < 1e-6, "{what}");
                }
                check(&list[0], (body, &at), (ground, fg), &what);
                let mut turned = Vec::new();
                manifolds((ground, fg), (body, &at), 0.01, &mut work, &mut turned);
                assert_eq!(turned.len(), 1, "{what}");
                assert_eq!(turned[0].normal, -list[0].normal);
                check(&turned[0], (ground, fg), (body, &at), &what);
            }
        }
    }
}

#[test]
fn features_stay_while_a_box_slides_and_turns() {
    let cube = Shape::from(Cuboid::new(Vec3::splat(1.0)).unwrap());
    let slab = Shape::from(Cuboid::new(Vec3::new(10.0, 10.0, 1.0)).unwrap());
    let small = Shape::from(Cuboid::new(Vec3::new(0.8, 0.8, 1.0)).unwrap());
    let ground = Frame::IDENTITY;
    let mut noise = Dice(OdeRandom::new(3));
    for under in [&slab, &small] {
        let mut m = Manifold::default();
        let mut axis = Axis::default();
        let mut lost = 0;
        for step in 0..400 {
            let t = f64::from(step) * 1e-3;
            let tilt = Quat::from_axis_angle(Vec3::X, 1e-5 * noise.number());
            let turn = Quat::from_axis_angle(Vec3::Z, 0.1 + 0.4 * t) * tilt;
            let frame = Frame::from(&Pose::new(
                Vec3::new(0.05 + 0.2 * t, 0.1 * t, 0.995 + 1e-5 * noise.number()),
                turn,
            ));
            let answer = convex_manifold((&cube, &frame), (under, &ground), 0.01, &mut axis, &mut m);
            assert_eq!(answer, Touching::Yes);
            assert_eq!(m.points().len(), 4);
            for p in m.points_mut() {
                if step > 0 && p.impulse[0] == 0.0 {
                    lost += 1;
                }
                p.impulse[0] = 1.0;
            }
        }
        assert!(lost <= 2, "{lost}");
    }
}

#[test]
fn impulses_stay_at_their_corner() {
    let cube = Shape::from(Cuboid::new(Vec3::splat(1.0)).unwrap());
    let slab = Shape::from(Cuboid::new(Vec3::new(10.0, 10.0, 1.0)).unwrap());
    let (mut m, mut axis) = (Manifold::default(), Axis::default());
    for step in 0..200 {
        let t = f64::from(step) * 0.01;
        let turn = Quat::from_axis_angle(Vec3::Z, 0.8 * t) * Quat::from_axis_angle(Vec3::X, 1e-4 * (9.0 * t));
        let frame = Frame::from(&Pose::new(Vec3::new(t, 0.3 * t, 0.995), turn));
        convex_manifold((&cube, &frame), (&slab, &Frame::IDENTITY), 0.01, &mut axis, &mut m);
        let code =
            |p: &ManifoldPoint| 1.0 + f32::from(p.anchor_a.x > 0.0) + 2.0 * f32::from(p.anchor_a.y > 0.0);
        for p in m.points_mut() {
            if step > 0 {
                assert_eq!(p.impulse[1], code(p), "step {step}");
            }
            p.impulse[1] = code(p);
        }
    }
}

#[test]
fn refresh_equals_a_fresh_search() {
    let mut dice = Dice(OdeRandom::new(5));
    let list = solids();
    let ground: Vec<Shape> = list.iter().cloned().chain([Plane::new(Vec3::Z, 0.1).unwrap().into()]).collect();
    let (mut compared, mut corners) = (0, 0);
    for a in &list {
        for b in &ground {
            for _ in 0..200 {
                let pose = Pose::new(dice.vector() * 0.7, dice.turn());
                let fb = match b {
                    Shape::Plane(_) => Frame::IDENTITY,
                    _ => Frame::from(&Pose::new(dice.vector() * 0.4, dice.turn())),
                };
                let fa = Frame::from(&pose);
                let Ok(mut m) = fresh((a, &fa), (b, &fb), 0.02) else { continue };
                // Deep overlap turns its mind about the way out.
                if m.depth() > 0.05 {
                    continue;
                }
                let little =
                    Quat::from_axis_angle(dice.vector().normalized_or(Vec3::X), 2e-5 * dice.number());
                let moved = Pose::new(pose.position + dice.vector() * 2e-5, little * pose.rotation);
                let fa = Frame::from(&moved);
                m.refresh(&fa, &fb);
                let Ok(new) = fresh((a, &fa), (b, &fb), 0.02) else { continue };
                if (new.normal - m.normal).length() > 1e-3 {
                    continue;
                }
                for p in m.points() {
                    let Some(q) = new.points().iter().find(|q| q.feature == p.feature) else { continue };
                    compared += 1;
                    // A place where an edge is cut moves along the edge: that shift, at most, comes on top.
                    let shifts = ((p.anchor_a - q.anchor_a).length(), (p.anchor_b - q.anchor_b).length());
                    let is_corner = (if m.normal_of_a { shifts.1 } else { shifts.0 }) < 1e-7;
                    corners += usize::from(is_corner);
                    let shift = if is_corner { 0.0 } else { shifts.0.max(shifts.1) };
                    assert!(
                        (p.depth - q.depth).abs() < 1e-6 + shift,
                        "{:?} {:?} {shift}\n{m:#?}\n{new:#?}",
                        a.kind(),
                        b.kind()
                    );
                }
            }
        }
    }
    assert!(compared > 800 && corners > 100, "{compared} {corners}");
}

#[test]
fn a_long_way_from_the_origin() {
    let cube = Shape::from(Cuboid::new(Vec3::splat(1.0)).unwrap());
    let ground = Shape::from(Plane::new(Vec3::Z, 0.0).unwrap());
    let at = Frame::from(&Pose::from_position(Vec3::new(1e7, -1e7, 0.498)));
    let mut m = fresh((&cube, &at), (&ground, &Frame::IDENTITY), 0.01).unwrap();
    let moved = Frame::from(&Pose::from_position(Vec3::new(1e7, -1e7, 0.499)));
    m.refresh(&moved, &Frame::IDENTITY);
    assert!(m.points().iter().all(|p| (p.depth - 0.001).abs() < 1e-6), "{m:?}");
    // And on a mesh in the other order.
    let floor = Shape::from(cube_mesh(1e5));
    let fm = Frame::from(&Pose::from_position(Vec3::new(1e7, -1e7, -1e5)));
    let at = Frame::from(&Pose::from_position(Vec3::new(1e7 + 5e4, -1e7 + 3e4, 0.498)));
    let mut list = Vec::new();
    manifolds((&cube, &at), (&floor, &fm), 0.01, &mut Workspace::default(), &mut list);
    assert_eq!(list.len(), 1);
    let moved = Frame::from(&Pose::from_position(Vec3::new(1e7 + 5e4, -1e7 + 3e4, 0.499)));
    list[0].refresh(&moved, &fm);
    assert!(list[0].points().iter().all(|p| (p.depth - 0.001).abs() < 1e-6), "{list:?}");
}

/// A sheet of triangles whose corners are at `height` of their numbers.
fn sheet(n: u32, size: f64, mut height: impl FnMut() -> f64) -> TriMesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let at = |i: u32| (f64::from(i) / f64::from(n - 1) - 0.5) * size;
    for i in 0..n {
        for j in 0..n {
            vertices.push(Vec3::new(at(i), at(j), height()));
            if i + 1 < n && j + 1 < n {
                let k = i * n + j;
                triangles.extend([[k, k + n, k + n + 1], [k, k + n + 1, k + 1]]);
            }
        }
    }
    TriMesh::new(vertices, triangles).unwrap()
}

#[test]
fn nothing_pushes_sideways_on_flat_triangles() {
    let mesh = Shape::from(sheet(24, 10.0, || 0.0));
    let field = Shape::from(Heightfield::new(10.0, 10.0, 24, 24, vec![0.0; 576], 1.0).unwrap());
    let field_frame = Frame::from(&Pose::new(Vec3::ZERO, Heightfield::z_up()));
    let mut dice = Dice(OdeRandom::new(21));
    let mut work = Workspace::default();
    let mut list = Vec::new();
    for body in &solids() {
        for _ in 0..200 {
            let turn = dice.turn();
            let mut at =
                Frame::from(&Pose::new(Vec3::new(4.0 * dice.number(), 4.0 * dice.number(), 0.0), turn));
            // Its lowest point 2 cm below to 1 cm above the sheet.
            let lowest = body.aabb_in(&at).min.z;
            let height = 0.015 * dice.number() - 0.005;
            at.position.z = height - lowest;
            for (ground, frame) in [(&mesh, &Frame::IDENTITY), (&field, &field_frame)] {
                list.clear();
                manifolds((body, &at), (ground, frame), 0.02, &mut work, &mut list);
                assert_eq!(list.len(), 1, "{body:?} {at:?} {list:#?}");
                let m = &list[0];
                assert!((double(m.normal) - Vec3::Z).length() < 1e-5, "{body:?} {m:#?}");
                assert!((f64::from(m.depth()) + height).abs() < 1e-3, "{body:?} {height} {m:#?}");
            }
        }
    }
}

#[test]
fn points_ahead_of_bumpy_ground_are_as_far_as_it_is() {
    let mut dice = Dice(OdeRandom::new(22));
    let mesh = Shape::from(sheet(24, 10.0, || 0.12 * dice.number()));
    let mut dice = Dice(OdeRandom::new(23));
    let mut work = Workspace::default();
    let (mut list, mut touched) = (Vec::new(), 0);
    for (kind, body) in solids().iter().enumerate() {
        for _ in 0..300 {
            let place = Vec3::new(4.0 * dice.number(), 4.0 * dice.number(), 1.0);
            let mut at = Frame::from(&Pose::new(place, dice.turn()));
            // Down to where it is near.
            for _ in 0..3 {
                let above = distance_frames((body, &at), (&mesh, &Frame::IDENTITY)).unwrap().distance;
                at.position.z -= above - 0.01 - 0.02 * dice.number();
            }
            let truth = distance_frames((body, &at), (&mesh, &Frame::IDENTITY)).unwrap();
            if truth.distance < -0.005 {
                continue;
            }
            list.clear();
            manifolds((body, &at), (&mesh, &Frame::IDENTITY), 0.03, &mut work, &mut list);
            let depth = list.iter().map(|m| f64::from(m.depth())).fold(f64::NEG_INFINITY, f64::max);
            if truth.distance < 0.028 {
                touched += 1;
                assert!((depth + truth.distance).abs() < 2e-3, "{kind} {depth} {truth:?} {list:#?}");
            } else if truth.distance > 0.0301 {
                // None, or one that is over no triangle but the margin's breadth beside it.
                assert!(depth < -0.02, "{kind} {depth} {truth:?} {list:#?}");
            }
        }
    }
    assert!(touched > 1000, "{touched}");
}
