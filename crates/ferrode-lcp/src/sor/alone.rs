//! [`super`] on the few rows of one body, such as a box on the ground: four problems abreast, one in each lane.
//!
//! A visit of such a row is a chain of operations that leaves most of the processor idle, and its bookkeeping takes as many
//! instructions as its numbers. So the rows of four bodies are woven together in the order of their visits, anew after each
//! shuffle, and then visited with no thought of an order, by the same operations as one by one; and two such looms run side by side. A problem
//! with fewer rows than its neighbours has empty ones. For that the order of all visits is drawn when a problem is taken in, which is when its random
//! numbers are due.

use super::sweep::PackedRow;
use super::{InfTimesZero, SHUFFLE_PERIOD, SorAcceleration, SorParams, shuffle};
use ferrode_math::simd::Quad;

/// The most rows: more don't fit into the processor's first cache.
const MOST_ROWS: usize = 24;
/// Room for these and the force that is always 1.
const PLACES: usize = 32;
const _: () = assert!(MOST_ROWS < PLACES);
/// The most iterations whose visits are written down beforehand.
const MOST_ITERATIONS: u32 = 1000;
/// Problems in a loom.
const ABREAST: usize = 4;
/// Problems that are visited at once.
pub(super) const AT_ONCE: usize = 2 * ABREAST;
/// Where in a loom the force is that is always 1.
const ONE: usize = MOST_ROWS;

/// A problem of one body and few rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Alone {
    /// The order of the visits, at first and after each shuffle.
    orders: Vec<[u8; MOST_ROWS]>,
    iterations: u32,
    rows: usize,
    /// What visits read and write: none, or two, for most problems are visited in another's.
    pub looms: Vec<Loom>,
}

/// A problem and its numbers.
pub(super) struct Problem<'a> {
    pub alone: &'a Alone,
    pub packed: &'a [PackedRow],
    /// The rows' forces.
    pub lambda: &'a mut [f64],
    pub acceleration: &'a mut SorAcceleration,
}

/// A number of each of four problems.
type Four = [f64; ABREAST];

/// A row of each of four problems.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
struct Woven {
    /// `-d J` and `B`.
    j: [Four; 6],
    b: [Four; 6],
    rhs: Four,
    cfm: Four,
    lo: Four,
    hi: Four,
    /// Whose force scales the bounds, as a place among the loom's forces.
    scale: [u8; ABREAST],
}

/// Four problems woven together.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Loom {
    rows: [Woven; MOST_ROWS],
    /// Rows of the largest problem.
    count: usize,
    acceleration: [Four; 6],
    /// In fours, in the order of the visits. There is more room than needed, so that no index needs a look whether it is within.
    force: [f64; 256],
}

impl Default for Loom {
    fn default() -> Self {
        let mut force = [0.0; 256];
        force[ONE * ABREAST..].fill(1.0);
        Self { rows: [Woven::default(); MOST_ROWS], count: 0, acceleration: [[0.0; ABREAST]; 6], force }
    }
}

/// Whether the method is the one to take.
pub(super) fn suits(rows: usize, iterations: u32) -> bool {
    (1..=MOST_ROWS).contains(&rows) && (1..=MOST_ITERATIONS).contains(&iterations)
}

impl Alone {
    /// Takes a problem in and draws the order of its visits.
    #[inline(always)]
    pub fn begin(
        &mut self,
        packed: &mut [PackedRow],
        order: &[u32],
        params: &SorParams,
        random: &mut impl FnMut(u32) -> u32,
    ) {
        self.iterations = params.iterations;
        self.rows = order.len().min(MOST_ROWS);
        if params.inf_times_zero == InfTimesZero::Zero {
            // Infinity times zero is no number, which bounds nothing; any finite number times zero is zero.
            for row in packed {
                (row.lo, row.hi) = (row.lo.clamp(f64::MIN, f64::MAX), row.hi.clamp(f64::MIN, f64::MAX));
            }
        }
        let mut visits = [0; MOST_ROWS];
        for (visit, row) in visits.iter_mut().zip(order) {
            *visit = *row as u8;
        }
        self.orders.clear();
        self.orders.push(visits);
        for _ in 1..params.iterations.div_ceil(SHUFFLE_PERIOD) {
            shuffle(&mut visits[..self.rows], random);
            self.orders.push(visits);
        }
    }

