//! Casts, nearest points and depths of shapes, against what they mean and against looking at every geom.

use ferrode_collide::space::AxisOrder;
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
}

/// A closed mesh: an octahedron that is not regular.
fn mesh() -> Shape {
    let v = [
        [1.0, 0.0, 0.0],
        [-0.8, 0.1, 0.0],
        [0.0, 0.7, 0.1],
        [0.0, -0.9, 0.0],
        [0.1, 0.0, 0.6],
        [0.0, 0.1, -0.5],
    ];
    let t = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    TriMesh::new(v.map(Vec3::from_array).to_vec(), t.to_vec()).unwrap().into()
}

fn shape(kind: u32, n: &mut Numbers) -> Shape {
    let mut size = || 0.3 + 0.25 * n.next();
    match kind {
        0 => Sphere::new(size()).unwrap().into(),
        1 => Cuboid::new(Vec3::new(size(), 2.0 * size(), size())).unwrap().into(),
        2 => Capsule::new(size(), size()).unwrap().into(),
        3 => Cylinder::new(size(), size()).unwrap().into(),
        4 => Cone::new(size(), 2.0 * size()).unwrap().into(),
        5 => Ellipsoid::new(Vec3::new(size(), size(), 1.5 * size())).unwrap().into(),
        6 => {
            let points: Vec<Vec3> = (0..12).map(|_| n.vector() * 0.6).collect();
            Convex::from_points(&points).unwrap().into()
        }
        7 => mesh(),
        9 => {
            let heights = (0..30).map(|_| 0.3 * n.next()).collect();
            Heightfield::new(2.0, 2.5, 5, 6, heights, 1.0).unwrap().into()
        }
        _ => Plane::new(n.vector() + Vec3::Z * 1.5, -0.5).unwrap().into(),
    }
}

fn moved(pose: &Pose, by: Vec3) -> Pose {
    Pose::new(pose.position + by, pose.rotation)
}

/// Before the hit the shapes are apart, after it they touch; the normal and the place are those of the touch.
#[test]
fn shape_casts_end_at_the_first_touch() {
    let mut n = Numbers(OdeRandom::new(3));
    let (mut hits, mut misses, mut inside) = (0, 0, 0);
    for round in 0..4000 {
        let (ka, kb) = (n.0.next_below(8), n.0.next_below(10));
        let (a, b) = (shape(ka, &mut n), shape(kb, &mut n));
        let (pa, pb) = (n.pose(2.5), n.pose(0.5));
        let pb = if b.is_placeable() { pb } else { Pose::IDENTITY };
        let path = (pb.position - pa.position) * (1.0 + n.next()) + n.vector() * 0.7;
        let gap = |t: f64| narrow::distance((&a, &moved(&pa, path * t)), (&b, &pb)).unwrap();
        let hit = narrow::shape_cast((&a, &Frame::from(&pa)), path, (&b, &Frame::from(&pb)));
        let what = format!("round {round}: kinds {ka} {kb}, {hit:?}");
        match hit {
            Some(hit) if hit.fraction == 0.0 => {
                inside += 1;
                let start = gap(0.0).distance;
                assert!(start <= 1e-9 && (hit.depth + start).abs() < 1e-6, "{what} {start}");
            }
            Some(hit) => {
                hits += 1;
                assert!(hit.fraction <= 1.0 && hit.depth == 0.0, "{what}");
                let there = gap(hit.fraction);
                // Shapes are about a metre large: a few millionths of that.
                assert!(there.distance.abs() < 2e-6, "{what} {there:?}");
                for k in 0..40 {
                    let before = gap(hit.fraction * f64::from(k) / 40.0 * 0.999);
                    assert!(before.distance > 0.0, "{what} {k} {before:?}");
                }
                // The place is on the surface of both.
                for (s, p) in [(&b, pb), (&a, moved(&pa, path * hit.fraction))] {
                    let there = closest_point(s, &Frame::from(&p), hit.position).unwrap();
                    assert!(there.distance.abs() < 3e-6, "{what} {there:?}");
                }
                assert!((hit.normal.length() - 1.0).abs() < 1e-9 && hit.normal.dot(path) < 0.0, "{what}");
            }
            None => {
                misses += 1;
                for k in 0..=40 {
                    let d = gap(f64::from(k) / 40.0);
                    assert!(d.distance > -1e-6, "{what} {k} {d:?}");
                }
            }
        }
    }
    println!("{hits} hits, {misses} misses, {inside} inside at the start");
    assert!(hits > 1000 && misses > 200 && inside > 50);
}

