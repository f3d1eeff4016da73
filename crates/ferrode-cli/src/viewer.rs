//! Starts `ferrode-view`, the program that makes pictures, as git starts its commands: found beside this one or on the path.

use crate::exit::{Exit, Failure};
use std::ffi::OsStr;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::Command;

const NAME: &str = "ferrode-view";

/// Runs the viewer with the given arguments and waits for its end.
///
/// # Errors
/// [`Exit::Usage`] if it is not installed; the viewer's own exit code if it fails, which has told why.
pub fn start<'a>(arguments: impl IntoIterator<Item = &'a OsStr>) -> Result<(), Failure> {
    let arguments: Vec<&OsStr> = arguments.into_iter().collect();
    let mut command = Command::new(program());
    command.args(&arguments);
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // Without it, as on servers, Mesa's layer that puts devices in order looks for Wayland and prints errors that are none.
        command.env("NODEVICE_SELECT", "1");
    }
    let status = match command.status() {
        Ok(status) => status,
        Err(error) if error.kind() == ErrorKind::NotFound => {
            let without = match arguments[..] {
                [command, name, ..] if command == "demo" => {
                    format!("; without pictures: `ferrode demo {} --headless`", name.to_string_lossy())
                }
                _ => String::new(),
            };
            return Err(Failure::usage(format!(
                "{NAME} is not installed, and pictures need it: `cargo install {NAME}`, or `cargo build --release -p {NAME}` \
                 here{without}"
            )));
        }
        Err(error) => return Err(Failure::usage(format!("{NAME} cannot be started: {error}"))),
    };
    let exit = match status.code() {
        Some(0) => return Ok(()),
        Some(1) => Exit::NotFinite,
        Some(2) => Exit::Usage,
        Some(4) => Exit::Output,
        _ => Exit::BadFile,
    };
    Err(Failure { exit, message: String::new() })
}

/// Beside this program if it is there, else on the path.
fn program() -> PathBuf {
    let file = format!("{NAME}{}", std::env::consts::EXE_SUFFIX);
    let beside = std::env::current_exe().ok().map(|own| own.with_file_name(&file));
    beside.filter(|path| path.is_file()).unwrap_or_else(|| PathBuf::from(file))
}
