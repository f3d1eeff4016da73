//! Finds the files that `model://…`, `package://…` and relative references mean.

use std::path::{Path, PathBuf};

use crate::source::Source;

/// What became of a reference to a file.
pub(crate) enum Found {
    /// The file or folder.
    Path(PathBuf),
    /// Why there is none.
    Nothing(String),
}

/// Looks a reference up: in the search path for `model://` and `package://`, from the folder of the file that makes
/// it and then in the search path for relative ones.
///
/// `model://name/rest` is `name/rest` in a folder of the search path, and so is `package://name/rest`; or, where
/// such a folder is itself called `name`, `rest` in it. The folders above the file are tried last, since packages
/// and models mostly come whole.
pub(crate) fn find(uri: &str, from: &Source, search: &[PathBuf]) -> Found {
    let lower = uri.to_ascii_lowercase();
    if let Some(path) = strip_scheme(uri, &lower, "file://") {
        return on_disk(Path::new(path), uri, from);
    }
    for scheme in ["model://", "package://"] {
        if let Some(rest) = strip_scheme(uri, &lower, scheme) {
            return in_search_path(rest, uri, from, search);
        }
    }
    if let Some((scheme, _)) = uri.split_once("://") {
        return Found::Nothing(format!(
            "`{uri}` cannot be read: `{scheme}://` is not supported, download it first"
        ));
    }
    match on_disk(Path::new(uri), uri, from) {
        Found::Path(path) => Found::Path(path),
        Found::Nothing(message) => {
            let found = search.iter().map(|folder| folder.join(uri)).find(|path| path.exists());
            found.map_or(Found::Nothing(message), Found::Path)
        }
    }
}

fn strip_scheme<'a>(uri: &'a str, lower: &str, scheme: &str) -> Option<&'a str> {
    lower.starts_with(scheme).then(|| &uri[scheme.len()..])
}

fn on_disk(path: &Path, uri: &str, from: &Source) -> Found {
    let path = match from.folder() {
        Some(folder) if path.is_relative() => folder.join(path),
        _ => path.to_path_buf(),
    };
    if path.exists() { Found::Path(path) } else { Found::Nothing(format!("there is no file `{uri}`")) }
}

fn in_search_path(rest: &str, uri: &str, from: &Source, search: &[PathBuf]) -> Found {
    let (name, inside) = rest.split_once('/').unwrap_or((rest, ""));
    let above =
        from.folder().into_iter().flat_map(Path::ancestors).filter(|folder| !folder.as_os_str().is_empty());
    for folder in search.iter().map(PathBuf::as_path).chain(above) {
        let direct = folder.join(rest);
        if direct.exists() {
            return Found::Path(direct);
        }
        let itself = folder.join(inside);
        if folder.file_name().is_some_and(|last| last == name) && itself.exists() {
            return Found::Path(itself);
        }
    }
    let searched = match search {
        [] => "the search path is empty".to_owned(),
        folders => {
            let list: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
            format!("searched: {}", list.join(", "))
        }
    };
    Found::Nothing(format!("`{uri}` is not found ({searched})"))
}