#[test]
fn casts_move_with_the_world() {
    let mut n = Numbers(OdeRandom::new(8));
    let mut hits = 0;
    for _ in 0..500 {
        let (ka, kb) = (n.0.next_below(8), n.0.next_below(8));
        let (a, b) = (shape(ka, &mut n), shape(kb, &mut n));
        let (pa, pb) = (n.pose(3.0), n.pose(0.5));
        let path = (pb.position - pa.position) * 1.5;
        let turn = n.pose(10.0);
        let cast = |pa: Pose, pb: Pose, path| {
            narrow::shape_cast((&a, &Frame::from(&pa)), path, (&b, &Frame::from(&pb)))
        };
        let (here, there) = (cast(pa, pb, path), cast(turn * pa, turn * pb, turn.transform_vector(path)));
        let Some((x, y)) = here.zip(there) else {
            assert_eq!(here.is_some(), there.is_some());
            continue;
        };
        hits += 1;
        assert!((x.fraction - y.fraction).abs() < 1e-6, "{ka} {kb} {x:?} {y:?}");
        // Seen from the other shape.
        let other = narrow::shape_cast((&b, &Frame::from(&pb)), -path, (&a, &Frame::from(&pa))).unwrap();
        assert!((x.fraction - other.fraction).abs() < 1e-6, "{ka} {kb} {x:?} {other:?}");
    }
    assert!(hits > 300, "{hits}");
}

/// The nearest point is on the surface, as far away as it says, and nothing found by chance is nearer.
#[test]
fn nearest_points_are_nearest() {
    let mut n = Numbers(OdeRandom::new(4));
    let mut within = 0;
    for round in 0..3000 {
        let kind = n.0.next_below(9);
        let s = shape(kind, &mut n);
        let pose = if s.is_placeable() { n.pose(1.0) } else { Pose::IDENTITY };
        let frame = Frame::from(&pose);
        let p = pose.position + n.vector() * if round % 2 == 0 { 0.3 } else { 2.0 };
        let c = closest_point(&s, &frame, p).unwrap();
        let what = format!("round {round}: kind {kind}, {p:?} {c:?}");
        assert!(((p - c.position).length() - c.distance.abs()).abs() < 1e-7, "{what}");
        let again = point_depth(&s, &frame, c.position).unwrap();
        assert!(again.abs() < 1e-7, "{what} {again}");
        let depth = point_depth(&s, &frame, p).unwrap();
        assert!((depth + c.distance).abs() < 1e-7, "{what} {depth}");
        within += usize::from(depth > 0.0);
        // All the way to the surface in other directions lies on the same side.
        for _ in 0..20 {
            let other = p + n.vector().normalized_or(Vec3::X) * (depth.abs() * 0.999);
            let d = point_depth(&s, &frame, other).unwrap();
            assert!(d * depth >= 0.0 || d.abs() < 1e-7, "{what} {other:?} {d}");
        }
    }
    assert!(within > 300, "{within}");
}

fn kinds() -> [SpaceKind; 5] {
    [
        SpaceKind::Simple,
        SpaceKind::HASH,
        SpaceKind::Quadtree { center: [0.0; 2], half_sides: [5.0; 2], depth: 3 },
        SpaceKind::SweepAndPrune(AxisOrder::XYZ),
        SpaceKind::Bvh,
    ]
}

