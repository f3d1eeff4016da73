//! What the tests of pictures share.
// Not every test file uses everything here.
#![allow(dead_code)]

use ferrode_view::render::{Canvas, Quality, RenderError};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

/// A canvas, or `None` (said loudly) without a driver.
pub fn canvas(size: [u32; 2], quality: Quality) -> Option<Canvas> {
    match Canvas::new(size[0], size[1], quality) {
        Ok(canvas) => Some(canvas),
        Err(error @ RenderError::NoDriver(_)) => {
            eprintln!("SKIPPED: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// A path to write to. Tests use names of their own.
pub fn scratch(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// A file of the test's own.
pub fn written(name: &str, text: &str) -> String {
    let path = scratch(name);
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// The viewer's program.
pub fn viewer() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ferrode-view"));
    command.env("NODEVICE_SELECT", "1");
    command
}

/// A virtual display, closed when it is dropped.
pub struct Display {
    server: Child,
    /// Its name, such as `:7`.
    pub name: String,
    /// Where its picture lies, as an X window dump.
    pub picture: PathBuf,
}

impl Display {
    /// Opens one of a size, or `None` (said loudly) without Xvfb.
    pub fn open(test: &str, size: [u32; 2]) -> Option<Self> {
        use std::io::{BufRead, BufReader};
        let folder = scratch(&format!("{test}-display"));
        std::fs::create_dir_all(&folder).unwrap();
        let screen = format!("{}x{}x24", size[0], size[1]);
        let mut command = Command::new("Xvfb");
        // It must not start anew when a program of several leaves: the next could meet it closing.
        command.args(["-displayfd", "1", "-noreset", "-nolisten", "tcp", "-screen", "0", &screen, "-fbdir"]);
        command.arg(&folder);
        let server = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let Ok(mut server) = server else {
            eprintln!("SKIPPED: Xvfb is not installed (apt install xvfb)");
            return None;
        };
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        if number.trim().is_empty() {
            let _ = server.kill();
            let _ = server.wait();
            eprintln!("SKIPPED: Xvfb cannot open a display here");
            return None;
        }
        Some(Self { server, name: format!(":{}", number.trim()), picture: folder.join("Xvfb_screen0") })
    }

    /// What it shows now: width, height, and a function from x and y to red, green and blue.
    pub fn pixels(&self) -> (u32, u32, impl Fn(u32, u32) -> [u8; 3] + use<>) {
        let dump = std::fs::read(&self.picture).unwrap();
        // The dump's header: 25 numbers of 4 bytes, the most significant first (X11/XWDFile.h).
        let number = |n: usize| u32::from_be_bytes(dump[4 * n..4 * n + 4].try_into().unwrap());
        let (header, width, height, stride, colors) =
            (number(0), number(4), number(5), number(12), number(19));
        assert_eq!(number(11), 32, "bits a pixel");
        let little = number(7) == 0;
        let start = header as usize + colors as usize * 12;
        let pixel = move |x: u32, y: u32| {
            let at = start + (y * stride + 4 * x) as usize;
            let [a, b, c, d]: [u8; 4] = dump[at..at + 4].try_into().unwrap();
            if little { [c, b, a] } else { [b, c, d] }
        };
        (width, height, pixel)
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// A cube of a metre on the ground.
pub const CUBE: &str = r#"<sdf version="1.10"><world name="w">
  <physics type="ode"><max_step_size>0.005</max_step_size></physics>
  <model name="ground"><static>true</static><link name="l"><collision name="c">
    <geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link></model>
  <model name="cube"><pose>0 0 0.5 0 0 0</pose><link name="body">
    <inertial auto="true"><density>200</density></inertial>
    <collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision></link></model>
</world></sdf>"#;
