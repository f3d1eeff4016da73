//! One engine, one scene, one process; and many of these in turns.

use crate::engine::Choice;
use crate::engines;
use crate::quality::Quality;
use crate::scene::Scene;
use rustix::time::{ClockId, clock_gettime};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

/// What a run tells.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Run {
    /// The scene's name.
    pub scene: String,
    /// The engine's.
    pub engine: String,
    /// The engine's version and settings.
    pub about: String,
    /// Threads that it was given.
    pub threads: usize,
    /// Mean over the timed steps in milliseconds: of the clock, and of all processors together.
    pub wall: f64,
    /// Processor time.
    pub cpu: f64,
    /// Peak memory in megabytes over that of the empty program with the scene read.
    pub memory: f64,
    /// Of the last step.
    pub quality: Quality,
    /// Why there was no run, if there was none.
    pub refused: Option<String>,
}

fn processor_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// A field of Linux' description of this process, in megabytes.
fn memory(field: &str) -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(field)?.strip_prefix(':'));
    let number = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    number.unwrap_or(f64::NAN) / 1024.0
}

/// Steps a scene in this process; `steps` 0 for as many as it says itself.
pub fn measure(scene: &Scene, choice: &Choice, threads: usize, steps: usize) -> Run {
    let steps = if steps == 0 { scene.steps } else { steps };
    let empty = memory("VmRSS");
    let mut engine = (choice.build)(scene, threads);
    let (mut wall, mut cpu) = (0.0, 0.0);
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for i in 0..steps {
        if i + 1 == steps {
            engine.poses(&mut before);
        }
        let (clock, used) = (Instant::now(), processor_seconds());
        engine.step();
        if i >= scene.first {
            wall += clock.elapsed().as_secs_f64();
            cpu += processor_seconds() - used;
        }
    }
    let memory = memory("VmHWM") - empty;
    engine.poses(&mut after);
    let scale = 1e3 / steps.saturating_sub(scene.first).max(1) as f64;
    Run {
        scene: scene.name.clone(),
        engine: choice.name.into(),
        about: engine.about(),
        threads,
        wall: wall * scale,
        cpu: cpu * scale,
        memory,
        quality: Quality::judge(scene, &before, &after),
        refused: None,
    }
}

/// Runs of all engines whose name has one of the words in it that commas part, in turns; of each engine the one with the median time.
pub fn take_turns(file: &Path, scene: &Scene, words: &str, threads: usize, reps: usize) -> Vec<Run> {
    let wanted = |name: &str| words.split(',').any(|word| name.contains(word));
    let choices: Vec<Choice> =
        engines::all().into_iter().filter(|c| wanted(c.name) && (threads == 1 || c.threads)).collect();
    let refused = |choice: &Choice| Some(Run::refused(scene, choice, threads, (choice.refuses)(scene)?));
    let mut runs: Vec<Vec<Run>> =
        choices.iter().map(|choice| refused(choice).into_iter().collect()).collect();
    for turn in 0..reps {
        for (choice, runs) in choices.iter().zip(&mut runs) {
            if runs.iter().any(|run| run.refused.is_some()) {
                continue;
            }
            match single(file, choice.name, threads) {
                Ok(run) => runs.push(run),
                Err(error) => eprintln!("{} in {}, turn {turn}: {error}", scene.name, choice.name),
            }
        }
    }
    let median = |mut runs: Vec<Run>| {
        runs.sort_by(|a, b| a.time().total_cmp(&b.time()));
        (!runs.is_empty()).then(|| runs.swap_remove(runs.len() / 2))
    };
    runs.into_iter().filter_map(median).collect()
}

fn single(file: &Path, engine: &str, threads: usize) -> Result<Run, String> {
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let stem = file.file_stem().unwrap_or_default();
    let mut command = Command::new(program);
    command.arg("--single").arg("0").arg("--scene").arg(stem).arg("--engine").arg(engine);
    command.arg("--threads").arg(threads.to_string()).env("RAYON_NUM_THREADS", threads.to_string());
    let output = command.output().map_err(|e| e.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    let line = text.lines().rfind(|line| line.starts_with('{'));
    let line =
        line.ok_or_else(|| format!("{}: {}", output.status, String::from_utf8_lossy(&output.stderr)))?;
    serde_json::from_str(line).map_err(|e| e.to_string())
}

impl Run {
    /// In place of a run that an engine refuses.
    fn refused(scene: &Scene, choice: &Choice, threads: usize, why: String) -> Self {
        Self {
            scene: scene.name.clone(),
            engine: choice.name.into(),
            about: String::new(),
            threads,
            wall: f64::INFINITY,
            cpu: f64::INFINITY,
            memory: f64::NAN,
            quality: Quality::default(),
            refused: Some(why),
        }
    }

    /// Milliseconds a step: processor time on one thread, which other work on the machine does not lengthen, and time of
    /// the clock on several.
    pub fn time(&self) -> f64 {
        if self.threads == 1 { self.cpu } else { self.wall }
    }
}
