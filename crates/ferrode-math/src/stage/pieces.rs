//! Slices in pieces, one for each task.

use super::Crew;
use core::marker::PhantomData;

/// Something that falls into pieces: [`chunks`] of a slice, or a tuple of such, which has as many pieces as the shortest.
pub trait Pieces: Sync + sealed::Sealed {
    /// A piece.
    type Piece;
    /// How many there are.
    fn count(&self) -> usize;
    /// One of them.
    ///
    /// # Safety
    /// Each piece is asked for at most once.
    #[doc(hidden)]
    unsafe fn piece(&self, number: usize) -> Self::Piece;
}

mod sealed {
    /// Kept here, so that nobody else's pieces overlap.
    pub trait Sealed {}
}

/// Cuts a slice into chunks of `size` items; the last may have fewer.
pub fn chunks<T: Send>(list: &mut [T], size: usize) -> Chunks<'_, T> {
    Chunks { start: list.as_mut_ptr(), len: list.len(), size: size.max(1), list: PhantomData }
}

/// A slice in chunks.
pub struct Chunks<'a, T> {
    start: *mut T,
    len: usize,
    size: usize,
    list: PhantomData<&'a mut [T]>,
}

// SAFETY: all that can be had of it by reference is pieces, each of them once: it is lent to several threads as a `&mut [T]` could
// be split among them, which takes items that may be sent.
unsafe impl<T: Send> Sync for Chunks<'_, T> {}

impl<T> sealed::Sealed for Chunks<'_, T> {}

impl<'a, T: Send> Pieces for Chunks<'a, T> {
    type Piece = &'a mut [T];

    fn count(&self) -> usize {
        self.len.div_ceil(self.size)
    }

    unsafe fn piece(&self, number: usize) -> &'a mut [T] {
        assert!(number < self.count());
        let first = number * self.size;
        let len = self.size.min(self.len - first);
        // SAFETY: within the slice, which is borrowed for 'a; chunks of different numbers don't overlap, and none is lent twice.
        unsafe { core::slice::from_raw_parts_mut(self.start.add(first), len) }
    }
}

/// Cuts a slice, whose first item has the number `first`: each piece ends before the item with one of the numbers `ends`, and begins
/// where the one before it ends.
///
/// # Panics
/// When the ends don't ascend, or lie outside the slice.
pub fn cut<'a, T: Send>(list: &'a mut [T], first: usize, ends: &'a [usize]) -> Cut<'a, T> {
    let last = ends.iter().fold(first, |before, end| {
        assert!(before <= *end, "a piece ends before it begins");
        *end
    });
    assert!(last - first <= list.len(), "a piece ends beyond the slice");
    Cut { start: list.as_mut_ptr(), first, ends, list: PhantomData }
}

/// A slice in pieces of different lengths.
pub struct Cut<'a, T> {
    start: *mut T,
    first: usize,
    ends: &'a [usize],
    list: PhantomData<&'a mut [T]>,
}

// SAFETY: as for `Chunks`.
unsafe impl<T: Send> Sync for Cut<'_, T> {}

impl<T> sealed::Sealed for Cut<'_, T> {}

impl<'a, T: Send> Pieces for Cut<'a, T> {
    type Piece = &'a mut [T];

    fn count(&self) -> usize {
        self.ends.len()
    }

    unsafe fn piece(&self, number: usize) -> &'a mut [T] {
        let first = if number == 0 { self.first } else { self.ends[number - 1] };
        let len = self.ends[number] - first;
        // SAFETY: `cut` has seen that the ends ascend from `first` and stay within the slice, which is borrowed for 'a; so pieces of
        // different numbers don't overlap, and none is lent twice.
        unsafe { core::slice::from_raw_parts_mut(self.start.add(first - self.first), len) }
    }
}

macro_rules! tuples {
    ($(($($name:ident $place:tt),+))+) => {$(
        impl<$($name: Pieces),+> sealed::Sealed for ($($name,)+) {}

        impl<$($name: Pieces),+> Pieces for ($($name,)+) {
            type Piece = ($($name::Piece,)+);

            fn count(&self) -> usize {
                let counts = [$(self.$place.count()),+];
                counts.into_iter().min().unwrap_or(0)
            }

            unsafe fn piece(&self, number: usize) -> Self::Piece {
                // SAFETY: the caller's promise.
                unsafe { ($(self.$place.piece(number),)+) }
            }
        }
    )+};
}

tuples! {
    (A 0, B 1)
    (A 0, B 1, C 2)
    (A 0, B 1, C 2, D 3)
    (A 0, B 1, C 2, D 3, E 4)
    (A 0, B 1, C 2, D 3, E 4, F 5)
    (A 0, B 1, C 2, D 3, E 4, F 5, G 6)
    (A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7)
}

impl Crew {
    /// Calls `task` once with each piece and its number, in no order, and returns when all calls are done.
    ///
    /// # Panics
    /// When a task panics: the others are done, then the panic goes on in the caller.
    pub fn each<P: Pieces>(&self, pieces: P, task: impl Fn(usize, P::Piece) + Sync) {
        self.run(pieces.count(), |number| {
            // SAFETY: `run` calls with each number once, and `pieces` ends here.
            task(number, unsafe { pieces.piece(number) });
        });
    }
}
