//! The spaces against each other, while geoms move, come and go.

use ferrode_collide::space::AxisOrder;
use ferrode_collide::{Colliders, Cuboid, Geom, GeomKey, Item, Plane, SpaceKey, SpaceKind, Sphere};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Pose, Vec3};
use std::collections::BTreeMap;

const KINDS: [SpaceKind; 5] = [
    SpaceKind::Simple,
    SpaceKind::HASH,
    SpaceKind::Bvh,
    SpaceKind::Quadtree { center: [0.5, -0.25], half_sides: [5.0, 4.0], depth: 3 },
    SpaceKind::SweepAndPrune(AxisOrder::YZX),
];

struct World {
    colliders: Colliders,
    space: SpaceKey,
    /// By number; the same number is the same geom in all worlds.
    keys: Vec<Option<GeomKey>>,
}

fn random_vec(random: &mut OdeRandom, size: f64) -> Vec3 {
    let mut x = || (f64::from(random.next_u32()) / 4294967296.0 - 0.5) * size;
    Vec3::new(x(), x(), x())
}

fn geom(random: &mut OdeRandom) -> Geom {
    let at = Pose::from_position(random_vec(random, 10.0));
    let size = 0.05 + f64::from(random.next_below(100)) * 0.02;
    match random.next_below(20) {
        0 => Geom::new(Plane::new(random_vec(random, 1.0) + Vec3::Z, 0.1).unwrap()),
        1..9 => Geom::new(Cuboid::new(Vec3::new(size, 2.0 * size, 0.5 * size)).unwrap()).at(at),
        _ => Geom::new(Sphere::new(size).unwrap()).at(at),
    }
    .with_bits(1 << random.next_below(4), u64::from(random.next_below(16)))
}

fn pairs(world: &mut World) -> Vec<(usize, usize)> {
    let numbers: BTreeMap<GeomKey, usize> =
        world.keys.iter().enumerate().filter_map(|(i, k)| k.map(|k| (k, i))).collect();
    let number = |item: Item| match item {
        Item::Geom(key) => numbers[&key],
        Item::Space(_) => panic!("no space in this space"),
    };
    let mut list = Vec::new();
    world
        .colliders
        .collide(world.space, |_, a, b| {
            let (a, b) = (number(a), number(b));
            list.push((a.min(b), a.max(b)));
        })
        .unwrap();
    list
}

#[test]
fn all_spaces_report_the_same_pairs() {
    let mut random = OdeRandom::new(7);
    let mut worlds: Vec<World> = KINDS
        .iter()
        .map(|&kind| {
            let mut colliders = Colliders::new();
            let space = colliders.add_space(None, kind).unwrap();
            World { colliders, space, keys: Vec::new() }
        })
        .collect();
    let mut total = 0;
    for round in 0..60 {
        for _ in 0..30 {
            let g = geom(&mut random);
            let target = random.next_below(200) as usize;
            let (place, enabled) = (random_vec(&mut random, 10.0), random.next_below(10) > 0);
            let nudge = random_vec(&mut random, 0.1);
            let action = random.next_below(4);
            for w in &mut worlds {
                let existing = w.keys.get(target).copied().flatten();
                match (existing, action) {
                    (Some(key), 0) => {
                        assert!(w.colliders.remove_geom(key).is_some());
                        assert!(w.colliders.remove_geom(key).is_none(), "a stale key");
                        w.keys[target] = None;
                    }
                    (Some(key), 1) => {
                        // A plane stays.
                        let _ = w.colliders.set_pose(key, Pose::from_position(place));
                        w.colliders.set_enabled(key, enabled).unwrap();
                    }
                    (Some(key), _) => {
                        let at = w.colliders.geom(key).unwrap().pose().position;
                        let _ = w.colliders.set_pose(key, Pose::from_position(at + nudge));
                    }
                    (None, _) => {
                        let key = w.colliders.add_geom(Some(w.space), g.clone()).unwrap();
                        w.keys.push(Some(key));
                    }
                }
            }
        }
        let lists: Vec<_> = worlds.iter_mut().map(pairs).collect();
        // The tree's order is that of insertion.
        assert!(lists[2].is_sorted(), "round {round}");
        let mut sorted = lists;
        sorted.iter_mut().for_each(|l| l.sort_unstable());
        total += sorted[0].len();
        for list in &sorted[1..] {
            assert!(list.windows(2).all(|w| w[0] != w[1]), "a pair twice, round {round}");
            assert_eq!(list, &sorted[0], "round {round}");
        }
        // A clone answers to the same keys with the same pairs.
        for w in &mut worlds {
            let mut copy = World { colliders: w.colliders.clone(), space: w.space, keys: w.keys.clone() };
            assert_eq!(pairs(&mut copy), pairs(w));
        }
    }
    assert!(total > 1000, "{total}");
}

#[test]
fn keys_of_other_containers_match_nothing() {
    let (mut a, mut b) = (Colliders::new(), Colliders::new());
    let geom = Geom::new(Sphere::new(1.0).unwrap());
    let (ka, kb) = (a.add_geom(None, geom.clone()).unwrap(), b.add_geom(None, geom.clone()).unwrap());
    assert!(a.geom(kb).is_none() && b.geom(ka).is_none());
    let copy = a.clone();
    assert!(copy.geom(ka).is_some());
    // What is added to a copy is not the original's, even in the same slot.
    let mut copy = copy;
    let kc = copy.add_geom(None, geom.clone()).unwrap();
    let ka2 = a.add_geom(None, geom).unwrap();
    assert!(kc != ka2 && a.geom(kc).is_none() && copy.geom(ka2).is_none());
}