#[test]
fn spaces_agree_with_asking_each_geom() {
    for kind in kinds() {
        let mut n = Numbers(OdeRandom::new(12));
        let mut colliders = Colliders::new();
        let space = colliders.add_space(None, kind).unwrap();
        let inner = colliders.add_space(Some(space), kind).unwrap();
        let mut keys = Vec::new();
        for i in 0..120 {
            let s = shape(if i == 0 { 8 } else { i % 8 }, &mut n);
            let parent = if i % 3 == 0 { inner } else { space };
            let geom = Geom::new(s).at(n.pose(4.0));
            keys.push(colliders.add_geom(Some(parent), geom).unwrap());
        }
        // Some have moved since they were first found.
        colliders.collide(space, |_, _, _| {}).unwrap();
        for &key in keys.iter().skip(1).step_by(2) {
            colliders.set_pose(key, n.pose(4.0)).unwrap();
        }
        colliders.set_enabled(keys[5], false).unwrap();
        keys.remove(5);
        let queries = colliders.queries(space).unwrap();
        let geom = |key: GeomKey| colliders_geom(&queries, key);
        let mut found = [0; 4];
        for round in 0..150 {
            let pose = n.pose(5.0);
            let which = n.0.next_below(8);
            let s = shape(which, &mut n);
            let frame = Frame::from(&pose);
            let path = if round == 0 { Vec3::ZERO } else { n.vector() * 6.0 };
            let skip = keys[n.0.next_below(keys.len() as u32) as usize];
            let others = || keys.iter().copied().filter(|k| *k != skip);

            let got = queries.shape_cast(&s, &pose, path, |key, _| key != skip);
            let want = others()
                .filter_map(|key| {
                    let g = geom(key);
                    let hit = narrow::shape_cast((&s, &frame), path, (g.shape(), g.frame()))?;
                    Some((hit.fraction, key))
                })
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            assert_eq!(got.map(|h| (h.fraction, h.geom)), want, "{kind:?} round {round}");
            found[0] += usize::from(got.is_some());

            let p = pose.position;
            let limit = 0.5 + n.next().abs();
            let got = queries.closest_point(p, limit, |key, _| key != skip);
            let want = others()
                .filter_map(|key| {
                    Some((closest_point(geom(key).shape(), geom(key).frame(), p)?.distance, key))
                })
                .filter(|c| c.0 <= limit)
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            assert_eq!(got.map(|(key, c)| (c.distance, key)), want, "{kind:?} round {round}");
            found[1] += usize::from(got.is_some());

            let mut got = Vec::new();
            queries.overlaps(&s, &pose, |key, _| got.push(key));
            got.sort();
            let touching =
                |key: &GeomKey| narrow::touches((&s, &frame), (geom(*key).shape(), geom(*key).frame()));
            let want: Vec<_> = keys.iter().copied().filter(touching).collect();
            assert_eq!(got, want, "{kind:?} round {round}");
            found[2] += got.len();

            let first = queries.ray_cast(p, path, 3.0, |key, _| key != skip);
            let any = queries.ray_meets(p, path, 3.0, |key, _| key != skip);
            assert_eq!(first.is_some(), any);
            let want = others()
                .filter_map(|key| {
                    let hit = ray_cast(geom(key).shape(), geom(key).frame(), p, path, 3.0)?;
                    Some((hit.distance, key))
                })
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            assert_eq!(first.map(|h| (h.distance, h.geom)), want, "{kind:?} round {round}");
            found[3] += usize::from(any);
        }
        assert!(found.iter().all(|&f| f > 30), "{found:?}");
    }
}

fn colliders_geom<'a>(queries: &Queries<'a>, key: GeomKey) -> &'a Geom {
    queries.colliders().geom(key).unwrap()
}

#[test]
fn odd_questions() {
    let mut colliders = Colliders::new();
    let space = colliders.add_space(None, SpaceKind::Bvh).unwrap();
    let queries = colliders.queries(space).unwrap();
    let all = |_: GeomKey, _: &Geom| true;
    // Nothing there.
    assert_eq!(queries.ray_cast(Vec3::ZERO, Vec3::X, 1.0, all), None);
    assert!(queries.closest_point(Vec3::ZERO, f64::INFINITY, all).is_none());
    let cube = colliders.add_geom(Some(space), Geom::new(Cuboid::new(Vec3::splat(2.0)).unwrap())).unwrap();
    let ground = colliders.add_geom(Some(space), Geom::new(Plane::new(Vec3::Z, -3.0).unwrap())).unwrap();
    let queries = colliders.queries(space).unwrap();
    // No direction, no length, not numbers.
    let nan = Vec3::splat(f64::NAN);
    for (from, direction, length) in [
        (Vec3::ZERO, Vec3::ZERO, 1.0),
        (Vec3::ZERO, nan, 1.0),
        (nan, Vec3::X, 1.0),
        (Vec3::ZERO, Vec3::X, -1.0),
    ] {
        assert_eq!(queries.ray_cast(from, direction, length, all), None);
        assert!(!queries.ray_meets(from, direction, length, all));
    }
    // Endless.
    let hit = queries.ray_cast(Vec3::Z * 1e6, -Vec3::Z, f64::INFINITY, all).unwrap();
    assert!(hit.geom == cube && hit.distance == 1e6 - 1.0 && hit.normal == Vec3::Z);
    // Just long enough, along a face, from within.
    assert!(queries.ray_cast(Vec3::X * 3.0, -Vec3::X, 2.0, all).is_some());
    assert!(queries.ray_cast(Vec3::X * 3.0, -Vec3::X, 2.0 - 1e-9, all).is_none());
    assert_eq!(queries.ray_cast(Vec3::new(-3.0, 1.0, 0.0), Vec3::X, 9.0, all).map(|h| h.distance), Some(2.0));
    assert_eq!(queries.ray_cast(Vec3::ZERO, Vec3::X, 9.0, all).map(|h| h.distance), Some(1.0));
    let hit = queries.ray_cast(Vec3::X * 5.0, -Vec3::Z, 9.0, all).unwrap();
    assert!(hit.geom == ground && hit.distance == 3.0);
    // A touch at the start is a hit at the start; moving away along a face is one, too.
    let ball = Shape::from(Sphere::new(0.5).unwrap());
    let start = Pose::from_position(Vec3::X * 1.4);
    let hit = queries.shape_cast(&ball, &start, Vec3::X, all).unwrap();
    assert!(
        hit.geom == cube && hit.fraction == 0.0 && (hit.depth - 0.1).abs() < 1e-12 && hit.normal == Vec3::X
    );
    assert_eq!(queries.shape_cast(&ball, &Pose::from_position(Vec3::X * 1.6), Vec3::X, all), None);
    assert_eq!(queries.shape_cast(&ball, &start, nan, all), None);
    // A plane that moves is asked against all.
    let floor = Shape::from(Plane::new(Vec3::Z, -2.0).unwrap());
    let hit = queries.shape_cast(&floor, &Pose::IDENTITY, Vec3::Z * 4.0, all).unwrap();
    assert!(hit.geom == cube && (hit.fraction - 0.25).abs() < 1e-12, "{hit:?}");
}

