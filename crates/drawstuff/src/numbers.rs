//! What the program's pointers point to: arrays of numbers, texts.

use crate::fault::{Fault, Outcome};
use core::ffi::{CStr, c_char, c_int};
use std::fmt::Debug;
use std::marker::PhantomData;

/// `float` or `double`. Its `Debug` form is the shortest text that reads back as the same number.
pub trait Real: Copy + Debug + Into<f64> {}
impl Real for f32 {}
impl Real for f64 {}

fn null() -> Fault {
    Fault::misuse("a null pointer")
}

/// A pointer to `N` numbers to read.
#[repr(transparent)]
#[derive(Clone, Copy, Debug)]
pub struct Array<T, const N: usize>(*const T);

impl<T: Copy, const N: usize> Array<T, N> {
    /// The numbers.
    ///
    /// # Errors
    /// The pointer is null.
    pub fn read(self) -> Outcome<[T; N]> {
        self.maybe().ok_or_else(null)
    }

    /// The numbers, if the pointer is not null.
    pub fn maybe(self) -> Option<[T; N]> {
        // SAFETY: by the header, a pointer that is not null points to `N` numbers; they may be unaligned in packed structures.
        (!self.0.is_null()).then(|| unsafe { self.0.cast::<[T; N]>().read_unaligned() })
    }
}

/// A pointer to numbers whose count is told elsewhere.
#[repr(transparent)]
#[derive(Clone, Copy, Debug)]
pub struct List<T>(*const T);

impl<T: Copy> List<T> {
    /// The n-th number.
    ///
    /// # Errors
    /// The pointer is null.
    pub fn get(self, n: usize) -> Outcome<T> {
        if self.0.is_null() {
            return Err(null());
        }
        // SAFETY: callers ask for numbers that, by the header, are there.
        Ok(unsafe { self.0.add(n).read_unaligned() })
    }

    /// The first `count` numbers.
    ///
    /// # Errors
    /// The pointer is null, and the count is not 0.
    pub fn read(self, count: usize) -> Outcome<Vec<T>> {
        (0..count).map(|n| self.get(n)).collect()
    }
}

/// A pointer to `N` numbers to write; null for none wanted.
#[repr(transparent)]
#[derive(Clone, Copy, Debug)]
pub struct Out<T, const N: usize>(*mut T);

impl<T: Copy, const N: usize> Out<T, N> {
    /// Writes the numbers.
    pub fn write(self, numbers: [T; N]) {
        if !self.0.is_null() {
            // SAFETY: by the header, there is room for `N` numbers.
            unsafe { self.0.cast::<[T; N]>().write_unaligned(numbers) }
        }
    }
}

/// `argv` of a program's `main`, with `argc`.
#[repr(transparent)]
#[derive(Clone, Copy, Debug)]
pub struct Arguments(*const *const c_char);

impl Arguments {
    /// The arguments, without the program's name; null for none.
    pub fn read(self, count: c_int) -> Vec<String> {
        let count = usize::try_from(count).unwrap_or(0);
        if self.0.is_null() {
            return Vec::new();
        }
        // SAFETY: `argv` points to `argc` pointers.
        let pointers = (1..count).map(|n| unsafe { *self.0.add(n) });
        // SAFETY: each points to a text that ends in a zero.
        let texts = pointers.filter(|p| !p.is_null()).map(|p| unsafe { CStr::from_ptr(p) });
        texts.map(|text| text.to_string_lossy().into_owned()).collect()
    }
}

/// A pointer to a structure to read.
#[repr(transparent)]
#[derive(Clone, Copy, Debug)]
pub struct Structure<'a, T>(*const T, PhantomData<&'a T>);

impl<T: Copy> Structure<'_, T> {
    /// The structure.
    ///
    /// # Errors
    /// The pointer is null.
    pub fn read(self) -> Outcome<T> {
        if self.0.is_null() {
            return Err(null());
        }
        // SAFETY: by the header, it points to one.
        Ok(unsafe { self.0.read() })
    }
}

#[cfg(test)]
mod tests {
    use super::{Arguments, Array, List, Out};

    #[test]
    fn null_pointers_are_told_apart() {
        let numbers = [1.0_f32, 2.0, 3.0];
        assert_eq!(Array::<f32, 3>(numbers.as_ptr()).read(), Ok(numbers));
        assert!(Array::<f32, 3>(std::ptr::null()).read().is_err());
        assert_eq!(List(numbers.as_ptr()).read(2), Ok(vec![1.0, 2.0]));
        assert_eq!(List::<f32>(std::ptr::null()).read(0), Ok(vec![]));
        assert!(List::<f32>(std::ptr::null()).read(1).is_err());
        Out::<f32, 3>(std::ptr::null_mut()).write(numbers);
        let mut place = [0.0_f32; 3];
        Out::<f32, 3>(place.as_mut_ptr()).write(numbers);
        assert_eq!(place, numbers);
    }

    #[test]
    fn arguments_come_without_the_programs_name() {
        let texts = [c"program".as_ptr(), c"-notex".as_ptr(), std::ptr::null(), c"x".as_ptr()];
        assert_eq!(Arguments(texts.as_ptr()).read(4), ["-notex", "x"]);
        assert!(Arguments(std::ptr::null()).read(3).is_empty());
    }
}
