//! How the time of one exact step grows with the size of the mechanism, beside libode's `dWorldStep`.
//!
//! ```text
//! cargo run --release --bin growth -- [--smallest N] [--largest N] [--case WORD] [--reps N] [--size N] [--h SECONDS] [--from STEP]
//!     [--steps N] [--ours] [--threads N]
//! ```
//!
//! With more than one thread, times of ours are those of the clock on the wall.
//!
//! Contacts are found by Ferrode and given to both engines. Timed are the making of contact joints, the step, and removing them. Printed per
//! size: median processor time of a step, factorisations per step, time per factorisation, blocks of the factor, residual and a
//! figure of quality; then the exponent of the time per factorisation, fitted over the larger half of the sizes.
#![deny(unsafe_code)]
#![allow(dead_code)]

#[allow(unsafe_code)]
#[path = "../cpu.rs"]
mod cpu;
#[path = "../engine.rs"]
mod engine;
#[allow(unsafe_code)]
#[path = "../ode.rs"]
mod ode;

use engine::{ContactLine, Engine, Ferrode, Method, Mu};
use ferrode_collide::{CollideOptions, Cuboid, Plane, Shape, narrow};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Pose, Quat, Vec3, real};
use ode::Ode;
use std::time::Instant;

/// A family of scenes.
struct Case {
    name: &'static str,
    sizes: &'static [usize],
    /// libode is not asked beyond this size.
    most_for_libode: usize,
    h: f64,
    cfm: f64,
    /// Sides of the boxes that touch; None if nothing does.
    sides: Option<Vec3>,
    /// Steps before the timed ones, and timed ones.
    steps: [usize; 2],
    build: fn(&mut dyn Builder, usize),
}

/// What the builders use of an engine.
trait Builder {
    fn body(&mut self, mass: f64, sides: Vec3, at: Vec3) -> usize;
    fn turned_body(&mut self, mass: f64, sides: Vec3, at: Vec3, rotation: Quat) -> usize;
    fn ball(&mut self, first: usize, second: Option<usize>, anchor: Vec3);
    fn hinge(&mut self, first: usize, second: Option<usize>, anchor: Vec3, axis: Vec3, brake: f64);
}

impl<E: Engine> Builder for E {
    fn body(&mut self, mass: f64, sides: Vec3, at: Vec3) -> usize {
        self.add_box(mass, sides, at, Quat::IDENTITY)
    }
    fn turned_body(&mut self, mass: f64, sides: Vec3, at: Vec3, rotation: Quat) -> usize {
        self.add_box(mass, sides, at, rotation)
    }
    fn ball(&mut self, first: usize, second: Option<usize>, anchor: Vec3) {
        self.add_ball(Some(first), second, anchor);
    }
    fn hinge(&mut self, first: usize, second: Option<usize>, anchor: Vec3, axis: Vec3, brake: f64) {
        self.add_hinge(Some(first), second, anchor, axis, Some(brake));
    }
}

const UNIT: Vec3 = Vec3::new(1.0, 1.0, 1.0);
const HALF: Vec3 = Vec3::new(0.5, 0.5, 0.5);
const CONTACT_SIZES: &[usize] = &[10, 20, 40, 80, 160, 320, 640, 1000];

