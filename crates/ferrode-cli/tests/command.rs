//! The command as its users have it: exit codes, what is printed where, recordings.
// Formulas to compare with may differ in the last bit.
#![allow(clippy::disallowed_methods)]

mod common;

use common::{Table, data, edited, ferrode, scratch};

#[test]
fn help_and_version_are_worth_reading() {
    for line in [vec!["--help"], vec!["help"], vec!["run", "--help"], vec!["compare", "-h"]] {
        let done = ferrode(&line);
        assert_eq!(done.code, 0, "{line:?}");
        assert!(done.out.contains("Usage: ferrode"), "{}", done.out);
        assert!(done.out.contains("Exit codes:"), "{line:?} tells the exit codes");
        assert!(done.err.is_empty());
    }
    let version = ferrode(&["--version"]).out;
    for word in [env!("CARGO_PKG_VERSION"), "precision: double", "SIMD:", "threads:"] {
        assert!(version.contains(word), "{word} in {version}");
    }
    assert_eq!(ferrode(&["-V"]).out.trim(), concat!("ferrode ", env!("CARGO_PKG_VERSION")));
}

#[test]
fn mistakes_have_codes_of_their_own() {
    let arm = data("arm.sdf");
    let no_folder = scratch("no such folder").join("out.csv");
    let broken = edited("box.sdf", "broken.sdf", "<mass>3</mass>", "<mass>-3</mass>");
    let cases: [(&[&str], i32, &str); 8] = [
        (&["fly"], 2, "fly"),
        (&["run", &arm, "--dt", "0"], 2, "--dt"),
        (&["run", &arm, "--fix", "leg"], 2, "leg"),
        (&["run", &data("box.sdf"), "--hold", "1,1"], 2, "--hold"),
        (&["run", "no such file.sdf"], 3, "no such file.sdf"),
        (&["run", &broken], 3, "broken.sdf:7:"),
        (&["check", &broken], 3, "mass"),
        (&["run", &arm, "--record", no_folder.to_str().unwrap()], 4, "out.csv"),
    ];
    for (line, code, word) in cases {
        let done = ferrode(line);
        assert_eq!(done.code, code, "{line:?}: {}", done.err);
        assert!(done.err.contains(word), "{line:?}: {}", done.err);
        assert_eq!(done.out, "", "{line:?}");
    }
}

#[test]
fn a_world_that_leaves_the_numbers_is_told() {
    // 1e308 m/s² on 2 kg is more newtons than there are.
    let file = edited("arm.sdf", "heavy.sdf", "0 0 -9.81", "0 0 -1e308");
    let done = ferrode(&["run", &file, "--steps", "3"]);
    assert_eq!(done.code, 1, "{}{}", done.out, done.err);
    assert!(done.err.contains("did not stay finite: arm::bar"), "{}", done.err);
    assert!(done.out.contains("quarantined       1 body: arm::bar"), "{}", done.out);
    assert_eq!(ferrode(&["run", &file, "--steps", "3", "--quiet"]).code, 1);
    let compared = ferrode(&["compare", &file, "--steps", "3"]);
    assert_eq!(compared.code, 1);
    assert!(compared.err.contains("with direct, quick"), "{}", compared.err);
}

#[test]
fn strict_makes_warnings_errors() {
    let file = edited("box.sdf", "odd.sdf", "<mass>3</mass>", "<mass>3</mass><masss>3</masss>");
    let done = ferrode(&["run", &file, "--steps", "1"]);
    assert_eq!(done.code, 0);
    assert!(
        done.err.contains("masss") && done.out.contains("warnings          1\n"),
        "{}{}",
        done.err,
        done.out
    );
    let done = ferrode(&["run", &file, "--steps", "1", "--strict"]);
    assert_eq!((done.code, done.out.as_str()), (3, ""));
    assert!(done.err.contains("masss"), "{}", done.err);
    assert_eq!(ferrode(&["check", &file, "--strict"]).code, 3);
}

