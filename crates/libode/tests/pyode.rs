//! Debian's `python3-pyode`, as it is installed, on libode and on this library: Python programs over all that it binds print
//! the same, trajectories included.
//!
//! Needs `python3-pyode`; without it the test says so and does nothing.

mod support;

use std::path::Path;
use std::process::Command;
use support::{build_folder, differences, here, link_library, scratch, skip};

/// Numbers agree to this, relative to numbers above 1.
const TOLERANCE: f64 = 1e-9;
/// Debian's interpreter: its modules are not for others.
const PYTHON: &str = "/usr/bin/python3";

fn python(library: Option<&Path>) -> Command {
    let mut command = Command::new(PYTHON);
    command
        .current_dir(here().join("tests/python"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env_remove("LD_LIBRARY_PATH");
    if let Some(library) = library {
        command.env("LD_LIBRARY_PATH", library);
    }
    command
}

#[test]
fn pyode_programs_print_the_same() {
    let there = python(None).args(["-c", "import ode"]).output().is_ok_and(|output| output.status.success());
    if !there {
        return skip("no pyode (apt install python3-pyode)");
    }
    let folder = scratch("pyode");
    link_library(&build_folder().join("libode.so"), &folder);
    let mut faults = Vec::new();
    for name in ["bodies", "joints", "geoms", "piles"] {
        let run = |library: Option<&Path>| {
            let output = python(library).arg(format!("{name}.py")).output().expect("Python starts");
            let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
            (text(&output.stdout), text(&output.stderr), output.status)
        };
        // How libode ends does not count: it does not bear the order in which Python lets things go.
        let (theirs, _, _) = run(None);
        let (ours, errors, status) = run(Some(&folder));
        assert!(status.success(), "{name}.py ends with {status}:\n{errors}");
        assert!(theirs.lines().count() > 100, "{name}.py prints little on libode:\n{theirs}");
        faults.extend(differences(name, &theirs, &ours, TOLERANCE));
    }
    assert!(faults.is_empty(), "{} lines differ:\n{}", faults.len(), faults.join("\n"));
}
