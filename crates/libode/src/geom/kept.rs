//! Places for what a record keeps and cells cannot hold: threads may look at one geom at once.

use crate::real::Real;
use core::array;
use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use ferrode_math::{Aabb, Vec3};

#[cfg(feature = "single")]
type AtomicBits = core::sync::atomic::AtomicU32;
#[cfg(not(feature = "single"))]
type AtomicBits = AtomicU64;

/// Something of a record's that is looked at by reference. Several threads may look at once; changing it while another
/// looks is against the C interface's contract, as it is for ODE's geoms.
#[derive(Default)]
pub struct Kept<T>(UnsafeCell<T>);

impl<T> Kept<T> {
    /// Looks at it. `work` must neither call out to the program nor change the same record.
    #[inline]
    pub fn with<R>(&self, work: impl FnOnce(&T) -> R) -> R
    where
        T: Sync,
    {
        // SAFETY: `work` does not change it (this crate's rule, kept at every call), and nobody else does meanwhile.
        work(unsafe { &*self.0.get() })
    }

    /// Changes it. `work` must neither call out to the program nor use the same record's content by another way.
    #[inline]
    pub fn change<R>(&self, work: impl FnOnce(&mut T) -> R) -> R
    where
        T: Send,
    {
        // SAFETY: as above; no other reference to the content is in use.
        work(unsafe { &mut *self.0.get() })
    }

    /// Puts something else in its place.
    pub fn set(&self, value: T)
    where
        T: Send,
    {
        drop(self.change(|old| core::mem::replace(old, value)));
    }
}

/// Reals that the program has a pointer to, and that every thread that looks at a geom may bring up to date: all write the
/// same.
pub struct Shown<const N: usize>(UnsafeCell<[Real; N]>);

impl<const N: usize> Default for Shown<N> {
    fn default() -> Self {
        Self(UnsafeCell::new([0.0; N]))
    }
}

impl<const N: usize> Shown<N> {
    fn places(&self) -> [&AtomicBits; N] {
        // SAFETY: the numbers live as long as the borrow, are aligned as their bits are, and the library reaches them in no
        // other way than by atomics; what the program does through its pointer is by its contract not at the same time.
        array::from_fn(|i| unsafe { AtomicBits::from_ptr(self.as_ptr().wrapping_add(i).cast()) })
    }

    #[inline]
    pub fn get(&self) -> [Real; N] {
        self.places().map(|place| Real::from_bits(place.load(Ordering::Relaxed)))
    }

    #[inline]
    pub fn set(&self, numbers: [Real; N]) {
        for (place, number) in self.places().into_iter().zip(numbers) {
            place.store(number.to_bits(), Ordering::Relaxed);
        }
    }

    /// Where the numbers are.
    pub fn as_ptr(&self) -> *mut Real {
        self.0.get().cast()
    }
}

/// A world box, or that it has to be computed anew. Threads that look at one geom at once may each do so: all get the same.
pub struct KeptBox {
    fresh: AtomicBool,
    numbers: [AtomicU64; 6],
}

impl Default for KeptBox {
    fn default() -> Self {
        Self { fresh: AtomicBool::new(false), numbers: array::from_fn(|_| AtomicU64::new(0)) }
    }
}

impl KeptBox {
    /// The box, unless it is out of date.
    pub fn get(&self) -> Option<Aabb> {
        let at = |i: usize| f64::from_bits(self.numbers[i].load(Ordering::Relaxed));
        let corner = |i| Vec3::new(at(i), at(i + 1), at(i + 2));
        self.fresh.load(Ordering::Acquire).then(|| Aabb::new(corner(0), corner(3)))
    }

    /// The box is this one until something moves.
    pub fn set(&self, aabb: &Aabb) {
        let numbers = aabb.min.to_array().into_iter().chain(aabb.max.to_array());
        for (place, number) in self.numbers.iter().zip(numbers) {
            place.store(number.to_bits(), Ordering::Relaxed);
        }
        self.fresh.store(true, Ordering::Release);
    }

    /// The box is out of date.
    pub fn forget(&self) {
        self.fresh.store(false, Ordering::Relaxed);
    }
}
