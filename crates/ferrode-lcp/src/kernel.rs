//! The inner loops that everything dense is made of.
//!
//! Each sum has a fixed number of partial sums and a fixed order of adding them up, written out in the source. A
//! compiler may put the partial sums into registers of any width, but it may not reorder them, so the bits are the
//! same on every machine. Products and sums are never fused.

/// Adds up eight partial sums, always in this order.
#[inline(always)]
fn sum8(s: [f64; 8]) -> f64 {
    ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]))
}

/// Adds up four partial sums, always in this order.
#[inline(always)]
pub(crate) fn sum4(s: [f64; 4]) -> f64 {
    (s[0] + s[2]) + (s[1] + s[3])
}

/// The dot product of two slices, over the length of the shorter one.
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a, b) = (&a[..n], &b[..n]);
    let (a8, a_rest) = a.as_chunks::<8>();
    let (b8, b_rest) = b.as_chunks::<8>();
    let mut rest = 0.0;
    for (x, y) in a_rest.iter().zip(b_rest) {
        rest += x * y;
    }
    if a8.is_empty() {
        return rest;
    }
    let mut s = [0.0; 8];
    for (x, y) in a8.iter().zip(b8) {
        for l in 0..8 {
            s[l] += x[l] * y[l];
        }
    }
    sum8(s) + rest
}

/// The four dot products of the rows `a0`, `a1` with the rows `b0`, `b1`, over the length of the shortest.
/// Each loaded number serves two products.
#[inline(always)]
pub(crate) fn dot_2x2(a0: &[f64], a1: &[f64], b0: &[f64], b1: &[f64]) -> [f64; 4] {
    let n = a0.len().min(a1.len()).min(b0.len()).min(b1.len());
    let (a0, r0) = a0[..n].as_chunks::<4>();
    let (a1, r1) = a1[..n].as_chunks::<4>();
    let (b0, q0) = b0[..n].as_chunks::<4>();
    let (b1, q1) = b1[..n].as_chunks::<4>();
    let mut s00 = [0.0; 4];
    let mut s01 = [0.0; 4];
    let mut s10 = [0.0; 4];
    let mut s11 = [0.0; 4];
    for (((x0, x1), y0), y1) in a0.iter().zip(a1).zip(b0).zip(b1) {
        for l in 0..4 {
            s00[l] += x0[l] * y0[l];
            s01[l] += x0[l] * y1[l];
            s10[l] += x1[l] * y0[l];
            s11[l] += x1[l] * y1[l];
        }
    }
    let mut out = [sum4(s00), sum4(s01), sum4(s10), sum4(s11)];
    for (((x0, x1), y0), y1) in r0.iter().zip(r1).zip(q0).zip(q1) {
        out[0] += x0 * y0;
        out[1] += x0 * y1;
        out[2] += x1 * y0;
        out[3] += x1 * y1;
    }
    out
}

/// `y += s * a`, over the length of the shorter slice.
#[inline(always)]
pub(crate) fn add_scaled(y: &mut [f64], s: f64, a: &[f64]) {
    for (y, a) in y.iter_mut().zip(a) {
        *y += s * a;
    }
}

/// `y -= s * a`, over the length of the shorter slice.
#[inline(always)]
pub(crate) fn sub_scaled(y: &mut [f64], s: f64, a: &[f64]) {
    for (y, a) in y.iter_mut().zip(a) {
        *y -= s * a;
    }
}

/// `y = (y - s * a) - t * b`: two calls of [`sub_scaled`] to the bit, but `y` goes through memory once.
#[inline(always)]
pub(crate) fn sub_scaled_2(y: &mut [f64], s: f64, a: &[f64], t: f64, b: &[f64]) {
    for ((y, a), b) in y.iter_mut().zip(a).zip(b) {
        *y = (*y - s * a) - t * b;
    }
}
