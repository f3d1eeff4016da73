//! Contacts against those recorded from libode 0.16.2.

mod common;

use common::{Record, contacts, number, vector};
use ferrode_collide::narrow::{self, closest_segment_points, cuboids_touch};
use ferrode_collide::{CollideOptions, Frame, GeomContact, Shape};
use serde_json::Value;

const FILES: &[&str] = &["collision.json", "convex.json"];
const TOLERANCE: f64 = 1e-9;

fn same(a: &GeomContact, b: &GeomContact) -> bool {
    (a.point.position - b.point.position).abs_max() < TOLERANCE
        && (a.point.normal - b.point.normal).abs_max() < TOLERANCE
        && (a.point.depth - b.point.depth).abs() < TOLERANCE
}

fn all_same(a: &[GeomContact], b: &[GeomContact]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b))
}

fn collide(a: &(Shape, Frame), b: &(Shape, Frame), flags: u32) -> Vec<GeomContact> {
    let mut out = Vec::new();
    let n =
        narrow::collide_frames((&a.0, &a.1), (&b.0, &b.1), CollideOptions::from_ode_flags(flags), &mut out);
    assert_eq!(n, out.len());
    out
}

fn class(case: &Value, side: &str) -> String {
    case[side]["class"].as_str().unwrap().to_string()
}

/// Pairs with a formula: every number, and the order of contacts.
#[test]
fn closed_form_pairs_are_libodes() {
    let record = Record::open(FILES);
    let (mut replayed, mut ties, mut repaired) = (0, 0, 0);
    for case in record.list("cases") {
        if case["quality"] != "closed_form" {
            continue;
        }
        let (Some(a), Some(b)) = (record.geom(&case["a"]), record.geom(&case["b"])) else { continue };
        let flags = case["flags"].as_u64().unwrap() as u32;
        let (want, got) = (contacts(case), collide(&a, &b, flags));
        replayed += 1;
        if all_same(&got, &want) {
            continue;
        }
        let pair = [class(case, "a"), class(case, "b")];
        let has = |name: &str| pair.iter().any(|c| c == name);
        if want.iter().any(|c| !c.point.normal.is_finite()) {
            // A ball centred on a cylinder's axis: libode's normal is NaN. Any radial direction is right.
            assert!(has("cylinder") && has("sphere"), "{case}");
            assert!(got.len() == 1 && (got[0].point.normal.length() - 1.0).abs() < 1e-12, "{case}");
            repaired += 1;
        } else if has("convex") && has("plane") && want.is_empty() {
            // A polyhedron wholly below the plane: libode lets it fall.
            assert!(!got.is_empty() && got.iter().all(|c| c.point.depth > 0.0), "{case}\n{got:?}");
            repaired += 1;
        } else if has("cylinder") && has("box") && want.is_empty() {
            // Overlap that libode's clipping loses: of bodies with one centre, for instance.
            let truth = match &case["truth"] {
                Value::Null if case["kind"] == "concentric" => 0.1,
                truth => number(&truth["mtd"]),
            };
            assert!(truth > 1e-4 && got.iter().any(|c| c.point.depth > truth - 1e-4), "{case}\n{got:?}");
            repaired += 1;
        } else if has("cylinder") && has("box") {
            // A cap flat on a face: rounding noise decides at which corner libode begins to clip, and so, if there
            // are more corners than wanted, which ones it reports. They are among ours, with the same depth. Corners
            // that lie in the cap's plane up to noise may be there or not.
            let all = collide(&a, &b, 0xffff);
            // The cylinder's half extent along the normal has R √(1 − c²), whose noise near c = 1 is 1e-8.
            let near = |g: &GeomContact, w: &GeomContact| {
                let mut g = *g;
                if (g.point.depth - w.point.depth).abs() < 2e-8 {
                    g.point.depth = w.point.depth;
                }
                same(&g, w)
            };
            let in_plane = |c: &GeomContact| c.point.depth < 2e-8;
            assert!(want.iter().all(|w| in_plane(w) || all.iter().any(|g| near(g, w))), "{case}\n{got:?}");
            let count = |list: &[GeomContact]| list.iter().filter(|c| !in_plane(c)).count();
            assert_eq!(count(&got), count(&want), "{case}\n{got:?}");
            ties += 1;
        } else {
            panic!("{case}\n{got:?}");
        }
    }
    println!("{replayed} cases, {ties} with another order of corners, {repaired} repaired");
    assert!(replayed > 150, "{replayed}");
    assert!(ties * 100 <= replayed, "{ties} of {replayed}");
}

