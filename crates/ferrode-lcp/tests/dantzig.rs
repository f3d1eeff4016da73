//! Dantzig's algorithm against enumeration, against its own conditions, and at the edges.

mod common;

use common::{Matrix, Numbers, brute_force};
use ferrode_lcp::*;
use proptest::prelude::*;

struct Problem {
    m: Matrix,
    b: Vec<f64>,
    lo: Vec<f64>,
    hi: Vec<f64>,
    findex: Vec<i32>,
}

struct Answer {
    x: Vec<f64>,
    w: Vec<f64>,
    report: DantzigReport,
    residual: f64,
}

impl Problem {
    fn solve_in(&self, ws: &mut DantzigWorkspace) -> Answer {
        self.solve_with(ws, &DantzigOptions::default())
    }

    fn solve_with(&self, ws: &mut DantzigWorkspace, options: &DantzigOptions) -> Answer {
        let n = self.b.len();
        let mut x = vec![f64::NAN; n];
        let mut w = vec![f64::NAN; n];
        let report = solve_dantzig_with(
            &mut BoxedLcp {
                n,
                a: &self.m.a,
                stride: self.m.stride,
                first: None,
                b: &self.b,
                lo: &self.lo,
                hi: &self.hi,
                findex: &self.findex,
                x: &mut x,
                w: &mut w,
            },
            ws,
            options,
        )
        .unwrap();
        let residual =
            natural_residual(&self.m.a, self.m.stride, &self.b, ws.lower_bounds(), ws.upper_bounds(), &x)
                .unwrap();
        Answer { x, w, report, residual }
    }

    fn solve(&self) -> Answer {
        self.solve_in(&mut DantzigWorkspace::new())
    }

    fn random(n: usize, friction: bool, sparsity: usize, shift: f64, numbers: &mut Numbers) -> Self {
        let m = Matrix::gram(n, n.div_ceil(2), shift, sparsity, numbers);
        let b = (0..n).map(|_| numbers.next()).collect();
        let (mut lo, mut hi, mut findex) = (vec![], vec![], vec![]);
        for i in 0..n {
            let size = numbers.next().abs();
            let kind = numbers.below(if friction && i > 0 { 9 } else { 6 });
            let (l, h, f) = match kind {
                0 => (f64::NEG_INFINITY, f64::INFINITY, -1),
                1 | 2 => (0.0, f64::INFINITY, -1),
                3 => (f64::NEG_INFINITY, 0.0, -1),
                4 => (-size, numbers.next().abs(), -1),
                5 => (-size, 0.0, -1),
                6 => (0.0, f64::INFINITY, numbers.below(i) as i32),
                _ => (0.0, size, numbers.below(i) as i32),
            };
            lo.push(l);
            hi.push(h);
            findex.push(f);
        }
        Self { m, b, lo, hi, findex }
    }

    /// The rows listed, alone.
    fn part(&self, rows: &[usize]) -> Self {
        let mut m = Matrix::zero(rows.len());
        for (i, &r) in rows.iter().enumerate() {
            for (j, &c) in rows.iter().enumerate().take(i + 1) {
                m.a[i * m.stride + j] = self.m.at(r, c);
            }
        }
        let pick = |v: &[f64]| rows.iter().map(|&r| v[r]).collect();
        Self { m, b: pick(&self.b), lo: pick(&self.lo), hi: pick(&self.hi), findex: vec![-1; rows.len()] }
    }
}

#[test]
fn agrees_with_enumeration() {
    let mut numbers = Numbers(7);
    let mut ws = DantzigWorkspace::new();
    let mut pivots = 0;
    for _ in 0..400 {
        let n = 1 + numbers.below(7);
        let p = Problem::random(n, false, 3, 0.05, &mut numbers);
        let answer = p.solve_in(&mut ws);
        assert_eq!(answer.report.status, DantzigStatus::Solved);
        pivots += answer.report.pivots;
        let expected =
            brute_force(&p.m, &p.b, &p.lo, &p.hi).expect("a positive definite problem has a solution");
        for (x, y) in answer.x.iter().zip(&expected) {
            assert!((x - y).abs() < 1e-7 * (1.0 + y.abs()), "{:?} {expected:?}", answer.x);
        }
    }
    assert!(pivots > 400, "the problems should need pivoting");
}

