//! Meshes against shapes whose contacts are known.

mod common;

use common::{Record, contacts};
use ferrode_collide::narrow::{collide, collide_frames, distance, steady};
use ferrode_collide::*;
use ferrode_math::{Pose, Quat, Vec3, real};
use proptest::prelude::*;

/// A flat grid of 2 × `n` × `n` triangles, one metre wide each, at z = 0.
fn grid(n: u32) -> TriMesh {
    let at = |i: u32, j: u32| {
        Vec3::new(f64::from(i), f64::from(j), 0.0) - Vec3::new(1.0, 1.0, 0.0) * f64::from(n) * 0.5
    };
    let vertices = (0..=n).flat_map(|j| (0..=n).map(move |i| at(i, j))).collect();
    let number = |i: u32, j: u32| i + j * (n + 1);
    let mut triangles = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i, j + 1), number(i + 1, j + 1)];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    TriMesh::new(vertices, triangles).unwrap()
}

/// A box as a mesh.
fn box_mesh(half: Vec3) -> TriMesh {
    let corner = |i: u32| {
        let s = |bit: u32, h: f64| if i & bit != 0 { h } else { -h };
        Vec3::new(s(1, half.x), s(2, half.y), s(4, half.z))
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
    TriMesh::new((0..8).map(corner).collect(), triangles).unwrap()
}

/// A convex shape of about half a metre.
fn shape() -> impl Strategy<Value = Shape> {
    let size = 0.1..0.5f64;
    let hull = |v: Vec<[f64; 3]>| {
        let points: Vec<_> = v.into_iter().map(Vec3::from_array).collect();
        Convex::from_points(&points).ok().map(Shape::from)
    };
    prop_oneof![
        size.clone().prop_map(|r| Sphere::new(r).unwrap().into()),
        prop::array::uniform3(size.clone()).prop_map(|s| Cuboid::new(Vec3::from_array(s)).unwrap().into()),
        (size.clone(), size.clone()).prop_map(|(r, l)| Capsule::new(r, l).unwrap().into()),
        (size.clone(), size.clone()).prop_map(|(r, l)| Cylinder::new(r, l).unwrap().into()),
        prop::collection::vec(prop::array::uniform3(-0.4..0.4f64), 8..20).prop_filter_map("flat", hull),
    ]
}

fn turn() -> impl Strategy<Value = Quat> {
    prop::array::uniform4(-1.0..1.0f64)
        .prop_map(|q| Quat::from_array(q).normalized().unwrap_or(Quat::IDENTITY))
}

/// `shape` turned and set so that its lowest point is `depth` below `ground`, a box's upper face at z = 0.
fn sunk(shape: &Shape, turn: Quat, x: f64, y: f64, depth: f64) -> Pose {
    let low = shape.aabb(&Pose::new(Vec3::ZERO, turn)).min.z;
    Pose::new(Vec3::new(x, y, -low - depth), turn)
}

fn list(a: (&Shape, &Pose), b: (&Shape, &Pose)) -> Vec<GeomContact> {
    let mut out = Vec::new();
    collide(a, b, CollideOptions::new(16), &mut out);
    out
}

fn deepest(list: &[GeomContact]) -> f64 {
    list.iter().map(|c| c.point.depth).fold(f64::NEG_INFINITY, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, rng_seed: common::seed(), ..Default::default() })]

    /// No edge within a flat surface catches a body: every normal is the surface's, and the depth that of the body's
    /// lowest point.
    #[test]
    fn a_flat_mesh_is_a_plane(shape in shape(), q in turn(), x in -2.0..2.0f64, y in -2.0..2.0f64, depth in 0.001..0.05f64) {
        let ground = Shape::from(grid(8));
        let at = sunk(&shape, q, x, y, depth);
        // A surface has no inside: what has sunk beyond its middle is through.
        if let Shape::Convex(hull) = &shape {
            prop_assume!(at.transform_point(hull.middle()).z > 0.0);
        }
        let found = list((&shape, &at), (&ground, &Pose::IDENTITY));
        prop_assert!(!found.is_empty());
        for c in &found {
            prop_assert!((c.point.normal - Vec3::Z).length() < 1e-9, "{found:?}");
            prop_assert!(c.side1 == -1 && c.side2 >= 0);
        }
        prop_assert!((deepest(&found) - depth).abs() < 1e-6, "{depth} {found:?}");
        let swapped = list((&ground, &Pose::IDENTITY), (&shape, &at));
        prop_assert_eq!(swapped.len(), found.len());
        for (s, f) in swapped.iter().zip(&found) {
            prop_assert_eq!(s.swapped(), *f);
        }
    }

    /// A box as a mesh and as itself, touched lightly from above, at the faces, edges and corners.
    #[test]
    fn a_box_mesh_is_a_box(shape in shape(), q in turn(), x in -1.2..1.2f64, y in -1.2..1.2f64, depth in 0.001..0.01f64) {
        let half = Vec3::new(1.0, 1.0, 0.5);
        let (mesh, solid) = (Shape::from(box_mesh(half)), Shape::from(Cuboid::from_half_sides(half).unwrap()));
        let below = Pose::from_position(Vec3::new(0.0, 0.0, -0.5));
        let at = sunk(&shape, q, x, y, depth);
        let (on_mesh, on_box) = (list((&shape, &at), (&mesh, &below)), list((&shape, &at), (&solid, &below)));
        // Where hardly anything overlaps rounding may decide.
        if deepest(&on_box) > 1e-4 || deepest(&on_mesh) > 1e-4 {
            prop_assert!(!on_mesh.is_empty() && !on_box.is_empty(), "{on_mesh:?}\n{on_box:?}");
            // ODE's rules prefer faces to edges: of boxes by 5 %, of boxes and triangles by half. A ball has the part of its
            // depth along each normal.
            let (m, b) = (deepest(&on_mesh), deepest(&on_box));
            prop_assert!(m < 1.5 * b + 1e-6 && m > 0.5 * b, "{m} {b}\n{on_mesh:?}\n{on_box:?}");
        }
        // The contacts that a world steps with find the shortest way, over faces and edges alike.
        let mut steadied = Vec::new();
        steady((&shape, &at), (&mesh, &below), CollideOptions::new(16), &mut steadied);
        let truth = -distance((&shape, &at), (&solid, &below)).unwrap().distance;
        let m = deepest(&steadied);
        if truth > 1e-4 {
            prop_assert!((m - truth).abs() < 1e-6 + 1e-2 * truth, "{m} {truth}\n{steadied:?}");
        }
    }

    /// A mesh upon a mesh: the corners of a box on a flat grid.
    #[test]
    fn a_box_mesh_stands_on_a_grid(yaw in 0.0..6.0f64, x in -2.0..2.0f64, y in -2.0..2.0f64, depth in 0.001..0.05f64) {
        let ground = Shape::from(grid(8));
        let cube = Shape::from(box_mesh(Vec3::new(0.4, 0.3, 0.5)));
        let at = Pose::new(Vec3::new(x, y, 0.5 - depth), Quat::from_axis_angle(Vec3::Z, yaw));
        let found = list((&cube, &at), (&ground, &Pose::IDENTITY));
        for corner in [[0.4, 0.3], [0.4, -0.3], [-0.4, 0.3], [-0.4, -0.3]] {
            let p = at.transform_point(Vec3::new(corner[0], corner[1], -0.5));
            prop_assert!(found.iter().any(|c| (c.point.position - p).length() < 0.06), "{p:?} {found:?}");
        }
        for c in &found {
            prop_assert!((c.point.normal - Vec3::Z).length() < 1e-9, "{found:?}");
            prop_assert!(c.point.depth < depth + 1e-9, "{found:?}");
        }
        prop_assert!((deepest(&found) - depth).abs() < 1e-9);
    }
}

