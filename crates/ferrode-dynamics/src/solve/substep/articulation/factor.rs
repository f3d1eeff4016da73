//! The factor of an articulation's matrix: K = L D Lᵀ in blocks of three by three, for articulations of one shape side by side.

use super::plan::Plan;
use super::triple::without_trifles;
use ferrode_math::simd::Lanes;

/// Three by three, by rows.
pub(super) type Block<L> = [L; 9];

/// Of right sides and impulses, in m/s and N s: parts of 10⁻⁷ of it are rounded away.
pub(super) const TRIFLE: f32 = 1e-13;

/// K, and then its factor. Of a block on the diagonal that holds the inverses of D on its diagonal, and L below.
#[derive(Clone, Debug)]
pub(super) struct Factor<L> {
    pub blocks: Vec<Block<L>>,
    /// The blocks of a column times D.
    column: Vec<Block<L>>,
}

impl<L> Default for Factor<L> {
    fn default() -> Self {
        Self { blocks: Vec::new(), column: Vec::new() }
    }
}

impl<L: Lanes> Factor<L> {
    /// Makes room for K, of which the blocks that fill in are zero.
    #[inline(always)]
    pub fn begin(&mut self, plan: &Plan) {
        self.blocks.resize(plan.nodes() + plan.rows.len(), [L::ZERO; 9]);
        for block in &plan.fill {
            self.blocks[*block as usize] = [L::ZERO; 9];
        }
    }

    /// K = L D Lᵀ, in place. A row that nothing moves has a zero pivot, and no part in the inverse.
    #[inline(always)]
    pub fn factorise(&mut self, plan: &Plan) {
        let n = plan.nodes();
        let Self { blocks, column } = self;
        for c in 0..n {
            let k = blocks[c];
            let unit = (k[0] + k[4] + k[8]) * L::splat(1e-8);
            let pivot = decompose(&k, unit);
            blocks[c] = pivot;
            let (start, end) = (plan.start[c] as usize, plan.start[c + 1] as usize);
            // A column changes blocks on the diagonal, and those of later columns, which lie behind its own.
            let (diagonal, below) = blocks.split_at_mut(n);
            let (below, later) = below.split_at_mut(end);
            let below = &mut below[start..];
            column.resize(below.len().max(column.len()), [L::ZERO; 9]);
            for (block, times_d) in below.iter_mut().zip(column.iter_mut()) {
                solve_right(block, times_d, &pivot, unit);
            }
            for update in &plan.updates[plan.update_start[c] as usize..plan.update_start[c + 1] as usize] {
                let (a, b) = (&column[update.a as usize], &below[update.b as usize]);
                let target = update.target as usize;
                if target < n {
                    subtract_lower(&mut diagonal[target], a, b);
                } else {
                    subtract(&mut later[target - n - end], a, b);
                }
            }
        }
    }

    /// x = K⁻¹ x, of the first N in each place.
    #[inline(always)]
    pub fn solve<const N: usize>(&self, plan: &Plan, x: &mut [[[L; 3]; 2]]) {
        let (n, unit) = (plan.nodes(), L::splat(TRIFLE));
        for c in 0..n {
            let l = &self.blocks[c];
            let mut y = x[c];
            for y in y.iter_mut().take(N) {
                let [a, b, d] = *y;
                let b = b - l[3] * a;
                *y = without_trifles(&[a, b, d - (l[6] * a + l[7] * b)], unit);
            }
            x[c] = y;
            let range = plan.start[c] as usize..plan.start[c + 1] as usize;
            for (m, row) in self.blocks[n + range.start..n + range.end].iter().zip(&plan.rows[range]) {
                for (t, y) in x[*row as usize].iter_mut().zip(&y).take(N) {
                    for i in 0..3 {
                        t[i] -= m[3 * i] * y[0] + m[3 * i + 1] * y[1] + m[3 * i + 2] * y[2];
                    }
                }
            }
        }
        for c in (0..n).rev() {
            let l = &self.blocks[c];
            let mut y = x[c];
            for y in y.iter_mut().take(N) {
                *y = [y[0] * l[0], y[1] * l[4], y[2] * l[8]];
            }
            let range = plan.start[c] as usize..plan.start[c + 1] as usize;
            for (m, row) in self.blocks[n + range.start..n + range.end].iter().zip(&plan.rows[range]) {
                for (y, t) in y.iter_mut().zip(&x[*row as usize]).take(N) {
                    for i in 0..3 {
                        y[i] -= m[i] * t[0] + m[3 + i] * t[1] + m[6 + i] * t[2];
                    }
                }
            }
            for (x, y) in x[c].iter_mut().zip(&y).take(N) {
                let [a, b, d] = without_trifles(y, unit);
                let b = b - l[7] * d;
                *x = [a - (l[3] * b + l[6] * d), b, d];
            }
        }
    }
}

#[inline(always)]
fn inverse<L: Lanes>(x: L) -> L {
    L::select(L::ZERO.lt(x), L::ONE / x, L::ZERO)
}

