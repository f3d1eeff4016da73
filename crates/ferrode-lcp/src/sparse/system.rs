//! The rows of a problem, and solves with the rows of a given set held exactly.
//!
//! A row is either free (its force is unknown, its equation `J y + S lambda = r` holds) or its force is given. For one choice, with `F`
//! the free rows that are folded into their bodies' blocks and `G` the others,
//!
//! ```text
//!     residuals     g = J^T lambda - y          e = r - J y - S lambda
//!     correction    [ 1 + J_F^T S_F^-1 J_F    J_G^T ] [   dy       ]   [ g + J_F^T S_F^-1 e_F ]
//!                   [ J_G                    -S_G   ] [ -dlambda_G ] = [ e_G                  ]      dlambda_F = S_F^-1 (e_F - J_F dy)
//! ```
//!
//! From `y = 0`, `lambda_F = 0` the first correction is the solution, and each further one a step of iterative refinement in the full
//! system: the residuals are computed from the rows themselves, so what the stiff matrix lost to rounding comes back.
//! (Å. Björck, "Iterative refinement and reliable computing", 1990.)

use super::factor::Factor;
use super::kernels::{Six, stride};
use super::matrix;
use super::rows::{self, MOST_OWN, Twelve, UpToSix, Weighted, largest};
use super::symbolic::{NONE, Place, Symbolic};
use super::{NO_SPARSE_BODY, RowBlock, ScaledRow};
use crate::pivoting::RowState;
use ferrode_math::simd::{Quad, QuadKernel, dispatch_quads};

/// A row with less CFM than this part of its diagonal gets more, made good by proximal steps.
pub(crate) const LEAST_SIGMA: f64 = 1e-10;
/// Refinement ends when the error to be expected of the accelerations is below this part of the largest that a force causes: while rows
/// are still being sorted, and at the end. (Forces are no measure: rounding of the residuals, divided by a small CFM, moves redundant ones
/// by more than any correction, and to no effect.)
pub(crate) const ROUGH: f64 = 1e-12;
pub(crate) const FINE: f64 = 1e-15;
pub(crate) const MOST_CORRECTIONS: usize = 8;
/// A row is firm when its pivot is so many times its CFM: a proximal step then gains as many digits.
pub(crate) const FIRM: f64 = 1e6;

/// Which residuals a correction is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pass {
    /// Those of `y = 0`.
    First,
    /// Those with the CFM that the factor is made with.
    Raised,
    /// Those with the rows' own CFM. Corrections by a factor with more of it are proximal steps.
    Own,
}

/// A problem's rows with what is computed for each, and the unknowns.
#[derive(Clone, Debug, Default)]
pub(crate) struct System {
    /// Per row: CFM/h as given, as used, its inverse, and `J J^T` + CFM/h.
    pub sigma: Vec<f64>,
    pub used_sigma: Vec<f64>,
    pub inverse_sigma: Vec<f64>,
    pub diagonal: Vec<f64>,
    /// The right-hand side in force: the given one, plus what the proximal step adds.
    pub rhs: Vec<f64>,
    /// The forces and the accelerations that they cause, the latter by body.
    pub lambda: Vec<f64>,
    pub y: Vec<Six>,
    /// `J y`: kept up to date for folded rows, of which there are many to a body, and for the others by [`System::product`].
    pub jy: Vec<f64>,
    /// Of folded rows the residual, and then what the correction adds to `J y`.
    error: Vec<f64>,
    pub dy: Vec<Six>,
    dlambda: Vec<f64>,
    /// Right-hand side and solution by columns.
    z: Vec<f64>,
    pub factor: Factor,
    /// Largest change of an acceleration in the last correction, and its ratio to the one before.
    change: f64,
    rate: f64,
    /// The largest acceleration that a single force causes.
    scale: f64,
    /// Per row what it weighs in the matrix: `1 / S`, or 0 for a row whose force is given.
    pub weight: Vec<f64>,
    /// Per block of rows: whether all of them have a weight.
    whole: Vec<bool>,
    /// Whether some row's CFM was raised.
    pub raised: bool,
    /// Whether proximal steps may converge slowly: a raised row may be redundant.
    slow: bool,
}

/// A system with the rows that it is for, at work with the machine's instructions.
struct Work<'a> {
    system: &'a mut System,
    blocks: &'a [RowBlock],
    jacobian: &'a [ScaledRow],
    task: Task<'a>,
}

