//! Projected SOR: order, random stream, bounds, convergence to the exact answer.

mod common;

use common::Numbers;
use ferrode_lcp::*;
use proptest::prelude::*;

const INF: f64 = f64::INFINITY;

/// A plain reading of the method: no scaling, no packing. Returns forces and accelerations.
fn reference(
    bodies: &[SorBody],
    rows: &[SorRow],
    params: &SorParams,
    random: &mut impl FnMut(u32) -> u32,
) -> (Vec<f64>, Vec<[f64; 6]>) {
    let b: Vec<[[f64; 6]; 2]> = rows
        .iter()
        .map(|r| {
            [0, 1].map(|side| {
                let mut out = [0.0; 6];
                if let Some(body) = bodies.get(r.body[side] as usize) {
                    for k in 0..3 {
                        out[k] = body.inv_mass * r.j[6 * side + k];
                        out[3 + k] =
                            (0..3).map(|l| body.inv_inertia[3 * k + l] * r.j[6 * side + 3 + l]).sum();
                    }
                }
                out
            })
        })
        .collect();
    let mut a = vec![[0.0; 6]; bodies.len()];
    let mut lambda = vec![0.0; rows.len()];
    let mut order: Vec<usize> = (0..rows.len()).filter(|&i| rows[i].findex < 0).collect();
    order.extend((0..rows.len()).filter(|&i| rows[i].findex >= 0));
    for iteration in 0..params.iterations {
        if iteration > 0 && iteration % 8 == 0 {
            for k in 1..order.len() {
                order.swap(k, random(k as u32 + 1) as usize);
            }
        }
        for &i in &order {
            let r = &rows[i];
            let product = |side: usize, v: &[f64; 6]| (0..6).map(|k| r.j[6 * side + k] * v[k]).sum::<f64>();
            let diagonal = product(0, &b[i][0]) + product(1, &b[i][1]) + r.cfm;
            let mut ja = 0.0;
            for side in 0..2 {
                if let Some(a) = a.get(r.body[side] as usize) {
                    ja += product(side, a);
                }
            }
            let wanted = lambda[i] + params.over_relaxation / diagonal * (r.rhs - ja - r.cfm * lambda[i]);
            let (lo, hi) = if r.findex < 0 {
                (r.lo, r.hi)
            } else {
                let f: f64 = lambda[r.findex as usize];
                let bound = if params.inf_times_zero == InfTimesZero::Zero && f == 0.0 {
                    0.0
                } else {
                    (r.hi * f).abs()
                };
                (-bound, bound)
            };
            let new = if wanted < lo {
                lo
            } else if wanted > hi {
                hi
            } else {
                wanted
            };
            for (b, &body) in b[i].iter().zip(&r.body) {
                if let Some(a) = a.get_mut(body as usize) {
                    for k in 0..6 {
                        a[k] += (new - lambda[i]) * b[k];
                    }
                }
            }
            lambda[i] = new;
        }
    }
    (lambda, a)
}

fn random_scene(
    bodies: usize,
    rows: usize,
    friction: bool,
    numbers: &mut Numbers,
) -> (Vec<SorBody>, Vec<SorRow>) {
    let all = (0..bodies)
        .map(|_| {
            let (p, q, r) = (numbers.next() * 0.2, numbers.next() * 0.2, numbers.next() * 0.2);
            let mut d = || 1.0 + 0.5 * numbers.next();
            SorBody { inv_mass: d(), inv_inertia: [d(), p, q, p, d(), r, q, r, d()] }
        })
        .collect();
    // Friction hangs on rows without friction and is moderate: otherwise the iteration may amplify rounding.
    let mut normals = vec![];
    let rows = (0..rows)
        .map(|i| {
            let mut j = [0.0; 12];
            j.fill_with(|| numbers.next());
            let first = numbers.below(bodies) as u32;
            let second = numbers.below(bodies + 1) as u32;
            let body = match numbers.below(8) {
                0 => [NO_BODY, first],
                1 => [first, NO_BODY],
                _ if second as usize == bodies || second == first => [first, NO_BODY],
                _ => [first, second],
            };
            let (lo, hi, findex) = match numbers.below(if friction && !normals.is_empty() { 6 } else { 4 }) {
                0 => (-INF, INF, -1),
                1 => (0.0, INF, -1),
                2 => (-0.3, 0.2, -1),
                3 => (-INF, 0.0, -1),
                _ => (0.0, numbers.next().abs() * 0.5, normals[numbers.below(normals.len())]),
            };
            if findex < 0 {
                normals.push(i as i32);
            }
            SorRow { j, rhs: numbers.next(), cfm: 0.05, lo, hi, findex, body }
        })
        .collect();
    (all, rows)
}

