//! Distances, nearest points and casts of shapes of one's own: against built-in shapes, and against samples.

use ferrode_collide::space::AxisOrder;
use ferrode_collide::*;
use ferrode_math::random::OdeRandom;
use ferrode_math::{Aabb, Pose, Quat, Vec3};

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

/// A box that tells no more than how far it reaches.
#[derive(Debug)]
struct Block(Cuboid);

impl CustomShape for Block {
    fn aabb(&self, frame: &Frame) -> Aabb {
        Shape::from(self.0).aabb_in(frame)
    }

    fn collide(&self, _: &Frame, _: &Shape, _: &Frame, _: &mut Contacts<'_>) -> bool {
        false
    }

    fn support(&self, d: Vec3) -> Option<Vec3> {
        let h = self.0.half_sides();
        Some(Vec3::new(h.x.copysign(d.x), h.y.copysign(d.y), h.z.copysign(d.z)))
    }
}

/// A ring around z, of great and small radius: no convex shape, and it knows how far a point is.
#[derive(Debug)]
struct Ring(f64, f64);

impl CustomShape for Ring {
    fn aabb(&self, frame: &Frame) -> Aabb {
        Aabb::from_center(frame.position, Vec3::splat(self.0 + self.1))
    }

    fn collide(&self, _: &Frame, _: &Shape, _: &Frame, _: &mut Contacts<'_>) -> bool {
        false
    }

    fn point_depth(&self, frame: &Frame, point: Vec3) -> Option<f64> {
        let p = frame.point_to_local(point);
        let off = (p.x * p.x + p.y * p.y).sqrt() - self.0;
        Some(self.1 - (off * off + p.z * p.z).sqrt())
    }
}

/// A ring that tells its distance from capsules, too, by points along them.
#[derive(Debug)]
struct WiseRing(Ring);

impl CustomShape for WiseRing {
    fn aabb(&self, frame: &Frame) -> Aabb {
        self.0.aabb(frame)
    }

    fn collide(&self, _: &Frame, _: &Shape, _: &Frame, _: &mut Contacts<'_>) -> bool {
        false
    }

    fn point_depth(&self, frame: &Frame, point: Vec3) -> Option<f64> {
        self.0.point_depth(frame, point)
    }

    fn distance(&self, frame: &Frame, other: &Shape, at: &Frame) -> Option<narrow::Distance> {
        let Shape::Capsule(capsule) = other else { return None };
        let ring = Shape::from(Custom::new(Ring(self.0.0, self.0.1)));
        let ball = Shape::from(Sphere::new(capsule.radius()).ok()?);
        let along = at.axis(2) * capsule.length();
        (0..=100)
            .filter_map(|i| {
                let place = at.position + along * (f64::from(i) / 100.0 - 0.5);
                narrow::distance_frames((&ring, frame), (&ball, &Frame::new(place, at.rotation)))
            })
            .min_by(|a, b| a.distance.total_cmp(&b.distance))
    }
}

fn other(kind: u32, n: &mut Numbers) -> Shape {
    match kind {
        0 => Sphere::new(0.4).unwrap().into(),
        1 => Cuboid::new(Vec3::new(0.5, 0.9, 0.3)).unwrap().into(),
        2 => Capsule::new(0.2, 0.8).unwrap().into(),
        3 => Cylinder::new(0.4, 0.5).unwrap().into(),
        4 => Plane::new(n.vector() + Vec3::Z * 1.2, -0.4).unwrap().into(),
        5 => {
            let heights = (0..20).map(|_| 0.3 * n.next()).collect();
            Heightfield::new(2.0, 2.0, 4, 5, heights, 1.0).unwrap().into()
        }
        6 => {
            let v = [[1.0, 0.0, 0.0], [-0.8, 0.1, 0.0], [0.0, 0.7, 0.1], [0.1, 0.0, 0.6]];
            let t = [[0, 2, 3], [2, 1, 3], [1, 0, 3], [0, 1, 2]];
            TriMesh::new(v.map(Vec3::from_array).to_vec(), t.to_vec()).unwrap().into()
        }
        _ => Custom::new(Block(Cuboid::new(Vec3::new(0.4, 0.6, 0.5)).unwrap())).into(),
    }
}

