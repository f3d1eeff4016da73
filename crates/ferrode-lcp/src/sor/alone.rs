//! [`super`] on the few rows of one body, such as a box on the ground: what is taken in of such a problem.
//!
//! Most islands of a world with things strewn over a ground are of this kind, so their rows come by a way of their own, without
//! the half that stands for a second body. Several of them are solved abreast: see [`loom`](super::loom).

use super::sweep::{InverseMass, PackedRow, Six};
use super::{InfTimesZero, SHUFFLE_PERIOD, SorBody, SorParams, shuffle};
use crate::error::{LcpError, check_len};
use ferrode_math::simd::Quad;

/// The most rows: more don't fit into the processor's first cache.
pub(super) const MOST_ROWS: usize = 24;
/// Room for these, and two that are always there. A power of two: a number of a row needs no look whether it is within.
pub(super) const PLACES: usize = 32;
/// The place of a row that is visited where a problem has no row, and that changes nothing.
pub(super) const EMPTY: u8 = PLACES as u8 - 1;
/// What scales the bounds of rows without a friction index: a force that is always 1.
const ALWAYS: u8 = EMPTY - 1;
const _: () = assert!(MOST_ROWS <= ALWAYS as usize);
/// The most iterations whose visits are written down beforehand.
const MOST_ITERATIONS: u32 = 1000;

/// A constraint on one body: the first body's half of a [`SorRow`](super::SorRow).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoneRow {
    /// The Jacobian: linear and angular part (world frame).
    pub j: [f64; 6],
    /// The right-hand side of `A lambda = rhs`: `c / h - J (V / h + M^-1 f)`.
    pub rhs: f64,
    /// Constraint force mixing divided by the step size.
    pub cfm: f64,
    /// The lower bound of the force. Not read with a friction index.
    pub lo: f64,
    /// The upper bound of the force; with a friction index the coefficient of friction.
    pub hi: f64,
    /// The row whose force scales the bounds, or a negative number for none.
    pub findex: i32,
}

/// The numbers of a row: two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Strand {
    /// The first four of `-d J`.
    pub j: [f64; 4],
    /// The last two of `-d J`, and of `B`.
    pub tails: [[f64; 2]; 2],
    /// The first four of `B`.
    pub b: [f64; 4],
    /// The right-hand side, the CFM and the bounds.
    pub scalars: [f64; 4],
}

impl Strand {
    /// A row whose visit changes no bit of a body: it adds −0 times 0. It is scaled by the force that is always 1, and wants 1 but has no
    /// room.
    const WITHOUT_EFFECT: Self =
        Self { j: [0.0; 4], tails: [[0.0; 2], [-0.0; 2]], b: [-0.0; 4], scalars: [1.0, 0.0, 0.0, 0.0] };

    #[inline(always)]
    pub fn tails(&self) -> &[f64; 4] {
        match self.tails.as_flattened().first_chunk() {
            Some(four) => four,
            None => &[0.0; 4],
        }
    }
}

/// The rows by their numbers.
#[derive(Clone, Debug)]
pub(super) struct Table {
    pub strands: [Strand; PLACES],
    /// Whose force scales the bounds.
    pub scale: [u8; PLACES],
}

impl Table {
    const EMPTY: Self = Self { strands: [Strand::WITHOUT_EFFECT; PLACES], scale: [ALWAYS; PLACES] };
}

/// The order of visits; behind the last one what changes nothing.
pub(super) type Order = [u8; PLACES];

/// Where there is no problem.
pub(super) static NO_TABLE: Table = Table::EMPTY;
pub(super) static NO_ORDER: Order = [EMPTY; PLACES];

/// A problem of one body and few rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Alone {
    /// None or one: most workspaces of a large world don't need it.
    table: Vec<Table>,
    /// The order of the visits, at first and after each shuffle.
    orders: Vec<Order>,
    pub iterations: u32,
    pub rows: usize,
}

/// Whether the method is the one to take.
pub(super) fn suits(rows: usize, iterations: u32) -> bool {
    (1..=MOST_ROWS).contains(&rows) && (1..=MOST_ITERATIONS).contains(&iterations)
}

/// Checks a friction index and the bounds of one of `rows` rows.
#[inline(always)]
pub(super) fn check_bounds(row: usize, findex: i32, lo: f64, hi: f64, rows: usize) -> Result<(), LcpError> {
    if findex >= 0 {
        if findex as usize >= rows {
            return Err(LcpError::FrictionIndex { row, findex });
        }
        if hi.is_nan() {
            return Err(LcpError::Bounds { row, lo, hi });
        }
    } else if lo.is_nan() || hi.is_nan() || lo > hi {
        return Err(LcpError::Bounds { row, lo, hi });
    }
    Ok(())
}

