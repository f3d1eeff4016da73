//! The worlds of `worlds/direct`, on which other solvers fail, with the exact stepper.

mod common;

use common::{Table, recorded, world};
use ferrode::math::real;

/// `worlds/direct/NAME.sdf`, run with options. The solver may not have failed.
fn run(name: &str, case: &str, options: &[&str]) -> (Table, serde_json::Value) {
    let file = world(&format!("direct/{name}.sdf"));
    let (table, summary) = recorded(&file, &format!("direct_{name}_{case}.csv"), options);
    assert_eq!(summary["solver_failures"], 0, "{name}");
    (table, summary)
}

/// The velocity components of all links at the end: the largest.
fn fastest(table: &Table) -> f64 {
    let last = table.rows.last().unwrap();
    let speeds = table.names.iter().zip(last).filter(|(name, _)| name.contains(".v") || name.contains(".w"));
    speeds.map(|(_, v)| v.abs()).fold(0.0, f64::max)
}

#[test]
fn stacks_come_to_rest() {
    for h in ["0.016666666666666666", "0.004166666666666667"] {
        for name in ["four_boxes", "tower", "mass_ratios", "table"] {
            let (table, _) = run(name, &h[2..6], &["--time", "10", "--dt", h]);
            assert!(table.names.iter().any(|n| n.contains(".vz")), "{:?}", table.names);
            let fastest = fastest(&table);
            assert!(fastest <= 1e-9, "{name} at {h}: {fastest} m/s");
        }
    }
}

#[test]
fn a_chain_carries_a_hundredfold_mass() {
    let (table, summary) = run("chain", "swing", &["--time", "5"]);
    let error = summary["joint_error_max_m"].as_f64().unwrap();
    assert!(error < 1e-3, "joints open by {error} m");
    // It swings from 5 degrees to about as far on the other side, and stays straight: the weight 4.1 m below the hook.
    let [x, z] = ["x[m]", "z[m]"].map(|c| table.column(&format!("link.weight::link.{c}")));
    let far = x.iter().fold(0.0_f64, |far, x| far.min(*x));
    assert!((far + 4.1 * real::sin(5.0_f64.to_radians())).abs() < 0.02, "{far}");
    for (x, z) in x.iter().zip(&z) {
        assert!(((x * x + (5.0 - z) * (5.0 - z)).sqrt() - 4.1).abs() < 0.01, "{x} {z}");
    }
}

/// Speeds of the cradle's balls along x, before and after the first impact.
fn cradle(case: &str, options: &[&str]) -> [Vec<f64>; 2] {
    let (table, summary) = run("cradle", case, &[&["--time", "0.7"], options].concat());
    assert!(summary["penetration_max_m"].as_f64().unwrap() < 1e-3);
    let ball = |i: usize| table.column(&format!("link.ball_{i}::link.vx[m/s]"));
    let balls: Vec<Vec<f64>> = (1..=5).map(ball).collect();
    let impact = balls[4].iter().position(|v| *v > 0.1).unwrap();
    [impact - 1, impact].map(|step| balls.iter().map(|ball| ball[step]).collect())
}

#[test]
fn a_cradle_collides_all_at_once_or_in_turn() {
    // From 30 degrees on a string of 1 m.
    let speed = (2.0 * 9.81 * (1.0 - real::cos(30.0_f64.to_radians()))).sqrt();
    let cases: [(&str, &[&str], [f64; 5]); 2] = [
        ("together", &[], [-0.6, 0.4, 0.4, 0.4, 0.4]),
        ("in_turn", &["--in-turn"], [0.0, 0.0, 0.0, 0.0, 1.0]),
    ];
    for (case, options, expected) in cases {
        let [before, after] = cradle(case, options);
        assert!((before[0] - speed).abs() < 0.01 * speed, "{before:?}, expected {speed} m/s");
        for (v, part) in after.iter().zip(expected) {
            assert!((v - part * speed).abs() < 0.01 * speed, "{case}: {after:?}");
        }
    }
}
