//! Small dense blocks of several islands, a lane for each: the kernels of [`super::super::kernels`] and [`super::super::rows`] once more,
//! with the sums in the same order.

use super::super::kernels::stride;
use ferrode_math::simd::Lanes64;

// Where a loop's bounds depend on the column, columns are constants to the compiler: only then are sums kept in registers.

/// Calls a kernel for each of three or six columns in turn.
macro_rules! each_column {
    ($n:expr, $f:ident, [$($size:tt),*], $x:tt) => {
        $f::<$($size,)* 0> $x;
        $f::<$($size,)* 1> $x;
        $f::<$($size,)* 2> $x;
        if $n == 6 {
            $f::<$($size,)* 3> $x;
            $f::<$($size,)* 4> $x;
            $f::<$($size,)* 5> $x;
        }
    };
}

/// The twelve numbers of a row, six for each of its bodies.
pub(super) type Row<B> = [B; 12];

/// `a` where `x` is larger than zero, else `b`.
#[inline(always)]
pub(super) fn where_positive<Q: Lanes64>(x: Q, a: Q, b: Q) -> Q {
    Q::select(Q::ZERO.lt(x), a, b)
}

/// `R` numbers of a vector.
#[inline(always)]
pub(super) fn load<Q: Lanes64, const R: usize>(from: &[Q::Block]) -> [Q; R] {
    let from = &from[..R];
    let mut out = [Q::splat(0.0); R];
    for r in 0..R {
        out[r] = Q::load(&from[r]);
    }
    out
}

#[inline(always)]
pub(super) fn store<Q: Lanes64, const R: usize>(x: [Q; R], to: &mut [Q::Block]) {
    let to = &mut to[..R];
    for r in 0..R {
        x[r].store(&mut to[r]);
    }
}

/// `to += x`.
#[inline(always)]
pub(super) fn add<Q: Lanes64, const R: usize>(x: [Q; R], to: &mut [Q::Block]) {
    let to = &mut to[..R];
    for r in 0..R {
        (Q::load(&to[r]) + x[r]).store(&mut to[r]);
    }
}

/// Even and odd ones apart.
#[inline(always)]
fn sum_of_six<Q: Lanes64>(p: [Q; 6]) -> Q {
    ((p[0] + p[2]) + p[4]) + ((p[1] + p[3]) + p[5])
}

/// The product of the numbers with that place of a row and of what is there for two bodies.
#[inline(always)]
fn term<Q: Lanes64>(row: &Row<Q::Block>, y: &[Q; 12], i: usize) -> Q {
    Q::load(&row[i]) * y[i]
}

/// The terms of the product of two rows, or of what is there for two bodies and a row, that are summed at last.
#[inline(always)]
pub(super) fn terms<Q: Lanes64>(row: &Row<Q::Block>, y: &[Q; 12], sides: [bool; 2]) -> [Q; 4] {
    let mut terms = [Q::splat(0.0); 4];
    match sides {
        [true, true] => {
            for (l, out) in terms.iter_mut().enumerate() {
                *out = (term(row, y, l) + term(row, y, 4 + l)) + term(row, y, 8 + l);
            }
        }
        [true, false] => {
            for l in 0..2 {
                terms[l] = term(row, y, l) + term(row, y, 4 + l);
                terms[2 + l] = term(row, y, 2 + l);
            }
        }
        [false, true] => {
            for l in 0..2 {
                terms[l] = term(row, y, 8 + l);
                terms[2 + l] = term(row, y, 6 + l) + term(row, y, 10 + l);
            }
        }
        [false, false] => {}
    }
    terms
}

/// Their sum, in the order of `Quad::sums`.
#[inline(always)]
pub(super) fn sum<Q: Lanes64>(t: [Q; 4]) -> Q {
    (t[0] + t[1]) + (t[2] + t[3])
}

/// Their sum, in the order of `Quad::fold` and `Pair::sum`.
#[inline(always)]
pub(super) fn folded_sum<Q: Lanes64>(t: [Q; 4]) -> Q {
    (t[0] + t[2]) + (t[1] + t[3])
}

