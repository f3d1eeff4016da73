//! Nothing is allocated per call once lists have grown: every pair, touching or not, rays, casts and a step of each space.

use ferrode_collide::*;
use ferrode_math::{Pose, Quat, Vec3};

fn hills(n: u32) -> TriMesh {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            let (x, y) = (f64::from(i) * 0.5 - 2.0, f64::from(j) * 0.5 - 2.0);
            vertices.push(Vec3::new(x, y, 0.1 * ((7 * i + 5 * j) % 4) as f64));
        }
    }
    for i in 0..n {
        for j in 0..n {
            let a = i * (n + 1) + j;
            let (b, c, d) = (a + 1, a + n + 1, a + n + 2);
            triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    TriMesh::new(vertices, triangles).unwrap()
}

fn shapes() -> Vec<Shape> {
    let points: Vec<Vec3> = (0..12)
        .map(|k| Vec3::new(f64::from(k % 3) - 1.0, f64::from(k % 4) - 1.5, f64::from(k % 5) - 2.0) * 0.3)
        .collect();
    let heights = (0..64).map(|k| 0.1 * f64::from(k % 5)).collect();
    vec![
        Sphere::new(0.5).unwrap().into(),
        Cuboid::new(Vec3::new(1.0, 0.8, 0.6)).unwrap().into(),
        Capsule::new(0.3, 0.8).unwrap().into(),
        Cylinder::new(0.4, 0.9).unwrap().into(),
        Plane::new(Vec3::Z, 0.1).unwrap().into(),
        Ray::new(3.0).unwrap().into(),
        Convex::from_points(&points).unwrap().into(),
        hills(8).into(),
        Ellipsoid::new(Vec3::new(0.5, 0.4, 0.3)).unwrap().into(),
        Cone::new(0.4, 0.9).unwrap().into(),
        Heightfield::new(4.0, 4.0, 8, 8, heights, 1.0).unwrap().into(),
    ]
}

/// Places for the first of two shapes, from deep inside the other to far away.
fn poses(shape: &Shape) -> Vec<Pose> {
    if !shape.is_placeable() {
        return vec![Pose::IDENTITY];
    }
    let turns = [
        Quat::IDENTITY,
        Quat::from_axis_angle(Vec3::X, core::f64::consts::FRAC_PI_2),
        Quat::from_axis_angle(Vec3::new(1.0, 2.0, 3.0), 0.9),
        Quat::from_axis_angle(Vec3::new(-2.0, 1.0, 0.5), 2.4),
    ];
    let places =
        [Vec3::new(0.1, 0.2, 0.05), Vec3::new(0.3, -0.2, 0.7), Vec3::new(0.6, 0.1, 1.0), Vec3::Z * 9.0];
    places.iter().flat_map(|&p| turns.map(|q| Pose::new(p, q))).collect()
}

fn count(mut f: impl FnMut()) -> u64 {
    f();
    allocation_counter::measure(f).count_total
}

#[test]
fn pairs_do_not_allocate() {
    let shapes = shapes();
    let mut out = Vec::with_capacity(4096);
    for a in &shapes {
        for b in &shapes {
            let poses = poses(a);
            let turn = if matches!(b, Shape::Heightfield(_)) { Heightfield::z_up() } else { Quat::IDENTITY };
            let fixed = Pose::new(Vec3::ZERO, turn);
            let mut all = |most: u16| {
                for pose in &poses {
                    out.clear();
                    narrow::collide((a, pose), (b, &fixed), CollideOptions::new(most), &mut out);
                    narrow::steady((a, pose), (b, &fixed), CollideOptions::new(most), &mut out);
                }
            };
            let kinds = (a.kind(), b.kind());
            assert_eq!(count(|| all(8)), 0, "{kinds:?}, eight contacts");
            assert_eq!(count(|| all(1)), 0, "{kinds:?}, one contact");
        }
    }
}

fn kinds() -> [SpaceKind; 5] {
    let (center, half_sides) = ([0.0; 2], [10.0; 2]);
    [
        SpaceKind::Simple,
        SpaceKind::HASH,
        SpaceKind::Bvh,
        SpaceKind::SweepAndPrune(space::AxisOrder::XZY),
        SpaceKind::Quadtree { center, half_sides, depth: 4 },
    ]
}

/// Balls and boxes over a floor, in a space of the given kind.
fn scene(kind: SpaceKind) -> (Colliders, SpaceKey, Vec<GeomKey>) {
    let mut colliders = Colliders::new();
    let space = colliders.add_space(None, kind).unwrap();
    colliders.add_geom(Some(space), Geom::new(Plane::new(Vec3::Z, 0.0).unwrap())).unwrap();
    colliders.add_geom(Some(space), Geom::new(hills(8))).unwrap();
    let keys = (0..300)
        .map(|i| {
            let shape: Shape = if i % 2 == 0 {
                Sphere::new(0.3).unwrap().into()
            } else {
                Cuboid::new(Vec3::splat(0.5)).unwrap().into()
            };
            colliders.add_geom(Some(space), Geom::new(shape).at(place(i, 0))).unwrap()
        })
        .collect();
    (colliders, space, keys)
}

fn place(i: usize, step: usize) -> Pose {
    let (x, y, z) = ((i % 10) as f64, (i / 10 % 10) as f64, (i / 100) as f64);
    let sway = 0.05 * ((i * 7 + step * 3) % 11) as f64;
    Pose::from_position(Vec3::new(0.55 * x + sway, 0.55 * y - sway, 0.3 + 0.55 * z))
}

#[test]
fn steps_of_spaces_do_not_allocate() {
    for kind in kinds() {
        let (mut colliders, space, keys) = scene(kind);
        let mut contacts = Vec::new();
        let mut step = |n: usize| {
            for (i, &key) in keys.iter().enumerate().filter(|(i, _)| i % 2 == 0) {
                colliders.set_pose(key, place(i, n)).unwrap();
            }
            contacts.clear();
            colliders
                .collide(space, |colliders, a, b| {
                    colliders.contacts(a, b, CollideOptions::new(8), &mut contacts);
                })
                .unwrap();
        };
        // The places come back every eleven steps: all lists have had their greatest length by then.
        (0..33).for_each(&mut step);
        assert_eq!(allocation_counter::measure(|| (0..11).for_each(&mut step)).count_total, 0, "{kind:?}");
        assert!(!contacts.is_empty());
    }
}

#[test]
fn rays_do_not_allocate() {
    for kind in kinds() {
        let (mut colliders, space, _) = scene(kind);
        let queries = colliders.queries(space).unwrap();
        let mut hits = Vec::with_capacity(1024);
        let mut found = 0;
        let cast = || {
            for k in 0..200 {
                let from = Vec3::new(0.03 * f64::from(k), 0.02 * f64::from(k), 4.0);
                let along = Vec3::new(0.3, -0.2, -1.0);
                found += usize::from(queries.ray_cast(from, along, 20.0, |_, _| true).is_some());
                found += usize::from(queries.ray_meets(from, along, 20.0, |_, _| true));
                queries.ray_cast_all(from, along, 20.0, |_, _| true, &mut hits);
            }
        };
        assert_eq!(count(cast), 0, "{kind:?}");
        assert!(found > 100);
    }
}
