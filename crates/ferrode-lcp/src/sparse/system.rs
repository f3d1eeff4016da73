//! The rows of a problem, and solves with the rows of a given set held exactly.
//!
//! A row is either free (its force is unknown, its equation `J y + S lambda = r` holds) or its force is given. For one choice, with `F`
//! the free rows,
//!
//! ```text
//!     H = 1 + J_F^T S_F^-1 J_F
//!     residuals     g = J^T lambda - y          e_F = r_F - J_F y - S_F lambda_F
//!     correction    H dy = g + J_F^T S_F^-1 e_F      dlambda_F = S_F^-1 (e_F - J_F dy)
//! ```
//!
//! From `y = 0`, `lambda_F = 0` the first correction is the solution, and each further one a step of iterative refinement in the full
//! system: the residuals are computed from the rows themselves, so what the stiff `H` lost to rounding comes back.
//! (Å. Björck, "Iterative refinement and reliable computing", 1990.)

use super::factor::Factor;
use super::kernel6::{self, Six};
use super::symbolic::{NONE, Symbolic};
use super::{RowBlock, ScaledRow};
use crate::pivoting::RowState;

/// A row with less CFM than this part of its diagonal gets more, made good by proximal steps.
pub(crate) const LEAST_SIGMA: f64 = 1e-10;
/// Refinement ends when the error that is to be expected is below this part of the largest force: while rows are still being
/// sorted, and at the end.
const ROUGH: f64 = 1e-12;
const FINE: f64 = 1e-15;
const MOST_CORRECTIONS: usize = 8;

/// A problem's rows with what is computed for each, and the unknowns.
#[derive(Clone, Debug, Default)]
pub(crate) struct System {
    /// Per row: CFM/h as given, as used, its inverse, and `J J^T` + CFM/h.
    pub sigma: Vec<f64>,
    pub used_sigma: Vec<f64>,
    pub inverse_sigma: Vec<f64>,
    pub diagonal: Vec<f64>,
    /// The right-hand side in force: the given one, plus what the proximal step adds.
    pub rhs: Vec<f64>,
    /// The forces and the accelerations that they cause, the latter by column of the factor.
    pub lambda: Vec<f64>,
    pub y: Vec<Six>,
    /// `J y`, brought up to date by [`System::product`] and [`System::correct`].
    pub jy: Vec<f64>,
    error: Vec<f64>,
    pub dy: Vec<Six>,
    pub factor: Factor,
    /// Largest change of a force in the last correction, and its ratio to the one before.
    change: f64,
    rate: f64,
    /// Per row what it weighs in `H`: `1 / S`, or 0 for a row whose force is given.
    pub weight: Vec<f64>,
    /// Whether some row's CFM was raised.
    pub raised: bool,
}

impl System {
    /// Takes the rows in. `columns` is the number of bodies.
    pub fn load(&mut self, jacobian: &[ScaledRow], sigma: &[f64], rhs: &[f64], shape: &Symbolic) {
        let (m, n) = (jacobian.len(), shape.columns_len());
        for v in [&mut self.lambda, &mut self.jy, &mut self.error] {
            v.clear();
            v.resize(m, 0.0);
        }
        for v in [&mut self.y, &mut self.dy] {
            v.clear();
            v.resize(n, [0.0; 6]);
        }
        self.sigma.clear();
        self.sigma.extend_from_slice(&sigma[..m]);
        self.rhs.clear();
        self.rhs.extend_from_slice(&rhs[..m]);
        for v in [&mut self.used_sigma, &mut self.inverse_sigma, &mut self.diagonal] {
            v.clear();
        }
        self.raised = false;
        self.weight.clear();
        for (row, sigma) in jacobian.iter().zip(sigma) {
            let diagonal = kernel6::dot(&row[0], &row[0]) + kernel6::dot(&row[1], &row[1]) + sigma;
            let least = LEAST_SIGMA * diagonal;
            let used = if *sigma < least { least } else { *sigma };
            self.raised |= used != *sigma;
            self.diagonal.push(diagonal);
            self.used_sigma.push(used);
            self.weight.push(0.0);
            self.inverse_sigma.push(if used > 0.0 { 1.0 / used } else { 0.0 });
        }
        self.factor.reset(shape);
    }

