//! Recordings: a row a step, whose columns name links and joints and tell units.
//!
//! | column | |
//! |---|---|
//! | `time[s]` | simulated time |
//! | `link.NAME.x[m]`, `.y[m]`, `.z[m]` | the link's origin in the world |
//! | `link.NAME.qw`, `.qx`, `.qy`, `.qz` | its rotation, a unit quaternion from link to world |
//! | `link.NAME.vx[m/s]` … `.wz[rad/s]` | velocity of the origin, angular velocity, in the world |
//! | `joint.NAME.position[rad]` or `[m]`, `.velocity[rad/s]` or `[m/s]` | of joints with one axis |
//! | `joint.NAME.position1[rad]` … `.velocity2[rad/s]` | of joints with two axes |
//! | `energy.kinetic[J]`, `energy.potential[J]` | of all bodies |
//! | `contacts` | contact points of the step |
//!
//! Links that cannot move are left out. CSV has the names in its first row (quoted where RFC 4180 asks for it); JSON lines
//! have them in each object. A number that is not finite is `NaN`, `inf`, `-inf` in CSV and null in JSON.
//!
//! With the feature `rerun` a name that ends in `.rrd` asks for a recording for Rerun's viewer (`rrd`).

use crate::exit::Failure;
use crate::simulation::Simulation;
use ferrode_scene::description::{JointId, LinkId};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// How a recording is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Comma-separated values.
    Csv,
    /// A JSON object a line.
    JsonLines,
    /// For Rerun's viewer.
    #[cfg(feature = "rerun")]
    Rerun,
}

/// Whether a file's name is that of a recording for Rerun.
pub fn is_rerun(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("rrd"))
}

impl Format {
    /// The format that a file's name asks for.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            "jsonl" => Some(Self::JsonLines),
            #[cfg(feature = "rerun")]
            "rrd" => Some(Self::Rerun),
            _ => None,
        }
    }
}

/// A recording under way.
pub enum Recorder {
    /// Of rows.
    Table(Table),
    /// For Rerun.
    #[cfg(feature = "rerun")]
    Rerun(crate::rrd::Recording),
}

impl Recorder {
    /// Starts a recording.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, simulation: &Simulation) -> Result<Self, Failure> {
        match Format::of(path).unwrap_or(Format::Csv) {
            #[cfg(feature = "rerun")]
            Format::Rerun => Ok(Self::Rerun(crate::rrd::Recording::create(path, simulation)?)),
            format => Ok(Self::Table(Table::create(path, format, simulation)?)),
        }
    }

    /// Writes the present state.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn record(&mut self, simulation: &Simulation) -> Result<(), Failure> {
        match self {
            Self::Table(table) => table.record(simulation),
            #[cfg(feature = "rerun")]
            Self::Rerun(recording) => recording.record(simulation),
        }
    }

    /// Writes what is left.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(self) -> Result<(), Failure> {
        match self {
            Self::Table(table) => table.finish(),
            #[cfg(feature = "rerun")]
            Self::Rerun(recording) => recording.finish(),
        }
    }
}

/// A recording of rows.
pub struct Table {
    out: BufWriter<File>,
    path: PathBuf,
    format: Format,
    columns: Vec<String>,
    links: Vec<LinkId>,
    axes: Vec<(JointId, usize)>,
    row: Vec<f64>,
}

