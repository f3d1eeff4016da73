//! Cholesky's factorisation `A = L L^T` of a symmetric positive definite matrix, `L` lower triangular.
//!
//! Row i of `L` follows from the rows above it: `L_ij = (A_ij - L_i . L_j) / L_jj` with the dot product over the first j
//! columns, and `L_ii^2 = A_ii - L_i . L_i`. If that difference is not positive, `A` was not positive definite.
//! (G. H. Golub, C. F. Van Loan, Matrix Computations, section 4.2.)

use crate::error::{LcpError, check_len, check_matrix};
use crate::kernel::{dot, sub_scaled};

/// Factors `A = L L^T` in place: the lower triangle of `a` becomes `L`; the rest is not touched.
/// `false` as soon as a pivot is not positive; `a` is then partly overwritten.
///
/// # Errors
/// If `a` is too short for an `n` x `n` matrix of that stride.
pub fn factor_cholesky(a: &mut [f64], n: usize, stride: usize) -> Result<bool, LcpError> {
    check_matrix("a", a.len(), n, n, stride)?;
    for i in 0..n {
        let (above, rest) = a.split_at_mut(i * stride);
        let row = &mut rest[..=i];
        for j in 0..i {
            let l_j = &above[j * stride..][..=j];
            row[j] = (row[j] - dot(&row[..j], &l_j[..j])) / l_j[j];
        }
        let pivot = row[i] - dot(&row[..i], &row[..i]);
        if pivot.is_nan() || pivot <= 0.0 {
            return Ok(false);
        }
        row[i] = pivot.sqrt();
    }
    Ok(true)
}

/// Solves `L L^T x = b` in place in `b`, `L` from [`factor_cholesky`].
///
/// # Errors
/// If `l` or `b` is too short.
pub fn solve_cholesky(l: &[f64], b: &mut [f64], n: usize, stride: usize) -> Result<(), LcpError> {
    check_matrix("l", l.len(), n, n, stride)?;
    check_len("b", b.len(), n)?;
    for i in 0..n {
        let row = &l[i * stride..][..=i];
        b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
    }
    for i in (0..n).rev() {
        let row = &l[i * stride..][..=i];
        let x = b[i] / row[i];
        b[i] = x;
        sub_scaled(&mut b[..i], x, &row[..i]);
    }
    Ok(())
}

/// The inverse of a positive definite matrix, of which the lower triangle is read. The padding of the result is set to
/// zero. `false`, with `inverse` untouched, if `a` is not positive definite.
///
/// # Errors
/// If a slice is too short.
pub fn invert_pd(a: &[f64], inverse: &mut [f64], n: usize, stride: usize) -> Result<bool, LcpError> {
    check_matrix("a", a.len(), n, n, stride)?;
    check_matrix("inverse", inverse.len(), n, n, stride)?;
    let mut l = a.to_vec();
    if !factor_cholesky(&mut l, n, stride)? {
        return Ok(false);
    }
    let used = inverse.len().min(n * stride);
    inverse[..used].fill(0.0);
    let mut column = vec![0.0; n];
    for j in 0..n {
        column.fill(0.0);
        column[j] = 1.0;
        solve_cholesky(&l, &mut column, n, stride)?;
        for (i, x) in column.iter().enumerate() {
            inverse[i * stride + j] = *x;
        }
    }
    Ok(true)
}

/// Whether a symmetric matrix, of which the lower triangle is read, is positive definite.
///
/// # Errors
/// If `a` is too short.
pub fn is_positive_definite(a: &[f64], n: usize, stride: usize) -> Result<bool, LcpError> {
    check_matrix("a", a.len(), n, n, stride)?;
    factor_cholesky(&mut a.to_vec(), n, stride)
}
