//! Starting up, closing down, and what the library says it can do.

use crate::fault::{Fault, export};
use core::ffi::{CStr, c_char, c_int, c_uint};
use core::sync::atomic::{AtomicUsize, Ordering};

/// What Debian's library of 0.16.2 says of itself: programs look for these words.
const CONFIGURATION: &CStr = c"ODE ODE_EXT_trimesh ODE_EXT_opcode ODE_OPC_new_collider ODE_EXT_threading ODE_THR_builtin_impl ODE_double_precision";

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

    fn dGetConfiguration() -> *const c_char { CONFIGURATION.as_ptr() }
    /// 1 if the word stands in the configuration; as in ODE also for an empty one, and for one with a blank.
    fn dCheckConfiguration(token: *const c_char) -> c_int {
        if token.is_null() {
            return Err(Fault::ARGUMENT);
        }
        // SAFETY: not null, and a text with a terminating zero (the function's contract).
        let token = unsafe { CStr::from_ptr(token) }.to_bytes();
        let mut words = CONFIGURATION.to_bytes().split(|byte| *byte == b' ');
        (token.is_empty() || token.contains(&b' ') || words.any(|word| word == token)).into()
    }
}
