//! Starting up, closing down, and what the library says it can do.

use crate::fault::{Fault, export};
use core::ffi::{CStr, c_char, c_int, c_uint};
use core::sync::atomic::{AtomicUsize, Ordering};

/// What the library says of itself: programs look for these words. Without features they are those of Debian's 0.16.2.
const WORDS: [(&str, bool); 6] = [
    ("ODE", true),
    (" ODE_EXT_no_debug", cfg!(feature = "no-debug")),
    (" ODE_EXT_trimesh ODE_EXT_opcode ODE_OPC_new_collider", cfg!(not(feature = "no-trimesh"))),
    (" ODE_EXT_threading ODE_THR_builtin_impl", true),
    (" ODE_single_precision", cfg!(feature = "single")),
    (" ODE_double_precision", cfg!(not(feature = "single"))),
];

const fn joined() -> [u8; 160] {
    let (mut text, mut length, mut word) = ([0; 160], 0, 0);
    while word < WORDS.len() {
        let bytes = WORDS[word].0.as_bytes();
        let mut i = 0;
        while WORDS[word].1 && i < bytes.len() {
            text[length] = bytes[i];
            length += 1;
            i += 1;
        }
        word += 1;
    }
    text
}

static TEXT: [u8; 160] = joined();

/// The words with a terminating zero.
fn configuration() -> &'static CStr {
    CStr::from_bytes_until_nul(&TEXT).unwrap_or_default()
}

/// How many starts have not been closed.
static STARTS: AtomicUsize = AtomicUsize::new(0);

/// Whether the library was started.
pub fn is_started() -> bool {
    STARTS.load(Ordering::Acquire) > 0
}

export! {
    fn dInitODE() { STARTS.fetch_add(1, Ordering::AcqRel); }
    fn dInitODE2(_flags: c_uint) -> c_int { STARTS.fetch_add(1, Ordering::AcqRel); 1 }
    /// Objects live on: programs destroy them afterwards, from static destructors for one.
    fn dCloseODE() {
        let close = |starts: usize| starts.checked_sub(1);
        match STARTS.fetch_update(Ordering::AcqRel, Ordering::Acquire, close) {
            Err(_) => {
                return Err(Fault::user("dCloseODE must not be called without dInitODE2 or if dInitODE2 fails"));
            }
            Ok(1) => crate::geom::forget_classes(),
            Ok(_) => {}
        }
    }
    /// No data is kept by thread: there is nothing to allocate, and it always works once the library was started.
    fn dAllocateODEDataForThread(_flags: c_uint) -> c_int {
        if !is_started() {
            return Err(Fault::user("dInitODE2 must be called first"));
        }
        1
    }
    fn dCleanupODEAllDataForThread() {}

    fn dGetConfiguration() -> *const c_char { configuration().as_ptr() }
    /// 1 if the word stands in the configuration; as in ODE also for an empty one, and for one with a blank.
    fn dCheckConfiguration(token: *const c_char) -> c_int {
        if token.is_null() {
            return Err(Fault::ARGUMENT);
        }
        // SAFETY: not null, and a text with a terminating zero (the function's contract).
        let token = unsafe { CStr::from_ptr(token) }.to_bytes();
        let mut words = configuration().to_bytes().split(|byte| *byte == b' ');
        (token.is_empty() || token.contains(&b' ') || words.any(|word| word == token)).into()
    }
}
