//! The table of functions of the built-in implementations, and the functions that make and end these.

use super::calls::{CallId, WaitId};
use super::{
    Call, CallFunction, Calls, FunctionsInfo, ImplementationId, ImplementationRecord, WaitTime, allocate,
    release,
};
use crate::fault::{Outcome, export, fence, guard};
use crate::record::{Required, record};
use crate::slab::{Handle, Pool, Record, Tag};
use core::ffi::{c_char, c_int, c_uint, c_void};
use std::sync::{Arc, Condvar, Mutex, PoisonError, RwLock};
use std::time::Duration;

type MutexGroupId = Handle<MutexGroup>;

/// A group of mutexes that one function locks and another unlocks.
#[derive(Default)]
pub struct MutexGroup {
    tag: Tag,
    /// Looked up by many threads at once.
    mutexes: RwLock<Arc<[Lock]>>,
}
record!(MutexGroup, MUTEX_GROUPS, 8);

#[derive(Default)]
struct Lock {
    taken: Mutex<bool>,
    freed: Condvar,
}

impl Lock {
    fn lock(&self) {
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        while *taken {
            taken = self.freed.wait(taken).unwrap_or_else(PoisonError::into_inner);
        }
        *taken = true;
    }

    fn unlock(&self) {
        *self.taken.lock().unwrap_or_else(PoisonError::into_inner) = false;
        self.freed.notify_one();
    }
}

fn calls(implementation: *mut c_void) -> Outcome<Arc<Calls>> {
    ImplementationId::from_address(implementation.expose_provenance()).get()?.calls()
}

fn pointer<T: Record>(handle: Handle<T>) -> *mut c_void {
    core::ptr::with_exposed_provenance_mut(handle.address())
}

fn handle<T: Record>(pointer: *mut c_void) -> Handle<T> {
    Handle::from_address(pointer.expose_provenance())
}

unsafe extern "C-unwind" fn alloc_mutex_group(
    implementation: *mut c_void,
    count: c_uint,
    _names: *const *const c_char,
) -> *mut c_void {
    guard("AllocMutexGroup", || {
        calls(implementation)?;
        let group = MutexGroup::pool().create();
        *group.mutexes.write().unwrap_or_else(PoisonError::into_inner) =
            (0..count).map(|_| Lock::default()).collect();
        Ok(pointer(MutexGroupId::of(group)))
    })
}

unsafe extern "C-unwind" fn free_mutex_group(_implementation: *mut c_void, group: *mut c_void) {
    guard("FreeMutexGroup", || {
        let group = handle::<MutexGroup>(group).get()?;
        *group.mutexes.write().unwrap_or_else(PoisonError::into_inner) = Arc::default();
        MutexGroup::pool().destroy(group);
        Ok(())
    });
}

/// A mutex of a group. The mutexes outlive the look-up.
fn mutex(group: *mut c_void, index: c_uint, work: impl FnOnce(&Lock)) -> Outcome<()> {
    let group = handle::<MutexGroup>(group).get()?;
    let mutexes = Arc::clone(&group.mutexes.read().unwrap_or_else(PoisonError::into_inner));
    work(mutexes.get(index as usize).ok_or(crate::fault::Fault::ARGUMENT)?);
    Ok(())
}

unsafe extern "C-unwind" fn lock_group_mutex(
    _implementation: *mut c_void,
    group: *mut c_void,
    index: c_uint,
) {
    guard("LockMutexGroupMutex", || mutex(group, index, Lock::lock));
}

unsafe extern "C-unwind" fn unlock_group_mutex(
    _implementation: *mut c_void,
    group: *mut c_void,
    index: c_uint,
) {
    guard("UnlockMutexGroupMutex", || mutex(group, index, Lock::unlock));
}

unsafe extern "C-unwind" fn alloc_call_wait(implementation: *mut c_void) -> *mut c_void {
    guard("AllocThreadedCallWait", || Ok(pointer(calls(implementation)?.wait_token())))
}

unsafe extern "C-unwind" fn reset_call_wait(implementation: *mut c_void, wait: *mut c_void) {
    guard("ResetThreadedCallWait", || {
        calls(implementation)?.reset_wait(handle(wait));
        Ok(())
    });
}

unsafe extern "C-unwind" fn free_call_wait(implementation: *mut c_void, wait: *mut c_void) {
    guard("FreeThreadedCallWait", || {
        calls(implementation)?.free_wait(handle(wait));
        Ok(())
    });
}

