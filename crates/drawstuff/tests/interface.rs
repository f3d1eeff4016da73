//! The interface itself, by small programs without ODE: every function, the loop's life, what goes wrong.
//!
//! Needs a C compiler; without one the tests say so and do nothing.
#![cfg(target_os = "linux")]

mod support;

use std::path::PathBuf;
use std::process::Command;
use support::{compile, here, libraries, library, program, said, scratch, skip, succeed};

/// The names of functions in the header.
fn declared() -> Vec<String> {
    let header = std::fs::read_to_string(here().join("include/drawstuff/drawstuff.h")).expect("the header");
    let lines = header.lines().filter(|line| line.starts_with("DS_API "));
    let name = |line: &str| {
        let before = line.split('(').next().unwrap_or_default();
        before.split_whitespace().last().unwrap_or_default().to_owned()
    };
    let mut names: Vec<String> = lines.map(name).collect();
    names.sort();
    names
}

#[test]
fn what_the_header_declares_is_exported_and_nothing_else() {
    let Ok(output) =
        Command::new("nm").args(["-D", "--defined-only"]).arg(library("libdrawstuff.so")).output()
    else {
        return skip("no nm");
    };
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut exported: Vec<String> =
        text.lines().filter_map(|line| line.split_whitespace().nth(2)).map(str::to_owned).collect();
    exported.sort();
    assert_eq!(exported, declared());
    assert_eq!(exported.len(), 32);
    let needed = Command::new("readelf").arg("-d").arg(library("libdrawstuff.so")).output();
    if let Ok(needed) = needed {
        let text = String::from_utf8_lossy(&needed.stdout).into_owned();
        assert!(text.contains("libdrawstuff.so.0") && !text.contains("libode"), "{text}");
    }
}

fn built(name: &str) -> Option<(PathBuf, PathBuf, PathBuf)> {
    let folder = scratch(name);
    let libraries = libraries(&folder.join("lib"), false);
    let path = compile(&here().join("tests/c").join(format!("{name}.c")), &folder, &libraries)?;
    Some((path, libraries, folder))
}

#[test]
fn every_function_can_be_called() {
    let Some((path, libraries, folder)) = built("every_function") else { return };
    let text = std::fs::read_to_string(here().join("tests/c/every_function.c")).expect("the program");
    let missing: Vec<String> =
        declared().into_iter().filter(|name| !text.contains(&format!("{name}("))).collect();
    assert_eq!(missing, ["dsDebug", "dsError"], "these end the program; others are called");
    let mut command = program(&path, &libraries);
    command.env("DRAWSTUFF_HEADLESS", folder.join("out")).env("DRAWSTUFF_DUMP", "text");
    // p reaches the program; Ctrl-P pauses; Ctrl-O makes one frame; the program stops at q.
    command.env("DRAWSTUFF_KEYS", "1:p 2:^P 4:^O 6:^P 6:^V 8:q").env("DRAWSTUFF_STEP", "0.125");
    let printed = succeed(command.arg("-notex"));
    let lines: Vec<&str> = printed.lines().skip(1).collect();
    let wanted = [
        "start 2 0 1 180 0 0",
        "step 0 0.125",
        "command p",
        "step 0 0.125",
        "step 1 0.125",
        "step 1 0.125",
        "step 0 0.125",
        "step 1 0.125",
        "viewpoint: xyz {1.0000f, 2.0000f, 3.0000f}, hpr {40.0000f, -5.0000f, 0.0000f}",
        "step 0 0.125",
        "step 0 0.125",
        "command q",
        "step 0 0.125",
        "stop",
        "again 1 2 3 40 -5 0",
        // The second loop gets the same keys, but has no functions.
        "viewpoint: xyz {1.0000f, 2.0000f, 3.0000f}, hpr {40.0000f, -5.0000f, 0.0000f}",
        "end 1 2 3",
    ];
    // The second loop's own line comes between.
    let lines: Vec<&str> = lines.into_iter().filter(|line| !line.starts_with("drawstuff:")).collect();
    assert_eq!(lines, wanted, "{printed}");
    let calls = std::fs::read_to_string(folder.join("out/calls.txt")).expect("the calls");
    let first: Vec<&str> = calls.lines().collect();
    let all = [
        "frame 0",
        "view from 1.0 2.0 3.0 angles 40.0 -5.0 0.0",
        "box at 0.0 0.0 1.0 turn 1.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 1.0 sides 0.1 0.2 0.3 color 1.0 1.0 1.0 1.0 plain",
        "sphere at 0.0 0.0 1.0 turn 1.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 1.0 radius 0.5 color 1.0 0.5 0.25 1.0 wood",
        "cylinder at 0.0 0.0 1.0 turn 1.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 1.0 length 2.0 radius 0.5 color 1.0 0.5 0.25 0.5 checkered",
        "capsule at 0.0 0.0 1.0 turn 1.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 1.0 length 2.0 radius 0.5 color 1.0 0.5 0.25 0.5 checkered wire",
        "triangle at 0.0 0.0 1.0 turn 1.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 1.0 corners 0.0 0.0 0.0 1.0 0.0 0.0 0.0 1.0 0.0 color 1.0 0.5 0.25 0.5 ground wire",
        "line from 0.0 0.0 1.0 to 1.0 0.0 0.0 color 1.0 0.5 0.25 0.5 sky",
    ];
    assert_eq!(first[..all.len()], all, "{calls}");
    // Six frames of nine are not paused; both precisions draw the same.
    for (name, count) in [("box", 9 + 6), ("capsule", 9 + 6 * 3), ("triangles", 6 * 2), ("convex", 6 * 2)] {
        let start = format!("{name} ");
        assert_eq!(calls.lines().filter(|line| line.starts_with(&start)).count(), count, "{name}");
    }
    let second =
        std::fs::read_to_string(folder.join("out/loop-2/calls.txt")).expect("the second loop's calls");
    assert_eq!(second.lines().count(), 200, "a hundred frames with nothing in them");
}

