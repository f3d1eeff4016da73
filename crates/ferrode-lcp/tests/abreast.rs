//! Up to eight problems of one shape solved at once, against each by itself.

mod islands;

use ferrode_lcp::{
    ABREAST, AbreastWorkspace, NO_SPARSE_BODY, PivotingOptions, PivotingReport, PivotingWorkspace, RowState,
    SparseLcp, abreast, solve_abreast, solve_pivoting,
};
use islands::{Island, Random};

/// A tree of bodies on hinges, some with motors, on ball joints, and with a loop or two; `kind` decides the shape, `random` the numbers.
fn figure(kind: u64, random: &mut Random) -> Island {
    let cfm = [1e-10, 1e-5, 0.0][(kind % 3) as usize];
    let mut island = Island::new(0.01, cfm);
    let n = 8 + kind as u32 % 7;
    for body in 0..n {
        let (mass, size) = (random.range(0.1, 10.0), [0; 3].map(|_| random.range(0.1, 0.8)));
        let velocity = [0; 6].map(|_| random.range(-1.0, 1.0));
        island.add_body(mass, size, [f64::from(body), random.range(-0.3, 0.3), 0.0], velocity);
    }
    let mut shape = Random(kind + 1);
    for body in 1..n {
        // One body with many joints, the others with few.
        let parent = if shape.below(3) == 0 { 0 } else { body - 1 };
        let p = [f64::from(body) - 0.5, random.range(-0.1, 0.1), random.range(-0.1, 0.1)];
        match shape.below(4) {
            0 => island.ball(parent, body, p, random.vector().map(|x| 1e-3 * x)),
            1 => island.hinge(parent, body, p, None, None),
            _ => {
                let most = if shape.below(2) == 0 { 1e-3 } else { 1e3 };
                island.hinge(parent, body, p, Some((random.range(-1.0, 1.0), most)), None);
            }
        }
    }
    if kind.is_multiple_of(2) {
        island.ball(n - 1, NO_SPARSE_BODY, [f64::from(n), 0.0, 0.0], [0.0; 3]);
    }
    if kind.is_multiple_of(5) {
        island.ball(2, n - 2, [4.0, 0.5, 0.0], [0.0; 3]);
    }
    island
}

struct Answer {
    report: PivotingReport,
    x: Vec<f64>,
    states: Vec<[Option<RowState>; 2]>,
}

/// What the island's rows do, each by itself, from the guess that it holds.
fn alone(island: &mut Island) -> Answer {
    let report = {
        let mut problem = island.problem();
        solve_pivoting(&mut problem, &PivotingOptions::default(), &mut PivotingWorkspace::new()).unwrap()
    };
    Answer { report, x: island.x.clone(), states: island.states.clone() }
}

/// The memory is used again from test to test.
fn together(
    islands: &mut [Island],
    (first, work): &mut (PivotingWorkspace, AbreastWorkspace),
) -> [Option<PivotingReport>; ABREAST] {
    let mut problems: Vec<SparseLcp<'_>> = islands.iter_mut().map(Island::problem).collect();
    solve_abreast(&mut problems, &PivotingOptions::default(), first, work)
}

fn bits(x: &[f64]) -> Vec<u64> {
    // Zero has two.
    x.iter().map(|x| (x + 0.0).to_bits()).collect()
}

#[test]
fn many_at_once_have_the_answers_of_each_by_itself() {
    let mut memory = (PivotingWorkspace::new(), AbreastWorkspace::default());
    let (mut asked, mut answered, mut at_bounds, mut pivots) = (0, 0, 0, 0);
    for kind in 0..120 {
        let mut random = Random(1000 + kind);
        let count = 2 + kind as usize % (abreast() - 1);
        asked += count;
        let mut islands: Vec<Island> = (0..count).map(|_| figure(kind, &mut random)).collect();
        // Without a guess in half of the cases, in the others with the right one.
        let guessed = kind % 2 == 0;
        let answers: Vec<Answer> = islands
            .iter_mut()
            .map(|island| {
                if guessed {
                    alone(island);
                }
                let guess = island.states.clone();
                let answer = alone(island);
                island.states = guess;
                island.x.fill(f64::NAN);
                answer
            })
            .collect();
        at_bounds += answers.iter().flat_map(|a| &a.states).filter(|s| s[1] != Some(RowState::Free)).count();
        let reports = together(&mut islands, &mut memory);
        for ((island, answer), report) in islands.iter().zip(&answers).zip(reports) {
            assert!(!guessed || report.is_some(), "kind {kind}");
            let Some(report) = report else { continue };
            answered += 1;
            pivots += report.factorisations - 1;
            assert_eq!(report.factorisations, answer.report.factorisations);
            assert_eq!(bits(&island.x), bits(&answer.x), "kind {kind}");
            assert_eq!(island.states, answer.states);
            assert_eq!((report.residual, report.largest), (answer.report.residual, answer.report.largest));
            assert_eq!(report.factor_blocks, answer.report.factor_blocks);
        }
        assert!(reports[count..].iter().all(Option::is_none));
    }
    println!("{answered} of {asked} answered, {at_bounds} rows at bounds, {pivots} pivots");
    // Of those without a guess some take more pivots than are tried.
    assert!(4 * answered > 3 * asked && at_bounds > 200 && pivots > 20, "{answered}, {at_bounds}, {pivots}");
}

#[test]
fn more_than_the_machine_has_lanes_for_have_no_answer() {
    let mut memory = (PivotingWorkspace::new(), AbreastWorkspace::default());
    let mut random = Random(9);
    for count in 1..=2 * ABREAST {
        let mut islands: Vec<Island> = (0..count).map(|_| figure(1, &mut random)).collect();
        let answered = together(&mut islands, &mut memory).iter().flatten().count();
        assert_eq!(answered > 0, (2..=abreast()).contains(&count), "{count}");
    }
}

#[test]
fn problems_that_differ_or_are_out_of_order_have_no_answer() {
    let mut memory = (PivotingWorkspace::new(), AbreastWorkspace::default());
    let mut random = Random(5);
    let unasked = |islands: &[Island]| islands.iter().all(|island| island.x.iter().all(|x| *x == 7.0));
    let four = |kinds: [u64; 4], random: &mut Random| -> Vec<Island> {
        let mut islands: Vec<Island> = kinds.into_iter().map(|kind| figure(kind, random)).collect();
        islands.iter_mut().for_each(|island| island.x.fill(7.0));
        islands
    };
    let mut different = four([1, 1, 2, 1], &mut random);
    assert_eq!(together(&mut different, &mut memory), [None; ABREAST]);
    let mut not_finite = four([1; 4], &mut random);
    not_finite[2].rhs[3] = f64::NAN;
    let reports = together(&mut not_finite, &mut memory);
    assert!(reports[2].is_none() && reports[0].is_some() && reports[3].is_some());
    let mut bounds = four([1; 4], &mut random);
    bounds[1].lo[0] = 1.0;
    assert_eq!(together(&mut bounds, &mut memory), [None; ABREAST]);
    let mut contact = four([1; 4], &mut random);
    for island in &mut contact {
        island.face(3, NO_SPARSE_BODY, [0.1; 3], 0.0, 0.5);
        island.x.fill(7.0);
    }
    assert_eq!(together(&mut contact, &mut memory), [None; ABREAST]);
    assert!(unasked(&different) && unasked(&not_finite[2..3]) && unasked(&bounds) && unasked(&contact));
    assert_eq!(together(&mut four([1; 4], &mut random)[..1], &mut memory), [None; ABREAST]);
}
