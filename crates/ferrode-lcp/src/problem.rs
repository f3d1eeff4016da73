//! The boxed linear complementarity problem, as the equations of constrained motion pose it.
//!
//! Find `x` and `w` with `w = A x - b` such that for every row i
//!
//! - `lo_i < x_i < hi_i` and `w_i = 0`, or
//! - `x_i = lo_i` and `w_i >= 0`, or
//! - `x_i = hi_i` and `w_i <= 0`.
//!
//! In a physics step `x` holds constraint forces, `A = J M^-1 J^T + CFM/h` is symmetric and positive definite, and `w` is
//! the acceleration that is left between what the constraint asks for and what the bounded force achieves.
//! A row with a friction index f is bounded by `|hi_i x_f|` on both sides; what "x_f" means is the solver's affair.

use crate::error::{LcpError, check_len, check_matrix};

/// A boxed linear complementarity problem in dense form, with the places for its answer.
#[derive(Debug)]
pub struct BoxedLcp<'a> {
    /// The number of rows.
    pub n: usize,
    /// The matrix: symmetric, row-major with leading dimension `stride`; only the lower triangle with the diagonal is
    /// read, and it is not written.
    pub a: &'a [f64],
    /// The distance between the starts of two rows of `a`, usually [`pad(n)`](crate::dense::pad).
    pub stride: usize,
    /// If given, for each row the first column that may differ from zero. What lies left of it is not read, so it
    /// need not be cleared: a long chain of joints uses a narrow band of `a`.
    pub first: Option<&'a [u32]>,
    /// The right-hand side.
    pub b: &'a [f64],
    /// Lower bounds, not above 0, possibly minus infinity. Not read for rows with a friction index.
    pub lo: &'a [f64],
    /// Upper bounds, not below 0, possibly infinity; for rows with a friction index the coefficient of friction.
    pub hi: &'a [f64],
    /// For each row the row whose unknown scales its bounds, or a negative number for none.
    pub findex: &'a [i32],
    /// Answer: the unknowns.
    pub x: &'a mut [f64],
    /// Answer: the slack `A x - b`.
    pub w: &'a mut [f64],
}

impl BoxedLcp<'_> {
    /// Checks sizes, bounds and friction indices.
    ///
    /// # Errors
    /// Names the slice that is too short, or the row whose bounds exclude zero or whose friction index names no row.
    pub fn check(&self) -> Result<(), LcpError> {
        let n = self.n;
        check_matrix("a", self.a.len(), n, n, self.stride)?;
        check_len("first", self.first.map_or(n, <[u32]>::len), n)?;
        check_len("b", self.b.len(), n)?;
        check_len("lo", self.lo.len(), n)?;
        check_len("hi", self.hi.len(), n)?;
        check_len("findex", self.findex.len(), n)?;
        check_len("x", self.x.len(), n)?;
        check_len("w", self.w.len(), n)?;
        for (row, &first) in self.first.unwrap_or_default().iter().enumerate().take(n) {
            if first as usize > row {
                return Err(LcpError::Index { what: "first", index: first as usize, end: row + 1 });
            }
        }
        for row in 0..n {
            check_row(row, n, self.lo[row], self.hi[row], self.findex[row])?;
        }
        Ok(())
    }
}

/// Checks one row of a problem with `n` rows: bounds that contain zero, a friction index that names a row.
pub(crate) fn check_row(row: usize, n: usize, lo: f64, hi: f64, findex: i32) -> Result<(), LcpError> {
    match usize::try_from(findex) {
        Ok(f) if f >= n => Err(LcpError::FrictionIndex { row, findex }),
        Ok(_) if hi.is_nan() => Err(LcpError::Bounds { row, lo, hi }),
        Err(_) if !(lo <= 0.0 && hi >= 0.0) => Err(LcpError::Bounds { row, lo, hi }),
        _ => Ok(()),
    }
}