const CASES: &[Case] = &[
    Case {
        name: "chain",
        sizes: &[10, 32, 100, 320, 1000, 3200, 10000],
        most_for_libode: 320,
        h: 1.0 / 400.0,
        cfm: 1e-10,
        sides: None,
        steps: [2, 10],
        build: chain,
    },
    Case {
        name: "tree",
        sizes: &[10, 32, 100, 320, 1000, 3200, 10000],
        most_for_libode: 100,
        h: 1.0 / 400.0,
        cfm: 1e-10,
        sides: None,
        steps: [2, 10],
        build: tree,
    },
    Case {
        name: "robots",
        sizes: &[30, 120, 480, 1920],
        most_for_libode: 1920,
        h: 0.01,
        cfm: 1e-10,
        sides: None,
        steps: [2, 10],
        build: robots,
    },
    Case {
        name: "tower",
        sizes: &[10, 32, 100, 320, 1000, 3200, 10000],
        most_for_libode: 10,
        h: 1.0 / 60.0,
        cfm: 1e-10,
        sides: Some(UNIT),
        steps: [2, 6],
        build: tower,
    },
    Case {
        name: "wall",
        sizes: CONTACT_SIZES,
        most_for_libode: 80,
        h: 1.0 / 60.0,
        cfm: 1e-10,
        sides: Some(UNIT),
        steps: [10, 10],
        build: wall,
    },
    Case {
        name: "pyramid",
        sizes: &[10, 21, 45, 91, 210, 406, 820],
        most_for_libode: 45,
        h: 1.0 / 60.0,
        cfm: 1e-10,
        sides: Some(UNIT),
        steps: [10, 10],
        build: pyramid,
    },
    Case {
        name: "pile",
        sizes: CONTACT_SIZES,
        most_for_libode: 40,
        h: 0.01,
        cfm: 1e-5,
        sides: Some(HALF),
        steps: [60, 10],
        build: pile,
    },
    Case {
        name: "heap",
        sizes: CONTACT_SIZES,
        most_for_libode: 160,
        h: 0.01,
        cfm: 1e-5,
        sides: Some(HALF),
        steps: [60, 10],
        build: heap,
    },
    Case {
        name: "crowd",
        sizes: CONTACT_SIZES,
        most_for_libode: 80,
        h: 0.01,
        cfm: 1e-5,
        sides: Some(HALF),
        steps: [60, 10],
        build: crowd,
    },
    Case {
        name: "grid",
        sizes: &[25, 100, 400, 900],
        most_for_libode: 100,
        h: 0.01,
        cfm: 1e-10,
        sides: None,
        steps: [2, 10],
        build: grid,
    },
];

fn chain(world: &mut dyn Builder, n: usize) {
    let mut last = None;
    for i in 0..n {
        let link = world.body(0.2, Vec3::new(0.2, 0.05, 0.05), Vec3::new((i as f64 + 0.5) * 0.2, 0.0, 0.0));
        world.ball(link, last, Vec3::new(i as f64 * 0.2, 0.0, 0.0));
        last = Some(link);
    }
}

fn tree(world: &mut dyn Builder, n: usize) {
    let mut at = Vec::new();
    for i in 0..n {
        let place = Vec3::new((i % 97) as f64 * 0.3, (i / 97) as f64 * 0.3, 0.1 * (i % 7) as f64);
        at.push(place);
        let body = world.body(1.0, Vec3::splat(0.2), place);
        let parent = (i > 0).then(|| (i - 1) / 3);
        world.hinge(body, parent, place - Vec3::new(0.1, 0.0, 0.0), [Vec3::X, Vec3::Y, Vec3::Z][i % 3], 5.0);
    }
}

/// Robots of 30 hinges with brakes, as many as make n bodies.
fn robots(world: &mut dyn Builder, n: usize) {
    for robot in 0..n / 30 {
        let base = Vec3::new((robot % 8) as f64 * 5.0, (robot / 8) as f64 * 5.0, 3.0);
        let torso = world.body(5.0, Vec3::new(0.4, 0.3, 0.6), base);
        world.hinge(torso, None, base, Vec3::Z, 5.0);
        for k in 0..29 {
            let (limb, joint) = (k % 5, k / 5);
            let direction = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z][limb];
            let parent = if joint == 0 { torso } else { torso + k + 1 - 5 };
            let anchor = base + direction * (0.4 + joint as f64 * 0.25);
            let sides = Vec3::splat(0.08) + direction.abs() * 0.17;
            let body = world.body(0.5 + 0.1 * joint as f64, sides, anchor + direction * 0.125);
            let axis = [Vec3::X, Vec3::Y, Vec3::Z][(limb / 2 + joint + 1) % 3];
            world.hinge(body, Some(parent), anchor, axis, 1.0 + joint as f64);
        }
    }
}

