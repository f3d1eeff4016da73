//! Four islands of the same shape at once: robots of one kind, say.
//!
//! In a quad stands the same number of each of the four, so that nothing is lost on blocks of three or six, nor on sums across a register.
//! Each island's numbers go through the operations that [`super::system`] would put them through, in the same order, to the same bits: which
//! islands share a quad can't be seen in the answer. Only joints that have unknowns of their own take part ([`serves`]).

mod blocks;
mod factor;
mod system;

use super::ScaledRow;
use super::symbolic::{NONE, Symbolic};
use blocks::Row;
use factor::Factor;
use ferrode_math::simd::{Quad, QuadKernel, dispatch_quads};
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
    pub lo: Vec<Four>,
    pub hi: Vec<Four>,
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
    /// Per block of rows: whether any has a bound, in any of the four.
    pub bounded: Vec<bool>,
    /// Whether some row's CFM was raised.
    raised: bool,
    factor: Factor,
}

impl Abreast {
    /// Takes rows in.
    pub fn load(&mut self, islands: &[Numbers<'_>; 4], shape: &Symbolic) {
        let m = islands[0].jacobian.len();
        self.jacobian.resize(m, [[0.0; 4]; 12]);
        for v in [&mut self.sigma, &mut self.rhs, &mut self.lo, &mut self.hi] {
            v.resize(m, [0.0; 4]);
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
            v.resize(m, [0.0; 4]);
        }
        for v in [&mut self.y, &mut self.dy] {
            v.resize(shape.bodies(), [[0.0; 4]; 6]);
        }
        self.z.resize(shape.offset.last().map_or(0, |n| *n as usize), [0.0; 4]);
        self.whole.resize(shape.places.len(), false);
    }

    /// Forgets the last solution.
    pub fn begin(&mut self) {
        self.lambda.fill([0.0; 4]);
        self.y.fill([[0.0; 4]; 6]);
    }

    /// Has rows, told with their blocks, take no part where their force is given.
    pub fn hold(&mut self, given: impl Iterator<Item = ([u32; 2], [bool; 4])>) {
        self.weight.copy_from_slice(&self.inverse_sigma);
        self.whole.fill(true);
        for ([row, block], given) in given {
            for (weight, given) in self.weight[row as usize].iter_mut().zip(given) {
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

/// Puts numbers of the four side by side.
fn interleave(of: [&[f64]; 4], out: &mut [Four]) {
    struct Interleave<'a>([&'a [f64]; 4], &'a mut [Four]);

    impl QuadKernel for Interleave<'_> {
        type Out = ();

        #[inline(always)]
        fn run<Q: Quad>(self) {
            let Self([a, b, c, d], out) = self;
            let (a, b) = (a.as_chunks::<4>(), b.as_chunks::<4>());
            let (c, d) = (c.as_chunks::<4>(), d.as_chunks::<4>());
            let (out, last) = out.as_chunks_mut::<4>();
            for ((((out, a), b), c), d) in out.iter_mut().zip(a.0).zip(b.0).zip(c.0).zip(d.0) {
                let [w, x, y, z] = Q::columns([Q::load(a), Q::load(b), Q::load(c), Q::load(d)]);
                w.store(&mut out[0]);
                x.store(&mut out[1]);
                y.store(&mut out[2]);
                z.store(&mut out[3]);
            }
            for ((((out, a), b), c), d) in last.iter_mut().zip(a.1).zip(b.1).zip(c.1).zip(d.1) {
                *out = [*a, *b, *c, *d];
            }
        }
    }

    dispatch_quads(Interleave(of, out));
}
