//! Islands that follow each other and are alike, such as robots of one kind: their rows are solved four at a time.

use super::{DirectSettings, IslandWork, Problem, Start, Workspace, sparse};
use ferrode_lcp::{ABREAST, PivotingReport, SparseLcp, solve_abreast};

/// Fewer take less time one by one: what lanes do takes as long for one island as for four.
const LEAST: usize = 3;

/// Finds the forces of islands that follow each other, the first one's number being `number`.
pub(crate) fn solve_all(
    works: &mut [IslandWork],
    h: f64,
    settings: &DirectSettings,
    number: usize,
    past: &Workspace,
) {
    for (i, works) in works.chunks_mut(ABREAST).enumerate() {
        let problem = Problem { settings, number: number + ABREAST * i, warm: &past.warm };
        works.iter_mut().for_each(|work| work.begin(h));
        let reports = solve_alike(works, problem);
        for (l, (work, report)) in works.iter_mut().zip(reports).enumerate() {
            let problem = Problem { number: problem.number + l, ..problem };
            match report {
                Some(report) => work.take_answer(report, settings),
                None => work.solve_alone(h, problem),
            }
        }
    }
}

/// Answers for islands that can be solved together.
fn solve_alike(works: &mut [IslandWork], problem: Problem<'_>) -> [Option<PivotingReport>; ABREAST] {
    let none = [None; ABREAST];
    let Some((first, others)) = works.split_first() else { return none };
    let alike = |other: &IslandWork| {
        other.island.bodies.len() == first.island.bodies.len()
            && other.island.rows.len() == first.island.rows.len()
            && other.island.spans.len() == first.island.spans.len()
    };
    if works.len() < LEAST || first.island.rows.is_empty() || !others.iter().all(alike) {
        return none;
    }
    let sparse_without_friction = |work: &IslandWork| {
        !work.memory.system.is_for_dense(work.island.rows.len(), problem.settings)
            && work.memory.system.findex.iter().all(|f| *f < 0)
    };
    if !works.iter().all(sparse_without_friction) {
        return none;
    }
    for IslandWork { island, memory, .. } in &mut *works {
        memory.sparse.begin(island, problem, Start::Step);
    }
    let options = sparse::options(problem);
    let (mut pivoting, mut abreast) = Default::default();
    if let Some(first) = works.first_mut() {
        (pivoting, abreast) = first.memory.sparse.take_memory();
    }
    let mut solve =
        |problems: &mut [SparseLcp<'_>]| solve_abreast(problems, &options, &mut pivoting, &mut abreast);
    let reports = match &mut *works {
        [a, b, c] => solve(&mut [a.lcp(), b.lcp(), c.lcp()]),
        [a, b, c, d] => solve(&mut [a.lcp(), b.lcp(), c.lcp(), d.lcp()]),
        _ => none,
    };
    if let Some(first) = works.first_mut() {
        first.memory.sparse.give_memory(pivoting, abreast);
    }
    reports
}
