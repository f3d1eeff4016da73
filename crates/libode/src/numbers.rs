//! Arrays of the program's numbers as slices of the engine's `f64`.
//!
//! With `dReal` = double they are the program's memory itself. With `dReal` = float they are copies, and what was changed
//! is written back at the end.

use crate::fault::{Fault, Outcome};
use crate::real::Real;

#[cfg(feature = "single")]
mod kind {
    use core::ops::{Deref, DerefMut};

    /// Numbers to read.
    pub type Numbers<'a> = std::borrow::Cow<'a, [f64]>;

    /// Numbers to change: a wide copy that is written back when it is dropped.
    pub struct NumbersMut<'a> {
        wide: Box<[f64]>,
        narrow: &'a mut [f32],
    }

    pub fn read(narrow: &[f32]) -> Numbers<'_> {
        narrow.iter().copied().map(f64::from).collect()
    }

    pub fn change(narrow: &mut [f32]) -> NumbersMut<'_> {
        NumbersMut { wide: read(narrow).into(), narrow }
    }

    impl Deref for NumbersMut<'_> {
        type Target = [f64];
        fn deref(&self) -> &[f64] {
            &self.wide
        }
    }

    impl DerefMut for NumbersMut<'_> {
        fn deref_mut(&mut self) -> &mut [f64] {
            &mut self.wide
        }
    }

    impl Drop for NumbersMut<'_> {
        fn drop(&mut self) {
            for (narrow, wide) in self.narrow.iter_mut().zip(&self.wide) {
                *narrow = *wide as f32;
            }
        }
    }
}

#[cfg(not(feature = "single"))]
mod kind {
    /// Numbers to read.
    pub type Numbers<'a> = &'a [f64];
    /// Numbers to change.
    pub type NumbersMut<'a> = &'a mut [f64];

    pub fn read(numbers: &[f64]) -> Numbers<'_> {
        numbers
    }

    pub fn change(numbers: &mut [f64]) -> NumbersMut<'_> {
        numbers
    }
}

pub use kind::{Numbers, NumbersMut};

/// Numbers of the program's, to read.
///
/// # Safety
/// `a` is null or good for `n` numbers that nobody changes meanwhile.
pub unsafe fn read<'a>(a: *const Real, n: usize) -> Outcome<Numbers<'a>> {
    if n == 0 {
        return Ok(kind::read(&[]));
    }
    if a.is_null() {
        return Err(Fault::ARGUMENT);
    }
    // SAFETY: not null; the rest is the caller's contract.
    Ok(kind::read(unsafe { core::slice::from_raw_parts(a, n) }))
}

/// Numbers of the program's, to change.
///
/// # Safety
/// `a` is null or good for `n` numbers that nobody else uses meanwhile.
pub unsafe fn change<'a>(a: *mut Real, n: usize) -> Outcome<NumbersMut<'a>> {
    if n == 0 {
        return Ok(kind::change(&mut []));
    }
    if a.is_null() {
        return Err(Fault::ARGUMENT);
    }
    // SAFETY: not null; the rest is the caller's contract.
    Ok(kind::change(unsafe { core::slice::from_raw_parts_mut(a, n) }))
}

/// Names arrays of the program's as slices: `numbers!(a = pointer[length]; b = mut pointer[length])`.
///
/// The contract of every exported function that takes an array is that it is null or as long as its dimensions say, and
/// that arrays that are written overlap no other.
macro_rules! numbers {
    ($($name:ident = $pointer:ident[$length:expr]),*; $($out:ident = mut $out_pointer:ident[$out_length:expr]),*) => {
        // SAFETY: the exported function's contract, above.
        $(let $name = &*unsafe { $crate::numbers::read($pointer, $length) }?;)*
        // SAFETY: as above.
        $(let $out = &mut *unsafe { $crate::numbers::change($out_pointer, $out_length) }?;)*
    };
}
pub(crate) use numbers;
