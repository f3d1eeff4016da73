//! The natural residuals of all rows.

use super::line::Bounds;
use crate::residual::row_residual;
use crate::sparse::system::System;
use ferrode_math::simd::{Compute, compute_wide};

/// Finds the rows' residuals, given the accelerations that their forces cause, for the right-hand side `rhs` and the rows' own CFM.
pub(super) fn find(system: &System, rhs: &[f64], bounds: Bounds<'_>, out: &mut Vec<f64>) {
    out.resize(system.lambda.len(), 0.0);
    compute_wide(Residuals { system, rhs, bounds, out });
}

struct Residuals<'a> {
    system: &'a System,
    rhs: &'a [f64],
    bounds: Bounds<'a>,
    out: &'a mut [f64],
}

impl Compute for Residuals<'_> {
    type Out = ();

    #[inline(always)]
    fn run(self) {
        let Self { system: s, rhs, bounds: Bounds { lo, hi }, out } = self;
        let m = out.len();
        let (lambda, jy, sigma) = (&s.lambda[..m], &s.jy[..m], &s.sigma[..m]);
        let (diagonal, rhs, lo, hi) = (&s.diagonal[..m], &rhs[..m], &lo[..m], &hi[..m]);
        for i in 0..m {
            let w = jy[i] + sigma[i] * lambda[i] - rhs[i];
            out[i] = row_residual(lambda[i], w, diagonal[i], lo[i], hi[i]);
        }
    }
}
