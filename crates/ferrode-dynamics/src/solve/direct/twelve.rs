//! Products with rows, in quads: the twelve numbers of a row, six for each of its bodies, are three of them.

use super::jacobian;
use crate::rows::Row;
use ferrode_math::Vec3;
use ferrode_math::simd::{Pair, Quad};

/// A linear and an angular part.
pub(super) type Six = [f64; 6];

/// Six numbers for each of two bodies.
#[derive(Clone, Copy)]
pub(super) struct Twelve<Q: Quad>([Q; 3]);

impl<Q: Quad> Twelve<Q> {
    /// The Jacobian of a row.
    #[inline(always)]
    pub fn of_row(row: &Row) -> Self {
        let (a, b) = ((row.linear1, row.angular1), (row.linear2, row.angular2));
        Self([
            Q::load(&[a.0.x, a.0.y, a.0.z, a.1.x]),
            Q::load(&[a.1.y, a.1.z, b.0.x, b.0.y]),
            Q::load(&[b.0.z, b.1.x, b.1.y, b.1.z]),
        ])
    }

    /// What is listed for two bodies; zero where there is none.
    #[inline(always)]
    pub fn of_bodies(of: &[Six], bodies: [u32; 2]) -> Self {
        let zero = [0.0; 6];
        let a = if let Some(six) = of.get(bodies[0] as usize) { six } else { &zero };
        let b = if let Some(six) = of.get(bodies[1] as usize) { six } else { &zero };
        Self([
            Q::load(&[a[0], a[1], a[2], a[3]]),
            Q::load(&[a[4], a[5], b[0], b[1]]),
            Q::load(&[b[2], b[3], b[4], b[5]]),
        ])
    }

    /// Writes them where they are listed for two bodies.
    #[inline(always)]
    pub fn put(self, to: &mut [Six], bodies: [u32; 2]) {
        let [a, middle, b] = self.0;
        if let Some(six) = to.get_mut(bodies[0] as usize) {
            store(six, a, middle.low());
        }
        if let Some([x, y, rest @ ..]) = to.get_mut(bodies[1] as usize) {
            let mut first = [0.0; 2];
            middle.high().store(&mut first);
            [*x, *y] = first;
            b.store(rest);
        }
    }

    /// `self + s a`.
    #[inline(always)]
    pub fn plus(self, s: f64, a: Self) -> Self {
        let s = Q::splat(s);
        Self([self.0[0] + a.0[0] * s, self.0[1] + a.0[1] * s, self.0[2] + a.0[2] * s])
    }

    /// The products with the numbers of a row, if there is one, to be summed.
    #[inline(always)]
    fn terms(self, rows: &[Row], i: usize) -> Q {
        let Some(row) = rows.get(i) else { return Q::splat(0.0) };
        let row = Self::of_row(row);
        (self.0[0] * row.0[0] + self.0[1] * row.0[1]) + self.0[2] * row.0[2]
    }

    /// The products with up to four rows.
    #[inline(always)]
    pub fn times_rows(self, rows: &[Row]) -> [f64; 4] {
        let mut out = [0.0; 4];
        Q::sums([self.terms(rows, 0), self.terms(rows, 1), self.terms(rows, 2), self.terms(rows, 3)])
            .store(&mut out);
        out
    }
}

/// Writes four numbers and two.
#[inline(always)]
fn store<Q: Quad>(to: &mut Six, four: Q, two: Q::Pair) {
    if let Some(to) = to.first_chunk_mut() {
        four.store(to);
    }
    if let Some(to) = to.last_chunk_mut() {
        two.store(to);
    }
}

/// A root `C` of a body's inverse mass `C Cᵀ`, as a row is multiplied by it: its first four numbers times `first`, plus `of_y` and `of_z` times
/// its fifth and its sixth.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Root {
    first: [f64; 4],
    of_y: ([f64; 4], [f64; 2]),
    of_z: ([f64; 4], [f64; 2]),
}

impl Root {
    /// From the root of the inverse mass, and the lower triangle of that of the inverse inertia by rows: (0,0), (1,0), (1,1), (2,0), …
    pub fn new(linear: f64, [l00, l10, l11, l20, l21, l22]: Six) -> Self {
        Self {
            first: [linear, linear, linear, l00],
            of_y: ([0.0, 0.0, 0.0, l10], [l11, 0.0]),
            of_z: ([0.0, 0.0, 0.0, l20], [l21, l22]),
        }
    }

    /// Whether forces don't move the body.
    pub fn is_zero(&self) -> bool {
        let nothing = ([0.0; 4], [0.0; 2]);
        self.first == nothing.0 && self.of_y == nothing && self.of_z == nothing
    }

    /// J C of a row's side.
    #[inline(always)]
    pub fn apply<Q: Quad>(&self, row: &Row, side: u32, out: &mut Six) {
        let (linear, angular): (Vec3, Vec3) = jacobian(row, side);
        let four = Q::load(&[linear.x, linear.y, linear.z, angular.x]) * Q::load(&self.first);
        let (y, z) = (Q::splat(angular.y), Q::splat(angular.z));
        let four = (four + Q::load(&self.of_y.0) * y) + Q::load(&self.of_z.0) * z;
        let two = Q::Pair::load(&self.of_y.1) * y.low() + Q::Pair::load(&self.of_z.1) * z.low();
        store(out, four, two);
    }
}
