//! One answer from all ways there: which state a row gets that could have either.
//!
//! A degenerate row is at its bound with no slack: free or not, the forces are the same, but not to the last bit. Such rows are put at
//! their bound. Where several share a load, not all can be; those that must be free are let go again.

use super::{PivotingWorkspace, RowState, Solve, WRONG};

/// A row counts as degenerate when it is this close to changing its state.
pub(super) const DEGENERATE: f64 = 1e-9;
/// So often degenerate rows are looked for.
const MOST_ROUNDS: u32 = 6;

impl Solve<'_, '_> {
    /// Puts degenerate rows at their bound and solves once more, so that the way to the answer leaves no trace.
    pub(super) fn canonical(&mut self) {
        if !self.work.bounded.is_empty() {
            self.work.accepted.clone_from(&self.work.state);
            self.work.needed.clear();
            self.work.needed.resize(self.work.state.len(), false);
            if !self.put_at_bounds() {
                // They would not go there.
                self.work.state.clone_from(&self.work.accepted);
                self.solve_set();
                self.refine_set();
            }
        }
        let Self { p, shape, work, pass, .. } = self;
        work.system.polish(p.blocks, p.jacobian, &work.state, shape, *pass);
    }

    /// Puts rows at bounds until no free row is left there but those that must be free. Whether it came to an end.
    fn put_at_bounds(&mut self) -> bool {
        for _ in 0..MOST_ROUNDS {
            let PivotingWorkspace { system, state, needed, lo, hi, bounded, .. } = &mut *self.work;
            let close = DEGENERATE * (1.0 + self.largest);
            let mut degenerate = false;
            for row in bounded.iter().map(|row| *row as usize) {
                if state[row] != RowState::Free || needed[row] {
                    continue;
                }
                let lambda = system.lambda[row];
                if lambda - lo[row] < close {
                    (state[row], degenerate) = (RowState::Lower, true);
                } else if hi[row] - lambda < close {
                    (state[row], degenerate) = (RowState::Upper, true);
                }
            }
            if !degenerate {
                return true;
            }
            let mut wrong = usize::MAX;
            for _ in 0..MOST_ROUNDS {
                self.solve_set();
                if !self.largest.is_finite() {
                    return false;
                }
                self.refine_set();
                wrong = self.propose(WRONG);
                if wrong == 0 {
                    break;
                }
                let PivotingWorkspace { state, proposed, needed, .. } = &mut *self.work;
                for row in 0..state.len() {
                    needed[row] |= proposed[row] == RowState::Free && state[row] != RowState::Free;
                }
                core::mem::swap(state, proposed);
            }
            if wrong > 0 {
                return false;
            }
        }
        false
    }
}