#[test]
fn freezes_friction_bounds_at_the_frictionless_solution() {
    let mut numbers = Numbers(11);
    let mut seen = 0;
    for _ in 0..300 {
        let n = 2 + numbers.below(6);
        let p = Problem::random(n, true, 3, 0.05, &mut numbers);
        // Reference: the rows without friction alone; bounds from that; then all rows with fixed bounds.
        let plain: Vec<usize> = (0..n).filter(|&i| p.findex[i] < 0).collect();
        let first = p.part(&plain);
        let x0 = brute_force(&first.m, &first.b, &first.lo, &first.hi).unwrap();
        let mut x = vec![0.0; n];
        for (&i, v) in plain.iter().zip(x0) {
            x[i] = v;
        }
        let mut all = p.part(&(0..n).collect::<Vec<_>>());
        for i in 0..n {
            if p.findex[i] >= 0 {
                let force = x[p.findex[i] as usize];
                let bound = if force.abs() < 1e-12 { 0.0 } else { (p.hi[i] * force).abs() };
                all.lo[i] = -bound;
                all.hi[i] = bound;
                seen += usize::from(bound > 0.0);
            }
        }
        let expected = brute_force(&all.m, &all.b, &all.lo, &all.hi).unwrap();
        let answer = p.solve();
        assert_eq!(answer.report.status, DantzigStatus::Solved);
        for (x, y) in answer.x.iter().zip(&expected) {
            assert!((x - y).abs() < 1e-6 * (1.0 + y.abs()), "{:?} {expected:?}", answer.x);
        }
    }
    assert!(seen > 100);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn meets_the_complementarity_conditions(seed: u64, n in 0usize..60, sparsity in 0usize..9, friction: bool) {
        let p = Problem::random(n, friction, sparsity, 0.1, &mut Numbers(seed));
        let mut ws = DantzigWorkspace::new();
        let answer = p.solve_in(&mut ws);
        prop_assert_eq!(answer.report.status, DantzigStatus::Solved);
        prop_assert!(answer.residual < 1e-9, "residual {}", answer.residual);
        for i in 0..n {
            let w: f64 = (0..n).map(|j| p.m.at(i, j) * answer.x[j]).sum::<f64>() - p.b[i];
            prop_assert!((w - answer.w[i]).abs() < 1e-9, "slack {} of row {i}, should be {w}", answer.w[i]);
            prop_assert!(answer.x[i] >= ws.lower_bounds()[i] - 1e-10 && answer.x[i] <= ws.upper_bounds()[i] + 1e-10);
        }
    }

    #[test]
    fn a_used_workspace_makes_no_difference(seed: u64) {
        let mut numbers = Numbers(seed);
        let mut used = DantzigWorkspace::new();
        for n in [17, 3, 40, 0, 25] {
            let p = Problem::random(n, true, 5, 0.1, &mut numbers);
            let a = p.solve_in(&mut used);
            let b = p.solve();
            prop_assert_eq!(a.x, b.x);
            prop_assert_eq!(a.w, b.w);
            prop_assert_eq!(a.report, b.report);
        }
    }

    #[test]
    fn unbounded_rows_are_just_solved(seed: u64, n in 1usize..80, sparsity in 0usize..10) {
        let mut numbers = Numbers(seed);
        let m = Matrix::gram(n, n, 0.5, sparsity, &mut numbers);
        let b: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
        let p = Problem {
            m, b, lo: vec![f64::NEG_INFINITY; n], hi: vec![f64::INFINITY; n], findex: vec![-1; n],
        };
        let answer = p.solve();
        prop_assert_eq!(answer.report.pivots, 0);
        prop_assert_eq!(answer.report.unbounded, n);
        let (mut l, mut d, mut x) = (p.m.a.clone(), vec![0.0; n], p.b.clone());
        ldlt::factor_ldlt(&mut l, &mut d, n, p.m.stride).unwrap();
        ldlt::solve_ldlt(&l, &d, &mut x, n, p.m.stride).unwrap();
        for (x, y) in answer.x.iter().zip(&x) {
            prop_assert!((x - y).abs() < 1e-10 * (1.0 + y.abs()), "{x} {y}");
        }
    }

    #[test]
    fn redundant_rows_with_cfm_are_solved(seed: u64, copies in 2usize..6) {
        // Each row several times, as contacts at the corners of a box: rank 6, CFM on the diagonal.
        let mut numbers = Numbers(seed);
        let n = 6 * copies;
        let mut m = Matrix::gram(n, 6, 1e-5, 0, &mut numbers);
        for i in 6..n {
            for j in 0..=i {
                let (r, c) = ((i % 6).max(j % 6), (i % 6).min(j % 6));
                m.a[i * m.stride + j] = m.at(r, c) + if i != j && r == c { -1e-5 } else { 0.0 };
            }
        }
        // Right-hand sides as motions give them: equal for equal rows.
        let base: Vec<f64> = (0..6).map(|_| numbers.next()).collect();
        let p = Problem {
            m,
            b: (0..n).map(|i| base[i % 6]).collect(),
            lo: vec![0.0; n],
            hi: vec![f64::INFINITY; n],
            findex: vec![-1; n],
        };
        let answer = p.solve();
        prop_assert_eq!(answer.report.status, DantzigStatus::Solved);
        let largest = answer.x.iter().fold(1.0f64, |m, x| m.max(x.abs()));
        prop_assert!(answer.residual < 1e-9 * largest, "residual {} of {largest}", answer.residual);
    }
}