/// `sum += s row`.
#[inline(always)]
pub(super) fn plus_row<Q: Lanes64>(sum: &mut [Q; 12], s: Q, row: &Row<Q::Block>) {
    for i in 0..12 {
        sum[i] += Q::load(&row[i]) * s;
    }
}

/// `out -= A A^T` for the parts of rows `A` that act on the bodies told by `sides`: the lower triangle; `out` has `H` rows.
#[inline(always)]
pub(super) fn sub_square<Q: Lanes64, const H: usize>(
    out: &mut [Q::Block],
    rows: &[Row<Q::Block>],
    sides: [bool; 2],
) {
    let out = &mut out[..stride(H) * H];
    match sides {
        [true, true] => sub_square_of::<Q, H>(out, rows, [true, true]),
        [true, false] => sub_square_of::<Q, H>(out, rows, [true, false]),
        [false, true] => sub_square_of::<Q, H>(out, rows, [false, true]),
        [false, false] => {}
    }
}

#[inline(always)]
fn sub_square_of<Q: Lanes64, const H: usize>(out: &mut [Q::Block], rows: &[Row<Q::Block>], sides: [bool; 2]) {
    for (c, with) in rows.iter().take(H).enumerate() {
        let with = load::<Q, 12>(with);
        for (r, row) in rows.iter().take(H).enumerate().skip(c) {
            let terms = terms(row, &with, sides);
            let product = if r < 4 { sum(terms) } else { folded_sum(terms) };
            let out = &mut out[stride(H) * c + r];
            (Q::load(out) - product).store(out);
        }
    }
}

/// `out -= A B^T` for the parts of rows `A` and `B` that act on one body; `out` has `H` rows.
#[inline(always)]
pub(super) fn sub_product<Q: Lanes64, const H: usize>(
    out: &mut [Q::Block],
    (a, s): (&[Row<Q::Block>], usize),
    (b, t): (&[Row<Q::Block>], usize),
) {
    for (out, with) in out.chunks_exact_mut(stride(H)).zip(b) {
        let with = load::<Q, 6>(&with[6 * t..]);
        for (r, row) in a.iter().take(H).enumerate() {
            let mut p = load::<Q, 6>(&row[6 * s..]);
            for i in 0..6 {
                p[i] *= with[i];
            }
            let product = if r < 4 { ((p[0] + p[1]) + (p[2] + p[3])) + (p[4] + p[5]) } else { sum_of_six(p) };
            (Q::load(&out[r]) - product).store(&mut out[r]);
        }
    }
}

/// `t -= sign a a^T`, the lower triangle; `t` is R x R, `a` R x D.
#[inline(always)]
pub(super) fn sub_aat<Q: Lanes64, const R: usize, const D: usize>(
    t: &mut [Q::Block],
    a: &[Q::Block],
    sign: f64,
) {
    let (t, a) = (&mut t[..stride(R) * R], &a[..stride(R) * D]);
    let sign = Q::splat(sign);
    each_column!(R, aat_column, [Q, R, D], (t, a, sign));
}

#[inline(always)]
fn aat_column<Q: Lanes64, const R: usize, const D: usize, const C: usize>(
    t: &mut [Q::Block],
    a: &[Q::Block],
    sign: Q,
) {
    let with = Q::load(&a[C]);
    let mut sum = [Q::splat(0.0); R];
    for r in C..R {
        sum[r] = Q::load(&a[r]) * with;
    }
    for d in 1..D {
        let with = Q::load(&a[stride(R) * d + C]);
        for r in C..R {
            sum[r] += Q::load(&a[stride(R) * d + r]) * with;
        }
    }
    for r in C..R {
        let t = &mut t[stride(R) * C + r];
        (Q::load(t) - sum[r] * sign).store(t);
    }
}

