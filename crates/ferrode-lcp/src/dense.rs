//! Dense vectors and matrices on plain slices, as ODE's public matrix functions have them.
//!
//! A matrix is row-major with a leading dimension ("stride": the distance between the starts of two rows). The product
//! functions take [`pad`] of the number of columns as the leading dimension; the factorisations of the neighbouring
//! modules take it as an argument. Only the padding of the last row may be missing from a slice.

use crate::error::{LcpError, check_len, check_matrix};
use crate::kernel;

/// The leading dimension of a matrix with `k` columns: 0 and 1 stay as they are, others go up to a multiple of 4.
#[must_use]
pub const fn pad(k: usize) -> usize {
    if k > 1 { k.div_ceil(4) * 4 } else { k }
}

/// Sets the first `n` numbers of `a` to zero.
///
/// # Errors
/// If `a` is shorter than `n`.
pub fn set_zero(a: &mut [f64], n: usize) -> Result<(), LcpError> {
    set_value(a, n, 0.0)
}

/// Sets the first `n` numbers of `a` to `value`.
///
/// # Errors
/// If `a` is shorter than `n`.
pub fn set_value(a: &mut [f64], n: usize, value: f64) -> Result<(), LcpError> {
    check_len("a", a.len(), n)?;
    a[..n].fill(value);
    Ok(())
}

/// The dot product of the first `n` numbers of `a` and `b`; 0 for `n` = 0.
///
/// # Errors
/// If `a` or `b` is shorter than `n`.
pub fn dot(a: &[f64], b: &[f64], n: usize) -> Result<f64, LcpError> {
    check_len("a", a.len(), n)?;
    check_len("b", b.len(), n)?;
    Ok(kernel::dot(&a[..n], &b[..n]))
}

/// `a_i *= d_i` for the first `n` numbers.
///
/// # Errors
/// If `a` or `d` is shorter than `n`.
pub fn scale_vector(a: &mut [f64], d: &[f64], n: usize) -> Result<(), LcpError> {
    check_len("a", a.len(), n)?;
    check_len("d", d.len(), n)?;
    for (a, d) in a[..n].iter_mut().zip(d) {
        *a *= d;
    }
    Ok(())
}

/// `A = B C` for `A` p x r, `B` p x q and `C` q x r, each with its padded leading dimension. Padding is not written.
///
/// # Errors
/// If a slice is too short for its matrix.
pub fn multiply0(a: &mut [f64], b: &[f64], c: &[f64], p: usize, q: usize, r: usize) -> Result<(), LcpError> {
    let (a_stride, b_stride, c_stride) = (pad(r), pad(q), pad(r));
    check_matrix("a", a.len(), p, r, a_stride)?;
    check_matrix("b", b.len(), p, q, b_stride)?;
    check_matrix("c", c.len(), q, r, c_stride)?;
    if r == 0 {
        return Ok(());
    }
    for i in 0..p {
        let row = &mut a[i * a_stride..][..r];
        row.fill(0.0);
        for k in 0..q {
            kernel::add_scaled(row, b[i * b_stride + k], &c[k * c_stride..][..r]);
        }
    }
    Ok(())
}

/// `A = B^T C` for `A` p x r, `B` q x p and `C` q x r, each with its padded leading dimension. Padding is not written.
///
/// # Errors
/// If a slice is too short for its matrix.
pub fn multiply1(a: &mut [f64], b: &[f64], c: &[f64], p: usize, q: usize, r: usize) -> Result<(), LcpError> {
    let (a_stride, b_stride, c_stride) = (pad(r), pad(p), pad(r));
    check_matrix("a", a.len(), p, r, a_stride)?;
    check_matrix("b", b.len(), q, p, b_stride)?;
    check_matrix("c", c.len(), q, r, c_stride)?;
    if r == 0 {
        return Ok(());
    }
    for i in 0..p {
        let row = &mut a[i * a_stride..][..r];
        row.fill(0.0);
        for k in 0..q {
            kernel::add_scaled(row, b[k * b_stride + i], &c[k * c_stride..][..r]);
        }
    }
    Ok(())
}

/// `A = B C^T` for `A` p x r, `B` p x q and `C` r x q, each with its padded leading dimension. Padding is not written.
///
/// # Errors
/// If a slice is too short for its matrix.
pub fn multiply2(a: &mut [f64], b: &[f64], c: &[f64], p: usize, q: usize, r: usize) -> Result<(), LcpError> {
    let (a_stride, b_stride, c_stride) = (pad(r), pad(q), pad(q));
    check_matrix("a", a.len(), p, r, a_stride)?;
    check_matrix("b", b.len(), p, q, b_stride)?;
    check_matrix("c", c.len(), r, q, c_stride)?;
    for i in 0..p {
        for j in 0..r {
            a[i * a_stride + j] =
                if q == 0 { 0.0 } else { kernel::dot(&b[i * b_stride..][..q], &c[j * c_stride..][..q]) };
        }
    }
    Ok(())
}

/// Takes row and column `r` out of the `n` x `n` matrix `a`: what lies below and to the right moves up and left.
///
/// # Errors
/// If `a` is too short, or `r` is not below `n`.
pub fn remove_row_col(a: &mut [f64], n: usize, stride: usize, r: usize) -> Result<(), LcpError> {
    check_matrix("a", a.len(), n, n, stride)?;
    if r >= n {
        return Err(LcpError::Index { what: "r", index: r, end: n });
    }
    for i in (0..n).filter(|&i| i != r) {
        let (from, to) = (i * stride, if i > r { i - 1 } else { i } * stride);
        a.copy_within(from..from + r, to);
        a.copy_within(from + r + 1..from + n, to + r);
    }
    Ok(())
}

/// Sets everything above the diagonal of the `n` x `n` matrix `a` (leading dimension `pad(n)`) to zero.
///
/// # Errors
/// If `a` is too short.
pub fn clear_upper_triangle(a: &mut [f64], n: usize) -> Result<(), LcpError> {
    let stride = pad(n);
    check_matrix("a", a.len(), n, n, stride)?;
    for i in 0..n {
        a[i * stride + i + 1..i * stride + n].fill(0.0);
    }
    Ok(())
}

/// The largest absolute difference between entries of two `n` x `m` matrices (leading dimension `pad(m)`).
///
/// # Errors
/// If `a` or `b` is too short.
pub fn max_difference(a: &[f64], b: &[f64], n: usize, m: usize) -> Result<f64, LcpError> {
    max_difference_of(a, b, n, m, |_| m)
}

/// The largest absolute difference between the lower triangles, diagonals included, of two `n` x `n` matrices
/// (leading dimension `pad(n)`).
///
/// # Errors
/// If `a` or `b` is too short.
pub fn max_difference_lower_triangle(a: &[f64], b: &[f64], n: usize) -> Result<f64, LcpError> {
    max_difference_of(a, b, n, n, |i| i + 1)
}

fn max_difference_of(
    a: &[f64],
    b: &[f64],
    n: usize,
    m: usize,
    columns: impl Fn(usize) -> usize,
) -> Result<f64, LcpError> {
    let stride = pad(m);
    check_matrix("a", a.len(), n, m, stride)?;
    check_matrix("b", b.len(), n, m, stride)?;
    let mut largest = 0.0;
    if m == 0 {
        return Ok(largest);
    }
    for i in 0..n {
        let at = i * stride;
        for (x, y) in a[at..].iter().zip(&b[at..]).take(columns(i)) {
            let difference = (x - y).abs();
            if difference > largest {
                largest = difference;
            }
        }
    }
    Ok(largest)
}
