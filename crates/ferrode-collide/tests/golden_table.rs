//! How many of the recorded cases of libode 0.16.2 agree, pair by pair: the table of `docs/collision.md`.
//!
//! `FERRODE_SPEC` names the folder of the full record, `FERRODE_SHOW` a pair (`capsule-trimesh`) whose other cases are to be
//! printed.

mod common;

use common::judge::{Judge, Surface};
use common::{Record, contacts, number, vector};
use ferrode_collide::narrow::{collide_frames, distance_frames};
use ferrode_collide::{CollideOptions, Convex, Frame, GeomContact, Shape};
use ferrode_math::Aabb;
use serde_json::Value;
use std::collections::BTreeMap;

const FILES: &[&str] = &["collision.json", "convex.json", "mesh.json", "field.json"];

/// What became of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    /// As libode within the tolerance, or, where libode is only near, as the independent truth.
    Agree,
    /// libode's list is full: its contacts are among ours without the limit, and ours keep the deepest.
    Cut,
    /// libode's contacts are among ours, or in the middle of them; the others of ours hold.
    More,
    /// Contacts of libode contradict the geometry; its others are among ours, and ours hold.
    Repaired,
    /// None of these.
    Other,
}

const OUTCOMES: [Outcome; 5] =
    [Outcome::Agree, Outcome::Cut, Outcome::More, Outcome::Repaired, Outcome::Other];

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

/// Whether a contact lies in the middle of several with the same normal, one of which at least is as deep.
fn is_spanned(w: &GeomContact, list: &[GeomContact]) -> bool {
    let same: Vec<_> = list.iter().filter(|c| c.point.normal.dot(w.point.normal) > 1.0 - 1e-6).collect();
    // The same contact, somewhere else between the two surfaces.
    let is_it = |c: &&GeomContact| {
        (c.point.depth - w.point.depth).abs() < 1e-4
            && (c.point.position - w.point.position).length() < 1.1 * w.point.depth + 1e-4
    };
    if same.iter().copied().any(|c| is_it(&c)) {
        return true;
    }
    let (x, y) = ferrode_math::plane_space(w.point.normal);
    same.len() > 1
        && same.iter().any(|c| c.point.depth > w.point.depth - 1e-4)
        && (0..32).all(|k| {
            let angle = f64::from(k) * std::f64::consts::PI / 16.0;
            let d = x * ferrode_math::real::cos(angle) + y * ferrode_math::real::sin(angle);
            same.iter().any(|c| d.dot(c.point.position - w.point.position) > -1e-3)
        })
}

/// The least way out of a convex body and a mesh that is convex and closed, by its hull; `None` of others.
fn least_way(a: &(Shape, Frame), b: &(Shape, Frame)) -> Option<f64> {
    let solid = |g: &(Shape, Frame)| match &g.0 {
        Shape::TriMesh(mesh) => {
            // All of it is behind each of its triangles.
            let convex = (0..mesh.triangles().len() as u32).all(|i| {
                let (n, p) = (mesh.normal(i), mesh.corners(i)[0]);
                mesh.vertices().iter().all(|v| n.dot(*v - p) < 1e-6)
            });
            (convex && mesh.volume() > 0.0).then(|| Convex::from_points(mesh.vertices()).unwrap().into())
        }
        Shape::Plane(_) | Shape::Ray(_) | Shape::Heightfield(_) => None,
        other => Some(other.clone()),
    };
    let (sa, sb) = (solid(a)?, solid(b)?);
    Some(-distance_frames((&sa, &a.1), (&sb, &b.1))?.distance)
}

fn same_place(a: &GeomContact, b: &GeomContact) -> bool {
    (a.point.position - b.point.position).abs_max() < 1e-4 && (a.point.depth - b.point.depth).abs() < 1e-4
}

/// Whether a contact with a heightfield is at an edge between two of its triangles.
fn is_on_grid(c: &GeomContact, a: &(Shape, Frame), b: &(Shape, Frame)) -> bool {
    [a, b].iter().any(|g| match &g.0 {
        Shape::Heightfield(field) => {
            let p = g.1.point_to_local(c.point.position);
            let (sx, sz) = field.cell();
            let (u, v) = ((p.x + 0.5 * field.width()) / sx, (p.z + 0.5 * field.depth()) / sz);
            [u, v, u + v].iter().any(|x| (x - x.round()).abs() < 1e-9)
        }
        _ => false,
    })
}

fn sides(case: &Value, k: usize) -> [i64; 2] {
    let side = &case["contacts"][k]["side"];
    [0, 1].map(|i| side[i].as_i64().unwrap_or(-1))
}

