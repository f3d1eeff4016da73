//! Random islands with the rows that real joints and contacts have.
#![allow(dead_code)]

use ferrode_lcp::{NO_SPARSE_BODY, RowBlock, RowState, ScaledRow, SparseLcp};

/// A small generator of numbers.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let x = self.0 ^ (self.0 >> 29);
        x.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11
    }

    /// 0 … 1.
    pub fn unit(&mut self) -> f64 {
        self.next() as f64 / (1u64 << 53) as f64
    }

    pub fn range(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    pub fn vector(&mut self) -> [f64; 3] {
        [self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0)]
    }
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A body: an axis-parallel box, its velocity and the square roots of its inverse mass and inertia.
#[derive(Clone, Copy)]
pub struct Body {
    pub position: [f64; 3],
    pub velocity: [f64; 6],
    pub scale: [f64; 6],
}

/// An island.
#[derive(Default)]
pub struct Island {
    pub h: f64,
    pub cfm: f64,
    pub bodies: Vec<Body>,
    pub blocks: Vec<RowBlock>,
    pub jacobian: Vec<ScaledRow>,
    pub sigma: Vec<f64>,
    pub rhs: Vec<f64>,
    pub lo: Vec<f64>,
    pub hi: Vec<f64>,
    pub findex: Vec<i32>,
    pub states: Vec<[Option<RowState>; 2]>,
    pub x: Vec<f64>,
}

pub const WORLD: u32 = NO_SPARSE_BODY;

impl Island {
    pub fn new(h: f64, cfm: f64) -> Self {
        Self { h, cfm, ..Self::default() }
    }

    pub fn add_body(&mut self, mass: f64, size: [f64; 3], position: [f64; 3], velocity: [f64; 6]) -> u32 {
        let m = mass.sqrt().recip();
        let i = |a: f64, b: f64| (12.0 / (mass * (a * a + b * b))).sqrt();
        let scale = [m, m, m, i(size[1], size[2]), i(size[0], size[2]), i(size[0], size[1])];
        self.bodies.push(Body { position, velocity, scale });
        self.bodies.len() as u32 - 1
    }

    fn begin(&mut self, a: u32, b: u32) {
        self.blocks.push(RowBlock { bodies: [a, b], first: self.rhs.len() as u32, count: 0 });
    }

    /// A row with Jacobian (linear, angular) on the first body and its negative at `p` on the second.
    fn row(&mut self, p: [f64; 3], n: [f64; 3], angular_only: bool, c: f64) -> usize {
        let block = self.blocks.last_mut().unwrap();
        block.count += 1;
        let mut j = [[0.0; 6]; 2];
        let mut free = 0.0;
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            if block.bodies[side] == WORLD {
                continue;
            }
            let body = &self.bodies[block.bodies[side] as usize];
            let full = if angular_only {
                [0.0, 0.0, 0.0, n[0], n[1], n[2]]
            } else {
                let r = [0, 1, 2].map(|i| p[i] - body.position[i]);
                let a = cross(r, n);
                [n[0], n[1], n[2], a[0], a[1], a[2]]
            };
            for i in 0..6 {
                let gravity = if i == 2 { -9.81 } else { 0.0 };
                free += sign * full[i] * (body.velocity[i] / self.h + gravity);
                j[side][i] = sign * full[i] * body.scale[i];
            }
        }
        self.jacobian.push(j);
        self.sigma.push(self.cfm / self.h);
        self.rhs.push(c / self.h - free);
        self.lo.push(f64::NEG_INFINITY);
        self.hi.push(f64::INFINITY);
        self.findex.push(-1);
        self.states.push([None; 2]);
        self.x.push(0.0);
        self.rhs.len() - 1
    }

    pub fn ball(&mut self, a: u32, b: u32, p: [f64; 3], error: [f64; 3]) {
        self.begin(a, b);
        for i in 0..3 {
            let mut n = [0.0; 3];
            n[i] = 1.0;
            self.row(p, n, false, 0.2 / self.h * error[i]);
        }
    }

    /// A hinge about x, with a motor and maybe a limit.
    pub fn hinge(&mut self, a: u32, b: u32, p: [f64; 3], motor: Option<(f64, f64)>, limit: Option<f64>) {
        self.ball(a, b, p, [0.0; 3]);
        self.row(p, [0.0, 1.0, 0.0], true, 0.0);
        self.row(p, [0.0, 0.0, 1.0], true, 0.0);
        if let Some((speed, force)) = motor {
            let r = self.row(p, [1.0, 0.0, 0.0], true, speed);
            (self.lo[r], self.hi[r]) = (-force, force);
        }
        if let Some(c) = limit {
            let r = self.row(p, [1.0, 0.0, 0.0], true, c);
            self.lo[r] = 0.0;
        }
    }

    /// A contact with normal `n` into the first body.
    pub fn contact(&mut self, a: u32, b: u32, p: [f64; 3], n: [f64; 3], depth: f64, mu: f64) {
        self.begin(a, b);
        let normal = self.row(p, n, false, 0.2 / self.h * depth);
        self.lo[normal] = 0.0;
        if mu > 0.0 {
            let t = if n[2].abs() > 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
            let t2 = cross(n, t);
            let t1 = cross(t2, n);
            for t in [t1, t2] {
                let l = (t[0] * t[0] + t[1] * t[1] + t[2] * t[2]).sqrt();
                let r = self.row(p, t.map(|x| x / l), false, 0.0);
                (self.lo[r], self.hi[r], self.findex[r]) = (-mu, mu, normal as i32);
            }
        }
    }

    /// Four contacts under a box of the size given, on the body or ground below.
    pub fn face(&mut self, a: u32, b: u32, size: [f64; 3], depth: f64, mu: f64) {
        let c = self.bodies[a as usize].position;
        for (sx, sy) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let p = [c[0] + 0.5 * sx * size[0], c[1] + 0.5 * sy * size[1], c[2] - 0.5 * size[2]];
            self.contact(a, b, p, [0.0, 0.0, 1.0], depth, mu);
        }
    }

    pub fn problem(&mut self) -> SparseLcp<'_> {
        SparseLcp {
            bodies: self.bodies.len(),
            blocks: &self.blocks,
            jacobian: &self.jacobian,
            sigma: &self.sigma,
            rhs: &self.rhs,
            lo: &self.lo,
            hi: &self.hi,
            findex: &self.findex,
            states: &mut self.states,
            x: &mut self.x,
        }
    }

    /// The dense lower triangle, leading dimension `m`.
    pub fn dense(&self) -> Vec<f64> {
        let m = self.rhs.len();
        let mut a = vec![0.0; m * m];
        let mut rows = vec![Vec::<(u32, usize)>::new(); m];
        for block in &self.blocks {
            for r in block.first..block.first + block.count {
                for (side, body) in block.bodies.iter().enumerate() {
                    if *body != WORLD {
                        rows[r as usize].push((*body, side));
                    }
                }
            }
        }
        for r in 0..m {
            for c in 0..=r {
                for (body, s) in &rows[r] {
                    for (other, t) in &rows[c] {
                        if body == other {
                            for i in 0..6 {
                                a[r * m + c] += self.jacobian[r][*s][i] * self.jacobian[c][*t][i];
                            }
                        }
                    }
                }
            }
            a[r * m + r] += self.sigma[r];
        }
        a
    }

    /// The velocities after the step for forces `x`.
    pub fn velocities(&self, x: &[f64]) -> Vec<[f64; 6]> {
        let mut force = vec![[0.0; 6]; self.bodies.len()];
        for block in &self.blocks {
            let range = block.first as usize..(block.first + block.count) as usize;
            for (row, x) in self.jacobian[range.clone()].iter().zip(&x[range]) {
                for (body, row) in block.bodies.iter().zip(row) {
                    if *body != WORLD {
                        force[*body as usize].iter_mut().zip(row).for_each(|(f, j)| *f += j * x);
                    }
                }
            }
        }
        let bodies = self.bodies.iter().zip(force);
        bodies
            .map(|(b, f)| {
                let mut v = b.velocity;
                for i in 0..6 {
                    let gravity = if i == 2 { -9.81 } else { 0.0 };
                    v[i] += self.h * (gravity + b.scale[i] * f[i]);
                }
                v
            })
            .collect()
    }
}

