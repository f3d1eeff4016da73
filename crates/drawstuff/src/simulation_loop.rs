//! `dsSimulationLoop`: the only place where the program's functions are called.

use crate::fault::{Fault, Outcome, guard};
use crate::numbers::{Arguments, Structure};
use crate::session;
use core::ffi::{c_char, c_int};

/// `dsFunctions` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Functions {
    version: c_int,
    start: Option<unsafe extern "C-unwind" fn()>,
    step: Option<unsafe extern "C-unwind" fn(c_int)>,
    command: Option<unsafe extern "C-unwind" fn(c_int)>,
    stop: Option<unsafe extern "C-unwind" fn()>,
    path_to_textures: *const c_char,
}

/// `DS_VERSION` of the header.
const VERSION: c_int = 0x0002;

fn begin(
    argc: c_int,
    argv: Arguments,
    size: [c_int; 2],
    functions: Structure<'_, Functions>,
) -> Outcome<Functions> {
    let functions = functions.read()?;
    if functions.version != VERSION {
        let text = format!("dsFunctions.version is {}, not DS_VERSION {VERSION}", functions.version);
        return Err(Fault::misuse(text));
    }
    let program = std::env::args_os().next().unwrap_or_default();
    let program = std::path::Path::new(&program).file_name().unwrap_or_default().to_string_lossy();
    session::begin(&argv.read(argc), size[0], size[1], &program)?;
    Ok(functions)
}

const NAME: &str = "dsSimulationLoop";

/// Nothing that needs dropping lives here while the program's functions run: they may leave by `longjmp` or by an exception.
#[allow(clippy::missing_safety_doc)]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dsSimulationLoop(
    argc: c_int,
    argv: Arguments,
    window_width: c_int,
    window_height: c_int,
    functions: Structure<'_, Functions>,
) {
    let functions = guard(NAME, || begin(argc, argv, [window_width, window_height], functions));
    if let Some(start) = functions.start {
        // SAFETY: a function of the program's; nothing of ours is borrowed or locked.
        unsafe { start() }
    }
    while guard(NAME, session::begin_frame) {
        while let Some(sign) = guard(NAME, session::next_command) {
            if let Some(command) = functions.command {
                // SAFETY: as above.
                unsafe { command(sign) }
            }
        }
        let pause = guard(NAME, session::pause);
        if let Some(step) = functions.step {
            // SAFETY: as above.
            unsafe { step(c_int::from(pause)) }
        }
        guard(NAME, session::end_frame);
    }
    if let Some(stop) = functions.stop {
        // SAFETY: as above.
        unsafe { stop() }
    }
    guard(NAME, session::end);
}
