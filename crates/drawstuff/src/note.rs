//! Calls as lines of text.

use crate::numbers::Real;
use std::fmt::Write;

/// Something whose numbers can be written down.
pub trait Note {
    /// Appends the numbers, each after a space.
    fn append(&self, text: &mut String);
}

impl<T: Real> Note for [T] {
    fn append(&self, text: &mut String) {
        for number in self {
            // Writing to a string does not fail.
            let _ = write!(text, " {number:?}");
        }
    }
}

impl<T: Real, const N: usize> Note for [T; N] {
    fn append(&self, text: &mut String) {
        self[..].append(text);
    }
}

impl<T: Real> Note for Vec<T> {
    fn append(&self, text: &mut String) {
        self[..].append(text);
    }
}

/// Appends a line: a name, then each part's name and numbers.
pub fn line(text: &mut String, name: &str, parts: &[(&str, &dyn Note)], end: &str) {
    text.push_str(name);
    for (label, numbers) in parts {
        text.push(' ');
        text.push_str(label);
        numbers.append(text);
    }
    text.push_str(end);
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::line;

    #[test]
    fn numbers_are_written_as_short_as_they_can_be() {
        let mut text = String::new();
        line(&mut text, "box", &[("at", &[0.1_f32, 2.0]), ("sides", &vec![0.1_f64, 1e-20])], " wood");
        assert_eq!(text, "box at 0.1 2.0 sides 0.1 1e-20 wood\n");
    }
}
