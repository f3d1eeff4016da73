//! Processor time of the calling thread: what a step costs, whatever else the machine is busy with.

use core::ffi::{c_int, c_long};

#[repr(C)]
struct TimeSpec {
    seconds: i64,
    nanoseconds: c_long,
}

/// `CLOCK_THREAD_CPUTIME_ID` of Linux.
const THREAD: c_int = 3;

unsafe extern "C" {
    fn clock_gettime(clock: c_int, out: *mut TimeSpec) -> c_int;
}

/// Seconds of processor time that this thread has used.
pub fn thread_seconds() -> f64 {
    let mut time = TimeSpec { seconds: 0, nanoseconds: 0 };
    // SAFETY: `time` has the layout of a `struct timespec` of 64-bit Linux, and is written before the call returns.
    let failed = unsafe { clock_gettime(THREAD, &mut time) };
    assert!(failed == 0, "this system has no clock for a thread's processor time");
    time.seconds as f64 + 1e-9 * time.nanoseconds as f64
}