fn small(a: &[f64], b: &[f64], lo: &[f64], hi: &[f64], findex: &[i32]) -> Problem {
    let n = b.len();
    let mut m = Matrix::zero(n);
    for i in 0..n {
        for j in 0..n {
            m.a[i * m.stride + j] = a[i * n + j];
        }
    }
    Problem { m, b: b.to_vec(), lo: lo.to_vec(), hi: hi.to_vec(), findex: findex.to_vec() }
}

const INF: f64 = f64::INFINITY;

#[test]
fn nothing_to_solve() {
    let answer = small(&[], &[], &[], &[], &[]).solve();
    assert_eq!(answer.report.status, DantzigStatus::Solved);
    assert_eq!(answer.residual, 0.0);
}

#[test]
fn infinite_friction_of_a_separating_contact_is_no_friction() {
    let p = small(&[2.0, 0.1, 0.1, 2.0], &[-1.0, 3.0], &[0.0, 0.0], &[INF, INF], &[-1, 0]);
    let answer = p.solve();
    assert_eq!(answer.x, [0.0, 0.0]);
    assert_eq!(answer.w, [1.0, -3.0]);
    assert_eq!(answer.report.status, DantzigStatus::Solved);
    // The same contact under load sticks.
    let p = small(&[2.0, 0.0, 0.0, 2.0], &[1.0, 3.0], &[0.0, 0.0], &[INF, INF], &[-1, 0]);
    assert_eq!(p.solve().x, [0.5, 1.5]);
    // With a finite coefficient it slides.
    let p = small(&[2.0, 0.0, 0.0, 2.0], &[1.0, 3.0], &[0.0, 0.0], &[INF, 0.5], &[-1, 0]);
    let answer = p.solve();
    assert_eq!(answer.x, [0.5, 0.25]);
    assert_eq!(answer.w, [0.0, -2.5]);
}

#[test]
fn empty_rows_without_cfm_are_left_out() {
    for bounds in [(-INF, INF), (0.0, INF), (-1.0, 1.0)] {
        for rhs in [0.0, 1.0, -1.0] {
            let p = small(
                &[2.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 2.0],
                &[1.0, rhs, 2.0],
                &[-INF, bounds.0, 0.0],
                &[INF, bounds.1, INF],
                &[-1; 3],
            );
            let answer = p.solve();
            assert_eq!(answer.report.status, DantzigStatus::Solved);
            assert_eq!(answer.report.dropped, 1);
            assert_eq!(answer.x[1], 0.0);
            assert!(answer.x[0].abs() < 1e-15 && (answer.x[2] - 1.0).abs() < 1e-15, "{:?}", answer.x);
        }
    }
}