/// Balls, planes and rays on meshes: libode's contacts, as sets, where the number wanted cut none.
#[test]
fn simple_pairs_are_libodes() {
    let record = Record::open(&["mesh.json"]);
    let (mut replayed, mut cut) = (0, 0);
    for case in record.list("cases") {
        let classes = [&case["a"]["class"], &case["b"]["class"]].map(|c| c.as_str().unwrap());
        if !classes.contains(&"trimesh") || !classes.iter().any(|c| ["sphere", "plane", "ray"].contains(c)) {
            continue;
        }
        let (Some(a), Some(b)) = (record.geom(&case["a"]), record.geom(&case["b"])) else { continue };
        let want = contacts(case);
        let wanted = case["flags"].as_u64().unwrap() as usize & 0xffff;
        let mut got = Vec::new();
        collide_frames((&a.0, &a.1), (&b.0, &b.1), CollideOptions::default(), &mut got);
        replayed += 1;
        let first = ["a", "b"].iter().any(|side| case[side]["first_contact"] == 1);
        if want.len() >= wanted || (first && !want.is_empty()) {
            cut += 1;
            assert!(!got.is_empty(), "{case}");
            continue;
        }
        // Libode's mesh is of single precision.
        let near = |g: &GeomContact, w: &GeomContact| {
            (g.point.position - w.point.position).abs_max() < 1e-4
                && (g.point.normal - w.point.normal).abs_max() < 1e-4
                && (g.point.depth - w.point.depth).abs() < 1e-4
        };
        for w in &want {
            assert!(got.iter().any(|g| near(g, w)), "{case}\n{got:?}");
        }
        for g in &got {
            assert!(want.iter().any(|w| near(g, w)), "{case}\n{got:?}");
        }
    }
    println!("{replayed} cases, {cut} of them cut");
    assert!(replayed > 15 && 2 * cut < replayed, "{replayed} {cut}");
}

