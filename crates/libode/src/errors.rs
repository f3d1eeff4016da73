//! Error, debug and message handlers, and the C-variadic functions that call them.

use crate::fault::export;
use core::ffi::{c_int, c_void};

const ERROR: c_int = 0;
const DEBUG: c_int = 1;
const MESSAGE: c_int = 2;

unsafe extern "C" {
    fn ferrode_ode_get_handler(which: c_int) -> *mut c_void;
    fn ferrode_ode_set_handler(which: c_int, handler: *mut c_void);
}

fn set(which: c_int, handler: *mut c_void) {
    // SAFETY: a plain atomic store; the shim calls the handler as the header says.
    unsafe { ferrode_ode_set_handler(which, handler) }
}

fn get(which: c_int) -> *mut c_void {
    // SAFETY: a plain atomic load.
    unsafe { ferrode_ode_get_handler(which) }
}

export! {
    fn dSetErrorHandler(handler: *mut c_void) { set(ERROR, handler) }
    fn dSetDebugHandler(handler: *mut c_void) { set(DEBUG, handler) }
    fn dSetMessageHandler(handler: *mut c_void) { set(MESSAGE, handler) }
    fn dGetErrorHandler() -> *mut c_void { get(ERROR) }
    fn dGetDebugHandler() -> *mut c_void { get(DEBUG) }
    fn dGetMessageHandler() -> *mut c_void { get(MESSAGE) }
}

unsafe extern "C" {
    fn ferrode_ode_error();
    fn ferrode_ode_debug();
    fn ferrode_ode_message();
}

/// Rust can't define C-variadic functions, and a linker hides what only C defines. So each is one jump that leaves all
/// arguments where they are.
macro_rules! trampolines {
    ($($name:ident => $target:ident;)+) => {
        $(
            #[unsafe(no_mangle)]
            #[unsafe(naked)]
            pub unsafe extern "C-unwind" fn $name() {
                #[cfg(any(target_arch = "x86_64", target_arch = "x86"))]
                core::arch::naked_asm!("jmp {}", sym $target);
                #[cfg(any(target_arch = "aarch64", target_arch = "arm"))]
                core::arch::naked_asm!("b {}", sym $target);
                #[cfg(any(target_arch = "riscv64", target_arch = "riscv32"))]
                core::arch::naked_asm!("tail {}", sym $target);
            }
        )+
    };
}

trampolines! {
    dError => ferrode_ode_error;
    dDebug => ferrode_ode_debug;
    dMessage => ferrode_ode_message;
}
