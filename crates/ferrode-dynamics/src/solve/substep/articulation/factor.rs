//! The factor of an articulation's matrix: K = L Lᵀ in blocks, for articulations of one shape side by side.

use super::shape::Shape;
use ferrode_math::simd::Lanes;

/// The factor, and the sizes of its blocks.
#[derive(Clone, Debug)]
pub(super) struct Factor<L> {
    /// Rows of each joint, in the order of elimination, and where they begin.
    sizes: Vec<u32>,
    pub offsets: Vec<u32>,
    /// Where each block begins: those on the diagonal, then those below, each by its rows.
    starts: Vec<u32>,
    values: Vec<L>,
    /// Inverses of the diagonal.
    inverses: Vec<L>,
}

impl<L> Default for Factor<L> {
    fn default() -> Self {
        Self {
            sizes: Vec::new(),
            offsets: Vec::new(),
            starts: Vec::new(),
            values: Vec::new(),
            inverses: Vec::new(),
        }
    }
}

impl<L: Lanes> Factor<L> {
    /// Sizes the blocks.
    pub fn reset(&mut self, shape: &Shape, sizes: impl Iterator<Item = u32>) {
        self.sizes.clear();
        self.sizes.extend(sizes);
        self.offsets.clear();
        let mut sum = 0;
        self.offsets.push(0);
        for size in &self.sizes {
            sum += size;
            self.offsets.push(sum);
        }
        self.starts.clear();
        let mut at = 0;
        for size in &self.sizes {
            self.starts.push(at);
            at += size * size;
        }
        for column in 0..self.sizes.len() {
            for row in &shape.rows[shape.start[column] as usize..shape.start[column + 1] as usize] {
                self.starts.push(at);
                at += self.sizes[*row as usize] * self.sizes[column];
            }
        }
        self.values.resize(at as usize, L::ZERO);
        self.inverses.resize(sum as usize, L::ZERO);
    }

    /// Sets K to zero.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.values.fill(L::ZERO);
    }

    /// A block, by its rows.
    #[inline(always)]
    pub fn block(&mut self, number: u32, len: usize) -> &mut [L] {
        &mut self.values[self.starts[number as usize] as usize..][..len]
    }

    /// Number of rows of a joint.
    #[inline(always)]
    pub fn size(&self, joint: usize) -> usize {
        self.sizes[joint] as usize
    }

    /// K = L Lᵀ, in place. A row that nothing moves has a zero pivot, and no part in the inverse.
    #[inline(always)]
    pub fn factorise(&mut self, shape: &Shape) {
        let n = self.sizes.len();
        for c in 0..n {
            let size = self.size(c);
            let range = shape.start[c] as usize..shape.start[c + 1] as usize;
            let inverse = &mut self.inverses[self.offsets[c] as usize..][..size];
            let own = self.starts[c] as usize;
            if range.is_empty() {
                cholesky(&mut self.values[own..][..size * size], inverse, size);
                continue;
            }
            // The blocks below a column's diagonal lie behind all of these.
            let (head, tail) = self.values.split_at_mut(self.starts[n] as usize);
            let diagonal = &mut head[own..][..size * size];
            cholesky(diagonal, inverse, size);
            for block in range {
                let rows = self.sizes[shape.rows[block] as usize] as usize;
                let start = (self.starts[n + block] - self.starts[n]) as usize;
                solve_right(&mut tail[start..][..rows * size], diagonal, inverse, size);
            }
            for update in &shape.updates[shape.update_start[c] as usize..shape.update_start[c + 1] as usize] {
                let height = |block: u32| self.sizes[shape.rows[block as usize - n] as usize] as usize;
                let (rows, columns) = (height(update.a), height(update.b));
                let target = self.starts[update.target as usize] as usize;
                let (a, b) =
                    (self.starts[update.a as usize] as usize, self.starts[update.b as usize] as usize);
                if (update.target as usize) < n {
                    let (head, tail) = self.values.split_at_mut(self.starts[n] as usize);
                    let tail_a = &tail[a - self.starts[n] as usize..][..rows * size];
                    subtract_lower(&mut head[target..][..rows * rows], tail_a, rows, size);
                } else {
                    // What a column changes lies behind its own blocks.
                    let (head, tail) = self.values.split_at_mut(target);
                    subtract(
                        &mut tail[..rows * columns],
                        &head[a..][..rows * size],
                        &head[b..][..columns * size],
                        size,
                    );
                }
            }
        }
    }

    /// x = K⁻¹ x.
    #[inline(always)]
    pub fn solve(&self, shape: &Shape, x: &mut [L]) {
        let n = self.sizes.len();
        for c in 0..n {
            let size = self.size(c);
            let at = self.offsets[c] as usize;
            let (head, tail) = x.split_at_mut(at + size);
            let own = &mut head[at..];
            let l = &self.values[self.starts[c] as usize..][..size * size];
            let inverse = &self.inverses[at..][..size];
            for i in 0..size {
                let mut sum = own[i];
                for (l, y) in l[i * size..][..i].iter().zip(&own[..i]) {
                    sum -= *l * *y;
                }
                own[i] = without_trifles(sum * inverse[i]);
            }
            for block in shape.start[c] as usize..shape.start[c + 1] as usize {
                let row = shape.rows[block] as usize;
                let target = &mut tail[self.offsets[row] as usize - at - size..][..self.size(row)];
                let values = &self.values[self.starts[n + block] as usize..][..target.len() * size];
                for (t, row) in target.iter_mut().zip(values.chunks_exact(size.max(1))) {
                    for (v, y) in row.iter().zip(own.iter()) {
                        *t -= *v * *y;
                    }
                }
            }
        }
        for c in (0..n).rev() {
            let size = self.size(c);
            let at = self.offsets[c] as usize;
            let (head, tail) = x.split_at_mut(at + size);
            let own = &mut head[at..];
            for block in shape.start[c] as usize..shape.start[c + 1] as usize {
                let row = shape.rows[block] as usize;
                let source = &tail[self.offsets[row] as usize - at - size..][..self.size(row)];
                let values = &self.values[self.starts[n + block] as usize..][..source.len() * size];
                for (s, row) in source.iter().zip(values.chunks_exact(size.max(1))) {
                    for (v, y) in row.iter().zip(own.iter_mut()) {
                        *y -= *v * *s;
                    }
                }
            }
            let l = &self.values[self.starts[c] as usize..][..size * size];
            let inverse = &self.inverses[at..][..size];
            for i in (0..size).rev() {
                let y = without_trifles(own[i] * inverse[i]);
                own[i] = y;
                for (l, o) in l[i * size..][..i].iter().zip(own[..i].iter_mut()) {
                    *o -= *l * y;
                }
            }
        }
    }
}

