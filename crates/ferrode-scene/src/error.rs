//! What can be wrong with a file, said with file, line, column and the line itself.

use std::fmt;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

use crate::source::Origin;

/// A file that cannot be read, is not well-formed or contradicts itself. `Display` prints it as a compiler
/// would: the message, `file:line:column`, the line with the place underlined, and a hint if there is one.
#[derive(Clone)]
pub struct SceneError(Box<Report>);

/// Something in a file that may make the world behave otherwise than its author meant.
#[derive(Clone)]
pub struct Warning {
    kind: WarningKind,
    report: Box<Report>,
}

/// What a [`Warning`] is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum WarningKind {
    /// An element or attribute that is unknown here and may change the physics.
    NotUnderstood,
    /// An element that is understood but that this engine cannot follow (yet).
    NotSupported,
    /// An element that is read, but looks like a mistake.
    Suspicious,
    /// Parts that by their nature don't concern a dynamics engine (plugins, sensors, settings for other
    /// engines), counted: one line for all of a kind. Never an error, not even under `strict`.
    Ignored,
}

#[derive(Clone)]
struct Report {
    message: String,
    origin: Option<Origin>,
    file: Option<String>,
    help: Option<String>,
}

impl Report {
    fn render(&self, level: Level<'_>, name: &str, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(origin) = &self.origin else {
            write!(f, "{name}: {}", self.message)?;
            if let Some(file) = &self.file {
                write!(f, "\n --> {file}")?;
            }
            return match &self.help {
                Some(help) => write!(f, "\n  = help: {help}"),
                None => Ok(()),
            };
        };
        // Only the line itself is handed over: files may have 100,000 of them.
        let span = origin.span();
        let (line, column) = origin.source().line_column(span.start);
        let text = origin.source().line_text(span.start);
        let from = text.char_indices().nth(column - 1).map_or(text.len(), |(at, _)| at);
        let mut to = (from + span.len()).min(text.len());
        while !text.is_char_boundary(to) {
            to += 1;
        }
        let snippet = Snippet::source(text)
            .line_start(line)
            .path(origin.source().name())
            .annotation(AnnotationKind::Primary.span(from..to));
        let mut group = level.primary_title(self.message.as_str()).element(snippet);
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        f.write_str(&Renderer::plain().render(&[group]))
    }

    fn file(&self) -> Option<&str> {
        self.origin.as_ref().map(|origin| origin.source().name()).or(self.file.as_deref())
    }
}

impl SceneError {
    pub(crate) fn new(origin: Origin, message: impl Into<String>) -> Self {
        Self(Box::new(Report { message: message.into(), origin: Some(origin), file: None, help: None }))
    }

    pub(crate) fn in_file(file: impl Into<String>, message: impl Into<String>) -> Self {
        Self(Box::new(Report { message: message.into(), origin: None, file: Some(file.into()), help: None }))
    }

    pub(crate) fn with_help(mut self, help: impl Into<String>) -> Self {
        self.0.help = Some(help.into());
        self
    }

    /// The first warning of a strict run, as an error.
    pub(crate) fn from_warning(warning: Warning, others: usize) -> Self {
        let mut report = warning.report;
        if others > 0 {
            let more = format!("{others} more of this kind: without `strict` they are listed as warnings");
            report.help = Some(match report.help {
                Some(help) => format!("{help}\n{more}"),
                None => more,
            });
        }
        Self(report)
    }

    /// The message alone.
    pub fn message(&self) -> &str {
        &self.0.message
    }

    /// A hint at what may have been meant.
    pub fn help(&self) -> Option<&str> {
        self.0.help.as_deref()
    }

    /// The file's name, as in the path that was given.
    pub fn file(&self) -> Option<&str> {
        self.0.file()
    }

    /// The place in the file; `None` if the file could not be opened at all.
    pub fn origin(&self) -> Option<&Origin> {
        self.0.origin.as_ref()
    }

    /// The line, from 1.
    pub fn line(&self) -> Option<usize> {
        self.0.origin.as_ref().map(Origin::line)
    }

    /// The column, from 1.
    pub fn column(&self) -> Option<usize> {
        self.0.origin.as_ref().map(Origin::column)
    }

    /// The name of the element.
    pub fn element(&self) -> Option<&str> {
        self.0.origin.as_ref().map(Origin::element)
    }

    /// The line as it stands in the file.
    pub fn source_line(&self) -> Option<&str> {
        self.0.origin.as_ref().map(|origin| origin.source().line_text(origin.span().start))
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.render(Level::ERROR, "error", f)
    }
}

impl fmt::Debug for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for SceneError {}

impl Warning {
    pub(crate) fn new(kind: WarningKind, origin: Origin, message: impl Into<String>) -> Self {
        let report = Report { message: message.into(), origin: Some(origin), file: None, help: None };
        Self { kind, report: Box::new(report) }
    }

    pub(crate) fn in_file(kind: WarningKind, file: impl Into<String>, message: impl Into<String>) -> Self {
        let report = Report { message: message.into(), origin: None, file: Some(file.into()), help: None };
        Self { kind, report: Box::new(report) }
    }

