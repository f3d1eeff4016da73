//! `Direct`: the exact solution of the boxed linear complementarity problem, by Dantzig's pivoting on the dense matrix.

use super::{FreeMotion, Solved, free_motions, right_hand_side};
use crate::rows::{NO_FRICTION_INDEX, Row, RowCount};
use crate::step::{Island, JointSpan, SolverBody};
use ferrode_lcp::dantzig::{DantzigStatus, DantzigWorkspace, solve_dantzig};
use ferrode_lcp::dense::pad;
use ferrode_lcp::problem::BoxedLcp;
use ferrode_math::Vec3;
use std::collections::VecDeque;

/// Memory of the stepper.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    free: Vec<FreeMotion>,
    /// The system matrix J M⁻¹ Jᵀ + CFM/h; its lower triangle counts.
    matrix: Vec<f64>,
    /// For each row the first column of the matrix that is used; what lies left of it holds old numbers.
    first: Vec<u32>,
    /// M⁻¹ Jᵀ, transposed: for each row, linear and angular part for both bodies.
    inv_mass_j: Vec<[Vec3; 4]>,
    rhs: Vec<f64>,
    lo: Vec<f64>,
    hi: Vec<f64>,
    findex: Vec<i32>,
    w: Vec<f64>,
    /// For each body, the spans that act on it and on which side: `starts[b]..starts[b + 1]` in `at_body`.
    starts: Vec<usize>,
    at_body: Vec<(u32, u32)>,
    dantzig: DantzigWorkspace,
}

/// Puts an island's joints into ODE's order: those without bounds, mixed ones, bounded ones.
///
/// Within the classes ODE's two-ended scheme decides; only rounding, and the choice among equal solutions, depends on
/// it.
pub(crate) fn arrange(spans: &mut Vec<JointSpan>) {
    let (mut unbounded, mut mixed, mut bounded) = (VecDeque::new(), VecDeque::new(), VecDeque::new());
    let mut forward = true;
    for span in spans.drain(..) {
        match class(span.count) {
            Class::Unbounded => {
                unbounded.push_front(span);
                forward = false;
            }
            Class::Bounded => {
                bounded.push_back(span);
                forward = true;
            }
            Class::Mixed if forward => {
                if unbounded.is_empty() {
                    mixed.push_front(span);
                } else {
                    if !bounded.is_empty() {
                        bounded.rotate_left(1);
                    }
                    mixed.push_back(span);
                }
            }
            Class::Mixed => {
                if bounded.is_empty() {
                    mixed.push_back(span);
                } else {
                    if !unbounded.is_empty() {
                        unbounded.rotate_right(1);
                    }
                    mixed.push_front(span);
                }
            }
        }
    }
    spans.extend(unbounded.into_iter().chain(mixed).chain(bounded));
}

enum Class {
    Unbounded,
    Mixed,
    Bounded,
}

fn class(count: RowCount) -> Class {
    match count.unbounded {
        0 => Class::Bounded,
        n if n == count.rows => Class::Unbounded,
        _ => Class::Mixed,
    }
}

/// Finds the forces of an island's rows.
pub(crate) fn solve(island: &mut Island, h: f64, work: &mut Workspace) -> Solved {
    let m = island.rows.len();
    island.lambda.clear();
    island.lambda.resize(m, 0.0);
    if m == 0 {
        return Solved::Completely;
    }
    let fps = 1.0 / h;
    free_motions(&island.bodies, fps, &mut work.free);
    work.load_rows(island, fps);
    work.build_matrix(island, fps);
    work.w.clear();
    work.w.resize(m, 0.0);
    let mut problem = BoxedLcp {
        n: m,
        a: &work.matrix,
        stride: pad(m),
        first: Some(&work.first),
        b: &work.rhs,
        lo: &work.lo,
        hi: &work.hi,
        findex: &work.findex,
        x: &mut island.lambda,
        w: &mut work.w,
    };
    match solve_dantzig(&mut problem, &mut work.dantzig) {
        Ok(report) if report.status == DantzigStatus::Solved => Solved::Completely,
        Ok(_) => Solved::Partly,
        Err(_) => {
            // Bounds that exclude zero: no force rather than a wrong one.
            island.lambda.fill(0.0);
            Solved::Partly
        }
    }
}

impl Workspace {
    /// Right-hand side, bounds and M⁻¹ Jᵀ of all rows.
    fn load_rows(&mut self, island: &Island, fps: f64) {
        self.rhs.clear();
        self.lo.clear();
        self.hi.clear();
        self.findex.clear();
        self.inv_mass_j.clear();
        for span in &island.spans {
            let [a, b] = span.bodies.map(|place| island.bodies.get(place as usize));
            for row in &island.rows[span.first..span.first + span.count.rows] {
                self.rhs.push(right_hand_side(row, span, fps, &self.free));
                self.lo.push(row.lo);
                self.hi.push(row.hi);
                self.findex.push(match row.friction_index {
                    NO_FRICTION_INDEX => -1,
                    local => span.first as i32 + local,
                });
                let [l1, a1] = inv_mass_times(a, row.linear1, row.angular1);
                let [l2, a2] = inv_mass_times(b, row.linear2, row.angular2);
                self.inv_mass_j.push([l1, a1, l2, a2]);
            }
        }
    }

