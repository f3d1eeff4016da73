//! The window, in a virtual display, with scripted hands. Pictures are kept in the target folder.

#![cfg(target_os = "linux")]

mod common;

use common::{CUBE, Display, canvas, scratch, viewer, written};
use ferrode::Vec3;
use ferrode_view::render::{Camera, Quality};
use serde_json::Value;
use std::path::PathBuf;
use std::time::{Duration, Instant};

const SIZE: [u32; 2] = [640, 480];
const VIEW: [&str; 4] = ["--camera", "0,-7,2,0,0,0.7", "--size", "640x480"];

fn camera() -> Camera {
    Camera::look_at(Vec3::new(0.0, -7.0, 2.0), Vec3::new(0.0, 0.0, 0.7))
}

/// A display and a driver, or `None` (said loudly) without.
fn display(test: &str) -> Option<Display> {
    canvas([16, 16], Quality::live())?;
    Display::open(test, SIZE)
}

fn pixel(p: Vec3) -> String {
    let ([x, y], _) = camera().project(p, SIZE).unwrap();
    format!("{x:.1} {y:.1}")
}

#[test]
fn a_missing_driver_is_told_in_a_line_though_there_is_a_display() {
    let Some(display) = Display::open("driverless", SIZE) else { return };
    let world = written("driverless.sdf", CUBE);
    // Metal is not to be had here.
    let mut command = viewer();
    command.args(["view", &world]).env("DISPLAY", &display.name).env("WGPU_BACKEND", "metal");
    let done = command.output().unwrap();
    let told = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(4), "{told}");
    assert!(told.contains("apt install mesa-vulkan-drivers") && told.trim().lines().count() == 1, "{told}");
}

/// Runs a script on a world to its end; `{name}` in it are files of the test's own. Gives their paths.
fn run(display: &Display, test: &str, line: &[&str], script: &str) -> impl Fn(&str) -> PathBuf + use<> {
    let prefix = test.to_owned();
    let path = move |name: &str| scratch(&format!("{prefix}-{name}"));
    let mut text = script.to_owned();
    while let (Some(from), Some(to)) = (text.find('{'), text.find('}')) {
        let name = path(&text[from + 1..to]);
        text.replace_range(from..=to, name.to_str().unwrap());
    }
    let script = written(&format!("{test}.script"), &text);
    let done =
        viewer().args(line).args(VIEW).args(["--script", &script]).env("DISPLAY", &display.name).output();
    let done = done.unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    path
}

fn state(path: PathBuf) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn place(state: &Value, link: &str) -> Vec3 {
    let at = |n: usize| state["links"][link][n].as_f64().unwrap();
    Vec3::new(at(0), at(1), at(2))
}

#[test]
fn keys_pause_step_wind_back_and_start_anew() {
    let Some(display) = display("keys") else { return };
    let world = written("keys.sdf", CUBE);
    let path = run(
        &display,
        "keys",
        &["view", &world],
        "wait 30\nkey space\nstate {paused.json}\nwait 10\nstate {still.json}\nkey .\nstate {stepped.json}\n\
         key ,\nkey ,\nstate {back.json}\nkey r\nstate {anew.json}\nkey space\nwait 12\nstate {on.json}\n\
         key b\nwait 3\nstate {dropped.json}\nkey x\nwait 3\nstate {shot.json}\nquit",
    );
    let [paused, still, stepped, back, anew, on, dropped, shot] =
        ["paused", "still", "stepped", "back", "anew", "on", "dropped", "shot"]
            .map(|name| state(path(&format!("{name}.json"))));
    let time = |state: &Value| state["time"].as_f64().unwrap();
    assert!(paused["paused"] == true && (time(&paused) - 0.5).abs() < 0.02, "{paused}");
    assert_eq!(time(&still), time(&paused), "time stands still");
    assert!((time(&stepped) - time(&paused) - 0.005).abs() < 1e-12, "one step");
    assert!(time(&back) < time(&paused) && time(&back) > 0.2, "{back}");
    assert_eq!(time(&anew), 0.0);
    assert!(on["paused"] == false && (time(&on) - 0.2).abs() < 0.02, "{on}");
    assert_eq!(
        (on["bodies"].as_u64(), dropped["bodies"].as_u64(), shot["bodies"].as_u64()),
        (Some(1), Some(2), Some(3))
    );
}

