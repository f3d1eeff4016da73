//! Several problems that wait, solved in less time than one by one: those of one body abreast ([`loom`]), those of few bodies two at a time
//! ([`small`](super::small)).

use super::small::Small;
use super::{SorExit, SorWorkspace, State, loom};
use ferrode_math::simd::{Quad, QuadKernel, dispatch_quads};

/// So many problems that wait are put in order by size.
const TOGETHER: usize = 16;

/// Solves what [`begin_sor_rows`](super::begin_sor_rows) and
/// [`begin_sor_alone`](super::begin_sor_alone) have begun in these workspaces, if it still waits. The answers are, to the bit, those of
/// solving each problem by itself.
pub fn finish_sor<'a>(workspaces: impl Iterator<Item = &'a mut SorWorkspace>) {
    dispatch_quads(Finish { workspaces });
}

/// The visits of problems that wait, compiled for the machine.
struct Finish<I> {
    workspaces: I,
}

impl<'a, I: Iterator<Item = &'a mut SorWorkspace>> QuadKernel for Finish<I> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        let mut waiting = self.workspaces.filter(|workspace| matches!(workspace.state, State::Begun { .. }));
        loop {
            let mut some = [const { None }; TOGETHER];
            let mut count = 0;
            for (place, workspace) in some.iter_mut().zip(&mut waiting) {
                *place = Some(workspace);
                count += 1;
            }
            let some = &mut some[..count];
            finish_alone::<Q>(some);
            // Those of one size side by side: a visit takes as long as that of the largest.
            some.sort_unstable_by_key(|workspace| workspace.as_ref().map(|workspace| workspace.small.left()));
            let left = some.iter_mut().filter_map(Option::take);
            finish_all::<Q>(left.filter(|workspace| matches!(workspace.state, State::Begun { .. })));
            if count < TOGETHER {
                return;
            }
        }
    }
}

/// Solves the problems of one body, those of one size abreast: a visit takes as long as that of the largest.
#[inline(always)]
fn finish_alone<Q: Quad>(some: &mut [Option<&mut SorWorkspace>]) {
    let mut sizes = [((0, 0), 0); TOGETHER];
    let mut count = 0;
    for (place, workspace) in some.iter().enumerate().take(TOGETHER) {
        if let Some(SorWorkspace { alone, state: State::Begun { alone: true, .. }, .. }) = workspace {
            sizes[count] = (alone.size(), place);
            count += 1;
        }
    }
    let sizes = &mut sizes[..count];
    let Some(&(_, home)) = sizes.first() else { return };
    // Always in the same memory.
    let mut looms = some[home].as_mut().map(|workspace| core::mem::take(&mut workspace.looms));
    let Some(looms_here) = &mut looms else { return };
    // The largest first: those that are left over at the end are small.
    sizes.sort_unstable_by(|a, b| b.cmp(a));
    for alike in sizes.chunk_by(|a, b| a.0.0 == b.0.0) {
        for places in alike.chunks(loom::AT_ONCE) {
            let mut workspaces = [const { None }; loom::AT_ONCE];
            for (workspace, (_, place)) in workspaces.iter_mut().zip(places) {
                *workspace = some[*place].take();
            }
            let mut problems = workspaces.each_mut().map(|w| w.as_mut().and_then(|w| w.problem_alone()));
            loom::visit::<Q>(&mut problems, looms_here);
            for (workspace, (_, place)) in workspaces.into_iter().zip(places) {
                some[*place] = workspace;
            }
        }
    }
    for (_, place) in sizes {
        if let Some(workspace) = &mut some[*place]
            && let State::Begun { iterations, .. } = workspace.state
        {
            workspace.state = State::Ended { iterations, exit: SorExit::Completed };
        }
    }
    if let (Some(workspace), Some(looms)) = (&mut some[home], looms) {
        workspace.looms = looms;
    }
}

/// Solves what waits, two at a time.
#[inline(always)]
fn finish_all<'a, Q: Quad>(mut waiting: impl Iterator<Item = &'a mut SorWorkspace>) {
    let (mut first, mut second) = (waiting.next(), waiting.next());
    while let Some(one) = first {
        match &mut second {
            Some(other) => Small::visit::<Q, 2>([&mut one.small, &mut other.small]),
            None => Small::visit::<Q, 1>([&mut one.small]),
        }
        second = second.and_then(|other| other.finished::<Q>().map_or_else(|| waiting.next(), Some));
        first = one.finished::<Q>().map_or_else(|| second.take().or_else(|| waiting.next()), Some);
        if second.is_none() {
            second = waiting.next();
        }
    }
}

impl SorWorkspace {
    /// The problem, if it is one of a body alone.
    #[inline(always)]
    fn problem_alone(&mut self) -> Option<loom::Problem<'_>> {
        let Self { alone, lambda, acceleration, .. } = self;
        let (forces, acceleration) = (lambda.first_chunk_mut()?, acceleration.first_mut()?);
        Some(loom::Problem { alone, forces, acceleration })
    }

    /// Writes the answer down if all visits are made; else gives the workspace back.
    #[inline(always)]
    fn finished<Q: Quad>(&mut self) -> Option<&mut Self> {
        if self.small.left() > 0 {
            return Some(self);
        }
        let (rows, bodies) = (self.rows, self.bodies);
        let Self { small, packed, lambda, acceleration, .. } = self;
        small.finish::<Q>(&packed[..rows], &mut lambda[..rows], &mut acceleration[..bodies]);
        if let State::Begun { iterations, .. } = self.state {
            self.state = State::Ended { iterations, exit: SorExit::Completed };
        }
        None
    }
}
