//! A factorisation `L D L^T` that grows and shrinks by one row at a time, and knows where each row begins.
//!
//! Row k of `L` starts at its first nonzero column, its "envelope": elimination fills a row only to the right of its first
//! nonzero entry, so what lies to the left stays zero and is neither stored nor multiplied. (A. Jennings, "A compact storage
//! scheme for the solution of symmetric linear simultaneous equations", 1966.) A chain of joints in its natural order gives
//! short rows, and factoring it costs `O(n)` instead of `O(n^3)`; for a full matrix nothing is lost.
//!
//! Appending a row to `L` takes one forward solve, `O(n^2)`; taking row r out is a rank-one update of the rows below
//! it (see [`crate::ldlt`]), `O(n^2)` too, and cannot break an envelope. `d` holds the reciprocals of `D`.

use crate::kernel::{dot, dot_2x2, sub_scaled, sub_scaled_2};
use crate::ldlt::scale_row;

#[derive(Debug, Default, Clone)]
pub(crate) struct EnvelopeFactor {
    /// Where each row begins in `entries`; increasing.
    start: Vec<usize>,
    /// The first column that each row stores.
    first: Vec<usize>,
    /// The reciprocals of the pivots.
    d: Vec<f64>,
    /// The rows, with gaps where rows were taken out or became shorter.
    entries: Vec<f64>,
    /// The end of the last row in `entries`.
    used: usize,
    /// Rows whose pivot vanished and that were left out of the solution (`d` = 0).
    dropped: usize,
    // Scratch of the blocked factorisation and of the rank-one update.
    row_0: Vec<f64>,
    row_1: Vec<f64>,
    column: Vec<f64>,
    step: Vec<[f64; 2]>,
}

impl EnvelopeFactor {
    /// Forgets all rows, keeps the memory.
    pub fn clear(&mut self) {
        self.start.clear();
        self.first.clear();
        self.d.clear();
        self.used = 0;
        self.dropped = 0;
    }

    /// The number of rows.
    pub fn len(&self) -> usize {
        self.d.len()
    }

    /// How many rows were left out because their pivot vanished.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Row k of `L`, from column `first[k]` up to the diagonal (not included).
    #[inline(always)]
    fn row(&self, k: usize) -> &[f64] {
        &self.entries[self.start[k]..][..k - self.first[k]]
    }

    /// Factors an `n` x `n` matrix from scratch. `fill(k, row)` writes the nonzero entries of row k left of the diagonal into `row`
    /// (all zero before) and returns the first column with one (k if there is none) and the diagonal.
    ///
    /// Two rows are made at a time against two finished ones, so that each number loaded serves two products; pairs
    /// share one envelope for that.
    pub fn factor(&mut self, n: usize, mut fill: impl FnMut(usize, &mut [f64]) -> (usize, f64)) {
        self.clear();
        let mut y0 = std::mem::take(&mut self.row_0);
        let mut y1 = std::mem::take(&mut self.row_1);
        y0.clear();
        y1.clear();
        y0.resize(n, 0.0);
        y1.resize(n, 0.0);
        for k in (0..n).step_by(2) {
            let second = k + 1 < n;
            let (first_0, diagonal_0) = fill(k, &mut y0);
            let (first_1, diagonal_1) = if second { fill(k + 1, &mut y1) } else { (k, 0.0) };
            let first = first_0.min(first_1).min(k) & !1;
            for j in (first..k).step_by(2) {
                // Rows j and j + 1 are a pair: one envelope.
                let from = self.first[j].max(first);
                let l0 = &self.row(j)[from - self.first[j]..];
                let (l1, last) = self.row(j + 1)[from - self.first[j]..].split_at(j - from);
                let s = dot_2x2(&y0[from..j], &y1[from..j], l0, l1);
                y0[j] -= s[0];
                y0[j + 1] -= s[1] + last[0] * y0[j];
                y1[j] -= s[2];
                y1[j + 1] -= s[3] + last[0] * y1[j];
            }
            let sum = scale_row(&mut y0[first..k], &self.d[first..k]);
            self.push(&y0[first..k], first, diagonal_0, sum);
            if second {
                y1[k] -= dot(&y1[first..k], &y0[first..k]);
                let sum = scale_row(&mut y1[first..=k], &self.d[first..=k]);
                self.push(&y1[first..=k], first, diagonal_1, sum);
                y1[first..=k].fill(0.0);
            }
            y0[first..k].fill(0.0);
        }
        self.row_0 = y0;
        self.row_1 = y1;
    }

    /// Continues the forward solve `L y = a` in place. `y[..from]` is solved already, `y[from..]` holds `a`,
    /// and everything before `first` is zero.
    pub fn forward(&self, y: &mut [f64], from: usize, first: usize) {
        for j in from.max(first)..self.len() {
            let begin = self.first[j].max(first);
            let row = &self.row(j)[begin - self.first[j]..];
            y[j] -= dot(row, &y[begin..j]);
        }
    }

    /// Solves `D L^T x = y` in place.
    pub fn backward(&self, y: &mut [f64]) {
        let n = self.len();
        for (y, d) in y.iter_mut().zip(&self.d) {
            *y *= d;
        }
        let mut k = n;
        // Two rows at a time over the columns that both have.
        while k >= 2 {
            let (f1, f0) = (self.first[k - 1], self.first[k - 2]);
            let (row_1, row_0) = (self.row(k - 1), self.row(k - 2));
            let x1 = y[k - 1];
            if f1 <= k - 2 {
                y[k - 2] -= x1 * row_1[k - 2 - f1];
            }
            let x0 = y[k - 2];
            let both = f0.max(f1).min(k - 2);
            if f1 < both {
                sub_scaled(&mut y[f1..both], x1, row_1);
            }
            if f0 < both {
                sub_scaled(&mut y[f0..both], x0, row_0);
            }
            if both < k - 2 {
                sub_scaled_2(&mut y[both..k - 2], x1, &row_1[both - f1..], x0, &row_0[both - f0..]);
            }
            k -= 2;
        }
    }

