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
use super::kernels::{self, Six, by_sizes};
use super::symbolic::{NONE, Place, Symbolic};
use super::{NO_SPARSE_BODY, RowBlock, ScaledRow};
use crate::pivoting::RowState;

/// A row with less CFM than this part of its diagonal gets more, made good by proximal steps.
pub(crate) const LEAST_SIGMA: f64 = 1e-10;
/// Refinement ends when the error to be expected of the accelerations is below this part of the largest that a force causes: while rows
/// are still being sorted, and at the end. (Forces are no measure: rounding of the residuals, divided by a small CFM, moves redundant ones
/// by more than any correction, and to no effect.)
const ROUGH: f64 = 1e-12;
const FINE: f64 = 1e-15;
const MOST_CORRECTIONS: usize = 8;

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
    /// `J y`, brought up to date by [`System::product`] and [`System::correct`].
    pub jy: Vec<f64>,
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
    /// Whether some row's CFM was raised.
    pub raised: bool,
}

impl System {
    /// Takes the rows in.
    pub fn load(&mut self, jacobian: &[ScaledRow], sigma: &[f64], rhs: &[f64], shape: &Symbolic) {
        let (m, n) = (jacobian.len(), shape.bodies());
        self.z.resize(shape.offset.last().map_or(0, |n| *n as usize), 0.0);
        for v in [&mut self.lambda, &mut self.jy, &mut self.error, &mut self.dlambda] {
            v.clear();
            v.resize(m, 0.0);
        }
        for v in [&mut self.y, &mut self.dy] {
            v.clear();
            v.resize(n, [0.0; 6]);
        }
        self.sigma.clear();
        self.sigma.extend_from_slice(&sigma[..m]);
        self.rhs.clear();
        self.rhs.extend_from_slice(&rhs[..m]);
        for v in [&mut self.used_sigma, &mut self.inverse_sigma, &mut self.diagonal, &mut self.weight] {
            v.resize(m, 0.0);
        }
        self.raised = false;
        let out = self.diagonal.iter_mut().zip(&mut self.used_sigma).zip(&mut self.inverse_sigma);
        for ((row, sigma), ((diagonal, used), inverse)) in jacobian.iter().zip(&self.sigma).zip(out) {
            *diagonal = kernels::dot(&row[0], &row[0]) + kernels::dot(&row[1], &row[1]) + sigma;
            let least = LEAST_SIGMA * *diagonal;
            *used = if *sigma < least { least } else { *sigma };
            self.raised |= *used != *sigma;
            *inverse = if *used > 0.0 { 1.0 / *used } else { 0.0 };
        }
        self.factor.reset(shape);
    }

    /// Adds the blocks of the free rows to the stale columns, and factors them.
    pub fn factorise(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
    ) {
        for (row, state) in state.iter().enumerate() {
            self.weight[row] = if *state == RowState::Free { self.inverse_sigma[row] } else { 0.0 };
        }
        self.add_and_factorise(blocks, jacobian, shape);
    }

