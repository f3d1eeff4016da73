//! Loops over rows that have whole blocks of four numbers, from any place on.
//!
//! All of a block is read before any of it is written, so that it is loaded and stored at once.

use crate::kernel::sum4;

/// The blocks of four of a slice from place `from` on, and what of it lies before them.
#[inline(always)]
fn blocks(a: &[f64], from: usize) -> (&[f64], &[[f64; 4]]) {
    let aligned = from.next_multiple_of(4).min(a.len());
    (&a[from..aligned], a[aligned..].as_chunks().0)
}

/// `y -= s a` from place `from` on; both are whole blocks of four.
#[inline(always)]
pub(super) fn sub_scaled(y: &mut [f64], s: f64, a: &[f64], from: usize) {
    let aligned = from.next_multiple_of(4).min(y.len());
    let (y_head, y_rest) = y[from..].split_at_mut(aligned - from);
    let (head, rest) = blocks(a, from);
    for (y, a) in y_head.iter_mut().zip(head) {
        *y -= s * a;
    }
    for (y, a) in y_rest.as_chunks_mut::<4>().0.iter_mut().zip(rest) {
        // All read before any is written: one load, one store.
        *y = [y[0] - s * a[0], y[1] - s * a[1], y[2] - s * a[2], y[3] - s * a[3]];
    }
}

/// The dot product from place `from` on; both are whole blocks of four.
#[inline(always)]
pub(super) fn dot_from(a: &[f64], b: &[f64], from: usize) -> f64 {
    let ((a_head, a_rest), (b_head, b_rest)) = (blocks(a, from), blocks(b, from));
    let mut head = 0.0;
    for (a, b) in a_head.iter().zip(b_head) {
        head += a * b;
    }
    let mut s = [0.0; 4];
    for (a, b) in a_rest.iter().zip(b_rest) {
        for l in 0..4 {
            s[l] += a[l] * b[l];
        }
    }
    head + sum4(s)
}
