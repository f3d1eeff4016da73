//! Solves of several islands with the rows of given sets held exactly: [`super::super::system`] with lanes for each number.

use super::super::RowBlock;
use super::super::kernels::stride;
use super::super::symbolic::{NONE, Symbolic};
use super::super::system::{LEAST_SIGMA, Pass};
use super::blocks::{Row, add, folded_sum, load, plus_row, store, sum, terms, where_positive};
use super::factor::{assemble, light_sides};
use super::{ABREAST, Abreast};
use ferrode_math::simd::{Block64, Kernel64, Lanes64};

/// What is to be done, with the machine's instructions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Task {
    /// Computes what the rows alone decide: diagonals, CFM as used.
    Prepare,
    /// Assembles and factors.
    Factorise,
    /// Finds a correction; the answer is the largest change of an acceleration.
    Correct(Pass),
    /// Makes the correction that was found last, where `true`.
    Apply([bool; ABREAST]),
    /// Nothing is changed; the answer is the largest force, and the square of what the force that does most does to its row.
    Strengths,
    /// Nothing is changed; the answer is above zero where the pivot of a raised row is not so many times what its CFM was raised to.
    Loose(f64),
    /// Sets `jy` to `J y` in the rows that have a bound.
    Product,
    /// Brings forces inside their bounds, and sets `y` to `J^T lambda` and `jy` to `J y`, from these alone. The answer is the natural residual and
    /// the largest force.
    Measure,
}

struct Work<'a, B> {
    all: &'a mut Abreast<B>,
    blocks: &'a [RowBlock],
    shape: &'a Symbolic,
    task: Task,
}

impl<B: Block64> Kernel64<B> for Work<'_, B> {
    type Out = [B; 2];

    #[inline(always)]
    fn run<Q: Lanes64<Block = B>>(self) -> [B; 2] {
        let Self { all, blocks, shape, task } = self;
        match task {
            Task::Prepare => all.prepare::<Q>(),
            Task::Factorise => {
                assemble::<Q>(all, blocks, shape);
                all.factor.factorise::<Q>(shape);
            }
            Task::Correct(pass) => return [all.correct::<Q>(blocks, shape, pass), B::splat(0.0)],
            Task::Apply(to) => all.apply::<Q>(to),
            Task::Strengths => return all.strengths::<Q>(),
            Task::Loose(firm) => return [all.loose::<Q>(blocks, shape, firm), B::splat(0.0)],
            Task::Product => {
                for [row, block] in &all.bounded {
                    let y = of_bodies::<Q>(&all.y, blocks[*block as usize].bodies);
                    let row = *row as usize;
                    sum(terms(&all.jacobian[row], &y, [true; 2])).store(&mut all.jy[row]);
                }
            }
            Task::Measure => return all.measure::<Q>(blocks),
        }
        [B::splat(0.0); 2]
    }
}

/// What `y` holds for two bodies; zero where there is none.
#[inline(always)]
fn of_bodies<Q: Lanes64>(y: &[[Q::Block; 6]], bodies: [u32; 2]) -> [Q; 12] {
    let mut out = [Q::splat(0.0); 12];
    for s in 0..2 {
        if let Some(y) = y.get(bodies[s] as usize) {
            for i in 0..6 {
                out[6 * s + i] = Q::load(&y[i]);
            }
        }
    }
    out
}

/// `J y` of a block of rows.
#[inline(always)]
fn product<Q: Lanes64>(
    jacobian: &[Row<Q::Block>],
    block: &RowBlock,
    y: &[[Q::Block; 6]],
    out: &mut [Q::Block],
) {
    let (range, y) = (block.range(), of_bodies::<Q>(y, block.bodies));
    for (row, out) in jacobian[range.clone()].iter().zip(&mut out[range]) {
        sum(terms(row, &y, [true; 2])).store(out);
    }
}

/// Adds to what `y` holds for two bodies, where they are.
#[inline(always)]
fn add_to_bodies<Q: Lanes64>(x: [Q; 12], y: &mut [[Q::Block; 6]], bodies: [u32; 2]) {
    let [a, b, c, d, e, f, g, h, i, j, k, l] = x;
    if let Some(y) = y.get_mut(bodies[0] as usize) {
        add([a, b, c, d, e, f], y);
    }
    if let Some(y) = y.get_mut(bodies[1] as usize) {
        add([g, h, i, j, k, l], y);
    }
}

/// The largest of some numbers, by size; not a number if one is not.
#[derive(Clone, Copy)]
struct Largest<Q> {
    most: Q,
    total: Q,
}

impl<Q: Lanes64> Largest<Q> {
    #[inline(always)]
    fn new() -> Self {
        Self { most: Q::splat(0.0), total: Q::splat(0.0) }
    }

    #[inline(always)]
    fn take(&mut self, x: Q) {
        let size = x.abs();
        self.most = size.greater(self.most);
        self.total += size;
    }

    #[inline(always)]
    fn with(self, b: Self) -> Self {
        Self { most: self.most.greater(b.most), total: self.total + b.total }
    }

