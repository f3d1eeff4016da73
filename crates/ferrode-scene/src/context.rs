//! What a reader carries along: options, warnings, and the files it is inside of.

use std::path::{Path, PathBuf};

use crate::LoadOptions;
use crate::error::{Notes, Result, SceneError};
use crate::source::Source;

pub(crate) struct Context<'o> {
    pub options: &'o LoadOptions,
    pub notes: Notes,
    /// Files being read, the outermost first: an `<include>` of one of them would never end.
    open: Vec<PathBuf>,
}

impl<'o> Context<'o> {
    pub(crate) fn new(options: &'o LoadOptions) -> Self {
        Self { options, notes: Notes::default(), open: Vec::new() }
    }

    /// Reads `path` with `read`, unless it is being read already.
    pub(crate) fn read_file<T>(
        &mut self,
        path: &Path,
        read: impl FnOnce(&mut Self, &Source) -> Result<T>,
    ) -> Result<T> {
        let name = path.display().to_string();
        let unreadable = |error: &dyn std::fmt::Display| {
            SceneError::in_file(name.clone(), format!("cannot be read: {error}"))
        };
        let canonical = path.canonicalize().map_err(|error| unreadable(&error))?;
        if self.open.contains(&canonical) {
            return Err(SceneError::in_file(name, "the file includes itself"));
        }
        let bytes = std::fs::read(path).map_err(|error| unreadable(&error))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let valid = error.utf8_error().valid_up_to();
            unreadable(&format!("it is not UTF-8 text from byte {valid} on"))
        })?;
        // A byte order mark is no part of the text.
        let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
        self.open.push(canonical);
        let result = read(self, &Source::from_file(path, text));
        self.open.pop();
        result
    }
}