    /// Factors everything anew with the weights as they stand in `weight`.
    pub fn factorise_weighted(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow], shape: &Symbolic) {
        self.factor.reset(shape);
        self.add_and_factorise(blocks, jacobian, shape);
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
        self.dy.fill([0.0; 6]);
        for (block, place) in blocks.iter().zip(&shape.places) {
            let (mut a, mut b) = ([0.0; 6], [0.0; 6]);
            for row in block.range() {
                if place.own == NONE {
                    let force = rho[row] * self.weight[row];
                    kernels::add_scaled(&mut a, force, &jacobian[row][0]);
                    kernels::add_scaled(&mut b, force, &jacobian[row][1]);
                } else {
                    self.dlambda[row] = if self.weight[row] == 0.0 { 0.0 } else { rho[row] };
                }
            }
            if place.own == NONE {
                add_to_bodies(&mut self.dy, block, &a, &b);
            }
        }
        self.solve_factored(blocks, jacobian, shape, false);
        for (block, place) in blocks.iter().zip(&shape.places) {
            let [a, b] = of_bodies(&self.dy, block);
            for row in block.range() {
                x[row] = if place.own == NONE {
                    let j = &jacobian[row];
                    (rho[row] - (kernels::dot(&j[0], &a) + kernels::dot(&j[1], &b))) * self.weight[row]
                } else {
                    self.dlambda[row]
                };
            }
        }
    }

    /// Adds the blocks of the rows that have a weight to the stale columns, and factors them.
    fn add_and_factorise(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow], shape: &Symbolic) {
        self.factor.clear_stale(shape);
        for (block, place) in blocks.iter().zip(&shape.places) {
            if place.own == NONE {
                self.add_folded(block, jacobian, place, shape);
            } else {
                self.add_joint(block, jacobian, place, shape);
            }
        }
        for coupling in &shape.couplings {
            let [later, earlier] = coupling.blocks.map(|i| i as usize);
            if !self.factor.is_stale(shape.places[earlier].own) {
                continue;
            }
            let height = shape.size[shape.places[later].own as usize];
            let out = &mut self.factor.values[shape.at[coupling.at as usize] as usize..];
            let [rows, cols] = [later, earlier].map(|i| blocks[i].range());
            let [s, t] = coupling.sides.map(usize::from);
            let rows = (&jacobian[rows.clone()], &self.weight[rows], s);
            let cols = (&jacobian[cols.clone()], &self.weight[cols], t);
            by_sizes!(sub_product, [height], (out, rows, cols));
        }
        self.factor.factorise(shape);
    }

    /// `J^T S^-1 J` of rows without unknowns of their own.
    fn add_folded(&mut self, block: &RowBlock, jacobian: &[ScaledRow], place: &Place, shape: &Symbolic) {
        let (columns, pair) = (place.columns, place.at[0]);
        let stale = columns.map(|c| self.factor.is_stale(c));
        if !stale[0] && !stale[1] {
            return;
        }
        let (mut a, mut b, mut across) = ([0.0; 36], [0.0; 36], [0.0; 36]);
        let mut any = false;
        // The pair's block stands in the column of the body that is eliminated first.
        let (low, high) = if columns[0] < columns[1] { (0, 1) } else { (1, 0) };
        for row in block.range() {
            let (s, j) = (self.weight[row], &jacobian[row]);
            if s == 0.0 {
                continue;
            }
            any = true;
            if stale[0] {
                kernels::add_outer(&mut a, s, &j[0], &j[0]);
            }
            if stale[1] {
                kernels::add_outer(&mut b, s, &j[1], &j[1]);
            }
            if pair != NONE && stale[low] {
                kernels::add_outer(&mut across, s, &j[high], &j[low]);
            }
        }
        if any {
            if stale[0] {
                self.factor.add_diagonal(columns[0], shape, &a);
            }
            if stale[1] {
                self.factor.add_diagonal(columns[1], shape, &b);
            }
            if pair != NONE && stale[low] {
                self.factor.add_below(pair, shape, &across);
            }
        }
    }

    /// `-S` of a joint, `J` between it and its bodies; of light bodies, which are eliminated already, `-J J^T`.
    fn add_joint(&mut self, block: &RowBlock, jacobian: &[ScaledRow], place: &Place, shape: &Symbolic) {
        let own = place.own as usize;
        let width = usize::from(shape.size[own]);
        let range = block.range();
        let (rows, weight) = (&jacobian[range.clone()], &self.weight[range]);
        if self.factor.is_stale(place.own) {
            let diagonal = &mut self.factor.values[shape.start[own] as usize..];
            for (c, weight) in weight.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
                // A row without a weight keeps the -1 that stands there.
                diagonal[(width + 1) * c] = -1.0 / weight;
            }
            for (s, _) in light_sides(block, place) {
                let rows = (rows, weight, s);
                by_sizes!(sub_product, [width], (diagonal, rows, rows));
            }
        }
        for (s, column) in place.columns.into_iter().enumerate() {
            if column == NONE || !self.factor.is_stale(column.min(place.own)) {
                continue;
            }
            let values = &mut self.factor.values[shape.at[place.at[s] as usize] as usize..];
            for (r, (row, weight)) in rows.iter().zip(weight).enumerate() {
                if *weight == 0.0 {
                    continue;
                }
                for (c, x) in row[s].iter().enumerate() {
                    // By columns: the one eliminated first.
                    let at = if column < place.own { width * c + r } else { 6 * r + c };
                    values[at] += x;
                }
            }
        }
    }

    /// Solves with the factor: `dy` holds the right-hand side of the bodies and becomes their part of the solution, `dlambda` that of
    /// the rows with unknowns of their own. If `at_rest`, the bodies' right-hand side is zero.
    fn solve_factored(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        shape: &Symbolic,
        at_rest: bool,
    ) {
        let z = &mut self.z;
        for (dy, column) in self.dy.iter().zip(&shape.body_column) {
            if *column != NONE {
                let at = shape.offset[*column as usize] as usize;
                z[at..at + 6].copy_from_slice(dy);
            }
        }
        for (block, place) in blocks.iter().zip(&shape.places) {
            if place.own == NONE {
                continue;
            }
            let own = place.own as usize;
            let z = &mut z[shape.offset[own] as usize..shape.offset[own + 1] as usize];
            let range = block.range();
            let (force, weight) = (&self.dlambda[range.clone()], &self.weight[range.clone()]);
            z[force.len()..].fill(0.0);
            for (z, (force, weight)) in z.iter_mut().zip(force.iter().zip(weight)) {
                *z = if *weight == 0.0 { 0.0 } else { *force };
            }
            if at_rest {
                continue;
            }
            for (s, body) in light_sides(block, place) {
                let dy = &self.dy[body];
                for (z, (row, weight)) in z.iter_mut().zip(jacobian[range.clone()].iter().zip(weight)) {
                    if *weight != 0.0 {
                        *z -= kernels::dot(&row[s], dy);
                    }
                }
            }
        }
        self.factor.solve(shape, z);
        for (dy, column) in self.dy.iter_mut().zip(&shape.body_column) {
            if *column != NONE {
                let at = shape.offset[*column as usize] as usize;
                dy.copy_from_slice(&z[at..at + 6]);
            }
        }
        for (block, place) in blocks.iter().zip(&shape.places) {
            if place.own == NONE {
                continue;
            }
            let z = &z[shape.offset[place.own as usize] as usize..];
            let range = block.range();
            let (force, weight) = (&mut self.dlambda[range.clone()], &self.weight[range.clone()]);
            for (z, (force, weight)) in z.iter().zip(force.iter_mut().zip(weight)) {
                *force = if *weight == 0.0 { 0.0 } else { -z };
            }
            for (s, body) in light_sides(block, place) {
                let mut sum = [0.0; 6];
                for (row, force) in jacobian[range.clone()].iter().zip(force.iter()) {
                    kernels::add_scaled(&mut sum, *force, &row[s]);
                }
                kernels::add_scaled(&mut self.dy[body], 1.0, &sum);
            }
        }
    }

    /// Solves for the free rows with the forces of the others as they stand in `lambda`. Returns the largest force.
    pub fn solve(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
    ) -> f64 {
        self.y.fill([0.0; 6]);
        for (lambda, state) in self.lambda.iter_mut().zip(state) {
            if *state == RowState::Free {
                *lambda = 0.0;
            }
        }
        (self.change, self.rate) = (self.correct(blocks, jacobian, state, shape, Pass::First), 1.0);
        self.apply();
        let (mut largest, mut strongest): (f64, f64) = (0.0, 0.0);
        for (lambda, diagonal) in self.lambda.iter().zip(&self.diagonal) {
            if lambda.abs() > largest || lambda.is_nan() {
                largest = lambda.abs();
            }
            let square = lambda * lambda * diagonal;
            strongest = if square > strongest { square } else { strongest };
        }
        self.scale = strongest.sqrt();
        largest
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
        if pass == Pass::Own && self.raised {
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
            let change = self.correct(blocks, jacobian, state, shape, pass);
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

    /// Finds one correction. Returns the largest change of an acceleration.
    fn correct(
        &mut self,
        blocks: &[RowBlock],
        jacobian: &[ScaledRow],
        state: &[RowState],
        shape: &Symbolic,
        pass: Pass,
    ) -> f64 {
        let first = pass == Pass::First;
        let sigma = if pass == Pass::Own { &self.sigma } else { &self.used_sigma };
        for (dy, y) in self.dy.iter_mut().zip(&self.y) {
            *dy = y.map(|y| -y);
        }
        let mut at_rest = first;
        for (block, place) in blocks.iter().zip(&shape.places) {
            let range = block.range();
            let rows = &jacobian[range.clone()];
            let (lambda, state) = (&self.lambda[range.clone()], &state[range.clone()]);
            let (sigma, rhs) = (&sigma[range.clone()], &self.rhs[range.clone()]);
            if place.own != NONE && first && state.iter().all(|s| *s == RowState::Free) {
                self.dlambda[range].copy_from_slice(rhs);
                continue;
            }
            at_rest = false;
            let (error, own) = (&mut self.error[range.clone()], &mut self.dlambda[range.clone()]);
            let inverse_sigma = &self.inverse_sigma[range];
            let [ya, yb] = if first { [[0.0; 6]; 2] } else { of_bodies(&self.y, block) };
            let (mut a, mut b) = ([0.0; 6], [0.0; 6]);
            for (i, j) in rows.iter().enumerate() {
                let mut force = lambda[i];
                if state[i] == RowState::Free {
                    let jy = if first { 0.0 } else { kernels::dot(&j[0], &ya) + kernels::dot(&j[1], &yb) };
                    error[i] = rhs[i] - jy - sigma[i] * force;
                    if place.own == NONE {
                        force += error[i] * inverse_sigma[i];
                    } else {
                        own[i] = error[i];
                    }
                }
                kernels::add_scaled(&mut a, force, &j[0]);
                kernels::add_scaled(&mut b, force, &j[1]);
            }
            add_to_bodies(&mut self.dy, block, &a, &b);
        }
        self.solve_factored(blocks, jacobian, shape, at_rest);
        for (block, place) in blocks.iter().zip(&shape.places) {
            if place.own == NONE {
                let [da, db] = of_bodies(&self.dy, block);
                for row in block.range() {
                    self.dlambda[row] = 0.0;
                    if state[row] == RowState::Free {
                        let j = &jacobian[row];
                        let jdy = kernels::dot(&j[0], &da) + kernels::dot(&j[1], &db);
                        self.dlambda[row] = (self.error[row] - jdy) * self.inverse_sigma[row];
                    }
                }
            }
        }
        let mut largest: f64 = 0.0;
        for dy in self.dy.as_flattened() {
            if dy.abs() > largest || dy.is_nan() {
                largest = dy.abs();
            }
        }
        largest
    }

    /// Makes the correction that was found last.
    fn apply(&mut self) {
        for (y, dy) in self.y.iter_mut().zip(&self.dy) {
            kernels::add_scaled(y, 1.0, dy);
        }
        for (lambda, change) in self.lambda.iter_mut().zip(&self.dlambda) {
            *lambda += change;
        }
    }

    /// Sets `jy` to `J y`.
    pub fn product(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow]) {
        multiply(blocks, jacobian, &self.y, &mut self.jy);
    }

    /// Sets `y` to `J^T lambda` and `jy` to `J y`, from the forces alone.
    pub fn accelerations(&mut self, blocks: &[RowBlock], jacobian: &[ScaledRow]) {
        self.y.fill([0.0; 6]);
        multiply_transposed(blocks, jacobian, &self.lambda, &mut self.y);
        self.product(blocks, jacobian);
    }
}

