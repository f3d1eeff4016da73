//! Times broad phases and ray casts: Ferrode, installed libode, Rapier. All engines take turns step by step on the same
//! scene; figures are medians of the thread's processor time, so that what else the machine does falls on all alike.
//!
//! `cargo run --release -p ferrode-bench-collide [broad|rays]`

#[path = "../../src/clock.rs"]
mod clock;
mod ode;
mod rapier;
mod scene;

use ferrode_collide::{CollideOptions, Colliders, Cuboid, Geom, GeomKey, Item, SpaceKey, SpaceKind, Sphere};
use ferrode_math::{Pose, Vec3};
use scene::{Body, Solid};
use std::error::Error;

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
    let start = clock::thread_seconds();
    f();
    clock::thread_seconds() - start
}

const DT: f64 = 1.0 / 60.0;

fn broad(count: usize, speed: f64, steps: usize) -> Result<String, Box<dyn Error>> {
    let (mut bodies, side) = scene::crowd(count, 4.0, speed);
    let ours = [("ferrode bvh", SpaceKind::Bvh), ("ferrode hash", SpaceKind::HASH)];
    let theirs = [
        ("libode sap", ode::Kind::Sap),
        ("libode hash", ode::Kind::Hash),
        ("libode quadtree", ode::Kind::Quadtree),
    ];
    let mut a: Vec<_> = ours.iter().map(|o| Ours::new(o.1, &bodies)).collect::<Result<_, _>>()?;
    let mut b: Vec<_> = theirs.iter().map(|t| ode::Space::new(t.1, &bodies, side)).collect();
    let mut r64 = rapier::double::Scene::new(&bodies);
    let mut r32 = rapier::single::Scene::new(&bodies);
    let n = a.len() + b.len() + 2;
    // Moving, broad phase, broad and narrow phase.
    let mut times = vec![[const { Vec::<f64>::new() }; 3]; n];
    let mut counts = vec![(0, 0); n];
    // Drawn, not in alternation: a structure that is renewed every few steps must not be renewed in the same kind each time.
    let mut coin = scene::Numbers::new(5);
    for step in 0..steps + 10 {
        scene::advance(&mut bodies, side, DT, |_, _| {});
        let list: Vec<usize> = (0..count).filter(|&i| bodies[i].velocity != Vec3::ZERO).collect();
        let narrow = coin.next() < 0.5;
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
    let mut text =
        format!("{count} geoms, every second moves at up to {speed} m/s, dt 1/60 s; milliseconds\n\n");
    text += "| engine | moving geoms | broad phase | mean | broad and narrow | mean | whole, of means | pairs | contacts |\n|---|---|---|---|---|---|---|---|---|\n";
    let names =
        ours.iter().map(|o| o.0).chain(theirs.iter().map(|t| t.0)).chain(["rapier f64", "rapier f32"]);
    for (k, name) in names.enumerate() {
        let [m, b, w] = &mut times[k];
        let ms = |t: &mut Vec<f64>| median(t) * 1e3;
        let mean = |t: &[f64]| t.iter().sum::<f64>() / t.len() as f64 * 1e3;
        // Rapier always does both.
        let broad = if k < n - 2 { format!("{:.3} | {:.3}", ms(b), mean(b)) } else { " | ".into() };
        let (pairs, contacts) = counts[k];
        text += &format!(
            "| {name} | {:.3} | {broad} | {:.3} | {:.3} | {:.3} | {pairs} | {contacts} |\n",
            ms(m),
            ms(w),
            mean(w),
            mean(m) + mean(w)
        );
    }
    Ok(text + "\n")
}

/// One engine's answer to a ray: the distance of the first hit.
type Cast<'a> = Box<dyn FnMut(Vec3, Vec3) -> Option<f64> + 'a>;

/// Asks all engines the same rays in short turns, in which they mostly fetch their trees from memory again, and in long ones;
/// a slow one is only asked the first few rays.
fn ask(title: &str, rays: &[(Vec3, Vec3)], engines: &mut [(&str, bool, Cast<'_>)]) -> String {
    [500, 20_000].map(|turn| ask_in_turns(turn, title, rays, engines)).concat()
}

fn ask_in_turns(
    length: usize,
    title: &str,
    rays: &[(Vec3, Vec3)],
    engines: &mut [(&str, bool, Cast<'_>)],
) -> String {
    let mut times = vec![Vec::new(); engines.len()];
    let mut sums = vec![(0usize, 0.0f64, 0usize); engines.len()];
    for (turn, part) in rays.chunks(length).enumerate() {
        for (k, (_, slow, cast)) in engines.iter_mut().enumerate() {
            if *slow && turn * length >= 2000 {
                continue;
            }
            let part = if *slow { &part[..part.len().min(500)] } else { part };
            let sum = &mut sums[k];
            let time = seconds(|| {
                for (from, direction) in part {
                    if let Some(d) = cast(*from, *direction) {
                        *sum = (sum.0 + 1, sum.1 + d, sum.2);
                    }
                }
            });
            times[k].push(time / part.len() as f64);
            sum.2 += part.len();
        }
    }
    let mut text = format!(
        "{title}, {length} at a time\n\n| engine | µs a ray | hit | mean distance, m |\n|---|---|---|---|\n"
    );
    for (k, (name, ..)) in engines.iter().enumerate() {
        let (hits, sum, asked) = sums[k];
        let us = median(&mut times[k]) * 1e6;
        text += &format!(
            "| {name} | {us:.3} | {:.2} % | {:.4} |\n",
            100.0 * hits as f64 / asked as f64,
            sum / hits.max(1) as f64
        );
    }
    text + "\n"
}

fn rays(count: usize) -> Result<String, Box<dyn Error>> {
    let bodies = scene::boxes(10_000);
    let mut ours = Ours::new(SpaceKind::Bvh, &bodies)?;
    let queries = ours.colliders.queries(ours.space)?;
    let mut hash = ode::Space::new(ode::Kind::Hash, &bodies, 100.0);
    let mut r64 = rapier::double::Scene::new(&bodies);
    let mut r32 = rapier::single::Scene::new(&bodies);
    r64.collide();
    r32.collide();
    let (p64, p32) = (rapier::double::Shapes::new(&bodies), rapier::single::Shapes::new(&bodies));
    let length = 100.0;
    let mut text = ask(
        &format!("{count} rays of 100 m among 10,000 boxes in a cube of 100 m"),
        &scene::rays(count),
        &mut [
            (
                "ferrode",
                false,
                Box::new(|o, d| queries.ray_cast(o, d, length, |_, _| true).map(|h| h.distance)),
            ),
            ("parry f64", false, Box::new(|o, d| p64.cast(o, d, length))),
            ("parry f32", false, Box::new(|o, d| p32.cast(o, d, length))),
            ("rapier f64", false, Box::new(|o, d| r64.cast(o, d, length))),
            ("rapier f32", false, Box::new(|o, d| r32.cast(o, d, length))),
            ("libode hash", true, Box::new(|o, d| hash.cast(o, d, length))),
        ],
    );
    let (vertices, triangles) = scene::hills(158);
    let mesh = ferrode_collide::TriMesh::new(vertices.clone(), triangles.clone())?;
    let tree = mesh.tree().size() as f64 / triangles.len() as f64;
    let count_of = triangles.len();
    let shape = ferrode_collide::Shape::from(mesh);
    let frame = ferrode_collide::Frame::IDENTITY;
    let (m64, m32) =
        (rapier::double::Mesh::new(&vertices, &triangles), rapier::single::Mesh::new(&vertices, &triangles));
    let mut theirs = ode::Space::mesh(vertices.leak(), triangles.leak());
    text += &ask(
        &format!(
            "{count} rays onto hills of {count_of} triangles; ferrode's tree takes {tree:.1} bytes a triangle"
        ),
        &scene::rays_down(count),
        &mut [
            (
                "ferrode",
                false,
                Box::new(|o, d| ferrode_collide::ray_cast(&shape, &frame, o, d, length).map(|h| h.distance)),
            ),
            ("parry f64", false, Box::new(|o, d| m64.cast(o, d, length))),
            ("parry f32", false, Box::new(|o, d| m32.cast(o, d, length))),
            ("libode", false, Box::new(|o, d| theirs.cast(o, d, length))),
        ],
    );
    Ok(text)
}

fn main() -> Result<(), Box<dyn Error>> {
    if !ode::start() {
        return Err("libode is not built for double precision".into());
    }
    let what = std::env::args().nth(1).unwrap_or_default();
    let mut text = String::new();
    if what != "rays" {
        for speed in [0.5, 2.0, 10.0] {
            text += &broad(10_000, speed, 240)?;
        }
    }
    if what != "broad" {
        text += &rays(100_000)?;
    }
    print!("{text}");
    Ok(())
}
