//! Products with the rows of a problem, in quads: the twelve numbers of a row, six for each of its bodies, are three of them.

use super::kernels::{Block, Column, Six, pair, quad, store_pair, store_quad, stride};
use super::{RowBlock, ScaledRow};
use core::ops::Range;
use ferrode_math::simd::{Pair, Quad, QuadKernel, dispatch_quads};

/// Six numbers for each of two bodies, as a row has them.
#[derive(Clone, Copy)]
pub(crate) struct Twelve<Q: Quad>([Q; 3]);

impl<Q: Quad> Twelve<Q> {
    #[inline(always)]
    pub fn zero() -> Self {
        Self([Q::splat(0.0); 3])
    }

    /// The numbers of a row.
    #[inline(always)]
    pub fn of_row(row: &ScaledRow) -> Self {
        let row = row.as_flattened();
        Self([quad(row, 0), quad(row, 4), quad(row, 8)])
    }

    /// What `y` holds for two bodies; zero where there is none.
    #[inline(always)]
    pub fn of_bodies(y: &[Six], bodies: [u32; 2]) -> Self {
        let (mut a, mut b) = ((Q::splat(0.0), Q::Pair::splat(0.0)), (Q::Pair::splat(0.0), Q::splat(0.0)));
        if let Some(y) = y.get(bodies[0] as usize) {
            a = (quad(y, 0), pair::<Q>(y, 4));
        }
        if let Some(y) = y.get(bodies[1] as usize) {
            b = (pair::<Q>(y, 0), quad(y, 2));
        }
        Self([a.0, Q::join(a.1, b.0), b.1])
    }

    /// Adds to what `y` holds for two bodies, where they are.
    #[inline(always)]
    pub fn add_to_bodies(self, y: &mut [Six], bodies: [u32; 2]) {
        let [a, middle, b] = self.0;
        if let Some(y) = y.get_mut(bodies[0] as usize) {
            let x = (quad::<Q>(y, 0) + a, pair::<Q>(y, 4) + middle.low());
            store_quad(y, 0, x.0);
            store_pair::<Q>(y, 4, x.1);
        }
        if let Some(y) = y.get_mut(bodies[1] as usize) {
            let x = (pair::<Q>(y, 0) + middle.high(), quad::<Q>(y, 2) + b);
            store_pair::<Q>(y, 0, x.0);
            store_quad(y, 2, x.1);
        }
    }

    /// Zero but for the sides that are told.
    #[inline(always)]
    fn on_sides(self, sides: [bool; 2]) -> Self {
        let nothing = Q::Pair::splat(0.0);
        let [mut a, middle, mut b] = self.0;
        let (mut low, mut high) = (middle.low(), middle.high());
        if !sides[0] {
            (a, low) = (Q::splat(0.0), nothing);
        }
        if !sides[1] {
            (high, b) = (nothing, Q::splat(0.0));
        }
        Self([a, Q::join(low, high), b])
    }

    /// `self + s row`.
    #[inline(always)]
    pub fn plus(self, s: f64, row: &ScaledRow) -> Self {
        let (s, row) = (Q::splat(s), Self::of_row(row));
        Self([self.0[0] + row.0[0] * s, self.0[1] + row.0[1] * s, self.0[2] + row.0[2] * s])
    }

    /// The products of all twelve numbers, to be summed.
    #[inline(always)]
    fn terms(self, with: Self) -> Q {
        (self.0[0] * with.0[0] + self.0[1] * with.0[1]) + self.0[2] * with.0[2]
    }
}

/// The most rows of a joint that has unknowns of its own.
pub(crate) const MOST_OWN: usize = 6;

/// A number for each row of a joint with up to six: at first four, and two more if it has more than three. What is beyond its rows are those
/// of the next joint in an array that goes on, to be overwritten when it is that one's turn.
#[derive(Clone, Copy)]
pub(crate) struct UpToSix<Q: Quad> {
    first: Q,
    last: Option<Q::Pair>,
}

impl<Q: Quad> UpToSix<Q> {
    /// Loads them; the array has six from the first on.
    #[inline(always)]
    pub fn load(from: &[f64], rows: &Range<usize>) -> Self {
        let last = if rows.len() > 3 { Some(pair::<Q>(from, rows.start + 4)) } else { None };
        Self { first: quad(from, rows.start), last }
    }

    /// Stores them, and what is beyond the joint's rows.
    #[inline(always)]
    pub fn store(self, to: &mut [f64], rows: &Range<usize>) {
        store_quad(to, rows.start, self.first);
        if let Some(last) = self.last {
            store_pair::<Q>(to, rows.start + 4, last);
        }
    }