/// ODE's generator is in another crate; any stream will do here.
fn stream(mut state: u32) -> impl FnMut(u32) -> u32 {
    move |n| {
        state = state.wrapping_mul(1664525).wrapping_add(1013904223);
        ((u64::from(state) * u64::from(n)) >> 32) as u32
    }
}

/// A [`random_scene`] of one body, which is the first of every row.
fn lone_body(rows: usize, numbers: &mut Numbers) -> (Vec<SorBody>, Vec<SorRow>) {
    let (bodies, mut rows) = random_scene(1, rows, true, numbers);
    rows.iter_mut().for_each(|row| row.body = [0, NO_BODY]);
    (bodies, rows)
}

proptest! {
    #[test]
    fn agrees_with_the_plain_reading(
        seed: u64, bodies in 1usize..12, rows in 0usize..60, iterations in 0u32..40, zero: bool, alone: bool,
    ) {
        let (bodies, rows) = match alone {
            true => lone_body(rows, &mut Numbers(seed)),
            false => random_scene(bodies, rows, true, &mut Numbers(seed)),
        };
        let inf_times_zero = if zero { InfTimesZero::Zero } else { InfTimesZero::Unbounded };
        let params = SorParams { iterations, inf_times_zero, ..SorParams::default() };
        let mut draws = 0;
        let mut base = stream(seed as u32);
        let mut counted = |n| {
            draws += 1;
            base(n)
        };
        let mut ws = SorWorkspace::new();
        let report = solve_sor(&bodies, &rows, &params, &mut counted, &mut ws).unwrap();
        prop_assert_eq!(report, SorReport { iterations, exit: SorExit::Completed, finite: true });
        prop_assert_eq!(draws, rows.len().saturating_sub(1) * (iterations.saturating_sub(1) / 8) as usize);
        let (lambda, a) = reference(&bodies, &rows, &params, &mut stream(seed as u32));
        for (x, y) in ws.lambda().iter().zip(&lambda) {
            prop_assert!((x - y).abs() < 1e-12 * (1.0 + y.abs()), "{x} {y}");
        }
        prop_assert_eq!(ws.lambda().len(), rows.len());
        for (x, y) in ws.acceleration().iter().zip(&a) {
            for (x, y) in x.0.iter().zip(y) {
                prop_assert!((x - y).abs() < 1e-11 * (1.0 + y.abs()), "{x} {y}");
            }
        }
    }

    #[test]
    fn converges_to_the_exact_answer(seed: u64, bodies in 2usize..8, rows in 1usize..20) {
        let (bodies, mut rows) = random_scene(bodies, rows, false, &mut Numbers(seed));
        for r in &mut rows {
            r.cfm = 0.5;
        }
        let params = SorParams { iterations: 2000, ..SorParams::default() };
        let mut ws = SorWorkspace::new();
        solve_sor(&bodies, &rows, &params, &mut stream(1), &mut ws).unwrap();

        // The same as a dense problem: A = J M^-1 J^T + C, by unit forces.
        let n = rows.len();
        let stride = dense::pad(n);
        let mut a = vec![0.0; n * stride];
        for (j, column) in rows.iter().enumerate() {
            let force = SorRow { rhs: 1.0, cfm: 0.0, lo: -INF, hi: INF, ..*column };
            let once = SorParams { iterations: 1, over_relaxation: 1.0, ..SorParams::default() };
            let mut unit = SorWorkspace::new();
            solve_sor(&bodies, &[force], &once, &mut stream(1), &mut unit).unwrap();
            for (i, row) in rows.iter().enumerate() {
                let mut sum = 0.0;
                for side in 0..2 {
                    if let Some(acc) = unit.acceleration().get(row.body[side] as usize) {
                        for k in 0..6 {
                            sum += row.j[6 * side + k] * acc.0[k];
                        }
                    }
                }
                a[i * stride + j] = sum / unit.lambda()[0] + if i == j { row.cfm } else { 0.0 };
            }
        }
        let pick = |f: &dyn Fn(&SorRow) -> f64| -> Vec<f64> { rows.iter().map(f).collect() };
        let (b, lo, hi) = (pick(&|r| r.rhs), pick(&|r| r.lo), pick(&|r| r.hi));
        let (mut x, mut w) = (vec![0.0; n], vec![0.0; n]);
        let report = solve_dantzig(
            &mut BoxedLcp {
                n, a: &a, stride, first: None, b: &b, lo: &lo, hi: &hi, findex: &vec![-1; n], x: &mut x, w: &mut w,
            },
            &mut DantzigWorkspace::new(),
        ).unwrap();
        prop_assert_eq!(report.status, DantzigStatus::Solved);
        for (x, y) in ws.lambda().iter().zip(&x) {
            prop_assert!((x - y).abs() < 1e-9 * (1.0 + y.abs()), "{:?} {x} {y}", ws.lambda());
        }
    }
}

