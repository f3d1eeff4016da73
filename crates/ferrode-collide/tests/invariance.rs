//! Moving both shapes together changes nothing: contacts of all ordered pairs of all classes, touching, nearly, and deep,
//! before and after a motion by any rotation and tens of metres.

mod common;

use common::classes::{classes, moved};
use ferrode_collide::narrow::{collide, distance, steady};
use ferrode_collide::*;
use ferrode_math::random::OdeRandom;
use ferrode_math::{Pose, Quat, Vec3};
use std::collections::BTreeMap;

/// Metres, and of normals the same as a number.
const SAME: f64 = 1e-9;
/// Largest coordinate of the motion, in metres. Coordinates of that size are rounded to 7e-15 m, what a pair's relative pose
/// is then known to; that is left out of [`SAME`], which has five digits more.
const FAR: f64 = 50.0;

/// Random numbers and poses, the same at every run.
struct Random(OdeRandom);

impl Random {
    fn number(&mut self, size: f64) -> f64 {
        (f64::from(self.0.next_u32()) / 2147483648.0 - 1.0) * size
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.number(size), self.number(size), self.number(size))
    }

    fn pose(&mut self, size: f64) -> Pose {
        let q = Quat::from_array([self.number(1.0), self.number(1.0), self.number(1.0), self.number(1.0)]);
        Pose::new(self.vector(size), q.normalized().unwrap_or(Quat::IDENTITY))
    }
}

type Source = fn((&Shape, &Pose), (&Shape, &Pose), CollideOptions, &mut Vec<GeomContact>) -> usize;

fn list(source: Source, a: (&Shape, &Pose), b: (&Shape, &Pose)) -> Vec<GeomContact> {
    let mut out = Vec::new();
    source(a, b, CollideOptions::new(64), &mut out);
    out
}

fn same(x: &GeomContact, y: &GeomContact) -> bool {
    (x.point.position - y.point.position).abs_max() < SAME
        && (x.point.normal - y.point.normal).abs_max() < SAME
        && (x.point.depth - y.point.depth).abs() < SAME
}

/// Each contact is in the other list too, but for those that only just touch.
fn as_sets(a: &[GeomContact], b: &[GeomContact]) -> bool {
    let within = |a: &[GeomContact], b: &[GeomContact]| {
        a.iter().all(|x| x.point.depth < SAME || b.iter().any(|y| same(x, y)))
    };
    within(a, b) && within(b, a)
}

/// What differs of a pair at two poses before and after `m`; in how many comparisons.
fn differences(
    (name_a, a): &(&str, Shape),
    (name_b, b): &(&str, Shape),
    pa: &Pose,
    pb: &Pose,
    m: &Pose,
    faults: &mut Vec<String>,
) -> usize {
    let ((ma, qa), (mb, qb)) = (moved(a, pa, m), moved(b, pb, m));
    let back = m.inverse();
    let mut count = 0;
    for (what, source) in [("collide", collide as Source), ("steady", steady as Source)] {
        let before = list(source, (a, pa), (b, pb));
        let mut after = list(source, (&ma, &qa), (&mb, &qb));
        for c in &mut after {
            c.point.position = back.transform_point(c.point.position);
            c.point.normal = back.rotation.rotate(c.point.normal);
        }
        count += 1;
        if !as_sets(&before, &after) {
            let show = |list: &[GeomContact]| {
                list.iter()
                    .map(|c| {
                        format!(
                            "    {:?} {:?} {:e}",
                            c.point.position.to_array(),
                            c.point.normal.to_array(),
                            c.point.depth
                        )
                    })
                    .collect::<Vec<_>>()
                    .join("\n")
            };
            faults.push(format!("{what} {name_a} {name_b}\n{}\n  moved\n{}", show(&before), show(&after)));
        }
    }
    if let (Some(before), Some(after)) = (distance((a, pa), (b, pb)), distance((&ma, &qa), (&mb, &qb))) {
        count += 1;
        let normal = back.rotation.rotate(after.normal);
        // The normal of what lies on each other to rounding is none.
        let clear = before.distance.abs() > 1e-6;
        if (before.distance - after.distance).abs() > SAME
            || (clear && (normal - before.normal).abs_max() > SAME)
        {
            faults.push(format!("distance {name_a} {name_b}\n    {before:?}\n    {after:?} {normal:?}"));
        }
    }
    count
}

#[test]
fn moving_both_changes_nothing() {
    let cases = std::env::var("FERRODE_CASES").ok().and_then(|s| s.parse().ok()).unwrap_or(20);
    let (mut faults, mut count) = (Vec::new(), 0);
    let mut random = Random(OdeRandom::new(common::seed_number() as u32));
    for _ in 0..cases {
        let (pa, pb, m) = (random.pose(0.3), random.pose(0.3), random.pose(FAR));
        let (deep, near) = (random.number(0.05).abs(), random.number(0.05).abs());
        for a in &classes() {
            for b in &classes() {
                // As they fall, mostly deep; then drawn apart until they touch, and until they just don't.
                let mut at = pb;
                count += differences(a, b, &pa, &at, &m, &mut faults);
                if a.0 == "plane" || b.0 == "plane" || a.0 == "ray" || b.0 == "ray" {
                    continue;
                }
                for want in [-deep, near] {
                    for _ in 0..40 {
                        let Some(d) = distance((&a.1, &pa), (&b.1, &at)) else { break };
                        if (d.distance - want).abs() < 1e-6 {
                            break;
                        }
                        at.position -= d.normal * (want - d.distance);
                    }
                    count += differences(a, b, &pa, &at, &m, &mut faults);
                }
            }
        }
    }
    let mut pairs: BTreeMap<String, usize> = BTreeMap::new();
    for f in &faults {
        *pairs.entry(f.lines().next().unwrap_or_default().to_string()).or_default() += 1;
    }
    let text = faults.iter().take(40).cloned().collect::<Vec<_>>().join("\n");
    assert!(faults.is_empty(), "{} of {count}:\n{pairs:#?}\n{text}", faults.len());
}
