//! `unsafe` is fenced: only `ferrode-math`'s modules `simd` and `stage` and the C interfaces may use it.

use std::fs;
use std::path::{Path, PathBuf};

fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() && path.file_name().is_some_and(|n| n != "target") {
            sources(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
}

/// Crates that may hold unsafe code, and where in them.
fn may_be_unsafe(path: &str) -> bool {
    let modules = ["ferrode-math/src/simd", "ferrode-math/src/stage"];
    modules.iter().any(|module| path.contains(module))
        || path.contains("crates/libode/")
        || path.contains("drawstuff")
}

#[test]
fn unsafe_code_stays_behind_its_fence() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let crates = here.parent().expect("the crate lies in the workspace's folder of crates");
    let mut files = Vec::new();
    sources(crates, &mut files);
    assert!(files.len() > 50, "the search looks into the workspace's crates");
    // Put together here so that this file does not find itself.
    let word = ["un", "safe"].concat();
    for file in &files {
        let path = file.to_string_lossy().replace('\\', "/");
        let text = fs::read_to_string(file).expect("a source file can be read");
        for (number, line) in text.lines().enumerate() {
            let code = line.split("//").next().unwrap_or_default();
            let uses = code.split(|c: char| !c.is_alphanumeric() && c != '_').any(|w| w == word);
            assert!(!uses || may_be_unsafe(&path), "{path}:{}: {line}", number + 1);
        }
    }
    for lib in files.iter().filter(|f| f.ends_with("src/lib.rs") || f.ends_with("src/main.rs")) {
        let path = lib.to_string_lossy().replace('\\', "/");
        if path.contains("ferrode-math/") || may_be_unsafe(&path) {
            continue;
        }
        let text = fs::read_to_string(lib).expect("a source file can be read");
        assert!(text.contains(&format!("#![forbid({word}_code)]")), "{path} does not forbid {word} code");
    }
}
