//! Stopwatches, and the timer that notes how long the parts of a program take.

use crate::fault::export;
use crate::misc::{File, fprintf};
use crate::real::Out;
use core::ffi::{CStr, c_char, c_double, c_int, c_ulong};
use std::ffi::CString;
use std::sync::{LazyLock, Mutex, PoisonError};
use std::time::Instant;

/// `dStopwatch`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    /// Seconds of all runs that were stopped.
    time: c_double,
    /// When it was started: nanoseconds of the process's clock, and whether it runs.
    clock: [c_ulong; 2],
}

/// The clock's ticks a second.
const TICKS: f64 = 1e9;

/// The zero of the process's clock.
static EPOCH: LazyLock<Instant> = LazyLock::new(Instant::now);

fn now() -> c_ulong {
    EPOCH.elapsed().as_nanos() as c_ulong
}

/// What the timer has noted: from each mark to the next.
#[derive(Default)]
struct Timer {
    marks: Vec<(CString, c_ulong)>,
    /// Runs and total nanoseconds by slot, for averages.
    totals: Vec<(u64, u64)>,
}

/// Slots that ODE has.
const SLOTS: usize = 100;

static TIMER: Mutex<Timer> = Mutex::new(Timer { marks: Vec::new(), totals: Vec::new() });

impl Timer {
    fn mark(&mut self, description: &CStr) {
        if self.marks.len() < SLOTS {
            self.marks.push((description.to_owned(), now()));
        }
    }
}

/// The program's text.
///
/// # Safety
/// `text` is null or ends in a zero.
unsafe fn text<'a>(text: *const c_char) -> &'a CStr {
    // SAFETY: not null, and by contract with an end.
    if text.is_null() { c"" } else { unsafe { CStr::from_ptr(text) } }
}

fn timer<T>(work: impl FnOnce(&mut Timer) -> T) -> T {
    work(&mut TIMER.lock().unwrap_or_else(PoisonError::into_inner))
}

export! {
    fn dStopwatchReset(watch: Out<Stopwatch>) { watch.set([Stopwatch { time: 0.0, clock: [0; 2] }])? }
    fn dStopwatchStart(watch: Out<Stopwatch>) {
        let [old] = watch.get()?;
        watch.set([Stopwatch { time: old.time, clock: [now(), 1] }])?
    }
    fn dStopwatchStop(watch: Out<Stopwatch>) {
        let [old] = watch.get()?;
        let run = now().wrapping_sub(old.clock[0]) as f64 / TICKS;
        watch.set([Stopwatch { time: old.time + run, clock: [0; 2] }])?
    }
    fn dStopwatchTime(watch: Out<Stopwatch>) -> c_double { watch.get()?[0].time }

    fn dTimerTicksPerSecond() -> c_double { TICKS }
    fn dTimerResolution() -> c_double { 1.0 / TICKS }
    fn dTimerStart(description: *const c_char) {
        // SAFETY: the function's contract.
        let description = unsafe { text(description) };
        timer(|timer| {
            timer.marks.clear();
            timer.mark(description);
        })
    }
    fn dTimerNow(description: *const c_char) {
        // SAFETY: the function's contract.
        let description = unsafe { text(description) };
        timer(|timer| timer.mark(description))
    }
    fn dTimerEnd() {
        timer(|timer| {
            timer.mark(c"TOTAL");
            timer.totals.resize(SLOTS, (0, 0));
            for (i, pair) in timer.marks.windows(2).enumerate() {
                timer.totals[i].0 += 1;
                timer.totals[i].1 += pair[1].1.wrapping_sub(pair[0].1);
            }
        })
    }
    /// A line for each part: its time, and its share of the whole; on request its average over all runs.
    fn dTimerReport(file: *mut File, average: c_int) {
        if file.is_null() {
            return Err(crate::fault::Fault::ARGUMENT);
        }
        let lines: Vec<(CString, u64, f64)> = timer(|timer| {
            let runs = timer.totals.iter().map(|total| total.1 as f64 / total.0.max(1) as f64);
            let parts = timer.marks.windows(2).zip(runs.chain(core::iter::repeat(0.0)));
            let mut lines: Vec<_> = parts
                .map(|(pair, mean)| (pair[0].0.clone(), pair[1].1.wrapping_sub(pair[0].1), mean))
                .collect();
            // The last mark, "TOTAL" after dTimerEnd, has the whole.
            if let Some((name, _)) = timer.marks.last() {
                let whole = lines.iter().fold((0, 0.0), |sum, line| (sum.0 + line.1, sum.1 + line.2));
                lines.push((name.clone(), whole.0, whole.1));
            }
            lines
        });
        let total = lines.last().map_or(0, |line| line.1);
        let title = c"\nTimer Report (%g s resolution)\n------------\n";
        // SAFETY: the program's open file; the format takes one number.
        unsafe { fprintf(file, title.as_ptr(), 1.0 / TICKS) };
        for (name, ticks, mean) in &lines {
            let share = if total > 0 { *ticks as f64 * 100.0 / total as f64 } else { 0.0 };
            // SAFETY: as above; the format takes a text and two numbers.
            unsafe {
                fprintf(file, c"%-20s %10.4f ms %6.2f%%".as_ptr(), name.as_ptr(), *ticks as f64 / 1e6, share);
            }
            if average != 0 {
                // SAFETY: as above; the format takes one number.
                unsafe { fprintf(file, c"  (avg %10.4f ms)".as_ptr(), mean / 1e6) };
            }
            // SAFETY: a text without conversions.
            unsafe { fprintf(file, c"\n".as_ptr()) };
        }
        // SAFETY: as above; the format takes one number.
        unsafe { fprintf(file, c"\n".as_ptr()) };
    }
}
