//! Keys, from the keyboard or written down in `DRAWSTUFF_KEYS`.

/// A key that was pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// An ordinary character.
    Plain(char),
    /// A letter with the control key, in lower case.
    Control(char),
}

/// A key for a frame, the first being 0.
pub type Planned = (u64, Key);

/// Reads keys such as `10:p 20:^X 30:space`.
///
/// # Errors
/// The word that is none.
pub fn plan(text: &str) -> Result<Vec<Planned>, String> {
    let mut keys = Vec::new();
    for word in text.split_whitespace() {
        let wrong = || format!("{word:?} is not FRAME:KEY, with a key such as a, ^P or space");
        let (frame, key) = word.split_once(':').ok_or_else(wrong)?;
        let frame = frame.parse().map_err(|_| wrong())?;
        let mut signs = key.chars();
        let key = match (signs.next(), signs.next(), signs.next()) {
            (Some(sign), None, None) => Key::Plain(sign),
            (Some('^'), Some(letter), None) => Key::Control(letter.to_ascii_lowercase()),
            _ if key == "space" => Key::Plain(' '),
            _ => return Err(wrong()),
        };
        keys.push((frame, key));
    }
    Ok(keys)
}

#[cfg(test)]
mod tests {
    use super::{Key, plan};

    #[test]
    fn plans_are_read() {
        let keys = plan("3:a 3:^P 10:space 11:^").expect("a plan");
        let wanted =
            [(3, Key::Plain('a')), (3, Key::Control('p')), (10, Key::Plain(' ')), (11, Key::Plain('^'))];
        assert_eq!(keys, wanted);
        for wrong in ["a", "x:a", "3:", "3:ab", "-1:a", "3:^PP"] {
            assert!(plan(wrong).is_err(), "{wrong}");
        }
    }
}
