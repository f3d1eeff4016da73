//! [`super`] on a few rows: in the space of forces.
//!
//! The rows of a box on the ground all act on one body, so each visit waits for the one before, and that takes as long as from a body's
//! acceleration to its next one. With few rows the matrix is small enough to be formed: with `T_ji = -d_i (J_i B_j + [i = j] C_i)` and the
//! changes `r_i = d_i (rhs_i - J_i a - C_i lambda_i)` that all rows want, a visit of row j is
//!
//! ```text
//!    delta = clamp( r_j,  lo_j - lambda_j,  hi_j - lambda_j )        r += T_j delta
//! ```
//!
//! and what the next row k wants, `r_k + T_jk delta`, is found at once, one product, one sum and the bounds after this one. The accelerations are
//! added up at the end. The answer is that of visiting the bodies, to rounding.
//!
//! **Side by side.** Even so a visit is a chain of operations that leaves most of the processor idle. Two problems don't wait for each other, so
//! their visits are made by turns, in one loop; when one of them is done, the next takes its place. For that the order of all visits is
//! drawn when a problem is taken in, which is when its random numbers are due.

use super::sweep::{PackedRow, Six, bounds, clamp};
use super::{InfTimesZero, SHUFFLE_PERIOD, SorAcceleration, SorParams, shuffle};
use ferrode_math::simd::Quad;

/// The most rows: a visit takes time in proportion to them.
const MOST_ROWS: usize = 24;
/// Room for these and the force that is always 1.
const PLACES: usize = 32;
/// The most blocks of four columns.
const WIDEST: usize = 6;
const _: () = assert!(MOST_ROWS < PLACES);
const _: () = assert!(MOST_ROWS.div_ceil(4) == WIDEST, "Small::visit has a case for each width");
/// The most iterations whose visits are written down beforehand.
const MOST_ITERATIONS: u32 = 1000;

/// A problem of few rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Small {
    /// `-d J` by columns: six for each body, each with all rows' entries.
    columns: Vec<[f64; 4]>,
    /// None or one: most worlds don't need it.
    tables: Vec<Tables>,
    /// Blocks of four columns.
    width: usize,
    /// The rows in the order of all visits, and one more, whose change nobody asks for.
    visits: Vec<u8>,
    /// Visits to make.
    count: usize,
    /// Visits made.
    made: usize,
}

/// What visits read and write. There is more room than needed, so that no index needs a look whether it is within.
#[derive(Clone, Debug, Default)]
#[repr(C, align(64))]
struct Tables {
    /// `T`, row by row.
    matrix: [Blocks; PLACES],
    /// The changes that the rows want.
    wanted: Blocks,
    places: [Place; PLACES],
}

/// A number for each row.
type Blocks = [[f64; 4]; PLACES / 4];

/// A row's force, its bounds, and whose force scales these.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
struct Place {
    lo: f64,
    hi: f64,
    force: f64,
    scale: u32,
}

/// Whether the method is the faster one. With many bodies, few rows wait for each other, and there are more products to form.
pub(super) fn suits(rows: usize, bodies: usize, iterations: u32) -> bool {
    (1..=MOST_ROWS).contains(&rows) && rows >= 3 * bodies && (1..=MOST_ITERATIONS).contains(&iterations)
}

impl Small {
    /// Takes a problem in and draws the order of its visits.
    #[inline(always)]
    pub fn begin<Q: Quad>(
        &mut self,
        packed: &[PackedRow],
        order: &[u32],
        bodies: usize,
        params: &SorParams,
        random: &mut impl FnMut(u32) -> u32,
    ) {
        self.load::<Q>(packed, bodies, params.inf_times_zero);
        let rows = packed.len();
        let mut places = [0; PLACES];
        for (place, row) in places.iter_mut().zip(order) {
            *place = *row as u8;
        }
        self.count = params.iterations as usize * rows;
        self.made = 0;
        self.visits.resize(self.count + PLACES, 0);
        for done in 0..params.iterations {
            if done > 0 && done % SHUFFLE_PERIOD == 0 {
                shuffle(&mut places[..rows], random);
            }
            // The whole array: the next iteration's comes over what is too much.
            self.visits[done as usize * rows..][..PLACES].copy_from_slice(&places);
        }
    }

    /// Visits that are left.
    #[inline(always)]
    pub fn left(&self) -> usize {
        self.count - self.made
    }

    /// The forces, and the accelerations that they cause, added to what is there.
    #[inline(always)]
    pub fn finish<Q: Quad>(
        &self,
        packed: &[PackedRow],
        lambda: &mut [f64],
        acceleration: &mut [SorAcceleration],
    ) {
        let Some(Tables { places, .. }) = self.tables.first() else { return };
        for ((row, Place { force, .. }), lambda) in packed.iter().zip(places).zip(lambda) {
            *lambda = *force;
            for (body, b) in row.body.into_iter().zip([row.vector::<Q>(1), row.vector(3)]) {
                if let Some(SorAcceleration(a)) = acceleration.get_mut(body as usize) {
                    Six::load(a).plus(b.scaled(*force)).store(a);
                }
            }
        }
    }

