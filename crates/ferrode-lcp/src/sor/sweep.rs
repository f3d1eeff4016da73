//! The inner loop of [`super`]: one visit of a row, and of several rows on the same bodies.
//!
//! **Layout.** `J_i` is scaled by `-d_i` beforehand and stored with `B_i`, the bounds and the bodies' numbers in one record of four
//! cache lines. The six numbers that a row or a body has are four and two, so that each operation on them is one of four lanes and one of
//! two. Nothing is asked that the order of the rows makes hard to foretell: a row without a second body reads and writes one that stands for
//! none; bounds are multiplied by `|lambda_f|` always, and rows without a friction index point to a force that is always 1. Sums have
//! a fixed order.
//!
//! **Latency.** From a body's acceleration to its next one is a chain of dependent operations, and before the first shuffle
//! the rows of a joint or of a pair of touching bodies follow each other. All that can be is kept off that chain: there the change is
//! clamped, not the force; and in a stretch of rows on the same bodies all products `J_i a` are formed at once, with the `a` from before the
//! stretch, and corrected for the changes inside it by the couplings `J_k B_l`, which are known beforehand. The
//! result is that of visiting the rows one by one, to rounding.

use super::{SorAcceleration, SorBody};
use core::marker::PhantomData;
use ferrode_math::simd::{Pair, Quad};

/// Six numbers, as four and two that are computed with at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Six<Q: Quad> {
    head: Q,
    tail: Q::Pair,
}

impl<Q: Quad> Six<Q> {
    /// The first six of some numbers; zeros if there are not so many.
    #[inline(always)]
    pub fn load(a: &[f64]) -> Self {
        let head = a.first_chunk().unwrap_or(&[0.0; 4]);
        let tail = a.get(4..).and_then(<[f64]>::first_chunk).unwrap_or(&[0.0; 2]);
        Self { head: Q::load(head), tail: Q::Pair::load(tail) }
    }

    /// Writes them to the first six places, if there are so many.
    #[inline(always)]
    pub fn store(self, to: &mut [f64]) {
        if let Some((head, rest)) = to.split_first_chunk_mut()
            && let Some(tail) = rest.first_chunk_mut()
        {
            self.head.store(head);
            self.tail.store(tail);
        }
    }

    #[inline(always)]
    pub fn scaled(self, s: f64) -> Self {
        Self { head: self.head * Q::splat(s), tail: self.tail * Q::Pair::splat(s) }
    }

    #[inline(always)]
    pub fn plus(self, b: Self) -> Self {
        Self { head: self.head + b.head, tail: self.tail + b.tail }
    }

    /// The dot product of two pairs of six, plus `more`.
    #[inline(always)]
    pub fn dot(j: [Self; 2], a: [Self; 2], more: f64) -> f64 {
        let head = j[0].head * a[0].head + j[1].head * a[1].head;
        let tail = j[0].tail * a[0].tail + j[1].tail * a[1].tail;
        (head.fold() + tail.add_first(more)).sum()
    }

    /// The dot product of two, plus `more`.
    #[inline(always)]
    pub fn dot_one(j: Self, a: Self, more: f64) -> f64 {
        ((j.head * a.head).fold() + (j.tail * a.tail).add_first(more)).sum()
    }

    /// Writes the first four to one place, and the other two to another.
    #[inline(always)]
    pub fn store_parts(self, head: &mut [f64; 4], tail: &mut [f64; 2]) {
        self.head.store(head);
        self.tail.store(tail);
    }

    /// The largest component by size.
    #[inline(always)]
    pub fn largest(self) -> f64 {
        let mut numbers = [0.0; 6];
        self.store(&mut numbers);
        numbers.iter().fold(0.0, |m: f64, v| if v.abs() > m { v.abs() } else { m })
    }
}

/// The inverse of a body's mass matrix, by columns: the first multiplies four numbers of a row, the other two one each.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct InverseMass {
    head: [[f64; 4]; 3],
    tail: [[f64; 2]; 3],
}

