//! The islands of a step of `Quick`: each by itself, but the forces of several that have few rows found side by side, which takes less
//! time than one after the other.
//!
//! What can be seen is as if each were stepped alone, in its turn: random numbers are drawn, and bodies move, in the order of the islands.

use super::{Island, Moved, Stepper, Stepping};
use crate::ends::StepContext;
use crate::foreign::MovedObserver;
use crate::solve::quick;
use crate::timing::Phase;
use crate::{StepReport, World};
use ferrode_math::random::OdeRandom;

/// How many islands are stepped side by side. More find better company, but their memory drives other things out of the caches.
const COMPANY: usize = 16;
/// An island with more joints begins a new company, so that only the first one's memory grows large.
const MOST_JOINTS: usize = 24;

/// The memory of islands that are stepped side by side.
#[derive(Debug, Default)]
pub(super) struct Workspace {
    company: Vec<Member>,
}

#[derive(Debug, Default)]
struct Member {
    island: Island,
    quick: quick::Workspace,
}

impl World {
    /// Steps all islands. If whoever is told of moved bodies may change the world, one after the other.
    pub(super) fn step_quick(
        &mut self,
        h: f64,
        random: &mut OdeRandom,
        stepping: &mut Stepping,
        moved: Moved<'_>,
        report: &mut StepReport,
    ) {
        let Stepping { islands, quick: Workspace { company }, .. } = stepping;
        let Moved { mut observer, looks_only } = moved;
        let ctx = self.step_context(h);
        let most = if looks_only { COMPANY } else { 1 };
        let mut count = 0;
        for number in 0..islands.ends.len() {
            let (bodies, joints) = islands.of(number);
            if count == most || joints.len() > MOST_JOINTS {
                self.end_quick(h, &mut company[..count], &mut observer, report);
                count = 0;
            }
            if company.len() == count {
                company.push(Member::default());
            }
            // Who only looks destroys none.
            let survivors = if looks_only { None } else { self.survivors(bodies, joints) };
            let member = &mut company[count];
            match survivors {
                Some((bodies, joints)) => self.gather(&bodies, &joints, &mut member.island),
                None => self.gather(bodies, joints, &mut member.island),
            }
            self.begin_quick(&ctx, random, member);
            count += 1;
        }
        self.end_quick(h, &mut company[..count], &mut observer, report);
    }

    /// Writes the rows of an island that is gathered, and solves it if these are many.
    fn begin_quick(&mut self, ctx: &StepContext, random: &mut OdeRandom, member: &mut Member) {
        let Member { island, quick } = member;
        self.apply_gravity(island);
        self.apply_gyroscopic_torques(island, ctx.h);
        self.count_rows(island, ctx);
        self.write_rows(island, ctx);
        self.timing.spent_on(Phase::Assembly);
        quick::begin(island, ctx.h, &self.params.quick, random, quick);
        self.timing.spent_on(Phase::Solve);
    }

    /// Solves the islands that are not yet solved, and moves their bodies.
    fn end_quick(
        &mut self,
        h: f64,
        company: &mut [Member],
        observer: &mut Option<MovedObserver<'_>>,
        report: &mut StepReport,
    ) {
        if company.is_empty() {
            return;
        }
        quick::solve(company.iter_mut().map(|member| &mut member.quick));
        self.timing.spent_on(Phase::Solve);
        for Member { island, quick } in company {
            let solved = quick::finish(island, quick);
            report.count_exit(quick.exit);
            report.count_island(island.movable, island.rows.len(), solved);
            self.write_feedback(island);
            quick::update_velocities(island, h, quick);
            let observer = observer.as_mut().map(|observer| &mut **observer as MovedObserver<'_>);
            self.move_bodies(island, (Stepper::Quick, h, false), observer, report);
            self.timing.spent_on(Phase::Integrate);
        }
    }
}