#[test]
fn the_summary_has_every_figure() {
    let done = ferrode(&["run", &data("arm.sdf"), "--time", "0.5"]);
    assert_eq!(done.code, 0, "{}", done.err);
    for name in [
        "bodies            1 that move",
        "joints            1",
        "geoms             0",
        "contacts          0.0 mean, 0 max",
        "step time",
        "99th percentile",
        "real-time factor",
        "energy",
        "penetration       none",
        "joint error",
        "arm::shoulder",
        "sleeping          0 bodies",
        "quarantined       0 bodies",
        "warnings          0",
        "0.5 s in 500 steps of 1 ms, stepper direct",
    ] {
        assert!(done.out.contains(name), "{name} in {}", done.out);
    }
    let quick = ferrode(&["run", &data("arm.sdf"), "--steps", "5", "--stepper", "quick"]);
    assert!(quick.out.contains("stepper quick"));
    let projected = ferrode(&["run", &data("arm.sdf"), "--steps", "5", "--project"]);
    assert!(projected.out.contains("stepper direct"), "{}", projected.err);
    let wrong = ferrode(&["run", &data("arm.sdf"), "--steps", "5", "--stepper", "quick", "--project"]);
    assert_eq!(wrong.code, 2);
    assert!(wrong.err.contains("--project is for the stepper direct, not for quick"), "{}", wrong.err);
    // A file that says nothing of a solver is stepped with Quick.
    assert!(
        ferrode(&["run", &data("box.sdf"), "--steps", "0"])
            .out
            .contains("0 s in 0 steps of 1 ms, stepper quick")
    );
}

#[test]
fn nothing_piped_has_escape_codes() {
    let arm = data("arm.sdf");
    for line in [
        vec!["run", &arm, "--time", "0.1"],
        vec!["run", &arm, "--dt", "x"],
        vec!["check", &arm],
        vec!["compare", &arm, "--time", "0.1"],
        vec!["--help"],
        vec![],
    ] {
        let done = ferrode(&line);
        assert!(!done.out.contains('\x1b') && !done.err.contains('\x1b'), "{line:?}");
        assert!(!done.out.contains('\r') && !done.err.contains('\r'), "{line:?}: a progress bar");
    }
}

#[test]
fn quiet_is_quiet() {
    let done = ferrode(&["run", &data("arm.sdf"), "--time", "0.1", "--quiet"]);
    assert_eq!((done.code, done.out.as_str(), done.err.as_str()), (0, "", ""));
}

#[test]
fn json_tells_what_the_summary_tells() {
    let done = ferrode(&["run", &data("arm.sdf"), "--time", "0.3", "--json", "--quiet"]);
    let value: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    assert_eq!(value["steps"], 300);
    assert_eq!(value["finite"], true);
    assert_eq!(value["stepper"], "direct");
    assert_eq!((value["bodies"].as_u64(), value["joints"].as_u64()), (Some(1), Some(1)));
    let number = |name: &str| value[name].as_f64().unwrap_or_else(|| panic!("{name} in {value}"));
    // m g z at the start, 2 kg a metre up; a free pendulum keeps its energy.
    assert!((number("energy_start_J") - 2.0 * 9.81).abs() < 1e-9);
    assert!(
        (number("energy_end_J") - number("energy_start_J")).abs() < 0.02 * number("kinetic_energy_max_J")
    );
    assert!(number("kinetic_energy_max_J") > 1.0);
    assert!(number("joint_error_max_m") < 1e-4);
    assert!(number("step_time_p99_s") >= number("step_time_median_s"));
    assert!(number("real_time_factor") > 0.0);
}

