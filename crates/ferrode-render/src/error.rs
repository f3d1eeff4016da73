//! What can go wrong while drawing.

use std::fmt;

/// Why nothing can be drawn.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RenderError {
    /// No driver was found; the text names what each backend said.
    NoDriver(String),
    /// The driver refuses a device.
    Device(String),
    /// A window's surface cannot be made or used.
    Surface(String),
    /// A picture could not be fetched from the driver.
    ReadBack(String),
    /// A size that is zero, or more than the driver can do.
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// The most that each may be.
        most: u32,
    },
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDriver(what) => write!(
                f,
                "no Vulkan or OpenGL driver was found; on Debian or Ubuntu: apt install mesa-vulkan-drivers ({what})"
            ),
            Self::Device(what) => write!(f, "the graphics driver refuses to work: {what}"),
            Self::Surface(what) => write!(f, "the window cannot be drawn to: {what}"),
            Self::ReadBack(what) => {
                write!(f, "the picture could not be fetched from the graphics driver: {what}")
            }
            Self::Size { width, height, most } => {
                write!(
                    f,
                    "a picture of {width}x{height} pixels can't be drawn: each side must be 1 to {most}"
                )
            }
        }
    }
}

impl std::error::Error for RenderError {}
