//! Exit codes, and failures that carry one.

use std::fmt;

/// What the command tells its caller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// Done, and the simulation stayed finite.
    Success = 0,
    /// A body left the numbers: it was quarantined, or its state is not finite.
    NotFinite = 1,
    /// The command line cannot be followed.
    Usage = 2,
    /// The file cannot be read, is wrong, or cannot be simulated.
    BadFile = 3,
    /// A result cannot be written.
    Output = 4,
}

/// The exit codes as `--help` lists them.
pub const EXIT_CODES: &str = "\
Exit codes:
  0  done; the simulation stayed finite
  1  the simulation did not stay finite (a body was quarantined)
  2  the command line cannot be followed
  3  the file cannot be read, is wrong, or cannot be simulated
  4  a result cannot be written";

/// Why the command stopped.
#[derive(Debug)]
pub struct Failure {
    /// The code to exit with.
    pub exit: Exit,
    /// What to print on standard error; empty for nothing.
    pub message: String,
}

impl Failure {
    /// A command line that cannot be followed.
    pub fn usage(message: impl fmt::Display) -> Self {
        Self { exit: Exit::Usage, message: format!("error: {message}") }
    }

    /// A file that is wrong or cannot be simulated.
    pub fn file(message: impl fmt::Display) -> Self {
        Self { exit: Exit::BadFile, message: format!("error: {message}") }
    }

    /// A file's mistake, already told as a compiler tells it.
    pub fn told(report: impl fmt::Display) -> Self {
        Self { exit: Exit::BadFile, message: report.to_string() }
    }

    /// A result that cannot be written to `place`. A reader that has seen enough (`ferrode check … | head`) is no
    /// reason to complain.
    pub fn output(place: impl fmt::Display, error: &std::io::Error) -> Self {
        let message = match error.kind() {
            std::io::ErrorKind::BrokenPipe => String::new(),
            _ => format!("error: cannot write {place}: {error}"),
        };
        Self { exit: Exit::Output, message }
    }
}
