//! Small dense blocks of 3 or 6 rows and columns, in quads.
//!
//! A block is stored by columns, each of [`stride`] numbers: six rows as they are, three with a zero after them, so that a column of either is
//! loaded as a quad, or a quad and a pair. Sums run in one fixed order. Sizes are constants to the compiler; [`by_sizes`] chooses among them.

use ferrode_math::simd::{Pair, Quad};

/// A vector of one body.
pub(crate) type Six = [f64; 6];
/// A block of two bodies.
pub(crate) type Block = [f64; 36];

/// Numbers that a column of so many rows takes.
pub(crate) const fn stride(rows: usize) -> usize {
    if rows == 3 { 4 } else { 6 }
}

/// Calls a kernel with constant sizes, each 3 or 6.
macro_rules! by_sizes {
    ($f:ident, $q:ident, [$r:expr], ($($x:expr),*)) => {
        if $r == 3 { $f::<$q, 3>($($x),*) } else { $f::<$q, 6>($($x),*) }
    };
    ($f:ident, $q:ident, [$r:expr, $c:expr], ($($x:expr),*)) => {
        match ($r, $c) {
            (3, 3) => $f::<$q, 3, 3>($($x),*),
            (3, _) => $f::<$q, 3, 6>($($x),*),
            (_, 3) => $f::<$q, 6, 3>($($x),*),
            _ => $f::<$q, 6, 6>($($x),*),
        }
    };
    ($f:ident, $q:ident, [$r:expr, $c:expr, $d:expr], ($($x:expr),*)) => {
        match ($r, $c, $d) {
            (3, 3, 3) => $f::<$q, 3, 3, 3>($($x),*),
            (3, 3, _) => $f::<$q, 3, 3, 6>($($x),*),
            (3, _, 3) => $f::<$q, 3, 6, 3>($($x),*),
            (3, _, _) => $f::<$q, 3, 6, 6>($($x),*),
            (_, 3, 3) => $f::<$q, 6, 3, 3>($($x),*),
            (_, 3, _) => $f::<$q, 6, 3, 6>($($x),*),
            (_, _, 3) => $f::<$q, 6, 6, 3>($($x),*),
            _ => $f::<$q, 6, 6, 6>($($x),*),
        }
    };
}
pub(crate) use by_sizes;

// What `run_quads` compiles for the machine is what is inlined into it: no closures, nor functions of the library that take any.

/// Four numbers of a slice from `at` on.
#[inline(always)]
pub(crate) fn quad<Q: Quad>(from: &[f64], at: usize) -> Q {
    match from[at..].first_chunk() {
        Some(from) => Q::load(from),
        None => Q::splat(0.0),
    }
}

/// Two numbers of a slice from `at` on.
#[inline(always)]
pub(crate) fn pair<Q: Quad>(from: &[f64], at: usize) -> Q::Pair {
    match from[at..].first_chunk() {
        Some(from) => Q::Pair::load(from),
        None => Q::Pair::splat(0.0),
    }
}

#[inline(always)]
pub(crate) fn store_quad<Q: Quad>(to: &mut [f64], at: usize, x: Q) {
    if let Some(to) = to[at..].first_chunk_mut() {
        x.store(to);
    }
}

#[inline(always)]
pub(crate) fn store_pair<Q: Quad>(to: &mut [f64], at: usize, x: Q::Pair) {
    if let Some(to) = to[at..].first_chunk_mut() {
        x.store(to);
    }
}

/// `R` numbers: three in the quad, whose fourth is 0, or six in both.
#[derive(Clone, Copy)]
pub(crate) struct Column<Q: Quad, const R: usize> {
    first: Q,
    last: Q::Pair,
}

impl<Q: Quad, const R: usize> Column<Q, R> {
    #[inline(always)]
    pub fn zero() -> Self {
        Self { first: Q::splat(0.0), last: Q::Pair::splat(0.0) }
    }

    #[inline(always)]
    pub fn load(from: &[f64]) -> Self {
        let last = if R == 6 { pair::<Q>(from, 4) } else { Q::Pair::splat(0.0) };
        Self { first: quad(from, 0), last }
    }

    #[inline(always)]
    pub fn store(self, to: &mut [f64]) {
        store_quad(to, 0, self.first);
        if R == 6 {
            store_pair::<Q>(to, 4, self.last);
        }
    }

