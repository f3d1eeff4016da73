//! Four or eight problems of the same shape at once, as far as all goes well: see [`crate::sparse::abreast`].

use super::line::state_of;
use super::{CLEARLY_WRONG, MANY, NOISE, canonical::DEGENERATE};
use super::{
    PivotingOptions, PivotingReport, PivotingWorkspace, RowState, SparseLcp, WRONG, check, possible,
};
use crate::sparse::abreast::{Abreast, Numbers, Task, serves};
use crate::sparse::symbolic::Symbolic;
use crate::sparse::system::{FINE, FIRM, MOST_CORRECTIONS, Pass, ROUGH};
use ferrode_math::simd::{Block64, EightF64, FourF64};

/// How many problems are solved at once at the most.
pub const ABREAST: usize = 8;

/// So often states are corrected, before each problem is left to itself.
const MOST_ROUNDS: u32 = 4;

/// Memory for [`solve_abreast`].
#[derive(Clone, Debug, Default)]
pub struct AbreastWorkspace {
    four: Abreast<FourF64>,
    eight: Abreast<EightF64>,
    /// The state of each row that has a bound in one of the problems.
    state: Vec<[RowState; ABREAST]>,
}

/// How many problems this machine's registers hold: four or eight.
pub fn abreast() -> usize {
    if EightF64::is_available() { EightF64::LANES } else { FourF64::LANES }
}

/// Solves up to [`abreast`] problems whose rows act on the same bodies in the same order, where that takes few pivots and nothing is amiss. Each
/// answer is, to the bit, that of [`solve_pivoting`](super::solve_pivoting), which is to be asked where there is none. The shape is kept in
/// `first`, the first problem's workspace.
pub fn solve_abreast(
    problems: &mut [SparseLcp<'_>],
    options: &PivotingOptions,
    first: &mut PivotingWorkspace,
    workspace: &mut AbreastWorkspace,
) -> [Option<PivotingReport>; ABREAST] {
    let none = [None; ABREAST];
    let Some((p, others)) = problems.split_first() else { return none };
    let m = p.jacobian.len();
    let alike = |other: &SparseLcp<'_>| {
        other.bodies == p.bodies && other.jacobian.len() == m && other.blocks == p.blocks
    };
    if others.is_empty() || others.len() >= abreast() || !others.iter().all(alike) {
        return none;
    }
    let sound = |p: &SparseLcp<'_>| check(p).is_ok() && p.findex[..m].iter().all(|f| *f < 0);
    if !problems.iter().all(sound) {
        return none;
    }
    let p = &problems[0];
    let shape = first.shapes.get(options.topology, p.bodies, p.blocks, p.lo, p.hi);
    let fits = |p: &SparseLcp<'_>| shape.fits(p.bodies, p.blocks, p.lo, p.hi);
    if !serves(shape) || !problems.iter().all(fits) {
        return none;
    }
    let AbreastWorkspace { four, eight, state } = workspace;
    if problems.len() <= FourF64::LANES {
        Together { problems, shape, numbers: four, state }.run()
    } else {
        Together { problems, shape, numbers: eight, state }.run()
    }
}

fn numbers<'a>(p: &SparseLcp<'a>) -> Numbers<'a> {
    Numbers::of(p.jacobian, [p.sigma, p.rhs, p.lo, p.hi])
}

struct Together<'a, 'b, B> {
    problems: &'a mut [SparseLcp<'b>],
    shape: &'a Symbolic,
    numbers: &'a mut Abreast<B>,
    /// Of the rows in `numbers.bounded`; all others are free.
    state: &'a mut Vec<[RowState; ABREAST]>,
}

/// How far the refinement of one solution has come, as in [`crate::sparse::system::System`].
#[derive(Clone, Copy, Debug, Default)]
struct Refinement {
    change: f64,
    rate: f64,
    scale: f64,
}

