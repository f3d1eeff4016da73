//! Smaller lists of the record of libode 0.16.2: options of rays on meshes, merging of a ball's contacts with a mesh, and
//! shapes within transforms.

mod common;

use common::{Record, contacts, number, vector};
use ferrode_collide::narrow::collide_frames;
use ferrode_collide::{CollideOptions, Frame, GeomContact, Shape};
use ferrode_math::Mat3;
use serde_json::Value;

const FILES: &[&str] = &["mesh.json", "convex.json"];

fn near(a: &GeomContact, b: &GeomContact, tolerance: f64) -> bool {
    (a.point.position - b.point.position).abs_max() < tolerance
        && (a.point.normal - b.point.normal).abs_max() < tolerance
        && (a.point.depth - b.point.depth).abs() < tolerance
}

fn as_sets(a: &[GeomContact], b: &[GeomContact], tolerance: f64) -> bool {
    let within =
        |a: &[GeomContact], b: &[GeomContact]| a.iter().all(|x| b.iter().any(|y| near(x, y, tolerance)));
    within(a, b) && within(b, a)
}

fn collide(a: &(Shape, Frame), b: &(Shape, Frame), case: &Value) -> Vec<GeomContact> {
    let mut out = Vec::new();
    let flags = case["flags"].as_u64().unwrap_or(8) as u32;
    collide_frames((&a.0, &a.1), (&b.0, &b.1), CollideOptions::from_ode_flags(flags), &mut out);
    out
}

#[test]
fn rays_on_meshes_heed_their_options() {
    let record = Record::open(FILES);
    let (mut cases, mut agree) = (0, 0);
    for case in record.list("ray_trimesh_options") {
        let (a, b) = (record.geom(&case["a"]).unwrap(), record.geom(&case["b"]).unwrap());
        let Shape::Ray(mut ray) = a.0 else { panic!("{case}") };
        let flag = |key: &str| {
            [&case[key], &case["a"][key]]
                .into_iter()
                .any(|v| v == &Value::Bool(true) || v.as_f64() == Some(1.0))
        };
        ray.first_contact = flag("first_contact");
        ray.backface_cull = flag("backface_cull");
        ray.closest_hit = flag("closest_hit");
        let (got, want) = (collide(&(ray.into(), a.1), &b, case), contacts(case));
        cases += 1;
        if as_sets(&got, &want, 1e-4) {
            agree += 1;
        } else {
            // The first contact that libode comes upon need not be the nearest; ours is.
            let first = ray.first_contact && got.len() == 1 && want.len() == 1;
            assert!(first && got[0].point.depth < want[0].point.depth + 1e-4, "{case}\n{got:?}");
        }
    }
    println!("{agree} of {cases}");
    assert!(cases > 0 && agree * 10 >= cases * 8, "{agree} of {cases}");
}

#[test]
fn balls_on_meshes_are_those_without_merging() {
    let record = Record::open(FILES);
    let (mut cases, mut agree) = ([0; 4], [0; 4]);
    for case in record.list("sphere_trimesh_merge") {
        let (a, b) = (record.geom(&case["a"]).unwrap(), record.geom(&case["b"]).unwrap());
        let mode = case["merge"].as_u64().unwrap() as usize;
        cases[mode] += 1;
        let (got, want) = (collide(&a, &b, case), contacts(case));
        let same = as_sets(&got, &want, 1e-4);
        agree[mode] += usize::from(same);
        let room = case["flags"].as_u64().unwrap() as usize;
        if mode <= 1 && !same {
            // No room for all: libode keeps the first of its tree, here the deepest and most different stay. Libode's are
            // among all of ours.
            let mut all = Vec::new();
            collide_frames((&a.0, &a.1), (&b.0, &b.1), CollideOptions::default(), &mut all);
            assert!(want.len() == room && all.len() > room, "{case}\n{got:?}");
            assert!(want.iter().all(|w| all.iter().any(|g| near(g, w, 1e-4))), "{case}\n{all:?}");
        }
    }
    println!("by mode (default, none, normals, full): {agree:?} of {cases:?}");
    assert!(cases[1] > 0 && agree[0] * 2 >= cases[0] && agree[1] * 2 >= cases[1], "{agree:?} of {cases:?}");
}

#[test]
fn shapes_within_transforms_touch_where_they_are() {
    let record = Record::open(FILES);
    let (mut cases, mut agree) = (0, 0);
    for case in record.list("geom_transform") {
        let (inner, b) = (record.geom(&case["inner"]).unwrap(), record.geom(&case["b"]).unwrap());
        let r: Vec<f64> = case["transform_R"].as_array().unwrap().iter().map(number).collect();
        let outer = Mat3::from_rows([[r[0], r[1], r[2]], [r[3], r[4], r[5]], [r[6], r[7], r[8]]]);
        let outer = Frame::new(vector(&case["transform_pos"]), outer);
        let at = Frame::new(outer.point_to_world(inner.1.position), outer.rotation * inner.1.rotation);
        cases += 1;
        agree += usize::from(as_sets(&collide(&(inner.0, at), &b, case), &contacts(case), 1e-9));
    }
    println!("{agree} of {cases}");
    assert!(cases > 0 && agree == cases, "{agree} of {cases}");
}
