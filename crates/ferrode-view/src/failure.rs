//! Why the command stopped, and the code that it exits with: those of `ferrode` itself.

use std::fmt;

/// What the exit code tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// The command line cannot be followed.
    Usage = 2,
    /// A file cannot be read, is wrong, or cannot be simulated.
    File = 3,
    /// The result cannot be shown or written: no display, no driver, no room.
    Output = 4,
}

/// Why the command stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// The code to exit with.
    pub exit: Exit,
    /// One line, or the loader's report.
    pub message: String,
}

impl Failure {
    /// A command line that cannot be followed.
    pub fn usage(message: impl fmt::Display) -> Self {
        Self { exit: Exit::Usage, message: message.to_string() }
    }

    /// A file that is wrong or cannot be simulated.
    pub fn file(message: impl fmt::Display) -> Self {
        Self { exit: Exit::File, message: message.to_string() }
    }

    /// A result that cannot be shown or written.
    pub fn output(message: impl fmt::Display) -> Self {
        Self { exit: Exit::Output, message: message.to_string() }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}