    #[inline(always)]
    fn get(self) -> Q::Block {
        let (mut most, mut total) = (Q::Block::default(), Q::Block::default());
        self.most.store(&mut most);
        self.total.store(&mut total);
        for l in 0..Q::Block::LANES {
            if total[l].is_nan() {
                most[l] = total[l];
            }
        }
        most
    }
}

/// The nearest number within bounds.
#[inline(always)]
fn within<Q: Lanes64>(x: Q, (lo, hi): (&Q::Block, &Q::Block)) -> Q {
    let (x, hi) = (x.greater(Q::load(lo)), Q::load(hi));
    where_positive(x - hi, hi, x)
}

impl<B: Block64> Abreast<B> {
    /// Not a number where the machine has no lanes of the kind.
    pub fn work(&mut self, blocks: &[RowBlock], shape: &Symbolic, task: Task) -> [B; 2] {
        B::dispatch(Work { all: self, blocks, shape, task }).unwrap_or([B::splat(f64::NAN); 2])
    }

    #[inline(always)]
    fn prepare<Q: Lanes64<Block = B>>(&mut self) {
        let (zero, one, least) = (Q::splat(0.0), Q::splat(1.0), Q::splat(LEAST_SIGMA));
        for (row, jacobian) in self.jacobian.iter().enumerate() {
            let sigma = Q::load(&self.sigma[row]);
            let square = folded_sum(terms(jacobian, &load::<Q, 12>(jacobian), [true; 2]));
            let diagonal = square + sigma;
            let used = sigma.greater(least * diagonal);
            diagonal.store(&mut self.diagonal[row]);
            used.store(&mut self.used_sigma[row]);
            where_positive(used, one / used, zero).store(&mut self.inverse_sigma[row]);
        }
        self.raised = self.sigma != self.used_sigma;
    }

    #[inline(always)]
    fn strengths<Q: Lanes64<Block = B>>(&self) -> [B; 2] {
        let (mut largest, mut strongest) = (Largest::<Q>::new(), Largest::<Q>::new());
        for (lambda, diagonal) in self.lambda.iter().zip(&self.diagonal) {
            let lambda = Q::load(lambda);
            largest.take(lambda);
            strongest.take(lambda * lambda * Q::load(diagonal));
        }
        [largest.get(), strongest.get()]
    }

    #[inline(always)]
    fn measure<Q: Lanes64<Block = B>>(&mut self, blocks: &[RowBlock]) -> [B; 2] {
        let mut largest = Largest::<Q>::new();
        for (lambda, bounds) in self.lambda.iter_mut().zip(self.lo.iter().zip(&self.hi)) {
            let x = within(Q::load(lambda), bounds);
            x.store(lambda);
            largest.take(x);
        }
        self.y.fill([B::splat(0.0); 6]);
        for block in blocks {
            let range = block.range();
            let mut sum = [Q::splat(0.0); 12];
            for (row, lambda) in self.jacobian[range.clone()].iter().zip(&self.lambda[range]) {
                plus_row(&mut sum, Q::load(lambda), row);
            }
            add_to_bodies(sum, &mut self.y, block.bodies);
        }
        for block in blocks {
            product::<Q>(&self.jacobian, block, &self.y, &mut self.jy);
        }
        let mut residual = Largest::<Q>::new();
        for (row, bounds) in self.lo.iter().zip(&self.hi).enumerate() {
            let (x, sigma) = (Q::load(&self.lambda[row]), Q::load(&self.sigma[row]));
            let w = (Q::load(&self.jy[row]) + sigma * x) - Q::load(&self.rhs[row]);
            let moved = x - w / Q::load(&self.diagonal[row]);
            residual.take(x - within(moved, bounds));
        }
        [residual.get(), largest.get()]
    }

    #[inline(always)]
    fn apply<Q: Lanes64<Block = B>>(&mut self, to: [bool; ABREAST]) {
        let mut block = B::default();
        for l in 0..B::LANES {
            block[l] = f64::from(to[l]);
        }
        let to = Q::load(&block);
        for (y, dy) in self.y.as_flattened_mut().iter_mut().zip(self.dy.as_flattened()) {
            let before = Q::load(y);
            where_positive(to, before + Q::load(dy), before).store(y);
        }
        for (lambda, change) in self.lambda.iter_mut().zip(&self.dlambda) {
            let before = Q::load(lambda);
            where_positive(to, before + Q::load(change), before).store(lambda);
        }
    }