/// Rounds numbers below 1e-33 to zero. Down a long chain, impulses fade to numbers that processors take a hundred times as long to
/// compute with.
#[inline(always)]
fn without_trifles<L: Lanes>(x: L) -> L {
    let k = L::splat(1e-26);
    x + k - k
}

/// h = L Lᵀ in place, by rows of the lower triangle, with the inverses of the diagonal.
#[inline(always)]
fn cholesky<L: Lanes>(h: &mut [L], inverse: &mut [L], n: usize) {
    let (h, inverse) = (&mut h[..n * n], &mut inverse[..n]);
    for i in 0..n {
        for j in 0..=i {
            let mut sum = h[i * n + j];
            for k in 0..j {
                sum -= h[i * n + k] * h[j * n + k];
            }
            if i == j {
                inverse[i] = L::select(L::ZERO.lt(sum), L::ONE / sum.sqrt(), L::ZERO);
            } else {
                h[i * n + j] = sum * inverse[j];
            }
        }
    }
}

/// x = x L⁻ᵀ.
#[inline(always)]
fn solve_right<L: Lanes>(x: &mut [L], l: &[L], inverse: &[L], n: usize) {
    let (l, inverse) = (&l[..n * n], &inverse[..n]);
    for row in x.chunks_exact_mut(n.max(1)) {
        for j in 0..n {
            let mut sum = row[j];
            for k in 0..j {
                sum -= row[k] * l[j * n + k];
            }
            row[j] = sum * inverse[j];
        }
    }
}

/// t -= a bᵀ; a and b have n columns.
#[inline(always)]
fn subtract<L: Lanes>(t: &mut [L], a: &[L], b: &[L], n: usize) {
    if n == 0 {
        return;
    }
    let columns = b.len() / n;
    for (t, a) in t.chunks_exact_mut(columns.max(1)).zip(a.chunks_exact(n)) {
        for (t, b) in t.iter_mut().zip(b.chunks_exact(n)) {
            let mut sum = L::ZERO;
            for (x, y) in a.iter().zip(b) {
                sum += *x * *y;
            }
            *t -= sum;
        }
    }
}

/// The lower triangle of t -= a aᵀ.
#[inline(always)]
fn subtract_lower<L: Lanes>(t: &mut [L], a: &[L], rows: usize, n: usize) {
    if n == 0 {
        return;
    }
    for i in 0..rows {
        for j in 0..=i {
            let mut sum = L::ZERO;
            for (x, y) in a[i * n..][..n].iter().zip(&a[j * n..][..n]) {
                sum += *x * *y;
            }
            t[i * rows + j] -= sum;
        }
    }
}
