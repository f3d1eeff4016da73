//! Block pivoting on the sparse factorisation (`ferrode_lcp::pivoting`): hands it rows scaled by the bodies' masses.
//!
//! With M⁻¹ = C Cᵀ per body (C: the root of the inverse mass, and the Cholesky factor of the inverse inertia) a row's Jacobian becomes J C.

use super::twelve::Root;
use super::warm::{Name, WarmStart};
use super::{DirectSettings, Problem, RowSystem, Start};
use crate::report::{DirectMethod, IslandSolve};
use crate::rows::RowKind;
use crate::solve::Solved;
use crate::step::{Island, JointSpan};
use ferrode_lcp::{
    AbreastWorkspace, NO_SPARSE_BODY, PivotingOptions, PivotingReport, PivotingWorkspace, RowBlock, RowState,
    ScaledRow, SparseLcp, solve_pivoting,
};
use ferrode_math::Mat3;
use ferrode_math::simd::{Quad, QuadKernel, dispatch_quads};

/// Memory of the method.
#[derive(Clone, Debug, Default)]
pub(super) struct Workspace {
    /// C of each body.
    roots: Vec<Root>,
    blocks: Vec<RowBlock>,
    jacobian: Vec<ScaledRow>,
    states: Vec<[Option<RowState>; 2]>,
    pivoting: PivotingWorkspace,
    /// What names the rows of each span, if that was asked; none if none of the rows has a bound.
    names: Vec<Option<Name>>,
    abreast: AbreastWorkspace,
    /// The states of a step's first answer, to be remembered; empty if there is none.
    answered: Vec<[Option<RowState>; 2]>,
}

/// C of a body.
fn root(inv_mass: f64, inv_inertia: &Mat3) -> Root {
    let a = &inv_inertia.rows;
    // A direction without inverse inertia gives a column of zeros.
    let root = |x: f64| if x > 0.0 { x.sqrt() } else { 0.0 };
    let over = |x: f64, d: f64| if d > 0.0 { x / d } else { 0.0 };
    let l00 = root(a[0][0]);
    let (l10, l20) = (over(a[1][0], l00), over(a[2][0], l00));
    let l11 = root(a[1][1] - l10 * l10);
    let l21 = over(a[2][1] - l20 * l10, l11);
    let l22 = root((a[2][2] - l20 * l20) - l21 * l21);
    Root::new(root(inv_mass), [l00, l10, l11, l20, l21, l22])
}

/// Finds the forces of an island's rows.
pub(super) fn solve(
    island: &mut Island,
    system: &RowSystem,
    problem: Problem<'_>,
    start: Start,
    work: &mut Workspace,
    report: &mut IslandSolve,
) -> Solved {
    work.begin(island, problem, start);
    let mut pivoting = core::mem::take(&mut work.pivoting);
    let answer = solve_pivoting(&mut work.lcp(island, system), &options(problem), &mut pivoting);
    work.pivoting = pivoting;
    report.method = DirectMethod::BlockPivoting;
    match answer {
        Ok(answer) => work.end(island, answer, (problem.settings, start), report),
        Err(_) => {
            // Bounds that exclude zero: no force rather than a wrong one.
            island.lambda.fill(0.0);
            report.residual = f64::INFINITY;
            Solved::Partly
        }
    }
}

pub(super) fn options(Problem { settings, number, .. }: Problem<'_>) -> PivotingOptions {
    PivotingOptions {
        max_factorisations: settings.max_factorisations,
        most_dense_rows: settings.most_dense_rows,
        topology: number,
    }
}

impl Workspace {
    /// Makes the rows and their guesses ready.
    pub fn begin(&mut self, island: &Island, Problem { settings, warm, .. }: Problem<'_>, start: Start) {
        self.load(island);
        if start == Start::Step || self.states.len() != island.rows.len() {
            self.guess(island, settings.warm_start.then_some(warm));
        }
    }