#[test]
fn a_convex_shape_of_ones_own_is_as_the_built_in_one() {
    let mut n = Numbers(OdeRandom::new(31));
    let (mut hits, mut inside) = (0, 0);
    for round in 0..1600 {
        let kind = round % 8;
        let sides = Vec3::new(0.6 + 0.3 * n.next(), 0.5, 0.9);
        let built_in = Shape::from(Cuboid::new(sides).unwrap());
        let own = Shape::from(Custom::new(Block(Cuboid::new(sides).unwrap())));
        let b = other(kind, &mut n);
        let (at, pb) = (n.pose(1.5), if b.is_placeable() { n.pose(0.5) } else { Pose::IDENTITY });
        let (fa, fb) = (Frame::from(&at), Frame::from(&pb));
        let what = format!("round {round}, kind {kind}");
        let (x, y) = [&own, &built_in].map(|a| narrow::distance_frames((a, &fa), (&b, &fb)).unwrap()).into();
        assert!((x.distance - y.distance).abs() < 1e-7, "{what}: {x:?} {y:?}");
        let swapped = narrow::distance_frames((&b, &fb), (&own, &fa)).unwrap();
        assert!((x.distance - swapped.distance).abs() < 1e-7, "{what}: {x:?} {swapped:?}");
        inside += usize::from(x.distance < 0.0);
        let path = (pb.position - at.position) * 1.3 + n.vector() * 0.5;
        let casts = [&own, &built_in].map(|a| narrow::shape_cast((a, &fa), path, (&b, &fb)));
        match casts {
            [Some(x), Some(y)] => {
                hits += 1;
                assert!((x.fraction - y.fraction).abs() < 1e-5, "{what}: {x:?} {y:?}");
                let back = narrow::shape_cast((&b, &fb), -path, (&own, &fa)).unwrap();
                assert!((x.fraction - back.fraction).abs() < 1e-5, "{what}: {x:?} {back:?}");
            }
            [None, None] => {}
            _ => panic!("{what}: {casts:?}"),
        }
        let p = at.position + n.vector() * 0.8;
        let (x, y) = [&own, &built_in].map(|s| closest_point(s, &fa, p).unwrap()).into();
        assert!((x.distance - y.distance).abs() < 1e-7, "{what}: {x:?} {y:?}");
        let depth = point_depth(&own, &fa, p).unwrap();
        assert!((depth - point_depth(&built_in, &fa, p).unwrap()).abs() < 1e-7, "{what}: {depth}");
    }
    assert!(hits > 500 && inside > 200, "{hits} {inside}");
}

#[test]
fn nearest_points_of_a_ring_are_those_of_samples() {
    let mut n = Numbers(OdeRandom::new(32));
    let ring = Ring(1.0, 0.3);
    let samples: Vec<Vec3> = (0..200 * 60)
        .map(|k| {
            let (u, v) = (f64::from(k % 200) / 200.0, f64::from(k / 200) / 60.0);
            let turn = |a: f64, t: f64| {
                Quat::from_axis_angle([Vec3::Z, -Vec3::Y][a as usize], t * core::f64::consts::TAU)
            };
            turn(0.0, u).rotate(Vec3::X + turn(1.0, v).rotate(Vec3::X * 0.3))
        })
        .collect();
    let own = Shape::from(Custom::new(ring));
    let mut within = 0;
    for _ in 0..200 {
        let frame = Frame::from(&n.pose(2.0));
        let p = n.vector() * 1.4;
        let place = frame.point_to_world(p);
        let c = closest_point(&own, &frame, place).unwrap();
        let nearest = samples.iter().map(|s| (*s - p).length()).fold(f64::INFINITY, f64::min);
        assert!(c.distance.abs() <= nearest + 1e-9 && c.distance.abs() > nearest - 0.03, "{c:?} {nearest}");
        // On the surface, and on the way to the point.
        assert!(point_depth(&own, &frame, c.position).unwrap().abs() < 1e-6, "{c:?}");
        assert!((c.position + c.normal * c.distance - place).length() < 1e-9, "{c:?}");
        within += usize::from(c.distance < 0.0);
        let ball = Shape::from(Sphere::new(0.1).unwrap());
        let d = narrow::distance_frames((&ball, &Frame::from(&Pose::from_position(place))), (&own, &frame));
        let d = d.unwrap();
        assert!((d.distance - (c.distance - 0.1)).abs() < 1e-12, "{d:?} {c:?}");
        assert!((d.normal - c.normal).length() < 1e-8 && (d.b - c.position).length() < 1e-8, "{d:?} {c:?}");
    }
    assert!(within > 10, "{within}");
}

