//! Compounds against their parts, one by one: contacts, rays, casts, distances, points, in pairs and in spaces.

mod common;

use common::classes::classes;
use ferrode_collide::narrow::{collide, distance, shape_cast, steady};
use ferrode_collide::query::{closest_point, point_depth, ray_cast};
use ferrode_collide::*;
use ferrode_math::random::OdeRandom;
use ferrode_math::{Pose, Quat, Vec3};

struct Random(OdeRandom);

impl Random {
    fn number(&mut self, size: f64) -> f64 {
        (f64::from(self.0.next_u32()) / 2147483648.0 - 1.0) * size
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.number(size), self.number(size), self.number(size))
    }

    fn pose(&mut self, size: f64) -> Pose {
        let q = Quat::from_array([self.number(1.0), self.number(1.0), self.number(1.0), self.number(1.0)]);
        Pose::new(self.vector(size), q.normalized().unwrap_or(Quat::IDENTITY))
    }
}

/// A ball, a box, a cone, and a closed mesh, and the parts with their poses.
fn shape() -> (Shape, Vec<(Shape, Pose)>) {
    let at = |x: f64, y: f64, z: f64, turn: f64| {
        Pose::new(Vec3::new(x, y, z), Quat::from_axis_angle(Vec3::new(1.0, 0.5, 0.2), turn))
    };
    let corners = [[0.3, 0.3, 0.3], [0.3, -0.3, -0.3], [-0.3, 0.3, -0.3], [-0.3, -0.3, 0.3]];
    let triangles = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    let mesh = TriMesh::new(corners.map(Vec3::from_array).to_vec(), triangles).unwrap();
    let parts = vec![
        (Sphere::new(0.3).unwrap().into(), at(-0.5, 0.0, 0.1, 0.0)),
        (Cuboid::new(Vec3::new(0.9, 0.2, 0.3)).unwrap().into(), at(0.0, 0.1, 0.0, 0.4)),
        (Cone::new(0.3, 0.6).unwrap().into(), at(0.6, 0.0, 0.3, 1.1)),
        (mesh.into(), at(0.1, -0.6, 0.0, 2.0)),
    ];
    (Compound::new(parts.clone()).unwrap().into(), parts)
}

type Source = fn((&Shape, &Pose), (&Shape, &Pose), CollideOptions, &mut Vec<GeomContact>) -> usize;

fn list(source: Source, a: (&Shape, &Pose), b: (&Shape, &Pose), most: u16) -> Vec<GeomContact> {
    let mut out = Vec::new();
    source(a, b, CollideOptions::new(most), &mut out);
    out
}

