//! The example programs in windows of a virtual display, on both engines: they show the same.
//!
//! Needs a C compiler, Debian's `libode-dev`, Xvfb and a Vulkan or OpenGL driver (software will do); without them the test says so
//! and does nothing.
#![cfg(target_os = "linux")]

mod support;

use std::path::Path;
use support::{Display, compile, examples, has_driver, libraries, picture, program, scratch, succeed};

/// The frame that is looked at: early, before differences of the last bit can be seen.
const FRAME: &str = "4:^W";

#[test]
fn programs_show_the_same_on_both_engines() {
    if !has_driver() {
        return;
    }
    let folder = scratch("windows");
    let theirs = libraries(&folder.join("theirs"), false);
    let ours = libraries(&folder.join("ours"), true);
    let Some(display) = Display::open(&folder, [320, 200]) else { return };
    for source in examples() {
        let Some(path) = compile(&source, &folder, &theirs) else { return };
        let name = source.file_stem().expect("a name").to_string_lossy().into_owned();
        let shown = |libraries: &Path, engine: &str| {
            let out = folder.join(format!("{name}-{engine}"));
            std::fs::create_dir_all(&out).expect("a folder");
            let mut command = program(&path, libraries);
            command.current_dir(&out).env("DISPLAY", &display.name).env("DRAWSTUFF_SIZE", "320x200");
            succeed(command.env("DRAWSTUFF_FRAMES", "5").env("DRAWSTUFF_KEYS", FRAME));
            picture(&out.join("frame/00000.png"))
        };
        let (wanted, got) = (shown(&theirs, "libode"), shown(&ours, "ferrode"));
        assert_eq!((wanted.0, wanted.1), (320, 200), "{name}");
        let apart = wanted.2.iter().zip(&got.2).filter(|(a, b)| a.abs_diff(**b) > 4).count();
        assert!(apart < wanted.2.len() / 1000, "{name}: {apart} of {} bytes differ", wanted.2.len());
        // Bodies stand out from ground and sky: their colours are there many times over.
        let mut colors: Vec<&[u8]> = wanted.2.chunks_exact(3).collect();
        colors.sort_unstable();
        colors.dedup();
        assert!(colors.len() > 300, "{name} shows {} colours", colors.len());
    }
}
