//! Blocks of 6x6 numbers, stored by columns: entry (r, c) at `6 c + r`. Sums run in one fixed order.

/// A block.
pub(crate) type Block = [f64; 36];
/// A vector of one body.
pub(crate) type Six = [f64; 6];

/// `t -= a b^T`.
#[inline(always)]
pub(crate) fn sub_abt(t: &mut Block, a: &Block, b: &Block) {
    for c in 0..6 {
        let mut sum = [0.0; 6];
        for q in 0..6 {
            let s = b[6 * q + c];
            for r in 0..6 {
                sum[r] += a[6 * q + r] * s;
            }
        }
        for r in 0..6 {
            t[6 * c + r] -= sum[r];
        }
    }
}

/// `h = L L^T` in place, lower triangle; writes the inverses of the diagonal. A pivot that is not positive is replaced by `least`;
/// returns how many were.
#[inline(always)]
pub(crate) fn cholesky(h: &mut Block, inverse: &mut Six, least: f64) -> u32 {
    let mut replaced = 0;
    for c in 0..6 {
        for q in 0..c {
            let s = h[6 * q + c];
            for r in c..6 {
                h[6 * c + r] -= h[6 * q + r] * s;
            }
        }
        let mut pivot = h[6 * c + c];
        let positive = pivot > 0.0;
        if !positive {
            pivot = least;
            replaced += 1;
        }
        let root = pivot.sqrt();
        let inv = 1.0 / root;
        h[6 * c + c] = root;
        inverse[c] = inv;
        for r in c + 1..6 {
            h[6 * c + r] *= inv;
        }
    }
    replaced
}

/// `x = x L^-T` for a lower triangle with the inverses of its diagonal.
#[inline(always)]
pub(crate) fn solve_right(x: &mut Block, l: &Block, inverse: &Six) {
    for c in 0..6 {
        let mut column = [0.0; 6];
        column.copy_from_slice(&x[6 * c..6 * c + 6]);
        for q in 0..c {
            let s = l[6 * q + c];
            for r in 0..6 {
                column[r] -= x[6 * q + r] * s;
            }
        }
        for r in 0..6 {
            x[6 * c + r] = column[r] * inverse[c];
        }
    }
}

/// `x = L^-1 x`.
#[inline(always)]
pub(crate) fn forward(x: &mut Six, l: &Block, inverse: &Six) {
    for c in 0..6 {
        let s = x[c] * inverse[c];
        x[c] = s;
        for r in c + 1..6 {
            x[r] -= l[6 * c + r] * s;
        }
    }
}

/// `x = L^-T x`.
#[inline(always)]
pub(crate) fn backward(x: &mut Six, l: &Block, inverse: &Six) {
    for c in (0..6).rev() {
        let mut s = x[c];
        for r in c + 1..6 {
            s -= l[6 * c + r] * x[r];
        }
        x[c] = s * inverse[c];
    }
}

/// `y -= b x`.
#[inline(always)]
pub(crate) fn sub_mul(y: &mut Six, b: &Block, x: &Six) {
    for c in 0..6 {
        for r in 0..6 {
            y[r] -= b[6 * c + r] * x[c];
        }
    }
}

/// `y -= b^T x`.
#[inline(always)]
pub(crate) fn sub_mul_transposed(y: &mut Six, b: &Block, x: &Six) {
    for c in 0..6 {
        y[c] -= dot(&[b[6 * c], b[6 * c + 1], b[6 * c + 2], b[6 * c + 3], b[6 * c + 4], b[6 * c + 5]], x);
    }
}

/// `t += s u v^T`.
#[inline(always)]
pub(crate) fn add_outer(t: &mut Block, s: f64, u: &Six, v: &Six) {
    for c in 0..6 {
        let sv = s * v[c];
        for r in 0..6 {
            t[6 * c + r] += u[r] * sv;
        }
    }
}

/// The dot product.
#[inline(always)]
pub(crate) fn dot(a: &Six, b: &Six) -> f64 {
    ((a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])) + (a[4] * b[4] + a[5] * b[5])
}

/// `y += s a`.
#[inline(always)]
pub(crate) fn add_scaled(y: &mut Six, s: f64, a: &Six) {
    for r in 0..6 {
        y[r] += s * a[r];
    }
}
