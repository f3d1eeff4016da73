//! What a call did wrong, how the program gets to hear of it, and where panics end.

use core::ffi::{c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What went wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The machine or the user: no display, a folder that can't be written. Ends the process with status 1.
    Circumstance(String),
    /// The program: a null pointer, a wrong version. Aborts the process, for a debugger to look at.
    Misuse(String),
}

/// The result of a function's work.
pub type Outcome<T> = Result<T, Fault>;

impl Fault {
    /// A fault of the program's.
    pub fn misuse(text: impl Into<String>) -> Self {
        Self::Misuse(text.into())
    }

    /// A fault of the machine's, or of what the user asked for.
    pub fn circumstance(text: impl ToString) -> Self {
        Self::Circumstance(text.to_string())
    }
}

/// Runs a function's work, and ends the process if that fails.
pub fn guard<T>(name: &'static str, work: impl FnOnce() -> Outcome<T>) -> T {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(value)) => value,
        Ok(Err(Fault::Circumstance(text))) => fail(false, &text),
        Ok(Err(Fault::Misuse(text))) => fail(true, &format!("{text} in {name}()")),
        Err(payload) => {
            let text = payload.downcast_ref::<String>().cloned();
            let text = text.or_else(|| payload.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            fail(true, &format!("a bug of the library in {name}(): {}", text.unwrap_or_default()))
        }
    }
}

/// Says what is wrong and ends the process.
fn fail(abort: bool, text: &str) -> ! {
    // SAFETY: the text is valid for its length; the shim ends in `exit` or `abort`.
    unsafe { ferrode_drawstuff_fail(c_int::from(abort), text.as_ptr().cast(), text.len() as c_int) }
}

/// Prints to the program's output, in order with what it prints itself.
pub fn say(text: &str) {
    // SAFETY: the text is valid for its length.
    unsafe { ferrode_drawstuff_say(text.as_ptr().cast(), text.len() as c_int) }
}

/// Prints a line to the error output.
pub fn warn(text: &str) {
    // SAFETY: the text is valid for its length.
    unsafe { ferrode_drawstuff_warn(text.as_ptr().cast(), text.len() as c_int) }
}

unsafe extern "C" {
    fn ferrode_drawstuff_fail(bug: c_int, text: *const c_char, length: c_int) -> !;
    fn ferrode_drawstuff_say(text: *const c_char, length: c_int);
    fn ferrode_drawstuff_warn(text: *const c_char, length: c_int);
}

/// Declares functions of the C interface: each body is work that [`guard`] runs.
macro_rules! export {
    ($($(#[$meta:meta])* fn $name:ident($($arg:ident: $ty:ty),* $(,)?) $(-> $ret:ty)? $body:block)+) => {
        $(
            $(#[$meta])*
            #[allow(clippy::missing_safety_doc)]
            #[unsafe(no_mangle)]
            pub unsafe extern "C-unwind" fn $name($($arg: $ty),*) $(-> $ret)? {
                $crate::fault::guard(stringify!($name), || $body)
            }
        )+
    };
}
pub(crate) use export;

#[cfg(test)]
mod tests {
    use super::guard;

    #[test]
    fn work_that_succeeds_gives_its_value() {
        assert_eq!(guard("test", || Ok(3)), 3);
    }
}
