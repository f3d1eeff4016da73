#![forbid(unsafe_code)]
//! ferrode-dynamics
