//! A place for what a record keeps and cells cannot hold.

use core::cell::UnsafeCell;

/// Something of a record's that is looked at by reference. Several threads may look at once; changing it while another
/// looks is against the C interface's contract, as it is for ODE's geoms.
#[derive(Default)]
pub struct Kept<T>(UnsafeCell<T>);

impl<T> Kept<T> {
    /// Looks at it. `work` must neither call out to the program nor change the same record.
    #[inline]
    pub fn with<R>(&self, work: impl FnOnce(&T) -> R) -> R {
        // SAFETY: `work` does not change it (this crate's rule, kept at every call), and nobody else does meanwhile.
        work(unsafe { &*self.0.get() })
    }

    /// Changes it. `work` must neither call out to the program nor use the same record's content by another way.
    #[inline]
    pub fn change<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        // SAFETY: as above; no other reference to the content is in use.
        work(unsafe { &mut *self.0.get() })
    }

    /// Puts something else in its place.
    pub fn set(&self, value: T) {
        drop(self.change(|old| core::mem::replace(old, value)));
    }
}
