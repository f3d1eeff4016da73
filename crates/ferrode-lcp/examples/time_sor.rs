//! Times the relaxation solver. Run in release mode:
//!
//! ```text
//! cargo run --release -p ferrode-lcp --example time_sor [PILE]
//! ```
//!
//! PILE is a text file as `time_dantzig` takes it.

mod scene;

use ferrode_lcp::*;
use scene::{Scene, chain, heap, pile};
use std::time::Instant;

fn time(scene: &Scene, name: &str) {
    let bodies: Vec<SorBody> =
        scene.bodies.iter().map(|b| SorBody { inv_mass: b.inv_mass, inv_inertia: b.inv_inertia }).collect();
    let mut state = 0u32;
    let mut random = move |n: u32| {
        state = state.wrapping_mul(1664525).wrapping_add(1013904223);
        ((u64::from(state) * u64::from(n)) >> 32) as u32
    };
    let mut ws = SorWorkspace::new();
    print!("{name}: {} rows", scene.rows.len());
    for iterations in [1, 8, 20, 100] {
        let params = SorParams { iterations, ..SorParams::default() };
        let mut best = f64::INFINITY;
        let all = Instant::now();
        let mut runs = 0;
        while runs < 3 || (all.elapsed().as_secs_f64() < 0.3 && runs < 3000) {
            let start = Instant::now();
            if let Err(error) = solve_sor(&bodies, &scene.rows, &params, &mut random, &mut ws) {
                println!("{error}");
                return;
            }
            best = best.min(start.elapsed().as_secs_f64());
            runs += 1;
        }
        let visits = f64::from(iterations) * scene.rows.len() as f64;
        print!(", {iterations} iterations {:.4} ms ({:.1} ns a visit)", best * 1e3, best * 1e9 / visits);
    }
    println!();
}

fn main() {
    time(&chain(200, 0), "chain of 200");
    time(&heap(6, 6), "heap of 216");
    for path in std::env::args().skip(1) {
        match std::fs::read_to_string(&path).ok().and_then(|text| pile(&text)) {
            Some(scene) => time(&scene, &path),
            None => eprintln!("{path}: cannot be read as a pile"),
        }
    }
}
