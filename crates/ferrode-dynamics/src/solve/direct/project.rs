//! Bodies moved back to where their joints hold together, after they were moved along the tangents of their paths.
//!
//! With the errors e of the joints' rows, the displacement δ is the least in terms of kinetic energy that takes them out to first order:
//!
//! ```text
//! min ½ δᵀ M δ   with   J δ = e      that is      (J M⁻¹ Jᵀ + S) μ = e,   δ = M⁻¹ Jᵀ μ
//! ```
//!
//! a step of Newton's method, by the solver of the step itself, of which only the rows without bounds are there. (M. B. Cline and D. K. Pai,
//! "Post-stabilization for rigid body simulation with contact and constraints", ICRA 2003.)

use super::{DirectSettings, Problem, RowSystem, Start, WarmStart, jacobian, sparse};
use crate::ends::StepContext;
use crate::report::IslandSolve;
use crate::rows::{NO_FRICTION_INDEX, Row, RowKind};
use crate::step::Island;
use ferrode_math::Vec3;

/// What is added to the diagonal, as a part of it: rows that say the same share what they push with, and those that contradict each other stay
/// harmless. It leaves as much of the error as it lets through; the next step sees that.
const SOFTNESS: f64 = 1e-9;
/// CFM up to which a row is rigid, whatever the world's.
const LEAST_CFM: f64 = 1e-9;
/// Largest speed at which errors are taken out, in m/s or rad/s: joints made between bodies far apart don't snap shut.
const MOST_SPEED: f64 = 20.0;

/// How far a body has to move (m) and turn (rad), in the world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Displacement {
    pub linear: Vec3,
    pub angular: Vec3,
}

/// Memory of the method.
#[derive(Clone, Debug, Default)]
pub(super) struct Workspace {
    system: RowSystem,
    sparse: sparse::Workspace,
    moves: Vec<Displacement>,
}

/// Keeps those of the rows from `first` on that hold a joint together. What they ask for are their errors, as far as these may be taken out in
/// a step.
pub(crate) fn keep_rigid(rows: &mut Vec<Row>, first: usize, ctx: &StepContext) {
    let most = MOST_SPEED * ctx.h;
    let mut kept = first;
    for i in first..rows.len() {
        let row = rows[i];
        let free = row.lo == f64::NEG_INFINITY && row.hi == f64::INFINITY;
        if row.kind == RowKind::Joint
            && free
            && row.cfm <= ctx.cfm.max(LEAST_CFM)
            && row.position_error.is_finite()
        {
            rows[kept] = Row { c: row.position_error.clamp(-most, most), cfm: 0.0, ..row };
            kept += 1;
        }
    }
    rows.truncate(kept);
}

impl Workspace {
    pub fn solve(
        &mut self,
        island: &mut Island,
        settings: &DirectSettings,
        number: usize,
    ) -> &[Displacement] {
        self.moves.clear();
        if island.rows.iter().all(|row| row.c == 0.0) {
            return &self.moves;
        }
        let Self { system, sparse, moves } = self;
        system.load_errors(island);
        island.lambda.clear();
        island.lambda.resize(island.rows.len(), 0.0);
        let settings = DirectSettings { warm_start: false, ..*settings };
        let mut report = IslandSolve::default();
        let problem = Problem { settings: &settings, number, warm: &WarmStart::default() };
        sparse::solve(island, system, problem, Start::Step, sparse, &mut report);
        moves.resize(island.bodies.len(), Displacement::default());
        for span in &island.spans {
            let range = span.first..span.first + span.count.rows;
            for (row, push) in island.rows[range.clone()].iter().zip(&island.lambda[range]) {
                for (side, place) in span.bodies.into_iter().enumerate() {
                    if let Some(sum) = moves.get_mut(place as usize) {
                        let (linear, angular) = jacobian(row, side as u32);
                        sum.linear += linear * *push;
                        sum.angular += angular * *push;
                    }
                }
            }
        }
        for (sum, body) in moves.iter_mut().zip(&island.bodies) {
            sum.linear *= body.inv_mass;
            sum.angular = body.inv_inertia * sum.angular;
        }
        moves
    }
}

impl RowSystem {
    /// The rows ask for their errors.
    fn load_errors(&mut self, island: &Island) {
        let m = island.rows.len();
        self.rhs.clear();
        self.sigma.clear();
        for span in &island.spans {
            for row in &island.rows[span.first..span.first + span.count.rows] {
                let weight = |place: u32, linear: Vec3, angular: Vec3| {
                    let body = island.bodies.get(place as usize);
                    body.map_or(0.0, |b| {
                        linear.length_squared() * b.inv_mass + angular.dot(b.inv_inertia * angular)
                    })
                };
                let diagonal = weight(span.bodies[0], row.linear1, row.angular1)
                    + weight(span.bodies[1], row.linear2, row.angular2);
                self.rhs.push(row.c);
                self.sigma.push(SOFTNESS * diagonal);
            }
        }
        for (list, value) in [(&mut self.lo, f64::NEG_INFINITY), (&mut self.hi, f64::INFINITY)] {
            list.clear();
            list.resize(m, value);
        }
        self.findex.clear();
        self.findex.resize(m, NO_FRICTION_INDEX);
    }
}
