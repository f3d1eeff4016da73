//! Small dense blocks of 3 or 6 rows and columns, stored by columns: entry (r, c) of a block of R rows at `R c + r`.
//! Sums run in one fixed order. Sizes are constants to the compiler; [`by_sizes`] chooses among them.

/// A vector of one body.
pub(crate) type Six = [f64; 6];
/// A block of two bodies.
pub(crate) type Block = [f64; 36];

/// Calls a kernel with constant sizes, each 3 or 6.
macro_rules! by_sizes {
    ($f:ident, [$r:expr], ($($x:expr),*)) => {
        if $r == 3 { $f::<3>($($x),*) } else { $f::<6>($($x),*) }
    };
    ($f:ident, [$r:expr, $c:expr], ($($x:expr),*)) => {
        match ($r, $c) {
            (3, 3) => $f::<3, 3>($($x),*),
            (3, _) => $f::<3, 6>($($x),*),
            (_, 3) => $f::<6, 3>($($x),*),
            _ => $f::<6, 6>($($x),*),
        }
    };
    ($f:ident, [$r:expr, $c:expr, $q:expr], ($($x:expr),*)) => {
        match ($r, $c, $q) {
            (3, 3, 3) => $f::<3, 3, 3>($($x),*),
            (3, 3, _) => $f::<3, 3, 6>($($x),*),
            (3, _, 3) => $f::<3, 6, 3>($($x),*),
            (3, _, _) => $f::<3, 6, 6>($($x),*),
            (_, 3, 3) => $f::<6, 3, 3>($($x),*),
            (_, 3, _) => $f::<6, 3, 6>($($x),*),
            (_, _, 3) => $f::<6, 6, 3>($($x),*),
            _ => $f::<6, 6, 6>($($x),*),
        }
    };
}
pub(crate) use by_sizes;

/// `t -= sign a b^T`; `t` is R x C, `a` R x Q, `b` C x Q.
#[inline(always)]
pub(crate) fn sub_abt<const R: usize, const C: usize, const Q: usize>(
    t: &mut [f64],
    a: &[f64],
    b: &[f64],
    sign: f64,
) {
    let (t, a, b) = (&mut t[..R * C], &a[..R * Q], &b[..C * Q]);
    for c in 0..C {
        let mut sum = [0.0; R];
        for q in 0..Q {
            let s = b[C * q + c];
            for r in 0..R {
                sum[r] += a[R * q + r] * s;
            }
        }
        for r in 0..R {
            t[R * c + r] -= sign * sum[r];
        }
    }
}

/// `t -= sign a a^T`, at least its lower triangle; `t` is R x R, `a` R x Q.
#[inline(always)]
pub(crate) fn sub_aat<const R: usize, const Q: usize>(t: &mut [f64], a: &[f64], sign: f64) {
    let (t, a) = (&mut t[..R * R], &a[..R * Q]);
    for c in 0..R {
        // From an even row on, so that pairs stay whole.
        let first = if R == 6 { c & !1 } else { c };
        let mut sum = [0.0; R];
        for q in 0..Q {
            let s = a[R * q + c];
            for r in first..R {
                sum[r] += a[R * q + r] * s;
            }
        }
        for r in first..R {
            t[R * c + r] -= sign * sum[r];
        }
    }
}

/// `sign h = L L^T` in place, lower triangle; writes the inverses of the diagonal. A pivot that is not positive is replaced by 1;
/// returns how many were.
#[inline(always)]
pub(crate) fn cholesky<const N: usize>(h: &mut [f64], inverse: &mut [f64], sign: f64) -> u32 {
    let (h, inverse) = (&mut h[..N * N], &mut inverse[..N]);
    let mut replaced = 0;
    for c in 0..N {
        let mut column = [0.0; N];
        for r in c..N {
            column[r] = sign * h[N * c + r];
        }
        for q in 0..c {
            let s = h[N * q + c];
            for r in c..N {
                column[r] -= h[N * q + r] * s;
            }
        }
        let mut pivot = column[c];
        let positive = pivot > 0.0;
        if !positive {
            pivot = 1.0;
            replaced += 1;
        }
        let root = pivot.sqrt();
        let inv = 1.0 / root;
        h[N * c + c] = root;
        inverse[c] = inv;
        for r in c + 1..N {
            h[N * c + r] = column[r] * inv;
        }
    }
    replaced
}

/// `x = x L^-T` for a lower triangle with the inverses of its diagonal; `x` is R x C.
#[inline(always)]
pub(crate) fn solve_right<const R: usize, const C: usize>(x: &mut [f64], l: &[f64], inverse: &[f64]) {
    let (x, l, inverse) = (&mut x[..R * C], &l[..C * C], &inverse[..C]);
    for c in 0..C {
        let mut column = [0.0; R];
        for r in 0..R {
            column[r] = x[R * c + r];
        }
        for q in 0..c {
            let s = l[C * q + c];
            for r in 0..R {
                column[r] -= x[R * q + r] * s;
            }
        }
        for r in 0..R {
            x[R * c + r] = column[r] * inverse[c];
        }
    }
}

/// `x = L^-1 x`.
#[inline(always)]
pub(crate) fn forward<const N: usize>(x: &mut [f64], l: &[f64], inverse: &[f64]) {
    let (x, l, inverse) = (&mut x[..N], &l[..N * N], &inverse[..N]);
    for c in 0..N {
        let s = x[c] * inverse[c];
        x[c] = s;
        for r in c + 1..N {
            x[r] -= l[N * c + r] * s;
        }
    }
}

/// `x = sign L^-T x`.
#[inline(always)]
pub(crate) fn backward<const N: usize>(x: &mut [f64], l: &[f64], inverse: &[f64], sign: f64) {
    let (x, l, inverse) = (&mut x[..N], &l[..N * N], &inverse[..N]);
    for c in (0..N).rev() {
        let mut s = sign * x[c];
        for r in c + 1..N {
            s -= l[N * c + r] * x[r];
        }
        x[c] = s * inverse[c];
    }
}

/// `y -= sign b x`; `b` is R x C.
#[inline(always)]
pub(crate) fn sub_mul<const R: usize, const C: usize>(y: &mut [f64], b: &[f64], x: &[f64], sign: f64) {
    let (y, b, x) = (&mut y[..R], &b[..R * C], &x[..C]);
    let mut sum = [0.0; R];
    for c in 0..C {
        for r in 0..R {
            sum[r] += b[R * c + r] * x[c];
        }
    }
    for r in 0..R {
        y[r] -= sign * sum[r];
    }
}

/// `y -= b^T x`; `b` is R x C.
#[inline(always)]
pub(crate) fn sub_mul_transposed<const R: usize, const C: usize>(y: &mut [f64], b: &[f64], x: &[f64]) {
    let (y, b, x) = (&mut y[..C], &b[..R * C], &x[..R]);
    for c in 0..C {
        let (mut even, mut odd) = (0.0, 0.0);
        for r in 0..R {
            let product = b[R * c + r] * x[r];
            if r % 2 == 0 { even += product } else { odd += product }
        }
        y[c] -= even + odd;
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
