//! `ferrode run`: simulates a world, and says how it went.

use crate::args::{RunArgs, stepper_name};
use crate::exit::{Exit, Failure};
use crate::progress::Progress;
use crate::record::Recorder;
use crate::simulation::Simulation;
use crate::stats::Stats;
use crate::summary::Summary;
use ferrode::{ImpactLaw, Stepper, World};
use ferrode_scene::Warning;
use std::io::Write;
use std::time::Instant;

/// Does what `ferrode run` is asked for.
///
/// # Errors
/// The file is wrong or cannot be simulated, or a result cannot be written.
pub fn run(args: &RunArgs) -> Result<Exit, Failure> {
    let mut simulation = Simulation::new(&args.file, &args.setup)?;
    simulation.world_mut().set_threads(args.threads);
    if let Some(stepper) = args.stepper {
        simulation.world_mut().stepper = stepper;
    }
    set_direct(simulation.world_mut(), args)?;
    if !args.quiet {
        print_warnings(&simulation.warnings);
    }
    let steps = args.length.steps(simulation.step_size());
    let mut recorder = args.record.as_ref().map(|path| Recorder::create(path, &simulation)).transpose()?;
    if let Some(recorder) = &mut recorder {
        recorder.record(&simulation)?;
    }
    let label = args.file.file.file_name().unwrap_or_default().to_string_lossy();
    let progress = Progress::new(steps, &label, !args.quiet);
    let stats = simulate(&mut simulation, steps, progress, |simulation, step| match &mut recorder {
        Some(recorder) if step % args.every == 0 || step == steps => recorder.record(simulation),
        _ => Ok(()),
    })?;
    if let Some(recorder) = recorder {
        recorder.finish()?;
    }
    let summary =
        Summary::new(&args.file.file, &simulation, &stats, stepper_name(simulation.world().stepper));
    if args.json {
        print(&format!("{}\n", summary.to_json()))?;
    } else if !args.quiet {
        print(&summary.to_string())?;
    }
    if stats.is_finite() {
        return Ok(Exit::Success);
    }
    let names = simulation.quarantined();
    let who = if names.is_empty() { "a body".to_owned() } else { names.join(", ") };
    Err(Failure {
        exit: Exit::NotFinite,
        message: format!("error: the simulation did not stay finite: {who}"),
    })
}

/// Takes over the options that are for the stepper `direct` alone.
fn set_direct(world: &mut World, args: &RunArgs) -> Result<(), Failure> {
    let options = [("--project", args.project), ("--in-turn", args.in_turn)];
    let given = options.into_iter().find(|(_, given)| *given);
    if let Some((option, _)) = given.filter(|_| world.stepper != Stepper::Direct) {
        let name = stepper_name(world.stepper);
        return Err(Failure::usage(format_args!("{option} is for the stepper direct, not for {name}")));
    }
    let mut settings = *world.direct();
    settings.project_joints |= args.project;
    if args.in_turn {
        settings.impacts = ImpactLaw::InTurn;
    }
    world.set_direct(settings);
    Ok(())
}

/// Makes `steps` steps, and calls `after` after each with its number, from 1.
///
/// # Errors
/// Those of stepping, and of `after`.
pub fn simulate(
    simulation: &mut Simulation,
    steps: u64,
    mut progress: Progress,
    mut after: impl FnMut(&Simulation, u64) -> Result<(), Failure>,
) -> Result<Stats, Failure> {
    let mut stats = Stats::start(simulation, steps);
    for number in 1..=steps {
        let start = Instant::now();
        let step = simulation.step()?;
        stats.see(simulation, &step, start.elapsed());
        progress.update(number, stats.time);
        after(simulation, number)?;
    }
    stats.finish(simulation);
    Ok(stats)
}

/// Writes the first warnings to standard error; `ferrode check` lists all.
pub fn print_warnings(warnings: &[Warning]) {
    const MOST: usize = 10;
    for warning in warnings.iter().take(MOST) {
        eprintln!("{warning}");
    }
    if warnings.len() > MOST {
        eprintln!("and {} more: see `ferrode check`", warnings.len() - MOST);
    }
}

/// Writes to standard output.
///
/// # Errors
/// It cannot be written to.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(|error| Failure::output("standard output", &error))
}
