//! Heightfields: libode's contacts as sets, and a flat field against a plane.

mod common;

use common::{Record, contacts};
use ferrode_collide::narrow::{collide, collide_frames};
use ferrode_collide::*;
use ferrode_math::{Pose, Quat, Vec3};

#[test]
fn contacts_are_libodes() {
    let record = Record::open(&["field.json", "convex.json"]);
    let (mut replayed, mut differ) = (0, 0);
    for case in record.list("cases") {
        let classes = [&case["a"]["class"], &case["b"]["class"]].map(|c| c.as_str().unwrap());
        // Meshes touch planes at other vertices than libode's first ten; aligned bodies meet several triangles at
        // edges, where either may speak.
        if !classes.contains(&"heightfield") || classes.contains(&"trimesh") || case["kind"] == "aligned" {
            continue;
        }
        let (Some(a), Some(b)) = (record.geom(&case["a"]), record.geom(&case["b"])) else { continue };
        let want = contacts(case);
        let wanted = case["flags"].as_u64().unwrap() as usize & 0xffff;
        let mut got = Vec::new();
        collide_frames((&a.0, &a.1), (&b.0, &b.1), CollideOptions::default(), &mut got);
        if want.len() >= wanted {
            assert!(!got.is_empty(), "{case}");
            continue;
        }
        let near = |g: &GeomContact, w: &GeomContact| {
            (g.point.position - w.point.position).abs_max() < 1e-9
                && (g.point.normal - w.point.normal).abs_max() < 1e-9
                && (g.point.depth - w.point.depth).abs() < 1e-9
        };
        // Of a ray wholly below the field libode reports a place that the ray does not reach.
        let ray = [&a, &b].into_iter().find(|x| matches!(x.0, Shape::Ray(_))).map(|x| x.1);
        if let (Some(w), Some(ray)) = (want.first(), ray)
            && (ray.position + ray.axis(2) * w.point.depth - w.point.position).length() > 1e-9
        {
            assert!(got.is_empty(), "{case}\n{got:?}");
            continue;
        }
        // All of libode's contacts are there.
        for w in &want {
            assert!(got.iter().any(|g| near(g, w)), "{case}\n{got:?}");
        }
        replayed += 1;
        // Now and then libode leaves out a corner of the field that is inside the body.
        let more = got.iter().filter(|g| !want.iter().any(|w| near(g, w)));
        differ += more.inspect(|g| assert!(g.point.depth > 0.0, "{case}\n{got:?}")).count();
    }
    println!("{replayed} cases, {differ} contacts more than libode's");
    assert!(replayed >= 30 && differ * 30 <= replayed, "{replayed} {differ}");
}

#[test]
fn a_flat_field_is_a_plane() {
    let field = Heightfield::new(8.0, 6.0, 9, 7, vec![0.25; 63], 1.0).unwrap();
    let (field, plane) = (Shape::from(field), Shape::from(Plane::new(Vec3::Z, 0.25).unwrap()));
    let up = Pose::new(Vec3::ZERO, Heightfield::z_up());
    let turn = Quat::from_axis_angle(Vec3::new(0.3, 1.0, 0.2), 0.7);
    let shapes: [Shape; 6] = [
        Sphere::new(0.5).unwrap().into(),
        Cuboid::new(Vec3::new(1.0, 0.8, 0.6)).unwrap().into(),
        Capsule::new(0.3, 0.5).unwrap().into(),
        Cylinder::new(0.4, 0.5).unwrap().into(),
        Cone::new(0.4, 0.5).unwrap().into(),
        Ellipsoid::new(Vec3::new(0.4, 0.5, 0.6)).unwrap().into(),
    ];
    for shape in &shapes {
        for (x, y) in [(0.1, 0.2), (2.3, -1.1), (-3.0, 1.7)] {
            let low = shape.aabb(&Pose::new(Vec3::ZERO, turn)).min.z;
            let at = Pose::new(Vec3::new(x, y, 0.25 - low - 0.05), turn);
            let (mut on_field, mut on_plane) = (Vec::new(), Vec::new());
            collide((shape, &at), (&field, &up), CollideOptions::default(), &mut on_field);
            collide((shape, &at), (&plane, &Pose::IDENTITY), CollideOptions::default(), &mut on_plane);
            assert!(!on_plane.is_empty());
            for p in &on_plane {
                let same = |f: &GeomContact| {
                    (f.point.position - p.point.position).length() < 1e-9
                        && (f.point.normal - p.point.normal).length() < 1e-9
                        && (f.point.depth - p.point.depth).abs() < 1e-9
                };
                assert!(on_field.iter().any(same), "{shape:?} {on_field:?} {on_plane:?}");
            }
        }
        // Beside the field there is nothing.
        let mut none = Vec::new();
        let beside = Pose::from_position(Vec3::new(5.0, 0.0, 0.3));
        assert_eq!(collide((shape, &beside), (&field, &up), CollideOptions::default(), &mut none), 0);
    }
}

