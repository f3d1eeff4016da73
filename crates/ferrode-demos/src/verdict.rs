//! What was measured, and whether it is what physics says.

use std::fmt;

/// Why a demo did not go as it should.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// The engine, or a loader, refused something.
    Refused(String),
    /// The property does not hold; what was measured.
    Property(String),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(why) => write!(f, "refused: {why}"),
            Self::Property(what) => write!(f, "does not hold: {what}"),
        }
    }
}

impl std::error::Error for Failure {}

impl From<ferrode::Error> for Failure {
    fn from(error: ferrode::Error) -> Self {
        Self::Refused(error.to_string())
    }
}

impl From<ferrode::dynamics::Error> for Failure {
    fn from(error: ferrode::dynamics::Error) -> Self {
        Self::Refused(error.to_string())
    }
}

impl From<ferrode::collide::ShapeError> for Failure {
    fn from(error: ferrode::collide::ShapeError) -> Self {
        Self::Refused(error.to_string())
    }
}

impl From<ferrode_scene::SceneError> for Failure {
    fn from(error: ferrode_scene::SceneError) -> Self {
        Self::Refused(error.to_string())
    }
}

/// Measurements, each with what it should be.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    lines: Vec<String>,
    failed: bool,
}

impl Findings {
    pub fn new() -> Self {
        Self::default()
    }

    fn add(mut self, holds: bool, line: String) -> Self {
        self.failed |= !holds;
        self.lines.push(if holds { line } else { format!("{line} (!)") });
        self
    }

    /// `value` is at most `limit`. Not a number never is.
    pub fn at_most(self, what: &str, value: f64, limit: f64) -> Self {
        self.add(value <= limit, format!("{what} {value:.3e}, at most {limit:e}"))
    }

    /// `value` is at least `limit`.
    pub fn at_least(self, what: &str, value: f64, limit: f64) -> Self {
        self.add(value >= limit, format!("{what} {value:.4}, at least {limit}"))
    }

    /// `value` differs from `expected` by at most `part` of it.
    pub fn near(self, what: &str, value: f64, expected: f64, part: f64) -> Self {
        let holds = (value - expected).abs() <= part * expected.abs();
        self.add(holds, format!("{what} {value:.5}, expected {expected:.5} within {:.2} %", 100.0 * part))
    }

    /// Something that is so or not.
    pub fn is(self, what: &str, holds: bool) -> Self {
        self.add(holds, what.to_owned())
    }

    /// The text, or the failure.
    pub fn verdict(self) -> Result<String, Failure> {
        let text = self.lines.join("; ");
        if self.failed { Err(Failure::Property(text)) } else { Ok(text) }
    }
}