/// `out += J^T x`.
fn multiply_transposed(blocks: &[RowBlock], jacobian: &[ScaledRow], x: &[f64], out: &mut [Six]) {
    for block in blocks {
        let (mut a, mut b) = ([0.0; 6], [0.0; 6]);
        for row in block.range() {
            kernels::add_scaled(&mut a, x[row], &jacobian[row][0]);
            kernels::add_scaled(&mut b, x[row], &jacobian[row][1]);
        }
        add_to_bodies(out, block, &a, &b);
    }
}

/// `out = J y`.
pub(crate) fn multiply(blocks: &[RowBlock], jacobian: &[ScaledRow], y: &[Six], out: &mut [f64]) {
    for block in blocks {
        let [ya, yb] = of_bodies(y, block);
        for row in block.range() {
            let j = &jacobian[row];
            out[row] = kernels::dot(&j[0], &ya) + kernels::dot(&j[1], &yb);
        }
    }
}

/// What `y` holds for the bodies of a block; zero where there is none.
#[inline(always)]
fn of_bodies(y: &[Six], block: &RowBlock) -> [Six; 2] {
    block.bodies.map(|b| if b == NO_SPARSE_BODY { [0.0; 6] } else { y[b as usize] })
}

/// The bodies of a joint that have no column, each with its side.
#[inline(always)]
fn light_sides(block: &RowBlock, place: &Place) -> impl Iterator<Item = (usize, usize)> {
    let sides = block.bodies.into_iter().zip(place.columns).enumerate();
    sides
        .filter(|(_, (body, column))| *column == NONE && *body != NO_SPARSE_BODY)
        .map(|(s, (body, _))| (s, body as usize))
}

