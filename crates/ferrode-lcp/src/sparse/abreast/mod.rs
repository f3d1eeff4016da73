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
    /// Per block of rows: whether any has a bound, in any of them.
    pub bounded: Vec<bool>,
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

    /// Has rows, told with their blocks, take no part where their force is given.
    pub fn hold(&mut self, given: impl Iterator<Item = ([u32; 2], [bool; ABREAST])>) {
        self.weight.copy_from_slice(&self.inverse_sigma);
        self.whole.fill(true);
        for ([row, block], given) in given {
            for (weight, given) in self.weight[row as usize].as_mut().iter_mut().zip(given) {
                if given {
                    *weight = 0.0;
                    self.whole[block as usize] = false;
                }
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
    for (i, of) in of.as_chunks::<4>().0.iter().take(B::LANES / 4).enumerate() {
        dispatch_quads(Interleave(*of, out, i));
    }
}

/// Puts the numbers of four islands into the quarter or half of the lanes with that number.
struct Interleave<'a, B>([&'a [f64]; 4], &'a mut [B], usize);

impl<B: Block64> QuadKernel for Interleave<'_, B> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        let Self([a, b, c, d], out, part) = self;
        let (a, b) = (a.as_chunks::<4>(), b.as_chunks::<4>());
        let (c, d) = (c.as_chunks::<4>(), d.as_chunks::<4>());
        let (out, last) = out.as_chunks_mut::<4>();
        for ((((out, a), b), c), d) in out.iter_mut().zip(a.0).zip(b.0).zip(c.0).zip(d.0) {
            let columns = Q::columns([Q::load(a), Q::load(b), Q::load(c), Q::load(d)]);
            for i in 0..4 {
                columns[i].store(&mut out[i].as_mut().as_chunks_mut::<4>().0[part]);
            }
        }
        for ((((out, a), b), c), d) in last.iter_mut().zip(a.1).zip(b.1).zip(c.1).zip(d.1) {
            out.as_mut().as_chunks_mut::<4>().0[part] = [*a, *b, *c, *d];
        }
    }
}
