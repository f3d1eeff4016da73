//! The same input gives the same bits: with any optimisation, register width and machine.
//!
//! The hashes are of results that the other tests show to be right. They may change with the order of operations in the
//! source, for a reason given in the commit; they must not differ between builds of one source.

mod common;

use common::{Matrix, Numbers};
use ferrode_lcp::*;

/// FNV-1a over the bits of the numbers.
fn hash(numbers: &[f64]) -> u64 {
    let bytes = numbers.iter().flat_map(|v| v.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}

#[test]
fn pivoting() {
    let mut numbers = Numbers(2024);
    let n = 90;
    let m = Matrix::gram(n, 60, 0.01, 6, &mut numbers);
    let b: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
    let lo: Vec<f64> = (0..n).map(|i| if i < 20 { f64::NEG_INFINITY } else { 0.0 }).collect();
    let hi: Vec<f64> = (0..n).map(|i| if i < 60 { f64::INFINITY } else { 0.7 }).collect();
    let findex: Vec<i32> = (0..n as i32).map(|i| if i < 60 { -1 } else { i - 40 }).collect();
    let (mut x, mut w) = (vec![0.0; n], vec![0.0; n]);
    let mut problem = BoxedLcp {
        n,
        a: &m.a,
        stride: m.stride,
        first: None,
        b: &b,
        lo: &lo,
        hi: &hi,
        findex: &findex,
        x: &mut x,
        w: &mut w,
    };
    let report = solve_dantzig(&mut problem, &mut DantzigWorkspace::new()).unwrap();
    assert_eq!(report.status, DantzigStatus::Solved);
    assert_eq!((hash(&x), hash(&w)), (9_772_687_721_748_319_885, 12_511_698_366_579_951_667));
}

/// The hashes of forces and accelerations of 20 iterations over random rows on some bodies.
fn relax(bodies: u32, rows: i32) -> (u64, u64) {
    let mut numbers = Numbers(2025);
    let all: Vec<SorBody> = (0..bodies)
        .map(|_| {
            let mut d = || 1.0 + 0.5 * numbers.next();
            SorBody { inv_mass: d(), inv_inertia: [d(), 0.1, 0.0, 0.1, d(), 0.2, 0.0, 0.2, d()] }
        })
        .collect();
    let rows: Vec<SorRow> = (0..rows)
        .map(|i| {
            let mut j = [0.0; 12];
            j.fill_with(|| numbers.next());
            let first = i as u32 / 6 % bodies;
            let second = if i % 30 < 6 || bodies == 1 { NO_BODY } else { (first + 5) % bodies };
            let (hi, findex) = if i % 3 == 0 { (f64::INFINITY, -1) } else { (0.5, i - i % 3) };
            SorRow { j, rhs: numbers.next(), cfm: 0.01, lo: 0.0, hi, findex, body: [first, second] }
        })
        .collect();
    let mut state = 1u32;
    let mut random = |n: u32| {
        state = state.wrapping_mul(1664525).wrapping_add(1013904223);
        ((u64::from(state) * u64::from(n)) >> 32) as u32
    };
    let mut ws = SorWorkspace::new();
    let report = solve_sor(&all, &rows, &SorParams::default(), &mut random, &mut ws).unwrap();
    assert!(report.finite);
    let accelerations: Vec<f64> = ws.acceleration().iter().flat_map(|a| a.0).collect();
    (hash(ws.lambda()), hash(&accelerations))
}

#[test]
fn relaxation() {
    assert_eq!(relax(12, 90), (8_114_197_809_357_930_618, 4_491_954_727_278_343_792));
}

#[test]
fn relaxation_of_a_few_rows() {
    assert_eq!(relax(2, 22), (9_115_862_276_589_748_461, 1_559_078_663_569_451_980));
}

#[test]
fn relaxation_of_a_body_alone() {
    assert_eq!(relax(1, 22), (5_758_016_646_365_456_922, 6_632_582_787_960_250_710));
}
