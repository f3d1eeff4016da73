//! What the control keys switch.

use crate::keys::Key;
use crate::options::Options;
use core::ffi::c_int;

/// What is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switches {
    /// The program is told not to simulate.
    pub paused: bool,
    /// But one frame.
    pub single: bool,
    /// With textures.
    pub textures: bool,
    /// With shadows.
    pub shadows: bool,
    /// Frames are written as pictures.
    pub writing: bool,
    /// The loop is to end.
    pub stop: bool,
}

/// What a key asks for beyond switches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Nothing more.
    Nothing,
    /// To print the viewpoint.
    Viewpoint,
    /// The program is to get a character.
    Command(c_int),
}

impl Switches {
    /// As the command line asks.
    pub fn new(options: Options) -> Self {
        let Options { textures, shadows, paused } = options;
        Self { paused, single: false, textures, shadows, writing: false, stop: false }
    }

    /// A key was pressed.
    pub fn press(&mut self, key: Key) -> Wish {
        let flip = |switch: &mut bool| *switch = !*switch;
        match key {
            Key::Control('p') => flip(&mut self.paused),
            Key::Control('o') => self.single = self.paused,
            Key::Control('t') => flip(&mut self.textures),
            Key::Control('s') => flip(&mut self.shadows),
            Key::Control('w') => flip(&mut self.writing),
            Key::Control('x') => self.stop = true,
            Key::Control('v') => return Wish::Viewpoint,
            Key::Control(_) => {}
            // Programs get a byte, as Latin-1 counts.
            Key::Plain(sign) if !sign.is_control() && u32::from(sign) < 256 => {
                return Wish::Command(u32::from(sign) as c_int);
            }
            Key::Plain(_) => {}
        }
        Wish::Nothing
    }

    /// Whether the frame that begins now is a paused one.
    pub fn pause_of_frame(&mut self) -> bool {
        let single = std::mem::take(&mut self.single);
        self.paused && !single
    }
}

#[cfg(test)]
mod tests {
    use super::{Switches, Wish};
    use crate::keys::Key;
    use crate::options::Options;

    #[test]
    fn a_single_step_is_one_frame_of_a_pause() {
        let mut switches = Switches::new(Options { textures: true, shadows: false, paused: false });
        assert!(!switches.pause_of_frame());
        switches.press(Key::Control('o'));
        assert!(!switches.pause_of_frame(), "no effect while running");
        switches.press(Key::Control('p'));
        assert!(switches.pause_of_frame());
        switches.press(Key::Control('o'));
        assert!(!switches.pause_of_frame());
        assert!(switches.pause_of_frame());
        switches.press(Key::Control('p'));
        assert!(!switches.pause_of_frame());
    }

    #[test]
    fn keys_switch_or_go_to_the_program() {
        let mut switches = Switches::new(Options { textures: true, shadows: false, paused: false });
        for key in ['t', 's', 'w', 'x'] {
            assert_eq!(switches.press(Key::Control(key)), Wish::Nothing);
        }
        assert!(!switches.textures && switches.shadows && switches.writing && switches.stop);
        assert_eq!(switches.press(Key::Control('v')), Wish::Viewpoint);
        assert_eq!(switches.press(Key::Plain('a')), Wish::Command(97));
        assert_eq!(switches.press(Key::Plain(' ')), Wish::Command(32));
        assert_eq!(switches.press(Key::Plain('\u{3b1}')), Wish::Nothing);
    }
}