/// Hits of a ray that are not libode's: all hits along the ray, one after the other, decide.
fn rays(
    got: &[GeomContact],
    want: &[GeomContact],
    a: &(Shape, Frame),
    b: &(Shape, Frame),
) -> (Outcome, String) {
    let ((Shape::Ray(ray), fr), (surface, fs)) = (if matches!(a.0, Shape::Ray(_)) { (a, b) } else { (b, a) })
    else {
        return (Outcome::Other, "no ray".into());
    };
    if matches!(surface, Shape::Convex(_)) {
        // Along an edge, where a hair's breadth further out it misses.
        let misses = [fr.axis(0), -fr.axis(0), fr.axis(1), -fr.axis(1)].iter().any(|out| {
            let mut none = Vec::new();
            let apart = Frame::new(fr.position + *out * 1e-9, fr.rotation);
            collide_frames((&Shape::Ray(*ray), &apart), (surface, fs), CollideOptions::new(1), &mut none) == 0
        });
        return match misses && got.len() == 1 {
            true => (Outcome::More, String::new()),
            false => (Outcome::Other, format!("ours: {got:?}")),
        };
    }
    let (from, along) = (fr.position, fr.axis(2));
    let reach =
        Aabb::new(from, from).union(&Aabb::new(from + along * ray.length(), from + along * ray.length()));
    let hits =
        Surface::of(surface, fs, &reach).map(|s| s.hits(from, along, ray.length())).unwrap_or_default();
    let is_hit = |c: &GeomContact| hits.iter().any(|h| (h - c.point.depth).abs() < 1e-4);
    let nearest = hits.first().copied().unwrap_or(f64::INFINITY);
    let ours = got.iter().all(is_hit)
        && got.iter().all(|c| got.len() > 1 || (c.point.depth - nearest).abs() < 1e-4)
        && got.is_empty() == hits.is_empty();
    match (ours, want.iter().find(|c| !is_hit(c))) {
        (false, _) => (Outcome::Other, format!("ours: {got:?} {hits:?}")),
        (true, Some(_)) => (Outcome::Repaired, "no hit there".into()),
        (true, None) if want.len() < got.len() => (Outcome::More, String::new()),
        (true, None) if want.first().is_some_and(|c| c.point.depth > nearest + 1e-4) => {
            (Outcome::Repaired, "a nearer hit".into())
        }
        // On an edge either triangle may count, or both.
        (true, None) => (Outcome::More, String::new()),
    }
}

/// What became of a case, and why.
fn judge(case: &Value, a: &(Shape, Frame), b: &(Shape, Frame)) -> (Outcome, String) {
    let options = CollideOptions::from_ode_flags(case["flags"].as_u64().unwrap() as u32);
    let quality = case["quality"].as_str().unwrap();
    let want = contacts(case);
    let (mut got, mut full) = (Vec::new(), Vec::new());
    collide_frames((&a.0, &a.1), (&b.0, &b.1), options, &mut got);
    let ours = is_true(case, &got);
    let tolerance = if quality == "single_precision_mesh" { 1e-4 } else { 1e-9 };
    let agree = match quality {
        "closed_form" => in_order(&got, &want, tolerance),
        "heuristic" | "single_precision_mesh" => as_sets(&got, &want, tolerance),
        _ => ours.unwrap_or_else(|| got.is_empty() == (case["n"] == 0)),
    };
    if agree {
        return (Outcome::Agree, String::new());
    }
    if is_worse(case, &got, &want, [&a.0, &b.0], [&a.1, &b.1]) {
        let full = case["truth"].is_null() && want.len() == usize::from(options.max_contacts);
        let why = if full { "its list is full without the deepest" } else { "by the record's truth" };
        return (Outcome::Repaired, why.into());
    }
    if let Some(least) = least_way(a, b)
        && least > 1e-3
        && (deepest(&got) - least).abs() < 1e-4
        && (deepest(&want) - least).abs() > 1e-3
    {
        return (Outcome::Repaired, "the depth is not the least way out of a convex mesh".into());
    }
    let all = CollideOptions { max_contacts: u16::MAX, ..options };
    collide_frames((&a.0, &a.1), (&b.0, &b.1), all, &mut full);
    // A ray that begins on the surface: whether it enters there is a matter of the last bit.
    if case["truth"]["hit"] == true && number(&case["truth"]["depth"]) < 1e-12 {
        return (Outcome::More, String::new());
    }
    if [a, b].iter().any(|g| matches!(g.0, Shape::Ray(_))) {
        return rays(&got, &want, a, b);
    }
    // Nothing of ours may stand where bodies overlap. Of meshes above fields libode invents contacts, see below.
    let on_field = [a, b].iter().any(|g| matches!(g.0, Shape::Heightfield(_)));
    if got.is_empty() && deepest(&want) > 1e-3 && !on_field {
        return (Outcome::Other, "ours: nothing".into());
    }
    let bench = Judge::new(a, b);
    let has = |list: &[GeomContact], w: &GeomContact| list.iter().any(|g| near(g, w, tolerance));
    let missing: Vec<usize> = (0..want.len()).filter(|&k| !has(&full, &want[k])).collect();
    let cut = want.len() == usize::from(options.max_contacts);
    if missing.is_empty() && cut && deepest(&got) > deepest(&want) - tolerance {
        return (Outcome::Cut, String::new());
    }
    let ours: Vec<_> = got.iter().map(|g| (*g, [i64::from(g.side1), i64::from(g.side2)])).collect();
    let theirs: Vec<_> = want.iter().enumerate().map(|(k, w)| (*w, sides(case, k))).collect();
    // Of ours, those that libode has not.
    let own_fault =
        (0..got.len()).filter(|&k| !has(&want, &got[k])).find_map(|k| bench.fault(&ours, k, true));
    let mut reasons = Vec::new();
    for &k in &missing {
        match bench.fault(&theirs, k, false) {
            Some(reason) => reasons.push(reason),
            None if is_spanned(&want[k], &full) => {}
            // At the same place and as deep: of several triangles that meet there, in another order, another mean normal.
            None if full.iter().any(|g| same_place(g, &want[k])) => {}
            // Surfaces that just touch push nothing.
            None if want[k].point.depth < 1e-4 => {}
            // Rounding decides which triangle a point on an edge between two belongs to, and with it which corners count.
            None if got.iter().any(|g| !has(&want, g) && is_on_grid(g, a, b)) => {}
            None => {
                return (Outcome::Other, format!("contact {k} of libode's; ours: {own_fault:?} {missing:?}"));
            }
        }
    }
    if let Some(fault) = own_fault {
        return (Outcome::Other, format!("ours: {fault}"));
    }
    reasons.sort_unstable();
    reasons.dedup();
    if reasons.is_empty() { (Outcome::More, String::new()) } else { (Outcome::Repaired, reasons.join("; ")) }
}

