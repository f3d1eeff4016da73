//! A progress bar, on a terminal only.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// How far a run has come, shown on standard error if that is a terminal.
pub struct Progress {
    bar: ProgressBar,
    shown: Instant,
}

/// How often to redraw.
const INTERVAL: Duration = Duration::from_millis(100);

impl Progress {
    /// A bar of `steps` steps with a label, hidden unless `wanted` and standard error is a terminal.
    pub fn new(steps: u64, label: &str, wanted: bool) -> Self {
        let visible = wanted && std::io::stderr().is_terminal();
        let target = if visible { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(steps), target);
        if let Ok(style) =
            ProgressStyle::with_template("{prefix} {wide_bar} {percent:>3} % {msg} ({eta} left)")
        {
            bar.set_style(style);
        }
        bar.set_prefix(label.to_owned());
        Self { bar, shown: Instant::now() }
    }

    /// Tells that `step` steps are done, at `time` seconds of simulation.
    pub fn update(&mut self, step: u64, time: f64) {
        if self.shown.elapsed() >= INTERVAL {
            self.shown = Instant::now();
            self.bar.set_message(format!("{time:.2} s"));
            self.bar.set_position(step);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