fn tower(world: &mut dyn Builder, n: usize) {
    for i in 0..n {
        world.body(1.0, UNIT, Vec3::new(0.0, 0.0, 0.5 + i as f64));
    }
}

fn wall(world: &mut dyn Builder, n: usize) {
    let columns = ((n as f64).sqrt() * 1.3).ceil() as usize;
    for i in 0..n {
        let (row, column) = (i / columns, i % columns);
        let x = (column as f64 + 0.5 * (row % 2) as f64) * 1.02;
        world.body(1.0, UNIT, Vec3::new(x, 0.0, 0.499 + row as f64 * 0.998));
    }
}

fn pyramid(world: &mut dyn Builder, n: usize) {
    let rows = (1..).find(|r| r * (r + 1) / 2 >= n).unwrap_or(1);
    for row in 0..rows {
        for i in 0..rows - row {
            let x = (i as f64 + 0.5 * row as f64) * 1.02;
            world.body(1.0, UNIT, Vec3::new(x, 0.0, 0.499 + row as f64 * 0.998));
        }
    }
}

fn pile(world: &mut dyn Builder, n: usize) {
    let side = (1..).find(|s| s * s * s >= n).unwrap_or(1);
    for i in 0..n {
        let (x, y, z) = (i % side, i / side % side, i / (side * side));
        let shift = 0.07 * ((i * 7 % 5) as f64 - 2.0);
        let at = Vec3::new(0.62 * x as f64 + shift, 0.62 * y as f64 - 0.5 * shift, 0.35 + 0.6 * z as f64);
        world.body(0.125, HALF, at);
    }
}

/// As a pile, but every box is turned its own way, so that they tumble over each other.
fn heap(world: &mut dyn Builder, n: usize) {
    let side = (1..).find(|s| s * s * s >= n).unwrap_or(1);
    let mut random = OdeRandom::new(7);
    let mut unit = || random.next_real() - 0.5;
    for i in 0..n {
        let (x, y, z) = (i % side, i / side % side, i / (side * side));
        let at =
            Vec3::new(0.7 * x as f64 + 0.1 * unit(), 0.7 * y as f64 + 0.1 * unit(), 0.5 + 0.7 * z as f64);
        let axis = Vec3::new(unit(), unit(), unit());
        world.turned_body(0.125, HALF, at, Quat::from_axis_angle(axis, 3.0 * unit()));
    }
}

/// Boxes dropped close to each other, each turned a little: nearly all end in one island.
fn crowd(world: &mut dyn Builder, n: usize) {
    let side = (1..).find(|s| s * s * s >= n).unwrap_or(1);
    let mut random = OdeRandom::new(11);
    let mut unit = || random.next_real() - 0.5;
    for i in 0..n {
        let (x, y, z) = (i % side, i / side % side, i / (side * side));
        let half = 0.25 * (z % 2) as f64;
        let at = Vec3::new(0.56 * x as f64 + half, 0.56 * y as f64 + half, 0.3 + 0.56 * z as f64);
        let axis = Vec3::new(unit(), unit(), unit());
        world.turned_body(0.125, HALF, at, Quat::from_axis_angle(axis, 0.2 * unit()));
    }
}

fn grid(world: &mut dyn Builder, n: usize) {
    let side = (n as f64).sqrt().round() as usize;
    for i in 0..side * side {
        let (x, y) = ((i % side) as f64, (i / side) as f64);
        let body = world.body(1.0, Vec3::splat(0.5), Vec3::new(x, y, 0.0));
        if i % side > 0 {
            world.ball(body, Some(body - 1), Vec3::new(x - 0.5, y, 0.0));
        }
        if i >= side {
            world.ball(body, Some(body - side), Vec3::new(x, y - 0.5, 0.0));
        }
        if i == 0 {
            world.ball(body, None, Vec3::new(0.0, 0.0, 0.3));
        }
    }
}

