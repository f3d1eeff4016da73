use super::node::power_of_two;
use super::*;
use crate::Frame;
use crate::space::{Probe, TurnedBox};
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
                let step = power_of_two(seven.exponent(axis));
                let side = |q: u8| f64::from(seven.origin[axis]) + f64::from(q) * step;
                let [low, high] = [0, 1].map(|k| side(seven.sides[axis][k][l]));
                // Numbers in double precision, added with an error of their own.
                let hair = 4.0 * f64::EPSILON * far.abs_max().max(scale);
                assert!(low <= f64::from(b.min[axis]) + hair && high + hair >= f64::from(b.max[axis]));
                // And not by more than a step.
                let step = step + hair;
                assert!(low + step >= f64::from(b.min[axis]) && high - step <= f64::from(b.max[axis]));
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, rng_seed: seed(), ..Default::default() })]

    /// No ray that meets a turned box passes by it in single precision, and few that miss it by much seem to meet it.
    #[test]
    fn turned_boxes_that_a_ray_meets_are_met(
        seed in any::<u32>(),
        offset in prop::sample::select(vec![0.0, 1.0, 100.0, 1e4, 1e6, 4e7]),
        size in prop::sample::select(vec![1e-6, 1e-3, 0.1, 1.0, 40.0, 1e5]),
    ) {
        let mut numbers = OdeRandom::new(seed);
        let mut random = || f64::from(numbers.next_u32()) / 4294967296.0;
        let mut vector = || Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5) * 2.0;
        let far = vector() * offset;
        for round in 0..60 {
            let axis = vector().normalized_or(Vec3::Z);
            let mut half = vector().abs() * size;
            if round % 5 == 0 {
                half[round % 3] = 0.0;
            }
            let rotation = ferrode_math::Quat::from_axis_angle(axis, vector().x * 4.0);
            // Some lie along the axes of the world, and so does the ray of the same round.
            let straight = round % 4 == 0;
            let rotation = if straight { ferrode_math::Quat::IDENTITY } else { rotation };
            let frame = Frame::new(far + vector() * size, rotation.to_matrix());
            let turned = TurnedBox { frame, half };
            let leaf = LeafBox::new(7, &turned);
            let corner = frame.point_to_world(half).abs_max().max(frame.point_to_world(-half).abs_max());
            let reach = corner + 3.0 * size;
            let all = Box32 { min: [-reach as f32; 3], max: [reach as f32; 3] };
            // A point on the surface or within, mostly a corner or on an edge.
            let mut inner = vector();
            for k in 0..3 {
                if (round >> k) % 3 != 0 {
                    inner[k] = inner[k].signum();
                }
            }
            let target = frame.point_to_world(inner.component_mul(half));
            let mut direction = vector().normalized_or(Vec3::X);
            if straight {
                direction = [Vec3::X, -Vec3::Y, Vec3::Z][round % 3];
            }
            let from = target - direction * (vector().x.abs() * 3.0 * (size + offset));
            if let Some(bundle) = Probe::ray(from, direction).bundle(&all) {
                let line = bundle.line.expect("a unit direction");
                prop_assert!(leaf.is_met(&line), "{from:?} {direction:?} {turned:?}");
                prop_assert!(LeafBox::anywhere(7).is_met(&line));
                // Beside it by more than its diagonal.
                let aside = ferrode_math::plane_space(direction).0 * (2.0 * half.length() + 1e-3 * reach);
                let beside = Probe::ray(from + aside, direction).bundle(&all).and_then(|b| b.line);
                prop_assert!(beside.is_none_or(|line| !leaf.is_met(&line)));
            }
        }
    }
}

/// A tree as lopsided as can be, all of whose boxes are met, lets more wait than there is room for in registers and beside.
#[test]
fn what_waits_may_be_much() {
    let count = 400u32;
    let bounds = |i: u32| Box32 { min: [f64::from(i) as f32 * 0.001, 0.0, 0.0], max: [2.0; 3] };
    let part = |first: u32| Part {
        bounds: bounds(first),
        leaf: (first + 1 == count).then_some((first, 1)),
        of: first,
    };
    let open = |first: u32| [Part { leaf: Some((first, 1)), ..part(first) }, part(first + 1)];
    let turned =
        |payload| LeafBox::new(payload, &TurnedBox { frame: Frame::IDENTITY, half: Vec3::splat(2.0) });
    let (rows, boxed) =
        (PackedTree::build(part(0), open), PackedTree::build_with_boxes(part(0), open, &turned));
    for direction in [Vec3::X, -Vec3::X, Vec3::new(0.6, 0.0, 0.8)] {
        let bundle =
            Probe::ray(Vec3::splat(1.0) - direction * 5.0, direction).bundle(rows.bounds()).expect("near");
        let (mut first, mut second) = (Vec::new(), Vec::new());
        rows.seek(&bundle, &mut 10.0, |i, n, _| first.push(i + n - 1));
        boxed.seek_boxes(&bundle, &mut 10.0, |i, _| second.push(i));
        for mut found in [first, second] {
            found.sort_unstable();
            assert!(found.into_iter().eq(0..count));
        }
    }
}

#[test]
fn a_leaf_keeps_its_numbers() {
    let leaf = LeafBox {
        axes: [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]],
        half: [10.0, 11.0, 12.0],
        center: [13.0, 14.0, 15.0],
        payload: 16,
    };
    assert_eq!(format!("{leaf:?}"), format!("{:?}", Seven::leaf(&leaf).as_leaf()));
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
