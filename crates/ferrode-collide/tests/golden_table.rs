//! How many of the recorded cases of libode 0.16.2 agree, pair by pair: the table of `docs/collision.md`.
//!
//! `FERRODE_SPEC` names the folder of the full record, `FERRODE_SHOW` a pair (`capsule-trimesh`) whose other cases are to be
//! printed.

mod common;

use common::{Record, contacts, number, vector};
use ferrode_collide::narrow::collide_frames;
use ferrode_collide::{CollideOptions, Frame, GeomContact, Shape};
use serde_json::Value;
use std::collections::BTreeMap;

const FILES: &[&str] = &["collision.json", "convex.json", "mesh.json", "field.json"];

/// What became of the cases of a pair.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    cases: usize,
    /// As libode within the tolerance, or, where libode is only near, as the independent truth.
    agree: usize,
    /// Not as libode, whose answer is wrong: see [`is_worse`].
    better: usize,
    /// The same depth and normal at the deepest contact, but other contacts.
    deepest: usize,
    /// Everything else.
    other: usize,
}

fn near(a: &GeomContact, b: &GeomContact, tolerance: f64) -> bool {
    (a.point.position - b.point.position).abs_max() < tolerance
        && (a.point.normal - b.point.normal).abs_max() < tolerance
        && (a.point.depth - b.point.depth).abs() < tolerance
}

fn in_order(a: &[GeomContact], b: &[GeomContact], tolerance: f64) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| near(a, b, tolerance))
}

fn as_sets(a: &[GeomContact], b: &[GeomContact], tolerance: f64) -> bool {
    let within =
        |a: &[GeomContact], b: &[GeomContact]| a.iter().all(|x| b.iter().any(|y| near(x, y, tolerance)));
    within(a, b) && within(b, a)
}

fn deepest(list: &[GeomContact]) -> f64 {
    list.iter().map(|c| c.point.depth).fold(f64::NEG_INFINITY, f64::max)
}

/// Whether contacts say what the independent truth says; `None` where there is no truth.
fn is_true(case: &Value, list: &[GeomContact]) -> Option<bool> {
    let truth = &case["truth"];
    if truth.is_null() {
        return None;
    }
    if let Some(hit) = truth["hit"].as_bool() {
        let ray_first = case["a"]["class"] == "ray";
        return Some(match list.first() {
            Some(c) if hit => {
                let normal = if ray_first { c.point.normal } else { -c.point.normal };
                (c.point.depth - number(&truth["depth"])).abs() < 1e-4
                    && (c.point.position - vector(&truth["pos"])).abs_max() < 1e-4
                    && (normal - vector(&truth["normal"])).abs_max() < 1e-4
            }
            first => !hit && first.is_none(),
        });
    }
    let mtd = number(&truth["mtd"]);
    // A touch within the truth's own precision may be reported or not.
    Some(if list.is_empty() { mtd < 1e-4 } else { (deepest(list) - mtd).abs() < 1e-4 })
}

/// Whether libode's contacts are worse than ours, for a reason that no engine's judgement enters.
fn is_worse(case: &Value, got: &[GeomContact], want: &[GeomContact], b: [&Shape; 2], f: [&Frame; 2]) -> bool {
    // By the truth that the record holds; or they are no numbers.
    if is_true(case, got) == Some(true) && is_true(case, want) == Some(false) {
        return true;
    }
    if want.iter().any(|c| !c.point.normal.is_finite()) {
        return !got.is_empty() && got.iter().all(|c| c.point.normal.is_finite());
    }
    // Nothing is reported of solid bodies with one centre.
    if want.is_empty() && case["kind"] == "concentric" && !got.is_empty() {
        return !case["a"]["class"]
            .as_str()
            .into_iter()
            .chain(case["b"]["class"].as_str())
            .any(|c| ["plane", "ray", "trimesh", "heightfield"].contains(&c));
    }
    // Nothing is reported of a polyhedron all of whose corners are below the plane.
    for (i, j) in [(0, 1), (1, 0)] {
        if let (Shape::Convex(hull), Shape::Plane(plane)) = (b[i], b[j])
            && want.is_empty()
            && hull.points().iter().all(|&p| plane.depth(f[i].point_to_world(p)) > 0.0)
        {
            return !got.is_empty();
        }
    }
    // There was no room for more, and a shallower one took the place of the deepest.
    let room = case["flags"].as_u64().unwrap() as usize & 0xffff;
    case["kind"] != "unimportant"
        && !b.iter().any(|s| matches!(s, Shape::Ray(_)))
        && want.len() == room
        && got.len() == room
        && deepest(got) > deepest(want) + 1e-4
}

