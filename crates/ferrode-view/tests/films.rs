//! `ferrode-view render`: pictures and films as files, and what it says when it can't.

mod common;

use common::{CUBE, canvas, scratch, viewer, written};
use ferrode_view::render::Quality;
use std::process::Output;

fn render(line: &[&str]) -> Output {
    viewer().arg("render").args(line).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").output().unwrap()
}

fn has_driver() -> bool {
    canvas([16, 16], Quality::live()).is_some()
}

const FALLING: &str = r#"<sdf version="1.10"><world name="w">
  <model name="ball"><pose>0 0 2 0 0 0</pose><link name="body">
    <inertial auto="true"><density>200</density></inertial>
    <collision name="c"><geometry><sphere><radius>0.3</radius></sphere></geometry></collision></link></model>
</world></sdf>"#;

/// The height at which red is in the middle column of a picture, in pixels from the top; bodies of the first model are red.
fn red_height(pixels: &[u8], width: usize, height: usize) -> f64 {
    let red = |y: &usize| {
        let at = 4 * (y * width + width / 2);
        let [r, g, b] = [pixels[at], pixels[at + 1], pixels[at + 2]].map(i32::from);
        r > g + 40 && r > b + 40
    };
    let rows: Vec<usize> = (0..height).filter(red).collect();
    assert!(!rows.is_empty(), "there is no ball in the picture");
    rows.iter().sum::<usize>() as f64 / rows.len() as f64
}

/// Where a ball that falls from 2 m is seen at a time: in the middle of 96 pixels are 2 m, and 40° of height at 6 m.
fn expected(time: f64) -> f64 {
    48.0 + 0.5 * 9.8 * time * time * 48.0 / (6.0 * ferrode::math::real::tan(20.0_f64.to_radians()))
}

const VIEW: [&str; 4] = ["--camera", "0,-6,2,0,0,2", "--size", "128x96"];

#[test]
fn a_picture_shows_the_moment_that_was_asked_for() {
    if !has_driver() {
        return;
    }
    let world = written("moment.sdf", FALLING);
    for time in ["0", "0.3", "0.5"] {
        let out = scratch(&format!("moment-{time}.png"));
        let line =
            [&[world.as_str(), "-o", out.to_str().unwrap(), "--time", time, "--draft"], &VIEW[..]].concat();
        let done = render(&line);
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let picture = image::open(&out).unwrap().to_rgba8();
        assert_eq!(picture.dimensions(), (128, 96));
        let seen = red_height(picture.as_raw(), 128, 96);
        let want = expected(time.parse().unwrap());
        assert!((seen - want).abs() < 1.5, "at {time} s: {seen} instead of {want}");
    }
}

#[test]
fn films_show_one_moment_after_the_other() {
    if !has_driver() {
        return;
    }
    let world = written("film.sdf", FALLING);
    let make = |name: &str| {
        let out = scratch(name);
        let line = [
            &[world.as_str(), "-o", out.to_str().unwrap(), "--time", "0.4", "--fps", "10", "--draft"],
            &VIEW[..],
        ];
        let done = render(&line.concat());
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        out
    };
    let folder = make("frames");
    for n in 0..=4 {
        let picture = image::open(folder.join(format!("{n:05}.png"))).unwrap().to_rgba8();
        let want = expected(f64::from(n) * 0.1);
        assert!((red_height(picture.as_raw(), 128, 96) - want).abs() < 1.5);
    }
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut film = options.read_info(std::fs::File::open(make("film.gif")).unwrap()).unwrap();
    for n in 0..=4 {
        let frame = film.read_next_frame().unwrap().expect("five frames");
        assert_eq!((frame.width, frame.height, frame.delay), (128, 96, 10));
        assert!((red_height(&frame.buffer, 128, 96) - expected(f64::from(n) * 0.1)).abs() < 1.5);
    }
    assert!(film.read_next_frame().unwrap().is_none());
    let mp4 = std::fs::read(make("film.mp4")).unwrap();
    assert_eq!(&mp4[4..8], b"ftyp");
    let after = |name: &[u8]| mp4.windows(name.len()).position(|w| w == name).map(|at| at + name.len());
    assert!(after(b"av01").is_some() && after(b"av1C").is_some() && after(b"mdat").is_some());
    // The number of samples stands after version, flags and common size.
    let at = after(b"stsz").unwrap() + 8;
    assert_eq!(u32::from_be_bytes(mp4[at..at + 4].try_into().unwrap()), 5);
}