/// L and D⁻¹ of a block on the diagonal, of which the lower triangle counts.
#[inline(always)]
fn decompose<L: Lanes>(k: &Block<L>, unit: L) -> Block<L> {
    let [k3, k6, k7] = without_trifles(&[k[3], k[6], k[7]], unit);
    let d0 = inverse(k[0]);
    let (l10, l20) = (k3 * d0, k6 * d0);
    let d1 = inverse(k[4] - l10 * k3);
    let t21 = k7 - l20 * k3;
    let l21 = t21 * d1;
    let d2 = inverse(k[8] - (l20 * k6 + l21 * t21));
    [d0, L::ZERO, L::ZERO, l10, d1, L::ZERO, l20, l21, d2]
}

/// x L⁻ᵀ D⁻¹ in place, and that times D.
#[inline(always)]
fn solve_right<L: Lanes>(x: &mut Block<L>, times_d: &mut Block<L>, l: &Block<L>, unit: L) {
    for i in 0..3 {
        let [a, b, c] = without_trifles(&[x[3 * i], x[3 * i + 1], x[3 * i + 2]], unit);
        let b = b - a * l[3];
        let c = c - (a * l[6] + b * l[7]);
        (times_d[3 * i], times_d[3 * i + 1], times_d[3 * i + 2]) = (a, b, c);
        (x[3 * i], x[3 * i + 1], x[3 * i + 2]) = (a * l[0], b * l[4], c * l[8]);
    }
}

/// t -= a bᵀ.
#[inline(always)]
fn subtract<L: Lanes>(t: &mut Block<L>, a: &Block<L>, b: &Block<L>) {
    for i in 0..3 {
        for j in 0..3 {
            t[3 * i + j] -= a[3 * i] * b[3 * j] + a[3 * i + 1] * b[3 * j + 1] + a[3 * i + 2] * b[3 * j + 2];
        }
    }
}

/// The lower triangle of that.
#[inline(always)]
fn subtract_lower<L: Lanes>(t: &mut Block<L>, a: &Block<L>, b: &Block<L>) {
    for i in 0..3 {
        for j in 0..=i {
            t[3 * i + j] -= a[3 * i] * b[3 * j] + a[3 * i + 1] * b[3 * j + 1] + a[3 * i + 2] * b[3 * j + 2];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arena::NIL;
    use crate::solve::substep::articulation::shape::Shape;
    use ferrode_math::simd::{Kernel, Level, dispatch_at};

    /// Solves with a matrix that has the plan's blocks, and gives the largest part of the right side that is left.
    struct Solve<'a>(&'a Plan);

    impl Kernel for Solve<'_> {
        type Out = f32;

        fn run<L: Lanes>(self) -> f32 {
            let (plan, n) = (self.0, self.0.nodes());
            let mut state = 1u32;
            let mut number = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                L::splat((state >> 8) as f32 / 16_777_216.0 - 0.5)
            };
            let mut factor = Factor::default();
            factor.begin(plan);
            let mut dense = vec![vec![L::ZERO; 3 * n]; 3 * n];
            let mut places: Vec<(usize, usize, usize)> = (0..n).map(|c| (c, c, c)).collect();
            for c in 0..n {
                for k in plan.start[c] as usize..plan.start[c + 1] as usize {
                    places.push((n + k, plan.rows[k] as usize, c));
                }
            }
            for (block, row, column) in places {
                for i in 0..3 {
                    for j in 0..3 {
                        if row == column && j > i {
                            continue;
                        }
                        // Diagonally dominant.
                        let x = if row == column && i == j { number() + L::splat(40.0) } else { number() };
                        factor.blocks[block][3 * i + j] = x;
                        dense[3 * row + i][3 * column + j] = x;
                        dense[3 * column + j][3 * row + i] = x;
                    }
                }
            }
            let wanted: Vec<[L; 3]> = (0..n).map(|_| [number(), number(), number()]).collect();
            let mut x: Vec<[[L; 3]; 2]> =
                wanted.iter().map(|x| [*x, x.map(|x| x * L::splat(-2.0))]).collect();
            factor.factorise(plan);
            factor.solve::<2>(plan, &mut x);
            let x: Vec<[L; 3]> = x
                .iter()
                .map(|x| [0, 1, 2].map(|k| L::splat(0.5) * (x[0][k] - L::splat(0.5) * x[1][k])))
                .collect();
            let mut worst = 0.0f32;
            for (i, row) in dense.iter().enumerate() {
                let mut rest = wanted[i / 3][i % 3];
                for (j, k) in row.iter().enumerate() {
                    rest -= *k * x[j / 3][j % 3];
                }
                worst = rest.store().as_ref().iter().fold(worst, |worst, r| worst.max(r.abs()));
            }
            worst
        }
    }

    #[test]
    fn what_is_left_of_the_right_side_is_rounding() {
        // A tree with a loop, of joints with one to three nodes.
        let mut joints = vec![[0, NIL]];
        joints.extend((1..12).map(|i| [i, (i - 1) / 2]));
        joints.push([11, 7]);
        let shape = Shape::new(12, &joints, f64::INFINITY).unwrap();
        let mut plan = Plan::default();
        plan.prepare(&shape, true, (0..13).map(|i| 1 + i % 3));
        assert!(!plan.fill.is_empty() && plan.nodes() == 25);
        let left = dispatch_at(Level::Scalar, Solve(&plan));
        assert!(left < 1e-6, "{left}");
    }
}
