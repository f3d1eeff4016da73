//! Whole worlds side by side: `cargo run --release -p ferrode-bench-peers -- --out results`.
//!
//! Each run is a process of its own, so that peak memory is one engine's, and engines take turns. Options: `--scene WORD`
//! and `--engine WORD` pick some of them, `--reps N` sets the number of turns, `--threads 1,2` the numbers of threads.

mod arrange;
mod chart;
mod engine;
mod engines;
mod quality;
mod report;
mod run;
mod scene;
#[path = "../../src/stamp.rs"]
mod stamp;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What the command line asks for.
#[derive(Debug)]
struct Words {
    scene: String,
    engine: String,
    reps: usize,
    threads: Vec<usize>,
    out: Option<PathBuf>,
    /// One run in this process: the number of steps, 0 for the scene's own.
    single: Option<usize>,
}

fn words() -> Result<Words, String> {
    let mut words = Words {
        scene: String::new(),
        engine: String::new(),
        reps: 3,
        threads: vec![1],
        out: None,
        single: None,
    };
    let mut rest = std::env::args().skip(1);
    while let Some(word) = rest.next() {
        let value = rest.next().ok_or_else(|| format!("{word} needs a value"))?;
        let number = |text: &str| text.parse().map_err(|_| format!("{word}: {text:?} is no number"));
        match word.as_str() {
            "--scene" => words.scene = value,
            "--engine" => words.engine = value,
            "--reps" => words.reps = number(&value)?,
            "--threads" => words.threads = value.split(',').map(number).collect::<Result<_, _>>()?,
            "--out" => words.out = Some(value.into()),
            "--single" => words.single = Some(number(&value)?),
            _ => return Err(format!("{word}: no such option")),
        }
    }
    Ok(words)
}

fn scenes(word: &str) -> Result<Vec<PathBuf>, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|file| file.file_stem().is_some_and(|stem| stem.to_string_lossy().contains(word)));
    files.sort();
    Ok(files)
}

fn go() -> Result<(), String> {
    let words = words()?;
    let files = scenes(&words.scene)?;
    if let Some(steps) = words.single {
        let choice = engines::all().into_iter().find(|c| c.name == words.engine);
        let choice = choice.ok_or_else(|| format!("no engine {:?}", words.engine))?;
        let [file] = files.as_slice() else { return Err("one run takes one scene".into()) };
        let scene = scene::Scene::read(file)?;
        let threads = words.threads.first().copied().unwrap_or(1);
        if let Some(why) = (choice.refuses)(&scene) {
            return Err(format!("{}: {why}", choice.name));
        }
        let run = run::measure(&scene, &choice, threads, steps);
        println!("{}", serde_json::to_string(&run).map_err(|e| e.to_string())?);
        return Ok(());
    }
    let mut rows = Vec::new();
    for file in &files {
        let scene = scene::Scene::read(file)?;
        for &threads in &words.threads {
            rows.extend(run::take_turns(file, &scene, &words.engine, threads, words.reps));
        }
    }
    let text = report::text(&rows);
    println!("{text}");
    if let Some(folder) = &words.out {
        let name = format!("peers-{}-{}", stamp::processor(), stamp::today());
        let write = |end: &str, text: &str| {
            let path = folder.join(format!("{name}.{end}"));
            std::fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))
        };
        write("md", &text)?;
        write("svg", &chart::svg(&rows)?)?;
    }
    Ok(())
}

fn main() -> ExitCode {
    match go() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("peers: {error}");
            ExitCode::FAILURE
        }
    }
}
