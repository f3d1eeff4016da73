//! Threads for a step: the same work on one thread or many, with the same results.
//!
//! A [`Crew`] is the calling thread and some helpers that live as long as it does. [`Crew::run`] hands out numbered tasks and
//! returns when all are done; [`Crew::each`] cuts slices into pieces, one for each task; [`Exclusive`] lets tasks change records
//! that they reach by index, after it has made sure that no two of them reach the same one.
//!
//! ```text
//!   caller   ──run──┬─ 0 1 2 3 ─────┬──run──┬─ 0 1 ──┬── …
//!   helper          └─ 7 6 5 4 ─┘wait       └─ 3 2 ─┘
//! ```
//!
//! **Same results.** Which thread does a task is left to chance; what it does is not. Tasks are cut by place, write to places
//! of their own, and add up nothing across tasks. So neither the number of threads nor their speed shows in any bit.
//!
//! **Cost.** A stage of a step may take few microseconds. Helpers spin between stages, for some microseconds by themselves and a
//! while longer giving way to others, then sleep until the next stage; sooner when told to [`rest`](Crew::rest). Each
//! thread begins with its own part of the tasks, which is the same in every stage of as many tasks, so that data stay in the caches of
//! one core; who is done early takes over what others have not begun. A helper that the system does not let run
//! delays nobody: tasks that it has not begun are done without it.
//!
//! **Soundness.** The rules behind the few lines of unsafe code of this module:
//! 1. `run` neither returns nor unwinds before every task that a thread has begun is finished, and after that none can begin: so tasks
//!    may borrow from the caller (`crew`).
//! 2. Every number is handed out once per run: so a piece of a slice is lent to one task (`pieces`).
//! 3. No two parts of a group were found to have an index in common, and indices cannot change afterwards: so tasks, each with a part of
//!    its own, never share a record (`exclusive`).
// As `simd`, fenced: a test of the workspace looks.
#![allow(unsafe_code)]

mod crew;
mod exclusive;
mod pieces;

pub use crew::Crew;
pub use exclusive::{Exclusive, Lent, Lot, Touch};
pub use pieces::{Chunks, Cut, Pieces, chunks, cut};

#[cfg(test)]
mod tests;