    /// `self + s a`.
    #[inline(always)]
    pub fn plus(self, s: f64, a: Self) -> Self {
        let s = Q::splat(s);
        let last = if R == 6 { self.last + a.last * s.low() } else { self.last };
        Self { first: self.first + a.first * s, last }
    }

    /// `self - s a`.
    #[inline(always)]
    pub fn minus(self, s: f64, a: Self) -> Self {
        let s = Q::splat(s);
        let last = if R == 6 { self.last - a.last * s.low() } else { self.last };
        Self { first: self.first - a.first * s, last }
    }

    #[inline(always)]
    pub fn add(self, a: Self) -> Self {
        let last = if R == 6 { self.last + a.last } else { self.last };
        Self { first: self.first + a.first, last }
    }

    #[inline(always)]
    pub fn sub(self, a: Self) -> Self {
        let last = if R == 6 { self.last - a.last } else { self.last };
        Self { first: self.first - a.first, last }
    }

    /// `s self`.
    #[inline(always)]
    pub fn times(self, s: f64) -> Self {
        let s = Q::splat(s);
        let last = if R == 6 { self.last * s.low() } else { self.last };
        Self { first: self.first * s, last }
    }

    /// `b x`; `b` is R x C. Columns of even and odd number are summed apart, so that sums don't wait for each other.
    #[inline(always)]
    pub fn product<const C: usize>(b: &[f64], x: &[f64]) -> Self {
        let (b, x) = (&b[..stride(R) * C], &x[..C]);
        let mut even = Self::load(b).times(x[0]);
        let mut odd = Self::load(&b[stride(R)..]).times(x[1]);
        for c in 2..C {
            let sum = if c % 2 == 0 { &mut even } else { &mut odd };
            *sum = sum.plus(x[c], Self::load(&b[stride(R) * c..]));
        }
        even.add(odd)
    }

    /// `b^T x`; `b` is C x R.
    #[inline(always)]
    pub fn transposed_product<const C: usize>(b: &[f64], x: Column<Q, C>) -> Self {
        let b = &b[..stride(C) * R];
        let (nothing, none) = (Q::splat(0.0), Q::Pair::splat(0.0));
        if C == 3 {
            let x = x.first;
            let fourth = if R == 6 { quad::<Q>(b, 12) * x } else { nothing };
            let first = Q::sums([quad::<Q>(b, 0) * x, quad::<Q>(b, 4) * x, quad::<Q>(b, 8) * x, fourth]);
            let last = if R == 6 {
                Q::Pair::sums([(quad::<Q>(b, 16) * x).fold(), (quad::<Q>(b, 20) * x).fold()])
            } else {
                none
            };
            return Self { first, last };
        }
        // Two columns are three quads.
        let x = [x.first, Q::join(x.last, x.first.low()), Q::join(x.first.high(), x.last)];
        if R == 6 {
            Self { first: Q::join(two_dots(b, x), two_dots(&b[12..], x)), last: two_dots(&b[24..], x) }
        } else {
            let third = (quad::<Q>(b, 12) * x[0]).fold() + pair::<Q>(b, 16) * x[1].low();
            Self { first: Q::join(two_dots(b, x), Q::Pair::sums([third, none])), last: none }
        }
    }
}

/// The products of the first two columns of six with six numbers, given as `x₀ … x₅ x₀ … x₅`.
#[inline(always)]
fn two_dots<Q: Quad>(columns: &[f64], x: [Q; 3]) -> Q::Pair {
    let t0 = quad::<Q>(columns, 0) * x[0];
    let t1 = quad::<Q>(columns, 4) * x[1];
    let t2 = quad::<Q>(columns, 8) * x[2];
    Q::Pair::sums([t0.fold() + t1.low(), (t1.high() + t2.low()) + t2.high()])
}

/// `t -= sign a b^T`; `t` is R x C, `a` R x D, `b` C x D.
#[inline(always)]
pub(crate) fn sub_abt<Q: Quad, const R: usize, const C: usize, const D: usize>(
    t: &mut [f64],
    a: &[f64],
    b: &[f64],
    sign: f64,
) {
    let (t, a, b) = (&mut t[..stride(R) * C], &a[..stride(R) * D], &b[..stride(C) * D]);
    for c in 0..C {
        let mut sum = Column::<Q, R>::load(a).times(b[c]);
        for d in 1..D {
            sum = sum.plus(b[stride(C) * d + c], Column::load(&a[stride(R) * d..]));
        }
        let t = &mut t[stride(R) * c..];
        Column::<Q, R>::load(t).minus(sign, sum).store(t);
    }
}

