//! Four islands of the same shape at once: robots of one kind, say.
//!
//! In a quad stands the same number of each of the four, so that nothing is lost on blocks of three or six, nor on sums across a register.
//! Each island's numbers go through the operations that [`super::system`] would put them through, in the same order, to the same bits: which
//! islands share a quad can't be seen in the answer. Only joints that have unknowns of their own take part ([`serves`]).

mod blocks;
mod factor;
mod system;

use super::symbolic::{NONE, Symbolic};
use super::{RowBlock, ScaledRow};
use blocks::Row;
use factor::Factor;
pub(crate) use system::Task;

/// A number of each of the four.
pub(crate) type Four = [f64; 4];

/// Whether islands of this shape can be solved so.
pub(crate) fn serves(shape: &Symbolic) -> bool {
    shape.places.iter().all(|place| place.own != NONE)
}

/// The rows of four islands with what is computed for each, and the unknowns: as in [`super::system::System`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Abreast {
    jacobian: Vec<Row>,
    pub sigma: Vec<Four>,
    pub used_sigma: Vec<Four>,
    inverse_sigma: Vec<Four>,
    pub diagonal: Vec<Four>,
    pub rhs: Vec<Four>,
    pub bounds: Vec<[Four; 2]>,
    /// `1 / S`, or 0 for a row whose force is given.
    weight: Vec<Four>,
    pub lambda: Vec<Four>,
    /// `J y`, where it was asked for.
    pub jy: Vec<Four>,
    y: Vec<[Four; 6]>,
    dy: Vec<[Four; 6]>,
    dlambda: Vec<Four>,
    z: Vec<Four>,
    /// Per block of rows: whether all of them have a weight, in all four.
    whole: Vec<bool>,
    factor: Factor,
}

impl Abreast {
    /// Takes rows in.
    pub fn load(&mut self, islands: &[Numbers<'_>; 4], shape: &Symbolic) {
        let m = islands[0].jacobian.len();
        self.jacobian.resize(m, [[0.0; 4]; 12]);
        let [a, b, c, d] = islands.map(|island| island.jacobian);
        for (out, (((a, b), c), d)) in self.jacobian.iter_mut().zip(a.iter().zip(b).zip(c).zip(d)) {
            let [a, b, c, d] = [a, b, c, d].map(|row| row.as_flattened());
            for (out, (((a, b), c), d)) in out.iter_mut().zip(a.iter().zip(b).zip(c).zip(d)) {
                *out = [*a, *b, *c, *d];
            }
        }
        interleave(islands.map(|island| island.sigma), &mut self.sigma);
        interleave(islands.map(|island| island.rhs), &mut self.rhs);
        self.bounds.resize(m, [[0.0; 4]; 2]);
        for (row, [lo, hi]) in self.bounds.iter_mut().enumerate() {
            (*lo, *hi) = (islands.map(|island| island.lo[row]), islands.map(|island| island.hi[row]));
        }
        for v in [
            &mut self.used_sigma,
            &mut self.inverse_sigma,
            &mut self.diagonal,
            &mut self.weight,
            &mut self.lambda,
            &mut self.jy,
            &mut self.dlambda,
        ] {
            v.resize(m, [0.0; 4]);
        }
        for v in [&mut self.y, &mut self.dy] {
            v.resize(shape.bodies(), [[0.0; 4]; 6]);
        }
        self.z.resize(shape.offset.last().map_or(0, |n| *n as usize), [0.0; 4]);
        self.whole.resize(shape.places.len(), false);
    }

    /// Sets which rows are free.
    pub fn set_free(&mut self, free: impl Iterator<Item = [bool; 4]>, blocks: &[RowBlock]) {
        for ((weight, inverse), free) in self.weight.iter_mut().zip(&self.inverse_sigma).zip(free) {
            for l in 0..4 {
                weight[l] = if free[l] { inverse[l] } else { 0.0 };
            }
        }
        for (whole, block) in self.whole.iter_mut().zip(blocks) {
            *whole = self.weight[block.range()].as_flattened().iter().all(|weight| *weight != 0.0);
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

fn interleave([a, b, c, d]: [&[f64]; 4], out: &mut Vec<Four>) {
    out.clear();
    out.extend(a.iter().zip(b).zip(c).zip(d).map(|(((a, b), c), d)| [*a, *b, *c, *d]));
}
