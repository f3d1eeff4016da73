//! Worlds and robots that others made, from the folder that `FERRODE_WORLDS` names. Without it these tests say so, and
//! test nothing.
// Formulas to compare with may differ in the last bit.
#![allow(clippy::disallowed_methods)]

mod common;

use common::recorded;
use std::path::PathBuf;

fn folder() -> Option<PathBuf> {
    let folder = std::env::var_os("FERRODE_WORLDS").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("SKIPPED: FERRODE_WORLDS does not name a folder of worlds");
    }
    folder
}

#[test]
fn gazebo_worlds_stay_finite() {
    let Some(folder) = folder() else { return };
    let mut count = 0;
    for entry in std::fs::read_dir(folder.join("gazebo")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        // The 3,000 shapes take long to record: the release build is timed on them by hand.
        if path.extension().is_none_or(|extension| extension != "sdf") || name == "3k_shapes" {
            continue;
        }
        let (_, summary) =
            recorded(path.to_str().unwrap(), &format!("real_{name}.csv"), &["--every", "1000"]);
        assert_eq!(summary["quarantined"], 0, "{name}");
        count += 1;
    }
    assert!(count >= 9, "{count} worlds");
}

#[test]
fn shapes_rest_where_they_stand() {
    let Some(folder) = folder() else { return };
    let file = folder.join("gazebo/shapes.sdf");
    let (table, _) = recorded(file.to_str().unwrap(), "real_shapes_rest.csv", &[]);
    for shape in ["box", "cylinder", "sphere", "capsule"] {
        for axis in ["x", "y", "z"] {
            let column = table.column(&format!("link.{shape}::{shape}_link.{axis}[m]"));
            let most = column.iter().fold(0.0_f64, |most, value| most.max((value - column[0]).abs()));
            assert!(most < 1e-3, "{shape} has moved by {most} m along {axis}");
        }
    }
}

#[test]
fn the_double_pendulum_keeps_its_energy() {
    let Some(folder) = folder() else { return };
    let file = folder.join("gazebo/pendulum_links.sdf");
    let (_, summary) = recorded(file.to_str().unwrap(), "real_pendulum.csv", &["--every", "1000"]);
    let number = |name: &str| summary[name].as_f64().unwrap();
    assert!(number("energy_error_max_J") < 0.02 * number("kinetic_energy_max_J"), "{summary}");
    assert!(number("kinetic_energy_max_J") > 100.0);
}

#[test]
fn anymal_stands() {
    let Some(folder) = folder() else { return };
    let file = folder.join("robots/anymal/anymal.urdf");
    let options = ["--ground", "--hold", "--time", "10", "--every", "100"];
    let (table, _) = recorded(file.to_str().unwrap(), "real_anymal.csv", &options);
    let base = |part: &str| table.column(&format!("link.anymal::base.{part}"));
    assert!(base("z[m]").iter().all(|z| *z > 0.3));
    for (x, y) in base("qx").iter().zip(base("qy")) {
        // The cosine of the tilt is 1 − 2 (qx² + qy²).
        let tilt = (1.0 - 2.0 * (x * x + y * y)).acos().to_degrees();
        assert!(tilt < 10.0, "{tilt}°");
    }
}

#[test]
fn atlas_hangs() {
    let Some(folder) = folder() else { return };
    let file = folder.join("robots/atlas/robot.urdf");
    for stepper in ["quick", "direct"] {
        let options = ["--fix", "pelvis", "--time", "5", "--every", "100", "--stepper", stepper];
        let (_, summary) = recorded(file.to_str().unwrap(), "real_atlas.csv", &options);
        let error = summary["joint_error_max_m"].as_f64().unwrap();
        assert!(error < 1e-3, "{stepper}: {error}");
        assert_eq!(summary["joints"], 29);
    }
}