    /// Adds the blocks of the free rows to the stale columns, and factors them.
    pub fn factorise(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
    ) {
        for (row, state) in state.iter().enumerate() {
            self.weight[row] = if *state == RowState::Free { self.inverse_sigma[row] } else { 0.0 };
        }
        self.add_and_factorise(blocks, jacobian, shape);
    }

    /// Factors everything anew with the weights as they stand in `weight`.
    pub fn factorise_weighted(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow], shape: &Symbolic) {
        self.factor.reset(shape);
        self.add_and_factorise(blocks, jacobian, shape);
    }

    /// Solves `(J J^T + 1 / weight) x = rho` for the rows that have a weight, one time and without refinement; 0 for the others.
    pub fn solve_weighted(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        shape: &Symbolic,
        rho: &[f64],
        x: &mut [f64],
    ) {
        for (x, (rho, weight)) in x.iter_mut().zip(rho.iter().zip(&self.weight)) {
            *x = rho * weight;
        }
        self.dy.fill([0.0; 6]);
        multiply_transposed(blocks, jacobian, shape, x, &mut self.dy);
        self.factor.solve(shape, &mut self.dy);
        multiply(blocks, jacobian, shape, &self.dy, &mut self.error);
        for (row, x) in x.iter_mut().enumerate() {
            *x = (rho[row] - self.error[row]) * self.weight[row];
        }
    }

    fn add_and_factorise(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow], shape: &Symbolic) {
        self.factor.clear_stale(shape);
        for (block, (columns, pair)) in blocks.iter().zip(shape.columns.iter().zip(&shape.pair)) {
            let stale = columns.map(|c| self.factor.is_stale(c));
            if !stale[0] && !stale[1] {
                continue;
            }
            let (mut a, mut b, mut across) = ([0.0; 36], [0.0; 36], [0.0; 36]);
            let mut any = false;
            // The pair's block stands in the column of the body that is eliminated first.
            let (low, high) = if columns[0] < columns[1] { (0, 1) } else { (1, 0) };
            for row in block.range() {
                let (s, j) = (self.weight[row], &jacobian[row]);
                if s == 0.0 {
                    continue;
                }
                any = true;
                if stale[0] {
                    kernel6::add_outer(&mut a, s, &j[0], &j[0]);
                }
                if stale[1] {
                    kernel6::add_outer(&mut b, s, &j[1], &j[1]);
                }
                if *pair != NONE && stale[low] {
                    kernel6::add_outer(&mut across, s, &j[high], &j[low]);
                }
            }
            if any {
                if stale[0] {
                    self.factor.add_diagonal(columns[0], &a);
                }
                if stale[1] {
                    self.factor.add_diagonal(columns[1], &b);
                }
                if *pair != NONE && stale[low] {
                    self.factor.add_below(*pair, &across);
                }
            }
        }
        self.factor.factorise(shape);
    }

    /// Solves for the free rows with the forces of the others as they stand in `lambda`. Returns the largest force.
    pub fn solve(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
    ) -> f64 {
        self.y.fill([0.0; 6]);
        let mut largest_given: f64 = 0.0;
        for (lambda, state) in self.lambda.iter_mut().zip(state) {
            if *state == RowState::Free {
                *lambda = 0.0;
            } else if lambda.abs() > largest_given {
                largest_given = lambda.abs();
            }
        }
        let first = self.correct(blocks, jacobian, state, shape, true);
        let largest = if first > largest_given { first } else { largest_given };
        (self.change, self.rate) = (first, 1.0);
        self.refine(blocks, jacobian, state, shape, ROUGH * largest);
        largest
    }

    /// Refines the last solution as far as rounding allows.
    pub fn polish(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
        largest: f64,
    ) {
        self.refine(blocks, jacobian, state, shape, FINE * largest);
    }

    /// Corrects until the error to be expected, which shrinks by the same factor each time, is below `goal`, or rounding stops it.
    fn refine(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
        goal: f64,
    ) {
        for _ in 0..MOST_CORRECTIONS {
            if self.change * self.rate <= goal {
                break;
            }
            let change = self.correct(blocks, jacobian, state, shape, false);
            self.rate = change / self.change;
            self.change = change;
            let falls = self.rate < 0.5;
            if !falls {
                self.rate = 0.0;
                break;
            }
        }
    }

    /// One correction. Returns the largest change of a force.
    fn correct(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
        first: bool,
    ) -> f64 {
        for (dy, y) in self.dy.iter_mut().zip(&self.y) {
            *dy = y.map(|y| -y);
        }
        for (block, columns) in blocks.iter().zip(&shape.columns) {
            let [ya, yb] = columns.map(|c| if c == NONE { [0.0; 6] } else { self.y[c as usize] });
            let (mut a, mut b) = ([0.0; 6], [0.0; 6]);
            for row in block.range() {
                let j = &jacobian[row];
                let mut force = self.lambda[row];
                if state[row] == RowState::Free {
                    let jy = if first { 0.0 } else { kernel6::dot(&j[0], &ya) + kernel6::dot(&j[1], &yb) };
                    let error = self.rhs[row] - jy - self.used_sigma[row] * force;
                    self.error[row] = error;
                    force += error * self.inverse_sigma[row];
                }
                kernel6::add_scaled(&mut a, force, &j[0]);
                kernel6::add_scaled(&mut b, force, &j[1]);
            }
            for (c, sum) in [(columns[0], &a), (columns[1], &b)] {
                if c != NONE {
                    kernel6::add_scaled(&mut self.dy[c as usize], 1.0, sum);
                }
            }
        }
        self.factor.solve(shape, &mut self.dy);
        for (y, dy) in self.y.iter_mut().zip(&self.dy) {
            kernel6::add_scaled(y, 1.0, dy);
        }
        let mut largest: f64 = 0.0;
        for (block, columns) in blocks.iter().zip(&shape.columns) {
            let [da, db] = columns.map(|c| if c == NONE { [0.0; 6] } else { self.dy[c as usize] });
            for row in block.range() {
                if state[row] == RowState::Free {
                    let j = &jacobian[row];
                    let jdy = kernel6::dot(&j[0], &da) + kernel6::dot(&j[1], &db);
                    let change = (self.error[row] - jdy) * self.inverse_sigma[row];
                    self.lambda[row] += change;
                    if change.abs() > largest || change.is_nan() {
                        largest = change.abs();
                    }
                }
            }
        }
        largest
    }

    /// Sets `jy` to `J y`.
    pub fn product(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow], shape: &Symbolic) {
        multiply(blocks, jacobian, shape, &self.y, &mut self.jy);
    }

    /// Sets `y` to `J^T lambda` and `jy` to `J y`, from the forces alone.
    pub fn accelerations(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow], shape: &Symbolic) {
        self.y.fill([0.0; 6]);
        multiply_transposed(blocks, jacobian, shape, &self.lambda, &mut self.y);
        self.product(blocks, jacobian, shape);
    }
}

