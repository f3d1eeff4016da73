use super::*;
use crate::space::Probe;
use ferrode_math::random::OdeRandom;
use ferrode_math::{Aabb, Vec3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// A packed tree over boxes, by the middle of their list: a bad one, but any will do.
fn pack(boxes: &[Box32]) -> PackedTree {
    let part = |(start, end): (usize, usize)| Part {
        bounds: boxes[start..end].iter().fold(Box32::EMPTY, |all, b| all.union(b)),
        leaf: (end - start == 1).then_some((start as u32, 1)),
        of: (start, end),
    };
    PackedTree::build(part((0, boxes.len())), |(start, end)| {
        let middle = start + (end - start) / 2;
        [part((start, middle)), part((middle, end))]
    })
}

/// Boxes of a size within a cube of a size about a place far away.
fn boxes(random: &mut impl FnMut() -> f64, count: usize, far: Vec3, spread: f64, size: f64) -> Vec<Aabb> {
    (0..count)
        .map(|k| {
            let at = far + Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5) * spread;
            // One in five is flat or a point, one in seven much larger.
            let scale = size * if k % 7 == 0 { 20.0 } else { 1.0 };
            let mut half = Vec3::new(random(), random(), random()) * (0.5 * scale);
            if k % 5 == 0 {
                half[k % 3] = 0.0;
            }
            Aabb::from_center(at, if k % 35 == 34 { Vec3::ZERO } else { half })
        })
        .collect()
}

/// As in the tests of the crate: `PROPTEST_RNG_SEED`, else always the same.
fn seed() -> RngSeed {
    RngSeed::Fixed(std::env::var("PROPTEST_RNG_SEED").ok().and_then(|s| s.parse().ok()).unwrap_or(1))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, rng_seed: seed(), ..Default::default() })]

    /// Whatever the exact test of each box finds, the search finds; and the nearest when hits shorten it.
    #[test]
    fn finds_what_a_look_at_each_box_finds(
        seed in any::<u32>(),
        count in 1usize..80,
        offset in prop::sample::select(vec![0.0, 1.0, 1e3, 1e6, 1e7, 4e7]),
        spread in prop::sample::select(vec![1e-6, 1e-2, 1.0, 30.0, 1e3, 1e6]),
        size in prop::sample::select(vec![1e-6, 1e-3, 0.1, 1.0, 40.0, 1e5]),
    ) {
        let mut numbers = OdeRandom::new(seed);
        let mut random = || f64::from(numbers.next_u32()) / 4294967296.0;
        let far = Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5) * (2.0 * offset);
        let boxes = boxes(&mut random, count, far, spread, size);
        let rounded: Vec<Box32> = boxes.iter().map(Box32::around).collect();
        let all = rounded.iter().fold(Box32::EMPTY, |all, b| all.union(b));
        let tree = pack(&rounded);
        for round in 0..40 {
            let mut from = far + Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5) * (1.5 * spread);
            let target = &boxes[(random() * count as f64) as usize];
            let mut path = Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5) * 2.0;
            match round % 8 {
                // At a box, from within one, along an axis, in a plane of two, by next to nothing along the others.
                0 | 1 => path = target.center() - from,
                2 => from = target.center(),
                3 => {
                    from = target.center() + Vec3::Y * (target.min.y - target.max.y);
                    path = Vec3::Y * 0.3;
                }
                4 => path = Vec3::new(0.0, -0.0, -1.0),
                5 => path[round % 3] = -0.0,
                6 => path = Vec3::new(1e-30, path.y, -1e-200),
                // Along a face.
                _ => {
                    from = target.min - Vec3::X;
                    path = Vec3::X;
                }
            }
            let around = Aabb::from_center(from, Vec3::new(random(), random(), random()) * size);
            let ray = path.normalized().map_or(path, |p| if round % 2 == 0 { p } else { path });
            for probe in [Probe::ray(from, ray), Probe::sweep(&around, path)] {
                let Some(bundle) = probe.bundle(&all) else {
                    prop_assert!(path.abs_max() == 0.0, "{probe:?}");
                    continue;
                };
                for most in [f64::INFINITY, 3.0 * spread, 1.0, 0.0] {
                    let met = |i: u32| probe.enter_aabb(&boxes[i as usize], most);
                    let mut missing: Vec<u32> = (0..count as u32).filter(|&i| met(i).is_some()).collect();
                    let nearest = missing.iter().filter_map(|&i| met(i)).filter(|at| *at <= most);
                    let nearest = nearest.min_by(f64::total_cmp);
                    let mut visits = vec![0; count];
                    tree.seek(&bundle, &mut { most }, |i, _, _| {
                        missing.retain(|&m| m != i);
                        visits[i as usize] += 1;
                    });
                    prop_assert!(missing.is_empty(), "{missing:?} {probe:?} {bundle:?} {most}");
                    prop_assert!(visits.iter().all(|&n| n <= 1));
                    let (mut limit, mut best) = (most, None);
                    tree.seek(&bundle, &mut limit, |i, _, limit| {
                        if let Some(at) = met(i).filter(|at| at <= limit) {
                            (*limit, best) = (at, Some(at));
                        }
                    });
                    prop_assert_eq!(best, nearest);
                }
            }
        }
    }
}

