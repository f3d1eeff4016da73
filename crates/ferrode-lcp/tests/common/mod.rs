//! Problems and reference solvers that the tests share.
#![allow(dead_code, reason = "each test program uses a part")]

use ferrode_lcp::dense::pad;

/// A small generator of numbers in [-1, 1], so that a test is a function of its seed.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn below(&mut self, n: usize) -> usize {
        (((self.next() + 1.0) * 0.5 * n as f64) as usize).min(n - 1)
    }
}

/// A dense symmetric matrix with its leading dimension.
#[derive(Clone)]
pub struct Matrix {
    pub n: usize,
    pub stride: usize,
    pub a: Vec<f64>,
}

impl Matrix {
    pub fn zero(n: usize) -> Self {
        Self { n, stride: pad(n), a: vec![0.0; n * pad(n)] }
    }

    pub fn at(&self, i: usize, j: usize) -> f64 {
        let (i, j) = if i > j { (i, j) } else { (j, i) };
        self.a[i * self.stride + j]
    }

    /// `G G^T + shift`, G `n` x `rank` with numbers in [-1, 1]; `sparsity` of ten entries of G are zero.
    pub fn gram(n: usize, rank: usize, shift: f64, sparsity: usize, numbers: &mut Numbers) -> Self {
        let mut m = Self::zero(n);
        let g: Vec<f64> = (0..n * rank)
            .map(|_| {
                let v = numbers.next();
                if numbers.below(10) < sparsity { 0.0 } else { v }
            })
            .collect();
        for i in 0..n {
            for j in 0..=i {
                let dot: f64 = (0..rank).map(|k| g[i * rank + k] * g[j * rank + k]).sum();
                m.a[i * m.stride + j] = dot + if i == j { shift } else { 0.0 };
            }
        }
        m
    }
}

/// Solves a small dense system by Gaussian elimination with partial pivoting; `None` if singular.
pub fn gauss(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for k in 0..n {
        let p = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        a.swap(k, p);
        b.swap(k, p);
        if a[k][k].abs() < 1e-13 {
            return None;
        }
        for i in k + 1..n {
            let f = a[i][k] / a[k][k];
            let pivot_row = a[k].clone();
            for (x, p) in a[i].iter_mut().zip(&pivot_row).skip(k) {
                *x -= f * p;
            }
            b[i] -= f * b[k];
        }
    }
    for k in (0..n).rev() {
        for j in k + 1..n {
            b[k] -= a[k][j] * b[j];
        }
        b[k] /= a[k][k];
    }
    Some(b)
}

/// The solution of a boxed problem with fixed bounds by trying all assignments of rows to "free", "lower", "upper".
pub fn brute_force(m: &Matrix, b: &[f64], lo: &[f64], hi: &[f64]) -> Option<Vec<f64>> {
    let n = b.len();
    let tolerance = 1e-9;
    'assignments: for code in 0..3usize.pow(n as u32) {
        let mut rest = code;
        let mut state = vec![0; n];
        let mut x = vec![0.0; n];
        for i in 0..n {
            state[i] = rest % 3;
            rest /= 3;
            if state[i] > 0 {
                x[i] = if state[i] == 1 { lo[i] } else { hi[i] };
                if !x[i].is_finite() {
                    continue 'assignments;
                }
            }
        }
        let free: Vec<usize> = (0..n).filter(|&i| state[i] == 0).collect();
        let a = free.iter().map(|&i| free.iter().map(|&j| m.at(i, j)).collect()).collect();
        let rhs = free
            .iter()
            .map(|&i| b[i] - (0..n).filter(|&j| state[j] != 0).map(|j| m.at(i, j) * x[j]).sum::<f64>())
            .collect();
        let Some(solution) = gauss(a, rhs) else { continue };
        for (&i, s) in free.iter().zip(solution) {
            x[i] = s;
        }
        let fits = (0..n).all(|i| {
            let w: f64 = (0..n).map(|j| m.at(i, j) * x[j]).sum::<f64>() - b[i];
            match state[i] {
                0 => x[i] >= lo[i] - tolerance && x[i] <= hi[i] + tolerance,
                1 => w >= -tolerance,
                _ => w <= tolerance,
            }
        });
        if fits {
            return Some(x);
        }
    }
    None
}
