//! The answer of a set of free rows: solved for afresh, and refined in the whole system.

use super::blocks::{add_and_dot, add_blocks, dot_blocks, largest};
use super::{CondensedWorkspace, FINE, MOST_CORRECTIONS, SINGULAR, refill, width};
use crate::kernel::{self, dot};
use crate::problem::BoxedLcp;
use crate::residual::row_residual;
use ferrode_math::simd::Quad;

impl CondensedWorkspace {
    /// Solves from scratch for the rows that are free, with the others at their bounds. `None` if a pivot vanishes.
    #[inline(always)]
    pub(super) fn solve_set<Q: Quad>(&mut self, n: usize, u: usize) -> Option<()> {
        let stride = 4 * width(n);
        let Self { tableau, free, triangle, pivots, y, v, m, d, scale, x, place, .. } = self;
        refill(v, width(n), [0.0; 4]);
        let forces = v.as_flattened_mut();
        let numbers = m.as_flattened();
        free.clear();
        for (at, place) in tableau.rows.iter().enumerate() {
            if place.is_free() {
                free.push((u + at) as u32);
            }
            forces[u + at] = place.bound();
        }
        // Entries of a symmetric matrix whose upper triangle there is.
        let entry = |a: usize, b: usize| numbers[a.min(b) * stride + a.max(b)];
        y.clear();
        y.extend(free.iter().map(|at| numbers[*at as usize * stride + n]));
        for (at, bound) in forces.iter().enumerate().take(n).skip(u) {
            if *bound != 0.0 {
                for (y, free) in y.iter_mut().zip(free.iter()) {
                    *y -= entry(*free as usize, at) * bound;
                }
            }
        }
        // L D L^T with unit diagonal, row by row; `pivots` the reciprocals of D.
        let f = free.len();
        if triangle.len() < f * f {
            triangle.resize(f * f, 0.0);
        }
        pivots.clear();
        for (i, at) in free.iter().enumerate() {
            let at = *at as usize;
            let (above, own) = triangle.split_at_mut(i * f);
            let own = &mut own[..i];
            for (own, c) in own.iter_mut().zip(free.iter()) {
                *own = numbers[*c as usize * stride + at];
            }
            for j in 1..i {
                own[j] -= dot(&own[..j], &above[j * f..][..j]);
            }
            let mut pivot = numbers[at * stride + at];
            for (l, d) in own.iter_mut().zip(pivots.iter()) {
                let scaled = *l * d;
                pivot -= *l * scaled;
                *l = scaled;
            }
            if pivot.is_nan() || pivot <= SINGULAR * scale[at] {
                return None;
            }
            pivots.push(1.0 / pivot);
        }
        solve_free(triangle, pivots, y);
        for (at, y) in free.iter().zip(y.iter()) {
            forces[*at as usize] = *y;
        }
        for (j, force) in forces[..u].iter_mut().enumerate() {
            *force = numbers[j * stride + n];
        }
        substitute_back::<Q>(m, d, v);
        refill(x, stride, 0.0);
        let forces = v.as_flattened();
        for (x, at) in x.iter_mut().zip(place.iter()) {
            *x = forces[*at as usize];
        }
        Some(())
    }

    /// Refines the answer of a set in the whole system. Returns its natural residual and the largest force.
    #[inline(always)]
    pub(super) fn polish<Q: Quad>(&mut self, p: &BoxedLcp<'_>, u: usize) -> (f64, f64) {
        self.note_tight_rows(u);
        self.slack::<Q>(p);
        for _ in 0..MOST_CORRECTIONS {
            let force = largest(self.x.as_chunks().0.iter().copied());
            let slacks = self.w.as_chunks::<4>().0.iter().zip(self.tight.as_chunks::<4>().0);
            let error = largest(
                slacks.map(|(w, tight)| [w[0] / tight[0], w[1] / tight[1], w[2] / tight[2], w[3] / tight[3]]),
            );
            if error <= FINE * (1.0 + force) || error.is_nan() {
                break;
            }
            self.correct::<Q>(u);
            self.slack::<Q>(p);
        }
        // Forces that rounding left outside their bounds.
        let mut clamped = false;
        for ((x, lo), hi) in self.x.iter_mut().zip(&self.lo).zip(&self.hi) {
            let inside = if *x < *lo { *lo } else { *x };
            let inside = if inside > *hi { *hi } else { inside };
            clamped |= inside != *x;
            *x = inside;
        }
        if clamped {
            self.slack::<Q>(p);
        }
        let Self { x, w, diagonal, lo, hi, .. } = self;
        let (x, w, diagonal) = (x.as_chunks::<4>().0, w.as_chunks::<4>().0, diagonal.as_chunks::<4>().0);
        let (lo, hi) = (lo.as_chunks::<4>().0, hi.as_chunks::<4>().0);
        let residuals = (0..x.len()).map(|i| {
            let of = |l: usize| row_residual(x[i][l], w[i][l], diagonal[i][l], lo[i][l], hi[i][l]);
            [of(0), of(1), of(2), of(3)]
        });
        (largest(residuals), largest(x.iter().copied()))
    }

