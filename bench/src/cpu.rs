//! Processor time of this thread, which other work on the machine does not lengthen.

#[repr(C)]
struct Time {
    seconds: i64,
    nanoseconds: i64,
}

unsafe extern "C" {
    fn clock_gettime(clock: i32, time: *mut Time) -> i32;
}

/// Linux' number for the processor time of the calling thread.
const THREAD_CPUTIME: i32 = 3;

/// Seconds that this thread has run.
pub fn seconds() -> f64 {
    let mut time = Time { seconds: 0, nanoseconds: 0 };
    // SAFETY: the clock exists, and `time` has the layout of a timespec of 64-bit Linux.
    unsafe { clock_gettime(THREAD_CPUTIME, &mut time) };
    time.seconds as f64 + 1e-9 * time.nanoseconds as f64
}
