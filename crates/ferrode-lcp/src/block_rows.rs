//! A symmetric sparse matrix in rows of 4 x 4 blocks.
//!
//! Two constraints have a nonzero product in `A = J M^-1 J^T` only if they share a body, so most of the dense matrix that a
//! big-matrix solver is given is zero, in large areas. This copy keeps the blocks that hold anything, both triangles, so
//! that a row of it times a vector costs as much as the row holds, reads memory in order and needs no gathering.
//! Leaving zeros out of a sum does not change it.
//!
//! The rows of one block row are stored one after the other, each with all its blocks in order of column.

use crate::kernel::sum4;

#[derive(Debug, Default, Clone)]
pub(crate) struct BlockRows {
    /// Where the blocks of each block row start, in blocks; one more entry than block rows.
    start: Vec<usize>,
    /// The block column of each block.
    column: Vec<u32>,
    /// Four numbers per block and row.
    value: Vec<[f64; 4]>,
    /// The diagonal.
    diagonal: Vec<f64>,
    /// Scratch: what the blocks of a row hold; the blocks of the lower triangle, row by row, and where each row's list ends.
    held: Vec<u64>,
    lower: Vec<u32>,
    lower_end: Vec<usize>,
    cursor: Vec<usize>,
}

impl BlockRows {
    /// Takes a copy of the symmetric matrix whose lower triangle is in `a`; `first` holds, if given, the first column of each
    /// row that is to be read. The caller has checked sizes.
    pub fn assign(&mut self, a: &[f64], n: usize, stride: usize, first: Option<&[u32]>) {
        let first = |row: usize| first.map_or(0, |first| first[row] as usize);
        let blocks = n.div_ceil(4);
        self.lower.clear();
        self.lower_end.clear();
        self.start.clear();
        self.start.resize(blocks + 1, 0);
        for i in 0..blocks {
            // Look at row after row, as they lie in memory.
            self.held.clear();
            self.held.resize(i, 0);
            for r in 4 * i..n.min(4 * i + 4) {
                mark_held(&a[r * stride..][..4 * i], first(r).min(4 * i), &mut self.held);
            }
            // The sign bit is left out: minus zero is zero. The diagonal block is always kept.
            for j in (0..i).filter(|&j| self.held[j] << 1 != 0).chain([i]) {
                self.lower.push(j as u32);
                self.start[i + 1] += 1;
                if i != j {
                    self.start[j + 1] += 1;
                }
            }
            self.lower_end.push(self.lower.len());
        }
        for i in 0..blocks {
            self.start[i + 1] += self.start[i];
        }
        let total = self.start[blocks];
        self.column.clear();
        self.column.resize(total, 0);
        self.value.clear();
        self.value.resize(4 * total, [0.0; 4]);
        self.cursor.clear();
        self.cursor.extend_from_slice(&self.start[..blocks]);
        let mut at = 0;
        for i in 0..blocks {
            // Lower blocks of row i are met before the mirrored ones, so the columns of a row come out in order.
            for &j in &self.lower[at..self.lower_end[i]] {
                let j = j as usize;
                let here = take(&mut self.cursor[i]);
                self.column[here] = j as u32;
                let there = if i == j { here } else { take(&mut self.cursor[j]) };
                self.column[there] = i as u32;
                let (row_i, width_i) = (self.start[i], self.start[i + 1] - self.start[i]);
                let (row_j, width_j) = (self.start[j], self.start[j + 1] - self.start[j]);
                for r in 0..(n - 4 * i).min(4) {
                    for c in 0..4 {
                        if 4 * j + c > 4 * i + r {
                            break;
                        }
                        if 4 * j + c < first(4 * i + r) {
                            continue;
                        }
                        let v = a[(4 * i + r) * stride + 4 * j + c];
                        self.value[4 * row_i + r * width_i + (here - row_i)][c] = v;
                        self.value[4 * row_j + c * width_j + (there - row_j)][r] = v;
                    }
                }
            }
            at = self.lower_end[i];
        }
        self.diagonal.clear();
        self.diagonal.extend((0..n).map(|i| a[i * stride + i]));
    }

    /// The entry (k, k).
    pub fn diagonal(&self, k: usize) -> f64 {
        self.diagonal[k]
    }

    /// The blocks of row k: their block columns, and four entries each.
    fn row(&self, k: usize) -> (&[u32], &[[f64; 4]]) {
        let (from, to) = (self.start[k / 4], self.start[k / 4 + 1]);
        let width = to - from;
        (&self.column[from..to], &self.value[4 * from + (k % 4) * width..][..width])
    }

    /// Row k times the vector `x`, which is padded to whole blocks.
    #[inline]
    pub fn row_dot(&self, k: usize, x: &[[f64; 4]]) -> f64 {
        let (columns, values) = self.row(k);
        let mut even = [0.0; 4];
        let mut odd = [0.0; 4];
        let (columns_2, columns_rest) = columns.as_chunks::<2>();
        let (values_2, values_rest) = values.as_chunks::<2>();
        for (column, value) in columns_2.iter().zip(values_2) {
            let (x0, x1) = (&x[column[0] as usize], &x[column[1] as usize]);
            for l in 0..4 {
                even[l] += value[0][l] * x0[l];
                odd[l] += value[1][l] * x1[l];
            }
        }
        for (column, value) in columns_rest.iter().zip(values_rest) {
            let x0 = &x[*column as usize];
            for l in 0..4 {
                even[l] += value[l] * x0[l];
            }
        }
        for l in 0..4 {
            even[l] += odd[l];
        }
        sum4(even)
    }

    /// Writes the entries of row k into `out`, the one of column c to the place `place[c]` if that lies in `from..end`.
    /// Returns the smallest place below `end` with a nonzero entry, or `end`.
    pub fn scatter(&self, k: usize, place: &[[u32; 4]], from: usize, end: usize, out: &mut [f64]) -> usize {
        let mut first = end;
        let (columns, values) = self.row(k);
        for (column, value) in columns.iter().zip(values) {
            for (&at, &v) in place[*column as usize].iter().zip(value) {
                let at = at as usize;
                if at < end && v != 0.0 {
                    first = first.min(at);
                    if at >= from {
                        out[at] = v;
                    }
                }
            }
        }
        first
    }
}

/// The value of a counter, which then moves on.
fn take(counter: &mut usize) -> usize {
    *counter += 1;
    *counter - 1
}

/// Gathers the bits of the numbers of a row from column `first` on, block by block. The row ends with a whole block.
fn mark_held(row: &[f64], first: usize, held: &mut [u64]) {
    let whole = first.div_ceil(4);
    for v in &row[first..4 * whole] {
        held[whole - 1] |= v.to_bits();
    }
    for (held, block) in held[whole..].iter_mut().zip(row[4 * whole..].as_chunks::<4>().0) {
        let b = block.map(f64::to_bits);
        *held |= (b[0] | b[1]) | (b[2] | b[3]);
    }
}
