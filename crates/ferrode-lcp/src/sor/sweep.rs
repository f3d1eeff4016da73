//! The inner loop of [`super`]: one visit of a row, and of several rows on the same bodies.
//!
//! **Layout.** `J_i` is scaled by `-d_i` beforehand and stored with `B_i`, the bounds and the bodies' numbers in one record of four
//! cache lines, in the order of access; a row that acts on one body reads three of them. The two bounds are multiplied by
//! `|lambda_f|` without asking: rows without a friction index point to a force that is always 1. Sums have a fixed order of two
//! partial sums.
//!
//! **Latency.** From a body's acceleration to its next one is a chain of dependent operations, and before the first shuffle
//! the rows of a joint or of a pair of touching bodies follow each other. All that can be is kept off that chain: the change is
//! clamped, not the force; and in a stretch of rows on the same bodies all products `J_i a` are formed at once, with the `a` from before the
//! stretch, and corrected for the changes inside it by the couplings `J_k B_l`, which are known beforehand. The
//! result is that of visiting the rows one by one, to rounding.

use super::{NO_BODY, SorAcceleration};

/// A row as the loop reads it.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct PackedRow {
    pub rhs: f64,
    pub cfm: f64,
    pub lo: f64,
    pub hi: f64,
    pub body: [u32; 2],
    /// The force that scales the bounds; for rows without a friction index the one that is always 1.
    pub scale: u32,
    /// `-d J` and `B` of the first body.
    pub j0: [f64; 6],
    pub b0: [f64; 6],
    /// Of the second body.
    pub j1: [f64; 6],
    pub b1: [f64; 6],
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
pub(super) fn find_stretches(order: &[u32], packed: &[PackedRow], stretches: &mut Vec<Stretch>) {
    stretches.clear();
    let mut at = 0;
    while let Some(first) = order.get(at).map(|&row| &packed[row as usize]) {
        let same = |row: &&u32| packed[**row as usize].body == first.body;
        let len = order[at..].iter().take(LONGEST).take_while(same).count();
        let mut coupling = [0.0; 3];
        let mut c = 0;
        for k in 1..len {
            let row = &packed[order[at + k] as usize];
            for l in 0..k {
                let other = &packed[order[at + l] as usize];
                let (s, t) = (dot6(&row.j0, &other.b0), dot6(&row.j1, &other.b1));
                coupling[c] = (s[0] + t[0]) + (s[1] + t[1]);
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
pub(super) fn interleave(
    order: &[u32],
    packed: &[PackedRow],
    bodies: usize,
    stretches: &mut [Stretch],
    work: &mut Interleaving,
) {
    let Interleaving { of_body, level, start, before } = work;
    let elsewhere = |row: &PackedRow| packed.get(row.scale as usize).is_some_and(|f| f.body != row.body);
    if packed.iter().any(elsewhere) {
        return;
    }
    of_body.clear();
    of_body.resize(bodies + 1, 0);
    level.clear();
    start.clear();
    start.push(0);
    for stretch in stretches.iter() {
        let Some(row) = order.get(stretch.start as usize).map(|row| &packed[*row as usize]) else { return };
        let [first, second] = row.body.map(|b| b as usize);
        let mut here = of_body[first];
        if let Some(other) = of_body.get(second) {
            here = here.max(*other);
        }
        of_body[first] = here + 1;
        if let Some(other) = of_body.get_mut(second) {
            *other = here + 1;
        }
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

/// Two partial dot products of six numbers, even and odd places.
#[inline(always)]
fn dot6(j: &[f64; 6], a: &[f64]) -> [f64; 2] {
    let a = &a[..6];
    let mut s = [0.0; 2];
    for l in 0..2 {
        s[l] = (j[l] * a[l] + j[l + 2] * a[l + 2]) + j[l + 4] * a[l + 4];
    }
    s
}

/// `x` within `[lo, hi]`; a bound that is not a number is none.
#[inline(always)]
fn clamp(x: f64, lo: f64, hi: f64) -> f64 {
    let raised = if x < lo { lo } else { x };
    if raised > hi { hi } else { raised }
}

/// `a + delta b`. The sums are made in one value, so that they are stored in whole registers: what is stored in halves is
/// slow to load as a whole.
#[inline(always)]
fn add_scaled(a: &[f64; 6], delta: f64, b: &[f64; 6]) -> [f64; 6] {
    [
        a[0] + delta * b[0],
        a[1] + delta * b[1],
        a[2] + delta * b[2],
        a[3] + delta * b[3],
        a[4] + delta * b[4],
        a[5] + delta * b[5],
    ]
}

/// What a sweep over the rows works on. `ZERO`: infinity times zero is zero; `DYNAMIC`: changes are recorded.
pub(super) struct Sweep<'a, const ZERO: bool, const DYNAMIC: bool> {
    pub packed: &'a [PackedRow],
    pub lambda: &'a mut [f64],
    pub acceleration: &'a mut [SorAcceleration],
    pub weight: &'a [[f64; 2]],
    pub change: &'a mut [[f64; 2]],
}

impl<const ZERO: bool, const DYNAMIC: bool> Sweep<'_, ZERO, DYNAMIC> {
    #[inline(always)]
    fn load(&self, body: usize) -> [f64; 6] {
        let a = &self.acceleration[body].0;
        [a[0], a[1], a[2], a[3], a[4], a[5]]
    }

    #[inline(always)]
    fn store(&mut self, body: usize, a: [f64; 6]) {
        self.acceleration[body].0[..6].copy_from_slice(&a);
    }

    /// Clamps the change that a row wants and brings its force up to date. Returns the change.
    #[inline(always)]
    fn change_force(&mut self, row: usize, r: &PackedRow, old: f64, wanted: f64) -> f64 {
        let size = self.lambda[r.scale as usize].abs();
        let (mut lo, mut hi) = (r.lo * size, r.hi * size);
        if ZERO && size == 0.0 {
            (lo, hi) = (0.0, 0.0);
        }
        self.lambda[row] = clamp(old + wanted, lo, hi);
        clamp(wanted, lo - old, hi - old)
    }

    /// Adds a change to the sums of the row's bodies.
    #[inline(always)]
    fn record(&mut self, row: usize, r: &PackedRow, delta: f64) {
        if DYNAMIC {
            let side = usize::from(delta < 0.0);
            let weight = self.weight[row];
            self.change[r.body[0] as usize][side] += delta * weight[0];
            if r.body[1] != NO_BODY {
                self.change[r.body[1] as usize][side] += delta * weight[1];
            }
        }
    }

    /// Visits one row.
    #[inline(always)]
    pub fn visit(&mut self, row: usize) {
        let r = &self.packed[row];
        let (first, second) = (r.body[0] as usize, r.body[1] as usize);
        let two = r.body[1] != NO_BODY;
        let old = self.lambda[row];
        let mut s = dot6(&r.j0, &self.acceleration[first].0);
        if two {
            let t = dot6(&r.j1, &self.acceleration[second].0);
            s = [s[0] + t[0], s[1] + t[1]];
        }
        let wanted = (s[0] + (r.rhs - r.cfm * old)) + s[1];
        let delta = self.change_force(row, r, old, wanted);
        self.store(first, add_scaled(&self.load(first), delta, &r.b0));
        if two {
            self.store(second, add_scaled(&self.load(second), delta, &r.b1));
        }
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
        let two = r[0].body[1] != NO_BODY;
        let mut a0 = self.load(first);
        let mut a1 = if two { self.load(second) } else { [0.0; 6] };
        let old = rows.map(|row| self.lambda[row as usize]);
        let mut wanted = [0.0; K];
        for k in 0..K {
            let (s, t) = (dot6(&r[k].j0, &a0), dot6(&r[k].j1, &a1));
            wanted[k] = ((s[0] + t[0]) + (r[k].rhs - r[k].cfm * old[k])) + (s[1] + t[1]);
        }
        let mut delta = [0.0; K];
        let mut c = 0;
        for k in 0..K {
            for change in &delta[..k] {
                wanted[k] += coupling[c] * change;
                c += 1;
            }
            delta[k] = self.change_force(rows[k] as usize, r[k], old[k], wanted[k]);
            a0 = add_scaled(&a0, delta[k], &r[k].b0);
            a1 = add_scaled(&a1, delta[k], &r[k].b1);
            self.record(rows[k] as usize, r[k], delta[k]);
        }
        self.store(first, a0);
        if two {
            self.store(second, a1);
        }
    }
}
