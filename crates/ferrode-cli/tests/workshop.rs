//! `worlds/workshop.sdf` does what a workshop does.
// Formulas to compare with may differ in the last bit.
#![allow(clippy::disallowed_methods)]

mod common;

use common::{Table, recorded, world};

/// One run serves all tests here.
fn run() -> &'static (Table, serde_json::Value) {
    static RUN: std::sync::OnceLock<(Table, serde_json::Value)> = std::sync::OnceLock::new();
    RUN.get_or_init(|| recorded(&world("workshop.sdf"), "workshop.csv", &["--every", "50"]))
}

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found}, expected {expected} ± {tolerance}");
}

#[test]
fn the_file_is_read_without_a_warning() {
    let (_, summary) = run();
    assert_eq!((summary["warnings"].as_u64(), summary["quarantined"].as_u64()), (Some(0), Some(0)));
    assert_eq!((summary["bodies"].as_u64(), summary["joints"].as_u64()), (Some(76), Some(11)));
    assert!(summary["joint_error_max_m"].as_f64().unwrap() < 5e-4);
}

#[test]
fn the_cart_turns_left_on_its_springs() {
    let (table, _) = run();
    let chassis = |part: &str| table.column(&format!("link.cart::chassis.{part}"));
    let (time, x, y, z) = (table.column("time[s]"), chassis("x[m]"), chassis("y[m]"), chassis("z[m]"));
    let end = time.len() - 1;
    // It stands level, sunk by its weight on four springs of 20 kN/m and on eight tyre contacts of 200 kN/m.
    let sag = 140.0 * 9.81 / 4.0 / 20e3 + 168.0 * 9.81 / 8.0 / 200e3;
    close(z[end], 0.4 - sag, 1e-3);
    let tilt = |row: usize| 2.0 * chassis("qx")[row].hypot(chassis("qy")[row]);
    assert!(tilt(end) < 0.005, "{}", tilt(end));
    // Forward, then left, at a metre a second on a circle of 6 m about the middle of the rear axle.
    assert!(x[end] > 3.5 && y[end] > 1.5, "{} {}", x[end], y[end]);
    let speed = chassis("vx[m/s]")[end].hypot(chassis("vy[m/s]")[end]);
    close(speed, 1.0, 0.05);
    close(speed / chassis("wz[rad/s]")[end], 6.0, 0.3);
    for wheel in ["rear_left", "rear_right"] {
        let rate = table.last(&format!("joint.cart::{wheel}.velocity2[rad/s]"));
        close(rate, if wheel == "rear_left" { 3.7 } else { 4.3 }, 0.1);
        assert!(table.last(&format!("joint.cart::{wheel}.position1[rad]")).abs() < 0.01, "not steered");
    }
    close(table.last("joint.cart::front_left.position1[rad]"), 0.213, 0.02);
    // The cable duct is felt, by tilt and height.
    let on_duct = (0..=end).filter(|row| tilt(*row) > 0.01 && z[*row] > 0.385).count();
    assert!(on_duct > 0);
}

#[test]
fn the_arm_holds_its_load() {
    let (table, _) = run();
    for joint in ["yaw", "lift", "elbow", "roll", "bend", "twist"] {
        for angle in table.column(&format!("joint.arm::{joint}.position[rad]")) {
            assert!(angle.abs() < 0.01, "{joint}: {angle}");
        }
    }
    // The lift gives way by the torque of what hangs on it, over its servo's stiffness.
    let mut torque = 0.0;
    for (link, mass) in [("upper_arm", 9.0), ("forearm", 5.0), ("wrist", 2.0), ("hand", 2.0), ("load", 3.0)] {
        let at = |part: &str| table.last(&format!("link.arm::{link}.{part}[m]"));
        torque += mass * 9.81 * at("x").hypot(at("y") + 2.5);
    }
    let lift = table.column("joint.arm::lift.position[rad]");
    let mean = lift[20..].iter().sum::<f64>() / (lift.len() - 20) as f64;
    close(mean, torque / 20e3, 0.1 * torque / 20e3);
}

#[test]
fn the_heap_comes_to_rest_in_the_bin() {
    let (table, summary) = run();
    for part in 1..=64 {
        let prefix = format!("link.part_{part:02}::");
        let name = table.names.iter().find(|name| name.starts_with(&prefix)).unwrap();
        let link = name.strip_suffix(".x[m]").unwrap();
        let at = |column: &str| table.last(&format!("{link}.{column}"));
        assert!(at("x[m]").abs() < 0.6 && (at("y[m]") - 3.2).abs() < 0.6, "{link} is in the bin");
        assert!((0.05..0.75).contains(&at("z[m]")), "{link} at {}", at("z[m]"));
        let speed = at("vx[m/s]").hypot(at("vy[m/s]")).hypot(at("vz[m/s]"));
        assert!(speed < 0.03, "{link} moves at {speed} m/s");
    }
    // The speed is what tells rest. Not all fall asleep: a capsule that lies on a box has a single contact, as in ODE, and
    // rocks by some mm/s, which keeps its neighbours awake; how many depends on how the heap fell.
    assert!(summary["sleeping"].as_u64().unwrap() >= 16, "{}", summary["sleeping"]);
    assert!(summary["penetration_max_m"].as_f64().unwrap() < 0.02);
}
