//! Helping threads, and how they share out tasks.

use core::any::Any;
use core::fmt;
use core::sync::atomic::{AtomicBool, AtomicPtr, AtomicU64, AtomicUsize, Ordering, fence};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

/// Most threads of a crew.
const MOST_THREADS: usize = 64;
/// Most tasks that are handed out at once; more come in rounds.
const MOST_TASKS: usize = (1 << BITS) - 1;
/// Bits of a task's number in a seat's word.
const BITS: u32 = 12;
/// Looks for work before a helper gives way to other threads: some 10 µs.
const SPINS: u32 = 300;
/// Looks with giving way before it sleeps: a millisecond or so.
const YIELDS: u32 = 2000;
/// The same when told to rest: the next step may follow at once, and to wake takes longer than to wait so long.
const RESTING_YIELDS: u32 = 200;

/// The calling thread and its helpers; see the [module](super).
///
/// Clones are the same crew. One caller has the helpers at a time: who finds them busy, as tasks do that hand out tasks
/// themselves, works alone.
///
/// ```
/// use ferrode_math::stage::{Crew, chunks};
///
/// let crew = Crew::new(2);
/// let mut numbers = [1u64; 1000];
/// crew.each(chunks(&mut numbers, 100), |piece, numbers| {
///     numbers.iter_mut().for_each(|n| *n += piece as u64);
/// });
/// assert_eq!(numbers[999], 10);
/// ```
#[derive(Clone, Default)]
pub struct Crew {
    /// None for a caller without helpers.
    helpers: Option<Arc<Helpers>>,
}

impl fmt::Debug for Crew {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Crew").field("threads", &self.threads()).finish()
    }
}

impl Crew {
    /// A crew of so many threads, the caller's included; 64 at most. Where the system grants fewer, or none, there are fewer.
    pub fn new(threads: usize) -> Self {
        let threads = threads.clamp(1, MOST_THREADS);
        let helpers = (threads > 1).then(|| Helpers::start(threads)).filter(|h| !h.handles.is_empty());
        Self { helpers: helpers.map(Arc::new) }
    }

    /// Number of threads, the caller's included.
    pub fn threads(&self) -> usize {
        self.helpers.as_ref().map_or(1, |h| h.shared.seats.len())
    }

    /// Calls `task` once with each number below `tasks`, in no order, and returns when all calls are done.
    ///
    /// # Panics
    /// When a task panics: the others are done, then the panic goes on in the caller.
    pub fn run(&self, tasks: usize, task: impl Fn(usize) + Sync) {
        if tasks > 1
            && let Some(helpers) = &self.helpers
            && let Some(_turn) = Turn::take(&helpers.shared.busy)
        {
            for first in (0..tasks).step_by(MOST_TASKS) {
                helpers.shared.round((tasks - first).min(MOST_TASKS), &|i| task(first + i));
            }
            return;
        }
        (0..tasks).for_each(task);
    }

    /// Whether the helpers are at work.
    #[cfg(test)]
    pub(super) fn is_busy(&self) -> bool {
        self.helpers.as_ref().is_some_and(|h| h.shared.busy.load(Ordering::Relaxed))
    }

    /// Lets the helpers sleep until the next run: there is none for a while.
    pub fn rest(&self) {
        if let Some(helpers) = &self.helpers {
            helpers.shared.resting.store(true, Ordering::Relaxed);
        }
    }
}

/// Whose turn it is to have the helpers.
struct Turn<'a>(&'a AtomicBool);

impl<'a> Turn<'a> {
    fn take(busy: &'a AtomicBool) -> Option<Self> {
        // Acquires what the one before has released.
        (!busy.swap(true, Ordering::Acquire)).then(|| Self(busy))
    }
}

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Release);
    }
}

struct Helpers {
    shared: Arc<Shared>,
    handles: Vec<JoinHandle<()>>,
}

