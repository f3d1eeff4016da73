//! Sweeps over articulations, and the moves of bodies that belong to them.
//!
//! With the velocities ũ before the sweep, impulses change by the solution of
//!
//! ```text
//! (J̃ J̃ᵀ + Γ) Δλ = −(J̃ ũ − target − bias + Γ λ)
//! ```
//!
//! Γ holds the CFM of springs and, for all rows, 10⁻⁶ of the diagonal, by which rows that say the same share the load. The
//! factorisation is backward stable: what is left of the right side is of the size of rounding, whatever the condition, and each substep begins with
//! what is left.
//!
//! Rows with bounds (stops, motors) that hold take part like the others; those at a bound leave the equations, their impulse fixed. Which
//! is which is found by trying: rows that end beyond a bound are put there, rows at a bound that ought to give way are freed, and the
//! factor is made again.
//!
//! Where nothing else acts on the bodies within a substep, the relaxing sweep has the matrix of the biased one and is known beforehand but for
//! its bounds: its right side is that of the biased sweep without the bias, and both are solved in one pass over the factor.

use super::batch::{Batch, BodyRecords, DELTAS, Linear, both, linear_part, node, push};
use super::carry;
use super::factor;
use super::plan::NODE;
use super::row::{Bound, LaneRow, Role, angular, linear};
use super::triple::{add, cross, dot, unscaled, without_trifles};
use ferrode_math::simd::Lanes;

/// Trials in which rows may be freed; after them rows are only put to their bounds.
const FREEING: usize = 6;
/// Most trials.
const TRIALS: usize = 16;

/// What a sweep does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::solve::substep) enum Mode {
    /// Solves, with velocities that correct errors of position, for bodies that move with them for so many seconds then.
    Biased(f32),
    /// Solves for velocities alone.
    Relax,
    /// Moves the bodies so that errors of position vanish, but for what is of second order in them: a step of Newton's method, with the
    /// least motion in terms of kinetic energy. Only for rows without bounds that are no springs.
    Project,
}

/// What rows are solved for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Aim {
    /// Wanted velocities with the bias.
    Biased,
    /// Those without.
    Relax,
    /// Positions.
    Project,
}

impl<L: Lanes> Batch<L> {
    /// One sweep.
    #[inline(always)]
    pub fn sweep(&mut self, mode: Mode, records: &BodyRecords<'_, L>) {
        let goes_on = mode == Mode::Relax && core::mem::take(&mut self.ahead);
        let aim = match mode {
            Mode::Biased(_) => Aim::Biased,
            Mode::Relax => Aim::Relax,
            Mode::Project => Aim::Project,
        };
        let both = aim == Aim::Biased && self.alone;
        let mut solved = false;
        if goes_on {
            solved = self.go_on();
        } else if aim == Aim::Project {
            self.begin_projection();
        } else {
            if !core::mem::take(&mut self.gathered) {
                self.gather(records);
            }
            if !self.bounds.is_empty() {
                self.before.clone_from(&self.velocities);
            }
            self.guess(aim);
        }
        self.settle(aim, both, solved);
        if aim == Aim::Project {
            return self.move_bodies(records);
        }
        if both {
            self.ahead = true;
        } else {
            self.accept();
        }
        if let Mode::Biased(h) = mode {
            self.bend(h, records);
        }
        self.scatter(records);
    }

    /// Bodies are moved from where they are, by rows without bounds that are no springs.
    #[inline(always)]
    fn begin_projection(&mut self) {
        self.velocities.clear();
        self.velocities.resize(self.bodies.len() + 1, [L::ZERO; 6]);
        for row in &mut self.rows {
            row.free = if row.role == Role::Plain { L::ONE } else { L::ZERO };
        }
        for bound in &mut self.bounds {
            bound.fixed = self.rows[bound.row as usize].impulse;
        }
        self.stale |= !self.bounds.is_empty();
    }

    /// The relaxing sweep after a biased one that has solved for it too; whether that stands.
    ///
    /// What it ends with is what it would have ended with from the velocities before the biased sweep. So lanes whose rows hold or give way
    /// as they did keep what is solved, to the bit, also when others are solved again.
    #[inline(always)]
    fn go_on(&mut self) -> bool {
        self.guess_on();
        if self.stale {
            self.velocities.clone_from(&self.before);
            return false;
        }
        core::mem::swap(&mut self.velocities, &mut self.relaxed);
        for change in &mut self.changes {
            change[0] = change[1];
        }
        true
    }