impl InverseMass {
    #[inline(always)]
    pub fn new(body: &SorBody) -> Self {
        let (m, i) = (body.inv_mass, &body.inv_inertia);
        Self {
            head: [[m, m, m, i[0]], [0.0, 0.0, 0.0, i[1]], [0.0, 0.0, 0.0, i[2]]],
            tail: [[i[3], i[6]], [i[4], i[7]], [i[5], i[8]]],
        }
    }

    /// `B = M^-1 J^T`; `j` is given in both forms.
    #[inline(always)]
    pub fn times<Q: Quad>(&self, j: &[f64; 6], six: Six<Q>) -> Six<Q> {
        let head = [Q::load(&self.head[0]), Q::load(&self.head[1]), Q::load(&self.head[2])];
        let tail = [Q::Pair::load(&self.tail[0]), Q::Pair::load(&self.tail[1]), Q::Pair::load(&self.tail[2])];
        let (x, y, z) = (j[3], j[4], j[5]);
        Six {
            head: head[0] * six.head + head[1] * Q::splat(y) + head[2] * Q::splat(z),
            tail: tail[0] * Q::Pair::splat(x) + tail[1] * Q::Pair::splat(y) + tail[2] * Q::Pair::splat(z),
        }
    }
}

/// A row as the loop reads it.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct PackedRow {
    /// `-d J` and `B` of the first body, and of the second.
    head: [[f64; 4]; 4],
    tail: [[f64; 2]; 4],
    pub rhs: f64,
    pub cfm: f64,
    pub lo: f64,
    pub hi: f64,
    /// The bodies; those past the last stand for none.
    pub body: [u32; 2],
    /// The force that scales the bounds; for rows without a friction index the one that is always 1.
    pub scale: u32,
}

impl PackedRow {
    #[inline(always)]
    pub fn set_vectors<Q: Quad>(&mut self, vectors: [Six<Q>; 4]) {
        for (n, v) in vectors.into_iter().enumerate() {
            v.head.store(&mut self.head[n]);
            v.tail.store(&mut self.tail[n]);
        }
    }

    #[inline(always)]
    pub fn vector<Q: Quad>(&self, n: usize) -> Six<Q> {
        Six { head: Q::load(&self.head[n]), tail: Q::Pair::load(&self.tail[n]) }
    }

    /// The first four numbers of one of its four vectors.
    #[inline(always)]
    pub fn head(&self, n: usize) -> &[f64; 4] {
        &self.head[n]
    }

    /// The last two numbers of each of the first body's vectors.
    #[inline(always)]
    pub fn tails(&self) -> [[f64; 2]; 2] {
        [self.tail[0], self.tail[1]]
    }

    /// The right-hand side, the CFM and the bounds.
    #[inline(always)]
    pub fn scalars(&self) -> [f64; 4] {
        [self.rhs, self.cfm, self.lo, self.hi]
    }

    /// One of its four vectors, number by number.
    #[inline(always)]
    pub fn numbers(&self, n: usize) -> [f64; 6] {
        let ([a, b, c, d], [e, f]) = (self.head[n], self.tail[n]);
        [a, b, c, d, e, f]
    }

    /// `-d J a + more`.
    #[inline(always)]
    fn dot<Q: Quad>(&self, a: [Six<Q>; 2], more: f64) -> f64 {
        Six::dot([self.vector(0), self.vector(2)], a, more)
    }

    /// Its bodies, the same number for no body whatever stands for it.
    #[inline(always)]
    fn bodies(&self, nobody: usize) -> [u32; 2] {
        self.body.map(|body| body.min(nobody as u32))
    }
}

/// The longest stretch of rows that is visited as one: more rows need more registers than there are.
const LONGEST: usize = 3;

/// Some rows on the same bodies that follow each other in the order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    /// The place of the first of them in the order.
    start: u32,
    /// How many they are, up to [`LONGEST`].
    len: u32,
    /// `-d_k J_k B_l` for l < k: (1,0), (2,0), (2,1).
    coupling: [f64; 3],
}

