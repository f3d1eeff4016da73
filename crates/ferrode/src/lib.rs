#![forbid(unsafe_code)]
//! ferrode
