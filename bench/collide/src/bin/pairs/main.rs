//! Times the contacts of every pair of classes against installed libode: touching, near (boxes overlap, geoms do not) and
//! apart, the same random poses for both, in turns.
//!
//! `cargo run --release -p ferrode-bench-collide --bin pairs -- [--pair WORD[-WORD]] [--state WORD] [--reps N] [--out DIR]`
//!
//! Libode is asked by `dCollide` for up to 8 contacts, Ferrode by `Colliders::geom_contacts` for as many. Figures are
//! processor time of the one thread, medians. Beside them: in how many of the touching poses both have contacts, how many,
//! and how much the deepest differ.
#![deny(unsafe_code)]

#[allow(unsafe_code)]
#[path = "../../../../src/clock.rs"]
mod clock;
#[allow(unsafe_code)]
mod ode;
mod poses;
mod shapes;
#[path = "../../../../src/stamp.rs"]
mod stamp;

use ferrode_collide::{CollideOptions, Colliders, Geom, GeomContact, GeomKey, Shape};
use poses::{Numbers, State};
use shapes::Class;
use std::error::Error;
use std::fmt::Write as _;
use std::hint::black_box;

/// Poses of each pair and state.
const POSES: usize = 256;
/// Seconds of one measurement, at least.
const TURN: f64 = 1e-4;

/// One pair in one state.
struct Cell {
    /// Nanoseconds a call.
    ours: f64,
    theirs: Option<f64>,
    /// Contacts a call, ours and libode's.
    counts: [f64; 2],
    /// Share of poses of which both say the same: contacts or none.
    agree: f64,
    /// Median and largest difference of the deepest contact's depth, where both have some, in metres.
    depth: [f64; 2],
}

struct Scene {
    colliders: Colliders,
    ours: Vec<(GeomKey, GeomKey)>,
    theirs: Vec<(ode::Geom, ode::Geom)>,
}

impl Scene {
    fn new(shapes: [&[Shape]; 2], samples: &[poses::Sample]) -> Result<Self, Box<dyn Error>> {
        let data = shapes.map(|list| list.iter().map(ode::Data::of).collect::<Vec<_>>());
        let mut scene = Self { colliders: Colliders::new(), ours: Vec::new(), theirs: Vec::new() };
        for s in samples {
            let mut keys = Vec::new();
            let mut ids = Vec::new();
            for k in 0..2 {
                let shape = &shapes[k][s.sizes[k]];
                keys.push(scene.colliders.add_geom(None, Geom::new(shape.clone()).at(s.poses[k]))?);
                ids.extend(ode::Geom::new(shape, &data[k][s.sizes[k]], &s.poses[k]));
            }
            scene.ours.push((keys[0], keys[1]));
            if let [a, b] = ids[..] {
                scene.theirs.push((a, b));
            }
        }
        Ok(scene)
    }

    fn run_ours(&self, list: &mut Vec<GeomContact>) -> usize {
        let mut sum = 0;
        for &(a, b) in &self.ours {
            list.clear();
            sum += self.colliders.geom_contacts(a, b, CollideOptions::new(8), list);
        }
        sum
    }

    fn run_theirs(&self, list: &mut [ode::ContactGeom; 8]) -> usize {
        self.theirs.iter().map(|&(a, b)| a.collide(b, list)).sum()
    }

    fn measure(&self, reps: usize) -> Cell {
        let mut list = Vec::with_capacity(64);
        let mut room = ode::list();
        let calls = self.ours.len() as f64;
        // Seconds of `rounds` times all poses.
        let time = |rounds: usize, f: &mut dyn FnMut() -> usize| {
            let start = clock::thread_seconds();
            for _ in 0..rounds {
                black_box(f());
            }
            clock::thread_seconds() - start
        };
        let rounds = |f: &mut dyn FnMut() -> usize| {
            // The least of a few: one that was disturbed would make turns so short that reading the clock counts.
            let once = (0..5).map(|_| time(1, f)).fold(f64::INFINITY, f64::min);
            ((TURN / once.max(1e-9)).ceil() as usize).clamp(1, 1000)
        };
        let both = !self.theirs.is_empty();
        let mine = rounds(&mut || self.run_ours(&mut list));
        let yours = if both { rounds(&mut || self.run_theirs(&mut room)) } else { 0 };
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for _ in 0..reps {
            a.push(time(mine, &mut || self.run_ours(&mut list)) / (mine as f64 * calls) * 1e9);
            if both {
                b.push(time(yours, &mut || self.run_theirs(&mut room)) / (yours as f64 * calls) * 1e9);
            }
        }
        let mut cell = Cell {
            ours: median(&mut a),
            theirs: both.then(|| median(&mut b)),
            counts: [0.0; 2],
            agree: 0.0,
            depth: [0.0; 2],
        };
        cell.counts[0] = self.run_ours(&mut list) as f64 / calls;
        cell.counts[1] = self.run_theirs(&mut room) as f64 / calls;
        let mut differences = Vec::new();
        for (&(a, b), &(c, d)) in self.ours.iter().zip(&self.theirs) {
            list.clear();
            self.colliders.geom_contacts(a, b, CollideOptions::new(8), &mut list);
            let n = c.collide(d, &mut room);
            cell.agree += if list.is_empty() == (n == 0) { 1.0 / calls } else { 0.0 };
            if n > 0 && !list.is_empty() {
                let deepest = list.iter().map(|c| c.point.depth).fold(0.0, f64::max);
                differences.push((deepest - room[..n].iter().map(|c| c.depth).fold(0.0, f64::max)).abs());
            }
        }
        if !differences.is_empty() {
            let most = differences.iter().copied().fold(0.0, f64::max);
            cell.depth = [median(&mut differences), most];
        }
        cell
    }
}