/// Cuts an order into stretches.
#[inline(always)]
pub(super) fn find_stretches<Q: Quad>(
    order: &[u32],
    packed: &[PackedRow],
    nobody: usize,
    stretches: &mut Vec<Stretch>,
) {
    stretches.clear();
    let mut at = 0;
    while let Some(first) = order.get(at).map(|&row| &packed[row as usize]) {
        let bodies = first.bodies(nobody);
        let same = |row: &&u32| packed[**row as usize].bodies(nobody) == bodies;
        let len = order[at..].iter().take(LONGEST).take_while(same).count();
        let mut coupling = [0.0; 3];
        let mut c = 0;
        for k in 1..len {
            let row = &packed[order[at + k] as usize];
            for l in 0..k {
                let other = &packed[order[at + l] as usize];
                coupling[c] = row.dot::<Q>([other.vector(1), other.vector(3)], 0.0);
                c += 1;
            }
        }
        stretches.push(Stretch { start: at as u32, len: len as u32, coupling });
        at += len;
    }
}

/// Scratch of [`interleave`].
#[derive(Clone, Debug, Default)]
pub(super) struct Interleaving {
    /// The level that the next stretch on each body is on at least.
    of_body: Vec<u32>,
    level: Vec<u32>,
    /// Where the stretches of each level go.
    start: Vec<u32>,
    before: Vec<Stretch>,
}

/// Puts stretches that don't wait for each other side by side: those that share a body keep their order, so that the sweep computes the same bits,
/// and the processor works on several at a time. Friction rows come after their normal rows on the same bodies; if one hangs on
/// other bodies' rows, all stay as they are.
#[inline(always)]
pub(super) fn interleave(
    order: &[u32],
    packed: &[PackedRow],
    nobody: usize,
    stretches: &mut [Stretch],
    work: &mut Interleaving,
) {
    let Interleaving { of_body, level, start, before } = work;
    let elsewhere = |row: &PackedRow| {
        packed.get(row.scale as usize).is_some_and(|f| f.bodies(nobody) != row.bodies(nobody))
    };
    if packed.iter().any(elsewhere) {
        return;
    }
    of_body.clear();
    of_body.resize(nobody + 1, 0);
    level.clear();
    start.clear();
    start.push(0);
    for stretch in stretches.iter() {
        let Some(row) = order.get(stretch.start as usize).map(|row| &packed[*row as usize]) else { return };
        // No body makes nobody wait.
        of_body[nobody] = 0;
        let [first, second] = row.bodies(nobody).map(|b| b as usize);
        let here = of_body[first].max(of_body[second]);
        of_body[first] = here + 1;
        of_body[second] = here + 1;
        level.push(here);
        if start.len() <= here as usize + 1 {
            start.push(0);
        }
        start[here as usize + 1] += 1;
    }
    for i in 1..start.len() {
        start[i] += start[i - 1];
    }
    before.clear();
    before.extend_from_slice(stretches);
    for (stretch, level) in before.iter().zip(level.iter()) {
        let to = &mut start[*level as usize];
        stretches[*to as usize] = *stretch;
        *to += 1;
    }
}

/// The bounds of a row's force, given the force that scales them. `ZERO`: infinity times zero is zero.
#[inline(always)]
pub(super) fn bounds<const ZERO: bool>(lo: f64, hi: f64, scale: f64) -> (f64, f64) {
    let size = scale.abs();
    if ZERO && size == 0.0 { (0.0, 0.0) } else { (lo * size, hi * size) }
}

/// `x` within `[lo, hi]`; a bound that is not a number is none.
#[inline(always)]
pub(super) fn clamp(x: f64, lo: f64, hi: f64) -> f64 {
    let raised = if x < lo { lo } else { x };
    if raised > hi { hi } else { raised }
}

