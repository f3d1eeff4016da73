//! `ferrode compare`: the same world with each stepper.

use crate::args::{CompareArgs, STEPPERS};
use crate::exit::{Exit, Failure};
use crate::json::Object;
use crate::progress::Progress;
use crate::run::{print, print_warnings, simulate};
use crate::simulation::Simulation;
use crate::stats::Stats;
use crate::summary::{metres, round, seconds};

/// Does what `ferrode compare` is asked for.
///
/// # Errors
/// The file is wrong or cannot be simulated, or the table cannot be written.
pub fn compare(args: &CompareArgs) -> Result<Exit, Failure> {
    let start = Simulation::new(&args.file, &args.setup)?;
    if !args.quiet {
        print_warnings(&start.warnings);
    }
    let steps = args.length.steps(start.step_size());
    let mut results = Vec::new();
    for (name, stepper) in STEPPERS {
        // A clone steps to the same bits as a world that was built anew, and the file is read once.
        let mut simulation = start.clone();
        simulation.world_mut().stepper = stepper;
        let progress = Progress::new(steps, name, !args.quiet);
        results.push((name, simulate(&mut simulation, steps, progress, |_, _| Ok(()))?));
    }
    let text = if args.json { lines(&results) } else { table(args, steps, start.step_size(), &results) };
    print(&text)?;
    let strayed: Vec<&str> =
        results.iter().filter(|(_, stats)| !stats.is_finite()).map(|(name, _)| *name).collect();
    if strayed.is_empty() {
        return Ok(Exit::Success);
    }
    let message = format!("error: the simulation did not stay finite with {}", strayed.join(", "));
    Err(Failure { exit: Exit::NotFinite, message })
}

/// A JSON object a stepper.
fn lines(results: &[(&'static str, Stats)]) -> String {
    let line = |(name, stats): &(&'static str, Stats)| {
        let object = Object::default()
            .with("stepper", *name)
            .with("finite", stats.is_finite())
            .with("step_time_median_s", stats.step_time_quantile(0.5))
            .with("step_time_p99_s", stats.step_time_quantile(0.99))
            .with("real_time_factor", stats.real_time_factor())
            .with("energy_start_J", stats.energy_start.total())
            .with("energy_end_J", stats.energy_end.total())
            .with("kinetic_energy_max_J", stats.max_kinetic)
            .with("energy_error_max_J", stats.energy_error.value)
            .with("joint_error_max_m", stats.joint_position_error.value)
            .with("joint_error_max_rad", stats.joint_angle_error.value)
            .with("penetration_max_m", stats.penetration.value)
            .with("contacts_mean", stats.contacts_mean())
            .with("quarantined", stats.quarantined)
            .with("solver_failures", stats.solver_failures);
        format!("{object}\n")
    };
    results.iter().map(line).collect()
}

/// A table with a column a stepper.
fn table(args: &CompareArgs, steps: u64, h: f64, results: &[(&'static str, Stats)]) -> String {
    type Cell = fn(&Stats) -> String;
    let rows: [(&str, Cell); 11] = [
        ("step time, median", |s| seconds(s.step_time_quantile(0.5))),
        ("step time, 99th percentile", |s| seconds(s.step_time_quantile(0.99))),
        ("real-time factor", |s| round(s.real_time_factor())),
        ("energy at end", |s| format!("{} J", round(s.energy_end.total()))),
        ("energy change", |s| format!("{} J", round(s.energy_change()))),
        ("largest kinetic energy", |s| format!("{} J", round(s.max_kinetic))),
        ("joint error", |s| metres(s.joint_position_error.value)),
        ("joint error, angle", |s| format!("{} rad", round(s.joint_angle_error.value))),
        ("penetration", |s| metres(s.penetration.value)),
        ("quarantined", |s| s.quarantined.to_string()),
        ("islands solved in part", |s| s.solver_failures.to_string()),
    ];
    let mut text = format!("{}: {steps} steps of {}\n\n", args.file.file.display(), seconds(h));
    let mut line = |name: &str, cells: Vec<String>| {
        let cells: String = cells.iter().map(|cell| format!("{cell:>16}")).collect();
        text += &format!("  {name:<28}{cells}\n");
    };
    line("", results.iter().map(|(name, _)| (*name).to_owned()).collect());
    for (name, cell) in rows {
        line(name, results.iter().map(|(_, stats)| cell(stats)).collect());
    }
    text
}
