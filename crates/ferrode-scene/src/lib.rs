#![forbid(unsafe_code)]
//! ferrode-scene
