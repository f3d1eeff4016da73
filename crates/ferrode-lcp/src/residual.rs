//! How far an answer is from solving the problem.
//!
//! `x` solves the boxed problem with bounds lo, hi exactly when `x = proj(x - t w)` for any one t > 0, where `w = A x - b`
//! and proj clamps to the bounds. The natural residual takes, per row, `t_i = 1 / A_ii` (so that both terms have the units of `x`) and
//! reports the largest `|x_i - proj(x_i - w_i / A_ii)|`. (J.-S. Pang, "Error bounds in mathematical programming", 1997.)

use crate::error::{LcpError, check_len, check_matrix};

/// The natural residual of one row.
#[inline(always)]
#[must_use]
pub fn row_residual(x: f64, w: f64, diagonal: f64, lo: f64, hi: f64) -> f64 {
    let moved = if w == 0.0 { x } else { x - w / diagonal };
    let projected = if moved < lo {
        lo
    } else if moved > hi {
        hi
    } else {
        moved
    };
    (x - projected).abs()
}

/// The natural residual of `x` for a dense symmetric `A` (lower triangle read, leading dimension `stride`), right-hand side `b` and
/// the bounds in force (for friction rows the frozen ones). `w` is computed afresh from `x`. Not a number if any number is not.
///
/// # Errors
/// If a slice is too short.
pub fn natural_residual(
    a: &[f64],
    stride: usize,
    b: &[f64],
    lo: &[f64],
    hi: &[f64],
    x: &[f64],
) -> Result<f64, LcpError> {
    let n = x.len();
    check_matrix("a", a.len(), n, n, stride)?;
    check_len("b", b.len(), n)?;
    check_len("lo", lo.len(), n)?;
    check_len("hi", hi.len(), n)?;
    let mut w: Vec<f64> = b[..n].iter().map(|b| -b).collect();
    for i in 0..n {
        let row = &a[i * stride..][..=i];
        for j in 0..i {
            w[i] += row[j] * x[j];
            w[j] += row[j] * x[i];
        }
        w[i] += row[i] * x[i];
    }
    let mut largest = 0.0;
    for i in 0..n {
        let residual = row_residual(x[i], w[i], a[i * stride + i], lo[i], hi[i]);
        if residual > largest || residual.is_nan() {
            largest = residual;
        }
        if residual.is_nan() {
            break;
        }
    }
    Ok(largest)
}