#[test]
fn recordings_name_links_and_joints_with_units() {
    let out = scratch("arm.csv");
    let out_text = out.to_str().unwrap();
    let line = ["run", &data("arm.sdf"), "--steps", "105", "--every", "10", "--record", out_text, "--quiet"];
    assert_eq!(ferrode(&line).code, 0);
    let text = std::fs::read_to_string(&out).unwrap();
    let table = Table::from_csv(&text);
    // At 0, 10 … 100, and the last one.
    let times = table.column("time[s]");
    assert_eq!(times.len(), 12);
    assert!((times[1] - 0.01).abs() < 1e-12 && (times[11] - 0.105).abs() < 1e-12, "{times:?}");
    let angle = table.column("joint.arm::shoulder.position[rad]");
    let rate = table.column("joint.arm::shoulder.velocity[rad/s]");
    let x = table.column("link.arm::bar.x[m]");
    let z = table.column("link.arm::bar.z[m]");
    let w = table.column("link.arm::bar.wy[rad/s]");
    let (qw, qy) = (table.column("link.arm::bar.qw"), table.column("link.arm::bar.qy"));
    assert_eq!(angle[0], 0.0);
    assert!(angle[11] > 0.05, "about +y, the bar's tip falls as the angle grows: {}", angle[11]);
    for row in 0..12 {
        assert!((x[row] - 0.5 * angle[row].cos()).abs() < 1e-5, "row {row}");
        assert!((z[row] - (1.0 - 0.5 * angle[row].sin())).abs() < 1e-5, "row {row}");
        assert!((rate[row] - w[row]).abs() < 1e-9);
        assert!((2.0 * qy[row].atan2(qw[row]) - angle[row]).abs() < 1e-9);
    }
    for name in ["link.arm::bar.vz[m/s]", "energy.kinetic[J]", "energy.potential[J]", "contacts"] {
        assert_eq!(table.column(name).len(), 12);
    }

    let lines_out = scratch("arm.jsonl");
    let line = [
        "run",
        &data("arm.sdf"),
        "--steps",
        "105",
        "--every",
        "10",
        "--record",
        lines_out.to_str().unwrap(),
        "-q",
    ];
    assert_eq!(ferrode(&line).code, 0);
    let lines = Table::from_json_lines(&std::fs::read_to_string(&lines_out).unwrap());
    assert_eq!(lines, table, "both formats hold the same names and numbers");

    // And once more: the same bytes.
    assert_eq!(
        ferrode(&["run", &data("arm.sdf"), "--steps", "105", "--every", "10", "--record", out_text, "-q"])
            .code,
        0
    );
    assert_eq!(std::fs::read_to_string(&out).unwrap(), text);
}

#[test]
fn hold_is_a_spring_and_a_damper() {
    // At rest KP θ = m g l cos θ, here with m g l = 2 · 9.81 · 0.5 N m.
    let table = recorded("held.csv", &["--time", "3", "--hold", "100,5"]);
    let angle = *table.column("joint.arm::shoulder.position[rad]").last().unwrap();
    assert!((100.0 * angle - 9.81 * angle.cos()).abs() < 1e-3, "{angle}");
    // Any gains are stable, far beyond where an explicit law would blow up: KD h = 100 kg m² on 0.6.
    let table = recorded("stiff.csv", &["--time", "3", "--hold", "1e7,1e5"]);
    assert!(table.column("joint.arm::shoulder.position[rad]").iter().all(|angle| angle.abs() < 1e-5));
    // Undamped, the spring swings about its rest with the step's own (implicit) loss only.
    let table = recorded("swing.csv", &["--time", "0.3", "--hold", "100,0"]);
    let top = table.column("joint.arm::shoulder.position[rad]").into_iter().fold(0.0, f64::max);
    assert!((0.17..0.2).contains(&top), "twice the rest angle: {top}");
}

#[test]
fn hold_takes_no_more_than_the_effort() {
    let weak = edited(
        "arm.sdf",
        "weak.sdf",
        "<xyz>0 1 0</xyz>",
        "<xyz>0 1 0</xyz><limit><lower>-1.5</lower><upper>1.5</upper><effort>5</effort></limit>",
    );
    let out = scratch("weak.csv");
    let line = ["run", &weak, "--time", "0.2", "--hold", "1e6,1e3", "--record", out.to_str().unwrap(), "-q"];
    assert_eq!(ferrode(&line).code, 0);
    let table = Table::from_csv(&std::fs::read_to_string(&out).unwrap());
    // 5 of the 9.81 N m are held: I θ'' = 9.81 cos θ − 5 with I = 0.1 + 2 · 0.5² kg m².
    let angle = *table.column("joint.arm::shoulder.position[rad]").last().unwrap();
    let expected = 0.5 * (9.81 - 5.0) / 0.6 * 0.04;
    assert!((angle / expected - 1.0).abs() < 0.02, "{angle} for {expected}");
}

