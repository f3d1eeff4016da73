//! How long frames take, by their parts.

use std::fmt::Write;
use std::time::Instant;

/// A part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Hands and steps of the world.
    Step,
    /// Making the scene: a list of shapes.
    Scene,
    /// Laying the panel out, if anything in it changed.
    Panel,
    /// Waiting for a texture of the window's to draw into.
    Acquire,
    /// Filling buffers, writing commands.
    Upload,
    /// Drawing by the driver.
    Render,
    /// Handing the picture to the window system.
    Present,
}

const PARTS: [(Part, &str); 7] = [
    (Part::Step, "step"),
    (Part::Scene, "scene"),
    (Part::Panel, "panel"),
    (Part::Acquire, "acquire"),
    (Part::Upload, "upload"),
    (Part::Render, "render"),
    (Part::Present, "present"),
];

/// Frames at the start that are not counted: buffers grow, programs are compiled.
const WARM_UP: usize = 10;

/// Measures a number of frames.
#[derive(Debug)]
pub struct Meter {
    wanted: usize,
    seen: usize,
    mark: Instant,
    processor: Option<f64>,
    begun: Instant,
    /// Wall time of each part in each frame, s.
    wall: [Vec<f64>; PARTS.len()],
    /// Processor time of each part, all threads together, s.
    used: [f64; PARTS.len()],
    whole: Vec<f64>,
    moving: Vec<usize>,
}

impl Meter {
    /// For so many frames.
    pub fn new(wanted: usize) -> Self {
        let now = Instant::now();
        Self {
            wanted,
            seen: 0,
            mark: now,
            processor: None,
            begun: now,
            wall: Default::default(),
            used: [0.0; PARTS.len()],
            whole: Vec::new(),
            moving: Vec::new(),
        }
    }

    /// A frame begins.
    pub fn begin(&mut self) {
        self.begun = Instant::now();
        (self.mark, self.processor) = (self.begun, processor_time());
    }

    /// The time since the last call went to a part.
    pub fn spent_on(&mut self, part: Part) {
        let now = Instant::now();
        let processor = processor_time();
        if self.seen >= WARM_UP {
            let at = part as usize;
            self.wall[at].push((now - self.mark).as_secs_f64());
            if let (Some(before), Some(after)) = (self.processor, processor) {
                self.used[at] += after - before;
            }
        }
        (self.mark, self.processor) = (now, processor);
    }

    /// A frame ends, in which so many bodies moved; `true` after the last one.
    pub fn end(&mut self, moving: usize) -> bool {
        if self.seen >= WARM_UP {
            self.whole.push(self.begun.elapsed().as_secs_f64());
            self.moving.push(moving);
        }
        self.seen += 1;
        self.whole.len() >= self.wanted
    }

    /// A table of medians.
    pub fn report(&self, what: &str) -> String {
        let mut text = String::new();
        let count = self.whole.len().max(1) as f64;
        let moving = self.moving.iter().sum::<usize>() as f64 / count;
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        let _ = writeln!(text, "{what}; {moving:.0} bodies moving, {processors} processors");
        let _ = writeln!(text, "part      median ms   90 % ms   processor ms");
        let mut line = |name: &str, times: &[f64], used: f64| {
            let [middle, most] = [0.5, 0.9].map(|share| quantile(times, share) * 1e3);
            let used = used * 1e3 / count;
            let _ = writeln!(text, "{name:<9} {middle:>9.2} {most:>9.2} {used:>14.2}");
        };
        for (part, name) in PARTS {
            line(name, &self.wall[part as usize], self.used[part as usize]);
        }
        line("whole", &self.whole, self.used.iter().sum());
        let rate = 1.0 / quantile(&self.whole, 0.5).max(1e-9);
        let _ = writeln!(text, "{rate:.1} frames/s by the median of {} frames", self.whole.len());
        text
    }
}

fn quantile(times: &[f64], share: f64) -> f64 {
    let mut sorted = times.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let at = (share * sorted.len().saturating_sub(1) as f64).round() as usize;
    sorted.get(at).copied().unwrap_or(0.0)
}

/// Processor time of all threads so far, s, in steps of 10 ms; `None` where the system does not tell it in a file.
fn processor_time() -> Option<f64> {
    // Fields 14 and 15 of proc_pid_stat(5); the second one, the name in parentheses, may hold anything.
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    let rest = text.get(text.rfind(')')? + 2..)?;
    let mut fields = rest.split(' ').skip(11);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / 100.0)
}

#[cfg(test)]
mod tests {
    use super::{Meter, Part, WARM_UP, quantile};

    #[test]
    fn quantiles_of_a_list() {
        let times = [5.0, 1.0, 4.0, 2.0, 3.0];
        assert_eq!((quantile(&times, 0.5), quantile(&times, 1.0), quantile(&[], 0.5)), (3.0, 5.0, 0.0));
    }

    #[test]
    fn it_ends_after_as_many_frames_as_were_wanted() {
        let mut meter = Meter::new(3);
        let mut frames = 0;
        loop {
            frames += 1;
            meter.begin();
            meter.spent_on(Part::Step);
            if meter.end(7) {
                break;
            }
        }
        assert_eq!(frames, WARM_UP + 3);
        let report = meter.report("a test");
        assert!(report.starts_with("a test; 7 bodies moving") && report.contains("3 frames"), "{report}");
        assert!(report.lines().any(|line| line.starts_with("render ")), "{report}");
    }
}
