//! Pairs that spaces report, against those recorded from libode 0.16.2: which, in which order, which first.

mod common;

use common::Record;
use ferrode_collide::space::AxisOrder;
use ferrode_collide::{Colliders, Cuboid, Frame, Geom, GeomKey, Item, SpaceKind};
use ferrode_math::{Pose, Quat, Vec3};
use serde_json::Value;
use std::collections::BTreeMap;

fn kind(name: &str) -> Option<SpaceKind> {
    Some(match name {
        "simple" => SpaceKind::Simple,
        "hash_default" => SpaceKind::HASH,
        "hash_levels_-1_1" => SpaceKind::Hash { min_level: -1, max_level: 1 },
        "quadtree_depth4" => SpaceKind::Quadtree { center: [0.0; 2], half_sides: [4.0; 2], depth: 4 },
        "sap_xzy" => SpaceKind::SweepAndPrune(AxisOrder::XZY),
        "sap_xyz" => SpaceKind::SweepAndPrune(AxisOrder::XYZ),
        _ => return None,
    })
}

fn pose(frame: &Frame) -> Pose {
    Pose::new(frame.position, Quat::from_matrix(&frame.rotation))
}

fn pairs(v: &Value) -> Vec<(u64, u64)> {
    v.as_array().unwrap().iter().map(|p| (p[0].as_u64().unwrap(), p[1].as_u64().unwrap())).collect()
}

#[test]
fn pairs_come_as_in_libode() {
    let mut compared = 0;
    let record = Record::open(&["spaces.json"]);
    for scene in record.list("broadphase") {
        for (name, want) in scene["reports"].as_object().unwrap() {
            let Some(kind) = kind(name.trim_end_matches("_vs_box")) else { continue };
            let mut colliders = Colliders::new();
            let space = colliders.add_space(None, kind).unwrap();
            let mut numbers: BTreeMap<GeomKey, u64> = BTreeMap::new();
            for (i, g) in scene["geoms"].as_array().unwrap().iter().enumerate() {
                let (shape, frame) = record.geom(&g["g"]).unwrap();
                let bits = |key: &str| g[key].as_u64().unwrap();
                let geom = Geom::new(shape).at(pose(&frame)).with_bits(bits("category"), bits("collide"));
                let key = colliders.add_geom(Some(space), geom).unwrap();
                colliders.set_enabled(key, g["enabled"] == 1).unwrap();
                numbers.insert(key, i as u64);
            }
            let mut got = Vec::new();
            if name.ends_with("_vs_box") {
                let at = Pose::from_position(Vec3::splat(0.25));
                let cube = Geom::new(Cuboid::new(Vec3::splat(2.0)).unwrap()).at(at);
                let cube = colliders.add_geom(None, cube).unwrap();
                numbers.insert(cube, 999);
                let mut report = |_: &Colliders, a: Item, b: Item| got.push((a, b));
                colliders.collide2(cube, space, &mut report).unwrap();
            } else {
                colliders.collide(space, |_, a, b| got.push((a, b))).unwrap();
            }
            let number = |item: Item| match item {
                Item::Geom(key) => numbers[&key],
                Item::Space(_) => panic!("no spaces in this scene"),
            };
            let got: Vec<_> = got.into_iter().map(|(a, b)| (number(a), number(b))).collect();
            assert_eq!(got, pairs(want), "{name}");
            compared += 1;
        }
    }
    assert!(compared >= 24, "{compared}");
}
