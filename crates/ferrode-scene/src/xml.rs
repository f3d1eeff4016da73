//! XML elements with their places, and values read from them with errors that name the place.

use std::borrow::Cow;
use std::ops::Range;

use roxmltree::{Document, Node};

use crate::error::{Notes, Result, SceneError, did_you_mean};
use crate::source::{Origin, Source};

/// Parses a file and hands its root element to `read`.
///
/// Two departures from strict XML, both common in files that other tools accept: `--` inside comments, and
/// prefixes (`gz:`, `xacro:`) that nobody declared. Places stay true to the file as it is.
pub(crate) fn with_root<T>(source: &Source, read: impl FnOnce(Element<'_>) -> Result<T>) -> Result<T> {
    let mut text = Cow::Borrowed(source.text());
    let mut shift = Shift { at: usize::MAX, by: 0 };
    loop {
        let options = roxmltree::ParsingOptions { nodes_limit: 50_000_000, ..Default::default() };
        match Document::parse_with_options(&text, options) {
            Ok(document) => {
                let file = File { source, shift };
                return read(Element { node: document.root_element(), file: &file });
            }
            Err(roxmltree::Error::InvalidComment(_)) => match without_comments(&text) {
                Some(blanked) => text = Cow::Owned(blanked),
                None => return Err(not_well_formed(source, shift, &roxmltree::Error::UnclosedRootNode)),
            },
            Err(error @ roxmltree::Error::UnknownNamespace(..)) => {
                let roxmltree::Error::UnknownNamespace(prefix, _) = &error else { continue };
                match with_namespace(&text, prefix) {
                    Some((declared, at, by)) => {
                        text = Cow::Owned(declared);
                        shift = Shift { at: shift.at.min(at), by: shift.by + by };
                    }
                    None => return Err(not_well_formed(source, shift, &error)),
                }
            }
            Err(error) => return Err(not_well_formed(source, shift, &error)),
        }
    }
}

/// Bytes put in after `at`, so that a place after it in the parsed text is `by` further than in the file.
#[derive(Clone, Copy)]
struct Shift {
    at: usize,
    by: usize,
}

impl Shift {
    fn undo(self, offset: usize) -> usize {
        if offset <= self.at { offset } else { self.at.max(offset.saturating_sub(self.by)) }
    }
}

fn not_well_formed(source: &Source, shift: Shift, error: &roxmltree::Error) -> SceneError {
    use roxmltree::Error as E;
    let position = error.pos();
    let offset = match error {
        // These two have no place of their own: what is missing is missing at the end.
        E::UnclosedRootNode | E::NoRootNode => source.text().trim_end().len().saturating_sub(1),
        _ => shift.undo(source.offset_at(position.row as usize, position.col as usize)),
    };
    let message = match error {
        E::UnexpectedCloseTag(expected, actual, _) => {
            format!("the XML is broken: `</{actual}>` closes `<{expected}>`")
        }
        E::UnclosedRootNode => "the XML is broken: the file ends before its elements are closed".to_owned(),
        E::NoRootNode => "the XML is broken: the file holds no element".to_owned(),
        E::DuplicatedAttribute(name, _) => format!("the XML is broken: attribute `{name}` is given twice"),
        E::InvalidComment(_) => "the XML is broken: a comment is not closed".to_owned(),
        other => {
            let text = other.to_string();
            // The crate adds " at row:column"; the report has its own.
            let text = text.rsplit_once(" at ").map_or(text.as_str(), |(before, _)| before);
            format!("the XML is broken: {text}")
        }
    };
    let end = source.text()[offset.min(source.text().len())..].chars().next().map_or(0, char::len_utf8);
    SceneError::new(Origin::new(source, offset..offset + end, ""), message)
}

/// The text with comments overwritten by spaces, length and line ends kept; `None` if it has none to blank.
fn without_comments(text: &str) -> Option<String> {
    let mut blanked = String::with_capacity(text.len());
    let mut rest = text;
    let mut changed = false;
    loop {
        let comment = rest.find("<!--");
        let cdata = rest.find("<![CDATA[");
        match (comment, cdata) {
            (Some(start), cdata) if cdata.is_none_or(|cdata| start < cdata) => {
                let length = rest[start + 4..].find("-->")? + 7;
                blanked.push_str(&rest[..start]);
                let comment = &rest[start..start + length];
                blanked.extend(comment.bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' }));
                rest = &rest[start + length..];
                changed = true;
            }
            (_, Some(start)) => {
                let length = rest[start..].find("]]>").map_or(rest.len() - start, |end| end + 3);
                blanked.push_str(&rest[..start + length]);
                rest = &rest[start + length..];
            }
            _ => break,
        }
    }
    blanked.push_str(rest);
    (changed && blanked != text).then_some(blanked)
}

/// The text with `prefix` declared on its root element, where it went in and how long it is.
fn with_namespace(text: &str, prefix: &str) -> Option<(String, usize, usize)> {
    let mut from = 0;
    let root = loop {
        let open = from + text[from..].find('<')?;
        let after = &text[open + 1..];
        if let Some(comment) = after.strip_prefix("!--") {
            from = open + 4 + comment.find("-->")?;
        } else if after.starts_with(['?', '!']) {
            from = open + 1;
        } else {
            break open + 1;
        }
    };
    let at = root + text[root..].find(|c: char| c.is_whitespace() || c == '>' || c == '/')?;
    let declaration = format!(" xmlns:{prefix}=\"undeclared:{prefix}\"");
    if prefix.is_empty() || text.contains(&declaration) {
        return None;
    }
    Some((format!("{}{declaration}{}", &text[..at], &text[at..]), at, declaration.len()))
}

struct File<'a> {
    source: &'a Source,
    shift: Shift,
}

/// An element of a parsed file.
#[derive(Clone, Copy)]
pub(crate) struct Element<'a> {
    node: Node<'a, 'a>,
    file: &'a File<'a>,
}

