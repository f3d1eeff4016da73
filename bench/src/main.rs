//! Times Ferrode against installed libode on the same scenes, one thread each, and writes the figures down.
//!
//! ```text
//! cargo run --release -- [--reps N] [--scene WORD] [--only ferrode|libode] [--out DIR]
//! ```
//!
//! Contacts are found once, by Ferrode, and recorded; both engines get the same list for each step. What is timed is
//! making the contact joints, the step, and removing them, in processor time of the one thread. Runs alternate, and medians are
//! reported, so that a machine that is busy with something else slows both. Beside every time stand figures of quality, because a fast wrong
//! answer counts for nothing.
#![deny(unsafe_code)]

#[allow(unsafe_code)]
mod clock;
mod engine;
#[allow(unsafe_code)]
mod ode;
mod report;
mod scene;
mod stamp;

use engine::{ContactLine, Engine, Ferrode, Method};
use ode::Ode;
use report::Line;
use scene::{SCENES, Scene};

struct Options {
    reps: usize,
    scene: String,
    only: Option<String>,
    out: String,
}

fn options() -> Result<Options, String> {
    let mut options = Options { reps: 7, scene: String::new(), only: None, out: "results".into() };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--reps" => options.reps = value()?.parse().map_err(|e| format!("--reps: {e}"))?,
            "--scene" => options.scene = value()?,
            "--only" => options.only = Some(value()?),
            "--out" => options.out = value()?,
            _ => return Err(format!("unknown option {word}")),
        }
    }
    Ok(options)
}

/// Seconds of processor time of one run from the scene's start.
fn run<E: Engine>(scene: &Scene, contacts: &[Vec<ContactLine>]) -> (f64, E) {
    let mut engine: E = scene.build();
    let start = clock::thread_seconds();
    for list in contacts {
        engine.step(scene.method, Scene::H, list, Scene::MU);
    }
    (clock::thread_seconds() - start, engine)
}

/// The contacts of each step, as a run of this project's engine meets them; and the rows of its last step.
fn record(scene: &Scene) -> (Vec<Vec<ContactLine>>, usize) {
    let mut engine: Ferrode = scene.build();
    let mut lists = Vec::new();
    for _ in 0..scene.steps {
        let list = scene.contacts(&engine.poses());
        engine.step(scene.method, Scene::H, &list, Scene::MU);
        lists.push(list);
    }
    (lists, engine.rows)
}

/// The state that a run ends with, judged.
fn line<E: Engine>(scene: &Scene, engine: &E, seconds: Vec<f64>, rows: usize) -> Line {
    let poses = engine.poses();
    let depths = scene.contacts(&poses).into_iter().map(|c| c.point.depth);
    Line {
        scene: scene.name,
        method: if scene.method == Method::Quick { "Quick" } else { "Direct" },
        engine: E::NAME,
        bodies: poses.len(),
        rows,
        seconds: seconds.into_iter().map(|s| s / scene.steps as f64).collect(),
        joint_error: engine.joint_error(),
        penetration: depths.fold(0.0, f64::max),
        speed: engine.speeds().into_iter().map(|v| v.length()).fold(0.0, f64::max),
        difference: None,
    }
}

fn main() -> Result<(), String> {
    let options = options()?;
    let wanted = |name: &str| options.only.as_deref().is_none_or(|only| only == name);
    let mut lines = Vec::new();
    for scene in SCENES.iter().filter(|s| format!("{} {:?}", s.name, s.method).contains(&options.scene)) {
        let before = lines.len();
        let (contacts, rows) = record(scene);
        let mut times = [Vec::new(), Vec::new()];
        let (mut ours, mut theirs) = (None, None);
        for _ in 0..options.reps {
            if wanted(Ferrode::NAME) {
                let (seconds, engine) = run::<Ferrode>(scene, &contacts);
                times[0].push(seconds);
                ours = Some(engine);
            }
            if wanted(Ode::NAME) {
                let (seconds, engine) = run::<Ode>(scene, &contacts);
                times[1].push(seconds);
                theirs = Some(engine);
            }
        }
        let [our_times, their_times] = times;
        let difference = ours.as_ref().zip(theirs.as_ref()).map(|(a, b)| {
            let apart = a.poses().into_iter().zip(b.poses()).map(|((p, _), (q, _))| (p - q).length());
            apart.fold(0.0, f64::max)
        });
        if let Some(engine) = &ours {
            lines.push(Line { difference, ..line(scene, engine, our_times, rows) });
        }
        if let Some(engine) = &theirs {
            lines.push(line(scene, engine, their_times, rows));
        }
        report::print(&lines[before..]);
    }
    if options.only.is_none() && options.scene.is_empty() {
        let written = report::write(&options.out, &lines).map_err(|e| format!("{}: {e}", options.out))?;
        println!("written: {written}");
    }
    Ok(())
}
