//! The last resort: the dense matrix, and Dantzig's method with its repairs.

use super::SparseLcp;
use crate::dantzig::{DantzigOptions, DantzigWorkspace, solve_dantzig_with};
use crate::dense::pad;
use crate::problem::BoxedLcp;
use crate::sparse::{NO_SPARSE_BODY, kernels};

/// Memory of the dense method.
#[derive(Clone, Debug, Default)]
pub(crate) struct Dense {
    matrix: Vec<f64>,
    no_index: Vec<i32>,
    w: Vec<f64>,
    dantzig: DantzigWorkspace,
}

impl Dense {
    /// Solves with the bounds given. Leaves zeros if that fails too.
    pub fn solve(&mut self, p: &SparseLcp<'_>, lo: &[f64], hi: &[f64], lambda: &mut [f64]) {
        let m = p.jacobian.len();
        let stride = pad(m);
        self.matrix.clear();
        self.matrix.resize(m * stride, 0.0);
        for (i, first) in p.blocks.iter().enumerate() {
            for second in &p.blocks[..=i] {
                for (s, a) in first.bodies.iter().enumerate() {
                    for (t, b) in second.bodies.iter().enumerate() {
                        if a == b && *a != NO_SPARSE_BODY {
                            for r in first.range() {
                                for c in second.range() {
                                    self.matrix[r * stride + c] +=
                                        kernels::dot(&p.jacobian[r][s], &p.jacobian[c][t]);
                                }
                            }
                        }
                    }
                }
            }
        }
        for r in 0..m {
            self.matrix[r * stride + r] += p.sigma[r];
        }
        self.no_index.clear();
        self.no_index.resize(m, -1);
        self.w.clear();
        self.w.resize(m, 0.0);
        let mut problem = BoxedLcp {
            n: m,
            a: &self.matrix,
            stride,
            first: None,
            b: p.rhs,
            lo,
            hi,
            findex: &self.no_index,
            x: lambda,
            w: &mut self.w,
        };
        let options = DantzigOptions { recover: true, ..DantzigOptions::default() };
        if solve_dantzig_with(&mut problem, &mut self.dantzig, &options).is_err() {
            lambda.fill(0.0);
        }
    }
}
