//! Where the records behind handles live.
//!
//! Records of one kind fill chunks of their own, and a chunk is never given back: the memory behind a stale handle stays a
//! record of the same kind, whose tag tells that it is dead. A table of all chunks tells a handle from any other number
//! without looking at what it points to. So no handle, however wrong, leads to undefined behaviour.

use core::alloc::Layout;
use core::cell::UnsafeCell;
use core::ffi::c_int;
use core::ptr::NonNull;
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::collections::VecDeque;

/// Size and alignment of a chunk.
const CHUNK: usize = 1 << 16;
/// Chunks that the table can hold: 2 GiB of records.
const TABLE: usize = 1 << 16;
/// Dead records are reused oldest first, and not before there are so many, so that stale handles are found out for long.
const RESERVE: usize = 64;

/// Addresses of all chunks, with the kind of their records in the low bits; open addressing.
static CHUNKS: [AtomicUsize; TABLE] = [const { AtomicUsize::new(0) }; TABLE];

#[inline]
fn slot_of(address: usize) -> usize {
    (address / CHUNK).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> (usize::BITS - TABLE.trailing_zeros())
}

/// Whether a chunk of records of a kind begins there. The first look at the table nearly always tells.
#[inline]
fn is_chunk(address: usize, kind: usize) -> bool {
    let slot = slot_of(address);
    let entry = CHUNKS[slot].load(Ordering::Acquire);
    entry == address | kind || (entry != 0 && is_chunk_from(address, kind, slot))
}

#[cold]
fn is_chunk_from(address: usize, kind: usize, mut slot: usize) -> bool {
    for _ in 0..TABLE {
        let entry = CHUNKS[slot].load(Ordering::Acquire);
        if entry == address | kind {
            return true;
        }
        if entry == 0 {
            return false;
        }
        slot = (slot + 1) % TABLE;
    }
    false
}

fn add_chunk(address: usize, kind: usize) -> bool {
    let mut slot = slot_of(address);
    for _ in 0..TABLE {
        if CHUNKS[slot].compare_exchange(0, address | kind, Ordering::AcqRel, Ordering::Relaxed).is_ok() {
            return true;
        }
        slot = (slot + 1) % TABLE;
    }
    false
}

/// The first field of every record: whether it lives. Atomic, since a stale handle may be looked at in one thread while its
/// record gets a new life in another.
#[derive(Debug, Default)]
pub struct Tag(AtomicBool);

impl Tag {
    /// Makes a dead record that was kept back a living one again.
    pub fn revive(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    #[inline]
    fn lives(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    fn die(&self) {
        self.0.store(false, Ordering::Relaxed);
    }
}

/// A kind of record: plain cells, changed through shared references.
pub trait Record: Sized + 'static {
    /// A number below 16 that no other kind has.
    const KIND: usize;

    /// A blank record.
    fn blank() -> Self;

    /// Marks a record as dead, to be kept back by whoever has it.
    fn retire(&self) {
        self.tag().die();
    }

    /// Its tag.
    fn tag(&self) -> &Tag;

    /// The pool of its kind.
    fn pool() -> &'static Pool<Self>;
}

/// The records of one kind that can be used again.
pub struct Pool<T> {
    /// Under the lock of the kind.
    free: UnsafeCell<VecDeque<NonNull<T>>>,
}

unsafe extern "C" {
    fn ferrode_ode_lock(kind: c_int);
    fn ferrode_ode_unlock(kind: c_int);
}

/// A kind's lock, held: the C library's, which the race checkers of C programs understand.
pub struct Held(c_int);

impl Held {
    fn new(kind: usize) -> Self {
        // SAFETY: below 32, the number of locks.
        unsafe { ferrode_ode_lock(kind as c_int) };
        Self(kind as c_int)
    }

    /// The lock of one record's content, for those who look at it in several threads. Records share a few locks, so nothing
    /// else may be locked, and nobody called, while this one is held.
    pub fn content<T>(record: &T) -> Self {
        Self::new(16 + (core::ptr::from_ref(record).addr() / size_of::<T>().max(1)) % 16)
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        // SAFETY: taken in `new` by this thread.
        unsafe { ferrode_ode_unlock(self.0) };
    }
}

// SAFETY: the pointers are to memory that lives for ever; the kind's lock guards the queue.
unsafe impl<T> Send for Pool<T> {}
// SAFETY: as above.
unsafe impl<T> Sync for Pool<T> {}

impl<T: Record> Default for Pool<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Record> Pool<T> {
    pub const fn new() -> Self {
        Self { free: UnsafeCell::new(VecDeque::new()) }
    }

    /// A blank living record at an address of its own.
    pub fn create(&self) -> &'static T {
        let _held = Held::new(T::KIND);
        // SAFETY: under the kind's lock nobody else uses the queue.
        let free = unsafe { &mut *self.free.get() };
        if free.len() <= RESERVE {
            Self::carve_chunk(free);
        }
        let Some(place) = free.pop_front() else { std::alloc::handle_alloc_error(Layout::new::<T>()) };
        // SAFETY: the place is in a chunk of Ts, initialised when carved, aligned, and lives for ever. It was in the
        // queue, so no living object of the program's is behind it; blank Ts have nothing to drop.
        unsafe {
            place.as_ptr().write(T::blank());
            let record = place.as_ref();
            record.tag().revive();
            record
        }
    }