/// `t -= sign a b^T`; `t` is R x C, `a` R x D, `b` C x D.
#[inline(always)]
pub(super) fn sub_abt<Q: Lanes64, const R: usize, const C: usize, const D: usize>(
    t: &mut [Q::Block],
    a: &[Q::Block],
    b: &[Q::Block],
    sign: f64,
) {
    let (t, a, b) = (&mut t[..stride(R) * C], &a[..stride(R) * D], &b[..stride(C) * D]);
    let sign = Q::splat(sign);
    for c in 0..C {
        let with = Q::load(&b[c]);
        let mut sum = load::<Q, R>(a);
        for sum in &mut sum {
            *sum *= with;
        }
        for d in 1..D {
            let with = Q::load(&b[stride(C) * d + c]);
            let a = &a[stride(R) * d..][..R];
            for r in 0..R {
                sum[r] += Q::load(&a[r]) * with;
            }
        }
        let t = &mut t[stride(R) * c..][..R];
        for r in 0..R {
            (Q::load(&t[r]) - sum[r] * sign).store(&mut t[r]);
        }
    }
}

/// `sign h = L L^T` in place, lower triangle; writes the rows of `L^-1`, without the zeros. A pivot that is not positive is replaced by 1.
#[inline(always)]
pub(super) fn cholesky<Q: Lanes64, const N: usize>(h: &mut [Q::Block], inverse: &mut [Q::Block], sign: f64) {
    let (h, inverse) = (&mut h[..stride(N) * N], &mut inverse[..stride(N) * N]);
    let (sign, one) = (Q::splat(sign), Q::splat(1.0));
    let (mut pivots, mut over) = ([one; N], [one; N]);
    each_column!(N, eliminate, [Q, N], (h, &mut pivots, &mut over, sign));
    each_column!(N, finish, [Q, N], (h, inverse, &pivots, &over));
}

/// Column C of `V` in `h = V D^-1 V^T`.
#[inline(always)]
fn eliminate<Q: Lanes64, const N: usize, const C: usize>(
    h: &mut [Q::Block],
    pivots: &mut [Q; N],
    over: &mut [Q; N],
    sign: Q,
) {
    let (s, one) = (stride(N), Q::splat(1.0));
    let mut column = [one; N];
    for r in C..N {
        column[r] = Q::load(&h[s * C + r]) * sign;
    }
    for q in 0..C {
        let factor = Q::load(&h[s * q + C]) * over[q];
        for r in C..N {
            column[r] -= Q::load(&h[s * q + r]) * factor;
        }
    }
    for r in C..N {
        column[r].store(&mut h[s * C + r]);
    }
    pivots[C] = where_positive(column[C], column[C], one);
    over[C] = one / pivots[C];
}

/// Column C of `L`, and row C of its inverse.
#[inline(always)]
fn finish<Q: Lanes64, const N: usize, const C: usize>(
    h: &mut [Q::Block],
    inverse: &mut [Q::Block],
    pivots: &[Q; N],
    over: &[Q; N],
) {
    let s = stride(N);
    let root = pivots[C].sqrt();
    let inv = root * over[C];
    root.store(&mut h[s * C + C]);
    for r in C + 1..N {
        let h = &mut h[s * C + r];
        (Q::load(h) * inv).store(h);
    }
    let mut row = [Q::splat(0.0); N];
    for q in 0..C {
        let factor = Q::load(&h[s * q + C]);
        for k in 0..C {
            if k <= q {
                row[k] -= Q::load(&inverse[s * q + k]) * factor;
            }
        }
    }
    for k in 0..C {
        (row[k] * inv).store(&mut inverse[s * C + k]);
    }
    inv.store(&mut inverse[s * C + C]);
}

/// `x = x L^-T` for a lower triangle and the rows of its inverse, of which the diagonal is read; `x` is R x C.
#[inline(always)]
pub(super) fn solve_right<Q: Lanes64, const R: usize, const C: usize>(
    x: &mut [Q::Block],
    l: &[Q::Block],
    inverse: &[Q::Block],
) {
    let (x, l, inverse) = (&mut x[..stride(R) * C], &l[..stride(C) * C], &inverse[..stride(C) * C]);
    each_column!(C, solve_column, [Q, R, C], (x, l, inverse));
}

