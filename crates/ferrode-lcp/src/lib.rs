#![forbid(unsafe_code)]
//! ferrode-lcp