impl Table {
    fn create(path: &Path, format: Format, simulation: &Simulation) -> Result<Self, Failure> {
        let scene = simulation.scene();
        let mut columns = vec!["time[s]".to_owned()];
        let links: Vec<LinkId> =
            (0..scene.links.len()).map(LinkId).filter(|link| simulation.moves(*link)).collect();
        for link in &links {
            let name = &scene.links[link.0].name;
            for part in [
                "x[m]",
                "y[m]",
                "z[m]",
                "qw",
                "qx",
                "qy",
                "qz",
                "vx[m/s]",
                "vy[m/s]",
                "vz[m/s]",
                "wx[rad/s]",
                "wy[rad/s]",
                "wz[rad/s]",
            ] {
                columns.push(format!("link.{name}.{part}"));
            }
        }
        let mut axes = Vec::new();
        for (index, joint) in scene.joints.iter().enumerate() {
            let id = JointId(index);
            let present: Vec<usize> =
                (0..2).filter(|axis| simulation.joint_position(id, *axis).is_some()).collect();
            for axis in &present {
                let unit = simulation.joint_unit(id, *axis);
                let number = if present.len() > 1 { (axis + 1).to_string() } else { String::new() };
                columns.push(format!("joint.{}.position{number}[{unit}]", joint.name));
                columns.push(format!("joint.{}.velocity{number}[{unit}/s]", joint.name));
                axes.push((id, *axis));
            }
        }
        columns.extend(["energy.kinetic[J]", "energy.potential[J]", "contacts"].map(str::to_owned));
        let file = File::create(path).map_err(|error| Failure::output(path.display(), &error))?;
        let mut recorder = Self {
            out: BufWriter::new(file),
            path: path.to_owned(),
            format,
            columns,
            links,
            axes,
            row: Vec::new(),
        };
        if format == Format::Csv {
            let header: Vec<String> = recorder.columns.iter().map(|name| csv_field(name)).collect();
            recorder.line(&header.join(","))?;
        }
        Ok(recorder)
    }

    fn record(&mut self, simulation: &Simulation) -> Result<(), Failure> {
        let mut row = std::mem::take(&mut self.row);
        row.clear();
        let world = simulation.world();
        row.push(world.time());
        for link in &self.links {
            let pose = simulation.link_pose(*link);
            let (linear, angular) = simulation.link_velocity(*link);
            let (p, q) = (pose.position, pose.rotation);
            row.extend([p.x, p.y, p.z, q.w, q.x, q.y, q.z]);
            row.extend([linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]);
        }
        for (joint, axis) in &self.axes {
            row.push(simulation.joint_position(*joint, *axis).unwrap_or(f64::NAN));
            row.push(simulation.joint_velocity(*joint, *axis).unwrap_or(f64::NAN));
        }
        let energy = world.energy();
        row.extend([energy.kinetic, energy.potential, world.contacts().len() as f64]);
        let text = match self.format {
            Format::JsonLines => {
                let members = self.columns.iter().zip(&row).map(|(name, value)| {
                    format!("{}:{}", serde_json::Value::from(name.as_str()), serde_json::Value::from(*value))
                });
                format!("{{{}}}", members.collect::<Vec<_>>().join(","))
            }
            _ => row.iter().map(|value| csv_number(*value)).collect::<Vec<_>>().join(","),
        };
        self.row = row;
        self.line(&text)
    }

    fn finish(mut self) -> Result<(), Failure> {
        self.out.flush().map_err(|error| Failure::output(self.path.display(), &error))
    }

    fn line(&mut self, text: &str) -> Result<(), Failure> {
        writeln!(self.out, "{text}").map_err(|error| Failure::output(self.path.display(), &error))
    }
}

/// The shortest text that reads back as the same number.
fn csv_number(value: f64) -> String {
    match serde_json::Number::from_f64(value) {
        Some(number) => number.to_string(),
        None => value.to_string(),
    }
}

/// Quotes a field that holds a comma, a quote or a line break (RFC 4180).
fn csv_field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::{Format, csv_field, csv_number};
    use std::path::Path;

    #[test]
    fn fields_are_quoted_where_they_must() {
        assert_eq!(csv_field("link.base.x[m]"), "link.base.x[m]");
        assert_eq!(csv_field("a,\"b\""), "\"a,\"\"b\"\"\"");
    }

    #[test]
    fn numbers_read_back() {
        for value in [0.1, -3.0e-300, 1e21, f64::MIN_POSITIVE, 0.1 + 0.2, -0.0] {
            assert_eq!(csv_number(value).parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
        assert!(csv_number(1e-300).len() < 10);
        assert!(csv_number(f64::NAN).parse::<f64>().unwrap().is_nan());
        assert_eq!(csv_number(f64::NEG_INFINITY), "-inf");
    }

    #[test]
    fn names_tell_formats() {
        assert_eq!(Format::of(Path::new("a.b/out.CSV")), Some(Format::Csv));
        assert_eq!(Format::of(Path::new("out.jsonl")), Some(Format::JsonLines));
        assert_eq!(Format::of(Path::new("out.csv.gz")), None);
        assert_eq!(Format::of(Path::new("csv")), None);
    }
}