#[test]
fn several_at_once_have_the_bits_of_each_by_itself() {
    let mut numbers = Numbers(11);
    // More than are put in order at once, few rows and many, no rows, one that is refused, all kinds of bounds.
    let sizes = [3, 24, 1, 9, 0, 30, 12, 5, 24, 8, 2, 60, 17, 4, 6, 21, 7, 16, 3];
    let mut scenes: Vec<_> =
        sizes.iter().map(|&rows| random_scene(1 + rows / 12, rows, true, &mut numbers)).collect();
    // Bodies by themselves; and some that stay in a plane, where signs of zeros must be the same too.
    scenes.extend(sizes.iter().map(|&rows| lone_body(rows, &mut numbers)));
    for rows in [1, 2, 4, 7, 12, 13] {
        let (bodies, mut flat) = lone_body(rows, &mut numbers);
        for row in &mut flat {
            (row.j[1], row.j[3], row.j[5]) = (-0.0, 0.0, -0.0);
        }
        let bodies = bodies.iter().map(|body| {
            let mut i = body.inv_inertia;
            [i[1], i[2], i[3], i[5], i[6], i[7]] = [0.0; 6];
            SorBody { inv_inertia: i, ..*body }
        });
        scenes.push((bodies.collect(), flat));
    }
    for iterations in [0, 1, 8, 20] {
        for inf_times_zero in [InfTimesZero::Unbounded, InfTimesZero::Zero] {
            let params = SorParams { iterations, inf_times_zero, ..SorParams::default() };
            let (mut one, mut other) = (stream(5), stream(5));
            let mut together: Vec<SorWorkspace> = scenes.iter().map(|_| SorWorkspace::new()).collect();
            for ((bodies, rows), ws) in scenes.iter().zip(&mut together) {
                begin_sor_rows(bodies, rows.len(), rows.iter(), &params, &mut one, ws).unwrap();
            }
            let mut refused = SorWorkspace::new();
            assert!(begin_sor_rows(&[], 3, [].iter(), &params, &mut one, &mut refused).is_err());
            finish_sor(together.iter_mut().chain([&mut refused]));
            assert_eq!(refused.report(), None);
            for ((bodies, rows), ws) in scenes.iter().zip(&together) {
                let mut alone = SorWorkspace::new();
                let report = solve_sor(bodies, rows, &params, &mut other, &mut alone).unwrap();
                assert_eq!(ws.report(), Some(report));
                let bits = |ws: &SorWorkspace| -> Vec<u64> {
                    let accelerations = ws.acceleration().iter().flat_map(|a| a.0);
                    ws.lambda().iter().copied().chain(accelerations).map(f64::to_bits).collect()
                };
                assert_eq!(bits(ws), bits(&alone), "{} rows", rows.len());
            }
        }
    }
}

#[test]
fn rows_of_one_body_by_their_own_way_have_the_same_bits() {
    let mut numbers = Numbers(29);
    for rows in [0, 1, 2, 3, 6, 9, 23, 24, 25, 40] {
        let (bodies, rows) = lone_body(rows, &mut numbers);
        let half = |r: &SorRow| {
            let [a, b, c, d, e, f, ..] = r.j;
            let SorRow { rhs, cfm, lo, hi, findex, .. } = *r;
            LoneRow { j: [a, b, c, d, e, f], rhs, cfm, lo, hi, findex }
        };
        for iterations in [0, 1, 8, 20, 1001] {
            for inf_times_zero in [InfTimesZero::Unbounded, InfTimesZero::Zero] {
                let params = SorParams { iterations, inf_times_zero, ..SorParams::default() };
                let (mut a, mut b) = (SorWorkspace::new(), SorWorkspace::new());
                let (mut one, mut other) = (stream(3), stream(3));
                begin_sor_rows(&bodies, rows.len(), rows.iter(), &params, &mut one, &mut a).unwrap();
                let halves = rows.iter().map(half);
                begin_sor_alone(&bodies[0], rows.len(), halves, &params, &mut other, &mut b).unwrap();
                assert_eq!(one(1000), other(1000), "as many random numbers");
                finish_sor([&mut a, &mut b].into_iter());
                let bits = |ws: &SorWorkspace| -> Vec<u64> {
                    let accelerations = ws.acceleration().iter().flat_map(|a| a.0);
                    ws.lambda().iter().copied().chain(accelerations).map(f64::to_bits).collect()
                };
                assert_eq!((a.lambda().len(), a.acceleration().len()), (rows.len(), 1));
                assert_eq!(bits(&a), bits(&b), "{} rows", rows.len());
                assert_eq!(a.report(), b.report());
            }
        }
    }
}