impl Helpers {
    fn start(threads: usize) -> Self {
        let shared = Arc::new(Shared {
            seats: (0..threads).map(|_| Seat::default()).collect(),
            task: AtomicPtr::new(core::ptr::null_mut()),
            left: Alone(AtomicUsize::new(0)),
            busy: AtomicBool::new(false),
            resting: AtomicBool::new(false),
            asleep: Alone(AtomicUsize::new(0)),
            bed: Mutex::default(),
            bell: Condvar::new(),
            panic: Mutex::new(None),
        });
        let spawn = |seat: usize| {
            let shared = Arc::clone(&shared);
            let builder = thread::Builder::new().name(format!("ferrode {seat}"));
            // Tasks keep their working memory on the heap; a seat that nobody takes is emptied by the others.
            builder.spawn(move || shared.serve(seat)).ok()
        };
        let handles = (1..threads).filter_map(spawn).collect();
        Self { shared, handles }
    }
}

impl Drop for Helpers {
    fn drop(&mut self) {
        self.shared.bed().quit = true;
        self.shared.ring();
        let me = thread::current().id();
        for handle in self.handles.drain(..) {
            // The last of a crew may be dropped by a task of its own.
            if handle.thread().id() != me {
                // It has no panic to tell of: those of tasks were handed on.
                let _ = handle.join();
            }
        }
    }
}

/// The tasks of one thread: the number of the round, the first task that nobody has begun, and the end of them.
///
/// All in one word, so that who takes a task from it knows of which round it is.
#[derive(Debug, Default)]
#[repr(align(128))]
struct Seat(AtomicU64);

/// Which end a task is taken from.
#[derive(Clone, Copy, PartialEq)]
enum End {
    Front,
    Back,
}

fn word(round: u64, first: usize, end: usize) -> u64 {
    round << (2 * BITS) | (first as u64) << BITS | end as u64
}

fn round_of(word: u64) -> u64 {
    word >> (2 * BITS)
}

impl Seat {
    /// Takes a task of a round, if there is one left.
    fn take(&self, round: u64, from: End) -> Option<usize> {
        let mut old = self.0.load(Ordering::Acquire);
        loop {
            let mask = MOST_TASKS as u64;
            let (first, end) = (old >> BITS & mask, old & mask);
            if round_of(old) != round || first >= end {
                return None;
            }
            let (new, taken) = match from {
                End::Front => (old + (1 << BITS), first),
                End::Back => (old - 1, end - 1),
            };
            match self.0.compare_exchange_weak(old, new, Ordering::AcqRel, Ordering::Acquire) {
                Ok(_) => return Some(taken as usize),
                Err(now) => old = now,
            }
        }
    }
}

/// A value with cache lines of its own.
#[repr(align(128))]
struct Alone<T>(T);