/// The world boxes of all geoms.
#[test]
fn boxes_are_libodes() {
    let record = Record::open(FILES);
    for case in record.list("cases") {
        for (side, key) in [("a", "aabb_a"), ("b", "aabb_b")] {
            let (Some((shape, frame)), recorded) = (record.geom(&case[side]), &case[key]) else { continue };
            // Libode's box of a turned heightfield does not hold it, and that of a repeated one has no height.
            if let Shape::Heightfield(field) = &shape
                && (field.is_wrapped() || frame.rotation != ferrode_math::Mat3::IDENTITY)
            {
                continue;
            }
            let aabb = shape.aabb_in(&frame);
            for i in 0..3 {
                for (got, want) in
                    [(aabb.min[i], number(&recorded[2 * i])), (aabb.max[i], number(&recorded[2 * i + 1]))]
                {
                    assert!(got == want || (got - want).abs() < TOLERANCE, "{case}: {aabb:?}");
                }
            }
        }
    }
}

#[test]
fn box_box_functions_are_libodes() {
    let record = Record::open(FILES);
    for case in record.list("box_box") {
        let (a, b) = (record.geom(&case["a"]).unwrap(), record.geom(&case["b"]).unwrap());
        let (Shape::Cuboid(sa), Shape::Cuboid(sb)) = (&a.0, &b.0) else { panic!("{case}") };
        assert_eq!(cuboids_touch(sa, &a.1, sb, &b.1), case["touches"] == 1, "{case}");
        let mut list = Vec::new();
        let options = CollideOptions::from_ode_flags(case["flags"].as_u64().unwrap() as u32);
        let mut out = ferrode_collide::Contacts::new(&mut list, options);
        let hit = narrow::cuboid_cuboid(sa, &a.1, sb, &b.1, &mut out);
        assert_eq!(list.len() as u64, case["n"].as_u64().unwrap(), "{case}");
        if let Some(hit) = hit.filter(|_| !list.is_empty()) {
            assert_eq!(hit.code as u64, case["code"].as_u64().unwrap(), "{case}");
            assert!((hit.normal - vector(&case["normal"])).abs_max() < TOLERANCE, "{case}");
            assert!((hit.depth - number(&case["depth"])).abs() < TOLERANCE, "{case}");
        }
    }
}

#[test]
fn segment_points_are_libodes() {
    let record = Record::open(FILES);
    for case in record.list("closest_line_segment_points") {
        let p = |key: &str| vector(&case[key]);
        let (a, b) = closest_segment_points(p("a1"), p("a2"), p("b1"), p("b2"));
        if (a - p("cp1")).abs_max() < TOLERANCE && (b - p("cp2")).abs_max() < TOLERANCE {
            continue;
        }
        // For parallel segments libode may answer corners that are not nearest.
        let parallel = (p("a2") - p("a1")).cross(p("b2") - p("b1")).length() < TOLERANCE;
        assert!(parallel && (a - b).length() < (p("cp1") - p("cp2")).length(), "{case}: {a:?} {b:?}");
    }
}

