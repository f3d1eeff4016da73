//! Recordings of `ferrode run --record`: JSON lines, or comma-separated values.

use ferrode_math::{Pose, Quat, Vec3};
use std::path::Path;

/// A recording, and the moment of it that is shown.
#[derive(Clone, Debug)]
pub struct Recording {
    names: Vec<String>,
    times: Vec<f64>,
    /// By moment, then by link.
    poses: Vec<Vec<Pose>>,
    shown: usize,
    time: f64,
}

const PARTS: [&str; 7] = ["x[m]", "y[m]", "z[m]", "qw", "qx", "qy", "qz"];

impl Recording {
    /// Reads a recording.
    ///
    /// # Errors
    /// The file cannot be read, or a line is none of a recording: with its number.
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        Self::parse(&text).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Reads a recording's text.
    ///
    /// # Errors
    /// A line is none of a recording: with its number.
    pub fn parse(text: &str) -> Result<Self, String> {
        let rows = if text.trim_start().starts_with('{') { json_rows(text)? } else { csv_rows(text)? };
        let Some((columns, _)) = rows.first() else { return Err("the recording is empty".to_owned()) };
        let link = |column: &str| column.strip_prefix("link.")?.strip_suffix(".x[m]").map(str::to_owned);
        let names: Vec<String> = columns.iter().filter_map(|column| link(column)).collect();
        if names.is_empty() {
            return Err("there is no link in it: no column link.NAME.x[m]".to_owned());
        }
        let (mut times, mut poses) = (Vec::new(), Vec::new());
        for (number, (columns, values)) in rows.iter().enumerate() {
            let value = |name: &str| {
                let at = columns.iter().position(|column| column == name);
                at.and_then(|at| values.get(at).copied())
                    .ok_or_else(|| format!("row {}: there is no {name}", number + 1))
            };
            times.push(value("time[s]")?);
            let pose = |name: &String| {
                let mut v = [0.0; 7];
                for (place, part) in v.iter_mut().zip(PARTS) {
                    *place = value(&format!("link.{name}.{part}"))?;
                }
                let rotation = Quat::new(v[3], v[4], v[5], v[6]).normalized().unwrap_or_default();
                Ok(Pose::new(Vec3::new(v[0], v[1], v[2]), rotation))
            };
            poses.push(names.iter().map(pose).collect::<Result<Vec<Pose>, String>>()?);
        }
        if times.windows(2).any(|pair| pair[0] > pair[1]) {
            return Err("time runs backwards in it".to_owned());
        }
        let time = times.first().copied().unwrap_or(0.0);
        Ok(Self { names, times, poses, shown: 0, time })
    }

    /// Names of the links.
    pub fn links(&self) -> &[String] {
        &self.names
    }

    /// The time that is shown, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// First and last time, s.
    pub fn range(&self) -> [f64; 2] {
        [self.times.first().copied().unwrap_or(0.0), self.times.last().copied().unwrap_or(0.0)]
    }

    /// Shows a time; one outside the recording is its first or last.
    pub fn seek(&mut self, time: f64) {
        let [first, last] = self.range();
        self.time = if time.is_finite() { time.clamp(first, last) } else { first };
        self.shown = self.times.partition_point(|t| *t <= self.time).saturating_sub(1);
    }

    /// Shows the next recorded moment.
    pub fn next(&mut self) {
        self.shown = (self.shown + 1).min(self.times.len().saturating_sub(1));
        self.time = self.times.get(self.shown).copied().unwrap_or(self.time);
    }

    /// Shows the recorded moment before.
    pub fn previous(&mut self) {
        self.shown = self.shown.saturating_sub(1);
        self.time = self.times.get(self.shown).copied().unwrap_or(self.time);
    }

    /// The links' poses now, between the recorded moments in proportion.
    pub fn poses(&self) -> impl Iterator<Item = (&str, Pose)> + '_ {
        let now = self.poses.get(self.shown).map_or(&[][..], Vec::as_slice);
        let then = self.poses.get(self.shown + 1).map_or(now, Vec::as_slice);
        let from = self.times.get(self.shown).copied().unwrap_or(0.0);
        let span = self.times.get(self.shown + 1).map_or(0.0, |to| to - from);
        let t = if span > 0.0 { ((self.time - from) / span).clamp(0.0, 1.0) } else { 0.0 };
        let poses = now.iter().zip(then).map(move |(a, b)| a.interpolate(b, t));
        self.names.iter().map(String::as_str).zip(poses)
    }

    /// A world for recordings of which the world file is not given: a small box for each link.
    pub fn stand_in(&self) -> String {
        use std::fmt::Write;
        let escaped = |name: &str| name.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        let mut text = String::from("<sdf version=\"1.10\"><world name=\"recording\">");
        for name in &self.names {
            // Nested names stand for models within models; here each link gets a flat one of its own.
            let _ = write!(
                text,
                "<model name=\"{0}\"><link name=\"link\"><collision name=\"c\"><geometry><box><size>0.2 0.15 0.1</size></box>\
                 </geometry></collision></link></model>",
                escaped(&name.replace("::", "/"))
            );
        }
        text.push_str("</world></sdf>");
        text
    }

    /// Renames the links to those of [`Recording::stand_in`].
    pub fn rename_for_stand_in(&mut self) {
        for name in &mut self.names {
            *name = format!("{}::link", name.replace("::", "/"));
        }
    }
}

