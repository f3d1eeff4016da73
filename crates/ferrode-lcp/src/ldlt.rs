//! The factorisation `A = L D L^T` of a dense symmetric matrix: `L` unit lower triangular, `D` diagonal, no square root.
//!
//! Two conventions of ODE hold throughout: the strict lower triangle holds `L` and the diagonal is not touched, and the
//! vector `d` holds the RECIPROCALS of the diagonal of `D`, so that solving needs no division.
//!
//! The updates are those of P. E. Gill, G. H. Golub, W. Murray and M. A. Saunders, "Methods for modifying matrix
//! factorizations" (1974), method C1: for `A + alpha z z^T`, column by column j with `p = z_j`,
//!
//! `D'_j = D_j + alpha p^2`, `beta = alpha p / D'_j`, `alpha := alpha D_j / D'_j`, and for the rows k below,
//! `z_k := z_k - p L_kj`, `L_kj := L_kj + beta z_k`.

use crate::dense::remove_row_col;
use crate::error::{LcpError, check_len, check_matrix};
use crate::kernel::{dot, sub_scaled};

/// Factors `A = L D L^T` in place, without pivoting and without a check: a zero pivot gives an infinite reciprocal.
/// The strict lower triangle of `a` becomes that of `L`, `d` the reciprocals of `D`.
///
/// # Errors
/// If `a` or `d` is too short.
pub fn factor_ldlt(a: &mut [f64], d: &mut [f64], n: usize, stride: usize) -> Result<(), LcpError> {
    check_matrix("a", a.len(), n, n, stride)?;
    check_len("d", d.len(), n)?;
    for i in 0..n {
        let (above, rest) = a.split_at_mut(i * stride);
        let row = &mut rest[..=i];
        for j in 0..i {
            row[j] -= dot(&row[..j], &above[j * stride..][..j]);
        }
        d[i] = 1.0 / (row[i] - scale_row(&mut row[..i], &d[..i]));
    }
    Ok(())
}

/// Turns `y = L^-1 a` into the new row `y_j / D_j` of the factor; returns `sum y_j^2 / D_j`.
pub(crate) fn scale_row(y: &mut [f64], d: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (y, d) in y.iter_mut().zip(d) {
        let scaled = *y * d;
        sum += *y * scaled;
        *y = scaled;
    }
    sum
}

/// Solves `L x = b` in place, `L` unit lower triangular.
///
/// # Errors
/// If `l` or `b` is too short.
pub fn solve_l1(l: &[f64], b: &mut [f64], n: usize, stride: usize) -> Result<(), LcpError> {
    check_matrix("l", l.len(), n, n, stride)?;
    check_len("b", b.len(), n)?;
    for i in 1..n {
        b[i] -= dot(&l[i * stride..][..i], &b[..i]);
    }
    Ok(())
}

/// Solves `L^T x = b` in place, `L` unit lower triangular.
///
/// # Errors
/// If `l` or `b` is too short.
pub fn solve_l1t(l: &[f64], b: &mut [f64], n: usize, stride: usize) -> Result<(), LcpError> {
    check_matrix("l", l.len(), n, n, stride)?;
    check_len("b", b.len(), n)?;
    for i in (1..n).rev() {
        let (head, tail) = b.split_at_mut(i);
        sub_scaled(head, tail[0], &l[i * stride..][..i]);
    }
    Ok(())
}

/// Solves `L D L^T x = b` in place, with `d` the reciprocals of `D`.
///
/// # Errors
/// If a slice is too short.
pub fn solve_ldlt(l: &[f64], d: &[f64], b: &mut [f64], n: usize, stride: usize) -> Result<(), LcpError> {
    check_len("d", d.len(), n)?;
    solve_l1(l, b, n, stride)?;
    crate::dense::scale_vector(b, d, n)?;
    solve_l1t(l, b, n, stride)
}

