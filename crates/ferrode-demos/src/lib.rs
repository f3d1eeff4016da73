//! A gallery of scenes for [Ferrode](https://docs.rs/ferrode): one file each, short enough to read, and each says what a
//! physicist would measure on it and measures it.
//!
//! ```
//! let demo = ferrode_demos::find("hinge").expect("it is in the gallery");
//! let mut play = demo.start()?;
//! while play.time() < demo.seconds {
//!     play.step()?;
//! }
//! println!("{}", play.verdict()?);
//! # Ok::<(), ferrode_demos::Failure>(())
//! ```
#![forbid(unsafe_code)]

mod demo;
mod drawing;
mod gallery;
mod kit;
mod play;
mod solids;
mod verdict;

pub use demo::{Camera, Demo, Subject, find, list};
pub use drawing::{Drawing, Mark, Tint};
pub use gallery::ALL;
pub use play::{Director, Play};
pub use verdict::Failure;