    /// What problems that are visited at once have in common: they must have as many iterations, and should have as many rows.
    #[inline(always)]
    pub fn size(&self) -> (u32, usize) {
        (self.iterations, self.rows)
    }
}

/// Makes all visits of up to eight problems of as many iterations, and writes the answers down.
#[inline(always)]
pub(super) fn visit<Q: Quad>(problems: &mut [Option<Problem<'_>>; AT_ONCE], looms: &mut Vec<Loom>) {
    if looms.len() < 2 {
        looms.resize(2, Loom::default());
    }
    let [first, second, ..] = &mut looms[..] else { return };
    let iterations = problems.iter().flatten().map(|problem| problem.alone.iterations).max().unwrap_or(0);
    let (left, right) = problems.split_at_mut(ABREAST);
    first.begin(left);
    second.begin(right);
    let mut done = 0;
    for phase in 0..iterations.div_ceil(SHUFFLE_PERIOD) as usize {
        first.weave::<Q>(left, phase);
        second.weave::<Q>(right, phase);
        let now = (iterations - done).min(SHUFFLE_PERIOD);
        for _ in 0..now {
            sweep::<Q>(first, second);
        }
        done += now;
        first.unravel(left, phase);
        second.unravel(right, phase);
    }
    first.finish(left);
    second.finish(right);
}

/// Visits each row of two looms once.
#[inline(always)]
fn sweep<Q: Quad>(first: &mut Loom, second: &mut Loom) {
    let (mut a, mut b) = (load::<Q>(&first.acceleration), load::<Q>(&second.acceleration));
    let both = first.count.min(second.count).min(MOST_ROWS);
    for k in 0..both {
        a = visit_row(&first.rows[k], &mut first.force, k, a);
        b = visit_row(&second.rows[k], &mut second.force, k, b);
    }
    for (k, row) in first.rows.iter().enumerate().take(first.count).skip(both) {
        a = visit_row(row, &mut first.force, k, a);
    }
    for (k, row) in second.rows.iter().enumerate().take(second.count).skip(both) {
        b = visit_row(row, &mut second.force, k, b);
    }
    for n in 0..6 {
        a[n].store(&mut first.acceleration[n]);
        b[n].store(&mut second.acceleration[n]);
    }
}

#[inline(always)]
fn load<Q: Quad>(a: &[Four; 6]) -> [Q; 6] {
    [Q::load(&a[0]), Q::load(&a[1]), Q::load(&a[2]), Q::load(&a[3]), Q::load(&a[4]), Q::load(&a[5])]
}

/// Visits a row of each of four problems.
#[inline(always)]
fn visit_row<Q: Quad>(row: &Woven, force: &mut [f64; 256], k: usize, a: [Q; 6]) -> [Q; 6] {
    let Woven { j, b, rhs, cfm, lo, hi, scale: [p, q, r, s] } = row;
    let (p, q, r, s) =
        (force[usize::from(*p)], force[usize::from(*q)], force[usize::from(*r)], force[usize::from(*s)]);
    let size = Q::load(&[p, q, r, s]).abs();
    let (lo, hi) = (Q::load(lo) * size, Q::load(hi) * size);
    let (forces, _) = force.as_chunks_mut();
    let old = Q::load(&forces[k]);
    let j = load::<Q>(j);
    let head = (j[0] * a[0] + j[1] * a[1]) + (j[2] * a[2] + j[3] * a[3]);
    let tail = (j[4] * a[4] + j[5] * a[5]) + (Q::load(rhs) - Q::load(cfm) * old);
    let wanted = head + tail;
    // A bound that is not a number is none.
    hi.lesser(lo.greater(old + wanted)).store(&mut forces[k]);
    let delta = (hi - old).lesser((lo - old).greater(wanted));
    let b = load::<Q>(b);
    [
        a[0] + b[0] * delta,
        a[1] + b[1] * delta,
        a[2] + b[2] * delta,
        a[3] + b[3] * delta,
        a[4] + b[4] * delta,
        a[5] + b[5] * delta,
    ]
}

impl Loom {
    #[inline(always)]
    fn begin(&mut self, problems: &[Option<Problem<'_>>]) {
        self.count = problems.iter().flatten().map(|problem| problem.alone.rows).max().unwrap_or(0);
        self.acceleration = [[0.0; ABREAST]; 6];
    }

    /// Puts the rows in the order of their visits.
    #[inline(always)]
    fn weave<Q: Quad>(&mut self, problems: &[Option<Problem<'_>>], phase: usize) {
        let mut ranks = [[ONE as u8; PLACES]; ABREAST];
        for (problem, rank) in problems.iter().zip(&mut ranks) {
            let Some(Problem { alone, .. }) = problem else { continue };
            for (k, row) in alone.orders[phase][..alone.rows].iter().enumerate() {
                rank[usize::from(*row) % PLACES] = k as u8;
            }
        }
        let empty = PackedRow::without_effect();
        let (forces, _) = self.force.as_chunks_mut();
        for (k, (woven, force)) in self.rows[..self.count].iter_mut().zip(forces).enumerate() {
            let mut rows = [&empty; ABREAST];
            *force = [0.0; ABREAST];
            woven.scale = [(ONE * ABREAST) as u8; ABREAST];
            for (l, problem) in problems.iter().enumerate().take(ABREAST) {
                if let Some(Problem { alone, packed, lambda, .. }) = problem
                    && k < alone.rows
                {
                    let row = usize::from(alone.orders[phase][k]);
                    rows[l] = &packed[row];
                    force[l] = lambda[row];
                    woven.scale[l] = ranks[l][rows[l].scale as usize % PLACES] * ABREAST as u8 + l as u8;
                }
            }
            let [p, q, r, s] = rows;
            let [x, y, z, u] = columns::<Q>(p.head(0), q.head(0), r.head(0), s.head(0));
            let [v, w, bv, bw] = columns::<Q>(&p.tails(), &q.tails(), &r.tails(), &s.tails());
            store([x, y, z, u, v, w], &mut woven.j);
            let [x, y, z, u] = columns::<Q>(p.head(1), q.head(1), r.head(1), s.head(1));
            store([x, y, z, u, bv, bw], &mut woven.b);
            let [rhs, cfm, lo, hi] = columns::<Q>(&p.scalars(), &q.scalars(), &r.scalars(), &s.scalars());
            rhs.store(&mut woven.rhs);
            cfm.store(&mut woven.cfm);
            lo.store(&mut woven.lo);
            hi.store(&mut woven.hi);
        }
    }

    /// Puts the forces in the rows' own order.
    #[inline(always)]
    fn unravel(&self, problems: &mut [Option<Problem<'_>>], phase: usize) {
        for (l, problem) in problems.iter_mut().enumerate() {
            let Some(Problem { alone, lambda, .. }) = problem else { continue };
            for (k, row) in alone.orders[phase][..alone.rows].iter().enumerate() {
                lambda[usize::from(*row)] = self.force[k * ABREAST + l];
            }
        }
    }

    #[inline(always)]
    fn finish(&self, problems: &mut [Option<Problem<'_>>]) {
        for (l, problem) in problems.iter_mut().enumerate() {
            let Some(Problem { acceleration, .. }) = problem else { continue };
            for n in 0..6 {
                acceleration.0[n] = self.acceleration[n][l % ABREAST];
            }
        }
    }
}

#[inline(always)]
fn columns<Q: Quad>(p: &Four, q: &Four, r: &Four, s: &Four) -> [Q; 4] {
    Q::columns([Q::load(p), Q::load(q), Q::load(r), Q::load(s)])
}

#[inline(always)]
fn store<Q: Quad>(six: [Q; 6], to: &mut [Four; 6]) {
    for n in 0..6 {
        six[n].store(&mut to[n]);
    }
}