#[test]
fn mistakes_end_the_program_with_a_line_that_names_them() {
    let Some((path, libraries, folder)) = built("mistakes") else { return };
    let run = |what: &str, variables: &[(&str, &str)]| {
        let mut command = program(&path, &libraries);
        command.arg(what).envs(variables.iter().copied());
        let output = command.output().expect("the program starts");
        (output.status.code(), said(&output))
    };
    let out = folder.join("out");
    let headless = [("DRAWSTUFF_HEADLESS", out.to_str().expect("a path")), ("DRAWSTUFF_DUMP", "text")];
    // Those of the program abort (no exit code), for a debugger.
    for (what, line) in [
        ("version", "drawstuff: wrong use: dsFunctions.version is 1, not DS_VERSION 2 in dsSimulationLoop()"),
        ("null", "drawstuff: wrong use: a null pointer in dsDrawBox()"),
        ("polygon", "drawstuff: wrong use: a polygon's corner 7, of 3 points, in dsDrawConvex()"),
        ("nested", "drawstuff: wrong use: a second loop inside the first in dsSimulationLoop()"),
        ("debug", "drawstuff: wrong use: number 7"),
    ] {
        let (code, text) = run(what, &headless);
        assert!(code.is_none() && text.contains(line), "{what}: {code:?} {text}");
    }
    // Those of the machine, or the user, exit.
    let (code, text) = run("error", &headless);
    assert!(code == Some(1) && text.contains("drawstuff: error: number 7"), "{code:?} {text}");
    let (code, text) = run("nothing", &[]);
    assert!(code == Some(1) && text.contains("DRAWSTUFF_HEADLESS=FOLDER"), "{code:?} {text}");
    let (code, text) = run("nothing", &[headless[0], ("DRAWSTUFF_FRAMES", "few")]);
    assert!(code == Some(1) && text.contains("DRAWSTUFF_FRAMES=few"), "{code:?} {text}");
    let (code, text) = run("nothing", &[("DRAWSTUFF_HEADLESS", "/dev/null/out")]);
    assert!(code == Some(1) && text.contains("/dev/null/out"), "{code:?} {text}");
    // Drawing outside of a frame is said once, and does no harm; leaving by longjmp does none either.
    let (code, text) = run("outside", &headless);
    assert!(code == Some(0) && text.matches("outside of the step callback").count() == 1, "{code:?} {text}");
    let (code, text) = run("jump", &headless);
    assert!(code == Some(0) && text.contains("jumped"), "{code:?} {text}");
}

#[test]
fn it_is_installed_and_taken_out_again() {
    let folder = scratch("installed");
    let prefix = folder.join("prefix");
    let run = |line: &str| {
        let mut command = Command::new("sh");
        command.args(["-c", line]).current_dir(&folder).env_remove("DISPLAY");
        command
            .env("PKG_CONFIG_PATH", prefix.join("lib/pkgconfig"))
            .env("LD_LIBRARY_PATH", prefix.join("lib"));
        succeed(&mut command)
    };
    if !Command::new("pkg-config").arg("--version").output().is_ok_and(|output| output.status.success()) {
        return skip("there is no pkg-config (apt install pkg-config)");
    }
    let Some(_) = built("still") else { return };
    let installer = here().join("../../install.sh");
    let install = format!("sh '{}' --prefix '{}'", installer.display(), prefix.display());
    let library = library("libdrawstuff.so");
    run(&format!("{install} --drawstuff --from '{}'", library.parent().expect("a folder").display()));
    let source = here().join("examples/c/pendulum.c");
    // The line of docs/drawstuff.md.
    run(&format!("gcc '{}' -o demo $(pkg-config --cflags --libs drawstuff ode) -lm", source.display()));
    run("DRAWSTUFF_HEADLESS=out DRAWSTUFF_DUMP=text DRAWSTUFF_FRAMES=2 ./demo");
    assert!(folder.join("out/calls.txt").exists());
    run(&format!("{install} --uninstall"));
    assert!(!prefix.join("lib").exists() && !prefix.join("include").exists());
}
