//! Dantzig's method on the rows with bounds alone, against the other exact methods.

mod islands;

use ferrode_lcp::{
    BoxedLcp, CondensedWorkspace, DantzigStatus, DantzigWorkspace, PivotingOptions, PivotingWorkspace,
    natural_residual, solve_condensed, solve_dantzig, solve_pivoting,
};
use islands::{Island, random};

fn problem<'a>(island: &'a Island, a: &'a [f64], x: &'a mut [f64], w: &'a mut [f64]) -> BoxedLcp<'a> {
    BoxedLcp {
        n: island.rhs.len(),
        a,
        stride: island.rhs.len(),
        first: None,
        b: &island.rhs,
        lo: &island.lo,
        hi: &island.hi,
        findex: &island.findex,
        x,
        w,
    }
}

fn difference(a: &[[f64; 6]], b: &[[f64; 6]]) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs() / (1.0 + a.abs())).fold(0.0, f64::max)
}

#[test]
fn random_islands_agree_with_block_pivoting() {
    let (mut work, mut pivoting) = (CondensedWorkspace::new(), PivotingWorkspace::new());
    let (mut solved, mut worst, mut bounded) = (0, 0.0f64, 0);
    let islands = 600usize;
    for seed in 0..islands {
        let mut island = random(seed as u64);
        let n = island.rhs.len();
        let a = island.dense();
        let (mut x, mut w) = (vec![0.0; n], vec![0.0; n]);
        let answer = solve_condensed(&mut problem(&island, &a, &mut x, &mut w), &mut work).unwrap();
        let Some(answer) = answer else { continue };
        solved += 1;
        // What it says of itself holds.
        let (lo, hi) = (work.lower_bounds(), work.upper_bounds());
        let residual = natural_residual(&a, n, &island.rhs, lo, hi, &x).unwrap();
        assert!(residual <= 1e-11 * (1.0 + answer.largest), "island {seed}: {residual:e}, {answer:?}");
        bounded += usize::from((0..n).any(|i| island.findex[i] >= 0 && hi[i] > 0.0 && x[i].abs() == hi[i]));
        for i in 0..n {
            assert!(lo[i] <= x[i] && x[i] <= hi[i], "island {seed}, row {i}");
            if let Ok(f) = usize::try_from(island.findex[i]) {
                assert!(hi[i] >= 0.0 && lo[i] == -hi[i] && island.findex[f] < 0);
            }
        }
        let report =
            solve_pivoting(&mut island.problem(), &PivotingOptions::default(), &mut pivoting).unwrap();
        if report.certified() {
            let d = difference(&island.velocities(&x), &island.velocities(&island.x));
            worst = worst.max(d);
            assert!(d < 1e-6, "island {seed}: velocities differ by {d:e}");
        }
    }
    println!(
        "{solved} of {islands} solved, {bounded} of them slide, velocities differ by at most {worst:.1e}"
    );
    assert!(solved * 10 >= islands * 9);
    assert!(bounded * 10 >= solved * 3);
}

#[test]
fn the_workspace_leaves_no_trace() {
    let mut used = CondensedWorkspace::new();
    for seed in 0..60 {
        let island = random(seed);
        let n = island.rhs.len();
        let a = island.dense();
        let solve = |work: &mut CondensedWorkspace| {
            let (mut x, mut w) = (vec![0.0; n], vec![0.0; n]);
            let answer = solve_condensed(&mut problem(&island, &a, &mut x, &mut w), work).unwrap();
            answer.map(|answer| (x.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), answer))
        };
        assert_eq!(solve(&mut used), solve(&mut CondensedWorkspace::new()), "island {seed}");
    }
}

#[test]
fn the_order_of_elimination_changes_only_rounding() {
    let mut work = CondensedWorkspace::new();
    let mut compared = 0;
    for seed in 0..400 {
        let island = random(seed);
        let n = island.rhs.len();
        let a = island.dense();
        let first_of = |r: usize| (0..r).find(|c| a[r * n + c] != 0.0).unwrap_or(r) as u32;
        let first: Vec<u32> = (0..n).map(first_of).collect();
        let mut solve = |first| {
            let (mut x, mut w) = (vec![0.0; n], vec![0.0; n]);
            let mut problem = problem(&island, &a, &mut x, &mut w);
            problem.first = first;
            solve_condensed(&mut problem, &mut work).unwrap().map(|answer| (x, answer))
        };
        // Redundant rows share their load as rounding has it.
        let (Some((x, answer)), Some((y, _))) = (solve(None), solve(Some(&first))) else { continue };
        if island.cfm < 1e-6 {
            continue;
        }
        compared += 1;
        for (x, y) in x.iter().zip(&y) {
            assert!((x - y).abs() < 1e-8 * (1.0 + answer.largest), "island {seed}: {x} {y}");
        }
    }
    assert!(compared > 50, "{compared}");
}