    /// Finds one correction. Returns the largest change of an acceleration; not a number if one is not.
    #[inline(always)]
    fn correct<Q: Lanes64<Block = B>>(&mut self, blocks: &[RowBlock], shape: &Symbolic, pass: Pass) -> B {
        let (first, zero) = (pass == Pass::First, Q::splat(0.0));
        let sigma = if pass == Pass::Own { &self.sigma } else { &self.used_sigma };
        for (dy, y) in self.dy.as_flattened_mut().iter_mut().zip(self.y.as_flattened()) {
            (if first { zero } else { zero - Q::load(y) }).store(dy);
        }
        // Whether the bodies' part of the right-hand side is zero.
        let mut at_rest = first;
        for (block, whole) in blocks.iter().zip(&self.whole) {
            let range = block.range();
            if first && *whole {
                self.dlambda[range.clone()].copy_from_slice(&self.rhs[range]);
                continue;
            }
            at_rest = false;
            let y = of_bodies::<Q>(&self.y, block.bodies);
            for row in range.clone() {
                let mut error = Q::load(&self.rhs[row]);
                if !first {
                    let jy = sum(terms(&self.jacobian[row], &y, [true; 2]));
                    error = (error - jy) - Q::load(&sigma[row]) * Q::load(&self.lambda[row]);
                }
                where_positive(Q::load(&self.weight[row]), error, zero).store(&mut self.dlambda[row]);
            }
            let mut forces = [zero; 12];
            for row in range {
                plus_row(&mut forces, Q::load(&self.lambda[row]), &self.jacobian[row]);
            }
            add_to_bodies(forces, &mut self.dy, block.bodies);
        }
        self.solve_factored::<Q>(blocks, shape, at_rest);
        let mut largest = [Largest::<Q>::new(); 2];
        for dy in &self.dy {
            for i in 0..6 {
                largest[i % 2].take(Q::load(&dy[i]));
            }
        }
        largest[0].with(largest[1]).get()
    }

    /// Solves with the factor: `dy` holds the right-hand side of the bodies and becomes their part of the solution, `dlambda` that of
    /// the rows.
    #[inline(always)]
    fn solve_factored<Q: Lanes64<Block = B>>(
        &mut self,
        blocks: &[RowBlock],
        shape: &Symbolic,
        at_rest: bool,
    ) {
        let zero = Q::splat(0.0);
        let mut z = core::mem::take(&mut self.z);
        for (dy, column) in self.dy.iter().zip(&shape.body_column) {
            if *column != NONE {
                store(load::<Q, 6>(dy), &mut z[shape.offset[*column as usize] as usize..]);
            }
        }
        for (block, place) in blocks.iter().zip(&shape.places) {
            let own = place.own as usize;
            let z = &mut z[shape.offset[own] as usize..shape.offset[own + 1] as usize];
            let light = light_sides(block, place);
            let count = block.range().len();
            if at_rest || light == [false; 2] {
                z[..count].copy_from_slice(&self.dlambda[block.range()]);
            } else {
                let dy = of_bodies::<Q>(&self.dy, block.bodies);
                for (z, row) in z.iter_mut().zip(block.range()) {
                    let product = sum(terms(&self.jacobian[row], &dy, light));
                    let right = Q::load(&self.dlambda[row]) - product;
                    where_positive(Q::load(&self.weight[row]), right, zero).store(z);
                }
            }
            z[count..].fill(B::splat(0.0));
        }
        self.factor.solve::<Q>(shape, &mut z);
        for (dy, column) in self.dy.iter_mut().zip(&shape.body_column) {
            if *column != NONE {
                store(load::<Q, 6>(&z[shape.offset[*column as usize] as usize..]), dy);
            }
        }
        for (block, place) in blocks.iter().zip(&shape.places) {
            let z = &z[shape.offset[place.own as usize] as usize..];
            let light = light_sides(block, place);
            let mut forces = [zero; 12];
            for (row, z) in block.range().zip(z) {
                let negative = zero - Q::load(z);
                let force = where_positive(Q::load(&self.weight[row]), negative, zero);
                force.store(&mut self.dlambda[row]);
                plus_row(&mut forces, force, &self.jacobian[row]);
            }
            let [a, b, c, d, e, f, g, h, i, j, k, l] = forces;
            if light[0] {
                add([a, b, c, d, e, f], &mut self.dy[block.bodies[0] as usize]);
            }
            if light[1] {
                add([g, h, i, j, k, l], &mut self.dy[block.bodies[1] as usize]);
            }
        }
        self.z = z;
    }

    /// Whether the pivot of each raised row is so large that what its CFM was raised by hardly matters: `System::holds_firmly`. The answer
    /// is above zero where one is not.
    #[inline(always)]
    fn loose<Q: Lanes64<Block = B>>(&self, blocks: &[RowBlock], shape: &Symbolic, firm: f64) -> B {
        let (mut loose, zero, one, firm) = (Q::splat(0.0), Q::splat(0.0), Q::splat(1.0), Q::splat(firm));
        if self.raised {
            for (block, place) in blocks.iter().zip(&shape.places) {
                let own = place.own as usize;
                let step = stride(usize::from(shape.size[own])) + 1;
                let roots = &self.factor.values[shape.start[own] as usize..];
                for (i, row) in block.range().enumerate() {
                    let (used, root) = (Q::load(&self.used_sigma[row]), Q::load(&roots[step * i]));
                    let raised = where_positive(used - Q::load(&self.sigma[row]), one, zero);
                    let raised = where_positive(Q::load(&self.weight[row]), raised, zero);
                    loose = loose.greater(Q::select((firm * used).le(root * root), zero, raised));
                }
            }
        }
        let mut out = B::default();
        loose.store(&mut out);
        out
    }
}
