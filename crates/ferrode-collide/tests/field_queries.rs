//! Depths, distances and casts of heightfields, against samples of their surface and against the same surface as a mesh.

use ferrode_collide::*;
use ferrode_math::random::OdeRandom;
use ferrode_math::{Pose, Quat, Vec3};

struct Numbers(OdeRandom);

impl Numbers {
    /// From −1 to 1.
    fn next(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / 2147483648.0 - 1.0
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    fn pose(&mut self, spread: f64) -> Pose {
        let at = self.vector() * spread;
        Pose::new(at, Quat::from_axis_angle(self.vector() + Vec3::Z * 1.1, 3.0 * self.next()))
    }

    fn field(&mut self, columns: usize, rows: usize) -> Heightfield {
        let heights = (0..columns * rows).map(|_| 0.3 * self.next()).collect();
        Heightfield::new(0.5 * (columns - 1) as f64, 0.4 * (rows - 1) as f64, columns, rows, heights, 1.0)
            .unwrap()
    }

    fn body(&mut self) -> Shape {
        let kind = self.0.next_below(4);
        let size = 0.5 + 0.45 * self.next();
        match kind {
            0 => Sphere::new(size).unwrap().into(),
            1 => Cuboid::new(Vec3::new(size, 2.0 * size, 0.7)).unwrap().into(),
            2 => Capsule::new(0.3 * size, 1.5).unwrap().into(),
            _ => Cylinder::new(size, 0.4).unwrap().into(),
        }
    }
}

/// The triangles of a field: each cell is cut from its corner at greater x to that at greater z.
fn triangles(field: &Heightfield) -> Vec<[Vec3; 3]> {
    let mut list = Vec::new();
    for z in 0..field.rows() as i64 - 1 {
        for x in 0..field.columns() as i64 - 1 {
            let [a, b, c, d] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| field.vertex(x + i, z + j));
            list.extend([[a, c, b], [d, b, c]]);
        }
    }
    list
}

fn mesh(field: &Heightfield) -> Shape {
    TriMesh::from_triangles(&triangles(field)).unwrap().into()
}

#[test]
fn casts_and_distances_are_those_of_the_mesh() {
    let mut n = Numbers(OdeRandom::new(21));
    let (mut hits, mut misses) = (0, 0);
    for round in 0..600 {
        let field = n.field(9, 12);
        let (mesh, field) = (mesh(&field), Shape::from(field));
        let base = Frame::from(&n.pose(1.0));
        let body = n.body();
        // From above, from below, along x, along z, and slanting.
        let from = base.point_to_world(n.vector().component_mul(Vec3::new(3.0, 2.0, 3.0)));
        let stretch = [Vec3::new(9.0, 0.5, 0.2), Vec3::new(0.2, 0.5, 9.0), Vec3::splat(4.0)][round % 3];
        let path = base.vector_to_world(n.vector().component_mul(stretch));
        let at = Frame::from(&Pose::new(from, n.pose(1.0).rotation));
        let over = narrow::shape_cast((&body, &at), path, (&field, &base));
        let onto = narrow::shape_cast((&body, &at), path, (&mesh, &base));
        match (over, onto) {
            (Some(f), Some(m)) => {
                hits += 1;
                assert!((f.fraction - m.fraction).abs() < 1e-6, "{round}: {f:?} {m:?}");
                assert!((f.depth - m.depth).abs() < 1e-6, "{round}: {f:?} {m:?}");
            }
            (None, None) => misses += 1,
            _ => panic!("{round}: {over:?} {onto:?}"),
        }
        let over = narrow::distance_frames((&body, &at), (&field, &base)).unwrap();
        let onto = narrow::distance_frames((&body, &at), (&mesh, &base)).unwrap();
        assert!((over.distance - onto.distance).abs() < 1e-6, "{round}: {over:?} {onto:?}");
    }
    assert!(hits > 150 && misses > 100, "{hits} {misses}");
}

