//! Calls that depend on each other, and the threads that run them.
//!
//! A call runs when nothing is left that it depends on. It ends when it has run and everything that it made depend on
//! itself meanwhile has ended; then its own dependent has one thing less to wait for, and who waits for it is told.

use super::CallFunction;
use crate::record::record;
use crate::slab::{Handle, Pool, Record, Tag};
use core::cell::Cell;
use core::ffi::{c_int, c_void};
use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

pub type CallId = Handle<CallRecord>;
pub type WaitId = Handle<WaitRecord>;

/// A posted call. Read and changed only under its implementation's lock.
#[derive(Default)]
pub struct CallRecord {
    tag: Tag,
    /// What it waits for: before it runs, calls that must end first; while it runs also itself.
    pending: Cell<isize>,
    ran: Cell<bool>,
    failed: Cell<bool>,
    call: Cell<Option<Call>>,
}
record!(CallRecord, CALLS, 6);

/// What tells a waiting thread that a call has ended. Read and changed only under its implementation's lock.
#[derive(Default)]
pub struct WaitRecord {
    tag: Tag,
    done: Cell<bool>,
}
record!(WaitRecord, WAITS, 7);

/// What to call, and whom to tell.
#[derive(Clone, Copy)]
pub struct Call {
    pub function: CallFunction,
    pub context: *mut c_void,
    pub instance: usize,
    pub dependent: CallId,
    pub wait: WaitId,
    pub fault: *mut c_int,
}

#[derive(Default)]
struct State {
    ready: VecDeque<CallId>,
    servers: u32,
    shut_down: bool,
}

// SAFETY: handles lead to records that live for ever; the records of calls are used under the state's lock only.
unsafe impl Send for State {}

/// The calls of one implementation.
pub struct Calls {
    state: Mutex<State>,
    changed: Condvar,
    pub multi: bool,
}

impl Calls {
    pub fn new(multi: bool) -> Self {
        Self { state: Mutex::new(State::default()), changed: Condvar::new(), multi }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Threads that serve; 0 if the waiting thread does the work.
    pub fn thread_count(&self) -> u32 {
        self.lock().servers
    }

    pub fn wait_token(&self) -> WaitId {
        WaitId::of(WaitRecord::pool().create())
    }

    pub fn reset_wait(&self, wait: WaitId) {
        let _state = self.lock();
        if let Some(wait) = wait.live() {
            wait.done.set(false);
        }
    }

    pub fn free_wait(&self, wait: WaitId) {
        let _state = self.lock();
        if let Some(wait) = wait.live() {
            WaitRecord::pool().destroy(wait);
        }
    }

    /// Posts a call that waits for so many others. `tell` gets to know it before it can run, and must not call out.
    pub fn post(&self, call: Call, dependencies: usize, tell: impl FnOnce(CallId)) {
        let mut state = self.lock();
        let record = CallRecord::pool().create();
        record.pending.set(dependencies as isize);
        record.call.set(Some(call));
        let handle = CallId::of(record);
        tell(handle);
        if dependencies == 0 {
            state.ready.push_back(handle);
            self.changed.notify_all();
        }
    }

    /// Changes what a call waits for.
    pub fn alter(&self, call: CallId, change: isize) {
        let mut state = self.lock();
        if let Some(record) = call.live() {
            self.settle(&mut state, record, change);
        }
    }

    /// Adds to what a call waits for, and does what follows when that is nothing: it runs, or has ended.
    fn settle(&self, state: &mut State, record: &'static CallRecord, change: isize) {
        let mut next = Some((record, change));
        while let Some((record, change)) = next.take() {
            record.pending.set(record.pending.get() + change);
            if record.pending.get() > 0 {
                return;
            }
            if !record.ran.get() {
                state.ready.push_back(CallId::of(record));
                self.changed.notify_all();
                return;
            }
            next = self.end(record);
        }
    }

    /// Ends a call; its dependent has one thing less to wait for.
    fn end(&self, record: &'static CallRecord) -> Option<(&'static CallRecord, isize)> {
        let call = record.call.take()?;
        let failed = record.failed.get();
        if !call.fault.is_null() {
            // SAFETY: the poster keeps the place until the call has ended (the contract of post_call).
            unsafe { call.fault.write(failed.into()) };
        }
        if let Some(wait) = call.wait.live() {
            wait.done.set(true);
        }
        self.changed.notify_all();
        CallRecord::pool().destroy(record);
        let dependent = call.dependent.live()?;
        if failed {
            dependent.failed.set(true);
        }
        Some((dependent, -1))
    }

    /// Runs one call, with the lock let go.
    fn run<'a>(&'a self, state: MutexGuard<'a, State>, handle: CallId) -> MutexGuard<'a, State> {
        let Some((record, call)) = handle.live().and_then(|record| Some((record, record.call.get()?))) else {
            return state;
        };
        record.ran.set(true);
        record.pending.set(record.pending.get() + 1);
        drop(state);
        let releasee = core::ptr::with_exposed_provenance_mut(handle.address());
        // SAFETY: the poster's function with its context (the contract of post_call).
        let good = unsafe { (call.function)(call.context, call.instance, releasee) } != 0;
        let mut state = self.lock();
        if !good {
            record.failed.set(true);
        }
        self.settle(&mut state, record, -1);
        state
    }

    /// Waits until a call has ended, running calls meanwhile unless other threads do. `false` if time ran out.
    pub fn wait(&self, wait: WaitId, timeout: Option<Duration>) -> bool {
        let deadline = timeout.map(|timeout| Instant::now() + timeout);
        let mut state = self.lock();
        loop {
            if wait.live().is_none_or(|wait| wait.done.get()) {
                return true;
            }
            if !self.multi
                && let Some(call) = state.ready.pop_front()
            {
                state = self.run(state, call);
                continue;
            }
            match deadline.map(|deadline| deadline.saturating_duration_since(Instant::now())) {
                Some(Duration::ZERO) => return false,
                Some(left) => {
                    state = self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
                }
                None => state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner),
            }
        }
    }

    /// Runs calls until the implementation is shut down. `ready` is called once this thread counts as serving.
    pub fn serve(&self, ready: impl FnOnce()) {
        self.lock().servers += 1;
        ready();
        let mut state = self.lock();
        while !state.shut_down {
            state = match state.ready.pop_front() {
                Some(call) => self.run(state, call),
                None => self.changed.wait(state).unwrap_or_else(PoisonError::into_inner),
            };
        }
        state.servers -= 1;
    }

    /// Tells all serving threads to leave.
    pub fn shut_down(&self) {
        self.lock().shut_down = true;
        self.changed.notify_all();
    }

    /// Makes ready to serve again after a shutdown.
    pub fn restart(&self) {
        self.lock().shut_down = false;
    }
}

// SAFETY: `State` is Send, behind a mutex; the rest is plain.
unsafe impl Sync for Calls {}
// SAFETY: as above.
unsafe impl Send for Calls {}