impl Alone {
    /// Packs `count` rows, which [`suits`] has agreed to.
    #[inline(always)]
    pub fn load<Q: Quad>(
        &mut self,
        body: &SorBody,
        count: usize,
        rows: impl Iterator<Item = LoneRow>,
        params: &SorParams,
    ) -> Result<(), LcpError> {
        let mass = InverseMass::new(body);
        let (order, table) = self.begin(count, params);
        let (mut free, mut bound) = (0, 0);
        let mut friction = NO_ORDER;
        // Room for both one after the other.
        let mut places = [EMPTY; 2 * PLACES];
        for (row, r) in rows.take(count).enumerate() {
            check_bounds(row, r.findex, r.lo, r.hi, count)?;
            let j = Six::<Q>::load(&r.j);
            let b = mass.times(&r.j, j);
            let diagonal = Six::dot_one(j, b, r.cfm);
            // An empty row without CFM has no effect on anything; its force stays 0.
            let d =
                if diagonal == 0.0 || diagonal.is_nan() { 0.0 } else { params.over_relaxation / diagonal };
            let (lo, hi, scale) = if r.findex >= 0 {
                friction[bound % PLACES] = row as u8;
                bound += 1;
                (-r.hi.abs(), r.hi.abs(), r.findex as u8)
            } else {
                places[free % PLACES] = row as u8;
                free += 1;
                (r.lo, r.hi, ALWAYS)
            };
            let strand = &mut table.strands[row % PLACES];
            let j = j.scaled(-d);
            j.store_parts(&mut strand.j, &mut strand.tails[0]);
            b.store_parts(&mut strand.b, &mut strand.tails[1]);
            strand.scalars = [
                r.rhs * d,
                r.cfm * d,
                bound_of(lo, params.inf_times_zero),
                bound_of(hi, params.inf_times_zero),
            ];
            table.scale[row % PLACES] = scale;
        }
        check_len("rows", free + bound, count)?;
        places[free % PLACES..][..PLACES].copy_from_slice(&friction);
        order.copy_from_slice(&places[..PLACES]);
        Ok(())
    }

    /// Takes rows over that are packed already.
    #[inline(always)]
    pub fn take_over(&mut self, packed: &[PackedRow], order: &[u32], params: &SorParams) {
        let (places, table) = self.begin(order.len(), params);
        for (to, from) in places.iter_mut().zip(order) {
            *to = *from as u8;
        }
        for (row, from) in packed.iter().enumerate().take(order.len()) {
            let [rhs, cfm, lo, hi] = from.scalars();
            let (lo, hi) = (bound_of(lo, params.inf_times_zero), bound_of(hi, params.inf_times_zero));
            table.strands[row % PLACES] = Strand {
                j: *from.head(0),
                tails: from.tails(),
                b: *from.head(1),
                scalars: [rhs, cfm, lo, hi],
            };
            table.scale[row % PLACES] =
                if from.scale as usize == order.len() { ALWAYS } else { from.scale as u8 };
        }
    }

    /// Room for a problem: its first order, and its rows.
    #[inline(always)]
    fn begin(&mut self, rows: usize, params: &SorParams) -> (&mut Order, &mut Table) {
        self.iterations = params.iterations;
        self.rows = rows.min(MOST_ROWS);
        if self.table.is_empty() {
            self.table.push(Table::EMPTY);
        }
        self.orders.clear();
        self.orders.push(NO_ORDER);
        (&mut self.orders[0], &mut self.table[0])
    }

    /// Draws the order of all visits.
    #[inline(always)]
    pub fn draw(&mut self, random: &mut impl FnMut(u32) -> u32) {
        let mut order = *self.order(0);
        for _ in 1..self.iterations.div_ceil(SHUFFLE_PERIOD) {
            shuffle(&mut order[..self.rows], random);
            self.orders.push(order);
        }
    }

    /// The order of the visits after so many shuffles.
    #[inline(always)]
    pub fn order(&self, shuffles: usize) -> &Order {
        match self.orders.get(shuffles) {
            Some(order) => order,
            None => &NO_ORDER,
        }
    }

    #[inline(always)]
    pub fn table(&self) -> &Table {
        match self.table.first() {
            Some(table) => table,
            None => &NO_TABLE,
        }
    }

    /// What problems that are visited at once have in common: they must have as many iterations, and should have as many rows.
    #[inline(always)]
    pub fn size(&self) -> (u32, usize) {
        (self.iterations, self.rows)
    }
}

/// A bound such that its product with a force that is zero means what it is to mean: infinity times zero is no number, which bounds
/// nothing; any finite number times zero is zero.
#[inline(always)]
fn bound_of(bound: f64, inf_times_zero: InfTimesZero) -> f64 {
    match inf_times_zero {
        InfTimesZero::Unbounded => bound,
        InfTimesZero::Zero => bound.clamp(f64::MIN, f64::MAX),
    }
}
