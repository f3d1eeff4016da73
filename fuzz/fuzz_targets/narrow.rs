//! Two shapes at two poses.
#![no_main]

use arbitrary::{Arbitrary, Result, Unstructured};
use ferrode_collide::manifold::{Workspace, manifolds};
use ferrode_collide::{CollideOptions, Frame, narrow};
use ferrode_fuzz::{is_unit, pose, shape, vector};
use ferrode_math::Vec3;
use libfuzzer_sys::fuzz_target;

fn run(u: &mut Unstructured<'_>) -> Result<()> {
    let (Some(a), Some(b)) = (shape(u)?, shape(u)?) else { return Ok(()) };
    let (pa, pb) = (pose(u)?, pose(u)?);
    let (fa, fb) = (Frame::from(&pa), Frame::from(&pb));
    let options = CollideOptions::new(u.int_in_range(0..=20)?);
    let mut contacts = Vec::new();
    narrow::collide((&a, &pa), (&b, &pb), options, &mut contacts);
    narrow::steady((&a, &pa), (&b, &pb), options, &mut contacts);
    for c in &contacts {
        assert!(is_unit(c.point.normal) && c.point.position.is_finite(), "{c:?}");
        assert!(c.point.depth >= 0.0 && c.point.depth.is_finite(), "{c:?}");
    }
    let margin = f64::from(u8::arbitrary(u)?) * 1e-3;
    let mut list = Vec::new();
    manifolds((&a, &fa), (&b, &fb), margin, &mut Workspace::default(), &mut list);
    for m in &mut list {
        let n = Vec3::new(m.normal.x.into(), m.normal.y.into(), m.normal.z.into());
        assert!(is_unit(n) && (1..=4).contains(&m.points().len()), "{m:?}");
        assert!(m.points().iter().all(|p| p.depth.is_finite()), "{m:?}");
        m.refresh(&fa, &fb);
    }
    if let Some(d) = narrow::distance((&a, &pa), (&b, &pb)) {
        assert!(!d.distance.is_nan(), "{d:?} {a:?} {pa:?} {b:?} {pb:?}");
    }
    narrow::shape_cast((&a, &fa), vector(u)?, (&b, &fb));
    Ok(())
}

fuzz_target!(|data: &[u8]| {
    let _ = run(&mut Unstructured::new(data));
});
