#![forbid(unsafe_code)]
//! The `ferrode-view` command: shows worlds in a window, and draws pictures and films of them.

use ferrode_view::args::{self, Task};
use ferrode_view::failure::Failure;
use ferrode_view::{gallery, render_command, window};
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    let task = match args::parse(std::env::args_os()) {
        Ok(task) => task,
        Err(error) => {
            // To standard output for help and version, to standard error for mistakes; nobody to tell if that fails.
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    let result = match task {
        Task::Render(args) => render_command::render(&args),
        Task::View(args) => window::view(&args),
        Task::Gallery(docs) => gallery::draw_all(&docs),
        // A reader that has seen enough closes the pipe.
        Task::List => {
            let _ = std::io::stdout().write_all(ferrode_demos::list().as_bytes());
            Ok(())
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure { exit, message }) => {
            // The loader's reports begin with "error" themselves.
            let told = message.starts_with("error");
            eprintln!("{}{message}", if told { "" } else { "error: " });
            ExitCode::from(exit as u8)
        }
    }
}
