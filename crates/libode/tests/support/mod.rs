//! What the tests that run compilers share.
#![allow(dead_code)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of this package.
pub fn here() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A folder of this test's own, empty.
pub fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::remove_dir_all(&folder).ok();
    std::fs::create_dir_all(&folder).expect("a folder for the test");
    folder
}

/// Where cargo built the library with this test.
pub fn build_folder() -> PathBuf {
    let test = std::env::current_exe().expect("a test has a path");
    test.parent().expect("a test is in a folder").to_owned()
}

/// Links by the names that programs ask for, in a folder.
pub fn link_library(built: &Path, folder: &Path) {
    std::fs::create_dir_all(folder).expect("a folder for the library");
    for name in ["libode.so", "libode.so.8"] {
        std::fs::remove_file(folder.join(name)).ok();
        #[cfg(unix)]
        std::os::unix::fs::symlink(built, folder.join(name)).expect("a link to the library");
    }
}

/// Runs a command; `None` if there is no such program.
pub fn output(command: &mut Command) -> Option<Output> {
    command.output().ok()
}

/// Runs a command that has to succeed, and gives what it prints; `None` if there is no such program.
pub fn succeed(command: &mut Command) -> Option<String> {
    let output = output(command)?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{command:?} fails:\n{}{}", text(&output.stdout), text(&output.stderr));
    Some(text(&output.stdout))
}

/// Says that a test does nothing, and why.
pub fn skip(why: &str) {
    println!("SKIPPED: {why}");
}

/// The include folder of this package.
pub fn include() -> PathBuf {
    here().join("include")
}

/// The installed headers of libode, if there are any.
pub fn installed_headers() -> Option<&'static Path> {
    Some(Path::new("/usr/include")).filter(|folder| folder.join("ode/ode.h").exists())
}

/// The C and C++ programs of the comparison with libode.
pub fn programs() -> Vec<PathBuf> {
    let folder = std::fs::read_dir(here().join("tests/c")).expect("the folder of programs");
    let mut programs: Vec<PathBuf> = folder.map(|entry| entry.expect("an entry").path()).collect();
    programs.retain(|path| path.extension().is_some_and(|e| e == "c" || e == "cpp"));
    programs.sort();
    programs
}

/// What a program prints with the libraries in a folder, and how it ends.
pub fn run(program: &Path, folder: &Path) -> String {
    let output = Command::new(program).env("LD_LIBRARY_PATH", folder).output().expect("the program starts");
    format!("{}{}", String::from_utf8_lossy(&output.stdout), output.status)
}

/// Whether two lines are the same: their words, or numbers that agree to `tolerance`, relative above 1.
pub fn agree(a: &str, b: &str, tolerance: f64) -> bool {
    let near = |a: &str, b: &str| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= tolerance * a.abs().max(1.0),
        _ => false,
    };
    a.split_whitespace().count() == b.split_whitespace().count()
        && a.split_whitespace().zip(b.split_whitespace()).all(|(a, b)| a == b || near(a, b))
}

/// Lines that differ, by [`agree`].
pub fn differences(name: &str, wanted: &str, got: &str, tolerance: f64) -> Vec<String> {
    let mut faults = Vec::new();
    let (mut a, mut b) = (wanted.lines(), got.lines());
    for number in 1.. {
        let (a, b) = (a.next(), b.next());
        if a.is_none() && b.is_none() {
            break;
        }
        let (a, b) = (a.unwrap_or("(end)"), b.unwrap_or("(end)"));
        if !agree(a, b, tolerance) {
            faults.push(format!("{name}, line {number}:\n  wanted: {a}\n  got:    {b}"));
        }
    }
    faults
}
