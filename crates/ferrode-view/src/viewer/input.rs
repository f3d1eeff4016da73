//! What the user's hands do, from a window or from a script.

/// A key, by what it does here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Key {
    /// A letter, digit or sign, as written on the key without shift.
    Char(char),
    /// The space bar.
    Space,
    /// Leave, or let go.
    Escape,
    /// Show or hide the panel.
    Tab,
    /// Arrow.
    Left,
    /// Arrow.
    Right,
    /// Arrow.
    Up,
    /// Arrow.
    Down,
}

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// Grabs, selects, turns the camera.
    Left,
    /// Turns the camera.
    Right,
    /// Moves the camera.
    Middle,
}

/// What a hand did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Input {
    /// A key went down (`true`) or up.
    Key(Key, bool),
    /// The mouse moved to a pixel.
    Move([f64; 2]),
    /// A button went down (`true`) or up.
    Button(Button, bool),
    /// The wheel turned; positive is away from the user.
    Wheel(f64),
}

impl Key {
    /// Whether a key that is held down goes on doing what it does: through time.
    pub fn repeats(self) -> bool {
        matches!(self, Self::Left | Self::Right | Self::Char(',' | '.'))
    }

    /// The key of a name, as scripts write it: `space`, `left`, `p`, …
    pub fn named(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "space" => Self::Space,
            "escape" | "esc" => Self::Escape,
            "tab" => Self::Tab,
            "left" => Self::Left,
            "right" => Self::Right,
            "up" => Self::Up,
            "down" => Self::Down,
            other => {
                let mut characters = other.chars();
                let (Some(only), None) = (characters.next(), characters.next()) else { return None };
                Self::Char(only)
            }
        })
    }
}

/// The keys and what they do, for the help in the window and on the command line.
pub const KEYS: &[(&str, &str)] = &[
    ("space", "pause, play"),
    (". or →", "one step"),
    (", or ←", "wind back"),
    ("r", "start anew"),
    ("[ ]", "slower, faster"),
    ("left mouse", "grab a body and throw it; on nothing: turn"),
    ("right mouse", "turn the camera"),
    ("middle mouse", "move the camera"),
    ("wheel", "nearer, farther"),
    ("w a s d q e", "fly"),
    ("f", "see everything"),
    ("c", "look at the body that was clicked on"),
    ("b n m v", "drop a cube, ball, capsule, cylinder"),
    ("x", "shoot a ball"),
    ("1", "contacts"),
    ("2", "forces of contacts"),
    ("3", "joints"),
    ("4", "forces of joints"),
    ("5", "centres of mass"),
    ("6", "boxes of inertia"),
    ("7", "boxes of geoms"),
    ("8", "tree of boxes"),
    ("9", "colours: bodies, sleep, islands"),
    ("0", "names"),
    ("p", "save a picture"),
    ("tab", "panel"),
    ("esc", "leave"),
];
