//! The installed libode as an oracle: a C interpreter of scripts, compiled when a test runs, and the same scripts run
//! by this crate.
//!
//! Nothing here is linked to the tests: the interpreter is a program of its own that is fed through a pipe.

#![allow(dead_code)] // Each test uses its part.

pub mod engine;
pub mod scene;

use std::fmt;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// One line of a script: an operation, the body or joint it is for, and numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub op: &'static str,
    pub index: usize,
    pub numbers: Vec<f64>,
}

impl Line {
    pub fn new(op: &'static str, index: usize, numbers: &[f64]) -> Self {
        Self { op, index, numbers: numbers.to_vec() }
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.op, self.index)?;
        // Rust prints the shortest decimals that read back as the same number, and infinity as C reads it.
        self.numbers.iter().try_for_each(|x| write!(f, " {x}"))
    }
}

/// One line of printed state: what it is of, and the numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    pub what: String,
    pub index: usize,
    pub numbers: Vec<f64>,
}

impl Record {
    /// Whether libode's exact solver gave up, and left the constraints that it had not come to without force.
    pub fn is_gave_up(&self) -> bool {
        self.what == "message" && self.index == 3
    }

    /// Largest difference of a number, relative to the record's largest number if that is above 1.
    pub fn difference(&self, other: &Self) -> f64 {
        assert_eq!((&self.what, self.index), (&other.what, other.index));
        assert_eq!(self.numbers.len(), other.numbers.len());
        let scale = other.numbers.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        let worst = self.numbers.iter().zip(&other.numbers).map(|(a, b)| (a - b).abs());
        let worst = worst.fold(0.0, |m: f64, d| if d.is_nan() { f64::INFINITY } else { m.max(d) });
        worst / scale
    }
}

/// The compiled interpreter, or `None` where libode's headers and library or a C compiler are missing.
fn oracle() -> Option<&'static PathBuf> {
    static ORACLE: OnceLock<Option<PathBuf>> = OnceLock::new();
    ORACLE
        .get_or_init(|| {
            let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/oracle/ode_oracle.c");
            let program = PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
                .join(concat!("ode_oracle_", env!("CARGO_CRATE_NAME")));
            let run = |args: &[&str]| Command::new("cc").args(args).stderr(Stdio::null()).status();
            let probe = run(&["-E", "-include", "ode/ode.h", "-x", "c", "/dev/null", "-o", "/dev/null"]);
            if !probe.is_ok_and(|status| status.success()) {
                eprintln!(
                    "SKIPPED: no C compiler, or libode's headers are not installed (Debian: libode-dev)"
                );
                return None;
            }
            let out = program.to_str().expect("target directory in UTF-8");
            let built = run(&["-O1", "-o", out, source, "-lode"]).expect("cc ran a moment ago");
            assert!(built.success(), "the interpreter does not compile: cc -O1 -o {out} {source} -lode");
            Some(program)
        })
        .as_ref()
}

/// What libode printed, and how it ended if it aborted.
pub struct Output {
    pub records: Vec<Record>,
    pub abort: Option<String>,
}

/// Runs a script on libode. `None` if that is not installed; the reason was printed.
pub fn run(lines: &[Line]) -> Option<Output> {
    let program = oracle()?;
    let mut text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    text.push('\n');
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("start the interpreter");
    let mut stdin = child.stdin.take().expect("stdin is piped");
    let writer = std::thread::spawn(move || stdin.write_all(text.as_bytes()));
    let output = child.wait_with_output().expect("read what the interpreter prints");
    let written = writer.join().expect("the writing thread does not panic");
    let failed = !output.status.success() || written.is_err();
    let abort = failed.then(|| {
        let errors = String::from_utf8_lossy(&output.stderr);
        format!("{}: {}", output.status, errors.trim())
    });
    let records = String::from_utf8_lossy(&output.stdout).lines().filter_map(record).collect();
    Some(Output { records, abort })
}

fn record(line: &str) -> Option<Record> {
    let mut words = line.split_whitespace();
    let what = words.next()?.to_string();
    let index = words.next()?.parse().ok()?;
    let numbers = words.map(|w| w.parse::<f64>().ok()).collect::<Option<_>>()?;
    Some(Record { what, index, numbers })
}
