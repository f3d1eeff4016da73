#![allow(clippy::excessive_precision, reason = "figures stand as they were recorded, with all 17 digits")]
//! The dense matrix functions: figures recorded from libode 0.16.2, and properties.

mod common;

use common::{Matrix, Numbers, gauss};
use ferrode_lcp::LcpError;
use ferrode_lcp::cholesky::*;
use ferrode_lcp::dense::*;
use ferrode_lcp::ldlt::*;
use proptest::prelude::*;

#[test]
fn figures_of_libode() {
    let mut a = [4.0, 0.0, 0.0, 0.0, 1.0, 3.0, 0.0, 0.0, 0.5, 0.2, 2.0, 0.0];
    let mut d = [0.0; 3];
    factor_ldlt(&mut a, &mut d, 3, 4).unwrap();
    assert_eq!(d, [0.25, 0.36363636363636365, 0.51667449506810703]);
    assert_eq!([a[4], a[8]], [0.25, 0.125]);
    assert!((a[9] - 0.027272727272727278).abs() < 1e-17);
    assert_eq!([a[0], a[5], a[10]], [4.0, 3.0, 2.0], "the diagonal is not touched");
    let mut b = [1.0, 2.0, 3.0];
    solve_ldlt(&a, &d, &mut b, 3, 4).unwrap();
    for (x, y) in b.iter().zip([-0.081728511038046014, 0.59652418976045096, 1.4607797087834662]) {
        assert!((x - y).abs() <= 2.3e-16, "{x} {y}");
    }
}

#[test]
fn leading_dimensions() {
    assert_eq!([0, 1, 2, 3, 4, 5, 8, 9].map(pad), [0, 1, 4, 4, 4, 8, 8, 12]);
}

fn full(m: &Matrix) -> Vec<Vec<f64>> {
    (0..m.n).map(|i| (0..m.n).map(|j| m.at(i, j)).collect()).collect()
}

/// The factor of a matrix from scratch.
fn factored(m: &Matrix) -> (Vec<f64>, Vec<f64>) {
    let (mut l, mut d) = (m.a.clone(), vec![0.0; m.n]);
    factor_ldlt(&mut l, &mut d, m.n, m.stride).unwrap();
    (l, d)
}

fn without(m: &Matrix, r: usize) -> Matrix {
    let keep: Vec<usize> = (0..m.n).filter(|&i| i != r).collect();
    let mut out = Matrix::zero(m.n - 1);
    for (i, &p) in keep.iter().enumerate() {
        for (j, &q) in keep.iter().enumerate().take(i + 1) {
            out.a[i * out.stride + j] = m.at(p, q);
        }
    }
    out
}

