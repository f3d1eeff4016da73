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
    /// Islands in which `Direct` gave up: the rows from the failing one on got no force, as in ODE.
    pub lcp_failures: usize,
    /// Bodies that this step took out of the simulation because they or the forces on them were not finite.
    pub quarantined: Vec<BodyKey>,
}

impl StepReport {
    pub(crate) fn count_island(&mut self, bodies: usize, rows: usize, solved: crate::solve::Solved) {
        self.islands += 1;
        self.bodies += bodies;
        self.rows += rows;
        self.largest_island_rows = self.largest_island_rows.max(rows);
        self.lcp_failures += usize::from(solved == crate::solve::Solved::Partly);
    }
}
