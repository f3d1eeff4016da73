//! Slots with keys that never reach another object.
//!
//! Every object gets a serial number that is unique in the process, and a key holds slot and serial. So a stale key,
//! and a key of another world, finds nothing. Serials give identity only; no order is ever taken from them.

use core::sync::atomic::{AtomicU64, Ordering};

/// "No slot": the end of a linked list.
pub(crate) const NIL: u32 = u32::MAX;

/// The next serial number that no arena has reserved. Zero marks a vacant slot.
static NEXT_SERIAL: AtomicU64 = AtomicU64::new(1);
/// Serials are reserved in blocks, so that worlds in several threads don't fight over one counter.
const BLOCK: u64 = 4096;

/// Where a key points: a slot and the serial number of the object that it was made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct RawKey {
    pub index: u32,
    pub serial: u64,
}

/// Numbers that were reserved for one arena. A clone reserves its own.
#[derive(Debug, Default)]
struct Serials {
    next: u64,
    end: u64,
}

impl Clone for Serials {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Serials {
    fn take(&mut self) -> u64 {
        if self.next == self.end {
            self.next = NEXT_SERIAL.fetch_add(BLOCK, Ordering::Relaxed);
            self.end = self.next + BLOCK;
        }
        self.next += 1;
        self.next - 1
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Slot<T> {
    serial: u64,
    pub value: Option<T>,
}

/// A growing set of objects in stable slots.
#[derive(Clone, Debug)]
pub(crate) struct Arena<T> {
    slots: Vec<Slot<T>>,
    free: Vec<u32>,
    serials: Serials,
}

impl<T> Default for Arena<T> {
    fn default() -> Self {
        Self { slots: Vec::new(), free: Vec::new(), serials: Serials::default() }
    }
}

impl<T> Arena<T> {
    /// Number of objects.
    pub fn len(&self) -> usize {
        self.slots.len() - self.free.len()
    }

    /// Number of slots, used or not: every index is smaller.
    pub fn capacity(&self) -> usize {
        self.slots.len()
    }

    #[inline]
    pub fn insert(&mut self, value: T) -> RawKey {
        let serial = self.serials.take();
        let index = match self.free.pop() {
            Some(index) => {
                let slot = &mut self.slots[index as usize];
                slot.serial = serial;
                slot.value = Some(value);
                index
            }
            None => {
                self.slots.push(Slot { serial, value: Some(value) });
                // An arena of 2³² objects would need terabytes; the index can't overflow before memory does.
                (self.slots.len() - 1) as u32
            }
        };
        RawKey { index, serial }
    }

    /// The slot of a key's object, if it still lives.
    pub fn index_of(&self, key: RawKey) -> Option<u32> {
        let slot = self.slots.get(key.index as usize)?;
        (slot.serial == key.serial && slot.value.is_some()).then_some(key.index)
    }

    pub fn key_of(&self, index: u32) -> RawKey {
        RawKey { index, serial: self.slots[index as usize].serial }
    }

    pub fn remove(&mut self, index: u32) -> Option<T> {
        let slot = self.slots.get_mut(index as usize)?;
        let value = slot.value.take()?;
        slot.serial = 0;
        self.free.push(index);
        Some(value)
    }

    /// The object in a slot that is known to be in use, as every index in a linked list is.
    #[inline]
    pub fn at(&self, index: u32) -> &T {
        self.slots[index as usize].value.as_ref().expect("a linked slot holds an object")
    }

    /// As [`Arena::at`].
    #[inline]
    pub fn at_mut(&mut self, index: u32) -> &mut T {
        self.slots[index as usize].value.as_mut().expect("a linked slot holds an object")
    }

    /// As [`Arena::get`], to change it.
    pub fn get_mut(&mut self, index: u32) -> Option<&mut T> {
        self.slots.get_mut(index as usize)?.value.as_mut()
    }

    /// All slots in their order, to change what is in them.
    pub fn slots_mut(&mut self) -> &mut [Slot<T>] {
        &mut self.slots
    }

    /// The object in a slot, if it is in use.
    pub fn get(&self, index: u32) -> Option<&T> {
        self.slots.get(index as usize)?.value.as_ref()
    }
}

/// Declares a public key type over [`RawKey`].
macro_rules! key_type {
    ($(#[$doc:meta])* $name:ident, $word:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub(crate) $crate::arena::RawKey);

        impl core::fmt::Debug for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                write!(f, "{}#{}", $word, self.0.serial)
            }
        }

        impl core::fmt::Display for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                core::fmt::Debug::fmt(self, f)
            }
        }

        impl $name {
            /// A number that no other object of this process has had: an identity to print or to keep in a map.
            pub fn serial(self) -> u64 {
                self.0.serial
            }
        }
    };
}
pub(crate) use key_type;

#[cfg(test)]
mod tests {
    use super::Arena;

    #[test]
    fn keys_never_reach_another_object() {
        let mut a = Arena::default();
        let mut other = Arena::default();
        let first = a.insert(1);
        assert!(other.index_of(first).is_none());
        other.insert(7);
        assert!(other.index_of(first).is_none(), "a key of another arena finds nothing");
        a.remove(first.index);
        let second = a.insert(2);
        assert_eq!(second.index, first.index, "the slot is used again");
        assert!(a.index_of(first).is_none(), "the stale key finds nothing");
        let mut copy = a.clone();
        assert_eq!(copy.index_of(second), Some(second.index), "a clone knows its objects by the same keys");
        let (third, fourth) = (a.insert(3), copy.insert(4));
        assert!(a.index_of(fourth).is_none() && copy.index_of(third).is_none());
    }
}
