//! Geoms that come, move, sleep and go.
#![no_main]

use arbitrary::{Arbitrary, Result, Unstructured};
use ferrode_collide::pairs::{Motion, PairCache, PairSettings};
use ferrode_collide::space::AxisOrder;
use ferrode_collide::{Colliders, Frame, Geom, GeomKey, Item, SpaceKey, SpaceKind};
use ferrode_fuzz::{pose, shape};
use ferrode_math::Aabb;
use libfuzzer_sys::fuzz_target;

const KINDS: [SpaceKind; 5] = [
    SpaceKind::Simple,
    SpaceKind::Hash { min_level: -3, max_level: 5 },
    SpaceKind::Quadtree { center: [0.0, 0.0], half_sides: [16.0, 16.0], depth: 4 },
    SpaceKind::SweepAndPrune(AxisOrder::XYZ),
    SpaceKind::Bvh,
];

/// The place of sweep and prune among these.
const SWEEP: usize = 3;

/// The pairs of a space, by the numbers of their geoms.
fn pairs(colliders: &mut Colliders, space: SpaceKey) -> Vec<(u64, u64)> {
    let mut list = Vec::new();
    let asked = colliders.collide(space, |c, a, b| {
        let number = |item: Item| match item {
            Item::Geom(g) => c.geom(g).map_or(0, Geom::user),
            Item::Space(_) => 0,
        };
        let (a, b) = (number(a), number(b));
        list.push((a.min(b), a.max(b)));
    });
    assert!(asked.is_ok());
    list.sort_unstable();
    list
}

/// Whether sweep and prune reports a pair although the boxes are apart, which ODE's rule has it do: if either has no upper
/// bound on the first axis, and if only single precision has the boxes overlap there.
fn coarse(a: &Aabb, b: &Aabb) -> bool {
    let single = |low: f64, high: f64| low as f32 <= high as f32;
    let overlaps = |i: usize| a.min[i] <= b.max[i] && b.min[i] <= a.max[i];
    a.max.x == f64::INFINITY
        || b.max.x == f64::INFINITY
        || (single(a.min.x, b.max.x) && single(b.min.x, a.max.x) && overlaps(1) && overlaps(2))
}

fn run(u: &mut Unstructured<'_>) -> Result<()> {
    let mut worlds: Vec<(Colliders, SpaceKey)> = Vec::new();
    for kind in KINDS {
        let mut colliders = Colliders::new();
        if let Ok(space) = colliders.add_space(None, kind) {
            worlds.push((colliders, space));
        }
    }
    let mut keys: Vec<Option<Vec<GeomKey>>> = Vec::new();
    let mut cache = PairCache::new(PairSettings::default());
    for _ in 0..u.int_in_range(0..=40)? {
        let i = u.int_in_range(0..=15u32)?;
        match u.int_in_range(0..=5)? {
            0 | 1 => {
                let Some(shape) = shape(u)? else { continue };
                let at = pose(u)?;
                let number = keys.len() as u64;
                keys.push(Some(
                    worlds
                        .iter_mut()
                        .filter_map(|(c, s)| {
                            c.add_geom(Some(*s), Geom::new(shape.clone()).at(at).with_user(number)).ok()
                        })
                        .collect(),
                ));
                let motion = [Motion::Fixed, Motion::Asleep, Motion::Awake][u.int_in_range(0..=2)?];
                cache.insert(number as u32, shape, &Frame::from(&at), motion);
            }
            2 => {
                let at = pose(u)?;
                if let Some(Some(keys)) = keys.get(i as usize) {
                    for (key, (c, _)) in keys.iter().zip(&mut worlds) {
                        let _ = c.set_pose(*key, at);
                    }
                }
                cache.move_geom(i, &Frame::from(&at));
            }
            3 => {
                if let Some(keys) = keys.get_mut(i as usize).and_then(Option::take) {
                    for (key, (c, _)) in keys.iter().zip(&mut worlds) {
                        c.remove_geom(*key);
                    }
                }
                cache.remove(i);
            }
            4 => {
                cache.set_awake(i, bool::arbitrary(u)?);
                cache.set_ahead(i, f32::arbitrary(u)?);
            }
            _ => {
                cache.update(&|a, b| (a + b) % 7 != 0);
                assert!(
                    cache.contacts().all(|(_, c)| c.manifold.points().iter().all(|p| p.depth.is_finite()))
                );
                let mut first = None;
                for (kind, (c, s)) in KINDS.iter().zip(&mut worlds) {
                    let mut list = pairs(c, *s);
                    assert!(list.windows(2).all(|w| w[0] != w[1]), "{kind:?} reports twice: {list:?}");
                    let Some(first) = &first else {
                        first = Some(list);
                        continue;
                    };
                    if matches!(kind, SpaceKind::SweepAndPrune(_)) {
                        let aabb = |number: u64| {
                            let key = keys[number as usize].as_ref().expect("a living geom")[SWEEP];
                            c.aabb(key).expect("a living geom")
                        };
                        list.retain(|&(a, b)| first.contains(&(a, b)) || !coarse(&aabb(a), &aabb(b)));
                    }
                    assert_eq!(&list, first, "{kind:?}");
                }
            }
        }
    }
    Ok(())
}

fuzz_target!(|data: &[u8]| {
    let _ = run(&mut Unstructured::new(data));
});