enum Task<'a> {
    /// Fills `diagonal` with `J J^T`.
    Squares,
    Factorise(&'a Symbolic),
    Correct(&'a Symbolic, &'a [RowState], Pass),
    SolveWeighted(&'a Symbolic, &'a [f64], &'a mut [f64]),
    Product(&'a Symbolic),
    Accelerations,
}

impl QuadKernel for Work<'_> {
    /// The largest change of an acceleration, where that is asked for.
    type Out = f64;

    #[inline(always)]
    fn run<Q: Quad>(self) -> f64 {
        let Self { system, blocks, jacobian, task } = self;
        match task {
            Task::Squares => {
                for (diagonal, row) in system.diagonal.iter_mut().zip(jacobian) {
                    *diagonal = rows::square::<Q>(row);
                }
            }
            Task::Factorise(shape) => {
                let rows = Weighted { rows: jacobian, weight: &system.weight };
                matrix::assemble::<Q>(&mut system.factor, blocks, rows, shape, &mut system.whole);
                system.factor.factorise::<Q>(shape);
            }
            Task::Correct(shape, state, pass) => {
                return system.correct::<Q>(blocks, jacobian, state, shape, pass);
            }
            Task::SolveWeighted(shape, rho, x) => {
                system.solve_at_weights::<Q>(blocks, jacobian, shape, rho, x)
            }
            Task::Product(shape) => {
                for (block, _) in blocks.iter().zip(&shape.places).filter(|(_, place)| place.own != NONE) {
                    rows::multiply::<Q>(core::slice::from_ref(block), jacobian, &system.y, &mut system.jy);
                }
            }
            Task::Accelerations => {
                system.y.fill([0.0; 6]);
                rows::add_transposed::<Q>(blocks, jacobian, &system.lambda, &mut system.y);
                rows::multiply::<Q>(blocks, jacobian, &system.y, &mut system.jy);
            }
        }
        0.0
    }
}

impl System {
    /// Takes the rows in.
    pub fn load(&mut self, jacobian: &[ScaledRow], sigma: &[f64], rhs: &[f64], shape: &Symbolic) {
        let (m, n) = (jacobian.len(), shape.bodies());
        self.z.resize(shape.offset.last().map_or(0, |n| *n as usize), 0.0);
        for v in [&mut self.lambda, &mut self.jy, &mut self.error, &mut self.dlambda] {
            v.resize(m, 0.0);
        }
        for v in [&mut self.y, &mut self.dy] {
            v.resize(n, [0.0; 6]);
        }
        self.lambda.fill(0.0);
        self.sigma.clear();
        self.sigma.extend_from_slice(&sigma[..m]);
        self.rhs.clear();
        self.rhs.extend_from_slice(&rhs[..m]);
        for v in [&mut self.used_sigma, &mut self.inverse_sigma, &mut self.diagonal, &mut self.weight] {
            v.resize(m, 0.0);
        }
        self.work(&[], jacobian, Task::Squares);
        self.raised = false;
        let out = self.diagonal.iter_mut().zip(&mut self.used_sigma).zip(&mut self.inverse_sigma);
        for (sigma, ((diagonal, used), inverse)) in self.sigma.iter().zip(out) {
            *diagonal += sigma;
            let least = LEAST_SIGMA * *diagonal;
            *used = if *sigma < least { least } else { *sigma };
            self.raised |= *used != *sigma;
            *inverse = if *used > 0.0 { 1.0 / *used } else { 0.0 };
        }
        self.factor.reset(shape);
    }

    fn work(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow], task: Task<'_>) -> f64 {
        dispatch_quads(Work { system: self, blocks, jacobian, task })
    }

    /// Adds the blocks of the free rows to the stale columns, and factors them.
    pub fn factorise(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
    ) {
        for ((weight, inverse), state) in self.weight.iter_mut().zip(&self.inverse_sigma).zip(state) {
            *weight = if *state == RowState::Free { *inverse } else { 0.0 };
        }
        self.work(blocks, jacobian, Task::Factorise(shape));
        self.slow = self.raised && !self.holds_firmly(blocks, shape);
    }

    /// Whether the pivot of each raised row is so large that what its CFM was raised by hardly matters. With the other rows given, a redundant
    /// one has a pivot of the size of its CFM; folded rows have none that tells.
    fn holds_firmly(&self, blocks: &[RowBlock], shape: &Symbolic) -> bool {
        blocks.iter().zip(&shape.places).all(|(block, place)| {
            let range = block.range();
            let sigma = self.sigma[range.clone()].iter().zip(&self.used_sigma[range.clone()]);
            let mut raised = sigma
                .zip(&self.weight[range])
                .map(|((given, used), weight)| if given != used && *weight != 0.0 { *used } else { 0.0 });
            if place.own == NONE {
                return raised.all(|used| used == 0.0);
            }
            let own = place.own as usize;
            let step = stride(usize::from(shape.size[own])) + 1;
            let roots = self.factor.values[shape.start[own] as usize..].iter().step_by(step);
            raised.zip(roots).all(|(used, root)| FIRM * used <= root * root)
        })
    }

    /// Factors everything anew with the weights as they stand in `weight`.
    pub fn factorise_weighted(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow], shape: &Symbolic) {
        self.factor.reset(shape);
        self.work(blocks, jacobian, Task::Factorise(shape));
    }

    /// Solves `(J J^T + 1 / weight) x = rho` for the rows that have a weight, one time and without refinement; 0 for the others.
    pub fn solve_weighted(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        shape: &Symbolic,
        rho: &[f64],
        x: &mut [f64],
    ) {
        self.work(blocks, jacobian, Task::SolveWeighted(shape, rho, x));
    }

    /// Sets `jy` to `J y` where it isn't kept up to date.
    pub fn product(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow], shape: &Symbolic) {
        self.work(blocks, jacobian, Task::Product(shape));
    }

    /// Sets `y` to `J^T lambda` and `jy` to `J y`, from the forces alone.
    pub fn accelerations(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow]) {
        self.work(blocks, jacobian, Task::Accelerations);
    }

    /// Solves for the free rows, which are 0 in `lambda`, with the forces of the others as they stand there. Returns the largest force.
    pub fn solve(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
    ) -> f64 {
        self.y.fill([0.0; 6]);
        self.jy.fill(0.0);
        (self.change, self.rate) =
            (self.work(blocks, jacobian, Task::Correct(shape, state, Pass::First)), 1.0);
        self.apply();
        let mut strongest: f64 = 0.0;
        for (lambda, diagonal) in self.lambda.iter().zip(&self.diagonal) {
            let square = lambda * lambda * diagonal;
            strongest = if square > strongest { square } else { strongest };
        }
        self.scale = strongest.sqrt();
        largest(&self.lambda)
    }

    /// Refines the last solution until states can be told from it.
    pub fn refine_roughly(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
        pass: Pass,
    ) {
        self.refine(blocks, jacobian, state, shape, pass, ROUGH * self.scale);
    }

    /// Refines the last solution as far as rounding allows.
    pub fn polish(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
        pass: Pass,
    ) {
        if pass == Pass::Own && self.slow {
            // How fast proximal steps converge, the first one does not tell.
            self.rate = 1.0;
        }
        self.refine(blocks, jacobian, state, shape, pass, FINE * self.scale);
    }

    /// Corrects until the error to be expected, which shrinks by the same factor each time, is below `goal`, or rounding stops it.
    fn refine(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
        pass: Pass,
        goal: f64,
    ) {
        for _ in 0..MOST_CORRECTIONS {
            if self.change * self.rate <= goal {
                break;
            }
            let change = self.work(blocks, jacobian, Task::Correct(shape, state, pass));
            self.rate = change / self.change;
            self.change = change;
            let falls = self.rate < 0.5;
            if !falls {
                // Rounding is all that is left of it.
                self.rate = 0.0;
                break;
            }
            self.apply();
        }
    }

    /// Makes the correction that was found last.
    fn apply(&mut self) {
        for (y, dy) in self.y.as_flattened_mut().iter_mut().zip(self.dy.as_flattened()) {
            *y += dy;
        }
        for (lambda, change) in self.lambda.iter_mut().zip(&self.dlambda) {
            *lambda += change;
        }
        for (jy, change) in self.jy.iter_mut().zip(&self.error) {
            *jy += change;
        }
    }

    #[inline(always)]
    fn solve_at_weights<Q: Quad>(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        shape: &Symbolic,
        rho: &[f64],
        x: &mut [f64],
    ) {
        self.dy.fill([0.0; 6]);
        for (block, place) in blocks.iter().zip(&shape.places) {
            let range = block.range();
            let given = rho[range.clone()].iter().zip(&self.weight[range.clone()]);
            if place.own == NONE {
                let mut sum = Twelve::<Q>::zero();
                for (row, (rho, weight)) in jacobian[range].iter().zip(given) {
                    sum = sum.plus(rho * weight, row);
                }
                sum.add_to_bodies(&mut self.dy, block.bodies);
            } else {
                for (dlambda, (rho, weight)) in self.dlambda[range].iter_mut().zip(given) {
                    *dlambda = if *weight == 0.0 { 0.0 } else { *rho };
                }
            }
        }
        self.solve_factored::<Q>(blocks, jacobian, shape, false);
        for (block, place) in blocks.iter().zip(&shape.places) {
            let range = block.range();
            if place.own != NONE {
                x[range.clone()].copy_from_slice(&self.dlambda[range]);
                continue;
            }
            let dy = Twelve::<Q>::of_bodies(&self.dy, block.bodies);
            for first in range.clone().step_by(4) {
                let rows = first..range.end.min(first + 4);
                let products = rows::up_to_four(&jacobian[rows.clone()], dy);
                for (row, product) in rows.zip(products) {
                    x[row] = (rho[row] - product) * self.weight[row];
                }
            }
        }
    }

    /// Solves with the factor: `dy` holds the right-hand side of the bodies and becomes their part of the solution, `dlambda` that of
    /// the rows with unknowns of their own. If `at_rest`, the bodies' right-hand side is zero.
    #[inline(always)]
    fn solve_factored<Q: Quad>(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        shape: &Symbolic,
        at_rest: bool,
    ) {
        let (z, m) = (&mut self.z, jacobian.len());
        for (dy, column) in self.dy.iter().zip(&shape.body_column) {
            if *column != NONE {
                let at = shape.offset[*column as usize] as usize;
                z[at..at + 6].copy_from_slice(dy);
            }
        }
        for ((block, place), whole) in blocks.iter().zip(&shape.places).zip(&self.whole) {
            if place.own == NONE {
                continue;
            }
            let range = block.range();
            let own = place.own as usize;
            let z = &mut z[shape.offset[own] as usize..shape.offset[own + 1] as usize];
            if *whole && range.start + MOST_OWN <= m {
                let force = UpToSix::<Q>::load(&self.dlambda, &range);
                let light = light_bodies(block, place);
                let right = if at_rest || light == [NO_SPARSE_BODY; 2] {
                    force
                } else {
                    let dy = Twelve::of_bodies(&self.dy, light);
                    force.minus(UpToSix::products(&jacobian[range.clone()], dy))
                };
                right.store(z, &(0..range.len()));
                z[range.len()..].fill(0.0);
                continue;
            }
            let (force, weight) = (&self.dlambda[range.clone()], &self.weight[range.clone()]);
            z[force.len()..].fill(0.0);
            let light = light_bodies(block, place);
            if at_rest || light == [NO_SPARSE_BODY; 2] {
                for (z, (force, weight)) in z.iter_mut().zip(force.iter().zip(weight)) {
                    *z = if *weight == 0.0 { 0.0 } else { *force };
                }
                continue;
            }
            let dy = Twelve::<Q>::of_bodies(&self.dy, light);
            let of_four = z.chunks_mut(4).zip(jacobian[range].chunks(4));
            for ((z, rows), (force, weight)) in of_four.zip(force.chunks(4).zip(weight.chunks(4))) {
                let products = rows::up_to_four(rows, dy);
                for (z, (product, (force, weight))) in
                    z.iter_mut().zip(products.into_iter().zip(force.iter().zip(weight)))
                {
                    *z = if *weight == 0.0 { 0.0 } else { force - product };
                }
            }
        }
        self.factor.solve::<Q>(shape, z);
        for (dy, column) in self.dy.iter_mut().zip(&shape.body_column) {
            if *column != NONE {
                let at = shape.offset[*column as usize] as usize;
                dy.copy_from_slice(&z[at..at + 6]);
            }
        }
        for ((block, place), whole) in blocks.iter().zip(&shape.places).zip(&self.whole) {
            if place.own == NONE {
                continue;
            }
            let z = &z[shape.offset[place.own as usize] as usize..];
            let range = block.range();
            if *whole && range.start + MOST_OWN <= m {
                let mut sum = Twelve::<Q>::zero();
                for (row, z) in jacobian[range.clone()].iter().zip(z) {
                    sum = sum.plus(-z, row);
                }
                UpToSix::<Q>::load(z, &(0..range.len())).negative().store(&mut self.dlambda, &range);
                sum.add_to_bodies(&mut self.dy, light_bodies(block, place));
                continue;
            }
            let (force, weight) = (&mut self.dlambda[range.clone()], &self.weight[range.clone()]);
            let mut sum = Twelve::<Q>::zero();
            for (row, (z, (force, weight))) in
                jacobian[range].iter().zip(z.iter().zip(force.iter_mut().zip(weight)))
            {
                *force = if *weight == 0.0 { 0.0 } else { -z };
                sum = sum.plus(*force, row);
            }
            sum.add_to_bodies(&mut self.dy, light_bodies(block, place));
        }
    }

    /// Finds one correction. Returns the largest change of an acceleration.
    #[inline(always)]
    fn correct<Q: Quad>(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
        pass: Pass,
    ) -> f64 {
        let first = pass == Pass::First;
        let sigma = if pass == Pass::Own { &self.sigma } else { &self.used_sigma };
        for (dy, y) in self.dy.as_flattened_mut().iter_mut().zip(self.y.as_flattened()) {
            *dy = -y;
        }
        let (mut at_rest, m) = (first, jacobian.len());
        for ((block, place), whole) in blocks.iter().zip(&shape.places).zip(&self.whole) {
            let range = block.range();
            if place.own != NONE && *whole && first {
                self.dlambda[range.clone()].copy_from_slice(&self.rhs[range]);
                continue;
            }
            if place.own != NONE && *whole && range.start + MOST_OWN <= m {
                let rows = &jacobian[range.clone()];
                let jy = UpToSix::<Q>::products(rows, Twelve::of_bodies(&self.y, block.bodies));
                let sigma = UpToSix::load(sigma, &range);
                let error = UpToSix::load(&self.rhs, &range).minus(jy);
                let error = error.minus(sigma.times(UpToSix::load(&self.lambda, &range)));
                error.store(&mut self.dlambda, &range);
                let mut sum = Twelve::<Q>::zero();
                for (row, force) in rows.iter().zip(&self.lambda[range]) {
                    sum = sum.plus(*force, row);
                }
                sum.add_to_bodies(&mut self.dy, block.bodies);
                continue;
            }
            at_rest = false;
            let kept = first || place.own == NONE;
            let y = if kept { Twelve::<Q>::zero() } else { Twelve::of_bodies(&self.y, block.bodies) };
            let mut sum = Twelve::<Q>::zero();
            for at in range.clone().step_by(4) {
                let four = at..range.end.min(at + 4);
                let rows = &jacobian[four.clone()];
                let mut jy = [0.0; 4];
                if kept {
                    jy[..rows.len()].copy_from_slice(&self.jy[four.clone()]);
                } else {
                    jy = rows::up_to_four(rows, y);
                }
                let (lambda, state) = (&self.lambda[four.clone()], &state[four.clone()]);
                let (sigma, rhs) = (&sigma[four.clone()], &self.rhs[four.clone()]);
                let inverse_sigma = &self.inverse_sigma[four.clone()];
                let (error, own) = (&mut self.error[four.clone()], &mut self.dlambda[four]);
                for (i, row) in rows.iter().enumerate() {
                    let mut force = lambda[i];
                    if state[i] == RowState::Free {
                        error[i] = rhs[i] - jy[i & 3] - sigma[i] * force;
                        if place.own == NONE {
                            force += error[i] * inverse_sigma[i];
                        } else {
                            own[i] = error[i];
                        }
                    }
                    sum = sum.plus(force, row);
                }
            }
            sum.add_to_bodies(&mut self.dy, block.bodies);
        }
        self.solve_factored::<Q>(blocks, jacobian, shape, at_rest);
        for (block, place) in blocks.iter().zip(&shape.places) {
            if place.own != NONE {
                continue;
            }
            let range = block.range();
            let dy = Twelve::<Q>::of_bodies(&self.dy, block.bodies);
            for at in range.clone().step_by(4) {
                let four = at..range.end.min(at + 4);
                let products = rows::up_to_four(&jacobian[four.clone()], dy);
                for (row, product) in four.zip(products) {
                    let free = state[row] == RowState::Free;
                    let change = (self.error[row] - product) * self.inverse_sigma[row];
                    self.dlambda[row] = if free { change } else { 0.0 };
                    self.error[row] = product;
                }
            }
        }
        largest(self.dy.as_flattened())
    }
}

/// A joint's bodies that have no column.
#[inline(always)]
fn light_bodies(block: &RowBlock, place: &Place) -> [u32; 2] {
    [0, 1].map(|s| if place.columns[s] == NONE { block.bodies[s] } else { NO_SPARSE_BODY })
}