#[test]
fn the_mouse_grabs_a_body_and_moves_it() {
    let Some(display) = display("grab") else { return };
    let world = written("grab.sdf", CUBE);
    let (from, to) = (Vec3::new(0.0, -0.5, 0.6), Vec3::new(1.4, -0.5, 1.9));
    let script = format!(
        "wait 2\nkey tab\nclick {}\nstate {{before.json}}\nshot {{before.png}}\nmove {}\nwait 1\npress left\nwait 1\nmove {}\nwait 90\n\
         state {{held.json}}\nshot {{held.png}}\nrelease left\nwait 60\nstate {{after.json}}\nquit",
        pixel(from),
        pixel(from),
        pixel(to)
    );
    let path = run(&display, "grab", &["view", &world], &script);
    let [before, held, after] = ["before", "held", "after"].map(|name| state(path(&format!("{name}.json"))));
    assert_eq!(before["selected"], "cube::body");
    // The point that was taken is half a metre from the cube's middle, and that hangs from the mouse now.
    // The mouse is as deep in the picture as the point was when it was taken.
    let (eye, (at, _)) = (camera(), camera().project(to, SIZE).unwrap());
    let (along, forward) = (eye.ray(at, SIZE), eye.directions()[2]);
    let mouse = eye.eye + along * ((from - eye.eye).dot(forward) / along.dot(forward));
    let hanging = place(&held, "cube::body") - mouse;
    assert!((hanging.length() - 0.51).abs() < 0.03 && hanging.z < -0.4, "{hanging:?}");
    let fallen = place(&after, "cube::body");
    let hung = place(&held, "cube::body");
    assert!(fallen.z < hung.z - 0.5 && fallen.x > 0.3, "let go, it falls where it is: {fallen:?}");
    // And the pictures show it so: the cube's colour is where its middle is, and no longer where it was.
    let color = |name: &str, p: Vec3| {
        let picture = image::open(path(&format!("{name}.png"))).unwrap().to_rgba8();
        let ([x, y], _) = camera().project(p, SIZE).unwrap();
        let [r, g, b, _] = picture.get_pixel(x as u32, y as u32).0.map(i32::from);
        // The second model's colour, in light and shade; the ground is grey.
        b > r + 30 && b > g + 5
    };
    let (was, is) = (place(&before, "cube::body"), place(&held, "cube::body"));
    assert!(color("before", was) && !color("before", is));
    assert!(color("held", is) && !color("held", was - Vec3::new(0.2, 0.0, 0.2)));
}

#[test]
fn the_display_shows_what_was_drawn() {
    let Some(display) = display("shown") else { return };
    let world = written("shown.sdf", CUBE);
    let shot = scratch("shown-shot.png");
    // Of an earlier run.
    let _ = std::fs::remove_file(&shot);
    let script = format!("key space\nkey 1\nwait 3\nshot {}\nwait 100000\nquit", shot.display());
    let script = written("shown.script", &script);
    let mut child = viewer();
    child.args(["view", &world, "--script", &script]).args(VIEW).env("DISPLAY", &display.name);
    let mut child = child.spawn().unwrap();
    let start = Instant::now();
    let picture = loop {
        std::thread::sleep(Duration::from_millis(200));
        let whole = image::open(&shot).ok();
        if let Some(picture) = whole {
            break picture.to_rgb8();
        }
        assert!(
            start.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none(),
            "no picture"
        );
    };
    std::thread::sleep(Duration::from_millis(1500));
    let (width, height, on_screen) = display.pixels();
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!([width, height], SIZE);
    let same = |x: u32, y: u32| {
        let (a, b) = (picture.get_pixel(x, y).0, on_screen(x, y));
        (0..3).all(|i| a[i].abs_diff(b[i]) < 12)
    };
    let count =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|(x, y)| same(*x, *y)).count();
    let all = (width * height) as usize;
    // The number of frames a second, in the panel, goes on changing.
    assert!(count * 100 > all * 98, "{count} of {all} pixels are those of the picture");
}

#[test]
fn recordings_are_shown_on_their_world_and_without_it() {
    let Some(display) = display("replay") else { return };
    let world = written("replay.sdf", CUBE);
    let row = |time: f64, x: f64| {
        format!(
            "{{\"time[s]\":{time},\"link.cube::body.x[m]\":{x},\"link.cube::body.y[m]\":0,\"link.cube::body.z[m]\":0.5,\
             \"link.cube::body.qw\":1,\"link.cube::body.qx\":0,\"link.cube::body.qy\":0,\"link.cube::body.qz\":0}}"
        )
    };
    let recording = written("replay.jsonl", &format!("{}\n{}\n", row(0.0, 0.0), row(1.0, 2.0)));
    for (test, line, link) in [
        ("replay-world", vec!["replay", &recording, &world], "cube::body"),
        ("replay-alone", vec!["replay", &recording], "cube/body::link"),
    ] {
        let path = run(
            &display,
            test,
            &line,
            "wait 30\nkey space\nstate {half.json}\nshot {half.png}\nkey r\nstate {anew.json}\nquit",
        );
        let half = state(path("half.json"));
        let time = half["time"].as_f64().unwrap();
        assert!((time - 0.5).abs() < 0.05, "{test}: {half}");
        assert!((place(&half, link).x - 2.0 * time).abs() < 1e-9, "{test}: {half}");
        assert!(place(&state(path("anew.json")), link).x.abs() < 1e-12);
    }
}
