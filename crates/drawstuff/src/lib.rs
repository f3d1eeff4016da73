//! `libdrawstuff`: ODE's small drawing library, for ODE's demo programs and those written like them.
//!
//! There is nothing here to call from Rust: use `ferrode-render`. The library knows neither ODE nor the Ferrode engine. How it
//! is built:
//! - A C function's work runs inside [`fault::guard`]; what went wrong is said, and the process ended, when the work has
//!   returned. Panics end there too.
//! - What functions share is behind one lock (`state`), which is never held while a function of the program's runs.
//! - The loop (`session`) lies in thread-local memory, not on the stack: a program may leave a callback by `longjmp` or by a C++
//!   exception and skip nothing of ours.
//! - `unsafe` stays in `numbers`, `fault`, `variadic` and at calls of the program's functions in `simulation_loop`.
#![allow(non_snake_case)]

mod clock;
mod convex;
mod draw;
mod drawing;
mod environment;
mod fault;
mod functions;
mod keys;
mod note;
mod numbers;
mod options;
mod picture_file;
mod session;
mod simulation_loop;
mod stage;
mod state;
mod switches;
mod variadic;
mod viewpoint;
