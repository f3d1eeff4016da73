//! Smaller lists of the record of libode 0.16.2: options of rays on meshes, merging of a ball's contacts with a mesh, and
//! shapes within transforms.

mod common;

use common::{Record, contacts, number, vector};
use ferrode_collide::narrow::{ContactMerge, collide_frames};
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
            continue;
        }
        // The first contact that libode comes upon need not be the nearest; ours is, of all that a ray hits without that
        // option, and libode's is one of them.
        let mut all = ray;
        (all.first_contact, all.closest_hit) = (false, false);
        let hits = collide(&(all.into(), a.1), &b, case);
        let depth = |c: &GeomContact| c.point.depth;
        let nearest = hits.iter().map(depth).fold(f64::INFINITY, f64::min);
        assert!(ray.first_contact && got.len() == 1 && want.len() == 1, "{case}\n{got:?}");
        assert!(
            (depth(&got[0]) - nearest).abs() < 1e-9 && nearest < depth(&want[0]) - 1e-4,
            "{case}\n{got:?}"
        );
        assert!(hits.iter().any(|h| near(h, &want[0], 1e-4)), "{case}\n{hits:?}");
    }
    println!("{agree} of {cases}, the others nearer");
    assert!(cases > 0 && agree * 10 >= cases * 7, "{agree} of {cases}");
}

/// Balls on meshes in each of the modes of merging.
#[test]
fn balls_on_meshes_are_merged_as_asked() {
    let record = Record::open(FILES);
    let (mut cases, mut agree) = ([0; 4], [0; 4]);
    for case in record.list("sphere_trimesh_merge") {
        let (a, b) = (record.geom(&case["a"]).unwrap(), record.geom(&case["b"]).unwrap());
        let mode = case["merge"].as_u64().unwrap() as usize;
        let merge = [ContactMerge::None, ContactMerge::None, ContactMerge::Normals, ContactMerge::Full][mode];
        let Shape::TriMesh(mesh) = a.0 else { panic!("{case}") };
        let merged = |merge| (Shape::from(mesh.clone().with_sphere_merge(merge)), a.1);
        cases[mode] += 1;
        let (got, want) = (collide(&merged(merge), &b, case), contacts(case));
        if as_sets(&got, &want, 1e-4) {
            agree[mode] += 1;
            continue;
        }
        // No room for all: libode merges the first of its tree, here the deepest and most different stay. Without merging
        // libode's are among all of ours.
        let room = case["flags"].as_u64().unwrap() as usize;
        let mut all = Vec::new();
        let unmerged = merged(ContactMerge::None);
        collide_frames((&unmerged.0, &unmerged.1), (&b.0, &b.1), CollideOptions::default(), &mut all);
        assert!(all.len() > room, "{case}\n{got:?}\n{want:?}");
        if mode <= 1 {
            assert!(want.len() == room, "{case}\n{got:?}");
            assert!(want.iter().all(|w| all.iter().any(|g| near(g, w, 1e-4))), "{case}\n{all:?}");
        }
    }
    println!("by mode (default, none, normals, full): {agree:?} of {cases:?}");
    assert!(cases.iter().zip(&agree).all(|(c, a)| *c > 0 && a * 2 >= *c), "{agree:?} of {cases:?}");
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