#[test]
fn many_rows_are_left_to_others() {
    let n = 256;
    let mut a = vec![0.0; n * n];
    (0..n).for_each(|i| a[i * n + i] = 1.0);
    let (b, findex) = (vec![1.0; n], vec![-1; n]);
    let (lo, hi) = (vec![0.0; n], vec![f64::INFINITY; n]);
    let (mut x, mut w) = (vec![0.0; n], vec![0.0; n]);
    for (rows, solved) in [(255, true), (256, false)] {
        let mut problem = BoxedLcp {
            n: rows,
            a: &a,
            stride: n,
            first: None,
            b: &b,
            lo: &lo,
            hi: &hi,
            findex: &findex,
            x: &mut x,
            w: &mut w,
        };
        let answer = solve_condensed(&mut problem, &mut CondensedWorkspace::new()).unwrap();
        assert_eq!(answer.is_some(), solved);
    }
    assert_eq!(x[..255], b[..255]);
}

#[test]
fn what_it_cannot_do_is_said() {
    let solve = |a: &[f64], b: &[f64], lo: &[f64], hi: &[f64], findex: &[i32]| {
        let n = b.len();
        let (mut x, mut w) = (vec![7.0; n], vec![7.0; n]);
        let mut p = BoxedLcp { n, a, stride: n, first: None, b, lo, hi, findex, x: &mut x, w: &mut w };
        solve_condensed(&mut p, &mut CondensedWorkspace::new()).map(|answer| (answer, x))
    };
    let inf = f64::INFINITY;
    // Nothing to solve; one row at its bound, one free.
    assert_eq!(solve(&[], &[], &[], &[], &[]).unwrap().0.map(|a| a.pivots), Some(0));
    let (answer, x) = solve(&[2.0, 0.0, 1.0, 2.0], &[-1.0, 4.0], &[0.0; 2], &[inf; 2], &[-1; 2]).unwrap();
    assert_eq!((answer.map(|a| a.pivots), x), (Some(1), vec![0.0, 2.0]));
    // Friction by the force of a row without bounds: left to the other method.
    let friction = solve(&[1.0, 0.0, 0.0, 1.0], &[1.0; 2], &[-inf, 0.0], &[inf, 0.5], &[-1, 0]).unwrap();
    assert_eq!(friction.0, None);
    // Rows that contradict each other; numbers that are none.
    assert_eq!(solve(&[1.0, 0.0, 1.0, 1.0], &[1.0, 2.0], &[-inf; 2], &[inf; 2], &[-1; 2]).unwrap().0, None);
    assert_eq!(solve(&[1.0], &[f64::NAN], &[-inf], &[inf], &[-1]).unwrap().0, None);
    assert_eq!(solve(&[f64::NAN], &[1.0], &[0.0], &[inf], &[-1]).unwrap().0, None);
    // Malformed.
    assert!(solve(&[1.0], &[1.0], &[1.0], &[2.0], &[-1]).is_err());
    assert!(solve(&[1.0], &[1.0], &[0.0], &[2.0], &[5]).is_err());
}

#[test]
fn friction_is_frozen_as_in_dantzigs_method() {
    for seed in 0..200 {
        let island = random(seed);
        if island.cfm < 1e-6 {
            continue;
        }
        let n = island.rhs.len();
        let a = island.dense();
        let (mut work, mut dantzig) = (CondensedWorkspace::new(), DantzigWorkspace::new());
        let (mut x, mut w, mut y) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let answer = solve_condensed(&mut problem(&island, &a, &mut x, &mut w), &mut work).unwrap();
        let report = solve_dantzig(&mut problem(&island, &a, &mut y, &mut w), &mut dantzig).unwrap();
        if let (Some(answer), DantzigStatus::Solved) = (answer, report.status) {
            let close = 1e-7 * (1.0 + answer.largest);
            for i in 0..n {
                assert!((x[i] - y[i]).abs() < close, "island {seed}, row {i}: {} {}", x[i], y[i]);
                let (ours, theirs) = (work.upper_bounds()[i], dantzig.upper_bounds()[i]);
                assert!(ours == theirs || (ours - theirs).abs() < close, "island {seed}, row {i}");
            }
        }
    }
}
