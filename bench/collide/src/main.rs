//! Times broad phases and ray casts: Ferrode, installed libode, Rapier. All engines take turns step by step on the same
//! scene, so that what else the machine does falls on all alike; figures are medians.
//!
//! `cargo run --release -p ferrode-bench-collide [broad|rays]`

mod ode;
mod rapier;
mod scene;

use ferrode_collide::{CollideOptions, Colliders, Cuboid, Geom, GeomKey, Item, SpaceKey, SpaceKind, Sphere};
use ferrode_math::{Pose, Vec3};
use scene::{Body, Solid};
use std::error::Error;
use std::time::Instant;

struct Ours {
    colliders: Colliders,
    space: SpaceKey,
    keys: Vec<GeomKey>,
    pairs: Vec<(GeomKey, GeomKey)>,
    contacts: Vec<ferrode_collide::GeomContact>,
}

impl Ours {
    fn new(kind: SpaceKind, bodies: &[Body]) -> Result<Self, Box<dyn Error>> {
        let mut colliders = Colliders::new();
        let space = colliders.add_space(None, kind)?;
        let mut keys = Vec::new();
        for b in bodies {
            let geom = match b.solid {
                Solid::Ball(r) => Geom::new(Sphere::new(r)?),
                Solid::Cuboid(s) => Geom::new(Cuboid::new(s)?),
            };
            keys.push(colliders.add_geom(Some(space), geom.at(Pose::new(b.position, b.rotation)))?);
        }
        Ok(Self { colliders, space, keys, pairs: Vec::new(), contacts: Vec::new() })
    }

    fn put(&mut self, i: usize, b: &Body) {
        let _ = self.colliders.set_pose(self.keys[i], Pose::new(b.position, b.rotation));
    }

    fn collide(&mut self, narrow: bool) -> (usize, usize) {
        let (pairs, contacts) = (&mut self.pairs, &mut self.contacts);
        pairs.clear();
        contacts.clear();
        let _ = self.colliders.collide(self.space, |_, a, b| {
            if let (Item::Geom(a), Item::Geom(b)) = (a, b) {
                pairs.push((a, b));
            }
        });
        if narrow {
            for &(a, b) in pairs.iter() {
                self.colliders.geom_contacts(a, b, CollideOptions::new(8), contacts);
            }
        }
        (pairs.len(), contacts.len())
    }
}

fn median(list: &mut [f64]) -> f64 {
    list.sort_unstable_by(f64::total_cmp);
    list[list.len() / 2]
}

fn seconds(f: impl FnOnce()) -> f64 {
    let start = Instant::now();
    f();
    start.elapsed().as_secs_f64()
}

const DT: f64 = 1.0 / 60.0;

fn broad(count: usize, speed: f64, steps: usize) -> Result<(), Box<dyn Error>> {
    let (mut bodies, side) = scene::crowd(count, 4.0, speed);
    let ours = [("ferrode bvh", SpaceKind::Bvh), ("ferrode hash", SpaceKind::HASH)];
    let theirs = [("libode sap", ode::Kind::Sap), ("libode hash", ode::Kind::Hash), ("libode quadtree", ode::Kind::Quadtree)];
    let mut a: Vec<_> = ours.iter().map(|o| Ours::new(o.1, &bodies)).collect::<Result<_, _>>()?;
    let mut b: Vec<_> = theirs.iter().map(|t| ode::Space::new(t.1, &bodies, side)).collect();
    let mut r64 = rapier::double::Scene::new(&bodies);
    let mut r32 = rapier::single::Scene::new(&bodies);
    let n = a.len() + b.len() + 2;
    // Moving, broad phase, broad and narrow phase.
    let mut times = vec![[const { Vec::<f64>::new() }; 3]; n];
    let mut counts = vec![(0, 0); n];
    for step in 0..steps + 10 {
        scene::advance(&mut bodies, side, DT, |_, _| {});
        let list: Vec<usize> = (0..count).filter(|&i| bodies[i].velocity != Vec3::ZERO).collect();
        let narrow = step % 2 == 1;
        let mut note = |k: usize, moving: f64, rest: f64| {
            if step >= 10 {
                times[k][0].push(moving);
                times[k][1 + usize::from(narrow)].push(rest);
            }
        };
        for (k, s) in a.iter_mut().enumerate() {
            let moving = seconds(|| list.iter().for_each(|&i| s.put(i, &bodies[i])));
            let mut c = (0, 0);
            let rest = seconds(|| c = s.collide(narrow));
            counts[k] = if narrow { c } else { counts[k] };
            note(k, moving, rest);
        }
        for (k, s) in b.iter_mut().enumerate() {
            let moving = seconds(|| list.iter().for_each(|&i| s.put(i, bodies[i].position)));
            let mut c = (0, 0);
            let rest = seconds(|| c = s.collide(narrow));
            counts[a.len() + k] = if narrow { c } else { counts[a.len() + k] };
            note(a.len() + k, moving, rest);
        }
        let moving = seconds(|| list.iter().for_each(|&i| r64.put(i, bodies[i].position)));
        let rest = seconds(|| r64.collide());
        note(n - 2, moving, rest);
        let moving = seconds(|| list.iter().for_each(|&i| r32.put(i, bodies[i].position)));
        let rest = seconds(|| r32.collide());
        note(n - 1, moving, rest);
    }
    counts[n - 2] = r64.contacts();
    counts[n - 1] = r32.contacts();
    println!("{count} geoms, every second moves at up to {speed} m/s, dt 1/60 s; milliseconds");
    println!("{:<18}{:>8}{:>8}{:>8}{:>8}{:>8}{:>9}", "", "moving", "broad", "both", "whole", "pairs", "contacts");
    let names = ours.iter().map(|o| o.0).chain(theirs.iter().map(|t| t.0)).chain(["rapier f64", "rapier f32"]);
    for (k, name) in names.enumerate() {
        let [m, b, w] = &mut times[k];
        let ms = |t: &mut Vec<f64>| median(t) * 1e3;
        // Rapier always does both.
        let (moving, broad, both) = (ms(m), if k < n - 2 { ms(b) } else { f64::NAN }, ms(w));
        println!(
            "{name:<18}{moving:>8.3}{broad:>8.3}{both:>8.3}{:>8.3}{:>8}{:>9}",
            moving + both,
            counts[k].0,
            counts[k].1
        );
    }
    println!();
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    if !ode::start() {
        return Err("libode is not built for double precision".into());
    }
    let what = std::env::args().nth(1).unwrap_or_default();
    if what != "rays" {
        for speed in [0.5, 2.0, 10.0] {
            broad(10_000, speed, 120)?;
        }
    }
    Ok(())
}