type Row = (Vec<String>, Vec<f64>);

fn json_rows(text: &str) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let object: serde_json::Map<String, serde_json::Value> =
            serde_json::from_str(line).map_err(|error| format!("line {}: {error}", number + 1))?;
        rows.push(object.into_iter().map(|(key, value)| (key, value.as_f64().unwrap_or(f64::NAN))).unzip());
    }
    Ok(rows)
}

fn csv_rows(text: &str) -> Result<Vec<Row>, String> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let header = lines.next().map(|(_, line)| csv_fields(line)).unwrap_or_default();
    let mut rows = Vec::new();
    for (number, line) in lines {
        let values: Result<Vec<f64>, _> = csv_fields(line).iter().map(|field| field.parse::<f64>()).collect();
        let values = values.map_err(|error| format!("line {}: {error}", number + 1))?;
        if values.len() != header.len() {
            return Err(format!("line {}: {} values for {} columns", number + 1, values.len(), header.len()));
        }
        rows.push((header.clone(), values));
    }
    Ok(rows)
}

/// The fields of a line, with quotes as RFC 4180 has them.
fn csv_fields(line: &str) -> Vec<String> {
    let (mut fields, mut field, mut quoted) = (Vec::new(), String::new(), false);
    let mut characters = line.chars().peekable();
    while let Some(c) = characters.next() {
        match (c, quoted) {
            ('"', true) if characters.peek() == Some(&'"') => {
                characters.next();
                field.push('"');
            }
            ('"', _) => quoted = !quoted,
            (',', false) => fields.push(std::mem::take(&mut field)),
            _ => field.push(c),
        }
    }
    fields.push(field);
    fields
}

#[cfg(test)]
mod tests {
    use super::Recording;

    const LINES: &str = r#"{"time[s]":0.0,"link.a.x[m]":1.0,"link.a.y[m]":0,"link.a.z[m]":0,"link.a.qw":1,"link.a.qx":0,"link.a.qy":0,"link.a.qz":0}
{"time[s]":0.5,"link.a.x[m]":3.0,"link.a.y[m]":0,"link.a.z[m]":0,"link.a.qw":1,"link.a.qx":0,"link.a.qy":0,"link.a.qz":0}"#;

    #[test]
    fn moments_and_what_is_between() {
        let mut recording = Recording::parse(LINES).unwrap();
        assert_eq!(recording.links(), ["a"]);
        assert_eq!(recording.range(), [0.0, 0.5]);
        recording.seek(0.125);
        let (name, pose) = recording.poses().next().unwrap();
        assert_eq!((name, pose.position.x), ("a", 1.5));
        recording.next();
        assert_eq!(recording.poses().next().unwrap().1.position.x, 3.0);
        recording.seek(9.0);
        assert_eq!(recording.time(), 0.5);
        recording.previous();
        assert_eq!(recording.time(), 0.0);
    }

    #[test]
    fn both_formats_say_the_same() {
        let csv = "time[s],\"link.a.x[m]\",link.a.y[m],link.a.z[m],link.a.qw,link.a.qx,link.a.qy,link.a.qz\n\
                   0,1,0,0,1,0,0,0\n0.5,3,0,0,1,0,0,0\n";
        let (a, b) = (Recording::parse(LINES).unwrap(), Recording::parse(csv).unwrap());
        assert_eq!((a.times, a.poses, a.names), (b.times, b.poses, b.names));
    }

    #[test]
    fn what_is_no_recording_is_named() {
        for (text, says) in [
            ("", "empty"),
            ("{\"time[s]\":0}", "no link"),
            ("{\"time[s]\":0", "line 1"),
            ("time[s],link.a.x[m]\n0,1", "there is no link.a.y[m]"),
            ("time[s],link.a.x[m]\n0", "line 2: 1 values for 2 columns"),
            ("time[s],link.a.x[m]\n0,huh", "line 2"),
        ] {
            let error = Recording::parse(text).unwrap_err();
            assert!(error.contains(says), "{text:?}: {error}");
        }
    }
}
