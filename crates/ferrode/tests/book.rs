//! The book hangs together: its table of contents, its links and drawings, and which chapters' code is tested.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn book() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/book")
}

/// All chapters, as paths from the book's folder, with their text.
fn chapters() -> Vec<(String, String)> {
    let mut found = Vec::new();
    for folder in ["", "joints"] {
        for entry in fs::read_dir(book().join(folder)).expect("the book's folder") {
            let path = entry.expect("a file").path();
            if path.extension().is_some_and(|extension| extension == "md") {
                let name = path.file_name().unwrap().to_string_lossy().into_owned();
                let name = if folder.is_empty() { name } else { format!("{folder}/{name}") };
                found.push((name, fs::read_to_string(path).expect("text")));
            }
        }
    }
    found.sort();
    found
}

/// What the links of a text point to; not what stands in code, and not the web.
fn links(text: &str) -> Vec<String> {
    let mut targets = Vec::new();
    let mut code = false;
    for line in text.lines() {
        if line.starts_with("```") {
            code = !code;
        } else if !code {
            let after = line.split("](").skip(1);
            targets
                .extend(after.filter_map(|rest| rest.split_once(')')).map(|(target, _)| target.to_owned()));
        }
    }
    targets.retain(|target| !target.starts_with("http"));
    targets
}

/// The anchors of a chapter's headings, as mdBook makes them.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings =
        text.lines().filter_map(|line| line.strip_prefix('#')).map(|line| line.trim_start_matches('#'));
    headings
        .map(|heading| {
            let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
            kept.collect::<String>().to_lowercase().replace(' ', "-")
        })
        .collect()
}

#[test]
fn the_table_of_contents_names_every_chapter() {
    let chapters = chapters();
    let (_, summary) = chapters.iter().find(|(name, _)| name == "SUMMARY.md").expect("SUMMARY.md");
    let named: BTreeSet<String> = links(summary).into_iter().collect();
    let there: BTreeSet<String> =
        chapters.iter().map(|(name, _)| name.clone()).filter(|name| name != "SUMMARY.md").collect();
    assert_eq!(named, there);
}

#[test]
fn links_lead_somewhere() {
    for (name, text) in chapters() {
        let folder = book().join(&name).parent().expect("a folder").to_owned();
        for target in links(&text) {
            let (file, anchor) = target.split_once('#').unwrap_or((&target, ""));
            let path = if file.is_empty() { book().join(&name) } else { folder.join(file) };
            assert!(path.exists(), "{name}: {target} is not there");
            if !anchor.is_empty() {
                let text = fs::read_to_string(path).expect("text");
                assert!(anchors(&text).contains(anchor), "{name}: {target} has no such heading");
            }
        }
    }
}

#[test]
fn every_joint_has_a_small_drawing() {
    for (name, text) in chapters() {
        let Some(joint) = name.strip_prefix("joints/") else { continue };
        let drawing = format!("../img/{}", joint.replace(".md", ".svg"));
        if joint != "null.md" {
            assert!(links(&text).contains(&drawing), "{name} shows no {drawing}");
            let size = fs::metadata(book().join("joints").join(drawing)).expect("a drawing").len();
            assert!(size < 10_000, "{name}: {size} bytes");
        }
    }
}

#[test]
fn the_code_of_every_chapter_is_tested() {
    let listed = include_str!("../src/book.rs");
    let scene = include_str!("../../ferrode-scene/src/lib.rs");
    for (name, text) in chapters() {
        let tested =
            listed.contains(&format!("\"{name}\"")) || scene.contains(&format!("docs/book/{name}\""));
        assert!(tested || !text.contains("```rust"), "{name} has code, but no test compiles it");
        for skipped in ["```rust,ignore", "```rust,no_run", "```ignore"] {
            assert!(!text.contains(skipped), "{name} has code that is not run");
        }
    }
}