fn deepest(list: &[GeomContact]) -> f64 {
    list.iter().map(|c| c.point.depth).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn contacts_are_those_of_the_parts() {
    let (whole, parts) = shape();
    let mut random = Random(OdeRandom::new(11));
    let mut met = 0;
    for _ in 0..60 {
        let (at, pb) = (random.pose(0.5), random.pose(0.5));
        for (name, other) in classes().iter().filter(|c| c.0 != "ray" && c.0 != "compound") {
            for source in [collide as Source, steady] {
                let all = list(source, (&whole, &at), (other, &pb), 200);
                let each: Vec<_> = parts
                    .iter()
                    .map(|(part, p)| list(source, (part, &(at * *p)), (other, &pb), 200))
                    .collect();
                let most = each.iter().map(|l| deepest(l)).fold(f64::NEG_INFINITY, f64::max);
                assert_eq!(all.is_empty(), most < 0.0, "{name}");
                if all.is_empty() {
                    continue;
                }
                met += 1;
                assert!((deepest(&all) - most).abs() < 1e-9, "{name}: {} {most}", deepest(&all));
                for c in &all {
                    let from = &each[c.side1 as usize];
                    let twin = |d: &&GeomContact| {
                        (d.point.position - c.point.position).abs_max() < 1e-9
                            && (d.point.depth - c.point.depth).abs() < 1e-9
                    };
                    assert!(from.iter().any(|d| twin(&d)), "{name}: {c:?} {from:?}");
                }
                // The deepest is among the few.
                let few = list(source, (&whole, &at), (other, &pb), 2);
                assert!(few.len() <= 2 && (deepest(&few) - most).abs() < 1e-9);
                // The other way round.
                let mut turned = list(source, (other, &pb), (&whole, &at), 200);
                turned.iter_mut().for_each(|c| *c = c.swapped());
                assert_eq!(turned.len(), all.len(), "{name}");
                assert!((deepest(&turned) - most).abs() < 1e-9);
            }
        }
    }
    assert!(met > 500, "{met}");
}

#[test]
fn two_compounds_touch_where_their_parts_do() {
    let (whole, parts) = shape();
    let mut random = Random(OdeRandom::new(12));
    for _ in 0..100 {
        let (pa, pb) = (random.pose(0.6), random.pose(0.6));
        let all = list(collide, (&whole, &pa), (&whole, &pb), 200);
        let mut most = f64::NEG_INFINITY;
        for (a, x) in &parts {
            for (b, y) in &parts {
                most = most.max(deepest(&list(collide, (a, &(pa * *x)), (b, &(pb * *y)), 200)));
            }
        }
        assert_eq!(all.is_empty(), most < 0.0);
        assert!(all.is_empty() || (deepest(&all) - most).abs() < 1e-9);
        assert!(all.iter().all(|c| (0..4).contains(&c.side1) && (0..4).contains(&c.side2)));
    }
}

#[test]
fn rays_casts_and_distances_are_the_nearest_of_the_parts() {
    let (whole, parts) = shape();
    let mut random = Random(OdeRandom::new(13));
    let (mut hits, mut casts, mut inside) = (0, 0, 0);
    for _ in 0..400 {
        let at = random.pose(0.5);
        let frame = Frame::from(&at);
        let frames: Vec<_> = parts.iter().map(|p| Frame::from(&(at * p.1))).collect();
        let from = random.vector(2.0);
        let way = at.position - from + random.vector(0.6);
        let hit = ray_cast(&whole, &frame, from, way, 5.0);
        let each = parts.iter().zip(&frames).filter_map(|(p, f)| ray_cast(&p.0, f, from, way, 5.0));
        let best = each.map(|h| h.distance).min_by(f64::total_cmp);
        assert_eq!(hit.is_some(), best.is_some());
        if let (Some(hit), Some(best)) = (hit, best) {
            assert!((hit.distance - best).abs() < 1e-12);
            hits += 1;
        }
        let (other, ob) = (Shape::from(Capsule::new(0.1, 0.4).unwrap()), random.pose(2.0));
        let d = distance((&whole, &at), (&other, &ob)).unwrap();
        let each = parts.iter().map(|(p, x)| distance((p, &(at * *x)), (&other, &ob)).unwrap().distance);
        assert!((d.distance - each.min_by(f64::total_cmp).unwrap()).abs() < 1e-9);
        let turned = distance((&other, &ob), (&whole, &at)).unwrap();
        assert!((d.distance - turned.distance).abs() < 1e-9 && (d.normal + turned.normal).length() < 1e-6);
        let (path, of) = ((at.position - ob.position) * 1.5, Frame::from(&ob));
        let hit = shape_cast((&other, &of), path, (&whole, &frame));
        let each = parts.iter().zip(&frames).filter_map(|(p, f)| shape_cast((&other, &of), path, (&p.0, f)));
        let best = each.map(|h| h.fraction).min_by(f64::total_cmp);
        assert_eq!(hit.is_some(), best.is_some());
        if let (Some(hit), Some(best)) = (hit, best) {
            assert!((hit.fraction - best).abs() < 1e-9);
            casts += 1;
        }
        let p = random.vector(0.8);
        let depth = point_depth(&whole, &frame, p).unwrap();
        let each = parts.iter().zip(&frames).map(|(s, f)| point_depth(&s.0, f, p).unwrap());
        assert!((depth - each.max_by(f64::total_cmp).unwrap()).abs() < 1e-9);
        let near = closest_point(&whole, &frame, p).unwrap();
        assert!((near.distance + depth).abs() < 1e-6, "{near:?} {depth}");
        inside += usize::from(depth > 0.0);
    }
    assert!(hits > 100 && casts > 200 && inside > 15, "{hits} {casts} {inside}");
}

#[test]
fn spaces_and_queries_know_compounds() {
    let (whole, _) = shape();
    let mut colliders = Colliders::new();
    let key =
        colliders.add_geom(None, Geom::new(whole.clone()).at(Pose::from_position(Vec3::X * 5.0))).unwrap();
    let ball = colliders
        .add_geom(
            None,
            Geom::new(Shape::from(Sphere::new(0.3).unwrap()))
                .at(Pose::from_position(Vec3::new(4.5, 0.0, 0.6))),
        )
        .unwrap();
    let mut out = Vec::new();
    colliders.geom_contacts(key, ball, CollideOptions::new(8), &mut out);
    assert!(out.len() == 1 && out[0].side1 == 0 && (out[0].point.depth - 0.1).abs() < 1e-12, "{out:?}");
    assert!((colliders.point_depth(key, Vec3::new(4.5, 0.0, 0.1)).unwrap() - 0.3).abs() < 1e-12);
}