    /// The problem that is ready; its answer goes to the island.
    pub fn lcp<'a>(&'a mut self, island: &'a mut Island, system: &'a RowSystem) -> SparseLcp<'a> {
        SparseLcp {
            bodies: island.bodies.len(),
            blocks: &self.blocks,
            jacobian: &self.jacobian,
            sigma: &system.sigma,
            rhs: &system.rhs,
            lo: &system.lo,
            hi: &system.hi,
            findex: &system.findex,
            states: &mut self.states,
            x: &mut island.lambda,
        }
    }

    /// Reports an answer.
    pub fn end(
        &mut self,
        island: &mut Island,
        answer: PivotingReport,
        (settings, start): (&DirectSettings, Start),
        report: &mut IslandSolve,
    ) -> Solved {
        report.method = DirectMethod::BlockPivoting;
        report.factorisations = answer.factorisations;
        report.newton_steps = answer.newton_steps;
        report.fell_back |= answer.fell_back;
        report.residual = answer.residual;
        report.largest_force = answer.largest;
        report.factor_blocks = answer.factor_blocks;
        if !island.lambda.iter().all(|x| x.is_finite()) {
            island.lambda.fill(0.0);
            return Solved::Partly;
        }
        if settings.warm_start && start == Start::Step {
            self.answered.clone_from(&self.states);
        }
        if report.certified() { Solved::Completely } else { Solved::Partly }
    }

    /// Lends out the memory of solves.
    pub fn take_memory(&mut self) -> (PivotingWorkspace, AbreastWorkspace) {
        (core::mem::take(&mut self.pivoting), core::mem::take(&mut self.abreast))
    }

    pub fn give_memory(&mut self, pivoting: PivotingWorkspace, abreast: AbreastWorkspace) {
        (self.pivoting, self.abreast) = (pivoting, abreast);
    }

    fn load(&mut self, island: &Island) {
        self.roots.clear();
        self.roots.extend(island.bodies.iter().map(|b| root(b.inv_mass, &b.inv_inertia)));
        self.blocks.clear();
        for span in &island.spans {
            let bodies = span.bodies.map(|place| {
                let moves = self.roots.get(place as usize).is_some_and(|root| !root.is_zero());
                if moves { place } else { NO_SPARSE_BODY }
            });
            self.blocks.push(RowBlock { bodies, first: span.first as u32, count: span.count.rows as u32 });
        }
        self.jacobian.resize(island.rows.len(), [[0.0; 6]; 2]);
        dispatch_quads(Scale { roots: &self.roots, island, jacobian: &mut self.jacobian });
    }

    /// Asks what the rows did in the step before.
    fn guess(&mut self, island: &Island, warm: Option<&WarmStart>) {
        self.states.clear();
        self.states.resize(island.rows.len(), [None; 2]);
        let Some(warm) = warm else { return };
        self.names.clear();
        self.names.extend(island.spans.iter().map(|span| name(island, span)));
        for (span, name) in island.spans.iter().zip(&self.names) {
            if let Some(name) = name
                && let Some(states) = warm.find(*name)
            {
                let range = span.first..span.first + span.count.rows;
                for (out, row) in self.states[range.clone()].iter_mut().zip(&island.rows[range]) {
                    *out = states[usize::from(row.slot) & 7];
                }
            }
        }
    }

    /// Keeps the states of an answer for the next step.
    pub fn remember(&mut self, island: &Island, warm: &mut WarmStart) {
        if self.answered.len() == island.rows.len() {
            for (span, name) in island.spans.iter().zip(&self.names) {
                if let Some(name) = name {
                    let mut states = [[None; 2]; 8];
                    let range = span.first..span.first + span.count.rows;
                    for (state, row) in self.answered[range.clone()].iter().zip(&island.rows[range]) {
                        states[usize::from(row.slot) & 7] = *state;
                    }
                    warm.add(*name, states);
                }
            }
        }
        self.answered.clear();
    }
}

/// Scales the rows.
struct Scale<'a> {
    roots: &'a [Root],
    island: &'a Island,
    jacobian: &'a mut [ScaledRow],
}

impl QuadKernel for Scale<'_> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        let Self { roots, island, jacobian } = self;
        let immovable = Root::default();
        for span in &island.spans {
            let [a, b] = span.bodies;
            let a = if let Some(root) = roots.get(a as usize) { root } else { &immovable };
            let b = if let Some(root) = roots.get(b as usize) { root } else { &immovable };
            let range = span.first..span.first + span.count.rows;
            for (out, row) in jacobian[range.clone()].iter_mut().zip(&island.rows[range]) {
                a.apply::<Q>(row, 0, &mut out[0]);
                b.apply::<Q>(row, 1, &mut out[1]);
            }
        }
    }
}

/// What names the rows of a span from step to step; none if none of them has a bound.
fn name(island: &Island, span: &JointSpan) -> Option<Name> {
    if span.count.unbounded == span.count.rows {
        return None;
    }
    let rows = &island.rows[span.first..span.first + span.count.rows];
    // From the last row on: a joint's bounded ones come last.
    if rows.iter().rev().all(|row| row.lo == f64::NEG_INFINITY && row.hi == f64::INFINITY) {
        return None;
    }
    let first = rows.first()?;
    if first.kind == RowKind::Normal {
        // n × (r × n) is the point relative to the centre of mass, less its part along the normal.
        let body = island.bodies.get(span.bodies[0] as usize)?;
        let point = first.linear1.cross(first.angular1);
        let bodies = span.bodies.map(|b| island.slot(b));
        Some(Name::Contact(bodies, body.frame.rotation.transpose_mul(point)))
    } else {
        Some(Name::Joint(span.joint))
    }
}
