//! The program's memory functions: `dAlloc` and its kin, by handlers or by the C library.

use crate::fault::export;
use core::ffi::c_void;
use core::ptr::{self, NonNull};
use core::sync::atomic::{AtomicPtr, Ordering};

type Alloc = unsafe extern "C-unwind" fn(usize) -> *mut c_void;
type Realloc = unsafe extern "C-unwind" fn(*mut c_void, usize, usize) -> *mut c_void;
type Free = unsafe extern "C-unwind" fn(*mut c_void, usize);

/// A handler that may be set from any thread; null stands for the default.
struct Slot(AtomicPtr<c_void>);

static ALLOC: Slot = Slot(AtomicPtr::new(ptr::null_mut()));
static REALLOC: Slot = Slot(AtomicPtr::new(ptr::null_mut()));
static FREE: Slot = Slot(AtomicPtr::new(ptr::null_mut()));

impl Slot {
    fn set(&self, handler: *mut c_void) {
        self.0.store(handler, Ordering::Release);
    }

    fn get(&self) -> *mut c_void {
        self.0.load(Ordering::Acquire)
    }
}

unsafe extern "C" {
    fn malloc(size: usize) -> *mut c_void;
    fn realloc(block: *mut c_void, size: usize) -> *mut c_void;
    fn free(block: *mut c_void);
}

/// A function pointer as it is kept: `Option` of one has null for none.
fn kept<F>(handler: F) -> *mut c_void {
    const { assert!(size_of::<F>() == size_of::<*mut c_void>()) };
    // SAFETY: only called with Option<fn>, which has the size of a pointer and no invalid bits.
    unsafe { core::mem::transmute_copy(&handler) }
}

/// The function pointer that [`kept`] made the number of.
///
/// # Safety
/// `F` is the type that `handler` was kept as.
unsafe fn given<F>(handler: *mut c_void) -> F {
    const { assert!(size_of::<F>() == size_of::<*mut c_void>()) };
    // SAFETY: by contract the bits of an F.
    unsafe { core::mem::transmute_copy(&handler) }
}

fn alloc_handler() -> Option<Alloc> {
    // SAFETY: only dSetAllocHandler sets it.
    unsafe { given(ALLOC.get()) }
}

fn realloc_handler() -> Option<Realloc> {
    // SAFETY: only dSetReallocHandler sets it.
    unsafe { given(REALLOC.get()) }
}

fn free_handler() -> Option<Free> {
    // SAFETY: only dSetFreeHandler sets it.
    unsafe { given(FREE.get()) }
}

/// Memory from the program's handler, or the C library's.
///
/// # Safety
/// The handler, if there is one, is as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dAlloc(size: usize) -> *mut c_void {
    match alloc_handler() {
        // SAFETY: the program's own function.
        Some(handler) => unsafe { handler(size) },
        // SAFETY: always allowed.
        None => unsafe { malloc(size) },
    }
}

/// Memory of another size with the same content.
///
/// # Safety
/// `block` is null or from `dAlloc` or `dRealloc`, of the old size.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dRealloc(block: *mut c_void, oldsize: usize, newsize: usize) -> *mut c_void {
    match realloc_handler() {
        // SAFETY: the program's own function, called by its contract.
        Some(handler) => unsafe { handler(block, oldsize, newsize) },
        // SAFETY: the caller's contract.
        None => unsafe { realloc(block, newsize) },
    }
}

/// Gives memory back; null has no effect.
///
/// # Safety
/// `block` is null or from `dAlloc` or `dRealloc`, of that size.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dFree(block: *mut c_void, size: usize) {
    if block.is_null() {
        return;
    }
    match free_handler() {
        // SAFETY: the program's own function, called by its contract.
        Some(handler) => unsafe { handler(block, size) },
        // SAFETY: the caller's contract.
        None => unsafe { free(block) },
    }
}

/// Who takes back what the program's handler gave: the other handler as it was then, or the C library.
#[derive(Clone, Copy, Debug)]
pub struct Lender(Option<Free>);

impl Lender {
    /// Room for a `T` from the program's handler, if it has set one that has room.
    pub fn room<T>() -> Option<(NonNull<T>, Self)> {
        const { assert!(align_of::<T>() <= 16) };
        let handler = alloc_handler()?;
        let lender = Self(free_handler());
        // SAFETY: the program's own function, called by its contract.
        let room = NonNull::new(unsafe { handler(size_of::<T>()) }.cast::<T>())?;
        if room.is_aligned() {
            return Some((room, lender));
        }
        // SAFETY: just from the handler.
        unsafe { lender.take_back(room.as_ptr()) };
        None
    }

    /// Gives room back.
    ///
    /// # Safety
    /// It came from [`Lender::room`] with this lender, and nothing is in it any more.
    pub unsafe fn take_back<T>(self, room: *mut T) {
        match self.0 {
            // SAFETY: the program's own function, called by its contract.
            Some(handler) => unsafe { handler(room.cast(), size_of::<T>()) },
            // SAFETY: the caller's contract; without a handler of its own the program's blocks are the C library's.
            None => unsafe { free(room.cast()) },
        }
    }
}

/// A block of zeros, of the program's handler if it has set one.
pub fn zeros(size: usize) -> *mut c_void {
    // SAFETY: the handler is the program's own.
    let block = unsafe { dAlloc(size) };
    if !block.is_null() {
        // SAFETY: as large as was asked for.
        unsafe { block.cast::<u8>().write_bytes(0, size) };
    }
    block
}

export! {
    fn dSetAllocHandler(handler: Option<Alloc>) { ALLOC.set(kept(handler)) }
    fn dSetReallocHandler(handler: Option<Realloc>) { REALLOC.set(kept(handler)) }
    fn dSetFreeHandler(handler: Option<Free>) { FREE.set(kept(handler)) }
    fn dGetAllocHandler() -> Option<Alloc> { alloc_handler() }
    fn dGetReallocHandler() -> Option<Realloc> { realloc_handler() }
    fn dGetFreeHandler() -> Option<Free> { free_handler() }
}