    /// Finds which rows with bounds take part, and solves for the velocities and the changes of the impulses; if for `both`, also for those of
    /// the relaxing sweep. `solved`: they are there for the first trial.
    ///
    /// All kinds of sweep come through here, since what is called in several places is compiled as often.
    #[inline(always)]
    fn settle(&mut self, aim: Aim, both: bool, solved: bool) {
        for trial in 0..TRIALS {
            if trial > 0 {
                self.velocities.clone_from(&self.before);
            }
            if !solved || trial > 0 {
                if self.stale {
                    self.factorise();
                }
                if both {
                    self.solve::<2>(aim);
                } else {
                    self.solve::<1>(aim);
                }
            }
            if aim == Aim::Project || self.bounds.is_empty() || !self.correct(aim, trial < FREEING) {
                break;
            }
            self.stale = true;
        }
    }

    /// Adds what was found to the impulses.
    #[inline(always)]
    fn accept(&mut self) {
        for (node, change) in self.rows.chunks_exact_mut(NODE).zip(&self.changes) {
            for (row, change) in node.iter_mut().zip(&change[0]) {
                row.impulse += *change;
            }
        }
    }

    /// Guesses which rows with bounds take part, from their impulses and the velocities before the sweep.
    #[inline(always)]
    fn guess(&mut self, aim: Aim) {
        for i in 0..self.bounds.len() {
            let mut bound = self.bounds[i];
            let velocity = self.velocity(&bound, &self.velocities);
            let row = &mut self.rows[bound.row as usize];
            self.stale |= bound.guess(row, aim, velocity, row.impulse);
            self.bounds[i] = bound;
        }
    }

    /// The same for the relaxing sweep, with the impulses that the biased one has found.
    #[inline(always)]
    fn guess_on(&mut self) {
        for i in 0..self.bounds.len() {
            let mut bound = self.bounds[i];
            let velocity = self.velocity(&bound, &self.velocities);
            let place = bound.row as usize;
            let row = &mut self.rows[place];
            let found = row.impulse + self.changes[place / NODE][0][place % NODE];
            // A row at its bound is there exactly.
            let found = L::select(L::ZERO.lt(row.free), found, bound.fixed);
            self.stale |= bound.guess(row, Aim::Relax, velocity, found);
            self.bounds[i] = bound;
        }
    }

    /// Changes the state of rows that are on the wrong side; whether there were any.
    #[inline(always)]
    fn correct(&mut self, aim: Aim, freeing: bool) -> bool {
        let mut wrong = false;
        for i in 0..self.bounds.len() {
            let mut bound = self.bounds[i];
            let velocity = self.velocity(&bound, &self.velocities);
            let place = bound.row as usize;
            let new = self.rows[place].impulse + self.changes[place / NODE][0][place % NODE];
            wrong |= bound.correct(&mut self.rows[place], aim, velocity, new, freeing);
            self.bounds[i] = bound;
        }
        wrong
    }

    /// Solves for the changes of the impulses, and changes the velocities by them; with N = 2 for those of the relaxing sweep beside those of
    /// the biased one.
    #[inline(always)]
    fn solve<const N: usize>(&mut self, aim: Aim) {
        let Self { list, rows, linear, bounds, plan, factor, velocities, relaxed, changes, .. } = self;
        for bound in bounds.iter() {
            let (joint, place) = (&list[bound.joint as usize], bound.row as usize);
            let mut x = [L::ZERO; NODE];
            x[place % NODE] = fixed(&rows[place], bound);
            push(joint, rows, linear, (place - joint.first) / NODE, &x, velocities);
        }
        for (joint, first) in list.iter().zip(&plan.first) {
            let u = both(velocities, joint.ends);
            for i in 0..joint.nodes {
                let own = node(rows, joint, i);
                let x = &mut changes[*first as usize + i];
                if aim == Aim::Project {
                    x[0] =
                        [own[0].error * own[0].free, own[1].error * own[1].free, own[2].error * own[2].free];
                    continue;
                }
                let mut v = [own[0].turning(u), own[1].turning(u), own[2].turning(u)];
                match joint.linear {
                    Linear::Points([s, t]) if i == 0 => {
                        for k in 0..NODE {
                            v[k] += s * u[0][k] - t * u[1][k];
                        }
                    }
                    Linear::Points(_) => {}
                    Linear::Any(at) => {
                        for k in 0..NODE {
                            let l = &linear[at + i * NODE + k];
                            v[k] +=
                                dot(&l[0], &super::row::linear(u[0])) + dot(&l[1], &super::row::linear(u[1]));
                        }
                    }
                }
                for (side, x) in x.iter_mut().enumerate().take(N) {
                    let aim = if side == 0 { aim } else { Aim::Relax };
                    for k in 0..NODE {
                        x[k] = -own[k].residual(aim, v[k], own[k].impulse) * own[k].free;
                    }
                    *x = without_trifles(x, L::splat(factor::TRIFLE));
                }
            }
        }
        factor.solve::<N>(plan, changes);
        if N > 1 {
            relaxed.clone_from(velocities);
        }
        for (joint, first) in list.iter().zip(&plan.first) {
            for i in 0..joint.nodes {
                let x = &changes[*first as usize + i];
                push(joint, rows, linear, i, &x[0], velocities);
                if N > 1 {
                    push(joint, rows, linear, i, &x[1], relaxed);
                }
            }
        }
        for bound in bounds.iter() {
            let place = bound.row as usize;
            let x = fixed(&rows[place], bound);
            for change in changes[place / NODE].iter_mut().take(N) {
                change[place % NODE] += x;
            }
        }
    }

