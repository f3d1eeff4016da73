//! The scenes, written once for all engines.

use ferrode_math::random::OdeRandom;
use ferrode_math::{Quat, Vec3};

/// A shape.
#[derive(Clone, Copy, Debug)]
pub enum Solid {
    /// A ball by its radius.
    Ball(f64),
    /// A box by its sides.
    Cuboid(Vec3),
}

/// A shape at a place that may move.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its shape.
    pub solid: Solid,
    /// Where it is.
    pub position: Vec3,
    /// How it is turned.
    pub rotation: Quat,
    /// Metres per second; zero for what stays.
    pub velocity: Vec3,
}

/// Repeatable random numbers from 0 to 1.
pub struct Numbers(OdeRandom);

impl Numbers {
    /// From a seed.
    pub fn new(seed: u32) -> Self {
        Self(OdeRandom::new(seed))
    }

    /// The next number.
    pub fn next(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / 4294967296.0
    }

    /// A vector in the cube from 0 to 1.
    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    /// A unit vector.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector() * 2.0 - Vec3::splat(1.0);
            if let Some(n) = v.normalized().filter(|_| v.length() <= 1.0) {
                return n;
            }
        }
    }

    fn turn(&mut self) -> Quat {
        Quat::from_axis_angle(self.direction(), 6.3 * self.next())
    }
}

/// `count` balls and boxes (0.2 to 0.6 m), one to `volume` cubic metres in a cube, of which every second moves at up to
/// `speed`. Returns the side of the cube too.
pub fn crowd(count: usize, volume: f64, speed: f64) -> (Vec<Body>, f64) {
    let mut n = Numbers::new(1);
    let side = (count as f64 * volume).cbrt();
    let bodies = (0..count)
        .map(|i| Body {
            solid: if n.next() < 0.5 {
                Solid::Ball(0.1 + 0.2 * n.next())
            } else {
                Solid::Cuboid(Vec3::splat(0.2) + n.vector() * 0.4)
            },
            position: n.vector() * side,
            rotation: n.turn(),
            velocity: if i % 2 == 0 { n.direction() * (speed * n.next()) } else { Vec3::ZERO },
        })
        .collect();
    (bodies, side)
}

/// Moves the bodies by one step, back from the walls. Calls `moved` for each that moved.
pub fn advance(bodies: &mut [Body], side: f64, dt: f64, mut moved: impl FnMut(usize, &Body)) {
    for (i, b) in bodies.iter_mut().enumerate() {
        if b.velocity == Vec3::ZERO {
            continue;
        }
        b.position += b.velocity * dt;
        for k in 0..3 {
            if b.position[k] < 0.0 {
                b.velocity[k] = b.velocity[k].abs();
            } else if b.position[k] > side {
                b.velocity[k] = -b.velocity[k].abs();
            }
        }
        moved(i, b);
    }
}

/// `count` boxes (0.2 to 1.2 m) in a cube of side 100, none of which moves.
pub fn boxes(count: usize) -> Vec<Body> {
    let mut n = Numbers::new(2);
    (0..count)
        .map(|_| Body {
            solid: Solid::Cuboid(Vec3::splat(0.2) + n.vector()),
            position: n.vector() * 100.0,
            rotation: n.turn(),
            velocity: Vec3::ZERO,
        })
        .collect()
}

/// Hills: `2 n²` triangles over a square of side 100.
pub fn hills(n: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            let (x, y) = (f64::from(i) / f64::from(n) * 100.0, f64::from(j) / f64::from(n) * 100.0);
            vertices.push(Vec3::new(x, y, 3.0 * (0.3 * x).sin() + 2.0 * (0.4 * y).cos()));
        }
    }
    for i in 0..n {
        for j in 0..n {
            let a = i * (n + 1) + j;
            let (b, c, d) = (a + 1, a + n + 1, a + n + 2);
            triangles.push([a, c, b]);
            triangles.push([b, c, d]);
        }
    }
    (vertices, triangles)
}

/// Rays of length 100 from random places in a cube of side 100, in random directions.
pub fn rays(count: usize) -> Vec<(Vec3, Vec3)> {
    let mut n = Numbers::new(3);
    (0..count).map(|_| (n.vector() * 100.0, n.direction())).collect()
}

/// Rays down onto the hills from 20 m above, up to 45° off the vertical.
pub fn rays_down(count: usize) -> Vec<(Vec3, Vec3)> {
    let mut n = Numbers::new(4);
    (0..count)
        .map(|_| {
            let from = n.vector() * 100.0;
            let d = Vec3::new(n.next() - 0.5, n.next() - 0.5, -0.7).normalized_or(Vec3::Z);
            (Vec3::new(from.x, from.y, 20.0), d)
        })
        .collect()
}
