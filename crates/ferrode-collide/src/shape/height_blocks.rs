//! The heights of blocks of a field's cells, so that what is above or below all of them need not look at each.

use super::Heightfield;

/// Cells along either side of a block.
pub(super) const BLOCK: usize = 16;

/// Lowest and highest sample of each block of cells.
#[derive(Clone, Debug, Default)]
pub(super) struct HeightBlocks {
    across: usize,
    ranges: Vec<(f64, f64)>,
    /// Of all samples.
    all: (f64, f64),
}

impl HeightBlocks {
    /// Of a field of so many samples.
    pub fn new(columns: usize, rows: usize, heights: &[f64]) -> Self {
        let number = |samples: usize| (samples - 1).div_ceil(BLOCK);
        let (across, along) = (number(columns), number(rows));
        // The samples around the cells of a block. The last cells of a field without end reach to its first samples.
        let samples = |block: usize, count: usize| {
            let end = block * BLOCK + BLOCK;
            let first = (end >= count - 1).then_some(0);
            (block * BLOCK..(end + 1).min(count)).chain(first)
        };
        let mut ranges = Vec::with_capacity(across * along);
        for z in 0..along {
            for x in 0..across {
                let mut range = (f64::INFINITY, f64::NEG_INFINITY);
                for j in samples(z, rows) {
                    for i in samples(x, columns) {
                        let h = heights[i + j * columns];
                        range = (range.0.min(h), range.1.max(h));
                    }
                }
                ranges.push(range);
            }
        }
        let all = |a: (f64, f64), b: &(f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        let all = ranges.iter().fold((f64::INFINITY, f64::NEG_INFINITY), all);
        Self { across, ranges, all }
    }
}

impl Heightfield {
    /// The place of a cell among those of one repetition, along one axis of so many samples.
    fn place(&self, cell: i64, samples: usize) -> usize {
        let last = samples as i64 - 1;
        (if self.is_wrapped() { cell.rem_euclid(last) } else { cell.clamp(0, last - 1) }) as usize
    }

    /// The lowest and the highest sample.
    pub(crate) fn all_heights(&self) -> (f64, f64) {
        self.blocks().all
    }

    /// The lowest and the highest sample of the block that the cell at column `x` and row `z` is in.
    pub(crate) fn block_heights(&self, x: i64, z: i64) -> (f64, f64) {
        let blocks = self.blocks();
        let (x, z) = (self.place(x, self.columns()), self.place(z, self.rows()));
        blocks.ranges[x / BLOCK + z / BLOCK * blocks.across]
    }

    /// Cells from this one to the end of its block along an axis of so many samples, itself included; to the other end if
    /// `back`.
    pub(crate) fn rest_of_block(&self, cell: i64, samples: usize, back: bool) -> i64 {
        let place = self.place(cell, samples);
        let start = place - place % BLOCK;
        (if back { place - start + 1 } else { (start + BLOCK).min(samples - 1) - place }) as i64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_hold_the_corners_of_their_cells() {
        let height = |i: usize| ((i * 7919) % 104_729) as f64;
        for (columns, rows) in [(2, 2), (17, 18), (40, 3), (33, 70)] {
            let heights: Vec<f64> = (0..columns * rows).map(height).collect();
            let field = Heightfield::new(5.0, 5.0, columns, rows, heights, 1.0).unwrap();
            for field in [field.clone(), field.wrapped()] {
                let reach = if field.is_wrapped() { 100 } else { 0 };
                for x in -reach..columns as i64 - 1 + reach {
                    for z in -reach..rows as i64 - 1 + reach {
                        let (low, high) = field.block_heights(x, z);
                        for corner in [(x, z), (x + 1, z), (x, z + 1), (x + 1, z + 1)] {
                            let h = field.height(corner.0, corner.1);
                            assert!(low <= h && h <= high, "{x} {z}");
                        }
                        let (ahead, behind) =
                            (field.rest_of_block(x, columns, false), field.rest_of_block(x, columns, true));
                        assert!(ahead >= 1 && behind >= 1);
                        for other in [x + ahead - 1, x - behind + 1] {
                            assert_eq!(field.block_heights(other, z), (low, high));
                        }
                    }
                }
            }
        }
    }
}