#[test]
fn boxes_in_bytes_hold_those_that_they_stand_for() {
    let mut numbers = OdeRandom::new(3);
    let mut random = || f64::from(numbers.next_u32()) / 4294967296.0;
    for round in 0..2000 {
        let scale = [1e-8, 1e-5, 1e-3, 0.1, 1.0, 30.0, 1e4, 1e6, 1e8][round % 9];
        let far = Vec3::new(random(), random(), random()) * [0.0, 1.0, 1e2, 1e5, 1e7][round % 5];
        let boxes: Vec<Box32> =
            boxes(&mut random, 1 + round % 7, far, scale, scale).iter().map(Box32::around).collect();
        let seven = Seven::new(boxes.iter(), 0, 0);
        assert_eq!(seven.used().count_ones() as usize, boxes.len());
        for (l, b) in boxes.iter().enumerate() {
            for axis in 0..3 {
                let side = |q: u8| f64::from(seven.origin[axis]) + f64::from(q) * f64::from(seven.step(axis));
                let [low, high] = [0, 1].map(|k| side(seven.sides[axis][k][l]));
                // Numbers in double precision, added with an error of their own.
                let hair = 4.0 * f64::EPSILON * far.abs_max().max(scale);
                assert!(low <= f64::from(b.min[axis]) + hair && high + hair >= f64::from(b.max[axis]));
                // And not by more than a step.
                let step = f64::from(seven.step(axis)) + hair;
                assert!(low + step >= f64::from(b.min[axis]) && high - step <= f64::from(b.max[axis]));
            }
        }
    }
}

#[test]
fn a_long_way_off_the_search_in_bytes_is_not_for() {
    let all = Box32 { min: [-1.0; 3], max: [1.0; 3] };
    assert!(Probe::ray(Vec3::X * 1e7, Vec3::X).bundle(&all).is_some());
    assert!(Probe::ray(Vec3::X * 2e8, Vec3::X).bundle(&all).is_none());
    assert!(Probe::ray(Vec3::X * f64::NAN, Vec3::X).bundle(&all).is_none());
    assert!(Probe::ray(Vec3::X, Vec3::X * f64::NAN).bundle(&all).is_none());
    let wide = Box32 { min: [f32::NEG_INFINITY; 3], max: [1.0; 3] };
    assert!(Probe::ray(Vec3::X, Vec3::X).bundle(&wide).is_none());
    assert!(Probe::ray(Vec3::X, Vec3::X * 1e13).bundle(&all).is_none());
    let near = Aabb::from_center(Vec3::X, Vec3::splat(1.0));
    assert!(Probe::near(&near).bundle(&all).is_none());
}