/// The contacts of boxes with each other and with the ground.
fn contacts(sides: Option<Vec3>, poses: &[(Vec3, Quat)]) -> Vec<ContactLine> {
    let Some(sides) = sides else { return Vec::new() };
    let cuboid = Shape::from(Cuboid::new(sides).expect("sides are positive"));
    let ground = Shape::from(Plane::new(Vec3::Z, 0.0).expect("a unit normal"));
    let poses: Vec<Pose> = poses.iter().map(|(p, q)| Pose::new(*p, *q)).collect();
    let reach = sides.length();
    let (mut lines, mut found) = (Vec::new(), Vec::new());
    for (i, a) in poses.iter().enumerate() {
        narrow::collide((&cuboid, a), (&ground, &Pose::IDENTITY), CollideOptions::default(), &mut found);
        lines.extend(found.drain(..).map(|c| ContactLine { first: i, second: None, point: c.point }));
        for (j, b) in poses.iter().enumerate().skip(i + 1) {
            if (a.position.z - b.position.z).abs() < reach && (a.position - b.position).length() < reach {
                narrow::collide((&cuboid, a), (&cuboid, b), CollideOptions::default(), &mut found);
                let line = |c: ferrode_collide::GeomContact| ContactLine {
                    first: i,
                    second: Some(j),
                    point: c.point,
                };
                lines.extend(found.drain(..).map(line));
            }
        }
    }
    lines
}

fn new<E: Engine>(case: &Case, n: usize) -> E {
    let mut engine = E::new(Vec3::new(0.0, 0.0, -9.81));
    engine.set_cfm(case.cfm);
    (case.build)(&mut engine, n);
    engine
}

#[derive(Default)]
struct Figures {
    seconds: Vec<f64>,
    factorisations: u32,
    newton: u32,
    solves: u32,
    most: u32,
    uncertified: usize,
    fell_back: usize,
    blocks: usize,
    rows: usize,
}

impl Figures {
    fn median(&mut self) -> f64 {
        self.seconds.sort_by(f64::total_cmp);
        self.seconds.get(self.seconds.len() / 2).copied().unwrap_or(f64::NAN)
    }
}