#[test]
fn what_cannot_be_done_is_said_in_a_line() {
    let world = written("said.sdf", CUBE);
    let text = |done: Output| (done.status.code(), String::from_utf8(done.stderr).unwrap());
    let out = scratch("said.png");
    let out = out.to_str().unwrap();
    // A broken file: the loader's own report, with the line.
    let broken = written("broken.sdf", &CUBE.replace("1 1 1", "1 -1 1"));
    let (code, told) = text(render(&[&broken, "-o", out]));
    assert_eq!(code, Some(3));
    assert!(told.contains("broken.sdf:7") && told.contains("-1"), "{told}");
    // No driver: metal is not to be had here, or vulkan where metal is.
    let other = if cfg!(target_os = "macos") { "dx12" } else { "metal" };
    let done = viewer().args(["render", &world, "-o", out]).env("WGPU_BACKEND", other).output().unwrap();
    let (code, told) = text(done);
    assert_eq!(code, Some(4));
    assert!(told.contains("apt install mesa-vulkan-drivers") && told.trim().lines().count() == 1, "{told}");
    let (code, told) = text(render(&[&world, "-o", "out.avi"]));
    assert_eq!(code, Some(2));
    assert!(told.contains(".png, .gif, .mp4"), "{told}");
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_display_the_window_says_what_to_do_instead() {
    let world = written("no-display.sdf", CUBE);
    let mut command = viewer();
    command.args(["view", &world]);
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    let done = command.output().unwrap();
    let told = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(4));
    assert!(told.trim().lines().count() == 1 && told.contains("ferrode render"), "{told}");
}

#[test]
fn what_cannot_be_written_is_said_before_anything_is_simulated() {
    if !has_driver() {
        return;
    }
    let world = written("unwritable.sdf", CUBE);
    let nowhere = scratch("no-such-folder");
    for name in ["a.png", "a.gif", "a.mp4"] {
        let out = nowhere.join(name);
        // A day of simulation: it would not end.
        let done = render(&[&world, "-o", out.to_str().unwrap(), "--time", "86400", "--draft"]);
        let told = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(4), "{told}");
        assert!(told.starts_with("error: cannot write") && told.trim().lines().count() == 1, "{told}");
    }
}

#[test]
fn all_steppers_move_what_is_drawn() {
    if !has_driver() {
        return;
    }
    let world = written("steppers.sdf", FALLING);
    for stepper in ["direct", "quick", "substep"] {
        let out = scratch(&format!("stepper-{stepper}.png"));
        let line = [
            &[world.as_str(), "-o", out.to_str().unwrap(), "--time", "0.5", "--draft", "--stepper", stepper],
            &VIEW[..],
        ];
        let done = render(&line.concat());
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let picture = image::open(&out).unwrap().to_rgba8();
        let seen = red_height(picture.as_raw(), 128, 96);
        assert!((seen - expected(0.5)).abs() < 1.5, "{stepper}: {seen}");
    }
}

#[test]
fn names_and_the_time_are_written_where_they_belong() {
    if !has_driver() {
        return;
    }
    let world = written("lettered.sdf", FALLING);
    let draw = |name: &str, more: &[&str]| {
        let out = scratch(name);
        let line = [
            &[world.as_str(), "-o", out.to_str().unwrap(), "--draft", "--camera", "0,-6,2,0,0,2"][..],
            &["--size", "320x240"],
            more,
        ];
        let done = render(&line.concat());
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        image::open(&out).unwrap().to_rgba8()
    };
    let plain = draw("letters-none.png", &[]);
    let lettered = draw("letters-both.png", &["--show", "names,time"]);
    let later = draw("letters-later.png", &["--show", "time", "--time", "0.004"]);
    // Boxes of pixels that differ.
    let differ = |a: &image::RgbaImage, b: &image::RgbaImage, within: [u32; 4]| {
        let [x0, y0, x1, y1] = within;
        let all = (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y)));
        all.filter(|(x, y)| {
            a.get_pixel(*x, *y).0.iter().zip(b.get_pixel(*x, *y).0).any(|(a, b)| a.abs_diff(b) > 40)
        })
        .count()
    };
    // The time stands in the upper left corner, the name of the ball on it.
    let (corner, ball) = ([8, 6, 90, 32], [130, 108, 190, 132]);
    assert!(differ(&plain, &lettered, corner) > 60);
    assert!(differ(&plain, &lettered, ball) > 40);
    let everywhere = differ(&plain, &lettered, [0, 0, 320, 240]);
    assert_eq!(everywhere, differ(&plain, &lettered, corner) + differ(&plain, &lettered, ball));
    // 0.000 s is not 0.004 s.
    assert!(differ(&lettered, &later, corner) > 5);
}

#[test]
fn pictures_are_coloured_by_what_was_asked_for() {
    if !has_driver() {
        return;
    }
    let world = written("colors.sdf", CUBE);
    let middle = |by: &str, time: &str| {
        let out = scratch(&format!("colors-{by}-{time}.png"));
        let line = [
            &[world.as_str(), "-o", out.to_str().unwrap(), "--time", time, "--draft", "--colors", by][..],
            &["--camera", "0,-6,0.5,0,0,0.5", "--size", "64x48"],
        ];
        let done = render(&line.concat());
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        image::open(&out).unwrap().to_rgb8().get_pixel(32, 24).0.map(i32::from)
    };
    let [r, g, b] = middle("sleep", "0.02");
    assert!(r > g + 40 && r > b + 60, "awake is orange: {r} {g} {b}");
    let [r, g, b] = middle("sleep", "3");
    assert!(b > r + 15 && (g - r).abs() < 40, "asleep is pale blue: {r} {g} {b}");
    assert_ne!(middle("bodies", "3"), middle("sleep", "3"));
    let told = render(&[&world, "-o", "no.png", "--colors", "taste"]);
    assert_eq!(told.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&told.stderr).contains("bodies, sleep or islands"));
}
