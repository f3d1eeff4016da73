//! Runs the command, and reads what it records.
// Not every test file uses everything here.
#![allow(dead_code)]

use std::path::PathBuf;
use std::process::Command;

/// What a run of the command left.
pub struct Done {
    pub code: i32,
    pub out: String,
    pub err: String,
}

/// Runs the command, its output piped.
pub fn ferrode(line: &[&str]) -> Done {
    ferrode_with(line, &[])
}

/// As [`ferrode`], with environment variables.
pub fn ferrode_with(line: &[&str], variables: &[(&str, &str)]) -> Done {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ferrode"));
    for variable in ["GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH", "ROS_PACKAGE_PATH"] {
        command.env_remove(variable);
    }
    let output = command.args(line).envs(variables.iter().copied()).output().unwrap();
    Done {
        code: output.status.code().unwrap(),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

/// A file of `tests/data`; a whole path is taken as it is.
pub fn data(name: &str) -> String {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    folder.join(name).to_str().unwrap().to_owned()
}

/// A path to write to. Tests use names of their own.
pub fn scratch(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// A file of `tests/data` with a part replaced, under another name.
pub fn edited(file: &str, name: &str, from: &str, to: &str) -> String {
    let text = std::fs::read_to_string(data(file)).unwrap();
    assert!(text.contains(from), "{file} has no {from}");
    let path = scratch(name);
    std::fs::write(&path, text.replace(from, to)).unwrap();
    path.to_str().unwrap().to_owned()
}

/// A recording.
#[derive(Debug, PartialEq)]
pub struct Table {
    pub names: Vec<String>,
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// From CSV without quotes.
    pub fn from_csv(text: &str) -> Self {
        let mut lines = text.lines().map(|line| line.split(','));
        let names: Vec<String> = lines.next().unwrap().map(str::to_owned).collect();
        let rows: Vec<Vec<f64>> =
            lines.map(|line| line.map(|cell| cell.parse().unwrap()).collect()).collect();
        assert!(rows.iter().all(|row| row.len() == names.len()));
        Self { names, rows }
    }

    /// From a JSON object a line, read in the order of its text.
    pub fn from_json_lines(text: &str) -> Self {
        let mut names = Vec::new();
        let mut rows = Vec::new();
        for line in text.lines() {
            let object: serde_json::Map<String, serde_json::Value> = serde_json::from_str(line).unwrap();
            let mut members: Vec<(usize, String, f64)> = object
                .into_iter()
                .map(|(name, value)| {
                    let place = line.find(&format!("{}:", serde_json::Value::from(name.as_str()))).unwrap();
                    (place, name, value.as_f64().unwrap())
                })
                .collect();
            members.sort_by_key(|(place, ..)| *place);
            names = members.iter().map(|(_, name, _)| name.clone()).collect();
            rows.push(members.into_iter().map(|(.., value)| value).collect());
        }
        Self { names, rows }
    }

    /// The column of a name.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let at = self.names.iter().position(|known| known == name);
        let at = at.unwrap_or_else(|| panic!("no column {name} in {:?}", self.names));
        self.rows.iter().map(|row| row[at]).collect()
    }

    /// The last value of a column.
    pub fn last(&self, name: &str) -> f64 {
        *self.column(name).last().unwrap()
    }
}

/// A file of the project's `worlds`.
pub fn world(name: &str) -> String {
    format!("{}/../../worlds/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// Runs a file, and reads its recording and its summary. `name` is for the recording.
pub fn recorded(file: &str, name: &str, options: &[&str]) -> (Table, serde_json::Value) {
    let out = scratch(name);
    let mut line = vec!["run", file, "--quiet", "--json", "--record", out.to_str().unwrap()];
    line.extend(options);
    let done = ferrode(&line);
    assert_eq!(done.code, 0, "{line:?}: {}", done.err);
    let table = Table::from_csv(&std::fs::read_to_string(out).unwrap());
    (table, serde_json::from_str(&done.out).unwrap())
}