#[test]
fn fix_ground_and_height_change_the_world() {
    let z = |name: &str, options: &[&str]| {
        let table = recorded_of("box.sdf", name, options);
        let column = table.column("link.box::body.z[m]");
        (column[0], *column.last().unwrap())
    };
    let free = z("free.csv", &["--time", "1"]);
    assert!((free.1 - (0.5 - 9.8 / 2.0)).abs() < 0.01, "falls: {free:?}");
    let ground = z("ground.csv", &["--time", "1", "--ground"]);
    assert!((ground.1 - 0.5).abs() < 1e-3, "stands: {ground:?}");
    let high = z("high.csv", &["--time", "2", "--ground", "--height", "0.7"]);
    assert!((high.0 - 1.2).abs() < 1e-12 && (high.1 - 0.5).abs() < 1e-3, "falls and stands: {high:?}");
    let sunk = edited("box.sdf", "sunk.sdf", "0 0 0.5 0 0 0", "0 0 -3 0 0 0");
    let table = recorded_of(&sunk, "lifted.csv", &["--time", "1", "--ground"]);
    let column = table.column("link.box::body.z[m]");
    assert!(
        column.iter().all(|z| (z - 0.5).abs() < 1e-3),
        "is put on the ground it would start below: {column:?}"
    );
    let fixed = z("fixed.csv", &["--time", "1", "--fix", "body", "--height", "0.7"]);
    assert!((fixed.0 - 1.2).abs() < 1e-12 && (fixed.1 - 1.2).abs() < 1e-4, "hangs: {fixed:?}");
}

#[test]
fn check_prints_the_tree() {
    let done = ferrode(&["check", &data("arm.sdf")]);
    assert_eq!(done.code, 0);
    for line in [
        "world bench: gravity 0 0 -9.81 m/s², steps of 1 ms, stepper direct",
        "model arm at 0 0 0",
        "└─ shoulder [revolute] → arm::bar 2 kg",
    ] {
        assert!(done.out.contains(line), "{line} in {}", done.out);
    }
}

#[test]
fn compare_sets_steppers_side_by_side() {
    let done = ferrode(&["compare", &data("arm.sdf"), "--time", "0.2"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let head = done.out.lines().nth(2).unwrap();
    assert!(head.contains("direct") && head.contains("quick") && head.contains("substep"), "{}", done.out);
    for row in ["step time, median", "real-time factor", "energy change", "joint error", "penetration"] {
        assert!(done.out.contains(row), "{row} in {}", done.out);
    }
    let done = ferrode(&["compare", &data("arm.sdf"), "--time", "0.2", "--json", "-q"]);
    let lines: Vec<serde_json::Value> =
        done.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 3);
    assert!(lines.iter().all(|line| line["energy_error_max_J"].as_f64().unwrap() < 0.1));
}

fn recorded(name: &str, options: &[&str]) -> Table {
    recorded_of("arm.sdf", name, options)
}

fn recorded_of(file: &str, name: &str, options: &[&str]) -> Table {
    let (file, out) = (data(file), scratch(name));
    let mut line = vec!["run", &file, "--quiet", "--record", out.to_str().unwrap()];
    line.extend(options);
    let done = ferrode(&line);
    assert_eq!(done.code, 0, "{line:?}: {}", done.err);
    Table::from_csv(&std::fs::read_to_string(out).unwrap())
}

#[test]
fn models_are_found_where_options_and_environment_say() {
    let folder = scratch("models");
    std::fs::create_dir_all(folder.join("crate")).unwrap();
    std::fs::copy(data("box.sdf"), folder.join("crate/model.sdf")).unwrap();
    std::fs::write(
        folder.join("crate/model.config"),
        "<?xml version=\"1.0\"?><model><name>crate</name><sdf version=\"1.9\">model.sdf</sdf></model>",
    )
    .unwrap();
    let file = scratch("include.sdf");
    let text =
        "<sdf version=\"1.9\"><world name=\"w\"><include><uri>model://crate</uri></include></world></sdf>";
    std::fs::write(&file, text).unwrap();
    let file = file.to_str().unwrap();
    let lost = ferrode(&["run", file, "--steps", "1"]);
    assert!(lost.code == 3 && lost.err.contains("model://crate"), "{}{}", lost.out, lost.err);
    let one_body = "bodies            1 that move";
    let found = ferrode(&["run", file, "--steps", "1", "--model-path", folder.to_str().unwrap()]);
    assert!(found.code == 0 && found.out.contains(one_body), "{}{}", found.out, found.err);
    for variable in ["GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH"] {
        let found =
            common::ferrode_with(&["run", file, "--steps", "1"], &[(variable, folder.to_str().unwrap())]);
        assert!(found.code == 0 && found.out.contains(one_body), "{variable}: {}{}", found.out, found.err);
    }
}