/// `out += J^T x`.
fn multiply_transposed(
    blocks: &[RowBlock],
    jacobian: &[ScaledRow],
    shape: &Symbolic,
    x: &[f64],
    out: &mut [Six],
) {
    for (block, columns) in blocks.iter().zip(&shape.columns) {
        let (mut a, mut b) = ([0.0; 6], [0.0; 6]);
        for row in block.range() {
            kernel6::add_scaled(&mut a, x[row], &jacobian[row][0]);
            kernel6::add_scaled(&mut b, x[row], &jacobian[row][1]);
        }
        for (c, sum) in [(columns[0], &a), (columns[1], &b)] {
            if c != NONE {
                kernel6::add_scaled(&mut out[c as usize], 1.0, sum);
            }
        }
    }
}

/// `out = J y`.
pub(crate) fn multiply(
    blocks: &[RowBlock],
    jacobian: &[ScaledRow],
    shape: &Symbolic,
    y: &[Six],
    out: &mut [f64],
) {
    for (block, columns) in blocks.iter().zip(&shape.columns) {
        let [ya, yb] = columns.map(|c| if c == NONE { [0.0; 6] } else { y[c as usize] });
        for row in block.range() {
            let j = &jacobian[row];
            out[row] = kernel6::dot(&j[0], &ya) + kernel6::dot(&j[1], &yb);
        }
    }
}
