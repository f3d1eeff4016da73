//! An interior-point method, to find a good guess when pivoting from a bad one goes nowhere.
//!
//! With slacks `s, t >= 0` of the two bounds the problem reads
//!
//! ```text
//!     A x - b = s - t      s (x - lo) = 0      t (hi - x) = 0      lo <= x <= hi
//! ```
//!
//! The products are kept positive and equal and brought to zero together. Each Newton step solves
//!
//! ```text
//!     (A + D) dx = b - A x + c / (x - lo) - c' / (hi - x)       D = s / (x - lo) + t / (hi - x)
//! ```
//!
//! which is the sparse system with `D` added to the CFM. It takes some 10 to 20 factorisations from anywhere, whatever the number of
//! rows; which bound each row goes to shows well before the forces are exact, and pivoting does the rest.
//! (S. Mehrotra, "On the implementation of a primal-dual interior point method", SIAM J. Optim. 2, 1992.)

use super::RowState;
use super::line::Bounds;
use crate::sparse::symbolic::Symbolic;
use crate::sparse::system::System;
use crate::sparse::{RowBlock, ScaledRow};

/// Memory of the method.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interior {
    s: Vec<f64>,
    t: Vec<f64>,
    ds: Vec<f64>,
    dt: Vec<f64>,
    /// Right-hand side of a step and the step.
    rho: Vec<f64>,
    dx: Vec<f64>,
    w: Vec<f64>,
}

const MOST_STEPS: u32 = 40;
/// So far the products are brought down, relative to where they began.
const ENOUGH: f64 = 1e-11;

impl Interior {
    /// Leaves a guess in `state`, and the forces and accelerations there in the system. Returns the number of factorisations.
    pub fn guess(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        shape: &Symbolic,
        system: &mut System,
        bounds: Bounds<'_>,
        state: &mut [RowState],
    ) -> u32 {
        let m = state.len();
        for v in
            [&mut self.s, &mut self.t, &mut self.ds, &mut self.dt, &mut self.rho, &mut self.dx, &mut self.w]
        {
            v.clear();
            v.resize(m, 0.0);
        }
        let Bounds { lo, hi } = bounds;
        let mut pairs = self.start(blocks, jacobian, system, bounds);
        let mut steps = 0;
        let first = self.mean_product(system, bounds, pairs);
        if pairs == 0 || !first.is_finite() {
            pairs = 0;
        }
        while pairs > 0 && steps < MOST_STEPS {
            steps += 1;
            self.slacks(system);
            let mean = self.mean_product(system, bounds, pairs);
            let unsolved = (0..m).map(|i| self.infeasibility(system, bounds, i)).fold(0.0, f64::max);
            if mean <= ENOUGH * first && unsolved <= 1e-9 {
                break;
            }
            for i in 0..m {
                let (a, b) = (system.lambda[i] - lo[i], hi[i] - system.lambda[i]);
                let mut extra = 0.0;
                if lo[i] > f64::NEG_INFINITY {
                    extra += self.s[i] / a;
                }
                if hi[i] < f64::INFINITY {
                    extra += self.t[i] / b;
                }
                system.weight[i] = if lo[i] == hi[i] { 0.0 } else { 1.0 / (system.used_sigma[i] + extra) };
            }
            system.factorise_weighted(blocks, jacobian, shape);
            // Straight to zero products, to see how far that goes.
            self.step(blocks, jacobian, shape, system, bounds, 0.0, false);
            let reach = self.reach(system, bounds, 1.0);
            let after = self.mean_product_after(system, bounds, pairs, reach);
            let ratio = after / mean;
            let centre = mean * ratio * ratio * ratio;
            self.step(blocks, jacobian, shape, system, bounds, centre, true);
            let reach = self.reach(system, bounds, 0.995);
            for i in 0..m {
                system.lambda[i] += reach * self.dx[i];
                self.s[i] += reach * self.ds[i];
                self.t[i] += reach * self.dt[i];
            }
            system.accelerations(blocks, jacobian);
            if reach < 1e-6 || reach.is_nan() {
                break;
            }
        }
        for (i, state) in state.iter_mut().enumerate() {
            let d = system.diagonal[i];
            *state = if lo[i] == hi[i] || self.s[i] > d * (system.lambda[i] - lo[i]) {
                RowState::Lower
            } else if self.t[i] > d * (hi[i] - system.lambda[i]) {
                RowState::Upper
            } else {
                RowState::Free
            };
        }
        steps
    }

