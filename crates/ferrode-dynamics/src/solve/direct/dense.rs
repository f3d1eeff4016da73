//! Dantzig's pivoting on the dense matrix: ODE's way, and the reference.
//!
//! Islands of usual size are solved on their rows with bounds alone (`ferrode_lcp::condensed`), the same pivoting in less time.
//! What that cannot solve to rounding, and larger ones, are solved with all rows.

use super::{RowSystem, SpansByBody, jacobian};
use crate::report::{DirectMethod, IslandSolve};
use crate::rows::Row;
use crate::solve::Solved;
use crate::step::{Island, SolverBody};
use ferrode_lcp::condensed::{CondensedWorkspace, solve_condensed};
use ferrode_lcp::dantzig::{DantzigStatus, DantzigWorkspace, solve_dantzig};
use ferrode_lcp::dense::pad;
use ferrode_lcp::problem::BoxedLcp;
use ferrode_lcp::residual::row_residual;
use ferrode_math::Vec3;
use ferrode_math::simd::{Quad, QuadKernel, dispatch_quads};

/// Memory of the method.
#[derive(Clone, Debug, Default)]
pub(super) struct Workspace {
    /// The system matrix J M⁻¹ Jᵀ + CFM/h; its lower triangle counts.
    matrix: Vec<f64>,
    /// For each row the first column of the matrix that is used; what lies left of it holds old numbers.
    first: Vec<u32>,
    /// M⁻¹ Jᵀ, transposed: for each row, linear and angular part for both bodies.
    inv_mass_j: Vec<[[f64; 6]; 2]>,
    /// J of some rows on one side, four rows at a time by columns; zeros after the last.
    columns: Vec<[[f64; 4]; 6]>,
    w: Vec<f64>,
    dantzig: DantzigWorkspace,
    condensed: CondensedWorkspace,
}

/// The most rows that are condensed: the tableau must stay small.
const MOST_CONDENSED_ROWS: usize = 200;

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
    if m <= MOST_CONDENSED_ROWS
        && let Ok(Some(answer)) = solve_condensed(&mut problem, &mut work.condensed)
    {
        report.factorisations = 1;
        report.residual = answer.residual;
        report.largest_force = answer.largest;
        return Solved::Completely;
    }
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
                self.inv_mass_j.push([six(l1, a1), six(l2, a2)]);
            }
        }
    }

    /// The lower triangle of J M⁻¹ Jᵀ + CFM/h. A block is nonzero only where two joints share a body.
    fn build_matrix(&mut self, island: &Island, system: &RowSystem, spans: &SpansByBody) {
        let m = island.rows.len();
        let stride = pad(m);
        // Zeros are added to up to three numbers behind a row's last.
        let size = m * stride + 4;
        if self.matrix.len() < size {
            // Fresh zeroed memory costs nothing until it is touched.
            self.matrix = vec![0.0; size];
        }
        self.clear_band(island, spans, stride);
        dispatch_quads(Products { work: self, island, spans });
        for (r, sigma) in system.sigma.iter().enumerate() {
            self.matrix[r * stride + r] += sigma;
        }
    }

    /// Finds how far left each row reaches, to the first joint that shares a body with its own, and clears it from there to the
    /// diagonal.
    fn clear_band(&mut self, island: &Island, spans: &SpansByBody, stride: usize) {
        self.first.clear();
        // A zero that the compiler does not know: it would make each row a call.
        let zero = core::hint::black_box(0.0);
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
                let numbers = &mut self.matrix[row * stride..][..stride];
                match numbers.as_chunks_mut::<4>() {
                    // In whole blocks: beyond the diagonal nothing counts.
                    (blocks, []) => blocks[first / 4..=row / 4].iter_mut().for_each(|b| *b = [zero; 4]),
                    (_, numbers) => numbers.fill(zero),
                }
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

/// Adds J M⁻¹ Jᵀ up, body by body, compiled for the machine.
struct Products<'a> {
    work: &'a mut Workspace,
    island: &'a Island,
    spans: &'a SpansByBody,
}

impl QuadKernel for Products<'_> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        let Self { work: Workspace { matrix, inv_mass_j, columns, .. }, island, spans } = self;
        let stride = pad(inv_mass_j.len());
        for (body, ends) in island.bodies.iter().zip(spans.starts.windows(2)) {
            if body.inv_mass == 0.0 {
                continue;
            }
            let at_body = &spans.at_body[ends[0]..ends[1]];
            let mut runs = at_body;
            // Spans whose rows follow each other, on the same side, are one run of columns.
            while let Some((span, side)) = runs.first() {
                let first = island.spans[*span as usize].first;
                let mut end = first;
                let mut count = 0;
                for (span, other) in runs {
                    let span = &island.spans[*span as usize];
                    if span.first != end || other != side {
                        break;
                    }
                    end += span.count.rows;
                    count += 1;
                }
                load_columns(&island.rows[first..end], *side, columns);
                // Within the run up to the diagonal, below it all of the run.
                for r in first..end {
                    let out = &mut matrix[r * stride + first..];
                    add_products::<Q>(out, &inv_mass_j[r][*side as usize], &columns[..=(r - first) / 4]);
                }
                for (low, low_side) in &at_body[at_body.len() - runs.len() + count..] {
                    let low = &island.spans[*low as usize];
                    for r in low.first..low.first + low.count.rows {
                        let out = &mut matrix[r * stride + first..];
                        add_products::<Q>(out, &inv_mass_j[r][*low_side as usize], columns);
                    }
                }
                runs = &runs[count..];
            }
        }
    }
}

/// Takes J of some rows on one side by columns.
#[inline(always)]
fn load_columns(rows: &[Row], side: u32, columns: &mut Vec<[[f64; 4]; 6]>) {
    columns.clear();
    columns.resize(rows.len().div_ceil(4), [[0.0; 4]; 6]);
    for (four, columns) in rows.chunks(4).zip(columns) {
        for (l, row) in four.iter().enumerate() {
            let (linear, angular) = jacobian(row, side);
            columns[0][l] = linear.x;
            columns[1][l] = linear.y;
            columns[2][l] = linear.z;
            columns[3][l] = angular.x;
            columns[4][l] = angular.y;
            columns[5][l] = angular.z;
        }
    }
}

/// Adds to `out` the products of `v` with the rows of `columns`, in whole fours.
#[inline(always)]
fn add_products<Q: Quad>(out: &mut [f64], v: &[f64; 6], columns: &[[[f64; 4]; 6]]) {
    let (v0, v1, v2) = (Q::splat(v[0]), Q::splat(v[1]), Q::splat(v[2]));
    let (v3, v4, v5) = (Q::splat(v[3]), Q::splat(v[4]), Q::splat(v[5]));
    for (out, [c0, c1, c2, c3, c4, c5]) in out.as_chunks_mut::<4>().0.iter_mut().zip(columns) {
        let linear = v0 * Q::load(c0) + v1 * Q::load(c1) + v2 * Q::load(c2);
        let angular = v3 * Q::load(c3) + v4 * Q::load(c4) + v5 * Q::load(c5);
        (Q::load(out) + (linear + angular)).store(out);
    }
}

fn six(l: Vec3, a: Vec3) -> [f64; 6] {
    [l.x, l.y, l.z, a.x, a.y, a.z]
}

fn inv_mass_times(body: Option<&SolverBody>, linear: Vec3, angular: Vec3) -> [Vec3; 2] {
    match body {
        Some(b) => [linear * b.inv_mass, b.inv_inertia * angular],
        None => [Vec3::ZERO; 2],
    }
}
