//! A problem of a few rows, such as those of one joint, or of the points where two bodies meet.

use ferrode_lcp::dantzig::{DantzigStatus, DantzigWorkspace, solve_dantzig};
use ferrode_lcp::dense::pad;
use ferrode_lcp::problem::BoxedLcp;

/// A x = b + w with bounds on x, and the memory for solving it.
#[derive(Clone, Debug, Default)]
pub(super) struct FewRows {
    matrix: Vec<f64>,
    rhs: Vec<f64>,
    lo: Vec<f64>,
    hi: Vec<f64>,
    findex: Vec<i32>,
    /// The solution.
    pub x: Vec<f64>,
    w: Vec<f64>,
    dantzig: DantzigWorkspace,
}

impl FewRows {
    /// Starts anew, with `n` rows; as many are pushed then.
    pub fn begin(&mut self, n: usize) {
        self.rhs.clear();
        self.lo.clear();
        self.hi.clear();
        self.findex.clear();
        for (list, len) in [(&mut self.matrix, n * pad(n)), (&mut self.x, n), (&mut self.w, n)] {
            list.clear();
            list.resize(len, 0.0);
        }
    }

    /// Adds a row: its right side, bounds, and the row that its bounds are scaled with, or −1.
    pub fn push(&mut self, rhs: f64, (lo, hi): (f64, f64), findex: i32) {
        self.rhs.push(rhs);
        self.lo.push(lo);
        self.hi.push(hi);
        self.findex.push(findex);
    }

    /// An entry of the matrix on or below the diagonal.
    pub fn entry(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.matrix[row * pad(self.x.len()) + column]
    }

    /// Finds the solution; `None` where bounds exclude zero, false where it gave up on some rows.
    pub fn solve(&mut self) -> Option<bool> {
        let n = self.x.len();
        let mut problem = BoxedLcp {
            n,
            a: &self.matrix,
            stride: pad(n),
            first: None,
            b: &self.rhs,
            lo: &self.lo,
            hi: &self.hi,
            findex: &self.findex,
            x: &mut self.x,
            w: &mut self.w,
        };
        let answer = solve_dantzig(&mut problem, &mut self.dantzig).ok()?;
        Some(answer.status == DantzigStatus::Solved)
    }
}
