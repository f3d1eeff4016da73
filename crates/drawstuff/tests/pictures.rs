//! Pictures, without a display and in a window of a virtual one: they show what was drawn, where the camera projects it.
//!
//! Needs a C compiler and a Vulkan or OpenGL driver (software will do), for the window Xvfb; without them the tests say so and
//! do nothing.
#![cfg(target_os = "linux")]

mod support;

use std::path::PathBuf;
use support::{Display, compile, has_driver, here, libraries, picture, program, scratch, succeed};

const SIZE: [usize; 2] = [640, 480];

fn built(test: &str) -> Option<(PathBuf, PathBuf, PathBuf)> {
    if !has_driver() {
        return None;
    }
    let folder = scratch(test);
    let libraries = libraries(&folder.join("lib"), false);
    Some((compile(&here().join("tests/c/still.c"), &folder, &libraries)?, libraries, folder))
}

fn is_red(pixel: &[u8]) -> bool {
    pixel[0] > 60
        && u32::from(pixel[0]) > 2 * u32::from(pixel[1])
        && u32::from(pixel[0]) > 2 * u32::from(pixel[2])
}

/// The smallest rectangle around all that is red, and how many pixels are: left, top, right, bottom, count.
fn red(pixels: &[u8]) -> [usize; 5] {
    let mut all = [usize::MAX, usize::MAX, 0, 0, 0];
    for (n, pixel) in pixels.chunks_exact(3).enumerate().filter(|(_, pixel)| is_red(pixel)) {
        let (x, y) = (n % SIZE[0], n / SIZE[0]);
        assert_eq!(pixel.len(), 3);
        all = [all[0].min(x), all[1].min(y), all[2].max(x), all[3].max(y), all[4] + 1];
    }
    all
}

/// The mean difference of two pictures' bytes.
fn apart(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.len() as f64
}

/// The front of the box is half a metre high and wide around the middle, 3.5 m away; 50 degrees fill the height.
fn reach() -> f64 {
    240.0 / ferrode_math::real::tan(25.0_f64.to_radians()) * 0.5 / 3.5
}

#[test]
fn headless_pictures_show_what_was_drawn() {
    let Some((path, libraries, folder)) = built("headless") else { return };
    let shot = |name: &str, words: &[&str]| {
        let out = folder.join(name);
        let mut command = program(&path, &libraries);
        command
            .args(words)
            .env("DRAWSTUFF_HEADLESS", &out)
            .env("DRAWSTUFF_FRAMES", "3")
            .env("DRAWSTUFF_EVERY", "2");
        succeed(&mut command);
        assert!(out.join("00000.png").exists() && !out.join("00001.png").exists());
        let (width, height, pixels) = picture(&out.join("00002.png"));
        assert_eq!([width, height], SIZE);
        pixels
    };
    let plain = shot("plain", &["-notex", "-noshadow"]);
    let [left, top, right, bottom, count] = red(&plain).map(|n| n as f64);
    for (edge, wanted) in [
        (left, 320.0 - reach()),
        (top, 240.0 - reach()),
        (right + 1.0, 320.0 + reach()),
        (bottom + 1.0, 240.0 + reach()),
    ] {
        assert!((edge - wanted).abs() < 2.0, "{edge} instead of {wanted}");
    }
    assert!((count / (4.0 * reach() * reach()) - 1.0).abs() < 0.03, "the box is filled: {count}");
    // Edges alone cover little of the same rectangle.
    let wire = shot("wire", &["-notex", "-noshadow", "-still-wire"]);
    let [wire_left, _, _, _, wire_count] = red(&wire).map(|n| n as f64);
    assert!((wire_left - left).abs() < 3.0 && wire_count < 0.25 * count, "{wire_left} {wire_count}");
    // Shadows darken some ground, textures change all ground and sky.
    let shadow = shot("shadow", &["-notex"]);
    let darker = shadow.iter().zip(&plain).filter(|(a, b)| a.saturating_add(20) < **b).count();
    assert!(darker > 3000, "{darker}");
    assert!(apart(&shot("textures", &[]), &shadow) > 8.0);
}

#[test]
fn a_window_shows_the_same_as_its_pictures() {
    let Some((path, libraries, folder)) = built("window") else { return };
    let Some(display) = Display::open(&folder, SIZE.map(|side| side as u32)) else { return };
    let mut command = program(&path, &libraries);
    command.env("DISPLAY", &display.name).current_dir(&folder);
    // Pictures of two frames are written; the window then stays for a while.
    command.env("DRAWSTUFF_KEYS", "2:^W 4:^W").env("DRAWSTUFF_FRAMES", "600");
    let mut running = command.spawn().expect("the program starts");
    let written = folder.join("frame/00001.png");
    let patience = std::time::Duration::from_millis(50);
    let mut shown = f64::INFINITY;
    for _ in 0..400 {
        std::thread::sleep(patience);
        if running.try_wait().expect("its state").is_some() {
            break;
        }
        // Written for a while, so that no half of it is read.
        let age =
            written.metadata().and_then(|data| data.modified()).ok().and_then(|time| time.elapsed().ok());
        if age.is_some_and(|age| age > 4 * patience) {
            let (width, height, pixels) = picture(&written);
            assert_eq!([width, height], SIZE);
            shown = apart(&display.pixels(), &pixels);
            break;
        }
    }
    running.kill().expect("it runs until it is stopped");
    running.wait().expect("its end");
    assert!(shown < 1.0, "the window is {shown} away from the picture");
    let (_, _, pixels) = picture(&folder.join("frame/00000.png"));
    let count = red(&pixels)[4] as f64;
    assert!((count / (4.0 * reach() * reach()) - 1.0).abs() < 0.05, "{count}");
    assert!(!folder.join("frame/00002.png").exists(), "Ctrl-W switches off again");
}