    pub(crate) fn with_help(mut self, help: impl Into<String>) -> Self {
        self.report.help = Some(help.into());
        self
    }

    /// What it is about.
    pub fn kind(&self) -> WarningKind {
        self.kind
    }

    /// The message alone.
    pub fn message(&self) -> &str {
        &self.report.message
    }

    /// The file's name.
    pub fn file(&self) -> Option<&str> {
        self.report.file()
    }

    /// The place in the file; a count of ignored parts has none.
    pub fn origin(&self) -> Option<&Origin> {
        self.report.origin.as_ref()
    }

    /// The line, from 1.
    pub fn line(&self) -> Option<usize> {
        self.report.origin.as_ref().map(Origin::line)
    }

    /// The name of the element.
    pub fn element(&self) -> Option<&str> {
        self.report.origin.as_ref().map(Origin::element)
    }

    /// One line: `file:line:column: message`.
    pub fn one_line(&self) -> String {
        match (&self.report.origin, &self.report.file) {
            (Some(origin), _) => format!("{origin}: {}", self.report.message),
            (None, Some(file)) => format!("{file}: {}", self.report.message),
            (None, None) => self.report.message.clone(),
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            WarningKind::Ignored => self.report.render(Level::NOTE, "note", f),
            _ => self.report.render(Level::WARNING, "warning", f),
        }
    }
}

impl fmt::Debug for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// The warnings of a run as they come up, and the counts of ignored parts.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    warnings: Vec<Warning>,
    counts: Vec<(String, &'static str, usize)>,
}

impl Notes {
    pub(crate) fn push(&mut self, warning: Warning) {
        self.warnings.push(warning);
    }

    pub(crate) fn not_understood(&mut self, origin: Origin, message: impl Into<String>) {
        self.push(Warning::new(WarningKind::NotUnderstood, origin, message));
    }

    pub(crate) fn not_supported(&mut self, origin: Origin, message: impl Into<String>) {
        self.push(Warning::new(WarningKind::NotSupported, origin, message));
    }

    pub(crate) fn suspicious(&mut self, origin: Origin, message: impl Into<String>) {
        self.push(Warning::new(WarningKind::Suspicious, origin, message));
    }

    /// Counts one ignored part; `what` is its plural, as in "plugins".
    pub(crate) fn count(&mut self, file: &str, what: &'static str) {
        match self.counts.iter_mut().find(|(in_file, counted, _)| in_file == file && *counted == what) {
            Some((_, _, number)) => *number += 1,
            None => self.counts.push((file.to_owned(), what, 1)),
        }
    }

    /// The warnings, with one line a kind of ignored part at their end.
    pub(crate) fn into_warnings(self) -> Vec<Warning> {
        let mut warnings = self.warnings;
        for (file, what, number) in self.counts {
            warnings.push(Warning::in_file(WarningKind::Ignored, file, format!("{what} ignored: {number}")));
        }
        warnings
    }
}

/// `Result` with [`SceneError`].
pub type Result<T> = std::result::Result<T, SceneError>;

/// "did you mean `x`?" for a word that is close to one of those allowed here.
pub(crate) fn did_you_mean<'a>(word: &str, allowed: impl IntoIterator<Item = &'a str>) -> Option<String> {
    allowed
        .into_iter()
        .map(|candidate| (strsim::damerau_levenshtein(word, candidate), candidate))
        .filter(|&(distance, candidate)| distance <= 2 && distance < candidate.chars().count())
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| format!("did you mean `{candidate}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Source;

    #[test]
    fn an_error_is_printed_as_a_compiler_would() {
        let source = Source::from_text("robot.sdf", "<sdf>\n  <mass>-1</mass>\n</sdf>\n");
        let origin = Origin::new(&source, 14..16, "mass");
        let error = SceneError::new(origin, "mass must be positive").with_help("delete it for 1 kg");
        let text = error.to_string();
        assert!(text.starts_with("error: mass must be positive"), "{text}");
        assert!(text.contains("robot.sdf:2:9"), "{text}");
        assert!(text.contains("2 |   <mass>-1</mass>"), "{text}");
        assert!(text.contains("^^"), "{text}");
        assert!(text.contains("help: delete it for 1 kg"), "{text}");
        assert_eq!((error.line(), error.column(), error.element()), (Some(2), Some(9), Some("mass")));
        assert_eq!(error.source_line(), Some("  <mass>-1</mass>"));
    }

    #[test]
    fn a_missing_file_has_no_place() {
        let error = SceneError::in_file("no.sdf", "cannot be read: not found");
        assert_eq!(error.line(), None);
        let text = error.to_string();
        assert!(text.contains("error: cannot be read") && text.contains("no.sdf"), "{text}");
    }

    #[test]
    fn close_words_are_suggested_and_far_ones_are_not() {
        assert_eq!(
            did_you_mean("revolut", ["fixed", "revolute"]).as_deref(),
            Some("did you mean `revolute`?")
        );
        assert_eq!(did_you_mean("abcdef", ["fixed", "revolute"]), None);
    }
}
