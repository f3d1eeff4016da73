//! Pools of threads that serve a multi-threaded implementation.

use super::{Calls, ImplementationId};
use crate::fault::{Fault, export};
use crate::record::{Required, record};
use crate::slab::{Handle, Pool, Record, Tag};
use core::ffi::{c_uint, c_void};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, RwLock, RwLockReadGuard};
use std::thread::JoinHandle;

type PoolId = Handle<PoolRecord>;

/// A pool.
#[derive(Default)]
pub struct PoolRecord {
    tag: Tag,
    /// Threads of the program may wait for the pool side by side.
    threads: RwLock<Option<Threads>>,
}
record!(PoolRecord, POOLS, 9);

impl PoolRecord {
    fn threads(&self) -> RwLockReadGuard<'_, Option<Threads>> {
        self.threads.read().unwrap_or_else(PoisonError::into_inner)
    }
}

struct Threads {
    desk: Arc<Desk>,
    handles: Vec<JoinHandle<()>>,
}

/// Where the pool's threads find what to do.
#[derive(Default)]
struct Desk {
    task: Mutex<Task>,
    changed: Condvar,
}

#[derive(Default)]
struct Task {
    calls: Option<Arc<Calls>>,
    /// Counts tasks, so that each thread takes each one once.
    number: u64,
    /// Threads that have not begun the task, and those that have not finished it.
    starting: usize,
    busy: usize,
    quit: bool,
}

impl Desk {
    fn lock(&self) -> MutexGuard<'_, Task> {
        self.task.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait_while(&self, holds: impl Fn(&Task) -> bool) -> MutexGuard<'_, Task> {
        let mut task = self.lock();
        while holds(&task) {
            task = self.changed.wait(task).unwrap_or_else(PoisonError::into_inner);
        }
        task
    }

    /// What each thread of the pool does all its life.
    fn work(&self) {
        let mut done = 0;
        loop {
            let task = self.wait_while(|task| !task.quit && task.number == done);
            if task.quit {
                return;
            }
            done = task.number;
            let calls = task.calls.clone();
            drop(task);
            if let Some(calls) = calls {
                calls.serve(|| {
                    self.lock().starting -= 1;
                    self.changed.notify_all();
                });
            }
            let mut task = self.lock();
            task.busy -= 1;
            if task.busy == 0 {
                task.calls = None;
            }
            self.changed.notify_all();
        }
    }
}

impl Threads {
    fn start(count: c_uint, stack_size: usize) -> std::io::Result<Self> {
        let mut threads = Self { desk: Arc::default(), handles: Vec::new() };
        for _ in 0..count {
            let desk = Arc::clone(&threads.desk);
            let mut builder = std::thread::Builder::new().name("ode".into());
            if stack_size > 0 {
                builder = builder.stack_size(stack_size);
            }
            match builder.spawn(move || desk.work()) {
                Ok(handle) => threads.handles.push(handle),
                Err(error) => {
                    threads.stop();
                    return Err(error);
                }
            }
        }
        Ok(threads)
    }

    /// Hands an implementation to all threads; comes back when they serve it.
    fn serve(&self, calls: Arc<Calls>) {
        let mut task = self.desk.wait_while(|task| task.busy > 0);
        task.calls = Some(calls);
        task.number += 1;
        task.starting = self.handles.len();
        task.busy = self.handles.len();
        drop(task);
        self.desk.changed.notify_all();
        drop(self.desk.wait_while(|task| task.starting > 0));
    }

    fn stop(self) {
        drop(self.desk.wait_while(|task| task.busy > 0));
        self.desk.lock().quit = true;
        self.desk.changed.notify_all();
        for handle in self.handles {
            handle.join().ok();
        }
    }
}

export! {
    /// Null if the threads can't be had.
    fn dThreadingAllocateThreadPool(
        thread_count: c_uint, stack_size: usize, _ode_data_allocate_flags: c_uint, _reserved: *mut c_void,
    ) -> PoolId {
        if thread_count == 0 {
            return Err(Fault::ARGUMENT);
        }
        let Ok(threads) = Threads::start(thread_count, stack_size) else { return Ok(PoolId::NULL) };
        let pool = PoolRecord::pool().create();
        *pool.threads.write().unwrap_or_else(PoisonError::into_inner) = Some(threads);
        PoolId::of(pool)
    }
    fn dThreadingThreadPoolServeMultiThreadedImplementation(pool: PoolId, implementation: ImplementationId) {
        let calls = implementation.get()?.calls()?;
        if let Some(threads) = &*pool.get()?.threads() {
            threads.serve(calls);
        }
    }
    fn dThreadingThreadPoolWaitIdleState(pool: PoolId) {
        if let Some(threads) = &*pool.get()?.threads() {
            drop(threads.desk.wait_while(|task| task.busy > 0));
        }
    }
    fn dThreadingFreeThreadPool(pool: PoolId) {
        if !pool.is_null() {
            let pool = pool.get()?;
            if let Some(threads) = pool.threads.write().unwrap_or_else(PoisonError::into_inner).take() {
                threads.stop();
            }
            PoolRecord::pool().destroy(pool);
        }
    }
}