type Table = BTreeMap<([String; 2], String), [usize; OUTCOMES.len()]>;

#[test]
fn table() {
    let record = Record::open(FILES);
    let pick = std::env::var("FERRODE_SHOW").ok();
    let mut table = Table::new();
    let mut why: BTreeMap<String, usize> = BTreeMap::new();
    for case in record.list("cases") {
        let mut pair = ["a", "b"].map(|k| case[k]["class"].as_str().unwrap().to_string());
        pair.sort();
        let (Some(a), Some(b)) = (record.geom(&case["a"]), record.geom(&case["b"])) else { panic!("{case}") };
        let (outcome, reason) = judge(case, &a, &b);
        let quality = case["quality"].as_str().unwrap().to_string();
        if outcome == Outcome::Repaired {
            *why.entry(format!("{quality}: {reason}")).or_default() += 1;
        }
        if outcome == Outcome::Other && pick.as_deref().is_some_and(|p| p == "all" || p == pair.join("-")) {
            println!("{} {} {}: {reason}", pair.join("–"), case["id"], case["kind"]);
        }
        table.entry((pair, quality)).or_default()[outcome as usize] += 1;
    }
    println!("| pair | kind of case | cases | agree | cut | more | repaired | other |");
    println!("|---|---|---|---|---|---|---|---|");
    let mut sums: BTreeMap<String, [usize; OUTCOMES.len()]> = BTreeMap::new();
    let row = |name: &str, quality: &str, n: &[usize; OUTCOMES.len()]| {
        let counts: Vec<_> = n.iter().map(|n| n.to_string()).collect();
        println!("| {name} | {quality} | {} | {} |", n.iter().sum::<usize>(), counts.join(" | "));
    };
    for ((pair, quality), n) in &table {
        row(&pair.join("–"), quality, n);
        let sum = sums.entry(quality.clone()).or_default();
        for (s, n) in sum.iter_mut().zip(n) {
            *s += n;
        }
    }
    for (quality, n) in &sums {
        row("all", quality, n);
    }
    for (reason, n) in &why {
        println!("{n} repaired, {reason}");
    }
    let count = |quality: &str, outcome: Outcome| sums.get(quality).map_or(0, |n| n[outcome as usize]);
    for (quality, n) in &sums {
        assert_eq!(n[Outcome::Other as usize], 0, "{quality}: {n:?}");
    }
    assert_eq!(count("mpr", Outcome::Repaired) + count("defective", Outcome::Repaired), 0);
    // Where libode has formulas it is repaired where it fails, and nowhere else.
    let closed: usize = sums["closed_form"].iter().sum();
    assert!(count("closed_form", Outcome::Agree) * 100 >= closed * 97, "{sums:?}");
}