fn count(record: &Record, pick: Option<&str>) -> BTreeMap<[String; 2], BTreeMap<String, Counts>> {
    let mut table: BTreeMap<[String; 2], BTreeMap<String, Counts>> = BTreeMap::new();
    for case in record.list("cases") {
        let mut pair = ["a", "b"].map(|k| case[k]["class"].as_str().unwrap().to_string());
        pair.sort();
        let quality = case["quality"].as_str().unwrap();
        let (Some(a), Some(b)) = (record.geom(&case["a"]), record.geom(&case["b"])) else { panic!("{case}") };
        let options = CollideOptions::from_ode_flags(case["flags"].as_u64().unwrap() as u32);
        let want = contacts(case);
        let mut got = Vec::new();
        collide_frames((&a.0, &a.1), (&b.0, &b.1), options, &mut got);
        let ours = is_true(case, &got);
        let agree = match quality {
            "closed_form" => in_order(&got, &want, 1e-9),
            "heuristic" => as_sets(&got, &want, 1e-9),
            "single_precision_mesh" => as_sets(&got, &want, 1e-4),
            _ => ours.unwrap_or_else(|| got.is_empty() == (case["n"] == 0)),
        };
        let same_deepest = || {
            let first = |list: &[GeomContact]| {
                list.iter().copied().reduce(|a, b| if b.point.depth > a.point.depth { b } else { a })
            };
            match (first(&got), first(&want)) {
                (Some(g), Some(w)) => (g.point.depth - w.point.depth).abs() < 1e-4,
                (g, w) => g.is_none() && w.is_none(),
            }
        };
        let c = table.entry(pair.clone()).or_default().entry(quality.to_string()).or_default();
        c.cases += 1;
        if agree {
            c.agree += 1;
        } else if is_worse(case, &got, &want, [&a.0, &b.0], [&a.1, &b.1]) {
            c.better += 1;
        } else if same_deepest() {
            c.deepest += 1;
        } else {
            c.other += 1;
            if pick == Some(&pair.join("-")) {
                println!("{case}\n  ours {got:?}\n");
            }
        }
    }
    table
}

#[test]
fn table() {
    let record = Record::open(FILES);
    let pick = std::env::var("FERRODE_SHOW").ok();
    let table = count(&record, pick.as_deref());
    println!("| pair | kind of case | cases | agree | better | same deepest | other |");
    println!("|---|---|---|---|---|---|---|");
    let mut sums: BTreeMap<String, Counts> = BTreeMap::new();
    for (pair, qualities) in &table {
        for (quality, c) in qualities {
            println!(
                "| {} | {quality} | {} | {} | {} | {} | {} |",
                pair.join("–"),
                c.cases,
                c.agree,
                c.better,
                c.deepest,
                c.other
            );
            let s = sums.entry(quality.clone()).or_default();
            s.cases += c.cases;
            s.agree += c.agree;
            s.better += c.better;
            s.deepest += c.deepest;
            s.other += c.other;
        }
    }
    for (quality, s) in &sums {
        println!(
            "| all | {quality} | {} | {} | {} | {} | {} |",
            s.cases, s.agree, s.better, s.deepest, s.other
        );
        let right = match quality.as_str() {
            "closed_form" => s.other == 0 && s.agree + s.better >= s.cases * 99 / 100,
            "mpr" => s.agree == s.cases,
            "defective" => s.agree >= s.cases * 95 / 100,
            "heuristic" => s.agree + s.better >= s.cases * 90 / 100,
            // What is held so far, not what is wanted.
            _ => s.agree + s.better >= s.cases / 2,
        };
        assert!(right, "{quality}: {s:?}");
    }
}