/// Convex pairs that libode leaves to portal refinement: depth against the true least translation, found
/// independently by a search over directions (good to 1e-5).
#[test]
fn convex_pairs_have_the_true_depth() {
    let record = Record::open(FILES);
    let mut replayed = 0;
    for case in record.list("cases") {
        if case["quality"] != "mpr" {
            continue;
        }
        let (Some(a), Some(b)) = (record.geom(&case["a"]), record.geom(&case["b"])) else { continue };
        let got = collide(&a, &b, 0x7fff);
        if case["truth"].is_null() {
            assert_eq!(got.is_empty(), case["n"] == 0, "{case}\n{got:?}");
            continue;
        }
        let truth = number(&case["truth"]["mtd"]);
        let one = collide(&a, &b, 1);
        if truth < -1e-4 {
            assert!(got.is_empty(), "{case}\n{got:?}");
            continue;
        }
        if truth < 1e-4 {
            continue;
        }
        replayed += 1;
        let deepest = got.iter().map(|c| c.point.depth).fold(0.0, f64::max);
        // The search comes from above: it may stop short of the least by more than it may go below.
        let right = |depth: f64| depth < truth + 1e-5 && depth > truth - 1e-4;
        assert!(right(deepest), "{case}\n{got:?}");
        assert!(one.len() == 1 && right(one[0].point.depth), "{case}\n{one:?}");
        for c in &got {
            assert!((c.point.normal.length() - 1.0).abs() < 1e-12, "{case}\n{got:?}");
            assert_eq!(c.point.normal, got[0].point.normal, "{case}");
        }
    }
    println!("{replayed} cases");
    assert!(replayed >= 20, "{replayed}");
}

/// Rays against polyhedra, where libode is wrong: the exact hits.
#[test]
fn rays_hit_polyhedra_where_they_should() {
    let record = Record::open(FILES);
    let mut replayed = 0;
    for case in record.list("cases") {
        if case["quality"] != "defective" {
            continue;
        }
        let (Some(a), Some(b)) = (record.geom(&case["a"]), record.geom(&case["b"])) else { continue };
        let truth = &case["truth"];
        let got = collide(&a, &b, 4);
        // A ray that begins on the surface: whether it enters there is a matter of the last bit.
        if truth["hit"] == true && number(&truth["depth"]) < 1e-12 {
            continue;
        }
        replayed += 1;
        if truth["hit"] == false && !got.is_empty() {
            // Along an edge: a hair's breadth further out it misses.
            let mut apart = (a.clone(), b.clone());
            let out = (a.1.position - b.1.position).normalized().unwrap() * 1e-9;
            apart.0.1.position += out;
            assert!(collide(&apart.0, &apart.1, 4).is_empty(), "{case}\n{got:?}");
            continue;
        }
        assert_eq!(got.len() == 1, truth["hit"] == true, "{case}\n{got:?}");
        if let [hit] = got[..] {
            let ray_first = class(case, "a") == "ray";
            let normal = if ray_first { hit.point.normal } else { -hit.point.normal };
            assert!((hit.point.depth - number(&truth["depth"])).abs() < TOLERANCE, "{case}\n{got:?}");
            assert!((hit.point.position - vector(&truth["pos"])).abs_max() < TOLERANCE, "{case}\n{got:?}");
            assert!((normal - vector(&truth["normal"])).abs_max() < TOLERANCE, "{case}\n{got:?}");
        }
    }
    assert!(replayed >= 6, "{replayed}");
}

/// Depths of points, but for those outside a box, where libode 0.16.2 errs and later versions give the distance.
#[test]
fn point_depths_are_libodes() {
    let record = Record::open(FILES);
    let mut compared = 0;
    for case in record.list("point_depth") {
        let (shape, frame) = record.geom(&case["geom"]).unwrap();
        let (want, p) = (number(&case["depth"]), vector(&case["point"]));
        let got = ferrode_collide::point_depth(&shape, &frame, p).unwrap();
        if matches!(shape, Shape::Cuboid(_)) && want < 0.0 {
            assert!(got < 0.0, "{case}: {got}");
        } else {
            assert!((got - want).abs() < TOLERANCE, "{case}: {got}");
            compared += 1;
        }
    }
    assert!(compared > 20, "{compared}");
}