#[allow(clippy::too_many_arguments)]
unsafe extern "C-unwind" fn post_call(
    implementation: *mut c_void,
    fault: *mut c_int,
    releasee: *mut *mut c_void,
    dependencies: usize,
    dependent: *mut c_void,
    wait: *mut c_void,
    function: Option<CallFunction>,
    context: *mut c_void,
    instance: usize,
    _name: *const c_char,
) {
    guard("PostThreadedCall", || {
        let function = function.ok_or(crate::fault::Fault::ARGUMENT)?;
        let (dependent, wait): (CallId, WaitId) = (handle(dependent), handle(wait));
        let calls = calls(implementation)?;
        let call = Call { function, context, instance, dependent, wait, fault };
        calls.post(call, dependencies, |posted| {
            if !releasee.is_null() {
                // SAFETY: not null, so room for a handle (the function's contract).
                unsafe { releasee.write(pointer(posted)) };
            }
        });
        Ok(())
    });
}

unsafe extern "C-unwind" fn alter_dependencies(
    implementation: *mut c_void,
    releasee: *mut c_void,
    change: isize,
) {
    guard("AlterThreadedCallDependenciesCount", || {
        calls(implementation)?.alter(handle(releasee), change);
        Ok(())
    });
}

unsafe extern "C-unwind" fn wait_call(
    implementation: *mut c_void,
    status: *mut c_int,
    wait: *mut c_void,
    timeout: *const WaitTime,
    _name: *const c_char,
) {
    fence("WaitThreadedCall", || {
        // SAFETY: null or a time to read (the function's contract).
        let timeout = unsafe { timeout.as_ref() };
        let timeout = timeout.map(|t| {
            Duration::new(t.seconds.max(0).cast_unsigned(), 0) + Duration::from_nanos(t.nanoseconds)
        });
        let done = calls(implementation)?.wait(handle(wait), timeout);
        if !status.is_null() {
            // SAFETY: not null, so room for a number (the function's contract).
            unsafe { status.write(done.into()) };
        }
        Ok(())
    });
}

unsafe extern "C-unwind" fn thread_count(implementation: *mut c_void) -> c_uint {
    guard("RetrieveThreadingThreadCount", || Ok(calls(implementation)?.thread_count()))
}

/// Calls take memory as they come.
unsafe extern "C-unwind" fn preallocate(implementation: *mut c_void, _max_calls: usize) -> c_int {
    guard("PreallocateResourcesForCalls", || calls(implementation).map(|_| 1))
}

static FUNCTIONS: FunctionsInfo = FunctionsInfo {
    struct_size: size_of::<FunctionsInfo>() as c_uint,
    alloc_mutex_group: Some(alloc_mutex_group),
    free_mutex_group: Some(free_mutex_group),
    lock_group_mutex: Some(lock_group_mutex),
    unlock_group_mutex: Some(unlock_group_mutex),
    alloc_call_wait: Some(alloc_call_wait),
    reset_call_wait: Some(reset_call_wait),
    free_call_wait: Some(free_call_wait),
    post_call: Some(post_call),
    alter_call_dependencies_count: Some(alter_dependencies),
    wait_call: Some(wait_call),
    retrieve_thread_count: Some(thread_count),
    preallocate_resources_for_calls: Some(preallocate),
};

/// Called by a thread that is about to serve.
pub type ReadyCallback = unsafe extern "C-unwind" fn(*mut c_void);

export! {
    fn dThreadingAllocateSelfThreadedImplementation() -> ImplementationId { allocate(false) }
    fn dThreadingAllocateMultiThreadedImplementation() -> ImplementationId { allocate(true) }
    fn dThreadingImplementationGetFunctions(implementation: ImplementationId) -> *const FunctionsInfo {
        implementation.get()?;
        &raw const FUNCTIONS
    }
    fn dThreadingImplementationShutdownProcessing(implementation: ImplementationId) {
        implementation.get()?.calls()?.shut_down()
    }
    fn dThreadingImplementationCleanupForRestart(implementation: ImplementationId) {
        implementation.get()?.calls()?.restart()
    }
    fn dThreadingFreeImplementation(implementation: ImplementationId) {
        if !implementation.is_null() {
            release(implementation.get()?);
        }
    }
}

/// Serves an implementation's calls in the calling thread until it is shut down.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dExternalThreadingServeMultiThreadedImplementation(
    implementation: ImplementationId,
    ready: Option<ReadyCallback>,
    context: *mut c_void,
) {
    fence("dExternalThreadingServeMultiThreadedImplementation", || {
        let calls = ImplementationRecord::calls(implementation.get()?)?;
        calls.serve(|| {
            if let Some(ready) = ready {
                // SAFETY: the program's own function with its context.
                unsafe { ready(context) };
            }
        });
        Ok(())
    });
}
