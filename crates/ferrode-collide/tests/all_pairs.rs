//! All ordered pairs of all classes, planes, rays, meshes and heightfields included: none is missing, swapping turns the
//! normals and keeps the rest, normals are unit vectors, and moving both shapes together changes nothing.

mod common;

use common::classes::{classes, moved};
use ferrode_collide::narrow::{collide, collides, steady};
use ferrode_collide::*;
use ferrode_math::{Pose, Quat, Vec3};
use proptest::prelude::*;

const SAME: f64 = 1e-9;

/// Depth of the deepest contact; zero if there is none.
fn deepest(list: &[GeomContact]) -> f64 {
    list.iter().map(|c| c.point.depth).fold(0.0, f64::max)
}

type Source = fn((&Shape, &Pose), (&Shape, &Pose), CollideOptions, &mut Vec<GeomContact>) -> usize;

fn list(source: Source, a: (&Shape, &Pose), b: (&Shape, &Pose)) -> Vec<GeomContact> {
    let mut out = Vec::new();
    let n = source(a, b, CollideOptions::new(64), &mut out);
    assert_eq!(n, out.len());
    out
}

fn pose(size: f64) -> impl Strategy<Value = Pose> {
    let turn = prop::array::uniform4(-1.0..1.0f64)
        .prop_map(|q| Quat::from_array(q).normalized().unwrap_or(Quat::IDENTITY));
    (prop::array::uniform3(-size..size), turn).prop_map(|(p, q)| Pose::new(Vec3::from_array(p), q))
}

/// The same contacts, but for those that only just touch: rounding decides whether they do.
fn as_sets(a: &[GeomContact], b: &[GeomContact], same: impl Fn(&GeomContact, &GeomContact) -> bool) -> bool {
    let within = |a: &[GeomContact], b: &[GeomContact]| {
        a.iter().all(|x| x.point.depth < SAME || b.iter().any(|y| same(x, y)))
    };
    within(a, b) && within(b, a)
}

/// Every pair but those that cannot touch gives contacts somewhere.
#[test]
fn no_pair_is_missing() {
    let mut random = ferrode_math::random::OdeRandom::new(7);
    let mut number = |scale: f64| (f64::from(random.next_u32()) / 2147483648.0 - 1.0) * scale;
    for (name_a, a) in &classes() {
        for (name_b, b) in &classes() {
            let both = |n: &str| *name_a == n && *name_b == n;
            let field_and_plane =
                ["plane", "heightfield"].contains(name_a) && ["plane", "heightfield"].contains(name_b);
            let empty = both("ray") || field_and_plane;
            assert_eq!(collides(a.kind(), b.kind()), !empty, "{name_a} {name_b}");
            let found = (0..200).any(|_| {
                let mut at = || {
                    let q = Quat::from_array([number(1.0), number(1.0), number(1.0), number(1.0)]);
                    let p = Vec3::new(number(0.7), number(0.7), number(0.7));
                    Pose::new(p, q.normalized().unwrap_or(Quat::IDENTITY))
                };
                !list(collide, (a, &at()), (b, &at())).is_empty()
            });
            assert_eq!(found, !empty, "{name_a} {name_b}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, rng_seed: common::seed(), ..Default::default() })]

    #[test]
    fn every_ordered_pair_is_sound(pa in pose(0.6), pb in pose(0.6), m in pose(3.0)) {
        let mut faults = Vec::new();
        for source in [collide as Source, steady as Source] {
            for (name_a, a) in &classes() {
                for (name_b, b) in &classes() {
                    let ab = list(source, (a, &pa), (b, &pb));
                    for c in &ab {
                        let p = c.point;
                        prop_assert!((p.normal.length() - 1.0).abs() < SAME, "{name_a} {name_b} {c:?}");
                        prop_assert!(p.depth >= 0.0 && p.depth.is_finite() && p.position.is_finite());
                    }
                    let same = |x: &GeomContact, y: &GeomContact| {
                        (x.point.position - y.point.position).abs_max() < SAME
                            && (x.point.normal - y.point.normal).abs_max() < SAME
                            && (x.point.depth - y.point.depth).abs() < SAME
                    };
                    // Two of one class may choose the features of either.
                    if name_a != name_b {
                        let mut ba = list(source, (b, &pb), (a, &pa));
                        ba.iter_mut().for_each(|c| *c = c.swapped());
                        if !as_sets(&ab, &ba, same) {
                            faults.push(format!("swapped {name_a} {name_b}\n{ab:?}\n{ba:?}"));
                        }
                    }
                    let ((ma, qa), (mb, qb)) = (moved(a, &pa, &m), moved(b, &pb, &m));
                    let after = list(source, (&ma, &qa), (&mb, &qb));
                    let after: Vec<_> = after
                        .into_iter()
                        .map(|mut c| {
                            c.point.position = m.inverse().transform_point(c.point.position);
                            c.point.normal = m.rotation.inverse_rotate(c.point.normal);
                            c
                        })
                        .collect();
                    if !as_sets(&ab, &after, same) {
                        faults.push(format!("moved {name_a} {name_b}\n{ab:?}\n{after:?}"));
                    }
                }
            }
        }
        prop_assert!(faults.is_empty(), "{}", faults.join("\n"));
    }

    /// Ten thousand kilometres from the origin, where coordinates are told apart to 2 nm, depths are the same to that.
    #[test]
    fn far_from_the_origin_depths_stay(pa in pose(0.6), pb in pose(0.6)) {
        const FAR: f64 = 8_388_608.0;
        // Coordinates that are exact there.
        let grid = |p: Pose| {
            let round = |x: f64| (x * 16_777_216.0).round() / 16_777_216.0;
            let [x, y, z] = p.position.to_array();
            Pose::new(Vec3::new(round(x), round(y), round(z)), p.rotation)
        };
        let (pa, pb) = (grid(pa), grid(pb));
        let m = Pose::from_position(Vec3::new(FAR, -FAR, FAR));
        let mut faults = Vec::new();
        for (name_a, a) in &classes() {
            for (name_b, b) in &classes() {
                let near = list(collide, (a, &pa), (b, &pb));
                let ((ma, qa), (mb, qb)) = (moved(a, &pa, &m), moved(b, &pb, &m));
                let far = list(collide, (&ma, &qa), (&mb, &qb));
                let both = near.is_empty() == far.is_empty() || deepest(&near).max(deepest(&far)) < 1e-7;
                if !both || (deepest(&near) - deepest(&far)).abs() > 1e-7 {
                    faults.push(format!("{name_a} {name_b}\n{near:?}\n{far:?}"));
                }
            }
        }
        prop_assert!(faults.is_empty(), "{}", faults.join("\n"));
    }
}
