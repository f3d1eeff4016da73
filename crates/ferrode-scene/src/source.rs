//! A file's text, and places in it.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The text of one file and the name to call it by in messages. Clones share the text.
#[derive(Clone)]
pub struct Source(Arc<Inner>);

struct Inner {
    name: String,
    path: Option<PathBuf>,
    text: String,
}

impl Source {
    /// A text that was read from `path`; relative references in it start at the folder of `path`.
    pub fn from_file(path: &Path, text: String) -> Self {
        Self(Arc::new(Inner { name: path.display().to_string(), path: Some(path.to_path_buf()), text }))
    }

    /// A text that came from elsewhere; it has no folder, so relative references in it are not found.
    pub fn from_text(name: &str, text: &str) -> Self {
        Self(Arc::new(Inner { name: name.to_owned(), path: None, text: text.to_owned() }))
    }

    /// The name to print: the path as the caller gave it, or the name of the text.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// The file this came from, if it came from one.
    pub fn path(&self) -> Option<&Path> {
        self.0.path.as_deref()
    }

    /// The folder that relative references start from.
    pub fn folder(&self) -> Option<&Path> {
        self.path().and_then(Path::parent)
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        &self.0.text
    }

    /// Line and column of a byte offset, both from 1; the column counts characters.
    /// An offset past the end means the end.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let before = self.before(offset);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.bytes().filter(|&byte| byte == b'\n').count() + 1;
        (line, before[line_start..].chars().count() + 1)
    }

    /// The line that holds a byte offset, without its end.
    pub fn line_text(&self, offset: usize) -> &str {
        let before = self.before(offset);
        let start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let rest = &self.text()[start..];
        rest.split('\n').next().unwrap_or("").trim_end_matches('\r')
    }

    /// The byte offset of a line and column, both from 1; past the end means the end.
    pub(crate) fn offset_at(&self, line: usize, column: usize) -> usize {
        let text = self.text();
        let start = if line <= 1 {
            0
        } else {
            match text.match_indices('\n').nth(line - 2) {
                Some((newline, _)) => newline + 1,
                None => return text.len(),
            }
        };
        let rest = &text[start..];
        start + rest.char_indices().nth(column.saturating_sub(1)).map_or(rest.len(), |(at, _)| at)
    }

    fn before(&self, offset: usize) -> &str {
        let mut end = offset.min(self.text().len());
        while !self.text().is_char_boundary(end) {
            end -= 1;
        }
        &self.text()[..end]
    }
}

impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Source({})", self.name())
    }
}

/// Where something stands in a file: the bytes of its tag or value, and the element it belongs to.
/// The description keeps one with every link, joint and collision, so that whoever builds a world from it
/// can still name file and line.
#[derive(Clone)]
pub struct Origin {
    source: Source,
    start: usize,
    end: usize,
    element: Box<str>,
}

impl Origin {
    pub(crate) fn new(source: &Source, span: Range<usize>, element: &str) -> Self {
        Self {
            source: source.clone(),
            start: span.start,
            end: span.end.max(span.start),
            element: element.into(),
        }
    }

    /// The file.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The bytes of the tag or value.
    pub fn span(&self) -> Range<usize> {
        self.start..self.end
    }

    /// The element's name, as in `mass` for `<mass>`.
    pub fn element(&self) -> &str {
        &self.element
    }

    /// The line, from 1.
    pub fn line(&self) -> usize {
        self.source.line_column(self.start).0
    }

    /// The column, from 1, in characters.
    pub fn column(&self) -> usize {
        self.source.line_column(self.start).1
    }
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (line, column) = self.source.line_column(self.start);
        write!(f, "{}:{line}:{column}", self.source.name())
    }
}

impl fmt::Debug for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "<{}> at {self}", self.element)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_and_columns_count_characters() {
        let source = Source::from_text("t", "ab\r\n\u{e4}\u{f6}x\nlast");
        assert_eq!(source.line_column(0), (1, 1));
        assert_eq!(source.line_column(4), (2, 1));
        let x = source.text().find('x').unwrap();
        assert_eq!(source.line_column(x), (2, 3));
        assert_eq!(source.line_text(x), "\u{e4}\u{f6}x");
        assert_eq!(source.line_text(1), "ab");
        assert_eq!(source.offset_at(2, 3), x);
        assert_eq!(source.line_column(1_000), (3, 5));
        assert_eq!(source.offset_at(9, 9), source.text().len());
    }

    #[test]
    fn an_offset_inside_a_character_is_taken_back_to_its_start() {
        let source = Source::from_text("t", "\u{e4}b");
        assert_eq!(source.line_column(1), (1, 1));
    }
}
