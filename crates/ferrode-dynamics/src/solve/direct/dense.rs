//! Dantzig's pivoting on the dense matrix: ODE's way, and the reference.

use super::{RowSystem, SpansByBody, jacobian};
use crate::report::{DirectMethod, IslandSolve};
use crate::solve::Solved;
use crate::step::{Island, SolverBody};
use ferrode_lcp::dantzig::{DantzigStatus, DantzigWorkspace, solve_dantzig};
use ferrode_lcp::dense::pad;
use ferrode_lcp::problem::BoxedLcp;
use ferrode_lcp::residual::row_residual;
use ferrode_math::Vec3;

/// Memory of the method.
#[derive(Clone, Debug, Default)]
pub(super) struct Workspace {
    /// The system matrix J M⁻¹ Jᵀ + CFM/h; its lower triangle counts.
    matrix: Vec<f64>,
    /// For each row the first column of the matrix that is used; what lies left of it holds old numbers.
    first: Vec<u32>,
    /// M⁻¹ Jᵀ, transposed: for each row, linear and angular part for both bodies.
    inv_mass_j: Vec<[Vec3; 4]>,
    w: Vec<f64>,
    dantzig: DantzigWorkspace,
}

/// Finds the forces of an island's rows.
pub(super) fn solve(
    island: &mut Island,
    system: &RowSystem,
    spans: &SpansByBody,
    work: &mut Workspace,
    report: &mut IslandSolve,
) -> Solved {
    let m = island.rows.len();
    work.load_rows(island);
    work.build_matrix(island, system, spans);
    work.w.clear();
    work.w.resize(m, 0.0);
    let mut problem = BoxedLcp {
        n: m,
        a: &work.matrix,
        stride: pad(m),
        first: Some(&work.first),
        b: &system.rhs,
        lo: &system.lo,
        hi: &system.hi,
        findex: &system.findex,
        x: &mut island.lambda,
        w: &mut work.w,
    };
    report.method = DirectMethod::Dantzig;
    match solve_dantzig(&mut problem, &mut work.dantzig) {
        Ok(answer) => {
            report.factorisations = 1;
            work.measure(&island.lambda, system, report);
            if answer.status == DantzigStatus::Solved { Solved::Completely } else { Solved::Partly }
        }
        Err(_) => {
            // Bounds that exclude zero: no force rather than a wrong one.
            island.lambda.fill(0.0);
            report.residual = f64::INFINITY;
            Solved::Partly
        }
    }
}

impl Workspace {
    /// M⁻¹ Jᵀ of all rows.
    fn load_rows(&mut self, island: &Island) {
        self.inv_mass_j.clear();
        for span in &island.spans {
            let [a, b] = span.bodies.map(|place| island.bodies.get(place as usize));
            for row in &island.rows[span.first..span.first + span.count.rows] {
                let [l1, a1] = inv_mass_times(a, row.linear1, row.angular1);
                let [l2, a2] = inv_mass_times(b, row.linear2, row.angular2);
                self.inv_mass_j.push([l1, a1, l2, a2]);
            }
        }
    }

    /// The lower triangle of J M⁻¹ Jᵀ + CFM/h. A block is nonzero only where two joints share a body.
    fn build_matrix(&mut self, island: &Island, system: &RowSystem, spans: &SpansByBody) {
        let m = island.rows.len();
        let stride = pad(m);
        if self.matrix.len() < m * stride {
            // Fresh zeroed memory costs nothing until it is touched.
            self.matrix = vec![0.0; m * stride];
        }
        self.clear_band(island, spans, stride);
        for body in 0..island.bodies.len() {
            if island.bodies[body].inv_mass == 0.0 {
                continue;
            }
            let at_body = &spans.at_body[spans.starts[body]..spans.starts[body + 1]];
            for (i, (low_span, low_side)) in at_body.iter().enumerate() {
                let low = &island.spans[*low_span as usize];
                for (high_span, high_side) in &at_body[..=i] {
                    let high = &island.spans[*high_span as usize];
                    for r in low.first..low.first + low.count.rows {
                        let side = 2 * *low_side as usize;
                        let (linear, angular) = (self.inv_mass_j[r][side], self.inv_mass_j[r][side + 1]);
                        let end = (high.first + high.count.rows).min(r + 1);
                        let out = &mut self.matrix[r * stride + high.first..r * stride + end];
                        for (out, row) in out.iter_mut().zip(&island.rows[high.first..end]) {
                            let (l, a) = jacobian(row, *high_side);
                            *out += linear.dot(l) + angular.dot(a);
                        }
                    }
                }
            }
        }
        for (r, sigma) in system.sigma.iter().enumerate() {
            self.matrix[r * stride + r] += sigma;
        }
    }

    /// Finds how far left each row reaches, to the first joint that shares a body with its own, and clears it from there to the
    /// diagonal.
    fn clear_band(&mut self, island: &Island, spans: &SpansByBody, stride: usize) {
        self.first.clear();
        for span in &island.spans {
            let mut first = span.first;
            for place in span.bodies {
                let body = place as usize;
                if island.bodies.get(body).is_some_and(|b| b.inv_mass != 0.0) {
                    let (earliest, _) = spans.at_body[spans.starts[body]];
                    first = first.min(island.spans[earliest as usize].first);
                }
            }
            for row in span.first..span.first + span.count.rows {
                self.first.push(first as u32);
                self.matrix[row * stride + first..=row * stride + row].fill(0.0);
            }
        }
    }

    /// The natural residual, with the bounds that friction was frozen at.
    fn measure(&mut self, x: &[f64], system: &RowSystem, report: &mut IslandSolve) {
        let (m, stride) = (x.len(), pad(x.len()));
        for (w, rhs) in self.w.iter_mut().zip(&system.rhs) {
            *w = -rhs;
        }
        for r in 0..m {
            let row = &self.matrix[r * stride..][..=r];
            let mut sum = 0.0;
            for c in self.first[r] as usize..r {
                sum += row[c] * x[c];
                self.w[c] += row[c] * x[r];
            }
            self.w[r] += sum + row[r] * x[r];
        }
        let (lo, hi) = (self.dantzig.lower_bounds(), self.dantzig.upper_bounds());
        for r in 0..m {
            let residual = row_residual(x[r], self.w[r], self.matrix[r * stride + r], lo[r], hi[r]);
            if residual > report.residual || residual.is_nan() {
                report.residual = residual;
            }
            report.largest_force =
                if x[r].abs() > report.largest_force { x[r].abs() } else { report.largest_force };
        }
    }
}

fn inv_mass_times(body: Option<&SolverBody>, linear: Vec3, angular: Vec3) -> [Vec3; 2] {
    match body {
        Some(b) => [linear * b.inv_mass, b.inv_inertia * angular],
        None => [Vec3::ZERO; 2],
    }
}