fn median(list: &mut [f64]) -> f64 {
    list.sort_unstable_by(f64::total_cmp);
    list[list.len() / 2]
}

fn mean(ratios: &[f64]) -> f64 {
    (ratios.iter().map(|r| r.ln()).sum::<f64>() / ratios.len().max(1) as f64).exp()
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let option = |name: &str| arguments.iter().position(|a| a == name).and_then(|i| arguments.get(i + 1));
    let reps = option("--reps").map_or(Ok(15), |n| n.parse())?;
    if !ode::start() {
        return Err("libode is not built for double precision".into());
    }
    let mut text = format!(
        "# Pairs: {}, {}\n\nNanoseconds of processor time a call, medians of {reps} turns, libode 0.16.2 / Ferrode, over {POSES} random \
         poses of four sizes, half of them upright; up to 8 contacts. *Ratio*: geometric mean of the three states. Last columns, of the \
         touching poses: contacts a call (libode / Ferrode), poses in which both find contacts, and difference of the deepest \
         (median / largest).\n\n\
         | pair | touching | | near | | apart | | ratio | contacts | agree | depth, m |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
        stamp::processor(),
        stamp::today(),
    );
    let mut ratios: Vec<(String, f64)> = Vec::new();
    let mut worst: Vec<(String, f64)> = Vec::new();
    for (i, &first) in Class::ALL.iter().enumerate() {
        for &second in &Class::ALL[i..] {
            let name = format!("{}-{}", first.name(), second.name());
            if option("--pair").is_some_and(|p| !name.contains(p.as_str())) {
                continue;
            }
            let sizes = [shapes::sizes(first, false)?, shapes::sizes(second, true)?];
            let lists = [&sizes[0][..], &sizes[1][..]];
            let nothing = matches!(
                (first, second),
                (Class::Ray, Class::Ray)
                    | (Class::Heightfield | Class::Plane, Class::Heightfield | Class::Plane)
            );
            if nothing {
                continue;
            }
            let mut row = format!("| {name} |");
            let mut parts = Vec::new();
            let mut touching = None;
            for state in State::ALL {
                if option("--state")
                    .is_some_and(|s| !format!("{state:?}").to_lowercase().contains(s.as_str()))
                {
                    continue;
                }
                let samples =
                    poses::samples([first, second], lists, state, POSES, &mut Numbers::new(7 + i as u32));
                if samples.len() < POSES {
                    eprintln!("{name} {state:?}: {} poses only", samples.len());
                    row += " | |";
                    continue;
                }
                let cell = Scene::new(lists, &samples)?.measure(reps);
                match cell.theirs {
                    Some(theirs) => {
                        let _ = write!(row, " {theirs:.0} / {:.0} | {:.2} |", cell.ours, theirs / cell.ours);
                        parts.push(theirs / cell.ours);
                        worst.push((format!("{name} {state:?}"), theirs / cell.ours));
                    }
                    None => {
                        let _ = write!(row, " {:.0} | |", cell.ours);
                    }
                }
                if state == State::Touching {
                    touching = Some(cell);
                }
            }
            if !parts.is_empty() {
                let _ = write!(row, " **{:.2}** |", mean(&parts));
                ratios.push((name, mean(&parts)));
            } else {
                row += " |";
            }
            if let Some(c) = touching.filter(|c| c.theirs.is_some()) {
                let _ = write!(
                    row,
                    " {:.1} / {:.1} | {:.0} % | {:.0e} / {:.0e} |",
                    c.counts[1],
                    c.counts[0],
                    100.0 * c.agree,
                    c.depth[0],
                    c.depth[1]
                );
            } else {
                row += " | | |";
            }
            println!("{row}");
            text += &row;
            text += "\n";
        }
    }
    let all: Vec<f64> = ratios.iter().map(|r| r.1).collect();
    worst.sort_by(|a, b| a.1.total_cmp(&b.1));
    ratios.sort_by(|a, b| a.1.total_cmp(&b.1));
    let slow = |list: &[(String, f64)]| {
        let names = list.iter().take_while(|r| r.1 < 0.9).map(|r| format!("{} {:.2}", r.0, r.1));
        names.collect::<Vec<_>>().join(", ")
    };
    let _ = write!(
        text,
        "\nGeometric mean over {} pairs: **{:.2}** times libode's speed. Pairs below 0.9: {}. Single states below 0.9: {}.\n",
        all.len(),
        mean(&all),
        slow(&ratios),
        slow(&worst)
    );
    println!("{}", text.lines().last().unwrap_or_default());
    if let Some(folder) = option("--out") {
        std::fs::create_dir_all(folder)?;
        let path = format!("{folder}/pairs-{}-{}.md", stamp::processor(), stamp::today());
        std::fs::write(&path, text)?;
        println!("{path}");
    }
    Ok(())
}
