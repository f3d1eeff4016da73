//! Threads for steps: the interface by which a program lends the library its threads, and two implementations of it.
//!
//! An implementation is a table of functions. A program may bring one of its own; the built-in ones run calls in the
//! waiting thread ("self-threaded") or in threads that serve them ("multi-threaded", [`pool`]).

mod calls;
mod functions;
mod pool;

use crate::fault::{Fault, Outcome};
use crate::real::Real;
use crate::record::{WorldRecord, record};
use crate::slab::{Handle, Pool, Record, Tag};
use crate::stepping::Method;
use core::cell::Cell;
use core::ffi::{c_char, c_int, c_long, c_uint, c_void};
use std::sync::Arc;

pub use calls::{Call, Calls};

pub type ImplementationId = Handle<ImplementationRecord>;

/// An implementation, built in.
#[derive(Default)]
pub struct ImplementationRecord {
    tag: Tag,
    calls: Cell<Option<*const Calls>>,
}
record!(ImplementationRecord, IMPLEMENTATIONS, 5);

impl ImplementationRecord {
    /// The implementation's calls. They live on while someone serves them.
    fn calls(&self) -> Outcome<Arc<Calls>> {
        let calls = self.calls.get().ok_or(Fault::ARGUMENT)?;
        // SAFETY: from Arc::into_raw in `allocate`, and the record keeps its share until it is freed.
        unsafe {
            Arc::increment_strong_count(calls);
            Ok(Arc::from_raw(calls))
        }
    }
}

/// `dThreadedCallFunction`.
pub type CallFunction = unsafe extern "C-unwind" fn(*mut c_void, usize, *mut c_void) -> c_int;

/// `dThreadedWaitTime`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct WaitTime {
    pub seconds: c_long,
    pub nanoseconds: core::ffi::c_ulong,
}

/// `dThreadingFunctionsInfo`. A program's own table has handles of its own, so all of them are plain pointers here.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FunctionsInfo {
    pub struct_size: c_uint,
    pub alloc_mutex_group:
        Option<unsafe extern "C-unwind" fn(*mut c_void, c_uint, *const *const c_char) -> *mut c_void>,
    pub free_mutex_group: Option<unsafe extern "C-unwind" fn(*mut c_void, *mut c_void)>,
    pub lock_group_mutex: Option<unsafe extern "C-unwind" fn(*mut c_void, *mut c_void, c_uint)>,
    pub unlock_group_mutex: Option<unsafe extern "C-unwind" fn(*mut c_void, *mut c_void, c_uint)>,
    pub alloc_call_wait: Option<unsafe extern "C-unwind" fn(*mut c_void) -> *mut c_void>,
    pub reset_call_wait: Option<unsafe extern "C-unwind" fn(*mut c_void, *mut c_void)>,
    pub free_call_wait: Option<unsafe extern "C-unwind" fn(*mut c_void, *mut c_void)>,
    pub post_call: Option<PostCall>,
    pub alter_call_dependencies_count: Option<unsafe extern "C-unwind" fn(*mut c_void, *mut c_void, isize)>,
    pub wait_call: Option<
        unsafe extern "C-unwind" fn(*mut c_void, *mut c_int, *mut c_void, *const WaitTime, *const c_char),
    >,
    pub retrieve_thread_count: Option<unsafe extern "C-unwind" fn(*mut c_void) -> c_uint>,
    pub preallocate_resources_for_calls: Option<unsafe extern "C-unwind" fn(*mut c_void, usize) -> c_int>,
}

pub type PostCall = unsafe extern "C-unwind" fn(
    *mut c_void,
    *mut c_int,
    *mut *mut c_void,
    usize,
    *mut c_void,
    *mut c_void,
    Option<CallFunction>,
    *mut c_void,
    usize,
    *const c_char,
);

/// A step on its way to the thread that makes it, and its outcome on the way back.
struct StepCall {
    world: &'static WorldRecord,
    method: Method,
    stepsize: Real,
    outcome: Outcome<c_int>,
}

unsafe extern "C-unwind" fn step_call(
    context: *mut c_void,
    _instance: usize,
    _releasee: *mut c_void,
) -> c_int {
    // SAFETY: `run_step` passes its own StepCall and waits for the call's end.
    let call = unsafe { &mut *context.cast::<StepCall>() };
    call.outcome = crate::stepping::step(call.world, call.method, call.stepsize);
    c_int::from(matches!(call.outcome, Ok(1)))
}

/// Makes a step: in a thread of the implementation that the program has given the world, if that has any.
pub fn run_step(world: &'static WorldRecord, method: Method, stepsize: Real) -> Outcome<c_int> {
    let direct = || crate::stepping::step(world, method, stepsize);
    let Some((functions, implementation)) = world.settings.threading.get() else { return direct() };
    let implementation = core::ptr::with_exposed_provenance_mut::<c_void>(implementation.address());
    let (Some(count), Some(alloc), Some(free), Some(post), Some(wait)) = (
        functions.retrieve_thread_count,
        functions.alloc_call_wait,
        functions.free_call_wait,
        functions.post_call,
        functions.wait_call,
    ) else {
        return direct();
    };
    // A built-in pool that nobody serves would keep the step for ever; others run it in the thread that waits.
    let record = ImplementationId::from_address(implementation.addr()).live();
    let pool = record.is_some_and(|record| record.calls().is_ok_and(|calls| calls.multi));
    // SAFETY: the implementation's own functions, called as the header says.
    if pool && unsafe { count(implementation) } == 0 {
        return direct();
    }
    // SAFETY: as above.
    let token = unsafe { alloc(implementation) };
    if token.is_null() {
        return direct();
    }
    let mut call = StepCall { world, method, stepsize, outcome: Ok(0) };
    let null = core::ptr::null_mut::<c_void>();
    let (context, name) = (core::ptr::from_mut(&mut call).cast(), c"step".as_ptr());
    let (no_fault, no_releasee) = (core::ptr::null_mut(), core::ptr::null_mut());
    // SAFETY: as above; `call` lives until the wait is over.
    unsafe {
        post(implementation, no_fault, no_releasee, 0, null, token, Some(step_call), context, 0, name);
        wait(implementation, core::ptr::null_mut(), token, core::ptr::null(), name);
        free(implementation, token);
    }
    call.outcome
}

/// A new built-in implementation.
pub fn allocate(multi: bool) -> ImplementationId {
    let record = ImplementationRecord::pool().create();
    record.calls.set(Some(Arc::into_raw(Arc::new(Calls::new(multi)))));
    ImplementationId::of(record)
}

/// Frees a built-in implementation; those who serve it let go of it when it is shut down.
pub fn release(record: &'static ImplementationRecord) {
    if let Some(calls) = record.calls.take() {
        // SAFETY: from Arc::into_raw in `allocate`; taken, so given back once.
        drop(unsafe { Arc::from_raw(calls) });
    }
    ImplementationRecord::pool().destroy(record);
}
