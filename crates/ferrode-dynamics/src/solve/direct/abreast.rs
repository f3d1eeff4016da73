//! Islands that follow each other and are alike, such as robots of one kind: their rows are solved four or eight at a time.

use super::{DirectSettings, Island, IslandWork, Problem, State, Workspace, sparse};
use ferrode_lcp::{ABREAST, PivotingReport, SparseLcp, abreast, solve_abreast};

/// Fewer take less time one by one: what lanes do takes as long for one island as for all.
pub(super) const LEAST: usize = 3;

/// Finds the forces of islands that follow each other, the first one's number being `number`.
pub(crate) fn solve_all(
    works: &mut [IslandWork],
    h: f64,
    settings: &DirectSettings,
    number: usize,
    past: &Workspace,
) {
    let (mut rest, mut number) = (works, number);
    while !rest.is_empty() {
        let (works, others) = rest.split_at_mut(alike(rest));
        rest = others;
        let problem = Problem { settings, number, warm: &past.warm };
        number += works.len();
        let together = works.len() >= LEAST;
        for work in &mut *works {
            work.begin(h, problem, together);
        }
        let reports = if together { solve_alike(works, problem) } else { [None; ABREAST] };
        for (l, (work, report)) in works.iter_mut().zip(reports).enumerate() {
            let problem = Problem { number: problem.number + l, ..problem };
            match report {
                Some(report) => work.take_answer(report, settings),
                None => work.solve_alone(h, problem),
            }
        }
    }
}

/// How many islands, from the first on, are as large as it, as many as lanes hold.
fn alike(works: &[IslandWork]) -> usize {
    let size = |work: &IslandWork| {
        let Island { bodies, rows, spans, .. } = &work.island;
        [bodies.len(), rows.len(), spans.len()]
    };
    let some = works.iter().take(abreast());
    some.take_while(|work| works.first().is_some_and(|first| size(work) == size(first))).count()
}

/// Answers for islands that can be solved together.
fn solve_alike(works: &mut [IslandWork], problem: Problem<'_>) -> [Option<PivotingReport>; ABREAST] {
    if !works.iter().all(|work| work.state == State::ReadyForSparse) {
        return [None; ABREAST];
    }
    let options = sparse::options(problem);
    let (mut pivoting, mut memory) = Default::default();
    if let Some(first) = works.first_mut() {
        (pivoting, memory) = first.memory.sparse.take_memory();
    }
    let count = works.len();
    let mut rest = works.iter_mut();
    let mut problems: [SparseLcp<'_>; ABREAST] =
        core::array::from_fn(|_| rest.next().map(IslandWork::lcp).unwrap_or_default());
    let reports = solve_abreast(&mut problems[..count], &options, &mut pivoting, &mut memory);
    if let Some(first) = works.first_mut() {
        first.memory.sparse.give_memory(pivoting, memory);
    }
    reports
}
