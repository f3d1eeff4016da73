//! Faults: what a call did wrong, how the program gets to hear of it, and where panics end.
//!
//! A function's work runs inside [`guard`] and gives an [`Outcome`]. Only after it has returned, and every value of ours
//! has been dropped, is a fault raised through the C shim: ODE's debug handler is called, then the process aborts, unless
//! the handler leaves by `longjmp`, by an exception or by `exit`.

use core::ffi::{c_char, c_int};
use ferrode_dynamics::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The number of internal assertions.
pub const INTERNAL: c_int = 1;
/// The number of user errors.
pub const USER: c_int = 2;

/// What went wrong, with ODE's number for it. Plain data, so that a `longjmp` over it loses nothing.
#[derive(Clone, Copy, Debug)]
pub struct Fault {
    number: c_int,
    text: &'static str,
}

/// The result of a function's work.
pub type Outcome<T> = Result<T, Fault>;

impl Fault {
    /// A null, foreign or stale handle, or a number that makes no sense.
    pub const ARGUMENT: Self = Self::user("Bad argument(s)");

    /// A user error.
    pub const fn user(text: &'static str) -> Self {
        Self { number: USER, text }
    }

    /// What ODE reports as a failed assertion of its own.
    pub const fn internal(text: &'static str) -> Self {
        Self { number: INTERNAL, text }
    }
}

/// The engine's refusals. Numbers that are not finite are not among them: ODE takes these silently, here they have no
/// effect.
pub fn from_engine(error: &Error) -> Outcome<()> {
    Err(match error {
        Error::NotFinite { .. } => return Ok(()),
        Error::OutOfRange { value, .. } if !value.is_finite() => return Ok(()),
        Error::ZeroVector { .. } | Error::ParallelAxes { .. } => {
            Fault::internal("assertion \"the axis has a direction\" failed")
        }
        Error::NotARotation { .. } => Fault::internal("assertion \"the rotation can be normalised\" failed"),
        Error::WrongMode { what } if what.starts_with("transmission axes 1 and 2") => {
            Fault::user("can't set individual axes in current mode")
        }
        Error::WrongMode { what } if what.starts_with("transmission radii") => {
            Fault::user("can't set wheel radius explicitly in current mode")
        }
        Error::WrongMode { what } => Fault::user(what),
        Error::OutOfRange { what: "transmission ratio", .. } => Fault::user("ratio must be positive"),
        Error::OutOfRange { expected: "a positive number", .. } => Fault::user("value must be positive"),
        _ => Fault::ARGUMENT,
    })
}

/// Runs a function's work and raises its fault, or that of a panic, when nothing of it is left on the stack.
#[inline]
pub fn guard<T: Default>(name: &'static str, work: impl FnOnce() -> Outcome<T>) -> T {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(value)) => value,
        Ok(Err(fault)) => refuse(name, fault),
        Err(payload) => {
            drop(payload);
            raise(name, Fault::internal("a bug of the library: panic"))
        }
    }
}

/// As [`guard`], for work that calls back into the program: an exception of the program's passes through, which
/// `catch_unwind` would not allow. A panic ends at the fence.
#[inline]
pub fn fence<T: Default>(name: &'static str, work: impl FnOnce() -> Outcome<T>) -> T {
    struct Fence(&'static str);
    impl Drop for Fence {
        fn drop(&mut self) {
            if std::thread::panicking() {
                raise(self.0, Fault::internal("a bug of the library: panic"));
            }
        }
    }
    let fence = Fence(name);
    let outcome = work();
    core::mem::forget(fence);
    outcome.unwrap_or_else(|fault| refuse(name, fault))
}

/// What a program's mistake leads to: the debug handler; in ODE's release mode ("no-debug") nothing, the call just has no
/// effect and gives 0 or null.
#[cold]
fn refuse<T: Default>(name: &'static str, fault: Fault) -> T {
    if cfg!(feature = "no-debug") { T::default() } else { raise(name, fault) }
}

/// Calls the debug handler; does not come back.
#[cold]
pub fn raise(name: &'static str, fault: Fault) -> ! {
    // SAFETY: both texts are valid for the lengths given; the shim ends in `abort` if the handler returns.
    unsafe {
        ferrode_ode_raise(
            fault.number,
            fault.text.as_ptr().cast(),
            fault.text.len() as c_int,
            name.as_ptr().cast(),
            name.len() as c_int,
        )
    }
}

/// Sends a message; an empty `name` leaves the "in name()" out. Call it with no state borrowed: the handler may not return.
#[cold]
pub fn message(number: c_int, text: &str, name: &'static str) {
    // SAFETY: both texts are valid for the lengths given.
    unsafe {
        ferrode_ode_warn(
            number,
            text.as_ptr().cast(),
            text.len() as c_int,
            name.as_ptr().cast(),
            name.len() as c_int,
        );
    }
}

unsafe extern "C-unwind" {
    fn ferrode_ode_raise(
        n: c_int,
        text: *const c_char,
        text_len: c_int,
        name: *const c_char,
        len: c_int,
    ) -> !;
    fn ferrode_ode_warn(n: c_int, text: *const c_char, text_len: c_int, name: *const c_char, len: c_int);
}

/// Declares functions of a part that a feature leaves out: with it they do nothing and give 0 or null.
macro_rules! export_unless {
    ($feature:literal; $($(#[$meta:meta])* fn $name:ident($($arg:ident: $ty:ty),* $(,)?) $(-> $ret:ty)? $body:block)+) => {
        $(
            $(#[$meta])*
            #[allow(clippy::missing_safety_doc)]
            #[unsafe(no_mangle)]
            pub unsafe extern "C-unwind" fn $name($($arg: $ty),*) $(-> $ret)? {
                if cfg!(feature = $feature) {
                    return Default::default();
                }
                $crate::fault::guard(stringify!($name), move || Ok($body))
            }
        )+
    };
}
pub(crate) use export_unless;

/// Declares exported functions. The body is the work; it may use `?` on an [`Outcome`], and its value is the result.
///
/// Every function's contract is C's: pointer arguments are null or good for what the header says. Handles need not be.
macro_rules! export {
    ($($(#[$meta:meta])* fn $name:ident($($arg:ident: $ty:ty),* $(,)?) $(-> $ret:ty)? $body:block)+) => {
        $(
            $(#[$meta])*
            #[allow(clippy::missing_safety_doc)]
            #[unsafe(no_mangle)]
            pub unsafe extern "C-unwind" fn $name($($arg: $ty),*) $(-> $ret)? {
                $crate::fault::guard(stringify!($name), move || Ok($body))
            }
        )+
    };
}
pub(crate) use export;

/// As [`export`], for functions that may call the program's: what these throw passes through.
macro_rules! export_calling {
    ($($(#[$meta:meta])* fn $name:ident($($arg:ident: $ty:ty),* $(,)?) $(-> $ret:ty)? $body:block)+) => {
        $(
            $(#[$meta])*
            #[allow(clippy::missing_safety_doc)]
            #[unsafe(no_mangle)]
            pub unsafe extern "C-unwind" fn $name($($arg: $ty),*) $(-> $ret)? {
                $crate::fault::fence(stringify!($name), move || Ok($body))
            }
        )+
    };
}
pub(crate) use export_calling;
