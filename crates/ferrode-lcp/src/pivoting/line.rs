//! Newton's method with exact line search, for when pivoting goes round in circles.
//!
//! With bounds fixed and CFM > 0 the boxed problem is the minimum of a convex function of the accelerations alone,
//!
//! ```text
//!     F(y) = |y|^2 / 2 + sum_i psi_i(r_i - J_i y)
//!     psi(z) = z^2 / 2S              where lo < z/S < hi: the row is free, its force z/S
//!            = hi z - S hi^2 / 2     where z/S >= hi
//!            = lo z - S lo^2 / 2     where z/S <= lo
//! ```
//!
//! once differentiable, quadratic in pieces. One solve with the free rows of the piece that `y` lies in is a Newton step. The minimum on the
//! line towards its end is found exactly: the slope of F along the line grows piece by piece linearly. Each step makes F smaller,
//! pieces are finitely many, so no piece comes back.
//! (E. Todorov, "Analytically-invertible dynamics with contacts and constraints", ICRA 2014; J. Sun, "On piecewise quadratic Newton and
//! trust region problems", 1997.)

use super::RowState;
use crate::sparse::kernels::{self, Six};

/// The bounds in force.
#[derive(Clone, Copy)]
pub(crate) struct Bounds<'a> {
    pub lo: &'a [f64],
    pub hi: &'a [f64],
}

/// The rows as the line search sees them.
#[derive(Clone, Copy)]
pub(crate) struct Rows<'a> {
    pub bounds: Bounds<'a>,
    pub rhs: &'a [f64],
    pub sigma: &'a [f64],
    pub inverse_sigma: &'a [f64],
}

impl Rows<'_> {
    /// F at `y`, given `J y`.
    pub fn value(&self, y: &[Six], jy: &[f64]) -> f64 {
        let mut sum = 0.0;
        for y in y {
            sum += 0.5 * kernels::dot(y, y);
        }
        for (i, jy) in jy.iter().enumerate() {
            let z = self.rhs[i] - jy;
            let (lo, hi, s) = (self.bounds.lo[i], self.bounds.hi[i], self.sigma[i]);
            sum += match state_of(z * self.inverse_sigma[i], lo, hi) {
                RowState::Free => 0.5 * z * z * self.inverse_sigma[i],
                RowState::Lower => lo * z - 0.5 * s * lo * lo,
                RowState::Upper => hi * z - 0.5 * s * hi * hi,
            };
        }
        sum
    }

    /// The states of the rows at a point, given `J y` there.
    pub fn states(&self, jy: &[f64], state: &mut [RowState]) {
        for i in 0..jy.len() {
            let force = (self.rhs[i] - jy[i]) * self.inverse_sigma[i];
            state[i] = state_of(force, self.bounds.lo[i], self.bounds.hi[i]);
        }
    }

    /// Where on `y + t dy`, `t >= 0`, F is least, given `J y` and `J dy`.
    pub fn search(&self, y: &[Six], dy: &[Six], jy: &[f64], jdy: &[f64]) -> f64 {
        let (mut at_0, mut growth) = (0.0, 0.0);
        for (y, d) in y.iter().zip(dy) {
            at_0 += kernels::dot(y, d);
            growth += kernels::dot(d, d);
        }
        // Slope and its growth at t.
        let slope = |t: f64| {
            let (mut first, mut second) = (at_0 + t * growth, growth);
            for i in 0..jy.len() {
                let d = jdy[i];
                let force = (self.rhs[i] - jy[i] - t * d) * self.inverse_sigma[i];
                let (lo, hi) = (self.bounds.lo[i], self.bounds.hi[i]);
                first -= d * match state_of(force, lo, hi) {
                    RowState::Free => {
                        second += d * d * self.inverse_sigma[i];
                        force
                    }
                    RowState::Lower => lo,
                    RowState::Upper => hi,
                };
            }
            (first, second)
        };
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut t = 1.0;
        for _ in 0..100 {
            let (first, second) = slope(t);
            if first == 0.0 {
                break;
            }
            if first < 0.0 {
                low = t;
            } else {
                high = t;
            }
            // Within a piece the slope is linear, so Newton's step ends there. Where pieces are crossed, the bracket holds it.
            let next = t - first / second;
            let middle = if high.is_finite() { 0.5 * (low + high) } else { 2.0 * t + 1.0 };
            let next = if next > low && next < high { next } else { middle };
            if !(next > low && next < high) || (next - t).abs() <= 1e-15 * t {
                break;
            }
            t = next;
        }
        t
    }
}

/// The state that a force has which the free equation asks for.
#[inline(always)]
pub(crate) fn state_of(force: f64, lo: f64, hi: f64) -> RowState {
    if force <= lo {
        RowState::Lower
    } else if force >= hi {
        RowState::Upper
    } else {
        RowState::Free
    }
}