type Task<'a> = &'a (dyn Fn(usize) + Sync + 'a);

#[derive(Default)]
struct Bed {
    /// How often the bell rang.
    rings: u64,
    quit: bool,
}

struct Shared {
    /// The caller's first.
    seats: Box<[Seat]>,
    /// What is called in this round.
    task: AtomicPtr<Task<'static>>,
    /// Tasks of the round that are not done.
    left: Alone<AtomicUsize>,
    busy: AtomicBool,
    resting: AtomicBool,
    /// Helpers that sleep, or are about to.
    asleep: Alone<AtomicUsize>,
    bed: Mutex<Bed>,
    bell: Condvar,
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

impl Shared {
    /// Hands out `tasks` tasks, at most [`MOST_TASKS`], and takes part. Only the thread whose turn it is calls this.
    fn round(&self, tasks: usize, task: Task<'_>) {
        // SAFETY: only the lifetime changes. The reference is used by `work`, after it took a task of this round. Each task is taken
        // once and counted off after its call; below, this thread waits until all are counted. So no use outlasts the
        // wait, and nothing before the wait unwinds: `work` catches the panics of tasks.
        let task = unsafe { core::mem::transmute::<Task<'_>, Task<'static>>(task) };
        self.task.store((&raw const task).cast_mut(), Ordering::Relaxed);
        self.left.0.store(tasks, Ordering::Relaxed);
        if self.resting.load(Ordering::Relaxed) {
            self.resting.store(false, Ordering::Relaxed);
        }
        let round =
            round_of(self.seats[0].0.load(Ordering::Relaxed)).wrapping_add(1) & (u64::MAX >> (2 * BITS));
        let threads = self.seats.len();
        for (i, seat) in self.seats.iter().enumerate() {
            let (first, end) = (tasks * i / threads, tasks * (i + 1) / threads);
            // Releases the two stores above to whoever takes a task.
            seat.0.store(word(round, first, end), Ordering::Release);
        }
        // Either this thread sees who sleeps, or who is about to sleep sees the round: see `sleep`.
        fence(Ordering::SeqCst);
        if self.asleep.0.load(Ordering::Relaxed) > 0 {
            self.ring();
        }
        self.work(0, round);
        let mut looks = 0;
        // Acquires what the tasks wrote.
        while self.left.0.load(Ordering::Acquire) > 0 {
            pause(&mut looks);
        }
        let panic = self.panic.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(panic) = panic {
            resume_unwind(panic);
        }
    }

    /// Does tasks of a round, its own first, until none is left to begin.
    fn work(&self, own: usize, round: u64) {
        let threads = self.seats.len();
        let mut done = 0;
        for i in 0..threads {
            let seat = &self.seats[(own + i) % threads];
            let end = if i == 0 { End::Front } else { End::Back };
            while let Some(number) = seat.take(round, end) {
                // SAFETY: a task of this round was taken and is not counted off yet, so `round` still waits, and neither the pointer nor
                // what it points to has changed since it was released to the seats.
                let task = unsafe { *self.task.load(Ordering::Relaxed) };
                if let Err(panic) = catch_unwind(AssertUnwindSafe(|| task(number))) {
                    *self.panic.lock().unwrap_or_else(PoisonError::into_inner) = Some(panic);
                }
                done += 1;
            }
        }
        if done > 0 {
            self.left.0.fetch_sub(done, Ordering::AcqRel);
        }
    }

    /// The life of a helper.
    fn serve(&self, own: usize) {
        let (mut seen, mut looks) = (0, 0);
        loop {
            let round = round_of(self.seats[own].0.load(Ordering::Acquire));
            if round != seen {
                (seen, looks) = (round, 0);
                self.work(own, round);
            } else if looks > SPINS + self.yields() {
                looks = 0;
                if self.sleep(own, seen) {
                    return;
                }
            } else {
                pause(&mut looks);
            }
        }
    }

    /// How often a helper gives way before it sleeps.
    fn yields(&self) -> u32 {
        if self.resting.load(Ordering::Relaxed) { RESTING_YIELDS } else { YIELDS }
    }

    /// Sleeps until there is another round than the last one; whether the crew breaks up instead.
    fn sleep(&self, own: usize, seen: u64) -> bool {
        let mut bed = self.bed();
        let rings = bed.rings;
        self.asleep.0.fetch_add(1, Ordering::Relaxed);
        fence(Ordering::SeqCst);
        let mut waits = true;
        while waits && !bed.quit {
            waits = round_of(self.seats[own].0.load(Ordering::Acquire)) == seen && bed.rings == rings;
            if waits {
                bed = self.bell.wait(bed).unwrap_or_else(PoisonError::into_inner);
            }
        }
        if bed.rings == rings {
            // Who rings counts all as awake.
            self.asleep.0.fetch_sub(1, Ordering::Relaxed);
        }
        bed.quit
    }

    /// Wakes all helpers.
    fn ring(&self) {
        let mut bed = self.bed();
        bed.rings += 1;
        self.asleep.0.store(0, Ordering::Relaxed);
        self.bell.notify_all();
    }

    fn bed(&self) -> MutexGuard<'_, Bed> {
        self.bed.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Waits a little: longer when that has been in vain for some time.
fn pause(looks: &mut u32) {
    if *looks < SPINS {
        core::hint::spin_loop();
    } else {
        thread::yield_now();
    }
    *looks = looks.saturating_add(1);
}
