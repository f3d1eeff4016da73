//! What the tests that run C programs share.
#![allow(dead_code)]

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

/// The folder of this package.
pub fn here() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A folder of this test's own, empty.
pub fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("drawstuff").join(name);
    std::fs::remove_dir_all(&folder).ok();
    std::fs::create_dir_all(&folder).expect("a folder for the test");
    folder
}

/// A shared library that cargo built with this test.
pub fn library(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("a test has a path");
    let built = test.with_file_name(name);
    assert!(built.exists(), "cargo builds {} with this test", built.display());
    built
}

/// Says that a test does nothing, and why.
pub fn skip(why: &str) {
    println!("SKIPPED: {why}");
}

/// The example programs.
pub fn examples() -> Vec<PathBuf> {
    let folder = std::fs::read_dir(here().join("examples/c")).expect("the folder of programs");
    let mut programs: Vec<PathBuf> = folder.map(|entry| entry.expect("an entry").path()).collect();
    programs.retain(|path| path.extension().is_some_and(|e| e == "c"));
    programs.sort();
    programs
}

/// A folder with the library for a linker and loader; with `ode`, this project's libode takes the installed one's place.
pub fn libraries(folder: &Path, ode: bool) -> PathBuf {
    std::fs::create_dir_all(folder).expect("a folder for the libraries");
    let link = |from: &Path, name: &str| {
        std::fs::remove_file(folder.join(name)).ok();
        #[cfg(unix)]
        std::os::unix::fs::symlink(from, folder.join(name)).expect("a link to the library");
    };
    for name in ["libdrawstuff.so", "libdrawstuff.so.0"] {
        link(&library("libdrawstuff.so"), name);
    }
    if ode {
        link(&library("libode.so"), "libode.so.8");
    }
    folder.to_owned()
}

/// Compiles a program against this library and, if it asks for ODE, the installed one; `None` (said loudly) if these, or a
/// compiler, are missing.
pub fn compile(source: &Path, folder: &Path, libraries: &Path) -> Option<PathBuf> {
    let program = folder.join(source.file_stem().expect("a file name"));
    let mut compiler = Command::new("cc");
    compiler.args(["-Wall", "-Wextra", "-Wno-unused-function", "-o"]).arg(&program).arg(source);
    compiler.arg("-I").arg(here().join("include")).arg("-L").arg(libraries).arg("-ldrawstuff");
    if std::fs::read_to_string(source).expect("the program's text").contains("demo.h") {
        compiler.arg("-lode");
    }
    let Ok(output) = compiler.arg("-lm").output() else {
        skip("there is no C compiler (apt install gcc)");
        return None;
    };
    if output.status.success() {
        return Some(program);
    }
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let missing = errors.contains("ode/ode.h") || errors.contains("-lode");
    assert!(missing, "{} does not compile:\n{errors}", source.display());
    skip("there is no libode-dev (apt install libode-dev)");
    None
}

/// A command that runs a program with the libraries of a folder, with none of the variables that change how.
pub fn program(path: &Path, libraries: &Path) -> Command {
    let mut command = Command::new(path);
    command.env("LD_LIBRARY_PATH", libraries);
    // A layer of Mesa's that asks the X server for its device prints complaints where that has none.
    command.env("NODEVICE_SELECT", "1");
    for name in ["HEADLESS", "DUMP", "FRAMES", "EVERY", "STEP", "SIZE", "KEYS"] {
        command.env_remove(format!("DRAWSTUFF_{name}"));
    }
    for name in ["DISPLAY", "WAYLAND_DISPLAY"] {
        command.env_remove(name);
    }
    command
}

/// Runs a command that has to succeed, and gives what it prints.
pub fn succeed(command: &mut Command) -> String {
    let output = command.output().expect("the program starts");
    assert!(output.status.success(), "{command:?} ends with {}:\n{}", output.status, said(&output));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// All that a program printed.
pub fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// Lines that differ: words have to be the same, or numbers that agree to `tolerance`, relative above 1.
pub fn differences(name: &str, wanted: &str, got: &str, tolerance: f64) -> Vec<String> {
    let near = |a: &str, b: &str| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= tolerance * a.abs().max(1.0),
        _ => false,
    };
    let mut faults = Vec::new();
    let (mut a, mut b) = (wanted.lines(), got.lines());
    for number in 1.. {
        let (a, b) = (a.next(), b.next());
        if a.is_none() && b.is_none() {
            break;
        }
        let (a, b) = (a.unwrap_or("(end)"), b.unwrap_or("(end)"));
        let same = a.split_whitespace().count() == b.split_whitespace().count()
            && a.split_whitespace().zip(b.split_whitespace()).all(|(a, b)| a == b || near(a, b));
        if !same {
            faults.push(format!("{name}, line {number}:\n  wanted: {a}\n  got:    {b}"));
        }
    }
    faults
}

/// Whether pictures can be drawn; says loudly if not.
pub fn has_driver() -> bool {
    match ferrode_render::Gpu::offscreen() {
        Ok(_) => true,
        Err(error) if std::env::var_os("FERRODE_NEEDS_DRIVER").is_none() => {
            skip(&error.to_string());
            false
        }
        Err(error) => panic!("{error}"),
    }
}

/// A picture: width, height and three bytes a pixel.
pub fn picture(path: &Path) -> (usize, usize, Vec<u8>) {
    let file = std::fs::File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a PNG file");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a picture of a size")];
    let info = reader.next_frame(&mut pixels).expect("a picture");
    (info.width as usize, info.height as usize, pixels)
}

/// A virtual display, closed when it is dropped.
pub struct Display {
    server: Child,
    /// Its name, such as `:7`.
    pub name: String,
    dump: PathBuf,
}

impl Display {
    /// Opens one of a size, or `None` (said loudly) without Xvfb.
    pub fn open(folder: &Path, size: [u32; 2]) -> Option<Self> {
        use std::io::{BufRead, BufReader};
        let screen = format!("{}x{}x24", size[0], size[1]);
        let mut command = Command::new("Xvfb");
        // Without reset, when the last program has left: the next may come meanwhile.
        command.args(["-noreset", "-displayfd", "1", "-nolisten", "tcp"]);
        command.args(["-screen", "0", &screen, "-fbdir"]).arg(folder);
        let Ok(mut server) = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn() else {
            skip("Xvfb is not installed (apt install xvfb)");
            return None;
        };
        let mut number = String::new();
        let output = server.stdout.take().expect("its output");
        BufReader::new(output).read_line(&mut number).expect("the display's number");
        assert!(!number.trim().is_empty(), "Xvfb gave no display");
        Some(Self { server, name: format!(":{}", number.trim()), dump: folder.join("Xvfb_screen0") })
    }

    /// What it shows now: three bytes a pixel, row by row.
    pub fn pixels(&self) -> Vec<u8> {
        let dump = std::fs::read(&self.dump).expect("the display's memory");
        // The dump's header: numbers of 4 bytes, the most significant first (X11/XWDFile.h).
        let number =
            |n: usize| u32::from_be_bytes(dump[4 * n..4 * n + 4].try_into().expect("four bytes")) as usize;
        let (header, width, height, stride, colors) =
            (number(0), number(4), number(5), number(12), number(19));
        assert_eq!(number(11), 32, "bits a pixel");
        let little = number(7) == 0;
        let rows = dump[header + colors * 12..].chunks_exact(stride).take(height);
        let pixel = |p: &[u8]| if little { [p[2], p[1], p[0]] } else { [p[1], p[2], p[3]] };
        rows.flat_map(|row| row[..4 * width].chunks_exact(4).flat_map(pixel)).collect()
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}
