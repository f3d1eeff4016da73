//! What a step tells about itself.

use crate::BodyKey;

/// What happened in a step.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct StepReport {
    /// Islands of awake bodies.
    pub islands: usize,
    /// Bodies that were stepped.
    pub bodies: usize,
    /// Constraint rows.
    pub rows: usize,
    /// Rows of the largest island.
    pub largest_island_rows: usize,
    /// Islands whose forces `Direct` could not certify ([`IslandSolve::certified`]), by any of its methods.
    pub lcp_failures: usize,
    /// How `Direct` solved each island that has rows, in the order of the islands.
    pub solves: Vec<IslandSolve>,
    /// Islands that `Quick` solved in fewer sweeps than set ([`crate::QuickSettings::dynamic`]).
    pub premature_exits: usize,
    /// Islands that took `Quick` some of the added sweeps.
    pub prolonged_solves: usize,
    /// Islands that took `Quick` all of the added sweeps.
    pub full_extra_solves: usize,
    /// Bodies that this step took out of the simulation because they or the forces on them were not finite.
    pub quarantined: Vec<BodyKey>,
}

/// The method that found an island's forces in `Direct`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DirectMethod {
    /// Dantzig's pivoting on the dense matrix.
    #[default]
    Dantzig,
    /// Block pivoting on a sparse factorisation.
    BlockPivoting,
}

/// How `Direct` solved an island.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct IslandSolve {
    /// Constraint rows.
    pub rows: usize,
    /// The method.
    pub method: DirectMethod,
    /// Factorisations, whole or of the part that changed. Dantzig's method keeps one up to date.
    pub factorisations: u32,
    /// How many of them block pivoting took with line search, because the number of wrong rows would not fall.
    pub newton_steps: u32,
    /// The natural residual max |λ − proj(λ − w/A)|, A being the diagonal, with friction bounds as they were frozen.
    pub residual: f64,
    /// The largest force of a row.
    pub largest_force: f64,
    /// Whether the method chosen first did not get to the end, and another had to help.
    pub fell_back: bool,
    /// Blocks of 6×6 numbers in the sparse factor; 0 for the dense method.
    pub factor_blocks: usize,
    /// How often the boxed problem was solved again for the friction cone; 0 with the pyramid.
    pub friction_sweeps: u32,
}

impl IslandSolve {
    /// Whether the residual is at most 1e-10 (1 + the largest force).
    pub fn certified(&self) -> bool {
        self.residual <= 1e-10 * (1.0 + self.largest_force)
    }
}

impl StepReport {
    /// Empties the report, but for its memory.
    pub(crate) fn clear(&mut self) {
        let mut solves = core::mem::take(&mut self.solves);
        let mut quarantined = core::mem::take(&mut self.quarantined);
        solves.clear();
        quarantined.clear();
        *self = Self { solves, quarantined, ..Self::default() };
    }

    pub(crate) fn count_exit(&mut self, exit: Option<ferrode_lcp::sor::SorExit>) {
        use ferrode_lcp::sor::SorExit;
        match exit {
            Some(SorExit::Premature) => self.premature_exits += 1,
            Some(SorExit::Prolonged) => self.prolonged_solves += 1,
            Some(SorExit::FullExtra) => self.full_extra_solves += 1,
            Some(SorExit::Completed) | None => {}
        }
    }

    pub(crate) fn count_island(&mut self, bodies: usize, rows: usize, solved: crate::solve::Solved) {
        self.islands += 1;
        self.bodies += bodies;
        self.rows += rows;
        self.largest_island_rows = self.largest_island_rows.max(rows);
        self.lcp_failures += usize::from(solved == crate::solve::Solved::Partly);
    }
}
