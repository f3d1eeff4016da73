//! The visits of [`super`] on problems of one body: four abreast, one in each lane.
//!
//! A visit of such a row is a chain of operations that leaves most of the processor idle, and its bookkeeping takes as many
//! instructions as its numbers. So the rows of four bodies are woven together in the order of their visits, anew after each
//! shuffle, and then visited with no thought of an order, by the same operations as one by one; and two such looms run side by side. A problem
//! with fewer rows than its neighbours has empty ones. For that the order of all visits is drawn when a problem is taken in, which is when its random
//! numbers are due.

use super::alone::{Alone, MOST_ROWS, NO_ORDER, NO_TABLE, Order, PLACES, Strand, Table};
use super::{SHUFFLE_PERIOD, SorAcceleration};
use ferrode_math::simd::Quad;

/// Problems in a loom.
const ABREAST: usize = 4;
/// Problems that are visited at once.
pub(super) const AT_ONCE: usize = 2 * ABREAST;
/// Where in a loom the force is that is always 1.
const ONE: usize = MOST_ROWS;

/// The forces of a problem's rows. There is more room than needed, so that no index needs a look whether it is within.
pub(super) type Forces = [f64; PLACES];

/// A problem and its answer.
pub(super) struct Problem<'a> {
    pub alone: &'a Alone,
    pub forces: &'a mut Forces,
    pub acceleration: &'a mut SorAcceleration,
}

/// A number of each of four problems.
type Four = [f64; ABREAST];

/// A row of each of four problems.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
struct Woven {
    /// `-d J` and `B`.
    j: [Four; 6],
    b: [Four; 6],
    rhs: Four,
    cfm: Four,
    lo: Four,
    hi: Four,
}

/// Four problems woven together.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Loom {
    rows: [Woven; MOST_ROWS],
    /// Whose force scales the bounds, as a place among the forces.
    scale: [[u8; ABREAST]; MOST_ROWS],
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
        Self {
            rows: [Woven::default(); MOST_ROWS],
            scale: [[0; ABREAST]; MOST_ROWS],
            count: 0,
            acceleration: [[0.0; ABREAST]; 6],
            force,
        }
    }
}