/// A slab between two heights that only balls, rays and other slabs can touch.
#[derive(Debug)]
struct Slab(f64);

impl CustomShape for Slab {
    fn aabb(&self, frame: &Frame) -> ferrode_math::Aabb {
        let mut aabb = ferrode_math::Aabb::EVERYTHING;
        (aabb.min.z, aabb.max.z) = (frame.position.z - self.0, frame.position.z + self.0);
        aabb
    }

    fn collide(&self, frame: &Frame, other: &Shape, at: &Frame, out: &mut Contacts<'_>) -> bool {
        let z = at.position.z - frame.position.z;
        let up = if z < 0.0 { -1.0 } else { 1.0 };
        match other {
            Shape::Sphere(ball) => {
                let depth = self.0 + ball.radius() - z.abs();
                if depth >= 0.0 {
                    out.push(at.position - Vec3::Z * (up * ball.radius()), Vec3::Z * -up, depth);
                }
            }
            Shape::Ray(ray) => {
                let (from, along) = ray.line(at);
                let distance = (z.abs() - self.0) / (-up * along.z);
                if distance >= 0.0 && distance <= ray.length() {
                    out.push(from + along * distance, Vec3::Z * -up, distance);
                }
            }
            _ => return false,
        }
        true
    }

    fn point_depth(&self, frame: &Frame, point: Vec3) -> Option<f64> {
        Some(self.0 - (point.z - frame.position.z).abs())
    }
}

#[test]
fn own_shapes_collide_in_spaces() {
    for kind in kinds() {
        let mut colliders = Colliders::new();
        let space = colliders.add_space(None, kind).unwrap();
        let slab = colliders.add_geom(Some(space), Geom::new(Custom::new(Slab(0.5)))).unwrap();
        let at = Pose::from_position(Vec3::new(3.0, -2.0, 0.75));
        let ball = colliders.add_geom(Some(space), Geom::new(Sphere::new(0.5).unwrap()).at(at)).unwrap();
        let cube = Geom::new(Cuboid::new(Vec3::splat(1.0)).unwrap()).at(at);
        let cube = colliders.add_geom(Some(space), cube).unwrap();
        let mut pairs = Vec::new();
        colliders.collide(space, |_, a, b| pairs.push((a, b))).unwrap();
        assert_eq!(pairs.len(), 3, "{kind:?}");
        let mut contacts = Vec::new();
        let options = CollideOptions::new(4);
        assert_eq!(colliders.geom_contacts(ball, slab, options, &mut contacts), 1);
        assert_eq!(colliders.geom_contacts(slab, ball, options, &mut contacts), 1);
        assert_eq!(colliders.geom_contacts(slab, cube, options, &mut contacts), 0);
        let [a, b] = [contacts[0].point, contacts[1].point];
        assert_eq!((a.normal, a.depth, b.normal), (Vec3::Z, 0.25, -Vec3::Z));
        assert_eq!(colliders.point_depth(slab, Vec3::X), Some(0.5));
        let queries = colliders.queries(space).unwrap();
        let hit = queries.ray_cast(Vec3::Z * 4.0, -Vec3::Z, 9.0, |_, _| true).unwrap();
        assert!(hit.geom == slab && hit.distance == 3.5 && hit.normal == Vec3::Z, "{kind:?} {hit:?}");
        let mut found = Vec::new();
        queries.geoms_at(Vec3::new(0.0, 0.0, 0.25), |key, depth| found.push((key, depth)));
        assert_eq!(found, [(slab, 0.25)]);
        // A ball's distance follows from the depth of its centre.
        let d = colliders.distance(ball, slab).unwrap();
        assert!((d.distance + 0.25).abs() < 1e-12 && (d.normal - Vec3::Z).length() < 1e-9, "{d:?}");
        // What it says nothing about it does not have.
        assert_eq!(colliders.distance(slab, cube), None);
    }
}
