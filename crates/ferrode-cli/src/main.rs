#![forbid(unsafe_code)]
//! The `ferrode` command: simulates SDF worlds and URDF robots, checks them, compares steppers on them, and
//! shows a gallery of scenes.

mod args;
mod check;
mod compare;
mod demo;
mod exit;
mod hold;
mod json;
mod progress;
mod record;
#[cfg(feature = "rerun")]
mod rrd;
mod run;
mod simulation;
mod stats;
mod summary;
mod version;
mod viewer;

use exit::{Exit, Failure};
use std::process::ExitCode;

fn main() -> ExitCode {
    let task = match args::parse(std::env::args_os()) {
        Ok(task) => task,
        Err(error) => {
            // To standard output for help and version, to standard error for mistakes; nobody to tell if that fails.
            let _ = error.print();
            return if error.use_stderr() { ExitCode::from(Exit::Usage as u8) } else { ExitCode::SUCCESS };
        }
    };
    let result = match &task {
        args::Task::Run(args) => run::run(args),
        args::Task::Check(args) => check::check(args),
        args::Task::Compare(args) => compare::compare(args),
        args::Task::Viewer(name, arguments) => {
            let arguments = arguments.iter().map(std::ffi::OsString::as_os_str);
            viewer::start(std::iter::once(std::ffi::OsStr::new(name)).chain(arguments))
                .map(|()| Exit::Success)
        }
        args::Task::Demo(args) => demo::demo(args),
    };
    let exit = result.unwrap_or_else(|Failure { exit, message }| {
        if !message.is_empty() {
            eprintln!("{message}");
        }
        exit
    });
    ExitCode::from(exit as u8)
}