/// A random island: chains and trees of joints with motors and limits, loops, doubled joints, boxes on four contacts, on the ground and on
/// each other, sliding or at rest; masses to 1:10,000.
pub fn random(seed: u64) -> Island {
    let mut r = Random(seed.wrapping_mul(0x9E37_79B9).wrapping_add(12345));
    for _ in 0..4 {
        r.next();
    }
    let h = [0.01, 1.0 / 60.0, 0.0025][r.below(3)];
    let cfm = [1e-10, 1e-10, 1e-9, 1e-5][r.below(4)];
    let mut island = Island::new(h, cfm);
    let n = 3 + r.below(14);
    let heavy = [0.0, 1.0, 2.0, 4.0][r.below(4)];
    let moving = if r.unit() < 0.5 { 1.0 } else { 0.0 };
    let mu = [0.0, 0.3, 0.5, 1.0][r.below(4)];
    // Position errors of a tree can all be corrected. In loops they contradict each other, and with the usual CFM errors of a
    // millimetre would ask for forces of 1e8 N, where nothing is known to 1e-9.
    let tree = r.unit() < 0.5;
    let error = if tree { 1e-3 } else { 1e-6 };
    let size = [1.0, 0.8, 0.5];
    for i in 0..n {
        let mass = ferrode_math::real::exp(heavy * r.unit() * std::f64::consts::LN_10);
        let mut v = [0.0; 6];
        for x in &mut v {
            *x = moving * r.range(-1.0, 1.0);
        }
        island.add_body(
            mass,
            size,
            [1.1 * (i % 4) as f64, 1.1 * (i / 4 % 2) as f64, 0.25 + 0.5 * (i / 8) as f64],
            v,
        );
    }
    for i in 0..n as u32 {
        let p = island.bodies[i as usize].position;
        let noise = r.vector().map(|x| error * x);
        match r.below(6) {
            0 if i > 0 => {
                let other = r.below(i as usize) as u32;
                let q = r.vector();
                island.ball(i, other, [0, 1, 2].map(|k| p[k] + 0.3 * q[k]), noise);
            }
            1 | 2 if i > 0 => {
                let other = r.below(i as usize) as u32;
                let motor = (r.unit() < 0.6).then(|| (r.range(-2.0, 2.0), r.range(0.0, 30.0)));
                let limit = (r.unit() < 0.4).then(|| if tree { r.range(-1.0, 1.0) } else { -r.unit() });
                island.hinge(i, other, p, motor, limit);
                if !tree && r.unit() < 0.3 {
                    // The same hinge again.
                    island.hinge(i, other, p, None, None);
                }
            }
            3 if !tree => island.ball(i, WORLD, p.map(|x| x + 0.4), noise),
            _ => {
                let below = if i >= 8 { i - 8 } else { WORLD };
                island.face(i, below, size, r.range(0.0, error), mu);
            }
        }
        if !tree && i > 1 && r.unit() < 0.4 {
            // Closes a loop.
            let other = r.below(i as usize) as u32;
            island.ball(other, i, p.map(|x| x - 0.2), [0.0; 3]);
        }
    }
    island
}