/// What an element may hold, for [`Element::expect`].
#[derive(Clone, Copy, Default)]
pub(crate) struct Children {
    /// Read at most once; a second one is a warning, and the first counts.
    pub single: &'static [&'static str],
    /// Read as often as they come.
    pub many: &'static [&'static str],
    /// Known to have no bearing on the dynamics.
    pub silent: &'static [&'static str],
    /// Passed over, and counted under the plural that stands beside them.
    pub counted: &'static [(&'static str, &'static str)],
    /// The attributes that are read, or known to have no bearing on the dynamics.
    pub attributes: &'static [&'static str],
}

impl<'a> Element<'a> {
    /// The name as written, with its prefix if it has one.
    pub(crate) fn name(&self) -> &'a str {
        let text = &self.node.document().input_text()[self.node.range().start + 1..];
        let end = text.find(|c: char| c.is_whitespace() || c == '>' || c == '/').unwrap_or(text.len());
        &text[..end]
    }

    /// The file it stands in.
    pub(crate) fn source(&self) -> &'a Source {
        self.file.source
    }

    fn place(&self, span: Range<usize>) -> Origin {
        let shift = self.file.shift;
        Origin::new(self.file.source, shift.undo(span.start)..shift.undo(span.end), self.name())
    }

    /// The place of its opening tag's name.
    pub(crate) fn origin(&self) -> Origin {
        let start = self.node.range().start;
        self.place(start..start + 1 + self.name().len())
    }

    /// An error at the opening tag.
    pub(crate) fn error(&self, message: impl Into<String>) -> SceneError {
        SceneError::new(self.origin(), message)
    }

    /// The child elements without a prefix; those with one are somebody's own and mean nothing here.
    pub(crate) fn children(&self) -> impl Iterator<Item = Element<'a>> + use<'a> {
        self.all_children().filter(|element| !element.name().contains(':'))
    }

    fn all_children(&self) -> impl Iterator<Item = Element<'a>> + use<'a> {
        let file = self.file;
        self.node.children().filter(Node::is_element).map(move |node| Element { node, file })
    }

    /// The child elements of one name.
    pub(crate) fn all(&self, name: &'static str) -> impl Iterator<Item = Element<'a>> + use<'a> {
        self.children().filter(move |child| child.name() == name)
    }

    /// The first child element of one name.
    pub(crate) fn child(&self, name: &str) -> Option<Element<'a>> {
        self.children().find(|child| child.name() == name)
    }

    /// The first child element of one name, which must be there.
    pub(crate) fn required(&self, name: &str) -> Result<Element<'a>> {
        self.child(name).ok_or_else(|| self.error(format!("<{}> needs a <{name}>", self.name())))
    }

    /// An attribute.
    pub(crate) fn attribute(&self, name: &str) -> Option<Value<'a>> {
        let attribute = self.node.attribute_node(name)?;
        let origin = self.place(attribute.range_value());
        Some(Value {
            text: Cow::Borrowed(attribute.value().trim()),
            origin,
            what: format!("attribute `{name}`"),
        })
    }

    /// An attribute that must be there.
    pub(crate) fn required_attribute(&self, name: &str) -> Result<Value<'a>> {
        self.attribute(name)
            .ok_or_else(|| self.error(format!("<{}> needs an attribute `{name}`", self.name())))
    }

    /// The text between the tags, comments left out.
    pub(crate) fn value(&self) -> Value<'a> {
        let mut texts = self.node.children().filter(Node::is_text);
        let first = texts.next();
        let mut text = Cow::Borrowed(first.and_then(|node| node.text()).unwrap_or(""));
        for more in texts {
            text = Cow::Owned(format!("{text} {}", more.text().unwrap_or("")));
        }
        let origin = match first {
            Some(node) if !text.trim().is_empty() => {
                let range = node.range();
                let raw = &self.node.document().input_text()[range.clone()];
                let start = range.start + (raw.len() - raw.trim_start().len());
                self.place(start..(start + raw.trim().len()).max(start))
            }
            _ => self.origin(),
        };
        let text = match text {
            Cow::Borrowed(text) => Cow::Borrowed(text.trim()),
            Cow::Owned(text) => Cow::Owned(text.trim().to_owned()),
        };
        Value { text, origin, what: format!("<{}>", self.name()) }
    }

    /// The number in a child element, or `default` if there is no such child.
    pub(crate) fn number_in(&self, name: &str, default: f64) -> Result<f64> {
        self.optional_number_in(name).map(|number| number.unwrap_or(default))
    }

    /// The number in a child element, if it is there.
    pub(crate) fn optional_number_in(&self, name: &str) -> Result<Option<f64>> {
        self.child(name).map(|child| child.value().number()).transpose()
    }

    /// The truth value in a child element, or `default` if there is no such child.
    pub(crate) fn flag_in(&self, name: &str, default: bool) -> Result<bool> {
        self.child(name).map_or(Ok(default), |child| child.value().flag())
    }

    /// Warns of what is neither read nor known to be harmless, of what is given twice, and counts the rest.
    pub(crate) fn expect(&self, notes: &mut Notes, expected: &Children) {
        let mut seen: Vec<&str> = Vec::new();
        for child in self.all_children() {
            let name = child.name();
            if let Some((prefix, _)) = name.split_once(':') {
                // SDF's own trials have this prefix, and change what they stand in.
                if prefix == "experimental" {
                    notes.not_understood(
                        child.origin(),
                        format!("<{name}> is not supported and has no effect"),
                    );
                } else {
                    notes.count(self.source().name(), "elements of other tools (with a prefix)");
                }
                continue;
            }
            if expected.single.contains(&name) {
                if seen.contains(&name) {
                    notes.suspicious(
                        child.origin(),
                        format!("<{name}> is given twice in <{}>: the first one counts", self.name()),
                    );
                }
                seen.push(name);
            } else if let Some((_, plural)) = expected.counted.iter().find(|(counted, _)| *counted == name) {
                notes.count(self.source().name(), plural);
            } else if !expected.many.contains(&name) && !expected.silent.contains(&name) {
                let known = expected.single.iter().chain(expected.many).copied();
                let warning = crate::error::Warning::new(
                    crate::error::WarningKind::NotUnderstood,
                    child.origin(),
                    format!("<{name}> in <{}> is not understood and has no effect", self.name()),
                );
                notes.push(match did_you_mean(name, known) {
                    Some(help) => warning.with_help(help),
                    None => warning,
                });
            }
        }
        for attribute in self.node.attributes() {
            if attribute.namespace().is_none() && !expected.attributes.contains(&attribute.name()) {
                let name = attribute.name();
                let warning = crate::error::Warning::new(
                    crate::error::WarningKind::NotUnderstood,
                    self.place(attribute.range_qname()),
                    format!("attribute `{name}` of <{}> is not understood and has no effect", self.name()),
                );
                notes.push(match did_you_mean(name, expected.attributes.iter().copied()) {
                    Some(help) => warning.with_help(help),
                    None => warning,
                });
            }
        }
    }
}