/// One rank-one update in progress: `A + alpha z z^T`.
struct RankOne {
    alpha: f64,
    p: f64,
    beta: f64,
}

impl RankOne {
    /// Starts column j, `p = z_j`; takes and returns the reciprocal pivot. No change for a vanishing `p`.
    fn pivot(&mut self, p: f64, reciprocal: f64) -> f64 {
        self.p = p;
        if p == 0.0 {
            self.beta = 0.0;
            return reciprocal;
        }
        let grown = 1.0 + self.alpha * p * p * reciprocal;
        let updated = reciprocal / grown;
        self.beta = self.alpha * p * updated;
        self.alpha /= grown;
        updated
    }

    /// Carries one entry of the column; returns the new `L_kj`.
    fn entry(&self, z: &mut f64, l: f64) -> f64 {
        *z -= self.p * l;
        l + self.beta * *z
    }
}

/// Updates the factorisation for the addition of the symmetric matrix whose first row and column are `a` and which is
/// zero elsewhere. The first column of `L` and `d[0]` are read but not written: the caller is about to drop them.
///
/// With `u = a`, `u_0 = a_0 / 2`, that matrix is `e_0 u^T + u e_0^T = 1/2 (u + e_0)(u + e_0)^T - 1/2 (u - e_0)(u - e_0)^T`:
/// two rank-one updates, done in one pass of `O(n^2)`.
///
/// # Errors
/// If a slice is too short.
pub fn ldlt_add_tl(l: &mut [f64], d: &mut [f64], a: &[f64], n: usize, stride: usize) -> Result<(), LcpError> {
    check_matrix("l", l.len(), n, n, stride)?;
    check_len("d", d.len(), n)?;
    check_len("a", a.len(), n)?;
    if n < 2 {
        return Ok(());
    }
    let mut z1 = a[..n].to_vec();
    let mut z2 = a[..n].to_vec();
    z1[0] = 0.5 * a[0] + 1.0;
    z2[0] = 0.5 * a[0] - 1.0;
    let mut first = RankOne { alpha: 0.5, p: 0.0, beta: 0.0 };
    let mut second = RankOne { alpha: -0.5, p: 0.0, beta: 0.0 };
    for j in 0..n {
        let between = first.pivot(z1[j], d[j]);
        let updated = second.pivot(z2[j], between);
        if j > 0 {
            d[j] = updated;
        }
        for k in j + 1..n {
            let at = k * stride + j;
            let entry = first.entry(&mut z1[k], l[at]);
            let entry = second.entry(&mut z2[k], entry);
            if j > 0 {
                l[at] = entry;
            }
        }
    }
    Ok(())
}

/// Removes row and column `r` from a factorisation of size `n`, in `O(n^2)`: `L` and `d` become those of the smaller
/// matrix, and are moved together so that it fills the first `n - 1` rows and columns.
///
/// What lies below r gains `D_r l l^T`, with `l` the column r of `L` below the diagonal: one rank-one update. The matrix
/// itself is not needed.
///
/// # Errors
/// If a slice is too short or `r` is not below `n`.
pub fn ldlt_remove(l: &mut [f64], d: &mut [f64], n: usize, r: usize, stride: usize) -> Result<(), LcpError> {
    check_matrix("l", l.len(), n, n, stride)?;
    check_len("d", d.len(), n)?;
    if r >= n {
        return Err(LcpError::Index { what: "r", index: r, end: n });
    }
    let mut z: Vec<f64> = (r + 1..n).map(|k| l[k * stride + r]).collect();
    let mut update = RankOne { alpha: 1.0 / d[r], p: 0.0, beta: 0.0 };
    for j in r + 1..n {
        d[j] = update.pivot(z[j - r - 1], d[j]);
        for k in j + 1..n {
            let at = k * stride + j;
            l[at] = update.entry(&mut z[k - r - 1], l[at]);
        }
    }
    remove_row_col(l, n, stride, r)?;
    d.copy_within(r + 1..n, r);
    Ok(())
}