#[test]
fn a_wrapped_field_goes_on() {
    let heights = (0..16).map(|i| f64::from(i % 4) * 0.1).collect();
    let field = Shape::from(Heightfield::new(3.0, 3.0, 4, 4, heights, 1.0).unwrap().wrapped());
    let ball = Shape::from(Sphere::new(0.3).unwrap());
    let depth = |x: f64| {
        let mut out = Vec::new();
        let at = Pose::from_position(Vec3::new(x, 0.3, 0.2));
        collide((&ball, &at), (&field, &Pose::IDENTITY), CollideOptions::default(), &mut out);
        out.iter().map(|c| c.point.depth).fold(f64::NEG_INFINITY, f64::max)
    };
    for x in [-1.1, -0.3, 0.2, 0.9] {
        assert!((depth(x) - depth(x + 30.0)).abs() < 1e-9, "{x} {} {}", depth(x), depth(x + 30.0));
    }
}

/// A long ray looks only at the cells on its way; it finds what many short ones find.
#[test]
fn long_rays_agree_with_short_ones() {
    let mut random = ferrode_math::random::OdeRandom::new(4);
    let mut number = || f64::from(random.next_u32()) / 4294967296.0;
    let heights = (0..41 * 31).map(|_| number()).collect();
    let field = Shape::from(Heightfield::new(40.0, 30.0, 41, 31, heights, 1.0).unwrap());
    let ray = |length: f64| Shape::from(Ray::new(length).unwrap());
    let mut total = 0;
    for _ in 0..200 {
        let from = Vec3::new((number() - 0.5) * 50.0, 0.2 + number(), (number() - 0.5) * 40.0);
        let pose =
            Ray::pose(from, Vec3::new(number() - 0.5, (number() - 0.5) * 0.05, number() - 0.5)).unwrap();
        let u = pose.rotation.rotate(Vec3::Z);
        let mut long = Vec::new();
        collide((&ray(30.0), &pose), (&field, &Pose::IDENTITY), CollideOptions::default(), &mut long);
        let mut short = Vec::new();
        for i in 0..300 {
            let start = f64::from(i) * 0.1;
            let at = Pose::new(from + u * start, pose.rotation);
            let mut list = Vec::new();
            collide((&ray(0.1), &at), (&field, &Pose::IDENTITY), CollideOptions::default(), &mut list);
            short.extend(list.iter().map(|c| c.point.depth + start));
        }
        let mut long: Vec<_> = long.iter().map(|c| c.point.depth).collect();
        long.sort_by(f64::total_cmp);
        short.sort_by(f64::total_cmp);
        assert_eq!(long.len(), short.len(), "{long:?} {short:?}");
        assert!(long.iter().zip(&short).all(|(a, b)| (a - b).abs() < 1e-9));
        total += long.len();
    }
    assert!(total > 200, "{total}");
}