/// Plains with towers and pits, over many blocks of cells: most are passed over.
#[test]
fn casts_over_plains_find_the_towers() {
    let mut n = Numbers(OdeRandom::new(27));
    let (mut hits, mut misses) = (0, 0);
    for round in 0..12 {
        let (columns, rows) = ([50, 90][round % 2], 70);
        let mut heights: Vec<f64> = (0..columns * rows).map(|_| 0.02 * n.next()).collect();
        for _ in 0..12 {
            heights[n.0.next_below((columns * rows) as u32) as usize] = 4.0 * n.next();
        }
        let (width, depth) = (0.5 * (columns - 1) as f64, 0.4 * (rows - 1) as f64);
        let field = Heightfield::new(width, depth, columns, rows, heights, 5.0).unwrap();
        let (mesh, field) = (mesh(&field), Shape::from(field));
        for _ in 0..25 {
            let body = n.body();
            let from = n.vector().component_mul(Vec3::new(0.6 * width, 2.5, 0.6 * depth));
            let path = n.vector().component_mul(Vec3::new(width, [0.0, 0.5, 5.0][round % 3], depth));
            let at = Frame::from(&Pose::new(from, n.pose(1.0).rotation));
            let over = narrow::shape_cast((&body, &at), path, (&field, &Frame::IDENTITY));
            let onto = narrow::shape_cast((&body, &at), path, (&mesh, &Frame::IDENTITY));
            match (over, onto) {
                (Some(f), Some(m)) => {
                    hits += 1;
                    assert!((f.fraction - m.fraction).abs() < 1e-6, "{round}: {f:?} {m:?}");
                    assert!((f.depth - m.depth).abs() < 1e-6, "{round}: {f:?} {m:?}");
                }
                (None, None) => misses += 1,
                _ => panic!("{round}: {over:?} {onto:?}"),
            }
        }
    }
    assert!(hits > 60 && misses > 60, "{hits} {misses}");
}

/// A tower a hundred thousand cells away.
#[test]
fn casts_over_endless_plains_go_far() {
    let mut heights = vec![0.0; 1001 * 801];
    heights[500 + 400 * 1001] = 3.0;
    let field = Heightfield::new(1000.0, 800.0, 1001, 801, heights, 0.0).unwrap();
    let field = Shape::from(field.wrapped());
    let body = Shape::from(Sphere::new(0.5).unwrap());
    // The towers are at whole multiples of 1000 and 800 m; there is none on the way to these.
    let from = Vec3::new(-0.5, 1.0, 2.0);
    let at = Frame::from(&Pose::from_position(from));
    for (x, z) in [(100_000.0, 800.0), (-100_000.0, 800.0), (1000.0, 80_000.0)] {
        let path = Vec3::new(x - from.x, 0.0, z - from.z) * 1.5;
        let hit = narrow::shape_cast((&body, &at), path, (&field, &Frame::IDENTITY)).unwrap();
        assert!((hit.fraction * 1.5 - 1.0).abs() < 1e-4, "{hit:?}");
        assert!((hit.position - Vec3::new(x, 1.0, z)).length() < 1.5, "{hit:?}");
    }
}

#[test]
fn depths_are_those_of_sampled_surfaces() {
    let mut n = Numbers(OdeRandom::new(22));
    let mut below = 0;
    for round in 0..12 {
        let field = n.field(5, 6);
        let (w, d) = (field.width(), field.depth());
        const PARTS: usize = 24;
        let mut samples = Vec::new();
        for [a, b, c] in triangles(&field) {
            for i in 0..=PARTS {
                for j in 0..=PARTS - i {
                    let (s, t) = (i as f64 / PARTS as f64, j as f64 / PARTS as f64);
                    samples.push(a + (b - a) * s + (c - a) * t);
                }
            }
        }
        let frame = Frame::from(&n.pose(2.0));
        let shape = Shape::from(field);
        for _ in 0..60 {
            let p = n.vector().component_mul(Vec3::new(0.5 * w, 1.0, 0.5 * d));
            let nearest = samples.iter().map(|s| (*s - p).length()).fold(f64::INFINITY, f64::min);
            let place = frame.point_to_world(p);
            let depth = point_depth(&shape, &frame, place).unwrap();
            let what = format!("round {round}: {p:?} {depth} {nearest}");
            // Samples are some 3 cm apart, the nearest no further from the point meant.
            assert!(depth.abs() <= nearest + 1e-9 && depth.abs() > nearest - 0.03, "{what}");
            let up = ray_cast(&shape, &frame, place, frame.vector_to_world(Vec3::Y), 9.0);
            assert_eq!(depth > 0.0, up.is_some(), "{what}");
            below += usize::from(depth > 0.0);
            let c = closest_point(&shape, &frame, place).unwrap();
            assert!((c.distance + depth).abs() < 1e-12, "{what} {c:?}");
            assert!((c.position + c.normal * c.distance - place).length() < 1e-9, "{what} {c:?}");
        }
    }
    assert!(below > 100, "{below}");
    // Beside the field nothing is below it, and all is as far as from its rim.
    let flat: Shape = Heightfield::new(2.0, 2.0, 3, 3, vec![0.0; 9], 1.0).unwrap().into();
    let depth = point_depth(&flat, &Frame::IDENTITY, Vec3::new(4.0, -4.0, 0.0)).unwrap();
    assert!((depth + 5.0).abs() < 1e-12, "{depth}");
}

