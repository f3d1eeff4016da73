//! Times the pivoting solver on problems as physics poses them. Run in release mode:
//!
//! ```text
//! cargo run --release -p ferrode-lcp --example time_dantzig [PILE]
//! ```
//!
//! PILE is a text file with a line `b position velocity angular-velocity rotation mass Ixx Iyy Izz` per box and a line
//! `c body body position normal depth` per contact (bodies numbered from 0, -1 for the world); without it, a made-up heap is used.

mod scene;

use ferrode_lcp::*;
use scene::{Scene, chain, heap, pile};
use std::time::Instant;

fn time(scene: &Scene, name: &str) {
    let (a, stride) = scene.matrix();
    let n = scene.rows.len();
    let pick = |f: &dyn Fn(&SorRow) -> f64| -> Vec<f64> { scene.rows.iter().map(f).collect() };
    let (b, lo, hi) = (pick(&|r| r.rhs), pick(&|r| r.lo), pick(&|r| r.hi));
    let findex: Vec<i32> = scene.rows.iter().map(|r| r.findex).collect();
    let (mut x, mut w) = (vec![0.0; n], vec![0.0; n]);
    let mut ws = DantzigWorkspace::new();
    let mut best = f64::INFINITY;
    let mut report = None;
    let all = Instant::now();
    let mut runs = 0;
    while runs < 3 || (all.elapsed().as_secs_f64() < 0.4 && runs < 1000) {
        let start = Instant::now();
        let problem = &mut BoxedLcp {
            n,
            a: &a,
            stride,
            first: None,
            b: &b,
            lo: &lo,
            hi: &hi,
            findex: &findex,
            x: &mut x,
            w: &mut w,
        };
        report = solve_dantzig(problem, &mut ws).ok();
        best = best.min(start.elapsed().as_secs_f64());
        runs += 1;
    }
    let residual = natural_residual(&a, stride, &b, ws.lower_bounds(), ws.upper_bounds(), &x);
    let largest = x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    println!("{name}: {n} rows, {:.3} ms, residual {residual:?} of {largest:.3e}, {report:?}", best * 1e3);
}

fn main() {
    time(&chain(200, 0), "chain of 200");
    time(&chain(200, 20), "chain of 200 with 10 stops");
    time(&chain(45, 2), "chain of 45 with 22 stops");
    time(&heap(2, 5), "heap of 20");
    time(&heap(3, 4), "heap of 36");
    for path in std::env::args().skip(1) {
        match std::fs::read_to_string(&path).ok().and_then(|text| pile(&text)) {
            Some(scene) => time(&scene, &path),
            None => eprintln!("{path}: cannot be read as a pile"),
        }
    }
}