    /// Forms the matrix.
    #[inline(always)]
    fn load<Q: Quad>(&mut self, packed: &[PackedRow], bodies: usize, inf_times_zero: InfTimesZero) {
        let width = packed.len().div_ceil(4).min(WIDEST);
        self.width = width;
        if self.tables.is_empty() {
            self.tables.push(Tables::default());
        }
        let Self { columns, tables, .. } = self;
        let Some(Tables { matrix, wanted, places }) = tables.first_mut() else { return };
        columns.clear();
        columns.resize(bodies * 6 * width, [0.0; 4]);
        *wanted = Blocks::default();
        places[packed.len() % PLACES] = Place { force: 1.0, ..Place::default() };
        // Infinity times zero is no number, which bounds nothing; any finite number times zero is zero.
        let end = |bound: f64| match inf_times_zero {
            InfTimesZero::Unbounded => bound,
            InfTimesZero::Zero => bound.clamp(f64::MIN, f64::MAX),
        };
        let numbers = columns.as_flattened_mut();
        for (i, row) in packed.iter().enumerate() {
            wanted.as_flattened_mut()[i] = row.rhs;
            places[i] = Place { lo: end(row.lo), hi: end(row.hi), force: 0.0, scale: row.scale };
            for (side, body) in row.body.into_iter().enumerate() {
                if (body as usize) < bodies {
                    let start = body as usize * 24 * width + i;
                    for (n, j) in row.numbers(2 * side).into_iter().enumerate() {
                        numbers[start + 4 * n * width] = j;
                    }
                }
            }
        }
        for (i, (out, row)) in matrix.iter_mut().zip(packed).enumerate() {
            out[..WIDEST].fill([0.0; 4]);
            for (side, body) in row.body.into_iter().enumerate() {
                if (body as usize) < bodies {
                    let columns = &columns[body as usize * 6 * width..][..6 * width];
                    add_products::<Q>(&mut out[..width], columns, row.numbers(2 * side + 1));
                }
            }
            out.as_flattened_mut()[i] -= row.cfm;
        }
    }

    /// Makes visits of some problems, as many of each as are left of the one with the fewest.
    #[inline(always)]
    pub fn visit<Q: Quad, const N: usize>(problems: [&mut Self; N]) {
        let (mut width, mut count) = (1, usize::MAX);
        for problem in &problems {
            (width, count) = (problem.width.max(width), problem.left().min(count));
        }
        match width {
            1 => Self::visit_blocks::<Q, N, 1>(problems, count),
            2 => Self::visit_blocks::<Q, N, 2>(problems, count),
            3 => Self::visit_blocks::<Q, N, 3>(problems, count),
            4 => Self::visit_blocks::<Q, N, 4>(problems, count),
            5 => Self::visit_blocks::<Q, N, 5>(problems, count),
            _ => Self::visit_blocks::<Q, N, WIDEST>(problems, count),
        }
    }

    /// Makes `count` visits of each problem; their matrices have `W` blocks of columns, or fewer and then zeros.
    #[inline(always)]
    fn visit_blocks<Q: Quad, const N: usize, const W: usize>(problems: [&mut Self; N], count: usize) {
        let mut lanes = problems.map(|problem| problem.lane(count));
        for visit in 0..count {
            for lane in &mut lanes {
                lane.visit::<Q, W>(lane.next[..count][visit]);
            }
        }
    }

    /// The next visits; marks them as made.
    #[inline(always)]
    fn lane(&mut self, count: usize) -> Lane<'_> {
        let row = usize::from(self.visits[self.made]) % PLACES;
        let next = &self.visits[self.made + 1..][..count];
        self.made += count;
        let tables = &mut self.tables[0];
        Lane { row, change: tables.wanted.as_flattened()[row], next, tables }
    }
}

/// A problem whose visits are being made.
struct Lane<'a> {
    tables: &'a mut Tables,
    /// The rows of the visits after this one.
    next: &'a [u8],
    /// The row to visit, and the change that it wants.
    row: usize,
    change: f64,
}

impl Lane<'_> {
    #[inline(always)]
    fn visit<Q: Quad, const W: usize>(&mut self, next: u8) {
        let Tables { matrix, wanted, places } = &mut *self.tables;
        let row = self.row % PLACES;
        let Place { lo, hi, force: old, scale } = places[row];
        let (lo, hi) = bounds::<false>(lo, hi, places[scale as usize % PLACES].force);
        let delta = clamp(self.change, lo - old, hi - old);
        places[row].force = clamp(old + self.change, lo, hi);
        let column = &matrix[row];
        let next = usize::from(next) % PLACES;
        self.row = next;
        self.change = wanted.as_flattened()[next] + column.as_flattened()[next] * delta;
        let delta = Q::splat(delta);
        for k in 0..W {
            (Q::load(&wanted[k]) + Q::load(&column[k]) * delta).store(&mut wanted[k]);
        }
    }
}

/// Adds a body's columns to a row of the matrix, each times a number of `b`.
#[inline(always)]
fn add_products<Q: Quad>(out: &mut [[f64; 4]], columns: &[[f64; 4]], b: [f64; 6]) {
    let width = out.len();
    let (c0, c1, c2) = (&columns[..width], &columns[width..][..width], &columns[2 * width..][..width]);
    let c3 = &columns[3 * width..][..width];
    let (c4, c5) = (&columns[4 * width..][..width], &columns[5 * width..][..width]);
    let (b0, b1, b2) = (Q::splat(b[0]), Q::splat(b[1]), Q::splat(b[2]));
    let (b3, b4, b5) = (Q::splat(b[3]), Q::splat(b[4]), Q::splat(b[5]));
    for l in 0..width {
        let linear = Q::load(&c0[l]) * b0 + Q::load(&c1[l]) * b1 + Q::load(&c2[l]) * b2;
        let angular = Q::load(&c3[l]) * b3 + Q::load(&c4[l]) * b4 + Q::load(&c5[l]) * b5;
        (Q::load(&out[l]) + (linear + angular)).store(&mut out[l]);
    }
}