#[test]
fn malformed_rows_of_one_body_are_errors() {
    let mut ws = SorWorkspace::new();
    let row =
        LoneRow { j: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], rhs: 1.0, cfm: 0.0, lo: -1.0, hi: 1.0, findex: -1 };
    let mut take = |row: LoneRow, count: usize, params: &SorParams| {
        let rows = core::iter::once(row);
        let taken = begin_sor_alone(&unit_body(), count, rows, params, &mut stream(1), &mut ws);
        finish_sor(core::iter::once(&mut ws));
        assert_eq!(ws.lambda().len(), usize::from(taken.is_ok()));
        taken
    };
    let params = SorParams::default();
    assert_eq!(take(row, 1, &params), Ok(()));
    let bad = |findex| LcpError::FrictionIndex { row: 0, findex };
    assert_eq!(take(LoneRow { findex: 1, ..row }, 1, &params), Err(bad(1)));
    assert!(matches!(take(LoneRow { lo: 2.0, ..row }, 1, &params), Err(LcpError::Bounds { row: 0, .. })));
    let without = LoneRow { findex: 0, hi: f64::NAN, ..row };
    assert!(matches!(take(without, 1, &params), Err(LcpError::Bounds { row: 0, .. })));
    assert_eq!(take(row, 2, &params), Err(LcpError::Size { what: "rows", need: 2, got: 1 }));
    let params = SorParams { over_relaxation: f64::NAN, ..params };
    assert!(matches!(take(row, 1, &params), Err(LcpError::Parameter { .. })));
}

#[test]
fn rows_may_be_made_on_the_way() {
    let (bodies, rows) = random_scene(5, 30, true, &mut Numbers(3));
    let params = SorParams::default();
    let (mut a, mut b) = (SorWorkspace::new(), SorWorkspace::new());
    solve_sor(&bodies, &rows, &params, &mut stream(1), &mut a).unwrap();
    solve_sor_rows(&bodies, 30, rows.iter().copied(), &params, &mut stream(1), &mut b).unwrap();
    assert_eq!(a.lambda(), b.lambda());
    assert_eq!(a.acceleration(), b.acceleration());
    assert_eq!(
        solve_sor_rows(&bodies, 31, rows.iter(), &params, &mut stream(1), &mut b),
        Err(LcpError::Size { what: "rows", need: 31, got: 30 })
    );
    assert!(b.lambda().is_empty() && b.acceleration().is_empty());
}

fn unit_body() -> SorBody {
    SorBody { inv_mass: 1.0, inv_inertia: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0] }
}

fn push(axis: usize, rhs: f64) -> SorRow {
    let mut j = [0.0; 12];
    j[axis] = 1.0;
    SorRow { j, rhs, body: [0, NO_BODY], ..SorRow::default() }
}

fn once(rows: &[SorRow], params: SorParams) -> (SorReport, Vec<f64>) {
    let mut ws = SorWorkspace::new();
    let report = solve_sor(&[unit_body()], rows, &params, &mut stream(1), &mut ws).unwrap();
    (report, ws.lambda().to_vec())
}

#[test]
fn friction_rows_come_last_until_the_first_shuffle() {
    // The friction row is listed first; it sees the normal force because it is visited last.
    let rows = [SorRow { hi: 0.5, findex: 1, ..push(0, 9.0) }, SorRow { lo: 0.0, ..push(2, 2.0) }];
    let params = SorParams { iterations: 1, over_relaxation: 1.0, ..SorParams::default() };
    assert_eq!(once(&rows, params).1, [1.0, 2.0]);
}