/// One run of ours, which also records the contacts.
fn run(
    case: &Case,
    n: usize,
    method: Method,
    threads: usize,
    figures: &mut Figures,
) -> (Ferrode, Vec<Vec<ContactLine>>) {
    let mut engine: Ferrode = new(case, n);
    engine.set_threads(threads);
    let mut lists = Vec::new();
    for step in 0..case.steps[0] + case.steps[1] {
        let list = contacts(case.sides, &engine.poses());
        let (start, wall) = (cpu::seconds(), Instant::now());
        engine.step(method, case.h, &list, Mu(0.5));
        let seconds = if threads > 1 { wall.elapsed().as_secs_f64() } else { cpu::seconds() - start };
        lists.push(list);
        if step < case.steps[0] {
            continue;
        }
        figures.seconds.push(seconds);
        figures.rows = engine.rows;
        figures.blocks = engine.report.solves.iter().map(|s| s.factor_blocks).sum();
        figures.solves += 1;
        let most = engine.report.solves.iter().map(|s| s.factorisations).max().unwrap_or(0);
        figures.factorisations += most;
        figures.most = figures.most.max(most);
        figures.newton += engine.report.solves.iter().map(|s| s.newton_steps).sum::<u32>();
        figures.uncertified += engine.report.solves.iter().filter(|s| !s.certified()).count();
        figures.fell_back += engine.report.solves.iter().filter(|s| s.fell_back).count();
    }
    (engine, lists)
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let value = |name: &str| words.iter().position(|w| w == name).and_then(|i| words.get(i + 1)).cloned();
    let largest: usize = value("--largest").and_then(|v| v.parse().ok()).unwrap_or(usize::MAX);
    let smallest: usize = value("--smallest").and_then(|v| v.parse().ok()).unwrap_or(0);
    let reps: usize = value("--reps").and_then(|v| v.parse().ok()).unwrap_or(3);
    let wanted = value("--case").unwrap_or_default();
    let ours_only = words.iter().any(|w| w == "--ours");
    let steps = |name: &str| value(name).and_then(|v| v.parse().ok());
    let (before, timed) = (steps("--from"), steps("--steps"));
    println!(
        "case,n,rows,ms,factorisations,most,newton,us_per_factorisation,blocks,uncertified,fell_back,joint_error,libode_ms,ratio,quick_ms,libode_quick_ms,highest,mean_ms,axis_error"
    );
    let threads = value("--threads").and_then(|v| v.parse().ok()).unwrap_or(1);
    for case in CASES.iter().filter(|c| c.name.contains(&wanted)) {
        let steps = [before.unwrap_or(case.steps[0]), timed.unwrap_or(case.steps[1])];
        let h = value("--h").and_then(|v| v.parse().ok()).unwrap_or(case.h);
        let size: Option<usize> = value("--size").and_then(|v| v.parse().ok());
        let sizes = size.as_ref().map_or(case.sizes, core::slice::from_ref);
        let case = &Case { steps, h, ..*case };
        let mut points = Vec::new();
        for n in sizes.iter().copied().filter(|n| (smallest..=largest).contains(n)) {
            let (mut figures, mut quick) = (Figures::default(), Figures::default());
            let (mut theirs, mut theirs_quick) = (Vec::new(), Vec::new());
            let (mut error, mut axis_error, mut highest) = (0.0, 0.0, 0.0);
            for _ in 0..reps {
                let (engine, lists) = run(case, n, Method::Direct, threads, &mut figures);
                error = engine.joint_error();
                axis_error = engine.axis_error();
                highest = engine.poses().iter().map(|(p, _)| p.z).fold(f64::NEG_INFINITY, f64::max);
                let ode = |method: Method, times: &mut Vec<f64>| {
                    let mut engine: Ode = new(case, n);
                    for (step, list) in lists.iter().enumerate() {
                        let start = cpu::seconds();
                        engine.step(method, case.h, list, Mu(0.5));
                        if step >= case.steps[0] {
                            times.push(cpu::seconds() - start);
                        }
                    }
                };
                if n <= case.most_for_libode && !ours_only {
                    ode(Method::Direct, &mut theirs);
                }
                if !ours_only {
                    ode(Method::Quick, &mut theirs_quick);
                    run(case, n, Method::Quick, 1, &mut quick);
                }
            }
            theirs.sort_by(f64::total_cmp);
            theirs_quick.sort_by(f64::total_cmp);
            let median = figures.median();
            let libode = theirs.get(theirs.len() / 2).copied().unwrap_or(f64::NAN);
            let per_step = f64::from(figures.factorisations) / f64::from(figures.solves.max(1));
            let per_factorisation = median / per_step.max(1.0);
            points.push((n as f64, per_factorisation));
            println!(
                "{},{n},{},{:.4},{per_step:.1},{},{},{:.1},{},{},{},{error:.1e},{:.3},{:.1},{:.4},{:.4},{highest:.3},{:.4},{axis_error:.1e}",
                case.name,
                figures.rows,
                median * 1e3,
                figures.most,
                figures.newton,
                per_factorisation * 1e6,
                figures.blocks,
                figures.uncertified,
                figures.fell_back,
                libode * 1e3,
                libode / median,
                quick.median() * 1e3,
                theirs_quick.get(theirs_quick.len() / 2).copied().unwrap_or(f64::NAN) * 1e3,
                figures.seconds.iter().sum::<f64>() / figures.seconds.len() as f64 * 1e3
            );
        }
        println!("{} exponent {:.2}", case.name, exponent(&points[points.len() / 2..]));
    }
}

/// The slope of log time over log size.
fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(n, t)| (real::log(*n), real::log(*t))).collect();
    let k = logs.len() as f64;
    let (mx, my) = (logs.iter().map(|p| p.0).sum::<f64>() / k, logs.iter().map(|p| p.1).sum::<f64>() / k);
    let (xy, xx) =
        logs.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + (x - mx) * (y - my), b + (x - mx) * (x - mx)));
    xy / xx
}