    /// The products of a joint's rows with `y`.
    #[inline(always)]
    pub fn products(rows: &[ScaledRow], y: Twelve<Q>) -> Self {
        let fourth = if rows.len() > 3 { terms(rows, 3, y) } else { Q::splat(0.0) };
        let first = Q::sums([terms(rows, 0, y), terms(rows, 1, y), terms(rows, 2, y), fourth]);
        let last = if rows.len() > 3 {
            // In the order of `Quad::sums`.
            let nothing = Q::splat(0.0);
            Some(Q::sums([terms(rows, 4, y), terms(rows, 5, y), nothing, nothing]).low())
        } else {
            None
        };
        Self { first, last }
    }

    #[inline(always)]
    pub fn minus(self, b: Self) -> Self {
        let last = match (self.last, b.last) {
            (Some(last), Some(b)) => Some(last - b),
            (last, _) => last,
        };
        Self { first: self.first - b.first, last }
    }

    #[inline(always)]
    pub fn times(self, b: Self) -> Self {
        let last = match (self.last, b.last) {
            (Some(last), Some(b)) => Some(last * b),
            (last, _) => last,
        };
        Self { first: self.first * b.first, last }
    }

    #[inline(always)]
    pub fn negative(self) -> Self {
        self.times(Self { first: Q::splat(-1.0), last: Some(Q::Pair::splat(-1.0)) })
    }
}

/// The products of up to four rows with `y`.
#[inline(always)]
pub(crate) fn up_to_four<Q: Quad>(rows: &[ScaledRow], y: Twelve<Q>) -> [f64; 4] {
    let mut out = [0.0; 4];
    Q::sums([terms(rows, 0, y), terms(rows, 1, y), terms(rows, 2, y), terms(rows, 3, y)]).store(&mut out);
    out
}

/// The products of the numbers of a row, if there is one, with those of `y`, to be summed.
#[inline(always)]
fn terms<Q: Quad>(rows: &[ScaledRow], i: usize, y: Twelve<Q>) -> Q {
    match rows.get(i) {
        Some(row) => Twelve::of_row(row).terms(y),
        None => Q::splat(0.0),
    }
}

/// `J J^T` of a row.
#[inline(always)]
pub(crate) fn square<Q: Quad>(row: &ScaledRow) -> f64 {
    let row = Twelve::<Q>::of_row(row);
    row.terms(row).fold().sum()
}

/// `out += J^T x`.
#[inline(always)]
pub(crate) fn add_transposed<Q: Quad>(
    blocks: &[RowBlock],
    jacobian: &[ScaledRow],
    x: &[f64],
    out: &mut [Six],
) {
    for block in blocks {
        let range = block.range();
        let mut sum = Twelve::<Q>::zero();
        for (row, x) in jacobian[range.clone()].iter().zip(&x[range]) {
            sum = sum.plus(*x, row);
        }
        sum.add_to_bodies(out, block.bodies);
    }
}

/// `out = J y`.
#[inline(always)]
pub(crate) fn multiply<Q: Quad>(blocks: &[RowBlock], jacobian: &[ScaledRow], y: &[Six], out: &mut [f64]) {
    for block in blocks {
        let range = block.range();
        let y = Twelve::<Q>::of_bodies(y, block.bodies);
        for (rows, out) in jacobian[range.clone()].chunks(4).zip(out[range].chunks_mut(4)) {
            let products = up_to_four(rows, y);
            out.copy_from_slice(&products[..out.len()]);
        }
    }
}

/// `out = J y`, with the machine's instructions.
pub(crate) fn multiply_in_quads(blocks: &[RowBlock], jacobian: &[ScaledRow], y: &[Six], out: &mut [f64]) {
    struct Multiply<'a>(&'a [RowBlock], &'a [ScaledRow], &'a [Six], &'a mut [f64]);

    impl QuadKernel for Multiply<'_> {
        type Out = ();

        #[inline(always)]
        fn run<Q: Quad>(self) {
            multiply::<Q>(self.0, self.1, self.2, self.3);
        }
    }

    dispatch_quads(Multiply(blocks, jacobian, y, out));
}

/// Rows with their weights.
#[derive(Clone, Copy)]
pub(crate) struct Weighted<'a> {
    pub rows: &'a [ScaledRow],
    pub weight: &'a [f64],
}

impl Weighted<'_> {
    /// Those of a block.
    #[inline(always)]
    pub fn of(self, block: &RowBlock) -> Self {
        let range = block.range();
        Self { rows: &self.rows[range.clone()], weight: &self.weight[range] }
    }
}

/// Six numbers of a row.
#[derive(Clone, Copy)]
struct Half<Q: Quad>(Q, Q::Pair);

impl<Q: Quad> Half<Q> {
    #[inline(always)]
    fn of(row: &ScaledRow, side: usize) -> Self {
        let row = &row[side];
        Self(quad(row, 0), pair::<Q>(row, 4))
    }
}

