//! Joints projected onto their constraints at the end of a step of `Direct`, if its settings ask for it.

use super::{Island, JointSpan, SolverBody, ends_of};
use crate::World;
use crate::ends::StepContext;
use crate::integrate;
use crate::joint::JointKind;
use crate::rows::{JointRows, Row, RowCount, Wrench};
use crate::solve::direct;

/// A step of Newton's method leaves of an error about as much as it turns bodies, in radians: one more follows on a larger turn than this.
const LARGEST_TURN: f64 = 1e-3;
/// The most that are taken.
const MOST_STEPS: usize = 4;

impl World {
    /// Moves the bodies of an island with their new velocities, and then to where their joints hold together. All poses are final before
    /// the first callback.
    pub(super) fn move_and_project(
        &mut self,
        island: &Island,
        moved: &mut Island,
        ctx: &StepContext,
        number: usize,
        work: &mut direct::Workspace,
    ) {
        let bodies = &island.slots[..island.movable];
        for (index, solver_body) in bodies.iter().zip(&island.bodies) {
            let body = self.bodies.at_mut(*index);
            body.advance_velocity(solver_body, ctx.h);
            integrate::advance_pose(body, ctx.h);
        }
        for _ in 0..MOST_STEPS {
            moved.bodies.clear();
            moved.bodies.extend(island.slots.iter().map(|slot| SolverBody::new(self.bodies.at(*slot))));
            self.write_rigid_rows(&island.spans, moved, ctx);
            let mut largest: f64 = 0.0;
            for (index, by) in bodies.iter().zip(direct::project(moved, &self.params.direct, number, work)) {
                integrate::displace(self.bodies.at_mut(*index), by.linear, by.angular);
                largest = largest.max(by.angular.length_squared());
            }
            if largest <= LARGEST_TURN * LARGEST_TURN {
                break;
            }
        }
    }

    /// The rows that hold joints together, without limits, motors, contacts and springs.
    fn write_rigid_rows(&mut self, spans: &[JointSpan], moved: &mut Island, ctx: &StepContext) {
        moved.rows.clear();
        moved.spans.clear();
        for span in spans {
            let joint = self.joints.at_mut(span.joint);
            if let JointKind::Contact(_) = joint.kind {
                continue;
            }
            let first = moved.rows.len();
            let ends = ends_of(joint, span, &moved.bodies);
            let model = joint.kind.model_mut();
            let count = model.row_count(&ends, ctx).rows;
            moved.rows.resize(first + count, Row::blank(ctx.cfm));
            let mut out = JointRows { rows: &mut moved.rows[first..], forces: [Wrench::default(); 2] };
            model.write_rows(&ends, ctx, &mut out);
            direct::keep_rigid(&mut moved.rows, first, ctx);
            let count = moved.rows.len() - first;
            if count > 0 {
                moved.spans.push(JointSpan { first, count: RowCount::new(count, count), ..*span });
            }
        }
    }
}
