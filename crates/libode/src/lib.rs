//! The C interface of the Open Dynamics Engine over the Ferrode engine: a shared library that takes the place of
//! `libode.so.8`.
//!
//! There is nothing here to call from Rust: use the `ferrode` crate. How it is built:
//! - A handle is the address of a record in memory that is never given back (`slab`), so a wrong or stale handle is
//!   found out, not followed.
//! - A body's record is what getters point into; it is compared with the engine before the engine needs it (`record`).
//! - A function's work gives an outcome; faults are raised by the C shim when the work has returned (`fault`).
//! - Only records are touched while a callback of the program's runs; the engine's world is lent to it (`stepping`).
//!
//! `unsafe` stays in `real`, `numbers`, `slab`, `fault`, `record`, `memory`, `geom::kept`, `dynamic_iterations` and at calls of the program's functions.
#![allow(non_snake_case)]

mod body;
mod contact;
mod cooperative;
mod dynamic_iterations;
mod errors;
mod export_dif;
mod fault;
mod geom;
mod init;
mod joint;
mod mass;
mod matrix;
mod memory;
mod misc;
mod numbers;
mod real;
mod record;
mod rotation;
mod selftest;
mod slab;
mod step_fast;
mod stepping;
mod threading;
mod timer;
mod world;