proptest! {
    #[test]
    fn products(seed: u64, p in 0usize..9, q in 0usize..9, r in 0usize..9) {
        let mut numbers = Numbers(seed);
        let mut make = |n: usize, m: usize| -> Vec<f64> { (0..n * pad(m)).map(|_| numbers.next()).collect() };
        let (b, bt, c, ct) = (make(p, q), make(q, p), make(q, r), make(r, q));
        let mut a = vec![7.0; p * pad(r)];
        let check = |a: &[f64], f: &dyn Fn(usize, usize, usize) -> f64| {
            for i in 0..p {
                for j in 0..pad(r) {
                    let expected = if j < r { (0..q).map(|k| f(i, j, k)).sum() } else { 7.0 };
                    assert!((a[i * pad(r) + j] - expected).abs() < 1e-14);
                }
            }
        };
        multiply0(&mut a, &b, &c, p, q, r).unwrap();
        check(&a, &|i, j, k| b[i * pad(q) + k] * c[k * pad(r) + j]);
        multiply1(&mut a, &bt, &c, p, q, r).unwrap();
        check(&a, &|i, j, k| bt[k * pad(p) + i] * c[k * pad(r) + j]);
        multiply2(&mut a, &b, &ct, p, q, r).unwrap();
        check(&a, &|i, j, k| b[i * pad(q) + k] * ct[j * pad(q) + k]);
    }

    #[test]
    fn dots_and_scales(seed: u64, n in 0usize..70) {
        let mut numbers = Numbers(seed);
        let a: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
        let b: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
        let naive: f64 = a.iter().zip(&b).map(|(x, y)| x * y).sum();
        prop_assert!((dot(&a, &b, n).unwrap() - naive).abs() < 1e-13);
        let mut s = a.clone();
        scale_vector(&mut s, &b, n).unwrap();
        prop_assert!((0..n).all(|i| s[i] == a[i] * b[i]));
        set_value(&mut s, n, 3.0).unwrap();
        prop_assert!(s.iter().all(|v| *v == 3.0));
        set_zero(&mut s, n / 2).unwrap();
        prop_assert_eq!(s.iter().filter(|v| **v == 0.0).count(), n / 2);
    }

    #[test]
    fn every_solver_agrees_with_elimination(seed: u64, n in 1usize..24) {
        let mut numbers = Numbers(seed);
        let m = Matrix::gram(n, n, 0.3, 2, &mut numbers);
        let b: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
        let expected = gauss(full(&m), b.clone()).unwrap();
        let close = |x: &[f64]| x.iter().zip(&expected).all(|(x, y)| (x - y).abs() < 1e-10 * (1.0 + y.abs()));

        let (l, d) = factored(&m);
        let mut x = b.clone();
        solve_ldlt(&l, &d, &mut x, n, m.stride).unwrap();
        prop_assert!(close(&x));

        let mut c = m.a.clone();
        prop_assert!(factor_cholesky(&mut c, n, m.stride).unwrap());
        let mut x = b.clone();
        solve_cholesky(&c, &mut x, n, m.stride).unwrap();
        prop_assert!(close(&x));

        let mut inverse = vec![5.0; m.a.len()];
        prop_assert!(invert_pd(&m.a, &mut inverse, n, m.stride).unwrap());
        let x: Vec<f64> =
            (0..n).map(|i| (0..n).map(|j| inverse[i * m.stride + j] * b[j]).sum()).collect();
        prop_assert!(close(&x));
        prop_assert!((0..n).all(|i| inverse[i * m.stride + n..(i + 1) * m.stride].iter().all(|v| *v == 0.0)));
    }

    #[test]
    fn removal_equals_factoring_the_rest(seed: u64, n in 1usize..24, r in 0usize..24) {
        let r = r % n;
        let m = Matrix::gram(n, n, 0.3, 2, &mut Numbers(seed));
        let (mut l, mut d) = factored(&m);
        ldlt_remove(&mut l, &mut d, n, r, m.stride).unwrap();
        let rest = without(&m, r);
        let (l2, d2) = factored(&rest);
        for i in 0..n - 1 {
            prop_assert!((d[i] - d2[i]).abs() < 1e-9 * d2[i].abs());
            for j in 0..i {
                prop_assert!((l[i * m.stride + j] - l2[i * rest.stride + j]).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn adding_a_first_row_and_column(seed: u64, n in 1usize..24) {
        let mut numbers = Numbers(seed);
        let m = Matrix::gram(n, n, 1.0, 2, &mut numbers);
        let (mut l, mut d) = factored(&m);
        let before = (l.clone(), d[0]);
        // Small enough for the sum to stay positive definite.
        let a: Vec<f64> = (0..n).map(|i| numbers.next() * if i == 0 { 0.3 } else { 0.02 }).collect();
        ldlt_add_tl(&mut l, &mut d, &a, n, m.stride).unwrap();
        let mut sum = m.clone();
        for (i, a) in a.iter().enumerate() {
            sum.a[i * sum.stride] += a;
        }
        let (l2, d2) = factored(&sum);
        prop_assert_eq!(d[0], before.1);
        for i in 1..n {
            prop_assert!((d[i] - d2[i]).abs() < 1e-9 * d2[i].abs());
            prop_assert_eq!(l[i * m.stride], before.0[i * m.stride]);
            for j in 1..i {
                prop_assert!((l[i * m.stride + j] - l2[i * m.stride + j]).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn triangles_and_differences(seed: u64, n in 0usize..12) {
        let mut numbers = Numbers(seed);
        let a: Vec<f64> = (0..n * pad(n)).map(|_| numbers.next()).collect();
        let mut b = a.clone();
        clear_upper_triangle(&mut b, n).unwrap();
        prop_assert_eq!(max_difference_lower_triangle(&a, &b, n).unwrap(), 0.0);
        let mut upper = 0.0f64;
        for i in 0..n {
            for j in i + 1..n {
                prop_assert_eq!(b[i * pad(n) + j], 0.0);
                upper = upper.max(a[i * pad(n) + j].abs());
            }
        }
        prop_assert_eq!(max_difference(&a, &b, n, n).unwrap(), upper);
    }
}

#[test]
fn compaction() {
    let mut a: Vec<f64> = (0..16).map(f64::from).collect();
    remove_row_col(&mut a, 4, 4, 1).unwrap();
    for (i, row) in [[0.0, 2.0, 3.0], [8.0, 10.0, 11.0], [12.0, 14.0, 15.0]].iter().enumerate() {
        assert_eq!(a[i * 4..i * 4 + 3], row[..]);
    }
}

#[test]
fn indefinite_matrices_are_noticed() {
    let a = [1.0, 0.0, 0.0, 0.0, 2.0, 1.0, 0.0, 0.0];
    assert!(!is_positive_definite(&a, 2, 4).unwrap());
    assert!(is_positive_definite(&[1.0, 0.0, 0.0, 0.0, 0.5, 1.0], 2, 4).unwrap());
    let mut inverse = [8.0; 8];
    assert!(!invert_pd(&a, &mut inverse, 2, 4).unwrap());
    assert_eq!(inverse, [8.0; 8], "untouched on failure");
    assert!(!is_positive_definite(&[f64::NAN], 1, 1).unwrap());
    assert!(!is_positive_definite(&[0.0], 1, 1).unwrap());
}

#[test]
fn short_slices_are_errors() {
    let size = |what, need, got| Err(LcpError::Size { what, need, got });
    assert_eq!(set_zero(&mut [0.0], 2), size("a", 2, 1));
    assert_eq!(dot(&[0.0; 3], &[0.0], 2).map(|_| ()), size("b", 2, 1));
    assert_eq!(multiply0(&mut [0.0; 8], &[0.0; 8], &[0.0; 3], 2, 2, 2), size("c", 6, 3));
    assert_eq!(factor_ldlt(&mut [0.0; 8], &mut [0.0], 2, 4), size("d", 2, 1));
    assert_eq!(
        factor_ldlt(&mut [0.0; 8], &mut [0.0; 4], 4, 2),
        Err(LcpError::Stride { columns: 4, stride: 2 })
    );
    assert_eq!(
        ldlt_remove(&mut [0.0; 8], &mut [0.0; 2], 2, 2, 4),
        Err(LcpError::Index { what: "r", index: 2, end: 2 })
    );
    assert_eq!(LcpError::Index { what: "r", index: 2, end: 2 }.to_string(), "r is 2 but must be below 2");
}