#[test]
fn fields_planes_and_fields() {
    let mut n = Numbers(OdeRandom::new(23));
    let mut apart = 0;
    for round in 0..40 {
        let (a, b) = (n.field(4, 5), n.field(6, 3));
        let (ma, mb) = (mesh(&a), mesh(&b));
        let (fa, fb) = (Frame::from(&n.pose(2.0)), Frame::from(&n.pose(2.0)));
        let plane = Shape::from(Plane::new(n.vector() + Vec3::Y * 0.1, -2.0).unwrap());
        let (a, b) = (Shape::from(a), Shape::from(b));
        let path = (fb.position - fa.position) * 1.5;
        for (field, mesh, other, same, at) in
            [(&a, &ma, &plane, &plane, &Frame::IDENTITY), (&a, &ma, &b, &mb, &fb)]
        {
            let x = narrow::distance_frames((field, &fa), (other, at)).unwrap();
            let y = narrow::distance_frames((mesh, &fa), (same, at)).unwrap();
            assert!((x.distance - y.distance).abs() < 1e-9, "{round}: {x:?} {y:?}");
            let z = narrow::distance_frames((other, at), (field, &fa)).unwrap();
            assert!((x.distance - z.distance).abs() < 1e-9 && (x.normal + z.normal).length() < 1e-6);
            apart += usize::from(x.distance > 0.0);
            let x = narrow::shape_cast((field, &fa), path, (other, at));
            let y = narrow::shape_cast((mesh, &fa), path, (same, at));
            assert_eq!(x.is_some(), y.is_some(), "{round}: {x:?} {y:?}");
            if let Some((x, y)) = x.zip(y) {
                assert!((x.fraction - y.fraction).abs() < 1e-6, "{round}: {x:?} {y:?}");
                let z = narrow::shape_cast((other, at), -path, (field, &fa)).unwrap();
                assert!((x.fraction - z.fraction).abs() < 1e-6, "{round}: {x:?} {z:?}");
            }
        }
    }
    assert!(apart > 15, "{apart}");
    // Without end, only what is level has a distance.
    let endless: Shape = n.field(4, 4).wrapped().into();
    let at = Frame::from(&Pose::from_position(Vec3::Y * 5.0));
    let level = Shape::from(Plane::new(Vec3::Y, 0.0).unwrap());
    let d = narrow::distance_frames((&endless, &at), (&level, &Frame::IDENTITY)).unwrap();
    assert!(d.distance > 4.69 && d.distance < 5.0, "{d:?}");
    let leaning = Shape::from(Plane::new(Vec3::new(0.1, 1.0, 0.0), 0.0).unwrap());
    assert!(narrow::distance_frames((&endless, &at), (&leaning, &Frame::IDENTITY)).is_none());
    assert!(narrow::distance_frames((&endless, &at), (&endless, &Frame::IDENTITY)).is_none());
    let bounded = Shape::from(n.field(3, 3));
    assert!(narrow::distance_frames((&bounded, &Frame::IDENTITY), (&endless, &at)).is_some());
    assert!(narrow::distance_frames((&endless, &at), (&bounded, &Frame::IDENTITY)).is_some());
}

/// Bodies far wider than the cells of a field without end, and paths far longer, were asked about each of billions of cells.
#[test]
fn casts_over_tiny_cells_come_to_an_end() {
    for cell in [1e-9, 1e-3, 0.1] {
        let heights = (0..9).map(|i| 0.01 * f64::from(i % 4)).collect();
        let field = Heightfield::new(2.0 * cell, 2.0 * cell, 3, 3, heights, 0.0).unwrap();
        let field = Shape::from(field.wrapped());
        let body = Shape::from(Cuboid::new(Vec3::new(4.0, 1.0, 4.0)).unwrap());
        let at = Frame::from(&Pose::from_position(Vec3::new(0.2, 0.6, 0.3)));
        let cast = |path| narrow::shape_cast((&body, &at), path, (&field, &Frame::IDENTITY));
        // The body's bottom is 7 cm above the highest samples.
        let hit = cast(Vec3::new(0.5, -1.0, 0.25)).unwrap();
        assert!((hit.fraction - 0.07).abs() < 1e-6 && hit.normal == Vec3::Y, "{hit:?}");
        assert_eq!(cast(Vec3::new(1e5, 0.0, 1e5)), None);
        // Within the surface already: the deepest part counts.
        let sunk = Frame::from(&Pose::from_position(Vec3::new(0.2, 0.4, 0.3)));
        let hit = narrow::shape_cast((&body, &sunk), Vec3::X, (&field, &Frame::IDENTITY)).unwrap();
        assert!(hit.fraction == 0.0 && hit.depth > 0.09, "{hit:?}");
    }
}
