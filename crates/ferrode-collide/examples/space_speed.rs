//! Time to find the pairs of many geoms that all move a little each step, by kind of space.
//!
//! Run with `cargo run --release -p ferrode-collide --example space_speed`.

use ferrode_collide::{CollideOptions, Colliders, Cuboid, Geom, Item, SpaceKind};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Pose, Quat, Vec3};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "{:>6} {:>8} {:>10} {:>10} {:>8} {:>9}",
        "geoms", "space", "pairs ms", "contacts ms", "pairs", "contacts"
    );
    for count in [1000usize, 3000, 10000] {
        for (name, kind) in
            [("simple", SpaceKind::Simple), ("hash", SpaceKind::HASH), ("bvh", SpaceKind::Bvh)]
        {
            if name == "simple" && count > 3000 {
                continue;
            }
            let mut random = OdeRandom::new(1);
            let mut number = || f64::from(random.next_u32()) / 4294967296.0;
            let mut colliders = Colliders::new();
            let space = colliders.add_space(None, kind)?;
            // One box to 1.5 cubic metres, half a metre to a metre wide.
            let side = ferrode_math::real::cbrt(count as f64 * 1.5);
            let mut keys = Vec::new();
            for _ in 0..count {
                let size = Vec3::new(0.5 + 0.5 * number(), 0.5 + 0.5 * number(), 0.5 + 0.5 * number());
                let at = Vec3::new(number(), number(), number()) * side;
                let turn = Quat::from_axis_angle(Vec3::new(number(), number(), 1.0), number() * 3.0);
                let geom = Geom::new(Cuboid::new(size)?).at(Pose::new(at, turn));
                keys.push(colliders.add_geom(Some(space), geom)?);
            }
            let steps = 20;
            let (mut broad, mut narrow) = (0.0, 0.0);
            let (mut pairs, mut contacts) = (Vec::new(), Vec::new());
            for step in 0..=steps {
                for &key in &keys {
                    let pose = *colliders.geom(key).ok_or("lost")?.pose();
                    let nudge = Vec3::new(number() - 0.5, number() - 0.5, number() - 0.5) * 0.02;
                    colliders.set_pose(key, Pose::new(pose.position + nudge, pose.rotation))?;
                }
                pairs.clear();
                contacts.clear();
                let start = Instant::now();
                colliders.collide(space, |_, a, b| pairs.push((a, b)))?;
                let found = Instant::now();
                for &(a, b) in &pairs {
                    if let (Item::Geom(a), Item::Geom(b)) = (a, b) {
                        colliders.geom_contacts(a, b, CollideOptions::new(8), &mut contacts);
                    }
                }
                // The first step warms up.
                if step > 0 {
                    broad += (found - start).as_secs_f64();
                    narrow += found.elapsed().as_secs_f64();
                }
            }
            let ms = |s: f64| s * 1e3 / f64::from(steps);
            println!(
                "{count:>6} {name:>8} {:>10.3} {:>10.3} {:>8} {:>9}",
                ms(broad),
                ms(narrow),
                pairs.len(),
                contacts.len()
            );
        }
    }
    Ok(())
}
