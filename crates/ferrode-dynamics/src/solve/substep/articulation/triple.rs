//! Vectors of three lanes' numbers. Functions rather than operators, since these must be inlined into the kernels.

use ferrode_math::simd::Lanes;

/// Rounds numbers to multiples of about 10⁻⁷ of `unit`; larger ones by a unit in the last place at most.
///
/// In motion that is nearly plane, and down a long chain, numbers fade until products of them are denormal, with which processors compute a hundred times as
/// slowly. What is as small as that is noise.
#[inline(always)]
pub(super) fn without_trifles<L: Lanes>(x: &[L; 3], unit: L) -> [L; 3] {
    [x[0] + unit - unit, x[1] + unit - unit, x[2] + unit - unit]
}

#[inline(always)]
pub(super) fn dot<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn add<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(super) fn sub<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn cross<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// M x, with M by rows.
#[inline(always)]
pub(super) fn apply<L: Lanes>(m: &[L; 9], x: &[L; 3]) -> [L; 3] {
    [
        m[0] * x[0] + m[1] * x[1] + m[2] * x[2],
        m[3] * x[0] + m[4] * x[1] + m[5] * x[2],
        m[6] * x[0] + m[7] * x[1] + m[8] * x[2],
    ]
}

/// Sᵀ x, with a body's record of scales.
#[inline(always)]
pub(super) fn scaled<L: Lanes>(s: &[L; 8], x: &[L; 3]) -> [L; 3] {
    [s[1] * x[0] + s[2] * x[1] + s[4] * x[2], s[3] * x[1] + s[5] * x[2], s[6] * x[2]]
}

/// S x.
#[inline(always)]
pub(super) fn unscaled<L: Lanes>(s: &[L; 8], x: &[L; 3]) -> [L; 3] {
    [s[1] * x[0], s[2] * x[0] + s[3] * x[1], s[4] * x[0] + s[5] * x[1] + s[6] * x[2]]
}

/// x / d; 0 where d is not positive.
#[inline(always)]
pub(super) fn over<L: Lanes>(x: L, d: L) -> L {
    L::select(L::ZERO.lt(d), x / d, L::ZERO)
}
