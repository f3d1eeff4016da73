//! The repository's README is this crate's front page, so that its code is tested: the two texts are kept equal.

use std::path::Path;

#[test]
fn the_front_page_is_the_repositorys_readme() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md");
    let Ok(root) = std::fs::read_to_string(root) else {
        println!("skipped: this is no checkout of the repository");
        return;
    };
    let mut lines: Vec<&str> = Vec::new();
    // A picture's relative path holds in the repository only.
    let picture = |line: &str| line.starts_with("![") || line.starts_with("[![");
    for line in root.lines().filter(|line| !picture(line)) {
        if !(line.is_empty() && lines.last().is_some_and(|last| last.is_empty())) {
            lines.push(line);
        }
    }
    let front: Vec<&str> = include_str!("../README.md").lines().collect();
    assert_eq!(front, lines, "copy README.md, but for the picture, to crates/ferrode/README.md");
}
