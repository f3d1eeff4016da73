//! Problems as physics poses them, for the timing programs.
#![allow(dead_code, reason = "each program uses a part")]

use ferrode_lcp::dense::pad;
use ferrode_lcp::{NO_BODY, SorRow};

type V = [f64; 3];

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub struct Body {
    pub position: V,
    pub velocity: V,
    pub spin: V,
    pub inv_mass: f64,
    pub inv_inertia: [f64; 9],
}

#[derive(Default)]
pub struct Scene {
    pub bodies: Vec<Body>,
    pub rows: Vec<SorRow>,
}

impl Scene {
    fn body(&mut self, position: V, inv_mass: f64, inv_inertia: [f64; 9]) -> u32 {
        self.bodies.push(Body { position, velocity: [0.0; 3], spin: [0.0; 3], inv_mass, inv_inertia });
        self.bodies.len() as u32 - 1
    }

    /// A row that acts along `axis` at `point`.
    fn row(&mut self, body: [u32; 2], point: V, axis: V, speed: f64, bounds: (f64, f64, i32)) {
        let h = 0.005;
        let mut j = [0.0; 12];
        let mut rhs = speed / h;
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            if let Some(b) = self.bodies.get(body[side] as usize) {
                let arm = [0, 1, 2].map(|k| point[k] - b.position[k]);
                let turn = cross(arm, axis);
                for k in 0..3 {
                    j[6 * side + k] = sign * axis[k];
                    j[6 * side + 3 + k] = sign * turn[k];
                    let gravity = if k == 2 { -9.81 } else { 0.0 };
                    rhs -= sign * (axis[k] * (b.velocity[k] / h + gravity) + turn[k] * b.spin[k] / h);
                }
            }
        }
        let (lo, hi, findex) = bounds;
        self.rows.push(SorRow { j, rhs, cfm: 1e-5 / h, lo, hi, findex, body });
    }

    fn ball(&mut self, body: [u32; 2], point: V) {
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            self.row(body, point, axis, 0.0, (f64::NEG_INFINITY, f64::INFINITY, -1));
        }
    }

    fn contact(&mut self, body: [u32; 2], point: V, normal: V, depth: f64) {
        let t1 = if normal[0].abs() > 0.7 {
            cross(normal, [0.0, 1.0, 0.0])
        } else {
            cross(normal, [1.0, 0.0, 0.0])
        };
        let size = (t1[0] * t1[0] + t1[1] * t1[1] + t1[2] * t1[2]).sqrt();
        let t1 = t1.map(|v| v / size);
        let first = self.rows.len() as i32;
        self.row(body, point, normal, 0.2 / 0.005 * depth, (0.0, f64::INFINITY, -1));
        self.row(body, point, t1, 0.0, (0.0, 0.5, first));
        self.row(body, point, cross(normal, t1), 0.0, (0.0, 0.5, first));
    }

    /// `A = J M^-1 J^T + C`, dense.
    pub fn matrix(&self) -> (Vec<f64>, usize) {
        let n = self.rows.len();
        let stride = pad(n);
        let mut a = vec![0.0; n * stride];
        for (i, r) in self.rows.iter().enumerate() {
            for (j, q) in self.rows.iter().enumerate().take(i + 1) {
                let mut sum = if i == j { r.cfm } else { 0.0 };
                for side in 0..2 {
                    for other in 0..2 {
                        if r.body[side] == q.body[other]
                            && let Some(b) = self.bodies.get(r.body[side] as usize)
                        {
                            for k in 0..3 {
                                sum += r.j[6 * side + k] * b.inv_mass * q.j[6 * other + k];
                                for l in 0..3 {
                                    sum += r.j[6 * side + 3 + k]
                                        * b.inv_inertia[3 * k + l]
                                        * q.j[6 * other + 3 + l];
                                }
                            }
                        }
                    }
                }
                a[i * stride + j] = sum;
            }
        }
        (a, stride)
    }
}

fn unit(d: f64) -> [f64; 9] {
    [d, 0.0, 0.0, 0.0, d, 0.0, 0.0, 0.0, d]
}

/// A chain hanging out sideways, with a stop at every `limits`-th link.
pub fn chain(links: usize, limits: usize) -> Scene {
    let mut s = Scene::default();
    let mut previous = NO_BODY;
    for i in 0..links {
        let b = s.body([i as f64 + 0.5, 0.0, 0.0], 1.0, unit(250.0));
        s.ball([b, previous], [i as f64, 0.0, 0.0]);
        if limits > 0 && i % limits == limits - 1 {
            s.row([b, previous], [i as f64, 0.1, 0.0], [0.0, 0.0, 1.0], 0.01, (0.0, f64::INFINITY, -1));
        }
        previous = b;
    }
    s
}

/// Boxes in a grid, each touching its neighbours and the floor with four points.
pub fn heap(side: usize, layers: usize) -> Scene {
    let mut s = Scene::default();
    let at = |i: usize, j: usize, k: usize| (i + side * (j + side * k)) as u32;
    for k in 0..layers {
        for j in 0..side {
            for i in 0..side {
                s.body([i as f64 + 0.03 * k as f64, j as f64, k as f64 + 0.5], 1.0, unit(6.0));
            }
        }
    }
    for k in 0..layers {
        for j in 0..side {
            for i in 0..side {
                let (x, y, z) = (i as f64, j as f64, k as f64);
                let below = if k > 0 { at(i, j, k - 1) } else { NO_BODY };
                for (dx, dy) in [(-0.4, -0.4), (-0.4, 0.4), (0.4, -0.4), (0.4, 0.4)] {
                    s.contact([at(i, j, k), below], [x + dx, y + dy, z], [0.0, 0.0, 1.0], 0.001);
                    if i > 0 {
                        s.contact(
                            [at(i, j, k), at(i - 1, j, k)],
                            [x - 0.5, y + dx, z + dy],
                            [1.0, 0.0, 0.0],
                            0.0005,
                        );
                    }
                }
            }
        }
    }
    s
}

pub fn pile(text: &str) -> Option<Scene> {
    let mut s = Scene::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let kind = words.next()?;
        let v: Vec<f64> = words.map_while(|w| w.parse().ok()).collect();
        let three = |at: usize| -> V { [v[at], v[at + 1], v[at + 2]] };
        match (kind, v.len()) {
            ("b", 22) => {
                let mut inverse = [0.0; 9];
                for r in 0..3 {
                    for c in 0..3 {
                        inverse[3 * r + c] =
                            (0..3).map(|k| v[9 + 3 * r + k] / v[19 + k] * v[9 + 3 * c + k]).sum();
                    }
                }
                s.bodies.push(Body {
                    position: three(0),
                    velocity: three(3),
                    spin: three(6),
                    inv_mass: 1.0 / v[18],
                    inv_inertia: inverse,
                });
            }
            ("c", 9) => {
                let (b0, b1, mut normal) = (v[0], v[1], three(5));
                let number = |b: f64| if b < 0.0 { NO_BODY } else { b as u32 };
                let mut body = [number(b0), number(b1)];
                if b0 < 0.0 {
                    body.swap(0, 1);
                    normal = normal.map(|v| -v);
                }
                s.contact(body, three(2), normal, v[8]);
            }
            _ => return None,
        }
    }
    Some(s)
}
