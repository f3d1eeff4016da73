//! Rays and points against whole containers.

use ferrode_collide::*;
use ferrode_math::random::OdeRandom;
use ferrode_math::{Pose, Quat, Vec3, rotation};

fn random_world(kind: SpaceKind) -> (Colliders, SpaceKey, Vec<GeomKey>) {
    let mut random = OdeRandom::new(11);
    let mut number = || f64::from(random.next_u32()) / 4294967296.0 * 2.0 - 1.0;
    let mut colliders = Colliders::new();
    let space = colliders.add_space(None, kind).unwrap();
    let inner = colliders.add_space(Some(space), kind).unwrap();
    let mut keys = Vec::new();
    for i in 0..150 {
        let size = 0.2 + 0.3 * number().abs();
        let shape: Shape = match i % 5 {
            0 => Sphere::new(size).unwrap().into(),
            1 => Cuboid::new(Vec3::new(size, 2.0 * size, size)).unwrap().into(),
            2 => Capsule::new(size, size).unwrap().into(),
            3 => Cylinder::new(size, size).unwrap().into(),
            _ => Cone::new(size, size).unwrap().into(),
        };
        let at = Vec3::new(number(), number(), number()) * 5.0;
        let turn = Quat::from_axis_angle(Vec3::new(number(), number(), 1.0), 3.0 * number());
        let parent = if i % 3 == 0 { inner } else { space };
        let key = colliders.add_geom(Some(parent), Geom::new(shape).at(Pose::new(at, turn))).unwrap();
        keys.push(key);
    }
    colliders.set_enabled(keys[7], false).unwrap();
    keys.push(colliders.add_geom(Some(space), Geom::new(Plane::new(Vec3::Z, -4.0).unwrap())).unwrap());
    (colliders, space, keys)
}

#[test]
fn rays_agree_with_asking_each_geom() {
    let mut hits = Vec::new();
    let tree = SpaceKind::Quadtree { center: [0.0; 2], half_sides: [4.0; 2], depth: 3 };
    for kind in [SpaceKind::Simple, SpaceKind::HASH, SpaceKind::Bvh, tree] {
        let (mut colliders, space, keys) = random_world(kind);
        let mut random = OdeRandom::new(5);
        let mut number = || f64::from(random.next_u32()) / 4294967296.0 * 2.0 - 1.0;
        let mut total = 0;
        for round in 0..600 {
            let from = Vec3::new(number(), number(), number()) * 7.0;
            // Some along an axis, where a slope is zero.
            let direction = match round % 4 {
                0 => Vec3::Z * number(),
                _ => Vec3::new(number(), number(), number()) - from * 0.1,
            };
            let ray = Shape::from(Ray::new(12.0).unwrap());
            let frame = Frame::new(from, rotation::from_z_axis(direction).unwrap());
            let mut want = Vec::new();
            for &key in &keys {
                let mut list = Vec::new();
                let geom = colliders.geom(key).unwrap();
                let other = (geom.shape(), geom.frame());
                narrow::collide_frames((&ray, &frame), other, CollideOptions::new(4), &mut list);
                if geom.is_enabled() {
                    want.extend(list.iter().map(|c| (key, c.point.depth)));
                }
            }
            want.sort_by(|a, b| a.1.total_cmp(&b.1));
            colliders.ray_cast_all(space, from, direction, 12.0, |_, _| true, &mut hits).unwrap();
            let got: Vec<_> = hits.iter().map(|h| (h.geom, h.distance)).collect();
            assert_eq!(got, want);
            let first = colliders.ray_cast(space, from, direction, 12.0, |_, _| true).unwrap();
            assert_eq!(first.map(|h| h.geom), want.first().map(|w| w.0));
            // Looking through the first geom, one sees the second.
            if let Some(first) = first {
                let second =
                    colliders.ray_cast(space, from, direction, 12.0, |key, _| key != first.geom).unwrap();
                assert_eq!(second.map(|h| h.geom), want.get(1).map(|w| w.0));
            }
            total += want.len();
        }
        assert!(total > 300, "{total}");
        assert_eq!(colliders.ray_cast(space, Vec3::ZERO, Vec3::ZERO, 1.0, |_, _| true), Ok(None));
    }
}

#[test]
fn points_agree_with_asking_each_geom() {
    for kind in [SpaceKind::HASH, SpaceKind::Bvh] {
        let (mut colliders, space, keys) = random_world(kind);
        let mut random = OdeRandom::new(9);
        let mut number = || f64::from(random.next_u32()) / 4294967296.0 * 2.0 - 1.0;
        let mut total = 0;
        for _ in 0..500 {
            let p = Vec3::new(number(), number(), number()) * 5.0;
            let mut want: Vec<_> = keys
                .iter()
                .filter(|&&key| colliders.geom(key).unwrap().is_enabled())
                .filter(|&&key| colliders.point_depth(key, p).is_some_and(|d| d >= 0.0))
                .copied()
                .collect();
            let mut got = Vec::new();
            colliders.geoms_at(space, p, |key, _| got.push(key)).unwrap();
            got.sort();
            want.sort();
            assert_eq!(got, want);
            total += got.len();
        }
        assert!(total > 50, "{total}");
    }
}

/// A space that has been asked often knows how its geoms are turned; it has to notice when one turns and its box stays.
#[test]
fn what_turns_in_its_box_is_hit_where_it_is() {
    let mut colliders = Colliders::new();
    let space = colliders.add_space(None, SpaceKind::Bvh).unwrap();
    let turned = |angle: f64, x: f64| Pose::new(Vec3::X * x, Quat::from_axis_angle(Vec3::Z, angle));
    let eighth = core::f64::consts::FRAC_PI_4;
    let plate = Cuboid::new(Vec3::new(2.0, 0.1, 1.0)).unwrap();
    let mut keys = Vec::new();
    for i in 0..40 {
        let geom = Geom::new(plate).at(turned(eighth, 3.0 * f64::from(i)));
        keys.push(colliders.add_geom(Some(space), geom).unwrap());
    }
    // Along z, above the right of the middle and below it: which of the two hit geom `i`.
    let ask = |colliders: &mut Colliders, i: usize| {
        let queries = colliders.queries(space).unwrap();
        [0.4, -0.4].map(|y| {
            let from = Vec3::new(3.0 * i as f64 + 0.4, y, -5.0);
            let hit = queries.ray_cast(from, Vec3::Z, 10.0, |_, _| true);
            assert!(hit.is_none_or(|h| h.geom == keys[i]));
            hit.is_some()
        })
    };
    for _ in 0..10 {
        for i in 0..40 {
            assert_eq!(ask(&mut colliders, i), [true, false]);
        }
    }
    colliders.set_pose(keys[5], turned(-eighth, 15.0)).unwrap();
    assert_eq!(ask(&mut colliders, 5), [false, true]);
    // Another shape within the box.
    colliders.set_shape(keys[6], Sphere::new(0.65).unwrap()).unwrap();
    assert_eq!(ask(&mut colliders, 6), [true, true]);
    // And its neighbours are as before.
    assert_eq!(ask(&mut colliders, 7), [true, false]);
}
