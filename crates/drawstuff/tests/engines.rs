//! The example programs, compiled once against this library and the installed libode, run on both engines, without a window:
//! they draw the same, number by number.
//!
//! Needs a C compiler and Debian's `libode-dev`; without them the test says so and does nothing.
#![cfg(target_os = "linux")]

mod support;

use std::path::Path;
use support::{compile, differences, examples, libraries, program, scratch, succeed};

/// Numbers agree to this, relative to numbers above 1.
const TOLERANCE: f64 = 1e-6;
/// So many frames, before differences of the last bit have grown: unless a program's first comment says "compared: n frames",
/// and why.
const FRAMES: usize = 60;

fn frames(source: &Path) -> usize {
    let text = std::fs::read_to_string(source).expect("the program's text");
    let stated = text.split_once("compared: ").and_then(|(_, rest)| rest.split_whitespace().next());
    stated.map_or(FRAMES, |number| number.parse().expect("a number after \"compared: \""))
}

#[test]
fn programs_draw_the_same_on_both_engines() {
    let folder = scratch("engines");
    let theirs = libraries(&folder.join("theirs"), false);
    let ours = libraries(&folder.join("ours"), true);
    let sources = examples();
    assert!(sources.len() >= 10);
    let mut faults = Vec::new();
    for source in &sources {
        let Some(path) = compile(source, &folder, &theirs) else { return };
        let name = source.file_stem().expect("a name").to_string_lossy().into_owned();
        let frames = frames(source);
        let calls = |libraries: &Path, engine: &str| {
            let out = folder.join(format!("{name}-{engine}"));
            let mut command = program(&path, libraries);
            command.env("DRAWSTUFF_HEADLESS", &out).env("DRAWSTUFF_DUMP", "text");
            succeed(command.env("DRAWSTUFF_FRAMES", frames.to_string()));
            std::fs::read_to_string(out.join("calls.txt")).expect("the calls")
        };
        let (wanted, got) = (calls(&theirs, "libode"), calls(&ours, "ferrode"));
        assert_eq!(wanted.lines().filter(|line| line.starts_with("frame ")).count(), frames, "{name}");
        // Something is drawn in each frame, and something moves.
        let drawn: Vec<&str> = wanted.lines().filter(|line| line.contains(" color ")).collect();
        assert!(drawn.len() >= frames && drawn.first() != drawn.last(), "{name} draws little");
        let body = |n: usize| {
            let mut parts = wanted.split("frame ").skip(1);
            parts.nth(n).map(|part| part.lines().skip(2).collect::<Vec<_>>())
        };
        assert_ne!(body(0), body(frames - 1), "{name}: nothing moves");
        let different = differences(&name, &wanted, &got, TOLERANCE);
        println!("{name}: {} lines, {} differ", wanted.lines().count(), different.len());
        faults.extend(different.into_iter().take(3));
    }
    assert!(faults.is_empty(), "lines differ:\n{}", faults.join("\n"));
}
