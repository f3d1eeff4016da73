//! From the window system's keys to those of the viewer.

use crate::viewer::input::{Button, Key};
use winit::event::MouseButton;
use winit::keyboard::{KeyCode, PhysicalKey};

/// The key, by its place on the keyboard (as labelled in the USA), so that flying keys lie together on all.
pub fn key(physical: PhysicalKey) -> Option<Key> {
    let PhysicalKey::Code(code) = physical else { return None };
    Some(match code {
        KeyCode::Space => Key::Space,
        KeyCode::Escape => Key::Escape,
        KeyCode::Tab => Key::Tab,
        KeyCode::ArrowLeft => Key::Left,
        KeyCode::ArrowRight => Key::Right,
        KeyCode::ArrowUp => Key::Up,
        KeyCode::ArrowDown => Key::Down,
        KeyCode::Period => Key::Char('.'),
        KeyCode::Comma => Key::Char(','),
        KeyCode::BracketLeft => Key::Char('['),
        KeyCode::BracketRight => Key::Char(']'),
        other => {
            // `KeyA`, `Digit1`: the last letter is the sign.
            let name = format!("{other:?}");
            let sign = name.strip_prefix("Key").or_else(|| name.strip_prefix("Digit"))?;
            let mut signs = sign.chars();
            match (signs.next(), signs.next()) {
                (Some(only), None) => Key::Char(only.to_ascii_lowercase()),
                _ => return None,
            }
        }
    })
}

/// The button.
pub fn button(button: MouseButton) -> Option<Button> {
    match button {
        MouseButton::Left => Some(Button::Left),
        MouseButton::Right => Some(Button::Right),
        MouseButton::Middle => Some(Button::Middle),
        _ => None,
    }
}