#[test]
fn a_row_twice_without_cfm_does_not_divide_by_zero() {
    let p = small(&[2.0, 2.0, 2.0, 2.0], &[1.0, 1.0], &[-INF; 2], &[INF; 2], &[-1; 2]);
    let answer = p.solve();
    assert_eq!(answer.report.status, DantzigStatus::Solved);
    assert!((answer.x[0] + answer.x[1] - 0.5).abs() < 1e-15, "{:?}", answer.x);
}

#[test]
fn contradicting_rows_are_given_up_and_reported() {
    // Two rows that are the same and ask for different things; the second cannot be driven.
    let p = small(
        &[1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        &[1.0, 2.0, 5.0],
        &[-INF, -1e300, 0.0],
        &[INF, INF, INF],
        &[-1; 3],
    );
    let answer = p.solve();
    match answer.report.status {
        DantzigStatus::StepNotPositive { row: 1, given_up: 2, .. } => {}
        other => panic!("{other:?}"),
    }
    assert_eq!(answer.x, [1.0, 0.0, 0.0]);
    // With recovery only the row that contradicts is lost.
    let options = DantzigOptions { recover: true, ..DantzigOptions::default() };
    let answer = p.solve_with(&mut DantzigWorkspace::new(), &options);
    assert_eq!(answer.report.status, DantzigStatus::Held { rows: 1 });
    assert_eq!(answer.x, [1.0, 0.0, 5.0]);
    assert_eq!(answer.w, [0.0, -1.0, 0.0]);
}

#[test]
fn a_tie_stops_the_algorithm_unless_it_may_recover() {
    // Row 0 rests exactly: its slack is 0 at its bound. Driving row 1 would release it with a step of length 0.
    let p = small(
        &[2.0, -1.0, 0.0, -1.0, 2.0, 0.0, 0.0, 0.0, 1.0],
        &[0.0, 3.0, 1.0],
        &[0.0; 3],
        &[INF; 3],
        &[-1; 3],
    );
    let answer = p.solve();
    assert_eq!(answer.report.status, DantzigStatus::StepNotPositive { row: 1, step: 0.0, given_up: 2 });
    assert_eq!(answer.x, [0.0; 3]);
    let options = DantzigOptions { recover: true, ..DantzigOptions::default() };
    let answer = p.solve_with(&mut DantzigWorkspace::new(), &options);
    assert_eq!(answer.report.status, DantzigStatus::Solved);
    assert!((answer.x[0] - 1.0).abs() < 1e-15 && (answer.x[1] - 2.0).abs() < 1e-15, "{:?}", answer.x);
    let options = DantzigOptions { max_pivots: Some(0), ..options };
    let answer = p.solve_with(&mut DantzigWorkspace::new(), &options);
    assert_eq!(answer.report.status, DantzigStatus::PivotLimit { row: 1, given_up: 2 });
}

#[test]
fn numbers_that_are_none_come_back_as_a_status() {
    for bad in [f64::NAN, INF] {
        for at in 0..4 {
            let mut p = small(&[2.0, 0.5, 0.5, 2.0], &[1.0, 1.0], &[-INF, 0.0], &[INF, INF], &[-1, -1]);
            match at {
                0 => p.b[0] = bad,
                1 => p.b[1] = bad,
                2 => p.m.a[0] = bad,
                _ => p.m.a[p.m.stride] = bad,
            }
            let answer = p.solve();
            assert!(answer.x.iter().chain(&answer.w).all(|v| v.is_finite()), "{bad} {at}: {:?}", answer.x);
        }
    }
}

#[test]
fn what_lies_left_of_a_rows_first_column_is_not_read() {
    let mut numbers = Numbers(5);
    for n in [1, 2, 5, 8, 23, 40] {
        let mut p = Problem::random(n, true, 0, 3.0, &mut numbers);
        let first: Vec<u32> = (0..n).map(|i| numbers.below(i + 1) as u32).collect();
        let mut spoilt = p.m.a.clone();
        for i in 0..n {
            p.m.a[i * p.m.stride..][..first[i] as usize].fill(0.0);
            spoilt[i * p.m.stride..][..first[i] as usize].fill(f64::NAN);
        }
        let expected = p.solve();
        let (mut x, mut w) = (vec![0.0; n], vec![0.0; n]);
        let mut problem = BoxedLcp {
            n,
            a: &spoilt,
            stride: p.m.stride,
            first: Some(&first),
            b: &p.b,
            lo: &p.lo,
            hi: &p.hi,
            findex: &p.findex,
            x: &mut x,
            w: &mut w,
        };
        let report = solve_dantzig(&mut problem, &mut DantzigWorkspace::new()).unwrap();
        assert_eq!(report, expected.report);
        assert_eq!(x, expected.x);
        assert_eq!(w, expected.w);
        let wrong = vec![1; n];
        let mut problem = BoxedLcp {
            n,
            a: &spoilt,
            stride: p.m.stride,
            first: Some(&wrong),
            b: &p.b,
            lo: &p.lo,
            hi: &p.hi,
            findex: &p.findex,
            x: &mut x,
            w: &mut w,
        };
        let error = solve_dantzig(&mut problem, &mut DantzigWorkspace::new()).unwrap_err();
        assert_eq!(error, LcpError::Index { what: "first", index: 1, end: 1 });
    }
}

#[test]
fn malformed_problems_are_errors() {
    let mut ws = DantzigWorkspace::new();
    let mut try_it = |a: &[f64], stride, b: &[f64], lo: &[f64], hi: &[f64], findex: &[i32]| {
        let (mut x, mut w) = ([9.0; 2], [9.0; 2]);
        let result = solve_dantzig(
            &mut BoxedLcp { n: 2, a, stride, first: None, b, lo, hi, findex, x: &mut x, w: &mut w },
            &mut ws,
        );
        assert_eq!(x, [9.0; 2]);
        result.unwrap_err()
    };
    let a = [1.0, 0.0, 0.0, 1.0];
    let (b, lo, hi, f) = ([1.0; 2], [0.0; 2], [1.0; 2], [-1; 2]);
    assert_eq!(try_it(&a[..3], 2, &b, &lo, &hi, &f), LcpError::Size { what: "a", need: 4, got: 3 });
    assert_eq!(try_it(&a, 1, &b, &lo, &hi, &f), LcpError::Stride { columns: 2, stride: 1 });
    assert_eq!(
        try_it(&a, usize::MAX, &b, &lo, &hi, &f),
        LcpError::Size { what: "a", need: usize::MAX, got: 4 }
    );
    assert_eq!(try_it(&a, 2, &b[..1], &lo, &hi, &f), LcpError::Size { what: "b", need: 2, got: 1 });
    assert_eq!(try_it(&a, 2, &b, &[0.0, 0.5], &hi, &f), LcpError::Bounds { row: 1, lo: 0.5, hi: 1.0 });
    assert_eq!(try_it(&a, 2, &b, &lo, &hi, &[-1, 2]), LcpError::FrictionIndex { row: 1, findex: 2 });
    assert!(matches!(try_it(&a, 2, &b, &lo, &[f64::NAN, 1.0], &f), LcpError::Bounds { row: 0, .. }));
}

#[test]
fn a_large_problem_runs_on_a_small_stack() {
    let run = || {
        let n = 5000;
        // A chain: each row coupled with the next three.
        let mut m = Matrix::zero(n);
        for i in 0..n {
            m.a[i * m.stride + i] = 4.0;
            for j in i.saturating_sub(3)..i {
                m.a[i * m.stride + j] = -0.5;
            }
        }
        let mut lo = vec![-INF; n];
        for i in (0..n).step_by(500) {
            lo[i] = 0.0;
        }
        let mut numbers = Numbers(1);
        let b = (0..n).map(|_| numbers.next()).collect();
        let p = Problem { m, b, lo, hi: vec![INF; n], findex: vec![-1; n] };
        let answer = p.solve();
        assert_eq!(answer.report.status, DantzigStatus::Solved);
        assert!(answer.residual < 1e-12);
    };
    std::thread::Builder::new().stack_size(256 * 1024).spawn(run).unwrap().join().unwrap();
}