    /// Forces inside their bounds, positive slacks. Returns the number of products.
    fn start(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        system: &mut System,
        Bounds { lo, hi }: Bounds<'_>,
    ) -> usize {
        let m = lo.len();
        // A typical force: what a row would take by itself.
        let mut scale = 0.0;
        for i in 0..m {
            scale += (system.rhs[i] / system.diagonal[i]).abs() / m as f64;
        }
        let scale = if scale > 1e-6 { scale } else { 1e-6 };
        let mut pairs = 0;
        for i in 0..m {
            let margin = 0.5 * scale;
            let wish = system.rhs[i] / system.diagonal[i];
            system.lambda[i] = match (lo[i] > f64::NEG_INFINITY, hi[i] < f64::INFINITY) {
                (true, true) => 0.5 * (lo[i] + hi[i]),
                (true, false) => lo[i] + if wish - lo[i] > margin { wish - lo[i] } else { margin },
                (false, true) => hi[i] - if hi[i] - wish > margin { hi[i] - wish } else { margin },
                (false, false) => 0.0,
            };
        }
        system.accelerations(blocks, jacobian);
        self.slacks(system);
        for i in 0..m {
            if lo[i] == hi[i] {
                continue;
            }
            let least = scale * system.diagonal[i];
            if lo[i] > f64::NEG_INFINITY {
                self.s[i] = if self.w[i] > 0.0 { self.w[i] + least } else { least };
                pairs += 1;
            }
            if hi[i] < f64::INFINITY {
                self.t[i] = if self.w[i] < 0.0 { least - self.w[i] } else { least };
                pairs += 1;
            }
        }
        pairs
    }

    /// `w = A x - b`; `y` must be `J^T x`.
    fn slacks(&mut self, system: &System) {
        for i in 0..self.w.len() {
            self.w[i] = system.jy[i] + system.used_sigma[i] * system.lambda[i] - system.rhs[i];
        }
    }

    /// How far a row is from `w = s - t`, in parts of its diagonal.
    fn infeasibility(&self, system: &System, Bounds { lo, hi }: Bounds<'_>, i: usize) -> f64 {
        if lo[i] == hi[i] {
            return 0.0;
        }
        ((self.w[i] - self.s[i] + self.t[i]) / system.diagonal[i]).abs() / (1.0 + system.lambda[i].abs())
    }

    fn mean_product(&self, system: &System, bounds: Bounds<'_>, pairs: usize) -> f64 {
        self.mean_product_after(system, bounds, pairs, 0.0)
    }

    /// The mean product after a part of the step.
    fn mean_product_after(
        &self,
        system: &System,
        Bounds { lo, hi }: Bounds<'_>,
        pairs: usize,
        reach: f64,
    ) -> f64 {
        let mut sum = 0.0;
        for i in 0..lo.len() {
            if lo[i] == hi[i] {
                continue;
            }
            let x = system.lambda[i] + reach * self.dx[i];
            if lo[i] > f64::NEG_INFINITY {
                sum += (self.s[i] + reach * self.ds[i]) * (x - lo[i]);
            }
            if hi[i] < f64::INFINITY {
                sum += (self.t[i] + reach * self.dt[i]) * (hi[i] - x);
            }
        }
        sum / pairs as f64
    }

    /// Finds the step towards products of `centre`; `corrected` takes the last step's second-order terms into account.
    #[allow(clippy::too_many_arguments)]
    fn step(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        shape: &Symbolic,
        system: &mut System,
        Bounds { lo, hi }: Bounds<'_>,
        centre: f64,
        corrected: bool,
    ) {
        let m = lo.len();
        for i in 0..m {
            self.rho[i] = -self.w[i];
            // ds and dt hold the wanted products until the step is known.
            let (ds, dt, dx) = (self.ds[i], self.dt[i], self.dx[i]);
            let second = |d: f64| if corrected { d * dx } else { 0.0 };
            if lo[i] > f64::NEG_INFINITY && lo[i] != hi[i] {
                self.ds[i] = (centre - second(ds)) / (system.lambda[i] - lo[i]);
                self.rho[i] += self.ds[i];
            }
            if hi[i] < f64::INFINITY && lo[i] != hi[i] {
                self.dt[i] = (centre + second(dt)) / (hi[i] - system.lambda[i]);
                self.rho[i] -= self.dt[i];
            }
        }
        system.solve_weighted(blocks, jacobian, shape, &self.rho, &mut self.dx);
        for i in 0..m {
            if lo[i] == hi[i] {
                (self.ds[i], self.dt[i]) = (0.0, 0.0);
                continue;
            }
            if lo[i] > f64::NEG_INFINITY {
                self.ds[i] += -self.s[i] - self.s[i] / (system.lambda[i] - lo[i]) * self.dx[i];
            }
            if hi[i] < f64::INFINITY {
                self.dt[i] += -self.t[i] + self.t[i] / (hi[i] - system.lambda[i]) * self.dx[i];
            }
        }
    }

    /// How much of the step keeps everything positive, times `part`, at most 1.
    fn reach(&self, system: &System, Bounds { lo, hi }: Bounds<'_>, part: f64) -> f64 {
        let mut reach = 1.0 / part;
        let mut limit = |x: f64, dx: f64| {
            if dx < 0.0 && -x / dx < reach {
                reach = -x / dx;
            }
        };
        for i in 0..lo.len() {
            if lo[i] == hi[i] {
                continue;
            }
            if lo[i] > f64::NEG_INFINITY {
                limit(system.lambda[i] - lo[i], self.dx[i]);
                limit(self.s[i], self.ds[i]);
            }
            if hi[i] < f64::INFINITY {
                limit(hi[i] - system.lambda[i], -self.dx[i]);
                limit(self.t[i], self.dt[i]);
            }
        }
        part * reach
    }
}