    /// Notes which rows are to have no slack.
    #[inline(always)]
    fn note_tight_rows(&mut self, u: usize) {
        let Self { tight, diagonal, order, tableau, .. } = self;
        tight.clear();
        tight.extend_from_slice(diagonal);
        for (row, place) in order[u..].iter().zip(&tableau.rows) {
            if !place.is_free() {
                tight[*row as usize] = f64::INFINITY;
            }
        }
    }

    /// Solves for what is left of the slacks, and adds that to the forces.
    #[inline(always)]
    fn correct<Q: Quad>(&mut self, u: usize) {
        let Self { free, triangle, pivots, y, v, x, w, m, d, place, .. } = self;
        let width = v.len();
        v.fill([0.0; 4]);
        for (w, at) in w.iter().zip(place.iter()) {
            v.as_flattened_mut()[*at as usize] = -w;
        }
        for (j, d) in d.iter().enumerate() {
            let (own, row) = (j / 4, &m[j * width..][..width]);
            let s = v[own][j & 3] * d;
            for l in (j & 3) + 1..4 {
                v[own][l] -= s * row[own][l];
            }
            add_blocks::<Q>(&mut v[own + 1..], -s, &row[own + 1..]);
        }
        let numbers = v.as_flattened_mut();
        y.clear();
        y.extend(free.iter().map(|at| numbers[*at as usize]));
        solve_free(triangle, pivots, y);
        numbers[u..].fill(0.0);
        for (at, y) in free.iter().zip(y.iter()) {
            numbers[*at as usize] = *y;
        }
        substitute_back::<Q>(m, d, v);
        let change = v.as_flattened();
        for (x, at) in x.iter_mut().zip(place.iter()) {
            *x += change[*at as usize];
        }
    }

    /// `w = A x - b`.
    #[inline(always)]
    fn slack<Q: Quad>(&mut self, p: &BoxedLcp<'_>) {
        let Self { x, w, diagonal, .. } = self;
        w.clear();
        w.extend(p.b[..p.n].iter().map(|b| -b));
        w.resize(x.len(), 0.0);
        for r in 0..p.n {
            let first = p.first.map_or(0, |first| first[r] as usize);
            let row = &p.a[r * p.stride..][first..r];
            let s = x[r];
            let sum = add_and_dot::<Q>(&mut w[first..r], s, row, &x[first..r]);
            w[r] += sum + diagonal[r] * s;
        }
    }
}

/// Solves with the rows that were eliminated, `D L^T`, of which `d` has the reciprocals of `D`. `x` holds the right-hand sides of these, and the
/// solution of all others; behind it zeros.
#[inline(always)]
fn substitute_back<Q: Quad>(m: &[[f64; 4]], d: &[f64], x: &mut [[f64; 4]]) {
    let width = x.len();
    for own in (0..d.len().div_ceil(4)).rev() {
        let (head, rest) = x.split_at_mut(own + 1);
        let x = &mut head[own];
        // What lies behind the block first: these four don't wait for each other.
        let end = d.len().min(4 * own + 4);
        for j in 4 * own..end {
            x[j & 3] -= dot_blocks::<Q>(&m[j * width + own + 1..(j + 1) * width], rest);
        }
        for j in (4 * own..end).rev() {
            let row = &m[j * width + own];
            let mut s = x[j & 3];
            for l in (j & 3) + 1..4 {
                s -= row[l] * x[l];
            }
            x[j & 3] = s * d[j];
        }
    }
}

/// Solves with the factor of the free rows: `triangle` has as many columns as there are rows.
#[inline(always)]
fn solve_free(triangle: &[f64], pivots: &[f64], y: &mut [f64]) {
    let f = y.len();
    for i in 1..f {
        y[i] -= dot(&triangle[i * f..][..i], &y[..i]);
    }
    for (y, d) in y.iter_mut().zip(pivots) {
        *y *= d;
    }
    for i in (1..f).rev() {
        let (head, tail) = y.split_at_mut(i);
        kernel::sub_scaled(head, tail[0], &triangle[i * f..][..i]);
    }
}
