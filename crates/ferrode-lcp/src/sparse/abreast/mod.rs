//! Four or eight islands of the same shape at once: robots of one kind, say.
//!
//! In a block of lanes stands the same number of each of them, so that nothing is lost on blocks of three or six, nor on sums across a register.
//! Each island's numbers go through the operations that [`super::system`] would put them through, in the same order, to the same bits: which
//! islands share lanes can't be seen in the answer. Only joints that have unknowns of their own take part ([`serves`]).

mod blocks;
mod factor;
mod system;

use super::ScaledRow;
use super::symbolic::{NONE, Symbolic};
use blocks::Row;
use factor::Factor;
use ferrode_math::simd::{Block64, Quad, QuadKernel, dispatch_quads};
pub(crate) use system::Task;

pub(crate) use crate::pivoting::ABREAST;
use crate::pivoting::RowState;

/// Whether islands of this shape can be solved so.
pub(crate) fn serves(shape: &Symbolic) -> bool {
    shape.places.iter().all(|place| place.own != NONE)
}

/// The rows of several islands with what is computed for each, and the unknowns: as in [`super::system::System`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Abreast<B> {
    jacobian: Vec<Row<B>>,
    pub sigma: Vec<B>,
    pub used_sigma: Vec<B>,
    inverse_sigma: Vec<B>,
    pub diagonal: Vec<B>,
    pub rhs: Vec<B>,
    pub lo: Vec<B>,
    pub hi: Vec<B>,
    /// `1 / S`, or 0 for a row whose force is given.
    weight: Vec<B>,
    pub lambda: Vec<B>,
    /// `J y`, where it was asked for.
    pub jy: Vec<B>,
    y: Vec<[B; 6]>,
    dy: Vec<[B; 6]>,
    dlambda: Vec<B>,
    z: Vec<B>,
    /// Per block of rows: whether all of them have a weight, in all of them.
    whole: Vec<bool>,
    /// The rows that have a bound in any of them, and their blocks.
    pub bounded: Vec<[u32; 2]>,
    /// Whether some row's CFM was raised.
    raised: bool,
    factor: Factor<B>,
}

impl<B: Block64> Abreast<B> {
    /// Takes rows in.
    pub fn load(&mut self, islands: &[Numbers<'_>; ABREAST], shape: &Symbolic) {
        let m = islands[0].jacobian.len();
        self.jacobian.resize(m, [B::splat(0.0); 12]);
        for v in [&mut self.sigma, &mut self.rhs, &mut self.lo, &mut self.hi] {
            v.resize(m, B::splat(0.0));
        }
        interleave(
            islands.map(|i| i.jacobian.as_flattened().as_flattened()),
            self.jacobian.as_flattened_mut(),
        );
        interleave(islands.map(|i| i.sigma), &mut self.sigma);
        interleave(islands.map(|i| i.rhs), &mut self.rhs);
        interleave(islands.map(|i| i.lo), &mut self.lo);
        interleave(islands.map(|i| i.hi), &mut self.hi);
        for v in [
            &mut self.used_sigma,
            &mut self.inverse_sigma,
            &mut self.diagonal,
            &mut self.weight,
            &mut self.lambda,
            &mut self.jy,
            &mut self.dlambda,
        ] {
            v.resize(m, B::splat(0.0));
        }
        for v in [&mut self.y, &mut self.dy] {
            v.resize(shape.bodies(), [B::splat(0.0); 6]);
        }
        self.z.resize(shape.offset.last().map_or(0, |n| *n as usize), B::splat(0.0));
        self.whole.resize(shape.places.len(), false);
    }

    /// Forgets the last solution.
    pub fn begin(&mut self) {
        self.lambda.fill(B::splat(0.0));
        self.y.fill([B::splat(0.0); 6]);
    }

    /// Has the bounded rows be free, or their forces given by their bounds, as their states say.
    pub fn hold(&mut self, states: &[[RowState; ABREAST]]) {
        self.weight.copy_from_slice(&self.inverse_sigma);
        self.whole.fill(true);
        for ([row, block], states) in self.bounded.iter().zip(states) {
            let row = *row as usize;
            for (l, state) in states.iter().enumerate().take(B::LANES) {
                let force = match state {
                    RowState::Free => continue,
                    RowState::Lower => self.lo[row][l],
                    RowState::Upper => self.hi[row][l],
                };
                self.lambda[row][l] = force;
                self.weight[row][l] = 0.0;
                self.whole[*block as usize] = false;
            }
        }
    }
}

/// The numbers of one island's rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Numbers<'a> {
    jacobian: &'a [ScaledRow],
    sigma: &'a [f64],
    rhs: &'a [f64],
    lo: &'a [f64],
    hi: &'a [f64],
}

impl<'a> Numbers<'a> {
    /// Of rows, and of what there is at least as much of: CFM/h, right-hand side and bounds.
    pub fn of(jacobian: &'a [ScaledRow], lists: [&'a [f64]; 4]) -> Self {
        let [sigma, rhs, lo, hi] = lists.map(|list| &list[..jacobian.len()]);
        Self { jacobian, sigma, rhs, lo, hi }
    }
}

/// Puts numbers of the islands side by side, of as many as there are lanes.
fn interleave<B: Block64>(of: [&[f64]; ABREAST], out: &mut [B]) {
    dispatch_quads(Interleave(of, out));
}

struct Interleave<'a, B>([&'a [f64]; ABREAST], &'a mut [B]);

impl<B: Block64> QuadKernel for Interleave<'_, B> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        let Self(of, out) = self;
        let mut of = of;
        let count = out.len();
        for from in &mut of {
            *from = &from[..count];
        }
        let (chunks, last) = out.as_chunks_mut::<4>();
        // All lanes of a number before the next: they share a cache line.
        for (i, out) in chunks.iter_mut().enumerate() {
            for part in 0..B::LANES / 4 {
                let mut rows = [Q::splat(0.0); 4];
                for l in 0..4 {
                    if let Some(four) = of[4 * part + l][4 * i..].first_chunk() {
                        rows[l] = Q::load(four);
                    }
                }
                let columns = Q::columns(rows);
                for k in 0..4 {
                    columns[k].store(&mut out[k].as_mut().as_chunks_mut::<4>().0[part]);
                }
            }
        }
        let first = count - last.len();
        for (i, out) in last.iter_mut().enumerate() {
            for l in 0..B::LANES {
                out[l] = of[l][first + i];
            }
        }
    }
}
