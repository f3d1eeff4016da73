//! A run by scripted hands from start to end: pause, step, grab, throw, shoot, drop, wind back. Its pictures are kept in
//! `target/tmp/viewer-run/`, each beside the state that it shows, and compared with that.

#![cfg(target_os = "linux")]

mod common;

use common::{CUBE, Display, canvas, scratch, viewer, written};
use ferrode::prelude::*;
use ferrode_view::render::{Camera, Quality};
use serde_json::Value;
use std::path::PathBuf;

const SIZE: [u32; 2] = [640, 480];
const VIEW: [&str; 4] = ["--camera", "0,-7,2,0,0,0.7", "--size", "640x480"];

fn camera() -> Camera {
    Camera::look_at(Vec3::new(0.0, -7.0, 2.0), Vec3::new(0.0, 0.0, 0.7))
}

fn pixel(p: Vec3) -> [f64; 2] {
    camera().project(p, SIZE).unwrap().0
}

/// A moment of the run: its picture and its state.
struct Moment {
    picture: image::RgbaImage,
    state: Value,
}

impl Moment {
    fn read(name: &str) -> Self {
        let path = |ending: &str| folder().join(format!("{name}.{ending}"));
        let picture = image::open(path("png")).unwrap().to_rgba8();
        let state = serde_json::from_str(&std::fs::read_to_string(path("json")).unwrap()).unwrap();
        Self { picture, state }
    }

    fn time(&self) -> f64 {
        self.state["time"].as_f64().unwrap()
    }

    /// The cube's pose, from the state.
    fn cube(&self) -> Pose {
        let v: Vec<f64> = self.state["links"]["cube::body"]
            .as_array()
            .unwrap()
            .iter()
            .map(|number| number.as_f64().unwrap())
            .collect();
        Pose::new(Vec3::new(v[0], v[1], v[2]), Quat::new(v[3], v[4], v[5], v[6]))
    }

    /// The centres of bodies that were added.
    fn added(&self) -> Vec<Vec3> {
        let list = self.state["added"].as_array().unwrap();
        let number = |v: &Value, n: usize| v[n].as_f64().unwrap();
        list.iter().map(|v| Vec3::new(number(v, 0), number(v, 1), number(v, 2))).collect()
    }

    /// Whether a pixel is blue as the second model of a world is, in light and shade.
    fn is_blue(&self, x: u32, y: u32) -> bool {
        let [r, g, b, _] = self.picture.get_pixel(x, y).0.map(i32::from);
        b > r + 45 && b > g + 12
    }

    /// The colour under a point: how far it is from grey.
    fn colourful(&self, p: Vec3) -> u8 {
        let [x, y] = pixel(p);
        let [r, g, b, _] = self.picture.get_pixel(x as u32, y as u32).0;
        r.max(g).max(b) - r.min(g).min(b)
    }

    /// The share of the cube's silhouette, where rays from the eye meet it, that is not blue, or that is blue beside it.
    fn wrong(&self) -> f64 {
        let mut world = World::new();
        let cube = Cuboid::new(Vec3::splat(1.0)).unwrap();
        world.add_static(cube, self.cube()).unwrap();
        let [width, height] = SIZE.map(|side| side as usize);
        let mut meets = vec![false; width * height];
        for (n, place) in meets.iter_mut().enumerate() {
            let along = camera().ray([(n % width) as f64 + 0.5, (n / width) as f64 + 0.5], SIZE);
            *place = world.ray_cast(camera().eye, along, 100.0, |_| true).unwrap().is_some();
        }
        let (mut covered, mut wrong) = (0, 0);
        // The time is written along the upper edge.
        for y in 40..height - 2 {
            for x in 2..width - 2 {
                let inside = meets[y * width + x];
                let same = |dx: usize, dy: usize| meets[(y + dy - 2) * width + x + dx - 2] == inside;
                if (0..5).all(|dx| (0..5).all(|dy| same(dx, dy))) {
                    covered += usize::from(inside);
                    wrong += usize::from(self.is_blue(x as u32, y as u32) != inside);
                }
            }
        }
        assert!(covered > 3000, "the cube covers {covered} pixels only: the test says little");
        wrong as f64 / covered as f64
    }
}

fn folder() -> PathBuf {
    scratch("viewer-run")
}