impl<B: Block64> Together<'_, '_, B> {
    fn run(mut self) -> [Option<PivotingReport>; ABREAST] {
        self.load();
        self.do_all(Task::Prepare);
        if !self.numbers.used_sigma.iter().all(|sigma| sigma.as_ref().iter().all(|x| *x > 0.0)) {
            // Some row is empty.
            return [None; ABREAST];
        }
        self.guess();
        let mut rounds = [None; ABREAST];
        let mut refinements = [Refinement::default(); ABREAST];
        let mut all_refined = false;
        for round in 1..=MOST_ROUNDS {
            self.hold_states();
            self.do_all(Task::Factorise);
            let largest;
            (largest, refinements) = self.solve();
            self.do_all(Task::Product);
            // As `Solve::pivot` goes on: refines unless many rows are wrong.
            let (mut refined, mut wrong) = ([false; ABREAST], false);
            for l in 0..self.problems.len() {
                if rounds[l].is_none() && largest[l].is_finite() {
                    let count = self.judge(l, largest[l], CLEARLY_WRONG, false).wrong;
                    refined[l] = count * MANY < self.numbers.rhs.len();
                    if !refined[l] {
                        self.judge(l, largest[l], CLEARLY_WRONG, true);
                        wrong = true;
                    }
                }
            }
            all_refined = refined != [false; ABREAST];
            if all_refined {
                self.refine(&mut refinements, ROUGH);
                self.do_all(Task::Product);
            }
            for l in (0..ABREAST).filter(|l| refined[*l]) {
                match self.judge(l, largest[l], WRONG, true) {
                    Judgement { wrong: 0, degenerate: false } => rounds[l] = Some(round),
                    Judgement { wrong: 0, .. } => {}
                    _ => wrong = true,
                }
            }
            if !wrong {
                break;
            }
        }
        if rounds == [None; ABREAST] {
            return [None; ABREAST];
        }
        if !all_refined {
            self.refine(&mut refinements, ROUGH);
        }
        let [loose, _] = self.do_all(Task::Loose(FIRM));
        for (refinement, loose) in refinements.iter_mut().zip(loose.as_ref()) {
            if *loose > 0.0 {
                // How fast proximal steps converge, the first one does not tell.
                refinement.rate = 1.0;
            }
        }
        self.refine(&mut refinements, FINE);
        let [residual, largest] = self.do_all(Task::Measure);
        let mut reports = [None; ABREAST];
        for (l, problem) in self.problems.iter_mut().enumerate() {
            let Some(factorisations) = rounds[l] else { continue };
            let report = PivotingReport {
                factorisations,
                residual: residual[l],
                largest: largest[l],
                factor_blocks: self.shape.blocks(),
                ..PivotingReport::default()
            };
            if !report.certified() {
                continue;
            }
            reports[l] = Some(report);
            for ((x, states), lambda) in
                problem.x.iter_mut().zip(&mut *problem.states).zip(&self.numbers.lambda)
            {
                (*x, *states) = (lambda[l], [Some(RowState::Free); 2]);
            }
            for ([row, _], state) in self.numbers.bounded.iter().zip(&*self.state) {
                problem.states[*row as usize] = [Some(state[l]); 2];
            }
        }
        reports
    }

    fn do_all(&mut self, task: Task) -> [B; 2] {
        self.numbers.work(self.problems[0].blocks, self.shape, task)
    }

    fn load(&mut self) {
        let p = &self.problems[0];
        let mut islands = [numbers(p); ABREAST];
        for (island, p) in islands.iter_mut().zip(self.problems.iter()) {
            *island = numbers(p);
        }
        let numbers = &mut *self.numbers;
        numbers.load(&islands, self.shape);
        numbers.bounded.clear();
        for (i, block) in p.blocks.iter().enumerate() {
            for row in block.first..block.first + block.count {
                let bounds = (numbers.lo[row as usize], numbers.hi[row as usize]);
                if bounds != (B::splat(f64::NEG_INFINITY), B::splat(f64::INFINITY)) {
                    numbers.bounded.push([row, i as u32]);
                }
            }
        }
    }