#[inline(always)]
fn solve_column<Q: Lanes64, const R: usize, const N: usize, const C: usize>(
    x: &mut [Q::Block],
    l: &[Q::Block],
    inverse: &[Q::Block],
) {
    let mut column = load::<Q, R>(&x[stride(R) * C..]);
    for q in 0..C {
        let factor = Q::load(&l[stride(N) * q + C]);
        for r in 0..R {
            column[r] -= Q::load(&x[stride(R) * q + r]) * factor;
        }
    }
    let inv = Q::load(&inverse[stride(N) * C + C]);
    for x in &mut column {
        *x *= inv;
    }
    store(column, &mut x[stride(R) * C..]);
}

/// `y -= sign b x`; `b` is R x C.
#[inline(always)]
pub(super) fn sub_mul<Q: Lanes64, const R: usize, const C: usize>(
    y: &mut [Q::Block],
    b: &[Q::Block],
    x: &[Q; C],
    sign: f64,
) {
    let b = &b[..stride(R) * C];
    let (mut even, mut odd) = ([Q::splat(0.0); R], [Q::splat(0.0); R]);
    for r in 0..R {
        even[r] = Q::load(&b[r]) * x[0];
        odd[r] = Q::load(&b[stride(R) + r]) * x[1];
    }
    for pair in 1..C.div_ceil(2) {
        let c = 2 * pair;
        for r in 0..R {
            even[r] += Q::load(&b[stride(R) * c + r]) * x[c];
            if c + 1 < C {
                odd[r] += Q::load(&b[stride(R) * (c + 1) + r]) * x[c + 1];
            }
        }
    }
    let (y, sign) = (&mut y[..R], Q::splat(sign));
    for r in 0..R {
        (Q::load(&y[r]) - (even[r] + odd[r]) * sign).store(&mut y[r]);
    }
}

/// `y -= b^T x`; `b` is C x R.
#[inline(always)]
pub(super) fn sub_transposed<Q: Lanes64, const R: usize, const C: usize>(
    y: &mut [Q; R],
    b: &[Q::Block],
    x: &[Q::Block],
) {
    let (b, x) = (&b[..stride(C) * R], load::<Q, C>(x));
    for r in 0..R {
        let mut p = [Q::splat(0.0); 6];
        for c in 0..C {
            p[c] = Q::load(&b[stride(C) * r + c]) * x[c];
        }
        let product = if C == 3 && r < 4 { (p[0] + p[1]) + p[2] } else { sum_of_six(p) };
        y[r] -= product;
    }
}

/// `x = L^-1 x`, given the rows of the inverse.
#[inline(always)]
pub(super) fn forward<Q: Lanes64, const N: usize>(inverse: &[Q::Block], x: [Q; N]) -> [Q; N] {
    let inverse = &inverse[..stride(N) * N];
    let mut out = x;
    each_column!(N, forward_row, [Q, N], (inverse, &x, &mut out));
    out
}

#[inline(always)]
fn forward_row<Q: Lanes64, const N: usize, const R: usize>(
    inverse: &[Q::Block],
    x: &[Q; N],
    out: &mut [Q; N],
) {
    let mut p = [Q::splat(0.0); 6];
    for c in 0..R + 1 {
        p[c] = Q::load(&inverse[stride(N) * R + c]) * x[c];
    }
    out[R] = if N == 3 { (p[0] + p[1]) + p[2] } else { sum_of_six(p) };
}

/// `x = L^-T x`, given the rows of the inverse.
#[inline(always)]
pub(super) fn back<Q: Lanes64, const N: usize>(inverse: &[Q::Block], x: [Q; N]) -> [Q; N] {
    let inverse = &inverse[..stride(N) * N];
    let mut out = x;
    each_column!(N, back_row, [Q, N], (inverse, &x, &mut out));
    out
}

#[inline(always)]
fn back_row<Q: Lanes64, const N: usize, const R: usize>(inverse: &[Q::Block], x: &[Q; N], out: &mut [Q; N]) {
    let mut p = [Q::splat(0.0); 6];
    for c in R..N {
        p[c] = Q::load(&inverse[stride(N) * c + R]) * x[c];
    }
    out[R] = sum_of_six(p);
}
