//! Meshes, heightfields and polyhedra of any numbers.
#![no_main]

use arbitrary::{Result, Unstructured};
use ferrode_collide::{CollideOptions, Convex, Frame, Shape, Sphere, TriMesh, narrow, point_depth, ray_cast};
use ferrode_fuzz::{field, hull, is_unit, mesh, pose, vector};
use libfuzzer_sys::fuzz_target;

fn run(u: &mut Unstructured<'_>) -> Result<()> {
    let shape = match u.int_in_range(0..=4)? {
        0 => mesh(u)?.map(Shape::from),
        1 => field(u)?.map(Shape::from),
        2 => hull(u)?.map(Shape::from),
        3 => {
            let points = (0..u.int_in_range(0..=10)?).map(|_| vector(u)).collect::<Result<Vec<_>>>()?;
            let faces = (0..u.int_in_range(0..=8)?)
                .map(|_| {
                    (0..u.int_in_range(0..=5)?).map(|_| u.int_in_range(0..=10u32)).collect::<Result<Vec<_>>>()
                })
                .collect::<Result<Vec<_>>>()?;
            Convex::from_faces(&points, &faces).ok().map(Shape::from)
        }
        _ => {
            let soup = (0..u.int_in_range(0..=12)?)
                .map(|_| Ok([vector(u)?, vector(u)?, vector(u)?]))
                .collect::<Result<Vec<_>>>()?;
            TriMesh::from_triangles(&soup).ok().map(Shape::from)
        }
    };
    let Some(shape) = shape else { return Ok(()) };
    let at = pose(u)?;
    let frame = Frame::from(&at);
    let aabb = shape.aabb_in(&frame);
    assert!(!(aabb.min.x.is_nan() || aabb.max.x.is_nan()), "{aabb:?} {shape:?} {at:?}");
    let p = vector(u)?;
    point_depth(&shape, &frame, p);
    if let Some(hit) = ray_cast(&shape, &frame, p, vector(u)?, 1e3) {
        assert!(hit.distance >= 0.0 && is_unit(hit.normal), "{hit:?}");
    }
    let ball = Shape::from(Sphere::new(0.5).expect("a ball"));
    let mut contacts = Vec::new();
    narrow::collide((&ball, &pose(u)?), (&shape, &at), CollideOptions::default(), &mut contacts);
    for c in &contacts {
        assert!(is_unit(c.point.normal) && c.point.depth >= 0.0, "{c:?}");
    }
    Ok(())
}

fuzz_target!(|data: &[u8]| {
    let _ = run(&mut Unstructured::new(data));
});
