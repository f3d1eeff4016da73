//! Dense matrices of the program's, row by row with padded rows.

use crate::fault::{Fault, Outcome, export};
use crate::numbers::numbers;
use crate::real::{self, Real, f};
use core::ffi::{c_int, c_uint};
use ferrode_lcp::{LcpError, cholesky, dense, ldlt};

/// A dimension or stride that must not be negative.
fn size(n: c_int) -> Outcome<usize> {
    usize::try_from(n).map_err(|_| Fault::ARGUMENT)
}

/// A dimension that must be positive.
fn positive(n: c_int) -> Outcome<usize> {
    size(n).and_then(|n| if n > 0 { Ok(n) } else { Err(Fault::ARGUMENT) })
}

/// Numbers that a matrix takes up: the last row's padding may be missing.
fn extent(rows: usize, columns: usize, stride: usize) -> usize {
    if rows == 0 { 0 } else { (rows - 1) * stride + columns }
}

fn done<T>(result: Result<T, LcpError>) -> Outcome<T> {
    result.map_err(|_| Fault::ARGUMENT)
}

/// The factorisation and the solutions by it, as the plain and the cooperative functions call them.
pub mod by_pointer {
    use super::{Outcome, Real, done, extent, ldlt, numbers};

    pub fn factor(a: *mut Real, d: *mut Real, n: usize, stride: usize) -> Outcome<()> {
        numbers!(; a = mut a[extent(n, n, stride)], d = mut d[n]);
        done(ldlt::factor_ldlt(a, d, n, stride))
    }

    pub fn solve_l1(l: *const Real, b: *mut Real, n: usize, stride: usize) -> Outcome<()> {
        numbers!(l = l[extent(n, n, stride)]; b = mut b[n]);
        done(ldlt::solve_l1(l, b, n, stride))
    }

    pub fn solve_l1t(l: *const Real, b: *mut Real, n: usize, stride: usize) -> Outcome<()> {
        numbers!(l = l[extent(n, n, stride)]; b = mut b[n]);
        done(ldlt::solve_l1t(l, b, n, stride))
    }

    pub fn solve(l: *const Real, d: *const Real, b: *mut Real, n: usize, stride: usize) -> Outcome<()> {
        numbers!(l = l[extent(n, n, stride)], d = d[n]; b = mut b[n]);
        done(ldlt::solve_ldlt(l, d, b, n, stride))
    }

    pub fn scale(a: *mut Real, d: *const Real, n: usize) -> Outcome<()> {
        numbers!(d = d[n]; a = mut a[n]);
        done(ferrode_lcp::dense::scale_vector(a, d, n))
    }
}