/// The text of an element or attribute, with its place.
pub(crate) struct Value<'a> {
    text: Cow<'a, str>,
    origin: Origin,
    what: String,
}

impl Value<'_> {
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    pub(crate) fn origin(&self) -> Origin {
        self.origin.clone()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.text.is_empty()
    }

    /// An error at the value.
    pub(crate) fn error(&self, message: impl Into<String>) -> SceneError {
        SceneError::new(self.origin.clone(), message)
    }

    fn should_be(&self, expected: &str) -> SceneError {
        if self.text.is_empty() {
            return self.error(format!("{} is empty: {expected} expected", self.what));
        }
        let mut found: String = self.text.chars().take(40).collect();
        if found.len() < self.text.len() {
            found.push('…');
        }
        self.error(format!("{} should be {expected}, found `{found}`", self.what))
    }

    /// Text that is not empty.
    pub(crate) fn word(&self) -> Result<&str> {
        if self.text.is_empty() { Err(self.should_be("a name")) } else { Ok(&self.text) }
    }

    /// A finite number.
    pub(crate) fn number(&self) -> Result<f64> {
        match self.text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.should_be("a finite number")),
        }
    }

    /// A number that may be infinite, but is one.
    pub(crate) fn number_or_infinite(&self) -> Result<f64> {
        match self.text.parse::<f64>() {
            Ok(number) if !number.is_nan() => Ok(number),
            _ => Err(self.should_be("a number")),
        }
    }

    /// A finite number that is not negative.
    pub(crate) fn not_negative(&self) -> Result<f64> {
        let number = self.number()?;
        if number < 0.0 {
            return Err(self.error(format!("{} must not be negative, found {number}", self.what)));
        }
        Ok(number)
    }

    /// A finite number above zero.
    pub(crate) fn positive(&self) -> Result<f64> {
        let number = self.number()?;
        if number <= 0.0 {
            return Err(self.error(format!("{} must be positive, found {number}", self.what)));
        }
        Ok(number)
    }

    /// `N` finite numbers with white space between them.
    pub(crate) fn numbers<const N: usize>(&self) -> Result<[f64; N]> {
        let numbers = self.number_list()?;
        let count = numbers.len();
        <[f64; N]>::try_from(numbers)
            .map_err(|_| self.error(format!("{} should be {N} numbers, found {count}", self.what)))
    }

    /// Finite numbers with white space between them.
    pub(crate) fn number_list(&self) -> Result<Vec<f64>> {
        self.text
            .split_whitespace()
            .map(|word| match word.parse::<f64>() {
                Ok(number) if number.is_finite() => Ok(number),
                _ => Err(self.error(format!("{} should hold finite numbers, found `{word}`", self.what))),
            })
            .collect()
    }

    /// `true`, `false`, `1` or `0`.
    pub(crate) fn flag(&self) -> Result<bool> {
        match self.text.to_ascii_lowercase().as_str() {
            "true" | "1" => Ok(true),
            "false" | "0" => Ok(false),
            _ => Err(self.should_be("true or false")),
        }
    }

    /// A whole number, not negative, decimal or `0x…`.
    pub(crate) fn count(&self) -> Result<u32> {
        let parsed = match self.text.strip_prefix("0x").or_else(|| self.text.strip_prefix("0X")) {
            Some(hexadecimal) => u32::from_str_radix(hexadecimal, 16),
            None => self.text.parse::<u32>(),
        };
        parsed.map_err(|_| self.should_be("a whole number from 0"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn broken(text: &str) -> SceneError {
        with_root(&Source::from_text("t.xml", text), |_| Ok(())).expect_err(text)
    }

    #[test]
    fn broken_xml_is_placed() {
        let error = broken("<a>\n  <b></c>\n</a>");
        assert_eq!((error.line(), error.message()), (Some(2), "the XML is broken: `</c>` closes `<b>`"));
        assert_eq!(broken("<a>\n<b/>\n").line(), Some(2));
        assert_eq!(broken("").line(), Some(1));
        assert_eq!(broken("<a x='1'\n x='2'/>").line(), Some(2));
        assert_eq!(broken("<a>&nothing;</a>").line(), Some(1));
    }

    #[test]
    fn undeclared_prefixes_are_passed_over_and_places_stay_true() {
        let text =
            "<?xml version='1.0'?>\n<!-- <x> --><sdf a='1'>\n <gz:x/><drake:y/> <mass>q</mass>\n</sdf>";
        let error = with_root(&Source::from_text("t", text), |root| {
            assert_eq!(root.children().count(), 1);
            root.required("mass")?.value().number()
        })
        .expect_err("q is no number");
        assert_eq!((error.line(), error.column()), (Some(3), Some(26)));
        let error = with_root(&Source::from_text("t", text), |root| root.attribute("a").unwrap().flag());
        assert!(error.is_ok());
    }

    #[test]
    fn double_hyphens_in_comments_are_tolerated_and_lines_kept() {
        let text = "<a><!-- x -- \n y --->\n<b>1</b></a>";
        let line = with_root(&Source::from_text("t", text), |root| Ok(root.required("b")?.origin().line()));
        assert_eq!(line.unwrap(), 3);
        assert!(broken("<a><!-- x -- <b/></a>").message().contains("broken"));
    }

    #[test]
    fn text_around_comments_is_one_value() {
        let text = "<pose>1 2 <!-- height: --> 3</pose>";
        let numbers = with_root(&Source::from_text("t", text), |root| root.value().numbers::<3>());
        assert_eq!(numbers.unwrap(), [1.0, 2.0, 3.0]);
    }

    #[test]
    fn values_say_what_they_should_be() {
        let message = |text: &str, read: fn(Value<'_>) -> Result<()>| {
            with_root(&Source::from_text("t", text), |root| read(root.value()))
                .expect_err(text)
                .message()
                .to_owned()
        };
        assert_eq!(message("<m>x</m>", |v| v.number().map(drop)), "<m> should be a finite number, found `x`");
        assert_eq!(
            message("<m>inf</m>", |v| v.number().map(drop)),
            "<m> should be a finite number, found `inf`"
        );
        assert_eq!(message("<m/>", |v| v.number().map(drop)), "<m> is empty: a finite number expected");
        assert_eq!(message("<m>1 2</m>", |v| v.numbers::<3>().map(drop)), "<m> should be 3 numbers, found 2");
        assert_eq!(message("<m>0</m>", |v| v.positive().map(drop)), "<m> must be positive, found 0");
        assert_eq!(message("<m>yes</m>", |v| v.flag().map(drop)), "<m> should be true or false, found `yes`");
        assert_eq!(
            message("<m>-3</m>", |v| v.count().map(drop)),
            "<m> should be a whole number from 0, found `-3`"
        );
    }
}
