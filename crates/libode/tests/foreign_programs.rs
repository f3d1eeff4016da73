//! Debian's OMPL and DART, as they are installed, with their ODE parts on libode and on this library: the same states.
//!
//! Needs `libompl-dev`, `libdart-collision-ode-dev` and `libdart-external-ikfast-dev`; without them the tests say so and do
//! nothing.

mod support;

use std::path::Path;
use std::process::Command;
use support::{build_folder, differences, here, link_library, scratch, skip};

/// Runs one program on both libraries.
fn compare(name: &str, header: &str, flags: &[&str], tolerance: f64) {
    if !Path::new(header).exists() {
        return skip(&format!("no {header}"));
    }
    let folder = scratch(name);
    link_library(&build_folder().join("libode.so"), &folder);
    let program = folder.join(name);
    let source = here().join("tests/programs").join(format!("{name}.cpp"));
    let mut compiler = Command::new("c++");
    compiler.args(["-std=c++17", "-w", "-I/usr/include/eigen3", "-o"]).arg(&program).arg(&source).args(flags);
    let Ok(output) = compiler.output() else { return skip("no C++ compiler") };
    assert!(output.status.success(), "{name}:\n{}", String::from_utf8_lossy(&output.stderr));
    let run = |library: Option<&Path>| {
        let mut command = Command::new(&program);
        command.env_remove("LD_LIBRARY_PATH");
        if let Some(library) = library {
            command.env("LD_LIBRARY_PATH", library);
        }
        let output = command.output().expect("the program starts");
        assert!(output.status.success(), "{name} ends with {}", output.status);
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let (theirs, ours) = (run(None), run(Some(&folder)));
    assert!(theirs.lines().count() >= 30, "{name} prints little:\n{theirs}");
    let faults = differences(name, &theirs, &ours, tolerance);
    assert!(faults.is_empty(), "{} lines differ:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn ompl_propagates_the_same_states() {
    let flags = ["-I/usr/include/ompl-1.5", "-lompl", "-lode", "-lboost_serialization"];
    compare("ompl_ode", "/usr/include/ompl-1.5/ompl/extensions/ode/OpenDESimpleSetup.h", &flags, 1e-9);
}

fn compare_dart(name: &str) {
    if !Path::new("/usr/include/dart/external/ikfast/ikfast.h").exists() {
        return skip("no libdart-external-ikfast-dev");
    }
    let flags = ["-ldart", "-ldart-collision-ode", "-lode", "-lassimp", "-lfcl", "-lccd"];
    compare(name, "/usr/include/dart/collision/ode/ode.hpp", &flags, 1e-9);
}

#[test]
fn dart_finds_the_same_contacts() {
    compare_dart("dart_ode");
}

/// 1,000 steps of an arm that sweeps a table.
#[test]
fn dart_steps_the_same_robot() {
    compare_dart("dart_robot");
}
