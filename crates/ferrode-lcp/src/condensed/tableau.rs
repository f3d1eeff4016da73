//! A principal pivoting tableau, and Dantzig's drives on it.
//!
//! With the free rows C and the others N the tableau `T` of the symmetric matrix `S` is
//!
//! ```text
//!     T_CC = -S_CC^-1         T_CN = S_CC^-1 S_CN
//!     T_NC = S_NC S_CC^-1     T_NN = S_NN - S_NC S_CC^-1 S_CN
//! ```
//!
//! Driving the force of a row i of N by one moves the forces of C by `-T_Ci` and the slacks of N by `T_Ni`. `T` is symmetric, so half of it is
//! kept. A row that changes between C and N costs one pass over that (J. H. Goodnight, "A tutorial on the SWEEP operator", 1979; A. W. Tucker's
//! principal pivot transform).

use super::blocks::add_blocks;
use ferrode_math::simd::Quad;

/// Friction hangs on no row.
pub(super) const NO_NORMAL: u32 = u32::MAX;

/// What a row does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Not taken in yet, or never: its force is zero whatever its slack.
    Out,
    Free,
    Lower,
    Upper,
}

/// A row of the tableau.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// The bounds in force.
    pub lo: f64,
    pub hi: f64,
    /// The row whose force scales the bounds.
    normal: u32,
    state: State,
}

impl Place {
    pub fn new(lo: f64, hi: f64, normal: u32) -> Self {
        Self { lo, hi, normal, state: State::Out }
    }

    pub fn is_free(&self) -> bool {
        self.state == State::Free
    }

    /// The force of a row that is not free; 0 for one that is.
    pub fn bound(&self) -> f64 {
        match self.state {
            State::Lower => self.lo,
            State::Upper => self.hi,
            State::Out | State::Free => 0.0,
        }
    }

    /// Changes a wrong state, given the force and the slack over the diagonal. Whether it was wrong.
    pub fn correct(&mut self, x: f64, w: f64, close: f64) -> bool {
        if self.lo == self.hi {
            return false;
        }
        let better = match self.state {
            // Forces were clamped to the bounds, so it shows in the slack.
            State::Free if x <= self.lo && w > close => State::Lower,
            State::Free if x >= self.hi && w < -close => State::Upper,
            State::Lower if w < -close => State::Free,
            State::Upper if w > close => State::Free,
            state => state,
        };
        core::mem::replace(&mut self.state, better) != better
    }
}

/// The tableau.
#[derive(Clone, Debug, Default)]
pub(super) struct Tableau {
    pub rows: Vec<Place>,
    /// Changes of sets in the last solve.
    pub pivots: u32,
    /// The upper triangle, in rows of whole blocks; what lies left of the diagonal means nothing.
    t: Vec<[f64; 4]>,
    /// Forces of C, slacks of all others; the range in which each may be until its row has to change sets.
    z: Vec<[f64; 4]>,
    floor: Vec<f64>,
    ceiling: Vec<f64>,
    /// -1 for rows of C, 1 for others: which way driving moves `z`.
    sign: Vec<[f64; 4]>,
    /// How `z` changes while a row is driven.
    rate: Vec<[f64; 4]>,
    /// A row of the tableau, whole; the same over its diagonal.
    row: Vec<[f64; 4]>,
    scaled: Vec<[f64; 4]>,
}

/// How many blocks a row has: a number that the compiler knows for the small tableaus that most are, whose loops then have no end to foretell.
trait Width: Copy {
    fn blocks(self) -> usize;
}

#[derive(Clone, Copy)]
struct Fixed<const W: usize>;

impl<const W: usize> Width for Fixed<W> {
    #[inline(always)]
    fn blocks(self) -> usize {
        W
    }
}

impl Width for usize {
    #[inline(always)]
    fn blocks(self) -> usize {
        self
    }
}

/// What ends a drive's step.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Event {
    Clamp,
    Bound(State),
    Change(usize),
}