#[test]
fn pictures_of_a_run_show_what_hands_did() {
    if canvas([16, 16], Quality::live()).is_none() {
        return;
    }
    let Some(display) = Display::open("run", SIZE) else { return };
    // Nothing of an earlier run.
    let _ = std::fs::remove_dir_all(folder());
    std::fs::create_dir_all(folder()).unwrap();
    let world = written("run.sdf", CUBE);
    let (from, to) = (Vec3::new(0.0, -0.5, 0.6), Vec3::new(1.4, -0.5, 1.9));
    let ([x, y], [x2, y2]) = (pixel(from), pixel(to));
    let script = format!(
        "key tab\nwait 30\nshot {{start.png}}\nstate {{start.json}}\n\
         move {x} {y}\nwait 1\npress left\nwait 1\nmove {x2} {y2}\nwait 80\nshot {{held.png}}\nstate {{held.json}}\n\
         release left\nwait 70\nshot {{fallen.png}}\nstate {{fallen.json}}\n\
         move 150 330\nkey x\nwait 12\nshot {{shooting.png}}\nstate {{shooting.json}}\nwait 100\n\
         key b\nwait 4\nshot {{dropped.png}}\nstate {{dropped.json}}\n\
         key space\nwait 1\nshot {{paused.png}}\nstate {{paused.json}}\nwait 8\nshot {{still.png}}\nstate {{still.json}}\n\
         key .\nwait 1\nshot {{stepped.png}}\nstate {{stepped.json}}\n\
         {}wait 1\nshot {{back.png}}\nstate {{back.json}}\ncsv {{values.csv}}\nplots {{plots.png}}\nquit",
        "key ,\n".repeat(48)
    );
    let mut text = script;
    while let (Some(start), Some(end)) = (text.find('{'), text.find('}')) {
        let path = folder().join(&text[start + 1..end]);
        text.replace_range(start..=end, path.to_str().unwrap());
    }
    let script = written("run.script", &text);
    let mut command = viewer();
    command.args(["view", &world, "--script", &script, "--plot", "link.cube::body.z"]).args(VIEW);
    let done = command.env("DISPLAY", &display.name).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));

    let [start, held, fallen, shooting, dropped, paused, still, stepped, back] =
        ["start", "held", "fallen", "shooting", "dropped", "paused", "still", "stepped", "back"]
            .map(Moment::read);
    // Silhouettes; while it is held, the spring is drawn over it.
    for (name, moment, most) in [("start", &start, 0.01), ("held", &held, 0.1), ("fallen", &fallen, 0.01)] {
        let wrong = moment.wrong();
        assert!(wrong < most, "{name}: {:.1} % of the cube's silhouette are wrong", 100.0 * wrong);
    }
    assert!((start.cube().position - Vec3::new(0.0, 0.0, 0.5)).length() < 0.02);
    assert!(held.cube().position.x > 1.0 && held.cube().position.z > 1.0, "it was moved: {:?}", held.cube());
    assert!(fallen.cube().position.z < 0.9, "let go, it falls");
    // What was shot and dropped is where the state says, in colour; it was not there before.
    assert_eq!([&start, &shooting, &dropped].map(|moment| moment.added().len()), [0, 1, 2]);
    let ball = shooting.added()[0];
    assert!(shooting.colourful(ball) > 40 && start.colourful(ball) < 40, "the ball at {ball:?}");
    let cube = *dropped.added().iter().max_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
    assert!(dropped.colourful(cube) > 40 && start.colourful(cube) < 40, "the dropped cube at {cube:?}");
    // Time stands still, goes on by a step, and back.
    assert_eq!(paused.time(), still.time());
    assert_eq!(paused.picture, still.picture);
    assert!((stepped.time() - still.time() - 0.005).abs() < 1e-12);
    assert_ne!(stepped.picture, still.picture);
    assert!(back.time() < 1.9 && back.added().is_empty(), "wound back to {} s", back.time());
    assert!(back.cube().position.z > 1.0 && back.wrong() < 0.01, "to when it hung from the mouse");
    // Plots: each phase of a step takes its part of the time, and the asked for value is there.
    let csv = std::fs::read_to_string(folder().join("values.csv")).unwrap();
    let columns: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let column =
        |name: &str| columns.iter().position(|column| *column == name).unwrap_or_else(|| panic!("{name}"));
    let value = |line: &str, name: &str| line.split(',').nth(column(name)).unwrap().parse::<f64>().unwrap();
    let mut awake = 0;
    for line in csv.lines().skip(2) {
        let phases = ["collision [ms]", "islands and rows [ms]", "solve [ms]", "integration [ms]"];
        let parts = phases.map(|name| value(line, name));
        assert!(parts[0] > 0.0, "{line}");
        // A cube at rest falls asleep.
        awake += usize::from(parts.iter().all(|part| *part > 0.0));
        assert!(parts.iter().sum::<f64>() <= value(line, "step [ms]") * 1.0001, "{line}");
        assert!(value(line, "cube::body z [m]") > 0.4, "{line}");
    }
    assert!(awake > 20, "{awake} steps with rows");
    let plots = image::open(folder().join("plots.png")).unwrap().to_rgba8();
    assert_eq!(plots.width(), 900);
    let colours: std::collections::BTreeSet<[u8; 4]> = plots.pixels().map(|pixel| pixel.0).collect();
    assert!(colours.len() > 20, "there are lines and letters in it");
}