    /// J̃ ũ of a row.
    #[inline(always)]
    fn velocity(&self, bound: &Bound<L>, velocities: &[[L; 6]]) -> L {
        let joint = &self.list[bound.joint as usize];
        let (row, u) = (bound.row as usize, both(velocities, joint.ends));
        let (turning, place) = (self.rows[row].turning(u), row - joint.first);
        // Rows about the axis of a hinge.
        if place >= NODE && matches!(joint.linear, Linear::Points(_)) {
            return turning;
        }
        let parts = [linear_part(joint, &self.linear, place, 0), linear_part(joint, &self.linear, place, 1)];
        turning + (dot(&parts[0], &linear(u[0])) + dot(&parts[1], &linear(u[1])))
    }

    /// Adds what was found in place of velocities to the displacements.
    #[inline(always)]
    fn move_bodies(&mut self, records: &BodyRecords<'_, L>) {
        for i in 0..self.bodies.len() {
            let (step, [root, inverse]) = (&self.velocities[i], self.yields[i]);
            let mut delta = records.gather(DELTAS, i);
            let curve = curve(&delta, inverse, &angular(step), &self.scales[i], &self.unscales[i]);
            for k in 0..3 {
                delta[k] += step[k];
                delta[k + 3] += (step[k + 3] + curve[k]) * root;
            }
            records.scatter(DELTAS, i, delta);
        }
    }

    /// Before the bodies move by `h` seconds: adds to their rotation vectors what that motion does to them beside being added.
    #[inline(always)]
    fn bend(&self, h: f32, records: &BodyRecords<'_, L>) {
        let h = L::splat(h);
        for i in 0..self.bodies.len() {
            let ([.., d, e, f], [root, inverse]) = (self.velocities[i], self.yields[i]);
            let mut delta = records.gather(DELTAS, i);
            let curve = curve(&delta, inverse, &[d * h, e * h, f * h], &self.scales[i], &self.unscales[i]);
            for k in 0..3 {
                delta[k + 3] += curve[k] * root;
            }
            records.scatter(DELTAS, i, delta);
        }
    }
}

/// What a row that does not take part is yet to push.
#[inline(always)]
fn fixed<L: Lanes>(row: &LaneRow<L>, bound: &Bound<L>) -> L {
    (bound.fixed - row.impulse) * (L::ONE - row.free)
}

/// The rotation vector of a rotation by θ followed by one by the small δ is θ + δ + δ × θ/2 + θ × (θ × δ)/12 (Baker, Campbell and
/// Hausdorff; the next term is θ³ × δ/720): the last two, with all in scaled coordinates, θ times `inverse`; `over`: 1/S of S's diagonal.
#[inline(always)]
fn curve<L: Lanes>(delta: &[L; 8], inverse: L, step: &[L; 3], s: &[L; 8], over: &[L; 3]) -> [L; 3] {
    let theta = unscaled(s, &[delta[3] * inverse, delta[4] * inverse, delta[5] * inverse]);
    let unit = L::splat(carry::TRIFLE);
    let (theta, small) = (without_trifles(&theta, unit), without_trifles(&unscaled(s, step), unit));
    let inner = without_trifles(&cross(&theta, &small), unit);
    let (one, two) = (cross(&small, &theta), cross(&theta, &inner));
    let (half, twelfth) = (L::splat(0.5), L::splat(1.0 / 12.0));
    let d = add(
        &[one[0] * half, one[1] * half, one[2] * half],
        &[two[0] * twelfth, two[1] * twelfth, two[2] * twelfth],
    );
    let a = d[0] * over[0];
    let b = (d[1] - s[2] * a) * over[1];
    [a, b, (d[2] - s[4] * a - s[5] * b) * over[2]]
}