#[test]
fn infinite_friction_without_normal_force() {
    let rows = [SorRow { lo: 0.0, ..push(2, -1.0) }, SorRow { hi: INF, findex: 0, ..push(0, 3.0) }];
    let params = SorParams { over_relaxation: 1.0, ..SorParams::default() };
    assert_eq!(once(&rows, params).1, [0.0, 3.0]);
    let params = SorParams { inf_times_zero: InfTimesZero::Zero, ..params };
    assert_eq!(once(&rows, params).1, [0.0, 0.0]);
}

#[test]
fn rows_without_any_effect_stay_without_force() {
    let (report, lambda) =
        once(&[SorRow { rhs: 1.0, ..SorRow::default() }, push(0, 1.0)], SorParams::default());
    assert_eq!(lambda[0], 0.0);
    assert!((lambda[1] - 1.0).abs() < 1e-10);
    assert!(report.finite);
    // With CFM alone the force is rhs / cfm.
    let spring = SorRow { rhs: 1.0, cfm: 2.0, ..SorRow::default() };
    let params = SorParams { over_relaxation: 1.0, ..SorParams::default() };
    assert_eq!(once(&[spring], params).1, [0.5]);
}

#[test]
fn nothing_at_all() {
    let mut ws = SorWorkspace::new();
    assert!(ws.lambda().is_empty() && ws.acceleration().is_empty());
    let mut never = |_| -> u32 { panic!("no row, no random number") };
    let report = solve_sor(&[], &[], &SorParams::default(), &mut never, &mut ws).unwrap();
    assert_eq!(report.iterations, 20);
}

#[test]
fn numbers_that_are_none_are_reported() {
    assert!(!once(&[push(0, f64::NAN)], SorParams::default()).0.finite);
}

#[test]
fn the_number_of_iterations_can_follow_the_progress() {
    let dynamic = |premature, extra, requirement| {
        Some(DynamicIterations {
            premature_exit_delta: premature,
            extra_iterations: extra,
            extra_requirement_delta: requirement,
        })
    };
    let params = |iterations, dynamic| SorParams { iterations, dynamic, ..SorParams::default() };
    // One row: the error shrinks to |1 - W| = 0.3 of itself in each iteration, the changes too: 1.3 * 0.3^k.
    let rows = [push(0, 1.0)];
    let run = |p| {
        let report = once(&rows, p).0;
        (report.iterations, report.exit)
    };
    assert_eq!(run(params(20, dynamic(1e-3, 20, 1e-2))), (7, SorExit::Premature));
    assert_eq!(run(params(7, dynamic(1e-3, 20, 1e-2))), (7, SorExit::Completed));
    assert_eq!(run(params(3, dynamic(1e-6, 3, 1e-2))), (6, SorExit::FullExtra));
    assert_eq!(run(params(3, dynamic(1e-6, 5, 1e-2))), (6, SorExit::Prolonged));
    assert_eq!(run(params(3, dynamic(1e-6, 0, 1e-2))), (3, SorExit::Completed));
    assert_eq!(run(params(3, dynamic(0.0, 0, 0.0))), (3, SorExit::Completed));
    assert_eq!(run(params(2, dynamic(0.0, 9, 0.0))), (11, SorExit::FullExtra));
}

#[test]
fn malformed_rows_are_errors() {
    let mut ws = SorWorkspace::new();
    let mut try_it = |row: SorRow, params: SorParams| {
        solve_sor(&[unit_body()], &[row], &params, &mut stream(1), &mut ws).unwrap_err()
    };
    let params = SorParams::default();
    let row = push(0, 1.0);
    assert_eq!(try_it(SorRow { body: [0, 1], ..row }, params), LcpError::Body { row: 0, body: [0, 1] });
    assert_eq!(try_it(SorRow { body: [0, 0], ..row }, params), LcpError::Body { row: 0, body: [0, 0] });
    assert_eq!(try_it(SorRow { findex: 1, ..row }, params), LcpError::FrictionIndex { row: 0, findex: 1 });
    assert!(matches!(try_it(SorRow { lo: f64::NAN, ..row }, params), LcpError::Bounds { row: 0, .. }));
    assert_eq!(
        try_it(SorRow { lo: 2.0, hi: 1.0, ..row }, params),
        LcpError::Bounds { row: 0, lo: 2.0, hi: 1.0 }
    );
    assert_eq!(
        try_it(row, SorParams { over_relaxation: -1.0, ..params }),
        LcpError::Parameter { what: "over_relaxation", value: -1.0 }
    );
}