    /// The lower triangle of J M⁻¹ Jᵀ + CFM/h. A block is nonzero only where two joints share a body.
    fn build_matrix(&mut self, island: &Island, fps: f64) {
        let m = island.rows.len();
        let stride = pad(m);
        if self.matrix.len() < m * stride {
            // Fresh zeroed memory costs nothing until it is touched.
            self.matrix = vec![0.0; m * stride];
        }
        self.list_spans_by_body(island);
        self.clear_band(island, stride);
        for body in 0..island.bodies.len() {
            if island.bodies[body].inv_mass == 0.0 {
                continue;
            }
            let at_body = &self.at_body[self.starts[body]..self.starts[body + 1]];
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
        for (r, row) in island.rows.iter().enumerate() {
            self.matrix[r * stride + r] += row.cfm * fps;
        }
    }

    /// Finds how far left each row reaches, to the first joint that shares a body with its own, and clears it from there to the
    /// diagonal.
    fn clear_band(&mut self, island: &Island, stride: usize) {
        self.first.clear();
        for span in &island.spans {
            let mut first = span.first;
            for place in span.bodies {
                let body = place as usize;
                if island.bodies.get(body).is_some_and(|b| b.inv_mass != 0.0) {
                    let (earliest, _) = self.at_body[self.starts[body]];
                    first = first.min(island.spans[earliest as usize].first);
                }
            }
            for row in span.first..span.first + span.count.rows {
                self.first.push(first as u32);
                self.matrix[row * stride + first..=row * stride + row].fill(0.0);
            }
        }
    }

    /// Counting sort of the spans by body; within a body they stay in the order of their rows.
    fn list_spans_by_body(&mut self, island: &Island) {
        self.starts.clear();
        self.starts.resize(island.bodies.len() + 2, 0);
        let n = island.bodies.len();
        for place in island.spans.iter().flat_map(|span| span.bodies) {
            if (place as usize) < n {
                self.starts[place as usize + 2] += 1;
            }
        }
        for i in 2..self.starts.len() {
            self.starts[i] += self.starts[i - 1];
        }
        self.at_body.clear();
        self.at_body.resize(*self.starts.last().unwrap_or(&0), (0, 0));
        for (index, span) in island.spans.iter().enumerate() {
            for (side, place) in span.bodies.into_iter().enumerate() {
                if (place as usize) < n {
                    let next = &mut self.starts[place as usize + 1];
                    self.at_body[*next] = (index as u32, side as u32);
                    *next += 1;
                }
            }
        }
    }
}

fn jacobian(row: &Row, side: u32) -> (Vec3, Vec3) {
    if side == 0 { (row.linear1, row.angular1) } else { (row.linear2, row.angular2) }
}

fn inv_mass_times(body: Option<&SolverBody>, linear: Vec3, angular: Vec3) -> [Vec3; 2] {
    match body {
        Some(b) => [linear * b.inv_mass, b.inv_inertia * angular],
        None => [Vec3::ZERO; 2],
    }
}

/// Adds the constraint forces Jᵀλ to all other forces of an island's bodies.
pub(crate) fn sum_forces(island: &mut Island, work: &mut Workspace) {
    if island.rows.is_empty() {
        return;
    }
    for body in 0..island.bodies.len() {
        let (mut force, mut torque) = (Vec3::ZERO, Vec3::ZERO);
        for (span, side) in &work.at_body[work.starts[body]..work.starts[body + 1]] {
            let span = &island.spans[*span as usize];
            let range = span.first..span.first + span.count.rows;
            for (row, lambda) in island.rows[range.clone()].iter().zip(&island.lambda[range]) {
                let (l, a) = jacobian(row, *side);
                force += l * *lambda;
                torque += a * *lambda;
            }
        }
        let b = &mut island.bodies[body];
        b.force = force + b.force;
        b.torque = torque + b.torque;
    }
}

/// The velocity after the step of one body.
pub(crate) fn update_velocity(body: &mut SolverBody, h: f64) {
    body.frame.linear_velocity += body.force * (h * body.inv_mass);
    body.frame.angular_velocity += body.inv_inertia * (body.torque * h);
}

#[cfg(test)]
mod tests {
    use super::arrange;
    use crate::rows::RowCount;
    use crate::step::JointSpan;

    #[test]
    fn joints_are_arranged_as_in_ode() {
        // dynamics.md 7.1: l1 m1 l2 u1 m2 u2 l3 m3 → u2 u1 | m2 m1 m3 | l2 l3 l1.
        let (l, m, u) = (RowCount::new(3, 0), RowCount::new(3, 2), RowCount::new(3, 3));
        let counts = [l, m, l, u, m, u, l, m];
        let mut spans: Vec<JointSpan> = counts
            .into_iter()
            .enumerate()
            .map(|(i, count)| JointSpan { joint: i as u32, bodies: [0; 2], first: 0, count })
            .collect();
        arrange(&mut spans);
        let order: Vec<u32> = spans.iter().map(|s| s.joint).collect();
        assert_eq!(order, [5, 3, 4, 1, 7, 2, 6, 0]);
    }
}
