//! A principal pivoting tableau, and Dantzig's drives on it.
//!
//! With the free rows C and the others N the tableau `T` of the symmetric matrix `S` is
//!
//! ```text
//!     T_CC = S_CC^-1          T_CN = -S_CC^-1 S_CN
//!     T_NC = S_NC S_CC^-1     T_NN = S_NN - S_NC S_CC^-1 S_CN
//! ```
//!
//! Driving the force of a row i of N by one moves the forces of C by `T_Ci` and the slacks of N by `T_Ni`. `T` is symmetric but for the
//! sign of `T_CN`, so row i has them too, next to each other. A row that changes between C and N costs one pass over the tableau (A. W. Tucker's principal
//! pivot transform; M. J. Tsatsomeros, "Principal pivot transforms: properties and applications", 2000).

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
    t: Vec<f64>,
    /// Forces of C, slacks of all others; the range in which each may be until its row has to change sets.
    z: Vec<f64>,
    floor: Vec<f64>,
    ceiling: Vec<f64>,
    /// -1 for rows of C, 1 for others: what makes a row of the tableau a column.
    sign: Vec<f64>,
    /// How `z` changes while a row is driven, and how far each lets it go; the pivot row.
    rate: Vec<f64>,
    length: Vec<f64>,
}

/// The distance between the starts of two rows of a matrix with `k` columns.
pub(super) fn stride(k: usize) -> usize {
    k.next_multiple_of(4)
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
    pub fn solve<'a>(&mut self, k: usize, upper: impl Iterator<Item = &'a [f64]>) -> Option<()> {
        let stride = stride(k);
        self.pivots = 0;
        refill(&mut self.t, k * stride, 0.0);
        refill(&mut self.z, stride, 0.0);
        refill(&mut self.sign, stride, 1.0);
        refill(&mut self.floor, stride, f64::NEG_INFINITY);
        refill(&mut self.ceiling, stride, f64::INFINITY);
        refill(&mut self.rate, stride, 0.0);
        refill(&mut self.length, stride, 0.0);
        for (i, row) in upper.enumerate() {
            let (row, q) = row.split_at(k - i);
            self.z[i] = -q[0];
            self.t[i * stride + i..i * stride + k].copy_from_slice(row);
            for (j, s) in row.iter().enumerate().skip(1) {
                self.t[(i + j) * stride + i] = *s;
            }
        }
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
            let w = self.z[at];
            if lo == 0.0 && w >= 0.0 {
                self.put(at, State::Lower, w);
            } else if hi == 0.0 && w <= 0.0 {
                self.put(at, State::Upper, w);
            } else if w == 0.0 {
                self.pivot(at, stride)?;
                self.put(at, State::Free, 0.0);
            } else {
                self.drive(at, stride, most)?;
            }
        }
        Some(())
    }

    /// Puts a row into a state, with that force or slack.
    #[inline(always)]
    fn put(&mut self, row: usize, state: State, z: f64) {
        let place = &mut self.rows[row];
        place.state = state;
        self.z[row] = z;
        self.sign[row] = if state == State::Free { -1.0 } else { 1.0 };
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
            let force =
                if normal.is_free() { self.z[self.rows[row].normal as usize] } else { normal.bound() };
            let place = &mut self.rows[row];
            let bound = if force == 0.0 { 0.0 } else { (place.hi * force).abs() };
            (place.lo, place.hi) = (0.0 - bound, bound);
        }
    }

    /// Drives a row until its slack vanishes or its force is at a bound.
    #[inline(always)]
    fn drive(&mut self, at: usize, stride: usize, most: u32) -> Option<()> {
        let Place { lo, hi, .. } = self.rows[at];
        let mut x = 0.0;
        loop {
            let s = if self.z[at] <= 0.0 { 1.0 } else { -1.0 };
            self.measure_lengths(at, s, stride);
            // The slack has the other sign than the drive, and the diagonal is positive.
            let (mut step, mut event) = (-self.z[at] / self.rate[at], Event::Clamp);
            let own = if s > 0.0 { hi - x } else { x - lo };
            if own < step {
                (step, event) = (own, Event::Bound(if s > 0.0 { State::Upper } else { State::Lower }));
            }
            // Of equal lengths the first.
            for (row, length) in self.length[..at].iter().enumerate() {
                if *length < step {
                    (step, event) = (*length, Event::Change(row));
                }
            }
            let usable = step > 0.0 && step.is_finite();
            if !usable || self.pivots >= most {
                return None;
            }
            let rate = self.rate.as_chunks::<4>().0;
            for (z, rate) in self.z.as_chunks_mut::<4>().0.iter_mut().zip(rate) {
                let l = |l: usize| z[l] + step * rate[l];
                *z = [l(0), l(1), l(2), l(3)];
            }
            x += step * s;
            match event {
                Event::Clamp => {
                    self.pivot(at, stride)?;
                    self.put(at, State::Free, x);
                    return Some(());
                }
                Event::Bound(state) => {
                    let w = self.z[at];
                    self.put(at, state, w);
                    return Some(());
                }
                Event::Change(row) => {
                    self.pivot(row, stride)?;
                    if self.rows[row].is_free() {
                        let state = if self.rate[row] < 0.0 { State::Lower } else { State::Upper };
                        self.put(row, state, 0.0);
                    } else {
                        let force = self.rows[row].bound();
                        self.put(row, State::Free, force);
                    }
                }
            }
        }
    }

    /// Finds how forces and slacks change while a row is driven, and how far each of them lets it go.
    #[inline(always)]
    fn measure_lengths(&mut self, at: usize, s: f64, stride: usize) {
        let row = self.t[at * stride..][..stride].as_chunks::<4>().0;
        let n = row.len();
        let (z, sign) = (&self.z.as_chunks::<4>().0[..n], &self.sign.as_chunks::<4>().0[..n]);
        let (floor, ceiling) = (&self.floor.as_chunks::<4>().0[..n], &self.ceiling.as_chunks::<4>().0[..n]);
        let rate = &mut self.rate.as_chunks_mut::<4>().0[..n];
        let length = &mut self.length.as_chunks_mut::<4>().0[..n];
        for i in 0..n {
            let v = |l: usize| s * (sign[i][l] * row[i][l]);
            let v = [v(0), v(1), v(2), v(3)];
            let far = |l: usize| far(v[l], z[i][l], floor[i][l], ceiling[i][l]);
            (rate[i], length[i]) = (v, [far(0), far(1), far(2), far(3)]);
        }
    }

    /// Moves a row from N to C or back. `None` if its diagonal is not positive.
    #[inline(always)]
    fn pivot(&mut self, p: usize, stride: usize) -> Option<()> {
        self.pivots += 1;
        let diagonal = self.t[p * stride + p];
        if diagonal.is_nan() || diagonal <= 0.0 {
            return None;
        }
        let inverse = 1.0 / diagonal;
        // Row p over the diagonal; row p itself becomes minus that.
        for (d, t) in self.length.iter_mut().zip(&mut self.t[p * stride..][..stride]) {
            *d = *t * inverse;
            *t = -*d;
        }
        self.t[p * stride + p] = inverse;
        let (before, rest) = self.t.split_at_mut(p * stride);
        for row in before.chunks_exact_mut(stride).chain(rest[stride..].chunks_exact_mut(stride)) {
            let f = row[p];
            if f != 0.0 {
                let d = self.length.as_chunks::<4>().0;
                for (t, d) in row.as_chunks_mut::<4>().0.iter_mut().zip(d) {
                    // All read before any is written: one load, one store.
                    *t = [t[0] - f * d[0], t[1] - f * d[1], t[2] - f * d[2], t[3] - f * d[3]];
                }
                row[p] = f * inverse;
            }
        }
        Some(())
    }
}

/// How long what is at `z` and changes at the rate `v` stays within its range.
#[inline(always)]
fn far(v: f64, z: f64, floor: f64, ceiling: f64) -> f64 {
    let way = (if v < 0.0 { floor } else { ceiling }) - z;
    let far = way / v;
    if v == 0.0 { f64::INFINITY } else { far }
}

fn refill(v: &mut Vec<f64>, n: usize, value: f64) {
    v.clear();
    v.resize(n, value);
}