#[test]
fn casts_onto_a_ring_end_at_the_first_touch() {
    let mut n = Numbers(OdeRandom::new(33));
    let own = Shape::from(Custom::new(WiseRing(Ring(1.0, 0.3))));
    let (mut hits, mut through, mut misses) = (0, 0, 0);
    for round in 0..400 {
        let frame = Frame::from(&n.pose(0.5));
        let body = other([0, 2][round % 2], &mut n);
        let start = n.pose(2.5);
        let at = Frame::from(&start);
        let path = (frame.position - start.position) * 2.0 + n.vector() * 0.8;
        let gap = |t: f64| {
            let there = Frame::new(at.position + path * t, at.rotation);
            narrow::distance_frames((&body, &there), (&own, &frame)).unwrap().distance
        };
        let hit = narrow::shape_cast((&body, &at), path, (&own, &frame));
        let until = match hit {
            Some(hit) if hit.fraction == 0.0 => {
                assert!(gap(0.0) <= 0.0 && (hit.depth + gap(0.0)).abs() < 1e-12, "{hit:?}");
                continue;
            }
            Some(hit) => {
                hits += 1;
                assert!(gap(hit.fraction).abs() < 1e-6, "{round}: {hit:?} {}", gap(hit.fraction));
                assert!(point_depth(&own, &frame, hit.position).unwrap().abs() < 1e-6, "{round}: {hit:?}");
                assert!((hit.normal.length() - 1.0).abs() < 1e-9 && hit.normal.dot(path) < 0.0, "{hit:?}");
                // The ring moves the other way.
                let back = narrow::shape_cast((&own, &frame), -path, (&body, &at)).unwrap();
                assert!((back.fraction - hit.fraction).abs() < 1e-6, "{round}: {hit:?} {back:?}");
                hit.fraction * 0.999
            }
            None => {
                misses += 1;
                // Through the hole.
                let center = |t: f64| (at.position + path * t - frame.position).length() < 0.5;
                through += usize::from((0..=100).any(|k| center(f64::from(k) / 100.0)));
                1.0
            }
        };
        for k in 0..=100 {
            let t = until * f64::from(k) / 100.0;
            assert!(gap(t) > -1e-6, "{round}: {hit:?} {t} {}", gap(t));
        }
    }
    assert!(hits > 100 && misses > 20 && through > 0, "{hits} {misses} {through}");
    // Of what it knows nothing about there is no answer.
    let cube = other(1, &mut n);
    let far = Frame::from(&Pose::from_position(Vec3::X * 5.0));
    assert_eq!(narrow::distance_frames((&cube, &far), (&own, &Frame::IDENTITY)), None);
    assert_eq!(narrow::shape_cast((&cube, &far), -Vec3::X * 9.0, (&own, &Frame::IDENTITY)), None);
}

#[test]
fn spaces_ask_own_shapes_and_fields_too() {
    let kinds = [
        SpaceKind::Simple,
        SpaceKind::HASH,
        SpaceKind::Quadtree { center: [0.0; 2], half_sides: [5.0; 2], depth: 3 },
        SpaceKind::SweepAndPrune(AxisOrder::XYZ),
        SpaceKind::Bvh,
    ];
    for kind in kinds {
        let mut n = Numbers(OdeRandom::new(34));
        let mut colliders = Colliders::new();
        let space = colliders.add_space(None, kind).unwrap();
        let mut keys = Vec::new();
        for i in 0..40 {
            let shape = match i % 4 {
                0 => Custom::new(WiseRing(Ring(0.6, 0.2))).into(),
                1 => other(7, &mut n),
                2 => other(5, &mut n),
                _ => other(1, &mut n),
            };
            keys.push(colliders.add_geom(Some(space), Geom::new(shape).at(n.pose(4.0))).unwrap());
        }
        let queries = colliders.queries(space).unwrap();
        let geom = |key: GeomKey| queries.colliders().geom(key).unwrap();
        let nearest = |a: &(f64, GeomKey), b: &(f64, GeomKey)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let mut found = [0; 3];
        for round in 0..60 {
            let pose = n.pose(4.0);
            let probe = other([0, 2, 7][round % 3], &mut n);
            let (path, frame) = (n.vector() * 5.0, Frame::from(&pose));
            let got = queries.shape_cast(&probe, &pose, path, |_, _| true).map(|h| (h.fraction, h.geom));
            let want = keys.iter().filter_map(|&key| {
                let hit = narrow::shape_cast((&probe, &frame), path, (geom(key).shape(), geom(key).frame()))?;
                Some((hit.fraction, key))
            });
            assert_eq!(got, want.min_by(nearest), "{kind:?} {round}");
            found[0] += usize::from(got.is_some());
            let p = pose.position;
            let got = queries.closest_point(p, 1.0, |_, _| true).map(|(key, c)| (c.distance, key));
            let want = keys.iter().filter_map(|&key| {
                let c = closest_point(geom(key).shape(), geom(key).frame(), p)?;
                (c.distance <= 1.0).then_some((c.distance, key))
            });
            assert_eq!(got, want.min_by(nearest), "{kind:?} {round}");
            found[1] += usize::from(got.is_some());
            let mut got = Vec::new();
            queries.geoms_at(p, |key, depth| got.push((depth, key)));
            for (depth, key) in &got {
                assert_eq!(point_depth(geom(*key).shape(), geom(*key).frame(), p), Some(*depth));
            }
            found[2] += got.len();
        }
        assert!(found.iter().all(|&f| f > 2), "{kind:?} {found:?}");
    }
}
