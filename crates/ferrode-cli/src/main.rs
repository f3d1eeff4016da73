#![forbid(unsafe_code)]
//! The `ferrode` command.

fn main() {}