impl Tableau {
    /// Finds the states of all rows. The upper triangle of `S` comes in rows, each from its diagonal on, and behind it the row's
    /// entry of `q`. `None` if a step has no length, or it takes too many.
    #[inline(always)]
    pub fn solve<'a, Q: Quad>(&mut self, k: usize, upper: impl Iterator<Item = &'a [f64]>) -> Option<()> {
        let width = k.div_ceil(4);
        self.pivots = 0;
        for v in [&mut self.z, &mut self.rate, &mut self.row, &mut self.scaled] {
            refill(v, width, [0.0; 4]);
        }
        refill(&mut self.sign, width, [1.0; 4]);
        refill(&mut self.floor, k, f64::NEG_INFINITY);
        refill(&mut self.ceiling, k, f64::INFINITY);
        // Four rows are worked on at a time.
        if self.t.len() < 4 * width * width {
            self.t.resize(4 * width * width, [0.0; 4]);
        }
        let numbers = self.t.as_flattened_mut().chunks_exact_mut((4 * width).max(1));
        for (i, (row, t)) in upper.zip(numbers).enumerate() {
            let (row, q) = row.split_at(k - i);
            self.z.as_flattened_mut()[i] = -q[0];
            // Old numbers behind the last column might not be finite.
            t[4 * width - 4..].fill(0.0);
            for (t, s) in t[i..].iter_mut().zip(row) {
                *t = *s;
            }
        }
        match width {
            1 => self.drive_all::<Q>(k, Fixed::<1>),
            2 => self.drive_all::<Q>(k, Fixed::<2>),
            3 => self.drive_all::<Q>(k, Fixed::<3>),
            4 => self.drive_all::<Q>(k, Fixed::<4>),
            5 => self.drive_all::<Q>(k, Fixed::<5>),
            6 => self.drive_all::<Q>(k, Fixed::<6>),
            _ => self.drive_all::<Q>(k, width),
        }
    }

    /// Takes the rows in, one after the other.
    #[inline(always)]
    fn drive_all<Q: Quad>(&mut self, k: usize, w: impl Width) -> Option<()> {
        let most = 50 + 20 * k as u32;
        let mut frozen = false;
        for at in 0..k {
            if !frozen && self.rows[at].normal != NO_NORMAL {
                frozen = true;
                self.freeze_friction(at);
            }
            let Place { lo, hi, .. } = self.rows[at];
            if lo == 0.0 && hi == 0.0 {
                continue;
            }
            let z = self.z.as_flattened()[at];
            if lo == 0.0 && z >= 0.0 {
                self.put(at, State::Lower, z);
            } else if hi == 0.0 && z <= 0.0 {
                self.put(at, State::Upper, z);
            } else if z == 0.0 {
                self.pivot::<Q>(at, w)?;
                self.put(at, State::Free, 0.0);
            } else {
                self.drive::<Q>(at, most, w)?;
            }
        }
        Some(())
    }

    /// Puts a row into a state, with that force or slack.
    #[inline(always)]
    fn put(&mut self, row: usize, state: State, z: f64) {
        let place = &mut self.rows[row];
        place.state = state;
        self.z.as_flattened_mut()[row] = z;
        self.sign.as_flattened_mut()[row] = if state == State::Free { -1.0 } else { 1.0 };
        (self.floor[row], self.ceiling[row]) = match state {
            State::Free => (place.lo, place.hi),
            State::Lower => (0.0, f64::INFINITY),
            State::Upper => (f64::NEG_INFINITY, 0.0),
            State::Out => (f64::NEG_INFINITY, f64::INFINITY),
        };
    }

    #[inline(always)]
    fn freeze_friction(&mut self, at: usize) {
        for row in at..self.rows.len() {
            let Some(normal) = self.rows.get(self.rows[row].normal as usize) else { continue };
            let force = if normal.is_free() {
                self.z.as_flattened()[self.rows[row].normal as usize]
            } else {
                normal.bound()
            };
            let place = &mut self.rows[row];
            let bound = if force == 0.0 { 0.0 } else { (place.hi * force).abs() };
            (place.lo, place.hi) = (0.0 - bound, bound);
        }
    }

    /// Drives a row until its slack vanishes or its force is at a bound.
    #[inline(always)]
    fn drive<Q: Quad>(&mut self, at: usize, most: u32, w: impl Width) -> Option<()> {
        let Place { lo, hi, .. } = self.rows[at];
        let mut x = 0.0;
        loop {
            let z = self.z.as_flattened()[at];
            let s = if z <= 0.0 { 1.0 } else { -1.0 };
            self.find_rates::<Q>(at, s, w);
            // The slack has the other sign than the drive, and the diagonal is positive.
            let (mut step, mut event) = (-z / self.rate.as_flattened()[at], Event::Clamp);
            let own = if s > 0.0 { hi - x } else { x - lo };
            if own < step {
                (step, event) = (own, Event::Bound(if s > 0.0 { State::Upper } else { State::Lower }));
            }
            if let Some((row, length)) = self.first_to_change(at, step) {
                (step, event) = (length, Event::Change(row));
            }
            let usable = step > 0.0 && step.is_finite();
            if !usable || self.pivots >= most {
                return None;
            }
            add_blocks::<Q>(&mut self.z[..w.blocks()], step, &self.rate[..w.blocks()]);
            x += step * s;
            match event {
                Event::Clamp => {
                    self.pivot::<Q>(at, w)?;
                    self.put(at, State::Free, x);
                    return Some(());
                }
                Event::Bound(state) => {
                    let slack = self.z.as_flattened()[at];
                    self.put(at, state, slack);
                    return Some(());
                }
                Event::Change(row) => {
                    let rate = self.rate.as_flattened()[row];
                    self.pivot::<Q>(row, w)?;
                    if self.rows[row].is_free() {
                        let state = if rate < 0.0 { State::Lower } else { State::Upper };
                        self.put(row, state, 0.0);
                    } else {
                        let force = self.rows[row].bound();
                        self.put(row, State::Free, force);
                    }
                }
            }
        }
    }

    /// Finds how forces and slacks change while a row is driven.
    #[inline(always)]
    fn find_rates<Q: Quad>(&mut self, at: usize, s: f64, w: impl Width) {
        self.copy_row(at, w);
        let w = w.blocks();
        let (rate, sign, row) = (&mut self.rate[..w], &self.sign[..w], &self.row[..w]);
        let s = Q::splat(s);
        for b in 0..w {
            (s * (Q::load(&sign[b]) * Q::load(&row[b]))).store(&mut rate[b]);
        }
    }

    /// The row before `at` that first leaves its range, and how long the step is until then; `None` if none does within `step`. Of
    /// equal lengths the first.
    #[inline(always)]
    fn first_to_change(&self, at: usize, mut step: f64) -> Option<(usize, f64)> {
        let (z, rate) = (&self.z.as_flattened()[..at], &self.rate.as_flattened()[..at]);
        let (floor, ceiling) = (&self.floor[..at], &self.ceiling[..at]);
        let mut first = None;
        for row in 0..at {
            let v = rate[row];
            let way = (if v < 0.0 { floor[row] } else { ceiling[row] }) - z[row];
            // Few rows are near the end of their range: the others need no division.
            if (if v < 0.0 { -way } else { way }) < step * v.abs() && v != 0.0 {
                let length = way / v;
                if length < step {
                    (step, first) = (length, Some((row, length)));
                }
            }
        }
        first
    }

    /// Copies a whole row, of which the part left of the diagonal is a column.
    #[inline(always)]
    fn copy_row(&mut self, p: usize, w: impl Width) {
        let w = w.blocks();
        let (t, row) = (&self.t, &mut self.row[..w]);
        // What stands left of the diagonal is written over.
        row.copy_from_slice(&t[p * w..][..w]);
        for (row, t) in row.as_flattened_mut()[..p].iter_mut().zip(t.chunks_exact(w)) {
            *row = t[p / 4][p & 3];
        }
    }

    /// Moves a row from N to C or back. `None` if its diagonal has not the sign that it must have.
    #[inline(always)]
    fn pivot<Q: Quad>(&mut self, p: usize, w: impl Width) -> Option<()> {
        self.pivots += 1;
        self.copy_row(p, w);
        let w = w.blocks();
        let (row, scaled) = (&self.row[..w], &mut self.scaled[..w]);
        let t = &mut self.t[..4 * w * w];
        let diagonal = row.as_flattened()[p];
        // What becomes of the row over its diagonal.
        let sign = if self.rows[p].is_free() { -1.0 } else { 1.0 };
        let size = sign * diagonal;
        if size.is_nan() || size <= 0.0 {
            return None;
        }
        let inverse = 1.0 / diagonal;
        let factor = Q::splat(inverse);
        for b in 0..w {
            (factor * Q::load(&row[b])).store(&mut scaled[b]);
        }
        // Row p changes too, but is written anew below.
        for block in 0..w {
            let rows = &mut t[4 * block * w..][..4 * w];
            let (r0, rest) = rows.split_at_mut(w);
            let (r1, rest) = rest.split_at_mut(w);
            let (r2, r3) = rest.split_at_mut(w);
            let f = row[block];
            let f = [Q::splat(-f[0]), Q::splat(-f[1]), Q::splat(-f[2]), Q::splat(-f[3])];
            for b in block..w {
                let scaled = Q::load(&scaled[b]);
                (Q::load(&r0[b]) + f[0] * scaled).store(&mut r0[b]);
                (Q::load(&r1[b]) + f[1] * scaled).store(&mut r1[b]);
                (Q::load(&r2[b]) + f[2] * scaled).store(&mut r2[b]);
                (Q::load(&r3[b]) + f[3] * scaled).store(&mut r3[b]);
            }
        }
        let sign = Q::splat(sign);
        for scaled in &mut *scaled {
            (sign * Q::load(scaled)).store(scaled);
        }
        for (t, scaled) in t.chunks_exact_mut(w).zip(&scaled.as_flattened()[..p]) {
            t[p / 4][p & 3] = *scaled;
        }
        // Left of the diagonal it means nothing.
        let own = &mut t[p * w..][..w];
        own.copy_from_slice(scaled);
        own[p / 4][p & 3] = -inverse;
        Some(())
    }
}

fn refill<T: Copy>(v: &mut Vec<T>, n: usize, value: T) {
    v.clear();
    v.resize(n, value);
}