/// Makes all visits of up to eight problems of as many iterations, and writes the answers down.
#[inline(always)]
pub(super) fn visit<Q: Quad>(problems: &mut [Option<Problem<'_>>; AT_ONCE], looms: &mut Vec<Loom>) {
    if looms.len() < 2 {
        looms.resize(2, Loom::default());
    }
    let [first, second, ..] = &mut looms[..] else { return };
    let mut iterations = 0;
    for problem in problems.iter().flatten() {
        iterations = problem.alone.iterations.max(iterations);
    }
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
    let (of_first, of_second) = (first.count.min(MOST_ROWS), second.count.min(MOST_ROWS));
    let both = of_first.min(of_second);
    for k in 0..both {
        a = visit_row(&first.rows[k], first.scale[k], &mut first.force, k, a);
        b = visit_row(&second.rows[k], second.scale[k], &mut second.force, k, b);
    }
    for k in both..of_first {
        a = visit_row(&first.rows[k], first.scale[k], &mut first.force, k, a);
    }
    for k in both..of_second {
        b = visit_row(&second.rows[k], second.scale[k], &mut second.force, k, b);
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
fn visit_row<Q: Quad>(
    row: &Woven,
    [p, q, r, s]: [u8; ABREAST],
    force: &mut [f64; 256],
    k: usize,
    a: [Q; 6],
) -> [Q; 6] {
    let Woven { j, b, rhs, cfm, lo, hi } = row;
    let (p, q, r, s) =
        (force[usize::from(p)], force[usize::from(q)], force[usize::from(r)], force[usize::from(s)]);
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

/// What is woven of a problem, or of none.
struct Warp<'a> {
    table: &'a Table,
    order: &'a Order,
    forces: &'a Forces,
}

impl<'a> Warp<'a> {
    #[inline(always)]
    fn new(problem: &'a Option<Problem<'_>>, phase: usize) -> Self {
        match problem {
            Some(Problem { alone, forces, .. }) => {
                Self { table: alone.table(), order: alone.order(phase), forces }
            }
            None => Self { table: &NO_TABLE, order: &NO_ORDER, forces: &[0.0; PLACES] },
        }
    }

    /// The places of the rows' forces in lane `lane` of a loom.
    #[inline(always)]
    fn places(&self, lane: usize, count: usize) -> [u8; PLACES] {
        let mut places = [(ONE * ABREAST + lane) as u8; PLACES];
        for (k, row) in self.order[..count].iter().enumerate() {
            places[usize::from(*row) % PLACES] = (k * ABREAST + lane) as u8;
        }
        places
    }
}

impl Loom {
    #[inline(always)]
    fn begin(&mut self, problems: &[Option<Problem<'_>>]) {
        self.count = 0;
        for problem in problems.iter().flatten() {
            self.count = problem.alone.rows.min(MOST_ROWS).max(self.count);
        }
        self.acceleration = [[0.0; ABREAST]; 6];
    }

    /// Puts the rows in the order of their visits.
    #[inline(always)]
    fn weave<Q: Quad>(&mut self, problems: &[Option<Problem<'_>>], phase: usize) {
        let [p, q, r, s] = problems else { return };
        let (p, q, r, s) =
            (Warp::new(p, phase), Warp::new(q, phase), Warp::new(r, phase), Warp::new(s, phase));
        let count = self.count.min(MOST_ROWS);
        let at = [p.places(0, count), q.places(1, count), r.places(2, count), s.places(3, count)];
        for k in 0..count {
            let (i, j) = (usize::from(p.order[k]) % PLACES, usize::from(q.order[k]) % PLACES);
            let (m, n) = (usize::from(r.order[k]) % PLACES, usize::from(s.order[k]) % PLACES);
            self.force.as_chunks_mut().0[k] = [p.forces[i], q.forces[j], r.forces[m], s.forces[n]];
            let scale = [p.table.scale[i], q.table.scale[j], r.table.scale[m], s.table.scale[n]];
            self.scale[k] = [
                at[0][usize::from(scale[0]) % PLACES],
                at[1][usize::from(scale[1]) % PLACES],
                at[2][usize::from(scale[2]) % PLACES],
                at[3][usize::from(scale[3]) % PLACES],
            ];
            let rows = [&p.table.strands[i], &q.table.strands[j], &r.table.strands[m], &s.table.strands[n]];
            self.rows[k].set::<Q>(rows);
        }
    }

    /// Puts the forces in the rows' own order.
    #[inline(always)]
    fn unravel(&self, problems: &mut [Option<Problem<'_>>], phase: usize) {
        for (l, problem) in problems.iter_mut().enumerate() {
            let Some(Problem { alone, forces, .. }) = problem else { continue };
            let order = alone.order(phase);
            for k in 0..alone.rows.min(MOST_ROWS) {
                forces[usize::from(order[k]) % PLACES] = self.force[k * ABREAST + l % ABREAST];
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

impl Woven {
    #[inline(always)]
    fn set<Q: Quad>(&mut self, [p, q, r, s]: [&Strand; ABREAST]) {
        let [x, y, z, u] = columns::<Q>(&p.j, &q.j, &r.j, &s.j);
        let [v, w, bv, bw] = columns::<Q>(p.tails(), q.tails(), r.tails(), s.tails());
        store([x, y, z, u, v, w], &mut self.j);
        let [x, y, z, u] = columns::<Q>(&p.b, &q.b, &r.b, &s.b);
        store([x, y, z, u, bv, bw], &mut self.b);
        let [rhs, cfm, lo, hi] = columns::<Q>(&p.scalars, &q.scalars, &r.scalars, &s.scalars);
        rhs.store(&mut self.rhs);
        cfm.store(&mut self.cfm);
        lo.store(&mut self.lo);
        hi.store(&mut self.hi);
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
