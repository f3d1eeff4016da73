//! `ferrode-view demo`: live in a window, and drawn without one.

mod common;

use common::{Display, canvas, scratch, viewer, written};
use ferrode::Vec3;
use ferrode_demos::find;
use ferrode_view::render::{Camera, Quality};
use serde_json::Value;

fn state(name: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(scratch(name)).unwrap()).unwrap()
}

fn places(state: &Value) -> Vec<Vec3> {
    let links = state["links"].as_object().unwrap();
    let numbers = |link: &Value| [0, 1, 2].map(|i| link[i].as_f64().unwrap());
    links.values().map(|link| Vec3::from_array(numbers(link))).collect()
}

/// Where the bodies of a demo are after so many steps, in the order of their names.
fn headless(name: &str, steps: u64) -> Vec<Vec3> {
    let mut play = find(name).unwrap().start().unwrap();
    for _ in 0..steps {
        play.step().unwrap();
    }
    let mut named: Vec<(String, Vec3)> = Vec::new();
    let h = play.step_size();
    let world = ferrode_scene::NamedWorld::of_world(play.world, h, name);
    for (index, link) in world.scene.links.iter().enumerate() {
        let pose = world.link_pose(ferrode_scene::description::LinkId(index));
        named.push((link.name.clone(), pose.position));
    }
    named.sort_by(|a, b| a.0.cmp(&b.0));
    named.into_iter().map(|(_, place)| place).collect()
}

#[test]
fn a_window_drives_the_demo_as_it_drives_itself() {
    if canvas([16, 16], Quality::live()).is_none() {
        return;
    }
    let Some(display) = Display::open("demo", [640, 480]) else { return };
    // The walker has a control loop that reads and drives its joints before each step.
    let file = |name: &str| scratch(name).display().to_string();
    let script = format!(
        "wait 30\nkey space\nstate {}\nkey .\nstate {}\nkey ,\nkey ,\nstate {}\nkey space\nwait 8\nkey space\nstate {}\n\
         key r\nstate {}\nshot {}\nclick 320 240\nquit",
        file("demo-paused.json"),
        file("demo-stepped.json"),
        file("demo-back.json"),
        file("demo-on.json"),
        file("demo-anew.json"),
        file("demo-anew.png"),
    );
    let script = written("demo.script", &script);
    let line = ["demo", "walker", "--size", "640x480", "--show", "joints", "--script", &script];
    let done = viewer().args(line).env("DISPLAY", &display.name).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let [paused, stepped, back, on, anew] =
        ["paused", "stepped", "back", "on", "anew"].map(|moment| state(&format!("demo-{moment}.json")));
    let steps = |state: &Value| state["steps"].as_u64().unwrap();
    assert!(steps(&paused) > 50 && steps(&stepped) == steps(&paused) + 1, "{paused} {stepped}");
    assert!(steps(&back) < steps(&paused) && steps(&on) > steps(&back), "{back} {on}");
    assert_eq!(steps(&anew), 0);
    // After pause, single step and winding back alike: where it is without a window. (The JSON reader may miss the last bit.)
    for state in [&paused, &stepped, &back, &on, &anew] {
        let alone = headless("walker", steps(state));
        assert_eq!(alone.len(), places(state).len());
        let off = places(state).iter().zip(&alone).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
        assert!(off < 1e-15, "off by {off:e} m after {} steps", steps(state));
    }
    assert!(scratch("demo-anew.png").is_file());
}

#[test]
fn a_demo_is_drawn_at_its_moment_by_its_camera() {
    if canvas([16, 16], Quality::live()).is_none() {
        return;
    }
    let (demo, size) = (find("newtons-cradle").unwrap(), [320, 200]);
    let out = scratch("demo-cradle.png");
    let line = ["demo", demo.name, "--size", "320x200", "--draft", "-q", "-o", out.to_str().unwrap()];
    let done = viewer().args(line).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let picture = image::open(&out).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (320, 200));
    let mut play = demo.start().unwrap();
    for _ in 0..play.steps_to(demo.picture_at) {
        play.step().unwrap();
    }
    let camera = Camera::look_at(demo.camera.eye, demo.camera.target);
    for (_, body) in play.world.bodies() {
        let ([x, y], _) = camera.project(body.position(), size).unwrap();
        let [r, g, b] = picture.get_pixel(x as u32, y as u32).0;
        assert!(r.max(g).max(b) - r.min(g).min(b) > 40, "no ball at {x} {y}: {r} {g} {b}");
    }
}

#[test]
fn without_a_name_demos_are_listed_and_wrong_names_are_refused() {
    let done = viewer().arg("demo").output().unwrap();
    let told = String::from_utf8(done.stdout).unwrap();
    assert!(done.status.success() && told == ferrode_demos::list(), "{told}");
    let done = viewer().args(["demo", "no-such"]).output().unwrap();
    assert_eq!(done.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&done.stderr).contains("`ferrode demo` lists them"));
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_display_one_line_says_what_to_do() {
    let mut command = viewer();
    command
        .args(["demo", "hinge"])
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET");
    let done = command.output().unwrap();
    let told = String::from_utf8_lossy(&done.stderr);
    assert!(!done.status.success() && told.trim().lines().count() == 1, "{told}");
    assert!(told.contains("`ferrode demo hinge -o out.png`"), "{told}");
}