/// `out -= A B^T` for the parts of rows `A` and `B` that act on one body, without those that have no weight; `out` has `H` rows.
#[inline(always)]
pub(crate) fn sub_product<Q: Quad, const H: usize>(
    out: &mut [f64],
    (a, s): (Weighted<'_>, usize),
    (b, t): (Weighted<'_>, usize),
) {
    let mut halves = [Half::<Q>(Q::splat(0.0), Q::Pair::splat(0.0)); 6];
    for (half, (row, weight)) in halves.iter_mut().zip(a.rows.iter().zip(a.weight)).take(H) {
        if *weight != 0.0 {
            *half = Half::of(row, s);
        }
    }
    for (out, (row, weight)) in out.chunks_exact_mut(stride(H)).zip(b.rows.iter().zip(b.weight)) {
        if *weight == 0.0 {
            continue;
        }
        let with = Half::<Q>::of(row, t);
        let [h0, h1, h2, h3, h4, h5] = halves;
        let fourth = if H == 6 { h3.0 * with.0 } else { Q::splat(0.0) };
        let products = Q::sums([h0.0 * with.0, h1.0 * with.0, h2.0 * with.0, fourth]);
        let ends =
            [Q::Pair::sums([h0.1 * with.1, h1.1 * with.1]), Q::Pair::sums([h2.1 * with.1, h3.1 * with.1])];
        store_quad(out, 0, quad::<Q>(out, 0) - (products + Q::join(ends[0], ends[1])));
        if H == 6 {
            let last = [(h4.0 * with.0).fold() + h4.1 * with.1, (h5.0 * with.0).fold() + h5.1 * with.1];
            store_pair::<Q>(out, 4, pair::<Q>(out, 4) - Q::Pair::sums(last));
        }
    }
}

/// `out -= A A^T` for the parts of rows `A` that act on the bodies told by `sides`, without those that have no weight: at least its lower
/// triangle; `out` has `H` rows.
#[inline(always)]
pub(crate) fn sub_square<Q: Quad, const H: usize>(out: &mut [f64], a: Weighted<'_>, sides: [bool; 2]) {
    let mut masked = [[[0.0; 6]; 2]; H];
    let rows = if a.weight.iter().all(|weight| *weight != 0.0) {
        a.rows
    } else {
        for (masked, (row, weight)) in masked.iter_mut().zip(a.rows.iter().zip(a.weight)) {
            if *weight != 0.0 {
                *masked = *row;
            }
        }
        &masked[..a.rows.len().min(H)]
    };
    for (c, (out, row)) in out.chunks_exact_mut(stride(H)).zip(rows).enumerate() {
        let with = Twelve::<Q>::of_row(row).on_sides(sides);
        if c < 4 {
            let fourth = if H == 6 { terms(rows, 3, with) } else { Q::splat(0.0) };
            let first = [terms(rows, 0, with), terms(rows, 1, with), terms(rows, 2, with), fourth];
            store_quad(out, 0, quad::<Q>(out, 0) - Q::sums(first));
        }
        if H == 6 {
            let last = [terms(rows, 4, with).fold(), terms(rows, 5, with).fold()];
            store_pair::<Q>(out, 4, pair::<Q>(out, 4) - Q::Pair::sums(last));
        }
    }
}

/// `out += sum_r weight_r u_r v_r^T`, the sixes of the rows' sides `u` and `v`. Whether any row has a weight.
#[inline(always)]
pub(crate) fn outer_products<Q: Quad>(rows: Weighted<'_>, u: usize, v: usize) -> Block {
    let mut out: [Column<Q, 6>; 6] = [Column::zero(); 6];
    for (row, weight) in rows.rows.iter().zip(rows.weight) {
        if *weight == 0.0 {
            continue;
        }
        let scaled = Column::<Q, 6>::load(&row[u]).times(*weight);
        for (out, v) in out.iter_mut().zip(&row[v]) {
            *out = out.plus(*v, scaled);
        }
    }
    let mut block = [0.0; 36];
    for (c, column) in out.into_iter().enumerate() {
        column.store(&mut block[6 * c..]);
    }
    block
}

/// The largest of some numbers, by size; not a number if one is not.
#[inline(always)]
pub(crate) fn largest(numbers: &[f64]) -> f64 {
    let (blocks, rest) = numbers.as_chunks::<4>();
    let (mut most, mut sum) = ([0.0f64; 4], [0.0f64; 4]);
    for block in blocks {
        for l in 0..4 {
            let size = block[l].abs();
            most[l] = if size > most[l] { size } else { most[l] };
            sum[l] += size;
        }
    }
    let (mut all, mut total) = (0.0f64, (sum[0] + sum[2]) + (sum[1] + sum[3]));
    for x in most.iter().chain(rest) {
        let size = x.abs();
        all = if size > all { size } else { all };
        total += size;
    }
    if total.is_nan() { total } else { all }
}
