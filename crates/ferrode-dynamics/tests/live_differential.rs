//! Random scenes in this engine and in the installed libode, step by step: bodies with all their modes, every joint type
//! with limits and motors, contacts with every surface mode, both steppers.
//!
//! One failing scene again, printed step by step, its script left in the target directory:
//! `FERRODE_SCENE=17 cargo test -p ferrode-dynamics --test live_differential -- --nocapture`
//! More of them: `FERRODE_SCENES=5000`.

mod oracle;

use oracle::scene::{Method, Scene};
use oracle::{Line, Record};

const METHODS: [Method; 3] = [Method::Direct, Method::Sparse, Method::Quick];
const SCENES: u32 = 200;
const STEPS: usize = 20;
const TOLERANCE: f64 = 1e-6;

/// How far one run of a scene is from libode's.
#[derive(Debug)]
struct Outcome {
    seed: u32,
    method: Method,
    redundant: bool,
    types: String,
    /// Largest difference of any body after each step.
    bodies: Vec<f64>,
    /// The same of what joints measure, over all steps.
    measures: f64,
    /// The same of joint forces.
    forces: f64,
    seeds_agree: bool,
    end: End,
}

/// What ended the comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    AllSteps,
    /// libode's own motion explodes, as joints do that it gets wrong in reverse: rounding errors grow with it.
    RunsAway,
    /// libode's exact solver gave up in the next step.
    GaveUp,
    /// libode aborted in the next step.
    Aborts,
}

impl Outcome {
    fn last(&self) -> f64 {
        self.bodies.last().copied().unwrap_or(0.0)
    }

    /// Rounding decides the forces of redundant constraints, and then friction. `Quick` has no such freedom.
    fn must_agree(&self) -> bool {
        self.method == Method::Quick || !self.redundant
    }

    fn agrees(&self) -> bool {
        self.seeds_agree && (!self.must_agree() || (self.last() < TOLERANCE && self.measures < TOLERANCE))
    }
}

/// Whether a body has become faster than any of these scenes can make it by honest forces.
fn runs_away(r: &Record) -> bool {
    r.what == "body" && r.numbers[8..].iter().any(|v| v.abs() > 1e3)
}

fn compare(scene: &Scene, method: Method, verbose: bool) -> Option<Outcome> {
    let (script, ours) = scene.run(STEPS, method).unwrap_or_else(|e| panic!("scene {}: {e}", scene.seed));
    if verbose {
        keep(&script, scene.seed, method);
    }
    let theirs = oracle::run(&script)?;
    let mut outcome = Outcome {
        seed: scene.seed,
        method,
        redundant: scene.redundant,
        types: scene.types.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "),
        bodies: Vec::new(),
        measures: 0.0,
        forces: 0.0,
        seeds_agree: true,
        end: End::AllSteps,
    };
    let mut ours = ours.iter();
    let mut worst_body: f64 = 0.0;
    for b in &theirs.records {
        if b.is_gave_up() || runs_away(b) {
            outcome.end = if b.is_gave_up() { End::GaveUp } else { End::RunsAway };
            break;
        }
        let a = ours.next().unwrap_or_else(|| panic!("scene {}: libode also prints {b:?}", scene.seed));
        let difference = a.difference(b);
        match &*a.what {
            "body" => worst_body = worst_body.max(difference),
            "measure" => outcome.measures = outcome.measures.max(difference),
            "feedback" => outcome.forces = outcome.forces.max(difference),
            _ => {
                // The last line of a step.
                outcome.seeds_agree &= a == b;
                outcome.bodies.push(worst_body);
                worst_body = 0.0;
            }
        }
        if verbose && difference > 1e-9 {
            print_record(outcome.bodies.len(), "ferrode", a);
            print_record(outcome.bodies.len(), "libode ", b);
        }
    }
    if let (End::AllSteps, Some(reason)) = (outcome.end, &theirs.abort) {
        println!("scene {}: libode aborts in step {}: {reason}", scene.seed, outcome.bodies.len());
        outcome.end = End::Aborts;
    }
    if outcome.end == End::AllSteps {
        assert_eq!(outcome.bodies.len(), STEPS, "scene {} prints every step", scene.seed);
    }
    if verbose {
        println!("{outcome:#?}");
    }
    Some(outcome)
}

fn print_record(step: usize, engine: &str, r: &Record) {
    let numbers: Vec<String> = r.numbers.iter().map(|x| format!("{x:.12}")).collect();
    println!("step {step} {engine} {} {}: {}", r.what, r.index, numbers.join(" "));
}

fn keep(script: &[Line], seed: u32, method: Method) {
    let path = format!("{}/scene-{seed}-{method:?}.txt", env!("CARGO_TARGET_TMPDIR"));
    let text: String = script.iter().map(|line| format!("{line}\n")).collect();
    match std::fs::write(&path, text) {
        Ok(()) => println!("script of scene {seed}: {path}"),
        Err(e) => println!("script of scene {seed} could not be kept in {path}: {e}"),
    }
}

fn print_class(method: Method, redundant: bool, outcomes: &[Outcome]) {
    let class: Vec<_> = outcomes.iter().filter(|o| o.method == method && o.redundant == redundant).collect();
    let mut last: Vec<f64> = class.iter().map(|o| o.last()).collect();
    last.sort_by(f64::total_cmp);
    let worst = |f: fn(&Outcome) -> f64| class.iter().map(|o| f(o)).fold(0.0, f64::max);
    println!(
        "{:6} {:11}: {:3} scenes; relative difference after {STEPS} steps: median {:.1e}, worst {:.1e}; worst on the way \
         of what joints measure {:.1e}, of joint forces {:.1e}",
        format!("{method:?}"),
        if redundant { "redundant" } else { "independent" },
        class.len(),
        last.get(last.len() / 2).copied().unwrap_or(0.0),
        worst(Outcome::last),
        worst(|o| o.measures),
        worst(|o| o.forces),
    );
}

#[test]
fn random_scenes_move_as_in_libode() {
    let number = |name: &str| -> Option<u32> { std::env::var(name).ok().and_then(|s| s.parse().ok()) };
    let one = number("FERRODE_SCENE");
    let seeds = one.map_or(0..number("FERRODE_SCENES").unwrap_or(SCENES), |seed| seed..seed + 1);
    let mut outcomes = Vec::new();
    for seed in seeds {
        let scene = Scene::random(seed);
        for method in METHODS {
            let Some(outcome) = compare(&scene, method, one.is_some()) else { return };
            outcomes.push(outcome);
        }
    }
    for method in METHODS {
        print_class(method, false, &outcomes);
        print_class(method, true, &outcomes);
    }
    let ended = |end: End| outcomes.iter().filter(|o| o.end == end).count();
    println!(
        "compared only until libode's motion exploded: {} of {} runs; until its exact solver gave up: {}; until it \
         aborted: {}",
        ended(End::RunsAway),
        outcomes.len(),
        ended(End::GaveUp),
        ended(End::Aborts),
    );
    let different: Vec<_> = outcomes.iter().filter(|o| !o.agrees()).collect();
    for o in &different {
        let first = o.bodies.iter().position(|d| *d > 1e-9);
        println!(
            "scene {} {:?}: {:.1e} at the end, above 1e-9 from step {first:?}, measured {:.1e}, seeds {}; {}",
            o.seed,
            o.method,
            o.last(),
            o.measures,
            if o.seeds_agree { "agree" } else { "DIFFER" },
            o.types
        );
    }
    assert!(different.is_empty(), "{} of {} runs differ from libode", different.len(), outcomes.len());
}