    /// Appends a row: `y` is the forward solution for its column, zero before `first`, `diagonal` its diagonal entry.
    pub fn append(&mut self, y: &[f64], first: usize, diagonal: f64) {
        let n = self.len();
        let mut row = std::mem::take(&mut self.row_0);
        row.clear();
        row.extend_from_slice(&y[first..n]);
        let sum = scale_row(&mut row, &self.d[first..]);
        self.push(&row, first, diagonal, sum);
        self.row_0 = row;
    }

    /// Stores a finished row and its pivot `diagonal - sum`. A pivot of exactly zero is made the smallest that rounding could have
    /// hidden. If even that has no finite reciprocal, the row is empty; it is left out (its unknown becomes 0).
    fn push(&mut self, row: &[f64], first: usize, diagonal: f64, sum: f64) {
        if self.used + row.len() > self.entries.len() {
            self.make_room(row.len());
        }
        self.entries[self.used..][..row.len()].copy_from_slice(row);
        self.start.push(self.used);
        self.first.push(first);
        self.used += row.len();
        let mut pivot = diagonal - sum;
        if pivot == 0.0 {
            pivot = diagonal.next_up() - sum;
        }
        let mut reciprocal = 1.0 / pivot;
        if reciprocal.is_infinite() {
            reciprocal = 0.0;
            self.dropped += 1;
        }
        self.d.push(reciprocal);
    }

    /// Closes the gaps between rows; takes more memory if that does not leave a good part of it free.
    fn make_room(&mut self, extra: usize) {
        let mut to = 0;
        for k in 0..self.len() {
            let (from, len) = (self.start[k], k - self.first[k]);
            self.entries.copy_within(from..from + len, to);
            self.start[k] = to;
            to += len;
        }
        self.used = to;
        let need = to + extra;
        if need + need / 2 > self.entries.len() {
            self.entries.resize((2 * need).max(256), 0.0);
        }
    }

    /// Takes row and column r out.
    pub fn remove(&mut self, r: usize) {
        let n = self.len();
        let pivot = self.d[r];
        self.column.clear();
        self.column.resize(n, 0.0);
        for k in r + 1..n {
            let first = self.first[k];
            if first <= r {
                let row = &mut self.entries[self.start[k]..][..k - first];
                self.column[k - 1] = row[r - first];
                row.copy_within(r + 1 - first.., r - first);
            } else {
                self.first[k] = first - 1;
            }
        }
        if r + 1 == n {
            self.used = self.start[r];
        }
        self.start.remove(r);
        self.first.remove(r);
        self.d.remove(r);
        if pivot != 0.0 {
            self.add_rank_one(r, n - 1, 1.0 / pivot);
        }
    }

    /// Updates the rows `r..n` for the addition of `alpha z z^T`, `z` in `column[r..n]`: the recurrences of
    /// [`crate::ldlt`], row by row, two rows in step because each is a chain of dependent operations.
    fn add_rank_one(&mut self, r: usize, n: usize, mut alpha: f64) {
        let Self { start, first, d, entries, column: z, step, .. } = self;
        step.clear();
        step.resize(n, [0.0; 2]);
        // Columns before the first with z_j != 0 change nothing.
        let mut lead = r;
        while lead < n && z[lead] == 0.0 {
            lead += 1;
        }
        let mut finish = |k: usize, z: f64, step: &mut [[f64; 2]], d: &mut [f64]| {
            if z != 0.0 {
                let grown = 1.0 + alpha * z * z * d[k];
                d[k] /= grown;
                step[k] = [z, alpha * z * d[k]];
                alpha /= grown;
            }
        };
        let mut k = lead;
        while k < n {
            let begin_0 = lead.max(first[k]).min(k);
            if k + 1 == n {
                let row = &mut entries[start[k] + begin_0 - first[k]..][..k - begin_0];
                let z0 = carry(row, &step[begin_0..k], z[k]);
                finish(k, z0, step, d);
                break;
            }
            let begin_1 = lead.max(first[k + 1]).min(k + 1);
            let (head, tail) = entries.split_at_mut(start[k + 1]);
            let row_0 = &mut head[start[k] + begin_0 - first[k]..][..k - begin_0];
            let row_1 = &mut tail[begin_1 - first[k + 1]..][..k + 1 - begin_1];
            let both = begin_0.max(begin_1).min(k);
            let (alone_0, row_0) = row_0.split_at_mut(both - begin_0);
            let (alone_1, row_1) = row_1.split_at_mut(both.saturating_sub(begin_1));
            let mut z0 = carry(alone_0, &step[begin_0..both], z[k]);
            let mut z1 = carry(alone_1, &step[begin_1.min(both)..both], z[k + 1]);
            for ((l0, l1), [p, beta]) in row_0.iter_mut().zip(row_1.iter_mut()).zip(&step[both..k]) {
                z0 -= p * *l0;
                z1 -= p * *l1;
                *l0 += beta * z0;
                *l1 += beta * z1;
            }
            finish(k, z0, step, d);
            if begin_1 <= k {
                z1 = carry(&mut row_1[k - both..], &step[k..=k], z1);
            }
            finish(k + 1, z1, step, d);
            k += 2;
        }
    }
}

/// Carries `z` of one row through a stretch of its columns; returns what is left of it.
fn carry(row: &mut [f64], step: &[[f64; 2]], mut z: f64) -> f64 {
    for (l, [p, beta]) in row.iter_mut().zip(step) {
        z -= p * *l;
        *l += beta * z;
    }
    z
}
