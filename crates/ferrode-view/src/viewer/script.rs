//! Hands written down: a list of keys and moves of the mouse, for tests and films of the window.
//!
//! A line each: `key space` · `down w`, `up w` · `move X Y` · `press left`, `release left` · `click X Y` · `drag X Y X2 Y2 FRAMES` ·
//! `wheel N` · `wait FRAMES` · `shot FILE.png` · `state FILE.json` · `csv FILE.csv` · `plot VALUE` · `plots FILE.png` · `quit`. `#` begins a comment. While a script
//! runs, each frame is 1/60 s of time, however long it takes to draw.

use super::input::{Button, Input, Key};
use std::collections::VecDeque;
use std::path::PathBuf;

/// A step of a script.
#[derive(Clone, Debug, PartialEq)]
pub enum Act {
    /// Something that hands do.
    Input(Input),
    /// Draw this many frames before going on.
    Wait(u64),
    /// Save a picture of the window.
    Shot(PathBuf),
    /// Save time, pause, and where all links are, as JSON.
    State(PathBuf),
    /// Save the recorded values.
    Csv(PathBuf),
    /// Plot a value.
    Plot(String),
    /// Save a picture of the plots.
    Plots(PathBuf),
    /// Leave.
    Quit,
}

/// A script under way.
#[derive(Clone, Debug, Default)]
pub struct Script {
    acts: VecDeque<Act>,
    waiting: u64,
}

/// Seconds that a frame of a script stands for.
pub const FRAME: f64 = 1.0 / 60.0;

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// A line that says nothing known: with its number.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut acts = VecDeque::new();
        for (number, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default();
            let words: Vec<&str> = line.split_whitespace().collect();
            if !words.is_empty() {
                let parsed = parse_line(&words);
                acts.extend(parsed.ok_or_else(|| format!("line {}: cannot follow {line:?}", number + 1))?);
            }
        }
        Ok(Self { acts, waiting: 0 })
    }

    /// What is to be done before the next frame.
    pub fn before_frame(&mut self) -> Vec<Act> {
        let mut now = Vec::new();
        if self.waiting > 0 {
            self.waiting -= 1;
            return now;
        }
        while let Some(act) = self.acts.pop_front() {
            if let Act::Wait(frames) = act {
                self.waiting = frames.saturating_sub(1);
                break;
            }
            let shot = matches!(act, Act::Shot(_));
            now.push(act);
            if shot {
                // It shows what came before it, not what comes after.
                break;
            }
        }
        now
    }
}

fn button(name: &str) -> Option<Button> {
    match name {
        "left" => Some(Button::Left),
        "right" => Some(Button::Right),
        "middle" => Some(Button::Middle),
        _ => None,
    }
}

fn parse_line(words: &[&str]) -> Option<Vec<Act>> {
    let number = |text: &str| text.parse::<f64>().ok().filter(|x| x.is_finite());
    let input = |input: Input| Act::Input(input);
    let left = |down: bool| input(Input::Button(Button::Left, down));
    Some(match *words {
        ["key", name] => {
            let key = Key::named(name)?;
            vec![input(Input::Key(key, true)), input(Input::Key(key, false))]
        }
        ["down", name] => vec![input(Input::Key(Key::named(name)?, true))],
        ["up", name] => vec![input(Input::Key(Key::named(name)?, false))],
        ["move", x, y] => vec![input(Input::Move([number(x)?, number(y)?]))],
        ["press", name] => vec![input(Input::Button(button(name)?, true))],
        ["release", name] => vec![input(Input::Button(button(name)?, false))],
        ["click", x, y] => {
            let there = input(Input::Move([number(x)?, number(y)?]));
            vec![there, Act::Wait(1), left(true), Act::Wait(1), left(false)]
        }
        ["drag", x, y, x2, y2, frames] => {
            let (from, to) = ([number(x)?, number(y)?], [number(x2)?, number(y2)?]);
            let frames: u32 = frames.parse().ok().filter(|n| *n > 0)?;
            let mut acts = vec![input(Input::Move(from)), Act::Wait(1), left(true), Act::Wait(1)];
            for n in 1..=frames {
                let t = f64::from(n) / f64::from(frames);
                let at = [0, 1].map(|i| from[i] + (to[i] - from[i]) * t);
                acts.extend([input(Input::Move(at)), Act::Wait(1)]);
            }
            acts.push(left(false));
            acts
        }
        ["wheel", notches] => vec![input(Input::Wheel(number(notches)?))],
        ["wait", frames] => vec![Act::Wait(frames.parse().ok()?)],
        ["shot", file] => vec![Act::Shot(file.into())],
        ["state", file] => vec![Act::State(file.into())],
        ["csv", file] => vec![Act::Csv(file.into())],
        ["plot", value] => vec![Act::Plot(value.to_owned())],
        ["plots", file] => vec![Act::Plots(file.into())],
        ["quit"] => vec![Act::Quit],
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::{Act, Script};

    #[test]
    fn waits_hold_the_rest_back() {
        let mut script = Script::parse("wait 2 # first\nkey space\nwait 1\nquit").unwrap();
        assert_eq!(script.before_frame(), []);
        assert_eq!(script.before_frame(), []);
        assert_eq!(script.before_frame().len(), 2);
        assert_eq!(script.before_frame(), [Act::Quit]);
    }

    #[test]
    fn lines_that_say_nothing_known_are_named() {
        for text in ["jump", "key", "key enormous", "move 1", "drag 1 2 3 4 0", "press nose", "wait -1"] {
            assert!(Script::parse(&format!("\n{text}")).unwrap_err().starts_with("line 2:"), "{text}");
        }
    }
}
