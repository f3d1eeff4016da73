//! Results: printed, and kept as CSV and Markdown per machine and day.

use crate::stamp::{processor, today};
use std::fmt::Write as _;
use std::path::Path;

/// One engine on one scene.
#[derive(Clone, Debug)]
pub struct Line {
    /// The scene's name.
    pub scene: &'static str,
    /// The stepper's name.
    pub method: &'static str,
    /// The engine's name.
    pub engine: &'static str,
    /// Number of bodies.
    pub bodies: usize,
    /// Rows in the last step.
    pub rows: usize,
    /// Seconds per step, of each repetition.
    pub seconds: Vec<f64>,
    /// Largest gap in a joint at the end, in metres.
    pub joint_error: f64,
    /// Deepest penetration at the end, in metres.
    pub penetration: f64,
    /// Largest speed of a body at the end, in m/s.
    pub speed: f64,
    /// Largest distance of a body from where the other engine has it at the end, in metres.
    pub difference: Option<f64>,
}

impl Line {
    fn sorted(&self) -> Vec<f64> {
        let mut seconds = self.seconds.clone();
        seconds.sort_by(f64::total_cmp);
        seconds
    }

    /// Median milliseconds per step.
    pub fn median(&self) -> f64 {
        self.sorted().get(self.seconds.len() / 2).map_or(f64::NAN, |s| 1e3 * s)
    }

    fn fastest(&self) -> f64 {
        self.sorted().first().map_or(f64::NAN, |s| 1e3 * s)
    }
}

/// How many times as fast the first of two lines is as the second.
fn ratio(lines: &[Line]) -> Option<f64> {
    match lines {
        [a, b] if (a.scene, a.method) == (b.scene, b.method) => Some(b.median() / a.median()),
        _ => None,
    }
}

/// Prints the lines of one scene.
pub fn print(lines: &[Line]) {
    for l in lines {
        println!(
            "{:24} {:6} {:8} {:9.4} ms/step (fastest {:.4})  joint error {:.1e} m, penetration {:.1e} m, speed {:.2} m/s",
            l.scene,
            l.method,
            l.engine,
            l.median(),
            l.fastest(),
            l.joint_error,
            l.penetration,
            l.speed
        );
    }
    if let (Some(ratio), Some(difference)) = (ratio(lines), lines.iter().find_map(|l| l.difference)) {
        println!("    {ratio:.2} times as fast; final positions differ by {difference:.1e} m");
    }
}

/// Writes `<processor>-<date>.csv` and `.md` into a folder; the name without the ending.
pub fn write(folder: &str, lines: &[Line]) -> std::io::Result<String> {
    std::fs::create_dir_all(folder)?;
    let stem = format!("{}-{}", processor(), today());
    let mut csv = String::from(
        "scene,stepper,engine,bodies,rows,median_ms,fastest_ms,repetitions,joint_error_m,penetration_m,max_speed_m_s\n",
    );
    for l in lines {
        let _ = writeln!(
            csv,
            "{},{},{},{},{},{:.5},{:.5},{},{:.3e},{:.3e},{:.4}",
            l.scene,
            l.method,
            l.engine,
            l.bodies,
            l.rows,
            l.median(),
            l.fastest(),
            l.seconds.len(),
            l.joint_error,
            l.penetration,
            l.speed
        );
    }
    let mut md = format!(
        "# {stem}\n\nMilliseconds of processor time per step, medians of {} runs in alternation, one thread each. Contacts come from one recorded \
         list for both engines. Joint error, penetration and largest speed are those at the end of the run.\n\n\
         | scene | stepper | bodies | rows | ferrode | libode | ratio | joint error m (ferrode / libode) | penetration m | speed m/s | \
         positions apart m |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
        lines.first().map_or(0, |l| l.seconds.len())
    );
    for pair in lines.chunks(2) {
        if let ([a, b], Some(ratio)) = (pair, ratio(pair)) {
            let _ = writeln!(
                md,
                "| {} | {} | {} | {} | {:.4} | {:.4} | {ratio:.2} | {:.1e} / {:.1e} | {:.1e} / {:.1e} | {:.2} / {:.2} | {:.1e} |",
                a.scene,
                a.method,
                a.bodies,
                a.rows,
                a.median(),
                b.median(),
                a.joint_error,
                b.joint_error,
                a.penetration,
                b.penetration,
                a.speed,
                b.speed,
                a.difference.unwrap_or(f64::NAN)
            );
        }
    }
    let path = Path::new(folder).join(&stem);
    std::fs::write(path.with_file_name(format!("{stem}.csv")), csv)?;
    std::fs::write(path.with_file_name(format!("{stem}.md")), md)?;
    Ok(path.display().to_string())
}