/// `t -= sign a a^T`, at least its lower triangle; `t` is R x R, `a` R x D.
#[inline(always)]
pub(crate) fn sub_aat<Q: Quad, const R: usize, const D: usize>(t: &mut [f64], a: &[f64], sign: f64) {
    let (t, a) = (&mut t[..stride(R) * R], &a[..stride(R) * D]);
    for c in 0..R {
        if c >= 4 {
            // What is left of the triangle is in the last two rows.
            let mut sum = pair::<Q>(a, 4) * Q::Pair::splat(a[c]);
            for d in 1..D {
                sum = sum + pair::<Q>(a, 6 * d + 4) * Q::Pair::splat(a[6 * d + c]);
            }
            let x = pair::<Q>(t, 6 * c + 4) - sum * Q::Pair::splat(sign);
            store_pair::<Q>(t, 6 * c + 4, x);
            continue;
        }
        let mut sum = Column::<Q, R>::load(a).times(a[c]);
        for d in 1..D {
            sum = sum.plus(a[stride(R) * d + c], Column::load(&a[stride(R) * d..]));
        }
        let t = &mut t[stride(R) * c..];
        Column::<Q, R>::load(t).minus(sign, sum).store(t);
    }
}

/// `sign h = L L^T` in place, lower triangle; writes the rows of `L^-1`. A pivot that is not positive is replaced by 1; returns how
/// many were.
#[inline(always)]
pub(crate) fn cholesky<Q: Quad, const N: usize>(h: &mut [f64], inverse: &mut [f64], sign: f64) -> u32 {
    let s = stride(N);
    let (h, inverse) = (&mut h[..s * N], &mut inverse[..s * N]);
    // First h = V D^-1 V^T, V = L D^1/2: a column then waits for one division of the column before, and not for a root as well.
    let (mut replaced, mut pivots, mut over) = (0, [0.0; N], [0.0; N]);
    for c in 0..N {
        let mut column = Column::<Q, N>::load(&h[s * c..]).times(sign);
        for q in 0..c {
            column = column.minus(h[s * q + c] * over[q], Column::load(&h[s * q..]));
        }
        column.store(&mut h[s * c..]);
        let mut pivot = h[s * c + c];
        let positive = pivot > 0.0;
        if !positive {
            pivot = 1.0;
            replaced += 1;
        }
        (pivots[c], over[c]) = (pivot, 1.0 / pivot);
    }
    for c in 0..N {
        let root = pivots[c].sqrt();
        let inv = root * over[c];
        Column::<Q, N>::load(&h[s * c..]).times(inv).store(&mut h[s * c..]);
        h[s * c + c] = root;
        // Row c of the inverse, from the rows before it.
        let mut row = Column::<Q, N>::zero();
        for q in 0..c {
            row = row.minus(h[s * q + c], Column::load(&inverse[s * q..]));
        }
        row.times(inv).store(&mut inverse[s * c..]);
        inverse[s * c + c] = inv;
    }
    replaced
}

/// `x = x L^-T` for a lower triangle and the rows of its inverse, of which the diagonal is read; `x` is R x C. (By substitution: products with
/// the inverse would lose digits where the triangle is stiff.)
#[inline(always)]
pub(crate) fn solve_right<Q: Quad, const R: usize, const C: usize>(
    x: &mut [f64],
    l: &[f64],
    inverse: &[f64],
) {
    let (x, l, inverse) = (&mut x[..stride(R) * C], &l[..stride(C) * C], &inverse[..stride(C) * C]);
    for c in 0..C {
        let mut column = Column::<Q, R>::load(&x[stride(R) * c..]);
        for q in 0..c {
            column = column.minus(l[stride(C) * q + c], Column::load(&x[stride(R) * q..]));
        }
        column.times(inverse[stride(C) * c + c]).store(&mut x[stride(R) * c..]);
    }
}

/// `y -= sign b x`; `b` is R x C.
#[inline(always)]
pub(crate) fn sub_mul<Q: Quad, const R: usize, const C: usize>(
    y: &mut [f64],
    b: &[f64],
    x: &[f64],
    sign: f64,
) {
    Column::<Q, R>::load(y).minus(sign, Column::product::<C>(b, x)).store(y);
}

/// The dot product.
#[inline(always)]
pub(crate) fn dot(a: &Six, b: &Six) -> f64 {
    ((a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])) + (a[4] * b[4] + a[5] * b[5])
}
