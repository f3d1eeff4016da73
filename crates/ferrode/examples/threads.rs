//! What more threads bring: `cargo run --release --example threads`, on a machine with nothing else to do.
//!
//! Steps worlds of one scene with 1, 2 … threads in turn, a block of steps each, and prints the median step of each, how many times as
//! fast that is as one thread, and the kinetic energy, which is the same for all. Arguments: the numbers of threads (1 2), and
//! optionally `bin`, `heap` or `pyramid` for one scene alone.

use ferrode::prelude::*;
use std::time::Instant;

const H: f64 = 1.0 / 60.0;
/// Steps of a world before it is the next one's turn.
const BLOCK: usize = 20;

/// A scene's name, its world, steps to begin with, and blocks that are timed.
type Scene = (&'static str, fn() -> Result<World, Error>, usize, usize);

const SCENES: [Scene; 3] = [
    ("pyramid of 820", || pyramid(40), 60, 30),
    ("bin of 4096", || bin(4096), 200, 15),
    ("bin of 20000", || bin(20_000), 200, 5),
];

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut threads: Vec<usize> = arguments.iter().filter_map(|a| a.parse().ok()).collect();
    if threads.is_empty() {
        threads = vec![1, 2];
    }
    let words: Vec<&String> = arguments.iter().filter(|a| a.parse::<usize>().is_err()).collect();
    for (name, scene, begin, blocks) in SCENES {
        if !words.is_empty() && !words.iter().any(|word| name.contains(word.as_str())) {
            continue;
        }
        let mut first = scene()?;
        first.set_threads(threads.iter().copied().max().unwrap_or(1));
        for _ in 0..begin {
            first.step(H)?;
        }
        let mut worlds: Vec<(World, Vec<f64>)> =
            threads.iter().map(|_| (first.clone(), Vec::new())).collect();
        drop(first);
        for ((world, _), threads) in worlds.iter_mut().zip(&threads) {
            world.set_threads(*threads);
        }
        for _ in 0..blocks {
            for (world, times) in &mut worlds {
                for i in 0..BLOCK {
                    let before = Instant::now();
                    world.step(H)?;
                    // The first ones fill the caches again.
                    if i > 1 {
                        times.push(before.elapsed().as_secs_f64() * 1e3);
                    }
                }
            }
        }
        let mut alone = 0.0;
        for ((world, times), threads) in worlds.iter_mut().zip(&threads) {
            times.sort_by(f64::total_cmp);
            let (least, median) = (times[0], times[times.len() / 2]);
            if alone == 0.0 {
                alone = median;
            }
            println!(
                "{name:15} {threads} threads  median {median:7.3} ms  least {least:7.3}  {:.2} times as fast  kinetic {:e}",
                alone / median,
                world.bodies().map(|(_, body)| body.kinetic_energy()).sum::<f64>(),
            );
        }
    }
    Ok(())
}

fn empty() -> Result<World, Error> {
    let mut world = World::new();
    world.stepper = Stepper::Substep;
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    world.set_default_material(Material::with_friction(0.6))?;
    let mut settings = *world.dynamics().substep();
    settings.sleep_speed = 0.0;
    world.set_substep(settings)?;
    let slab = Cuboid::new(Vec3::new(200.0, 200.0, 2.0))?;
    world.add_static(slab, Pose::from_position(Vec3::new(0.0, 0.0, -1.0)))?;
    Ok(world)
}

fn pyramid(rows: usize) -> Result<World, Error> {
    let mut world = empty()?;
    for row in 0..rows {
        for i in 0..rows - row {
            let x = (i as f64 - 0.5 * (rows - row - 1) as f64) * 1.05;
            let at = Vec3::new(x, 0.0, 0.5 + row as f64);
            world.add_body(BodyBuilder::new().at(at).with_shape(Cuboid::new(Vec3::splat(1.0))?, 1000.0))?;
        }
    }
    Ok(world)
}

/// Boxes of 0.9 m, a little askew, poured into a bin.
fn bin(count: usize) -> Result<World, Error> {
    let mut world = empty()?;
    let side = (ferrode::math::real::cbrt(count as f64) * 0.8).ceil();
    let half = side * 0.55;
    for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let long = 2.0 * half + 2.0;
        let size = Vec3::new(if x == 0.0 { long } else { 1.0 }, if y == 0.0 { long } else { 1.0 }, 60.0);
        let at = Vec3::new(x * (half + 0.5), y * (half + 0.5), 30.0);
        world.add_static(Cuboid::new(size)?, Pose::from_position(at))?;
    }
    let n = side as usize;
    for i in 0..count {
        let (x, y, z) = (i % n, i / n % n, i / (n * n));
        let jitter = |k: usize| ((i * 7919 + k * 104_729) % 1000) as f64 * 1e-4 - 0.05;
        let middle = 0.5 * (n - 1) as f64;
        let at = Vec3::new(
            (x as f64 - middle) * 1.05 + jitter(1),
            (y as f64 - middle) * 1.05 + jitter(2),
            0.7 + z as f64 * 1.2,
        );
        let turn = Quat::from_axis_angle(Vec3::new(1.0, 0.3, 0.2), jitter(3) * 4.0);
        let shape = Cuboid::new(Vec3::splat(0.9))?;
        world.add_body(BodyBuilder::new().at(at).rotated(turn).with_shape(shape, 1000.0))?;
    }
    Ok(world)
}