/// A torus about z, closed and outward.
fn ring(radius: f64, tube: f64, around: u32, across: u32) -> TriMesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let turn = |i: u32, n: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    for i in 0..around {
        let spoke = Quat::from_axis_angle(Vec3::Z, turn(i, around)).rotate(Vec3::X);
        for j in 0..across {
            let lift = Quat::from_axis_angle(Vec3::Y, -turn(j, across)).rotate(Vec3::X);
            vertices.push(spoke * (radius + tube * lift.x) + Vec3::Z * (tube * lift.z));
            let (i2, j2) = ((i + 1) % around, (j + 1) % across);
            let corner = |i: u32, j: u32| i * across + j;
            triangles.extend([
                [corner(i, j), corner(i2, j), corner(i2, j2)],
                [corner(i, j), corner(i2, j2), corner(i, j2)],
            ]);
        }
    }
    TriMesh::new(vertices, triangles).unwrap()
}

/// A long pole in the hole of a tilted ring: it overlaps the inside of the ring by a few millimetres, and is pushed by no more.
#[test]
fn a_pole_in_a_ring_is_pushed_to_the_side() {
    let mesh = Shape::from(ring(0.45, 0.12, 24, 12));
    let poles = [
        Shape::from(Cylinder::new(0.12, 2.4).unwrap()),
        Shape::from(Capsule::new(0.12, 2.4).unwrap()),
        Shape::from(Cuboid::new(Vec3::new(0.24, 0.24, 2.4)).unwrap()),
    ];
    let (mut touching, mut deepest) = (0, 0.0_f64);
    for step in 0..400 {
        let s = f64::from(step);
        let tilt = Quat::from_axis_angle(Vec3::new(real::sin(0.7 * s), real::cos(0.7 * s), 0.0), 0.00075 * s);
        let heading = 2.39996 * s;
        let aside = Vec3::new(real::cos(heading), real::sin(heading), 0.0) * (0.19 + 0.00005 * s);
        let place = Pose { position: aside + Vec3::Z * (0.8 * real::sin(0.31 * s)), rotation: tilt };
        for pole in &poles {
            let mut found = Vec::new();
            let still = (pole, &Pose::IDENTITY);
            steady((&mesh, &place), still, CollideOptions::default(), &mut found);
            touching += usize::from(!found.is_empty());
            for c in &found {
                // To the side, tilted by 0.3 rad with the ring and by up to a facet of 30°: sin 47° is 0.734.
                assert!(c.point.normal.z.abs() < 0.75, "{step} {c:?}");
                deepest = deepest.max(c.point.depth);
            }
        }
    }
    println!("{touching} touch, {deepest} deep at most");
    // The box's corners are 0.17 m from its axis, 0.21 m from the middle of a hole of 0.33 m, and the tilt takes 0.02 m.
    assert!(touching > 300 && deepest < 0.1, "{touching} {deepest}");
}