export! {
    fn dSetZero(a: *mut Real, n: c_int) {
        let n = size(n)?;
        numbers!(; a = mut a[n]);
        done(dense::set_zero(a, n))?
    }
    fn dSetValue(a: *mut Real, n: c_int, value: Real) {
        let n = size(n)?;
        numbers!(; a = mut a[n]);
        done(dense::set_value(a, n, f(value)))?
    }
    fn dDot(a: *const Real, b: *const Real, n: c_int) -> Real {
        let n = size(n.max(0))?;
        numbers!(a = a[n], b = b[n];);
        real::r(done(dense::dot(a, b, n))?)
    }
    fn dMultiply0(a: *mut Real, b: *const Real, c: *const Real, p: c_int, q: c_int, r: c_int) {
        let (p, q, r) = (positive(p)?, positive(q)?, positive(r)?);
        numbers!(b = b[extent(p, q, dense::pad(q))], c = c[extent(q, r, dense::pad(r))];
            a = mut a[extent(p, r, dense::pad(r))]);
        done(dense::multiply0(a, b, c, p, q, r))?
    }
    fn dMultiply1(a: *mut Real, b: *const Real, c: *const Real, p: c_int, q: c_int, r: c_int) {
        let (p, q, r) = (positive(p)?, positive(q)?, positive(r)?);
        numbers!(b = b[extent(q, p, dense::pad(p))], c = c[extent(q, r, dense::pad(r))];
            a = mut a[extent(p, r, dense::pad(r))]);
        done(dense::multiply1(a, b, c, p, q, r))?
    }
    fn dMultiply2(a: *mut Real, b: *const Real, c: *const Real, p: c_int, q: c_int, r: c_int) {
        let (p, q, r) = (positive(p)?, positive(q)?, positive(r)?);
        numbers!(b = b[extent(p, q, dense::pad(q))], c = c[extent(r, q, dense::pad(q))];
            a = mut a[extent(p, r, dense::pad(r))]);
        done(dense::multiply2(a, b, c, p, q, r))?
    }

    fn dFactorCholesky(a: *mut Real, n: c_int) -> c_int {
        let n = positive(n)?;
        numbers!(; a = mut a[extent(n, n, dense::pad(n))]);
        done(cholesky::factor_cholesky(a, n, dense::pad(n)))?.into()
    }
    fn dSolveCholesky(l: *const Real, b: *mut Real, n: c_int) {
        let n = positive(n)?;
        numbers!(l = l[extent(n, n, dense::pad(n))]; b = mut b[n]);
        done(cholesky::solve_cholesky(l, b, n, dense::pad(n)))?
    }
    fn dInvertPDMatrix(a: *const Real, inverse: *mut Real, n: c_int) -> c_int {
        let n = positive(n)?;
        let stride = dense::pad(n);
        numbers!(a = a[extent(n, n, stride)]; inverse = mut inverse[n * stride]);
        done(cholesky::invert_pd(a, inverse, n, stride))?.into()
    }
    fn dIsPositiveDefinite(a: *const Real, n: c_int) -> c_int {
        let n = positive(n)?;
        numbers!(a = a[extent(n, n, dense::pad(n))];);
        done(cholesky::is_positive_definite(a, n, dense::pad(n)))?.into()
    }

    fn dFactorLDLT(a: *mut Real, d: *mut Real, n: c_int, nskip: c_int) {
        by_pointer::factor(a, d, size(n)?, size(nskip)?)?
    }
    fn dSolveL1(l: *const Real, b: *mut Real, n: c_int, nskip: c_int) {
        by_pointer::solve_l1(l, b, size(n)?, size(nskip)?)?
    }
    fn dSolveL1T(l: *const Real, b: *mut Real, n: c_int, nskip: c_int) {
        by_pointer::solve_l1t(l, b, size(n)?, size(nskip)?)?
    }
    fn dSolveLDLT(l: *const Real, d: *const Real, b: *mut Real, n: c_int, nskip: c_int) {
        by_pointer::solve(l, d, b, size(n)?, size(nskip)?)?
    }
    fn dScaleVector(a: *mut Real, d: *const Real, n: c_int) { by_pointer::scale(a, d, size(n)?)? }
    fn dVectorScale(a: *mut Real, d: *const Real, n: c_int) { by_pointer::scale(a, d, size(n)?)? }
    fn dLDLTAddTL(l: *mut Real, d: *mut Real, a: *const Real, n: c_int, nskip: c_int) {
        let (n, stride) = (positive(n)?, size(nskip)?);
        numbers!(a = a[n]; l = mut l[extent(n, n, stride)], d = mut d[n]);
        done(ldlt::ldlt_add_tl(l, d, a, n, stride))?
    }
    /// The matrix itself and its permutation aren't needed: the factors say enough.
    fn dLDLTRemove(
        a: *mut *mut Real, p: *const c_int, l: *mut Real, d: *mut Real, n1: c_int, n2: c_int, r: c_int, nskip: c_int,
    ) {
        let (n1, n, r, stride) = (positive(n1)?, positive(n2)?, size(r)?, size(nskip)?);
        if a.is_null() || p.is_null() || n1 < n || r >= n {
            return Err(Fault::ARGUMENT);
        }
        numbers!(; l = mut l[extent(n, n, stride)], d = mut d[n]);
        done(ldlt::ldlt_remove(l, d, n, r, stride))?
    }
    fn dRemoveRowCol(a: *mut Real, n: c_int, nskip: c_int, r: c_int) {
        let (n, stride, r) = (positive(n)?, size(nskip)?, size(r)?);
        numbers!(; a = mut a[extent(n, n, stride)]);
        done(dense::remove_row_col(a, n, stride, r))?
    }

    fn dClearUpperTriangle(a: *mut Real, n: c_int) {
        let n = size(n)?;
        numbers!(; a = mut a[extent(n, n, dense::pad(n))]);
        done(dense::clear_upper_triangle(a, n))?
    }
    fn dMakeRandomVector(a: *mut Real, n: c_int, range: Real) {
        let n = size(n)?;
        numbers!(; a = mut a[n]);
        crate::misc::with_random(|random| random.fill(a, f(range)))
    }
    fn dMakeRandomMatrix(a: *mut Real, n: c_int, m: c_int, range: Real) {
        let (n, m) = (size(n)?, size(m)?);
        let stride = dense::pad(m);
        numbers!(; a = mut a[extent(n, m, stride)]);
        crate::misc::with_random(|random| {
            for row in a.chunks_mut(stride.max(1)) {
                random.fill(&mut row[..m], f(range));
            }
        })
    }
    fn dMaxDifference(a: *const Real, b: *const Real, n: c_int, m: c_int) -> Real {
        let (n, m) = (size(n)?, size(m)?);
        numbers!(a = a[extent(n, m, dense::pad(m))], b = b[extent(n, m, dense::pad(m))];);
        real::r(done(dense::max_difference(a, b, n, m))?)
    }
    fn dMaxDifferenceLowerTriangle(a: *const Real, b: *const Real, n: c_int) -> Real {
        let n = size(n)?;
        numbers!(a = a[extent(n, n, dense::pad(n))], b = b[extent(n, n, dense::pad(n))];);
        real::r(done(dense::max_difference_lower_triangle(a, b, n))?)
    }
}

/// Keeps the unsigned sizes of the cooperative functions in one place.
pub fn unsigned(n: c_uint) -> usize {
    n as usize
}