    fn carve_chunk(free: &mut VecDeque<NonNull<T>>) {
        let Ok(layout) = Layout::from_size_align(CHUNK, CHUNK) else { return };
        // SAFETY: the layout is not empty.
        let Some(chunk) = NonNull::new(unsafe { std::alloc::alloc(layout) }) else { return };
        let stride = size_of::<T>();
        for i in 0..CHUNK / stride {
            // SAFETY: within the chunk, whose alignment exceeds T's; stride is T's size, a multiple of its alignment.
            let place = unsafe { chunk.add(i * stride).cast::<T>() };
            // SAFETY: fresh memory of the right size and alignment.
            unsafe { place.as_ptr().write(T::blank()) };
            free.push_back(place);
        }
        if !add_chunk(chunk.as_ptr().expose_provenance(), T::KIND) {
            // More than 2 GiB of records: these can't be told from foreign pointers, so they are not used.
            free.clear();
        }
    }

    /// Takes dead records that were kept back.
    pub fn give_back(&self, records: impl Iterator<Item = &'static T>) {
        let _held = Held::new(T::KIND);
        // SAFETY: under the kind's lock nobody else uses the queue.
        unsafe { &mut *self.free.get() }.extend(records.map(NonNull::from));
    }

    /// Marks a record as dead.
    pub fn destroy(&self, record: &'static T) {
        record.tag().die();
        let _held = Held::new(T::KIND);
        // SAFETY: under the kind's lock nobody else uses the queue.
        unsafe { &mut *self.free.get() }.push_back(NonNull::from(record));
    }
}

/// A handle as C passes it: anything at all.
#[repr(transparent)]
#[derive(Debug)]
pub struct Handle<T>(*mut T);

impl<T> Clone for Handle<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Handle<T> {}

impl<T> Handle<T> {
    pub const NULL: Self = Self(core::ptr::null_mut());

    pub fn is_null(self) -> bool {
        self.0.is_null()
    }
}

/// A handle that this library has made itself, for links between records: it is known to lead to a record, dead or alive.
pub struct Link<T: 'static>(Option<&'static T>);

impl<T> Clone for Link<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Link<T> {}

impl<T> Default for Link<T> {
    fn default() -> Self {
        Self::NULL
    }
}

impl<T> Link<T> {
    pub const NULL: Self = Self(None);

    /// The link to a record.
    #[inline]
    pub fn to(record: &'static T) -> Self {
        Self(Some(record))
    }

    #[inline]
    pub fn is_null(self) -> bool {
        self.0.is_none()
    }

    /// Whether this is a link to that record, dead or alive.
    #[inline]
    pub fn is_to(self, record: &T) -> bool {
        self.0.is_some_and(|own| core::ptr::eq(own, record))
    }

    /// Whether both lead to the same record, or nowhere.
    #[inline]
    pub fn same(self, other: Self) -> bool {
        self.address() == other.address()
    }

    /// What tells records apart; 0 for none.
    #[inline]
    pub fn address(self) -> usize {
        self.0.map_or(0, |record| core::ptr::from_ref(record).addr())
    }
}

impl<T: Record> Link<T> {
    /// The record, if it lives.
    #[inline]
    pub fn live(self) -> Option<&'static T> {
        self.0.filter(|record| record.tag().lives())
    }

    /// The record, if it is dead.
    #[inline]
    pub fn dead(self) -> Option<&'static T> {
        self.0.filter(|record| !record.tag().lives())
    }

    /// As the program sees it.
    #[inline]
    pub fn handle(self) -> Handle<T> {
        self.0.map_or(Handle::NULL, Handle::of)
    }
}

impl<T: Record> Handle<T> {
    /// The handle of a record.
    pub fn of(record: &'static T) -> Self {
        Self(core::ptr::from_ref(record).cast_mut())
    }

    /// The handle at an address that was a handle's.
    pub fn from_address(address: usize) -> Self {
        Self(core::ptr::with_exposed_provenance_mut(address))
    }

    /// The address, to be kept as a number.
    pub fn address(self) -> usize {
        self.0.expose_provenance()
    }

    /// The living record behind the handle.
    #[inline]
    pub fn live(self) -> Option<&'static T> {
        self.record().filter(|record| record.tag().lives())
    }

    #[inline]
    fn record(self) -> Option<&'static T> {
        let address = self.0.addr();
        let offset = address % CHUNK;
        // Behind the last record of a chunk there may be room for a part of one.
        let last = (CHUNK / size_of::<T>() - 1) * size_of::<T>();
        let fits = offset <= last && offset.is_multiple_of(size_of::<T>());
        if !fits || !is_chunk(address - offset, T::KIND) {
            return None;
        }
        // SAFETY: the address is that of a record in a chunk of Ts, which was initialised when the chunk was carved, is
        // never freed, and is only ever changed through cells.
        Some(unsafe { &*self.0 })
    }
}