/// What a sweep over the rows works on. `ZERO`: infinity times zero is zero; `DYNAMIC`: changes are recorded.
pub(super) struct Sweep<'a, Q, const ZERO: bool, const DYNAMIC: bool> {
    pub packed: &'a [PackedRow],
    pub lambda: &'a mut [f64],
    pub acceleration: &'a mut [SorAcceleration],
    pub weight: &'a [[f64; 2]],
    pub change: &'a mut [[f64; 2]],
    /// Bodies from here on stand for none.
    pub nobody: usize,
    pub quads: PhantomData<Q>,
}

impl<Q: Quad, const ZERO: bool, const DYNAMIC: bool> Sweep<'_, Q, ZERO, DYNAMIC> {
    #[inline(always)]
    fn load(&self, body: usize) -> Six<Q> {
        Six::load(&self.acceleration[body].0)
    }

    #[inline(always)]
    fn store(&mut self, body: usize, a: Six<Q>) {
        a.store(&mut self.acceleration[body].0);
    }

    /// Adds a change to the sums of the row's bodies.
    #[inline(always)]
    fn record(&mut self, row: usize, r: &PackedRow, delta: f64) {
        if DYNAMIC {
            let side = usize::from(delta < 0.0);
            let weight = self.weight[row];
            self.change[r.body[0] as usize][side] += delta * weight[0];
            self.change[r.body[1] as usize][side] += delta * weight[1];
        }
    }

    /// Visits one row.
    #[inline(always)]
    pub fn visit(&mut self, row: usize) {
        let r = &self.packed[row];
        let (first, second) = (r.body[0] as usize, r.body[1] as usize);
        let old = self.lambda[row];
        let (lo, hi) = bounds::<ZERO>(r.lo, r.hi, self.lambda[r.scale as usize]);
        let (a0, a1) = (self.load(first), self.load(second));
        let wanted = r.dot([a0, a1], r.rhs - r.cfm * old);
        let delta = clamp(wanted, lo - old, hi - old);
        self.lambda[row] = clamp(old + wanted, lo, hi);
        self.store(first, a0.plus(r.vector(1).scaled(delta)));
        self.store(second, a1.plus(r.vector(3).scaled(delta)));
        self.record(row, r, delta);
    }

    /// Visits the rows of a stretch, in order.
    #[inline(always)]
    pub fn visit_stretch(&mut self, order: &[u32], stretch: &Stretch) {
        let rows = &order[stretch.start as usize..];
        match (stretch.len, rows) {
            (2, &[a, b, ..]) => self.visit_together([a, b], &stretch.coupling),
            (3, &[a, b, c, ..]) => self.visit_together([a, b, c], &stretch.coupling),
            (_, &[a, ..]) => self.visit(a as usize),
            _ => {}
        }
    }

    #[inline(always)]
    fn visit_together<const K: usize>(&mut self, rows: [u32; K], coupling: &[f64; 3]) {
        let packed = self.packed;
        let r = rows.map(|row| &packed[row as usize]);
        let (first, second) = (r[0].body[0] as usize, r[0].body[1] as usize);
        let two = second < self.nobody;
        let mut a0 = self.load(first);
        let mut a1 = if two { self.load(second) } else { Six::load(&[0.0; 6]) };
        let old = rows.map(|row| self.lambda[row as usize]);
        let mut wanted = [0.0; K];
        for k in 0..K {
            wanted[k] = r[k].dot([a0, a1], r[k].rhs - r[k].cfm * old[k]);
        }
        let mut delta = [0.0; K];
        let mut c = 0;
        for k in 0..K {
            for change in &delta[..k] {
                wanted[k] += coupling[c] * change;
                c += 1;
            }
            let (lo, hi) = bounds::<ZERO>(r[k].lo, r[k].hi, self.lambda[r[k].scale as usize]);
            self.lambda[rows[k] as usize] = clamp(old[k] + wanted[k], lo, hi);
            delta[k] = clamp(wanted[k], lo - old[k], hi - old[k]);
            a0 = a0.plus(r[k].vector(1).scaled(delta[k]));
            a1 = a1.plus(r[k].vector(3).scaled(delta[k]));
            self.record(rows[k] as usize, r[k], delta[k]);
        }
        self.store(first, a0);
        if two {
            self.store(second, a1);
        }
    }
}
