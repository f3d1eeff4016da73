//! Slots with keys that never match anything but the object they were made for.

use core::sync::atomic::{AtomicU64, Ordering};

/// Serial numbers are drawn from here in blocks, so that arenas rarely meet.
static NEXT_BLOCK: AtomicU64 = AtomicU64::new(1);
const BLOCK: u64 = 256;

/// Where an object lives, and which object it is. Serials are unique in the process, so a key that went stale or
/// comes from another arena matches nothing. Zero is never a serial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Key {
    pub slot: u32,
    pub serial: u64,
}

#[derive(Debug)]
pub(crate) struct Arena<T> {
    slots: Vec<Slot<T>>,
    free: Vec<u32>,
    next_serial: u64,
    block_end: u64,
    len: usize,
}

#[derive(Clone, Debug)]
struct Slot<T> {
    serial: u64,
    value: Option<T>,
}

impl<T> Default for Arena<T> {
    fn default() -> Self {
        Self { slots: Vec::new(), free: Vec::new(), next_serial: 0, block_end: 0, len: 0 }
    }
}

impl<T: Clone> Clone for Arena<T> {
    /// The copies answer to the keys of the originals. New objects of either get serials of their own, so the copy
    /// does not inherit the rest of the block.
    fn clone(&self) -> Self {
        Self {
            slots: self.slots.clone(),
            free: self.free.clone(),
            next_serial: 0,
            block_end: 0,
            len: self.len,
        }
    }
}

impl<T> Arena<T> {
    pub fn insert(&mut self, value: T) -> Key {
        if self.next_serial == self.block_end {
            self.next_serial = NEXT_BLOCK.fetch_add(BLOCK, Ordering::Relaxed);
            self.block_end = self.next_serial + BLOCK;
        }
        let serial = self.next_serial;
        self.next_serial += 1;
        self.len += 1;
        let filled = Slot { serial, value: Some(value) };
        let slot = match self.free.pop() {
            Some(slot) => {
                self.slots[slot as usize] = filled;
                slot
            }
            None => {
                self.slots.push(filled);
                (self.slots.len() - 1) as u32
            }
        };
        Key { slot, serial }
    }

    pub fn remove(&mut self, key: Key) -> Option<T> {
        let slot = self.slots.get_mut(key.slot as usize).filter(|s| s.serial == key.serial)?;
        let value = slot.value.take()?;
        slot.serial = 0;
        self.free.push(key.slot);
        self.len -= 1;
        Some(value)
    }

    #[inline]
    pub fn get(&self, key: Key) -> Option<&T> {
        self.slots.get(key.slot as usize).filter(|s| s.serial == key.serial)?.value.as_ref()
    }

    #[inline]
    pub fn get_mut(&mut self, key: Key) -> Option<&mut T> {
        self.slots.get_mut(key.slot as usize).filter(|s| s.serial == key.serial)?.value.as_mut()
    }

    /// The object in a slot known to be filled.
    #[inline]
    pub fn at(&self, slot: u32) -> Option<&T> {
        self.slots.get(slot as usize)?.value.as_ref()
    }

    #[inline]
    pub fn at_mut(&mut self, slot: u32) -> Option<&mut T> {
        self.slots.get_mut(slot as usize)?.value.as_mut()
    }

    /// The key of the object in a slot.
    #[inline]
    pub fn key_at(&self, slot: u32) -> Key {
        Key { slot, serial: self.slots.get(slot as usize).map_or(0, |s| s.serial) }
    }

    pub fn len(&self) -> usize {
        self.len
    }

    pub fn iter(&self) -> impl Iterator<Item = (Key, &T)> {
        self.slots
            .iter()
            .enumerate()
            .filter_map(|(i, s)| s.value.as_ref().map(|v| (Key { slot: i as u32, serial: s.serial }, v)))
    }
}
