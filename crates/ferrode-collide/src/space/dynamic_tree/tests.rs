use super::*;
use ferrode_math::random::OdeRandom;
use ferrode_math::{Aabb, Vec3};
use std::collections::BTreeSet;

/// Leaves that go their own ways, none of them far in a step.
#[test]
fn long_drifting_does_not_wear_the_tree() {
    let mut random = OdeRandom::new(1);
    let mut number = || (f64::from(random.next_u32()) / 4294967296.0) as f32;
    let mut places: Vec<[f32; 6]> = (0..400)
        .map(|_| core::array::from_fn(|k| if k < 3 { 40.0 * number() } else { number() - 0.5 }))
        .collect();
    let around = |p: &[f32; 6]| Box32 { min: [p[0], p[1], p[2]], max: [p[0] + 1.0, p[1] + 1.0, p[2] + 1.0] };
    let list = |places: &[[f32; 6]]| -> Vec<(u32, Box32)> { (0..).zip(places.iter().map(around)).collect() };
    let (mut tree, mut fresh) = (DynamicTree::default(), DynamicTree::default());
    tree.insert_all(&mut list(&places), true);
    for step in 0..400 {
        for p in &mut places {
            for k in 0..3 {
                p[k] += 0.3 * p[k + 3];
                if p[k] < 0.0 || p[k] > 40.0 {
                    p[k + 3] = -p[k + 3];
                }
            }
        }
        // A third of them at a time.
        let mut changes: Vec<_> = list(&places).into_iter().filter(|(i, _)| i % 3 == step % 3).collect();
        tree.change_all(&mut changes);
        fresh.build(&mut tree.leaves().collect::<Vec<_>>());
        let (cost, least) = (tree.cost(), fresh.cost());
        assert!(cost < 2.0 * least, "step {step}: {cost} for {least}");
    }
    let mut found = Vec::new();
    tree.walk(|_| true, |payload| found.push(payload));
    found.sort_unstable();
    assert!(found.into_iter().eq(0..400));
}

#[test]
fn a_wide_copy_finds_the_same() {
    let mut random = OdeRandom::new(2);
    let mut number = || f64::from(random.next_u32()) / 4294967296.0;
    let mut vector = |size: f64| Vec3::new(number() - 0.5, number() - 0.5, number() - 0.5) * size;
    for count in [1u32, 2, 3, 5, 300] {
        let boxes: Vec<Aabb> =
            (0..count).map(|_| Aabb::from_center(vector(20.0), vector(2.0).abs())).collect();
        let mut items: Vec<_> = (0..count).map(|i| (i, Box32::around(&boxes[i as usize]))).collect();
        let mut tree = DynamicTree::default();
        tree.build(&mut items);
        for _ in 0..60 {
            let (at, path) = (vector(24.0), vector(30.0));
            let around = Aabb::from_center(at, vector(8.0).abs());
            let list = |tree: &DynamicTree| {
                let mut found = Vec::new();
                tree.query(&Box32::around(&around), |i| found.push(i));
                found
            };
            let (binary, asked) = (tree.clone(), tree.clone());
            (0..=count).for_each(|_| asked.query(&items[0].1, |_| {}));
            assert!(asked.wide(Search::Query).is_some() && binary.wide(Search::Query).is_none());
            (0..=count).for_each(|_| _ = asked.packed(&|_| None));
            assert!(asked.packed(&|_| None).is_some());
            assert_eq!(list(&asked), list(&binary));
            let along_axis = Vec3::new(0.0, path.y, 0.0);
            for probe in [
                Probe::ray(at, path),
                Probe::ray(at, along_axis),
                Probe::sweep(&around, path),
                Probe::sweep(&around, along_axis),
                Probe::near(&around),
            ] {
                for most in [1.0, 0.3, f64::INFINITY] {
                    let met = |i: u32| probe.enter_aabb(&boxes[i as usize], most);
                    let mut missing: BTreeSet<u32> = (0..count).filter(|&i| met(i).is_some()).collect();
                    let first = missing.iter().filter_map(|&i| met(i)).min_by(f64::total_cmp);
                    for tree in [&asked, &binary] {
                        let (mut limit, mut nearest) = (most, None);
                        tree.seek(&probe, &mut limit, &|_| None, |i, limit| {
                            if let Some(at) = met(i).filter(|at| at <= limit) {
                                (*limit, nearest) = (at, Some(at));
                            }
                        });
                        assert_eq!(nearest, first);
                    }
                    asked.seek(&probe, &mut { most }, &|_| None, |i, _| {
                        missing.remove(&i);
                    });
                    assert!(missing.is_empty(), "{count} {probe:?} {missing:?}");
                }
            }
        }
        let mut all = Vec::new();
        (0..=count).for_each(|_| tree.query(&items[0].1, |_| {}));
        tree.query(&Box32 { min: [f32::NEG_INFINITY; 3], max: [f32::INFINITY; 3] }, |i| all.push(i));
        all.sort_unstable();
        assert!(all.into_iter().eq(0..count));
        // A change is not lost on the copy.
        (0..=count).for_each(|_| tree.query(&items[0].1, |_| {}));
        tree.change(0, &Box32 { min: [90.0; 3], max: [91.0; 3] });
        let mut found = Vec::new();
        tree.query(&Box32 { min: [90.5; 3], max: [90.6; 3] }, |i| found.push(i));
        assert_eq!(found, [0]);
    }
}
