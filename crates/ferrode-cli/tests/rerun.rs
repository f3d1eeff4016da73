//! Recordings for Rerun say what rows say. Needs the feature `rerun`, whose packages take minutes to compile:
//! `cargo test -p ferrode-cli --features rerun --test rerun`.
#![cfg(feature = "rerun")]

use rerun::external::re_log_encoding::DecoderApp;
use rerun::log::{Chunk, LogMsg};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::process::Command;

/// The last vectors of a component of each entity, and in how many rows it came.
fn last(chunks: &[Chunk], component: &'static str) -> BTreeMap<String, (Vec<[f32; 3]>, usize)> {
    let mut found = BTreeMap::new();
    for chunk in chunks {
        let entry = found.entry(chunk.entity_path().to_string()).or_insert((Vec::new(), 0));
        for values in chunk.iter_slices::<[f32; 3]>(component.into()) {
            *entry = (values.to_vec(), entry.1 + 1);
        }
    }
    found.retain(|_, entry| entry.1 > 0);
    found
}

#[test]
fn a_recording_holds_the_poses_of_the_rows() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let world = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../worlds/workshop.sdf");
    let record = |name: &str| {
        let file = folder.join(name);
        let run = Command::new(env!("CARGO_BIN_EXE_ferrode"))
            .arg("run")
            .arg(&world)
            .args(["--time", "0.2", "--every", "50", "--quiet", "--record"])
            .arg(&file)
            .output()
            .expect("ferrode starts");
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        file
    };
    let rows = std::fs::read_to_string(record("rerun.jsonl")).expect("rows");
    let rows: Vec<serde_json::Value> =
        rows.lines().map(|row| serde_json::from_str(row).expect("JSON")).collect();
    let file = BufReader::new(File::open(record("rerun.rrd")).expect("a recording"));
    let chunks: Vec<Chunk> = DecoderApp::decode_eager(file)
        .expect("the head of a recording")
        .filter_map(|message| match message.expect("a message") {
            LogMsg::ArrowMsg(_, message) => Some(Chunk::from_arrow_msg(&message).expect("a chunk")),
            _ => None,
        })
        .collect();

    let places = last(&chunks, "Transform3D:translation");
    let end = rows.last().expect("a row").as_object().expect("an object");
    let mut links = 0;
    for (name, x) in end {
        let Some(link) = name.strip_prefix("link.").and_then(|name| name.strip_suffix(".x[m]")) else {
            continue;
        };
        let (place, count) = &places[&format!("/world/links/{}", link.replace("::", "\\:\\:"))];
        assert_eq!(*count, rows.len(), "{link}");
        let y = &end[&format!("link.{link}.y[m]")];
        let z = &end[&format!("link.{link}.z[m]")];
        let wanted = [x, y, z].map(|v| v.as_f64().expect("a number") as f32);
        assert_eq!(place.as_slice(), [wanted], "{link}");
        links += 1;
    }
    assert_eq!(links, 76);
    let boxes = last(&chunks, "Boxes3D:half_sizes");
    assert!(boxes.len() > 20, "{}", boxes.len());
    let forces = last(&chunks, "Arrows3D:vectors");
    let contacts = end["contacts"].as_f64().expect("a number") as usize;
    assert_eq!(forces["/world/contacts"].0.len(), contacts);
    assert!(contacts > 10);
}
