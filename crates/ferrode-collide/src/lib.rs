#![forbid(unsafe_code)]
//! ferrode-collide
