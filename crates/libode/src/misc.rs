//! The process's random numbers, self-tests, and printing.

use crate::fault::{Fault, export};
use crate::real::{Real, f, r};
use core::ffi::{c_char, c_int, c_ulong, c_void};
use core::sync::atomic::{AtomicU32, Ordering};
use ferrode_lcp::dense::pad;
use ferrode_math::random::OdeRandom;

/// The one stream that all worlds and `dRand` draw from.
static SEED: AtomicU32 = AtomicU32::new(0);

/// The stream's state.
pub fn seed() -> u32 {
    SEED.load(Ordering::Relaxed)
}

/// Sets the stream's state.
pub fn set_seed(seed: u32) {
    SEED.store(seed, Ordering::Relaxed);
}

/// Draws from the stream what no other thread gets too; `draw` is called again if one came in between.
pub fn with_random<T>(mut draw: impl FnMut(&mut OdeRandom) -> T) -> T {
    loop {
        let before = seed();
        let mut random = OdeRandom::new(before);
        let drawn = draw(&mut random);
        if SEED.compare_exchange(before, random.seed(), Ordering::Relaxed, Ordering::Relaxed).is_ok() {
            return drawn;
        }
    }
}

/// One draw.
fn next() -> u32 {
    with_random(OdeRandom::next_u32)
}

/// A stream of the C library's, `FILE`.
pub type File = c_void;

unsafe extern "C" {
    pub fn fprintf(file: *mut File, format: *const c_char, ...) -> c_int;
}

export! {
    fn dRand() -> c_ulong { next().into() }
    fn dRandGetSeed() -> c_ulong { seed().into() }
    /// The upper half of a 64-bit seed has no meaning.
    fn dRandSetSeed(s: c_ulong) { set_seed(s as u32) }
    fn dRandReal() -> Real { r(f64::from(next()) / f64::from(u32::MAX)) }
    fn dRandInt(n: c_int) -> c_int { with_random(|random| random.next_below(n.cast_unsigned())) as c_int }
    /// 1 if the generator gives the stream that it must.
    fn dTestRand() -> c_int {
        let mut random = OdeRandom::new(0);
        let first = [random.next_u32(), random.next_u32(), random.next_u32(), random.next_u32(), random.next_u32()];
        (first == [0x3c6e_f35f, 0x4750_2932, 0xd1cc_f6e9, 0xaaf9_5334, 0x6252_e503]).into()
    }

    fn dPrintMatrix(a: *const Real, n: c_int, m: c_int, format: *const c_char, file: *mut File) {
        let (n, m) = (n.max(0) as usize, m.max(0) as usize);
        if n > 0 && (file.is_null() || m > 0 && (a.is_null() || format.is_null())) {
            return Err(Fault::ARGUMENT);
        }
        for i in 0..n {
            for j in 0..m {
                // SAFETY: within the n x m matrix that the program gives (the function's contract).
                let x = unsafe { a.add(i * pad(m) + j).read() };
                // SAFETY: the program's format takes one number, and its file is open (the function's contract).
                unsafe { fprintf(file, format, f(x)) };
            }
            // SAFETY: a text without conversions.
            unsafe { fprintf(file, c"\n".as_ptr()) };
        }
    }

    /// Runs the self-test of the boxed complementarity solver; 1 if every answer checks out.
    fn dTestSolveLCP() -> c_int { crate::selftest::lcp().into() }
    /// Runs the self-test of a world's lists and the matrix functions; the debug handler hears of a fault.
    fn dTestDataStructures() {
        if !crate::selftest::structures() {
            return Err(Fault::internal("assertion \"data structures are sound\" failed"));
        }
    }
}
