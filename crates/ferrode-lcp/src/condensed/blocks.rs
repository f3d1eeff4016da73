//! Loops over numbers in whole blocks of four.

use ferrode_math::simd::{Pair, Quad};

/// The dot product.
#[inline(always)]
pub(super) fn dot_blocks<Q: Quad>(a: &[[f64; 4]], b: &[[f64; 4]]) -> f64 {
    let mut sum = Q::splat(0.0);
    for (a, b) in a.iter().zip(b) {
        sum += Q::load(a) * Q::load(b);
    }
    sum.fold().sum()
}

/// `y += s a`.
#[inline(always)]
pub(super) fn add_blocks<Q: Quad>(y: &mut [[f64; 4]], s: f64, a: &[[f64; 4]]) {
    let s = Q::splat(s);
    for (y, a) in y.iter_mut().zip(a) {
        (Q::load(y) + s * Q::load(a)).store(y);
    }
}

/// `y += s a`, and the dot product of `a` and `x`: what a row and a column of a symmetric matrix put in.
#[inline(always)]
pub(super) fn add_and_dot<Q: Quad>(y: &mut [f64], s: f64, a: &[f64], x: &[f64]) -> f64 {
    let ((y_blocks, y_rest), (a_blocks, a_rest)) = (y.as_chunks_mut::<4>(), a.as_chunks::<4>());
    let (x_blocks, x_rest) = x.as_chunks::<4>();
    let (mut sum, scale) = (Q::splat(0.0), Q::splat(s));
    for ((y, a), x) in y_blocks.iter_mut().zip(a_blocks).zip(x_blocks) {
        let a = Q::load(a);
        (Q::load(y) + scale * a).store(y);
        sum += a * Q::load(x);
    }
    let mut rest = 0.0;
    for ((y, a), x) in y_rest.iter_mut().zip(a_rest).zip(x_rest) {
        *y += s * a;
        rest += a * x;
    }
    sum.fold().sum() + rest
}

/// The largest of some blocks' numbers, by size; not a number if one is not.
#[inline(always)]
pub(super) fn largest(numbers: impl Iterator<Item = [f64; 4]>) -> f64 {
    let (mut most, mut sum) = ([0.0f64; 4], [0.0f64; 4]);
    for block in numbers {
        for l in 0..4 {
            let size = block[l].abs();
            most[l] = if size > most[l] { size } else { most[l] };
            sum[l] += size;
        }
    }
    let [a, b, c, d] = most;
    let pair = [if b > a { b } else { a }, if d > c { d } else { c }];
    let most = if pair[1] > pair[0] { pair[1] } else { pair[0] };
    let sum = (sum[0] + sum[2]) + (sum[1] + sum[3]);
    if sum.is_nan() { sum } else { most }
}
