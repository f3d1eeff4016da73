//! `ferrode demo`: the gallery.

use crate::args::DemoArgs;
use crate::exit::{Exit, Failure};
use crate::run::print;
use ferrode_demos::{ALL, Demo, list};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Does what `ferrode demo` is asked for, without pictures.
///
/// # Errors
/// A name that no demo has, or one whose property does not hold.
pub fn demo(args: &DemoArgs) -> Result<Exit, Failure> {
    let chosen = match &args.name {
        Some(name) => vec![find(name)?],
        None if args.all => ALL.to_vec(),
        None => {
            print(&list())?;
            return Ok(Exit::Success);
        }
    };
    run(&chosen)
}

fn find(name: &str) -> Result<&'static Demo, Failure> {
    ferrode_demos::find(name)
        .ok_or_else(|| Failure::usage(format!("no demo is called {name}; `ferrode demo` lists them")))
}

/// Runs demos without pictures, as many at once as there are processors, and prints what was measured on each as it ends.
fn run(demos: &[&Demo]) -> Result<Exit, Failure> {
    let workers = std::thread::available_parallelism().map_or(1, usize::from).min(demos.len());
    let (next, failed) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let start = Instant::now();
    let work = || -> Result<(), Failure> {
        while let Some(demo) = demos.get(next.fetch_add(1, Ordering::Relaxed)) {
            let start = Instant::now();
            let (word, found) = match demo.run() {
                Ok(found) => ("ok", found),
                Err(failure) => {
                    failed.fetch_add(1, Ordering::Relaxed);
                    ("FAILED", failure.to_string())
                }
            };
            let (name, about, property) = (demo.name, demo.about, demo.property);
            let seconds = start.elapsed().as_secs_f64();
            print(&format!("{name}: {about}\n  {property}\n  {word} in {seconds:.1} s: {found}\n"))?;
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        threads.into_iter().map(|thread| thread.join().unwrap_or(Ok(()))).collect::<Result<Vec<()>, _>>()
    })?;
    let failed = failed.into_inner();
    print(&format!(
        "\n{} of {} demos show their property ({:.0} s)\n",
        demos.len() - failed,
        demos.len(),
        start.elapsed().as_secs_f64()
    ))?;
    if failed == 0 {
        return Ok(Exit::Success);
    }
    Err(Failure {
        exit: Exit::NotFinite,
        message: format!("error: {failed} demos did not go as they should"),
    })
}
