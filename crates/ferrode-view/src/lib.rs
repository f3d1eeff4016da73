#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod args;
pub mod demo;
pub mod failure;
pub mod film;
pub mod gallery;
pub mod islands;
pub mod joint_marks;
pub mod lettering;
pub mod overlay;
pub mod painter;
pub mod render_command;
pub mod setup;
pub mod view_point;
pub mod viewer;
pub mod window;

/// Draws shapes, meshes and lines: what the pictures are made with.
pub use ferrode_render as render;
