//! C programs, compiled once against the installed libode and its headers, run on libode and on this library: the same
//! output, number by number.
//!
//! Needs a C compiler and Debian's `libode-dev`; without them the tests say so and do nothing.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Numbers agree to this, relative to numbers above 1, unless a program's first comment says "tolerance: x" and why.
const TOLERANCE: f64 = 1e-9;

fn tolerance(source: &Path) -> f64 {
    let text = std::fs::read_to_string(source).expect("the program's text");
    let stated = text.split_once("tolerance: ").and_then(|(_, rest)| rest.split_whitespace().next());
    stated.map_or(TOLERANCE, |number| number.parse().expect("a number after \"tolerance: \""))
}

/// The folder of this package.
fn here() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The shared library that cargo built with this test, in the same folder.
fn library() -> PathBuf {
    let test = std::env::current_exe().expect("a test has a path");
    let built = test.with_file_name("libode.so");
    assert!(built.exists(), "cargo builds {} with this test", built.display());
    built
}

/// A folder in which the library has the name that programs ask for.
fn library_folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("drop-in");
    std::fs::create_dir_all(&folder).expect("a folder for the library");
    let link = folder.join("libode.so.8");
    std::fs::remove_file(&link).ok();
    #[cfg(unix)]
    std::os::unix::fs::symlink(library(), &link).expect("a link to the library");
    folder
}

/// Compiles a program against the installed headers and library; `None` if these, or a compiler, are missing.
fn compile(source: &Path) -> Option<PathBuf> {
    let name = source.file_stem().expect("a file name");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("against-libode");
    std::fs::create_dir_all(&folder).expect("a folder for programs");
    let program = folder.join(name);
    let cpp = source.extension().is_some_and(|extension| extension == "cpp");
    let mut compiler = Command::new(if cpp { "c++" } else { "cc" });
    compiler.arg("-w").arg("-o").arg(&program).arg(source).args(["-lode", "-lm", "-lpthread"]);
    let output = compiler.output().ok()?;
    if output.status.success() {
        return Some(program);
    }
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let missing = errors.contains("ode/ode.h") || errors.contains("-lode");
    assert!(missing, "{} does not compile:\n{errors}", source.display());
    None
}

/// What a program prints and how it ends, on the installed library or in that folder.
fn run(program: &Path, folder: Option<&Path>) -> String {
    let mut command = Command::new(program);
    command.env_remove("LD_LIBRARY_PATH");
    if let Some(folder) = folder {
        command.env("LD_LIBRARY_PATH", folder);
    }
    let output = command.output().expect("the program starts");
    let text = String::from_utf8_lossy(&output.stdout);
    format!("{text}\n{}", output.status)
}

/// Whether two words are the same, or numbers that agree.
fn agree(a: &str, b: &str, tolerance: f64) -> bool {
    a == b
        || match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(a), Ok(b)) => (a - b).abs() <= tolerance * a.abs().max(1.0),
            _ => false,
        }
}

fn compare(name: &str, theirs: &str, ours: &str, tolerance: f64) -> Vec<String> {
    let mut faults = Vec::new();
    let (mut a, mut b) = (theirs.lines(), ours.lines());
    for number in 1.. {
        let (a, b) = (a.next(), b.next());
        if a.is_none() && b.is_none() {
            break;
        }
        let (a, b) = (a.unwrap_or("(end)"), b.unwrap_or("(end)"));
        let same = a.split_whitespace().count() == b.split_whitespace().count()
            && a.split_whitespace().zip(b.split_whitespace()).all(|(a, b)| agree(a, b, tolerance));
        if !same {
            faults.push(format!("{name}, line {number}:\n  libode: {a}\n  ours:   {b}"));
        }
    }
    faults
}

fn programs() -> Vec<PathBuf> {
    let folder = std::fs::read_dir(here().join("tests/c")).expect("the folder of programs");
    let mut programs: Vec<PathBuf> = folder.map(|entry| entry.expect("an entry").path()).collect();
    programs.retain(|path| path.extension().is_some_and(|e| e == "c" || e == "cpp"));
    programs.sort();
    programs
}

#[test]
fn programs_print_the_same() {
    let folder = library_folder();
    let mut faults = Vec::new();
    // A line that begins with a function's name and a colon shows what a call of it led to.
    let mut unchecked: BTreeSet<&str> = include_str!("data/symbols.txt").lines().collect();
    let functions = unchecked.len();
    for source in programs() {
        let Some(program) = compile(&source) else {
            println!("SKIPPED: no C compiler, or no libode-dev (apt install libode-dev)");
            return;
        };
        let name = source.file_stem().expect("a name").to_string_lossy().into_owned();
        let ours = run(&program, Some(&folder));
        for line in ours.lines() {
            if let Some((name, _)) = line.split_once(':') {
                unchecked.remove(name);
            }
        }
        let mut theirs = run(&program, None);
        for _ in 0..5 {
            // Libode's own threads race, rarely, until it aborts. Ours has one run, and must end as it should.
            if theirs.contains("signal:") && !ours.contains("signal:") {
                theirs = run(&program, None);
            }
        }
        faults.extend(compare(&name, &theirs, &ours, tolerance(&source)));
    }
    let checked = functions - unchecked.len();
    println!("{} programs, with the results of {checked} of {functions} functions", programs().len());
    assert!(unchecked.is_empty(), "functions of which no program shows a result: {unchecked:?}");
    assert!(programs().len() >= 60, "{} programs", programs().len());
    assert!(faults.is_empty(), "{} lines differ:\n{}", faults.len(), faults.join("\n"));
}

/// The names of the installed library, and those that this one exports.
#[test]
fn only_public_names_are_exported() {
    let names = |library: &Path| -> Option<Vec<String>> {
        let output = Command::new("nm").args(["-D", "--defined-only"]).arg(library).output().ok()?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        Some(text.lines().filter_map(|line| line.split_whitespace().nth(2)).map(str::to_owned).collect())
    };
    let wanted: Vec<&str> = include_str!("data/symbols.txt").lines().collect();
    let Some(ours) = names(&library()) else {
        println!("SKIPPED: no nm");
        return;
    };
    let newer = [
        "dGeomTriMeshDataGet",
        "dJointAddPUTorques",
        "dWorldAttachQuickStepDynamicIterationStatisticsSink",
        "dWorldGetAutoEnableDepthSF1",
        "dWorldGetQuickStepDynamicIterationParameters",
        "dWorldGetSteppingThreadingParameters",
        "dWorldSetAutoEnableDepthSF1",
        "dWorldSetQuickStepDynamicIterationParameters",
        "dWorldSetSteppingThreadingParameters",
        "dWorldStepFast1",
    ];
    let foreign: Vec<_> = ours
        .iter()
        .filter(|name| !wanted.contains(&name.as_str()) && !newer.contains(&name.as_str()))
        .collect();
    assert!(foreign.is_empty(), "exported, but no public name: {foreign:?}");
    let exported = wanted.iter().filter(|name| ours.iter().any(|our| our == *name)).count();
    println!("exported {exported} of {}", wanted.len());
    let floor: usize = include_str!("data/exported.txt").trim().parse().expect("a number");
    assert!(exported >= floor, "{exported} names are exported; there were {floor} before");
}