/// Rows with their weights, seen from one of their two bodies.
type Side<'a> = (&'a [ScaledRow], &'a [f64], usize);

/// `out -= A B^T` for rows `A` and `B` of the same body, without those that have no weight; `out` has `H` rows.
#[inline(always)]
fn sub_product<const H: usize>(out: &mut [f64], a: Side<'_>, b: Side<'_>) {
    // Three rows fill two pairs of lanes.
    if H == 3 { sub_product_in::<3, 4>(out, a, b) } else { sub_product_in::<6, 6>(out, a, b) }
}

#[inline(always)]
fn sub_product_in<const H: usize, const W: usize>(
    out: &mut [f64],
    (a, a_weight, s): Side<'_>,
    (b, b_weight, t): Side<'_>,
) {
    let mut transposed = [[0.0; W]; 6];
    for (r, (row, weight)) in a.iter().zip(a_weight).enumerate().take(H) {
        if *weight != 0.0 {
            for q in 0..6 {
                transposed[q][r] = row[s][q];
            }
        }
    }
    for (out, (row, weight)) in out.chunks_exact_mut(H).zip(b.iter().zip(b_weight)) {
        if *weight != 0.0 {
            let mut sum = [0.0; W];
            for (column, x) in transposed.iter().zip(&row[t]) {
                for (sum, a) in sum.iter_mut().zip(column) {
                    *sum += a * x;
                }
            }
            for (out, sum) in out.iter_mut().zip(sum) {
                *out -= sum;
            }
        }
    }
}

#[inline(always)]
fn add_to_bodies(y: &mut [Six], block: &RowBlock, a: &Six, b: &Six) {
    for (body, sum) in block.bodies.into_iter().zip([a, b]) {
        if body != NO_SPARSE_BODY {
            kernels::add_scaled(&mut y[body as usize], 1.0, sum);
        }
    }
}
