//! Questions to a few geoms.
#![no_main]

use arbitrary::{Result, Unstructured};
use ferrode_collide::space::AxisOrder;
use ferrode_collide::{Colliders, Geom, SpaceKind};
use ferrode_fuzz::{is_unit, number, pose, shape, vector};
use ferrode_math::Aabb;
use libfuzzer_sys::fuzz_target;

fn run(u: &mut Unstructured<'_>) -> Result<()> {
    let mut colliders = Colliders::new();
    let kind = match u.int_in_range(0..=3)? {
        0 => SpaceKind::Simple,
        1 => SpaceKind::Hash { min_level: -3, max_level: 5 },
        2 => SpaceKind::SweepAndPrune(AxisOrder::XYZ),
        _ => SpaceKind::Bvh,
    };
    let Ok(space) = colliders.add_space(None, kind) else { return Ok(()) };
    for _ in 0..u.int_in_range(0..=6)? {
        if let Some(shape) = shape(u)? {
            let _ = colliders.add_geom(Some(space), Geom::new(shape).at(pose(u)?));
        }
    }
    let probe = shape(u)?;
    let at = pose(u)?;
    let Ok(queries) = colliders.queries(space) else { return Ok(()) };
    for _ in 0..u.int_in_range(0..=6)? {
        let (p, d, length) = (vector(u)?, vector(u)?, number(u)?);
        let hit = queries.ray_cast(p, d, length, |_, _| true);
        if let Some(hit) = &hit {
            assert!(hit.distance >= 0.0 && is_unit(hit.normal), "{hit:?}");
        }
        assert_eq!(queries.ray_meets(p, d, length, |_, _| true), hit.is_some());
        let mut hits = Vec::new();
        queries.ray_cast_all(p, d, length, |_, _| true, &mut hits);
        assert!(hits.is_sorted_by(|a, b| a.distance <= b.distance));
        queries.geoms_at(p, |_, depth| assert!(depth >= 0.0));
        if let Some(c) = queries.closest_point(p, length, |_, _| true) {
            assert!(!c.1.distance.is_nan(), "{c:?}");
        }
        queries.geoms_near(&Aabb::new(p.min(d), p.max(d)), |_, _| {});
        if let Some(shape) = &probe {
            queries.overlaps(shape, &at, |_, _| {});
            if let Some(hit) = queries.shape_cast(shape, &at, d, |_, _| true) {
                assert!((0.0..=1.0).contains(&hit.fraction) && is_unit(hit.normal), "{hit:?}");
            }
        }
    }
    Ok(())
}

fuzz_target!(|data: &[u8]| {
    let _ = run(&mut Unstructured::new(data));
});
