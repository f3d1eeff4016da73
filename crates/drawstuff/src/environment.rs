//! What the environment asks for: runs without a window, runs of a given length, keys that are pressed.

use crate::fault::{Fault, Outcome};
use crate::keys::{self, Planned};
use std::path::PathBuf;

/// What is kept of a run without a window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Headless {
    /// Where.
    pub folder: PathBuf,
    /// Pictures.
    pub pictures: bool,
    /// Each call as text.
    pub text: bool,
}

/// What the environment asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// Without a window.
    pub headless: Option<Headless>,
    /// The loop ends after so many frames.
    pub frames: Option<u64>,
    /// Of so many frames one becomes a picture.
    pub every: u64,
    /// Seconds a frame, without a window.
    pub step: f64,
    /// Width and height, in the place of what the program asks for.
    pub size: Option<[u32; 2]>,
    /// Keys to press.
    pub keys: Vec<Planned>,
}

/// Frames of a run without a window, unless told otherwise: it has nobody who closes it.
const FRAMES: u64 = 100;

impl Environment {
    /// Reads the variables by a function that gives one's text.
    ///
    /// # Errors
    /// The variable that makes no sense.
    pub fn read(variable: impl Fn(&str) -> Option<String>) -> Outcome<Self> {
        let variable = |name: &str| variable(name).filter(|text| !text.is_empty());
        let wrong = |name: &str, text: &str, expected: &str| {
            Fault::circumstance(format!("{name}={text} makes no sense: expected {expected}"))
        };
        let count = |name: &str| match variable(name) {
            None => Ok(None),
            Some(text) => match text.parse() {
                Ok(number) if number > 0 => Ok(Some(number)),
                _ => Err(wrong(name, &text, "a whole number above 0")),
            },
        };
        let headless = match variable("DRAWSTUFF_HEADLESS") {
            None => None,
            Some(folder) => {
                let dump = variable("DRAWSTUFF_DUMP");
                let (pictures, text) = match dump.as_deref() {
                    None | Some("png") => (true, false),
                    Some("text") => (false, true),
                    Some("both") => (true, true),
                    Some("none") => (false, false),
                    Some(text) => return Err(wrong("DRAWSTUFF_DUMP", text, "png, text, both or none")),
                };
                Some(Headless { folder: PathBuf::from(folder), pictures, text })
            }
        };
        let step = match variable("DRAWSTUFF_STEP") {
            None => 1.0 / 60.0,
            Some(text) => match text.parse::<f64>() {
                Ok(step) if step.is_finite() && step >= 0.0 => step,
                _ => return Err(wrong("DRAWSTUFF_STEP", &text, "seconds")),
            },
        };
        let size = match variable("DRAWSTUFF_SIZE") {
            None => None,
            Some(text) => {
                let parts = text.split_once('x').map(|(w, h)| (w.parse::<u32>(), h.parse::<u32>()));
                match parts {
                    Some((Ok(width), Ok(height))) if width > 0 && height > 0 => Some([width, height]),
                    _ => return Err(wrong("DRAWSTUFF_SIZE", &text, "WIDTHxHEIGHT, such as 640x360")),
                }
            }
        };
        let keys = keys::plan(&variable("DRAWSTUFF_KEYS").unwrap_or_default())
            .map_err(|error| Fault::circumstance(format!("DRAWSTUFF_KEYS: {error}")))?;
        let frames = count("DRAWSTUFF_FRAMES")?.or(headless.is_some().then_some(FRAMES));
        let every = count("DRAWSTUFF_EVERY")?.unwrap_or(1);
        Ok(Self { headless, frames, every, step, size, keys })
    }
}

#[cfg(test)]
mod tests {
    use super::{Environment, Headless};
    use crate::fault::{Fault, Outcome};
    use crate::keys::Key;

    fn read(variables: &[(&str, &str)]) -> Outcome<Environment> {
        Environment::read(|name| {
            variables.iter().find(|(known, _)| *known == name).map(|(_, text)| (*text).to_owned())
        })
    }

    #[test]
    fn nothing_set_is_a_window() {
        let environment = read(&[("DRAWSTUFF_HEADLESS", "")]).expect("an environment");
        assert_eq!((environment.headless, environment.frames, environment.every), (None, None, 1));
    }

    #[test]
    fn headless_runs_have_an_end() {
        let environment = read(&[
            ("DRAWSTUFF_HEADLESS", "out"),
            ("DRAWSTUFF_DUMP", "text"),
            ("DRAWSTUFF_SIZE", "320x200"),
            ("DRAWSTUFF_STEP", "0.01"),
            ("DRAWSTUFF_KEYS", "4:^X"),
        ])
        .expect("an environment");
        let headless = Headless { folder: "out".into(), pictures: false, text: true };
        assert_eq!((environment.headless, environment.frames), (Some(headless), Some(100)));
        assert_eq!((environment.size, environment.step), (Some([320, 200]), 0.01));
        assert_eq!(environment.keys, [(4, Key::Control('x'))]);
    }

    #[test]
    fn mistakes_are_named() {
        for (name, text) in [
            ("DRAWSTUFF_FRAMES", "0"),
            ("DRAWSTUFF_FRAMES", "many"),
            ("DRAWSTUFF_EVERY", "-1"),
            ("DRAWSTUFF_STEP", "inf"),
            ("DRAWSTUFF_SIZE", "640"),
            ("DRAWSTUFF_DUMP", "jpeg"),
            ("DRAWSTUFF_KEYS", "p"),
        ] {
            let Err(Fault::Circumstance(said)) = read(&[("DRAWSTUFF_HEADLESS", "out"), (name, text)]) else {
                panic!("{name}={text} is taken");
            };
            assert!(said.contains(name), "{said}");
        }
    }
}
