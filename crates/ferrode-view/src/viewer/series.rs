//! Values over time, for plots and files.

use crate::viewer::playback::Playback;
use std::collections::VecDeque;
use std::path::Path;

pub use super::quantity::Quantity;

/// Values over time: the last of them.
#[derive(Clone, Debug)]
pub struct Series {
    quantities: Vec<Quantity>,
    times: VecDeque<f64>,
    /// By time, then by quantity.
    rows: VecDeque<Vec<f64>>,
}

/// As many rows are kept.
const MOST: usize = 4000;

impl Default for Series {
    fn default() -> Self {
        Self { quantities: Quantity::ALWAYS.to_vec(), times: VecDeque::new(), rows: VecDeque::new() }
    }
}

impl Series {
    /// What is recorded.
    pub fn quantities(&self) -> &[Quantity] {
        &self.quantities
    }

    /// Records one more quantity from now on.
    pub fn add(&mut self, quantity: Quantity) {
        if !self.quantities.contains(&quantity) {
            self.quantities.push(quantity);
        }
    }

    /// Records one less.
    pub fn remove(&mut self, quantity: Quantity) {
        if let Some(at) = self.quantities.iter().position(|known| *known == quantity) {
            self.quantities.remove(at);
            for row in self.rows.iter_mut().filter(|row| row.len() > at) {
                row.remove(at);
            }
        }
    }

    /// Records the present values. What was recorded of a later time is forgotten: time was wound back.
    pub fn record(&mut self, playback: &Playback) {
        let time = playback.time();
        while self.times.back().is_some_and(|last| *last >= time) {
            self.times.pop_back();
            self.rows.pop_back();
        }
        if self.times.len() >= MOST {
            self.times.pop_front();
            self.rows.pop_front();
        }
        self.times.push_back(time);
        self.rows.push_back(self.quantities.iter().map(|quantity| quantity.value(playback)).collect());
    }

    /// Forgets all values.
    pub fn clear(&mut self) {
        self.times.clear();
        self.rows.clear();
    }

    /// Number of recorded times.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether nothing was recorded yet.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Times and values of a quantity, where it has any.
    pub fn points(&self, quantity: Quantity) -> impl Iterator<Item = [f64; 2]> + '_ {
        let at = self.quantities.iter().position(|known| *known == quantity).unwrap_or(usize::MAX);
        let rows = self.times.iter().zip(&self.rows);
        rows.filter_map(move |(time, row)| Some([*time, *row.get(at)?])).filter(|point| point[1].is_finite())
    }

    /// Writes all as comma-separated values.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn save_csv(&self, path: &Path, playback: &Playback) -> Result<(), String> {
        use std::fmt::Write;
        let quoted = |name: String| {
            if name.contains([',', '"']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name }
        };
        let mut text = String::from("time[s]");
        for quantity in &self.quantities {
            let _ = write!(text, ",{}", quoted(quantity.name(playback)));
        }
        for (time, row) in self.times.iter().zip(&self.rows) {
            let _ = write!(text, "\n{time}");
            for at in 0..self.quantities.len() {
                let _ = write!(text, ",{}", row.get(at).copied().unwrap_or(f64::NAN));
            }
        }
        text.push('\n');
        std::fs::write(path, text).map_err(|error| format!("cannot write {}: {error}", path.display()))
    }
}