    /// Takes the rows' states as guessed, and the forces of those that are not free.
    fn guess(&mut self) {
        let Self { problems, numbers, state, .. } = self;
        state.clear();
        for row in numbers.bounded.iter().map(|[row, _]| *row as usize) {
            let (lo, hi) = (numbers.lo[row], numbers.hi[row]);
            let mut states = [RowState::Free; ABREAST];
            for (l, state) in states.iter_mut().enumerate().take(B::LANES) {
                if lo[l] == f64::NEG_INFINITY && hi[l] == f64::INFINITY {
                    continue;
                }
                let p = problems.get(l).unwrap_or(&problems[0]);
                let guess = p.states[row][1].unwrap_or_else(|| {
                    let alone = numbers.rhs[row][l] / numbers.diagonal[row][l];
                    if alone == 0.0 { RowState::Free } else { state_of(alone, lo[l], hi[l]) }
                });
                *state = possible(guess, lo[l], hi[l]);
            }
            state.push(states);
        }
    }

    /// Has rows free or at their bounds, as their states say.
    fn hold_states(&mut self) {
        self.numbers.begin();
        self.numbers.hold(self.state);
    }

    /// The first solution, and the largest forces.
    fn solve(&mut self) -> (B, [Refinement; ABREAST]) {
        let [change, _] = self.do_all(Task::Correct(Pass::First));
        self.do_all(Task::Apply([true; ABREAST]));
        let [largest, strongest] = self.do_all(Task::Strengths);
        let mut refinements = [Refinement::default(); ABREAST];
        for (l, refinement) in refinements.iter_mut().enumerate().take(B::LANES) {
            *refinement = Refinement { change: change[l], rate: 1.0, scale: strongest[l].sqrt() };
        }
        (largest, refinements)
    }

    /// Corrects until the error to be expected is below that part of the scale, or rounding stops it: each problem as if alone.
    fn refine(&mut self, refinements: &mut [Refinement; ABREAST], part: f64) {
        let mut going = [true; ABREAST];
        for _ in 0..MOST_CORRECTIONS {
            for (going, r) in going.iter_mut().zip(refinements.iter()) {
                let reached = r.change * r.rate <= part * r.scale;
                *going = *going && !reached;
            }
            if going == [false; ABREAST] {
                break;
            }
            let [change, _] = self.do_all(Task::Correct(Pass::Own));
            for ((going, r), change) in going.iter_mut().zip(refinements.iter_mut()).zip(change.as_ref()) {
                if *going {
                    (r.rate, r.change) = (change / r.change, *change);
                    let falls = r.rate < 0.5;
                    if !falls {
                        // Rounding is all that is left of it.
                        (r.rate, *going) = (0.0, false);
                    }
                }
            }
            self.do_all(Task::Apply(going));
        }
    }

    /// Whether the states of a problem's rows are right, which are wrong if off by more than that part of the largest force; takes better
    /// ones where not, if told to.
    fn judge(&mut self, l: usize, largest: f64, part: f64, correct: bool) -> Judgement {
        let s = &*self.numbers;
        let (tolerance, close) = (part * (1.0 + largest), DEGENERATE * (1.0 + largest));
        let mut found = Judgement { wrong: 0, degenerate: false };
        for ([row, _], states) in s.bounded.iter().zip(&mut *self.state) {
            let row = *row as usize;
            let (lo, hi) = (s.lo[row][l], s.hi[row][l]);
            let (lambda, rhs) = (s.lambda[row][l], s.rhs[row][l]);
            let slack = s.jy[row][l] + s.sigma[row][l] * lambda - rhs;
            let least = tolerance * s.diagonal[row][l] + NOISE * rhs.abs();
            let state = &mut states[l];
            let better = match *state {
                RowState::Free if lambda < lo - tolerance => RowState::Lower,
                RowState::Free if lambda > hi + tolerance => RowState::Upper,
                RowState::Free => {
                    found.degenerate |= lambda - lo < close || hi - lambda < close;
                    continue;
                }
                _ if lo == hi => continue,
                RowState::Lower if slack < -least => RowState::Free,
                RowState::Upper if slack > least => RowState::Free,
                _ => continue,
            };
            found.wrong += 1;
            if correct {
                *state = better;
            }
        }
        found
    }
}

/// What is thought of the states of a problem's rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Judgement {
    /// How many are wrong.
    wrong: usize,
    /// Whether one could have either of two.
    degenerate: bool,
}
