//! Articulations of one shape, solved side by side.
//!
//! With the velocities ũ before the sweep, impulses change by the solution of
//!
//! ```text
//! (J̃ J̃ᵀ + Γ) Δλ = −(J̃ ũ − target − bias + Γ λ)
//! ```
//!
//! Γ holds the CFM of springs and, for all rows, 10⁻⁶ of the diagonal, by which rows that say the same share the load. Cholesky's
//! factor is backward stable: what is left of the right side is of the size of rounding, whatever the condition, and each sweep begins with what
//! is left.
//!
//! Rows with bounds (stops, motors) that hold take part like the others; those at a bound leave the equations, their impulse fixed. Which
//! is which is found by trying: rows that end beyond a bound are put there, rows at a bound that ought to give way are freed, and the
//! factor is made again.

use super::factor::Factor;
use super::shape::Shape;
use crate::arena::NIL;
use crate::solve::substep::joints::{JointConstraint, JointRow, Joints};
use core::cell::Cell;
use ferrode_math::Vector3;
use ferrode_math::simd::{Lanes, Mask, NO_RECORD, Record};

/// Part of the diagonal that is added to it.
const SOFTNESS: f32 = 1e-6;
/// Velocity, in m/s or rad/s, by which a row has to strive away from its bound to be freed.
const RELEASE: f32 = 1e-4;
/// Trials in which rows may be freed; after them rows are only put to their bounds.
const FREEING: usize = 6;
/// Most trials.
const TRIALS: usize = 16;

/// The same row of several joints.
#[derive(Clone, Copy, Debug)]
struct LaneRow<L: Lanes> {
    jacobian: [[L::Block; 6]; 2],
    target: L::Block,
    /// In the biased and the relaxing pass.
    bias: [L::Block; 2],
    /// Error of position, of rows without bounds that are no springs.
    error: L::Block,
    gamma: L::Block,
    lo: L::Block,
    hi: L::Block,
    impulse: L::Block,
    /// What is added to the diagonal beside γ.
    softness: L,
    /// 1 where the row takes part, 0 where its impulse is fixed to the next.
    free: L,
    fixed: L,
    bounded: bool,
    spring: bool,
}

impl<L: Lanes> LaneRow<L> {
    fn none() -> Self {
        let (zero, one) = (L::ZERO.store(), L::ONE);
        Self {
            jacobian: [[zero; 6]; 2],
            target: zero,
            bias: [zero; 2],
            error: zero,
            gamma: zero,
            lo: L::splat(f32::NEG_INFINITY).store(),
            hi: L::splat(f32::INFINITY).store(),
            impulse: zero,
            softness: L::ZERO,
            free: one,
            fixed: L::ZERO,
            bounded: false,
            spring: false,
        }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, row: &JointRow) {
        for (to, from) in self.jacobian.iter_mut().zip(&row.jacobian) {
            for (to, from) in to.iter_mut().zip(from) {
                to.as_mut()[lane] = *from;
            }
        }
        self.target.as_mut()[lane] = row.target;
        self.bias[0].as_mut()[lane] = row.bias;
        self.bias[1].as_mut()[lane] = if row.spring { row.bias } else { 0.0 };
        self.error.as_mut()[lane] = row.error;
        self.gamma.as_mut()[lane] = row.gamma;
        self.lo.as_mut()[lane] = row.lo;
        self.hi.as_mut()[lane] = row.hi;
        self.impulse.as_mut()[lane] = row.impulse;
        self.bounded |= row.lo > f32::NEG_INFINITY || row.hi < f32::INFINITY;
        self.spring |= row.spring;
    }

    #[inline(always)]
    fn jacobian(&self) -> [[L; 6]; 2] {
        [load6(&self.jacobian[0]), load6(&self.jacobian[1])]
    }

    /// Scales a Jacobian by the bodies' records of scales.
    #[inline(always)]
    fn scale(&mut self, scales: [&[L; 8]; 2]) {
        for (j, s) in self.jacobian.iter_mut().zip(scales) {
            let x = load6::<L>(j);
            *j = [
                (s[0] * x[0]).store(),
                (s[0] * x[1]).store(),
                (s[0] * x[2]).store(),
                (s[1] * x[3] + s[2] * x[4] + s[4] * x[5]).store(),
                (s[3] * x[4] + s[5] * x[5]).store(),
                (s[6] * x[5]).store(),
            ];
        }
    }

    /// J̃ ũ.
    #[inline(always)]
    fn velocity(&self, u: [&[L; 6]; 2]) -> L {
        dot6(&load6(&self.jacobian[0]), u[0]) + dot6(&load6(&self.jacobian[1]), u[1])
    }

    /// What is left of J̃ ũ − target − bias + Γ λ at an impulse λ.
    #[inline(always)]
    fn residual(&self, mode: Mode, velocity: L, impulse: L) -> L {
        let wanted = L::load(&self.target) + L::load(&self.bias[usize::from(mode == Mode::Relax)]);
        velocity - wanted + (L::load(&self.gamma) + self.softness) * impulse
    }

    #[inline(always)]
    fn clamp(&self, x: L) -> L {
        x.max(L::load(&self.lo)).min(L::load(&self.hi))
    }

    /// Where an impulse x at a bound and what is left of the row's equation ask for the row to give way.
    #[inline(always)]
    fn gives_way(&self, x: L, residual: L) -> L::Mask {
        let (lo, hi) = (L::load(&self.lo), L::load(&self.hi));
        let from_lo = x.le(lo) & residual.lt(L::splat(-RELEASE));
        let from_hi = hi.le(x) & L::splat(RELEASE).lt(residual);
        lo.lt(hi) & (from_lo | from_hi)
    }

    /// Applies impulses along the row. `yields`: the part of their torques that turns each body.
    #[inline(always)]
    fn push(&self, impulse: L, ends: [u32; 2], yields: &[L], velocities: &mut [[L; 6]]) {
        for (j, body) in self.jacobian.iter().zip(ends) {
            let (j, body) = (load6::<L>(j), body as usize);
            let turning = impulse * yields[body];
            let u = &mut velocities[body];
            for k in 0..3 {
                u[k] += j[k] * impulse;
                u[k + 3] += j[k + 3] * turning;
            }
        }
    }

    /// The Jacobian with the angular parts as they turn the bodies.
    #[inline(always)]
    fn response(&self, yields: [&L; 2]) -> [[L; 6]; 2] {
        let mut j = self.jacobian();
        for (j, y) in j.iter_mut().zip(yields) {
            for x in &mut j[3..] {
                *x *= *y;
            }
        }
        j
    }
}

/// What a sweep does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::solve::substep) enum Mode {
    /// Solves, with velocities that correct errors of position.
    Biased,
    /// Solves for velocities alone.
    Relax,
    /// Moves the bodies so that errors of position vanish, but for what is of second order in them: a step of Newton's method, with the
    /// least motion in terms of kinetic energy. Only for rows without bounds that are no springs.
    Project,
}

#[inline(always)]
fn both<T>(list: &[T], ends: [u32; 2]) -> [&T; 2] {
    [&list[ends[0] as usize], &list[ends[1] as usize]]
}

#[inline(always)]
fn load6<L: Lanes>(b: &[L::Block; 6]) -> [L; 6] {
    [L::load(&b[0]), L::load(&b[1]), L::load(&b[2]), L::load(&b[3]), L::load(&b[4]), L::load(&b[5])]
}

#[inline(always)]
fn dot6<L: Lanes>(a: &[L; 6], b: &[L; 6]) -> L {
    (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])
}

/// Articulations of one shape, as many as there are lanes or fewer.
#[derive(Debug)]
pub(super) struct Batch<L: Lanes> {
    /// Which shape they have.
    pub shape: u32,
    members: usize,
    /// Places of their bodies.
    bodies: Vec<L::Index>,
    /// Their joints among the constraints, in the order of elimination, lane by lane; `NIL` for lanes that are left.
    joints: Vec<u32>,
    rows: Vec<LaneRow<L>>,
    /// The rows that have bounds, and their joints.
    bounded: Vec<[u32; 2]>,
    factor: Factor<L>,
    /// Whether the factor has to be made, and whether there are rows of a substep before.
    stale: bool,
    written: bool,
    /// Velocities before the sweep and within it; the last body stands for all that no force moves.
    before: Vec<[L; 6]>,
    velocities: Vec<[L; 6]>,
    scales: Vec<[L; 8]>,
    /// The part of a torque that turns each body: 1 but for links under high tension.
    yields: Vec<L>,
    changes: Vec<L>,
}

impl<L: Lanes> Batch<L> {
    /// One without a shape.
    pub fn new() -> Self {
        Self {
            shape: 0,
            members: 0,
            bodies: Vec::new(),
            joints: Vec::new(),
            rows: Vec::new(),
            bounded: Vec::new(),
            factor: Factor::default(),
            stale: true,
            written: false,
            before: Vec::new(),
            velocities: Vec::new(),
            scales: Vec::new(),
            yields: Vec::new(),
            changes: Vec::new(),
        }
    }

    /// Empties it for articulations of a shape.
    pub fn reset(&mut self, number: u32, shape: &Shape) {
        let mut nobody = L::Index::default();
        nobody.as_mut().fill(NO_RECORD);
        self.shape = number;
        self.members = 0;
        self.bodies.clear();
        self.bodies.resize(shape.bodies, nobody);
        self.joints.clear();
        self.joints.resize(shape.order.len() * L::LANES, NIL);
        self.written = false;
    }

    /// Adds an articulation in the next lane.
    pub fn push(&mut self, shape: &Shape, bodies: &[u32], joints: &[u32]) {
        let lane = self.members;
        self.members += 1;
        for (lanes, body) in self.bodies.iter_mut().zip(bodies) {
            lanes.as_mut()[lane] = *body;
        }
        for (lanes, joint) in self.joints.chunks_exact_mut(L::LANES).zip(&shape.order) {
            lanes[lane] = joints[*joint as usize];
        }
    }

    /// Takes over the rows of a substep, with their impulses: these act along the new rows in place of those before along the old.
    #[inline(always)]
    pub fn load(
        &mut self,
        shape: &Shape,
        joints: &Joints,
        h: Option<f32>,
        scales: &[Cell<Record>],
        velocities: &[Cell<Record>],
    ) {
        let first = !self.written;
        if h.is_some() {
            self.gather(velocities);
        }
        let Self { factor, before, bodies, yields, .. } = self;
        if !first {
            for joint in 0..shape.ends.len() {
                for row in &self.rows[factor.offsets[joint] as usize..factor.offsets[joint + 1] as usize] {
                    row.push(-L::load(&row.impulse), shape.ends[joint], yields, before);
                }
            }
        } else {
            self.scales.clear();
            self.scales.extend(bodies.iter().map(|index| L::gather(scales, index)));
            self.scales.push([L::ZERO; 8]);
        }
        self.take(shape, (&joints.constraints, &joints.rows));
        let Some(h) = h else { return };
        if first {
            self.feel_tension(shape, L::splat(h));
        }
        for joint in 0..shape.ends.len() {
            for row in
                &self.rows[self.factor.offsets[joint] as usize..self.factor.offsets[joint + 1] as usize]
            {
                row.push(L::load(&row.impulse), shape.ends[joint], &self.yields, &mut self.before);
            }
        }
        core::mem::swap(&mut self.before, &mut self.velocities);
        self.scatter(velocities);
        self.written = true;
    }

    /// Makes bodies harder to turn that are under a tension at which the direction of the forces, that of the start of a substep, would be
    /// unstable.
    ///
    /// A force F at an arm r turns a body of inertia I back with ω² = F r/I; h²ω² may not be much larger than 1, the limit being 4. Of the joint's rows
    /// along unit directions e, Σ|r × e|² is 2r², and Σ|S⁻¹-scaled r × e|² over it the mean inverse inertia about axes across r.
    #[inline(always)]
    fn feel_tension(&mut self, shape: &Shape, h: L) {
        let Self { rows, factor, scales, yields, .. } = self;
        yields.clear();
        yields.resize(shape.bodies + 1, L::ZERO);
        for joint in 0..shape.ends.len() {
            let own = &rows[factor.offsets[joint] as usize..factor.offsets[joint + 1] as usize];
            for (side, body) in shape.ends[joint].iter().enumerate() {
                let s = &scales[*body as usize];
                let over = |x: L, d: L| L::select(L::ZERO.lt(d), x / d, L::ZERO);
                let (mut force, mut arms, mut turns) = ([L::ZERO; 3], L::ZERO, L::ZERO);
                for row in own {
                    let j = load6::<L>(&row.jacobian[side]);
                    let unit = [over(j[0], s[0]), over(j[1], s[0]), over(j[2], s[0])];
                    let present = unit[0] * unit[0] + unit[1] * unit[1] + unit[2] * unit[2];
                    for (f, e) in force.iter_mut().zip(unit) {
                        *f += e * L::load(&row.impulse);
                    }
                    // Back to r × e.
                    let z = over(j[5], s[6]);
                    let y = over(j[4] - s[5] * z, s[3]);
                    let x = over(j[3] - s[2] * y - s[4] * z, s[1]);
                    arms += present * (x * x + y * y + z * z);
                    turns += present * (j[3] * j[3] + j[4] * j[4] + j[5] * j[5]);
                }
                let force = (force[0] * force[0] + force[1] * force[1] + force[2] * force[2]).sqrt();
                yields[*body as usize] += over(h * force * turns, (arms + arms).sqrt());
            }
        }
        for y in yields {
            *y = L::select(L::ONE.lt(*y), L::ONE / *y, L::ONE);
        }
    }

    /// Rows as the joints have written them, scaled.
    #[inline(always)]
    fn take(&mut self, shape: &Shape, (constraints, rows): (&[JointConstraint], &[JointRow])) {
        let Self { joints, factor, bounded, .. } = self;
        let range = |joint: u32| {
            constraints.get(joint as usize).map_or(0..0, |c| c.first as usize..(c.first + c.count) as usize)
        };
        let lanes = joints.chunks_exact(L::LANES);
        let sizes =
            lanes.clone().map(|l| l.iter().map(|joint| range(*joint).len() as u32).max().unwrap_or(0));
        factor.reset(shape, sizes);
        self.rows.clear();
        bounded.clear();
        for (joint, lanes) in lanes.enumerate() {
            let first = self.rows.len();
            self.rows.resize(first + factor.size(joint), LaneRow::none());
            let own = &mut self.rows[first..];
            for (lane, constraint) in lanes.iter().enumerate() {
                for (to, from) in own.iter_mut().zip(&rows[range(*constraint)]) {
                    to.set(lane, from);
                }
            }
            let ends = shape.ends[joint];
            for (i, row) in own.iter_mut().enumerate() {
                row.scale(both(&self.scales, ends));
                if row.bounded {
                    bounded.push([(first + i) as u32, joint as u32]);
                }
            }
        }
        self.stale = true;
    }

    /// Gives the impulses back.
    pub fn store(&self, constraints: &[JointConstraint], rows: &mut [JointRow]) {
        for (joint, lanes) in self.joints.chunks_exact(L::LANES).enumerate() {
            let own = &self.rows[self.factor.offsets[joint] as usize..];
            for (lane, constraint) in lanes.iter().enumerate() {
                let Some(c) = constraints.get(*constraint as usize) else { continue };
                for (to, from) in rows[c.first as usize..][..c.count as usize].iter_mut().zip(own) {
                    to.impulse = from.impulse.as_ref()[lane];
                }
            }
        }
    }

    /// One sweep.
    #[inline(always)]
    pub fn sweep(&mut self, shape: &Shape, mode: Mode, velocities: &[Cell<Record>], deltas: &[Cell<Record>]) {
        let project = mode == Mode::Project;
        if project {
            self.before.clear();
            self.before.resize(shape.bodies + 1, [L::ZERO; 6]);
            for row in &mut self.rows {
                row.free = if row.bounded || row.spring { L::ZERO } else { L::ONE };
                row.fixed = L::load(&row.impulse);
            }
            self.stale = true;
        } else {
            self.gather(velocities);
            self.guess(shape, mode);
        }
        for trial in 0..TRIALS {
            if self.stale {
                self.factorise(shape);
            }
            self.solve(shape, mode);
            if project || self.bounded.is_empty() || !self.correct(shape, mode, trial < FREEING) {
                break;
            }
            self.stale = true;
        }
        if project {
            self.move_bodies(deltas);
            return;
        }
        for (row, change) in self.rows.iter_mut().zip(&self.changes) {
            row.impulse = (L::load(&row.impulse) + *change).store();
        }
        self.scatter(velocities);
    }

    /// Adds what was found in place of velocities to the displacements.
    #[inline(always)]
    fn move_bodies(&mut self, deltas: &[Cell<Record>]) {
        for ((index, step), scales) in self.bodies.iter().zip(&self.velocities).zip(&self.scales) {
            let mut delta = L::gather(deltas, index);
            let curve = curve(&delta, step, scales);
            for (k, d) in delta.iter_mut().take(6).enumerate() {
                *d += step[k] + if k < 3 { L::ZERO } else { curve[k - 3] };
            }
            L::scatter(deltas, index, delta);
        }
    }

    /// Before the bodies move by `h` seconds: adds to their rotation vectors what that motion does to them beside being added.
    #[inline(always)]
    pub fn bend(&self, h: f32, velocities: &[Cell<Record>], deltas: &[Cell<Record>]) {
        let h = L::splat(h);
        for (index, scales) in self.bodies.iter().zip(&self.scales) {
            let mut delta = L::gather(deltas, index);
            let [a, b, c, d, e, f, ..] = L::gather(velocities, index);
            let curve = curve(&delta, &[a * h, b * h, c * h, d * h, e * h, f * h], scales);
            for (d, c) in delta[3..6].iter_mut().zip(curve) {
                *d += c;
            }
            L::scatter(deltas, index, delta);
        }
    }

    #[inline(always)]
    fn gather(&mut self, velocities: &[Cell<Record>]) {
        self.before.clear();
        for index in &self.bodies {
            let [a, b, c, d, e, f, ..] = L::gather(velocities, index);
            self.before.push([a, b, c, d, e, f]);
        }
        self.before.push([L::ZERO; 6]);
    }

    #[inline(always)]
    fn scatter(&self, velocities: &[Cell<Record>]) {
        for (index, [a, b, c, d, e, f]) in self.bodies.iter().zip(self.velocities.iter().copied()) {
            L::scatter(velocities, index, [a, b, c, d, e, f, L::ZERO, L::ZERO]);
        }
    }

    /// The matrix of the rows that take part, and its factor.
    #[inline(always)]
    fn factorise(&mut self, shape: &Shape) {
        let Self { rows, factor, yields, .. } = self;
        factor.clear();
        for joint in 0..shape.ends.len() {
            let size = factor.size(joint);
            let own = &mut rows[factor.offsets[joint] as usize..][..size];
            let block = factor.block(joint as u32, size * size);
            for i in 0..size {
                let j = own[i].response(both(yields, shape.ends[joint]));
                let diagonal = own[i].velocity([&j[0], &j[1]]);
                let row = &mut own[i];
                row.softness = diagonal * L::splat(SOFTNESS);
                // A row that is fixed has the equation Δλ = 0.
                block[i * size + i] =
                    (diagonal + row.softness + L::load(&row.gamma)) * row.free + (L::ONE - row.free);
                let free = row.free;
                for k in 0..i {
                    block[i * size + k] = own[k].velocity([&j[0], &j[1]]) * free * own[k].free;
                }
            }
        }
        for product in &shape.products {
            let rows_of = |(joint, side): (u32, u8)| {
                let (joint, size) = (joint as usize, factor.size(joint as usize));
                (&rows[factor.offsets[joint] as usize..][..size], usize::from(side))
            };
            let (a, b) = (rows_of(product.a), rows_of(product.b));
            let columns = b.0.len();
            let block = factor.block(product.target, a.0.len() * columns);
            for (row, out) in a.0.iter().zip(block.chunks_exact_mut(columns.max(1))) {
                let body = shape.ends[product.a.0 as usize][a.1];
                let j = row.response([&yields[body as usize]; 2])[a.1];
                for (other, out) in b.0.iter().zip(out) {
                    *out += dot6(&j, &load6(&other.jacobian[b.1])) * row.free * other.free;
                }
            }
        }
        factor.factorise(shape);
        self.stale = false;
    }

    /// Guesses which rows with bounds take part, from their impulses and the velocities before the sweep.
    #[inline(always)]
    fn guess(&mut self, shape: &Shape, mode: Mode) {
        for [i, joint] in &self.bounded {
            let row = &mut self.rows[*i as usize];
            let velocity = row.velocity(both(&self.before, shape.ends[*joint as usize]));
            let x = L::load(&row.impulse);
            let inside = L::load(&row.lo).lt(x) & x.lt(L::load(&row.hi));
            let free = inside | row.gives_way(x, row.residual(mode, velocity, x));
            let free = L::select(free, L::ONE, L::ZERO);
            self.stale |= (free.lt(row.free) | row.free.lt(free)).any();
            (row.free, row.fixed) = (free, row.clamp(x));
        }
    }

    /// Solves for the changes of the impulses, and changes the velocities by them.
    #[inline(always)]
    fn solve(&mut self, shape: &Shape, mode: Mode) {
        let Self { rows, bounded, factor, before, yields, velocities, changes, .. } = self;
        velocities.clear();
        velocities.extend_from_slice(before);
        changes.clear();
        changes.resize(rows.len(), L::ZERO);
        let fixed = |row: &LaneRow<L>| (row.fixed - L::load(&row.impulse)) * (L::ONE - row.free);
        for [i, joint] in bounded.iter() {
            let row = &rows[*i as usize];
            row.push(fixed(row), shape.ends[*joint as usize], yields, velocities);
        }
        let mut i = 0;
        for joint in 0..shape.ends.len() {
            let u = both(velocities, shape.ends[joint]);
            for row in &rows[i..factor.offsets[joint + 1] as usize] {
                changes[i] = if mode == Mode::Project {
                    L::load(&row.error) * row.free
                } else {
                    -row.residual(mode, row.velocity(u), L::load(&row.impulse)) * row.free
                };
                i += 1;
            }
        }
        factor.solve(shape, changes);
        let mut i = 0;
        for joint in 0..shape.ends.len() {
            for row in &rows[i..factor.offsets[joint + 1] as usize] {
                row.push(changes[i], shape.ends[joint], yields, velocities);
                i += 1;
            }
        }
        for [i, _] in bounded.iter() {
            changes[*i as usize] += fixed(&rows[*i as usize]);
        }
    }

    /// Changes the state of rows that are on the wrong side; whether there were any.
    #[inline(always)]
    fn correct(&mut self, shape: &Shape, mode: Mode, freeing: bool) -> bool {
        let mut wrong = false;
        for [i, joint] in &self.bounded {
            let row = &mut self.rows[*i as usize];
            let velocity = row.velocity(both(&self.velocities, shape.ends[*joint as usize]));
            let new = L::load(&row.impulse) + self.changes[*i as usize];
            let takes_part = L::ZERO.lt(row.free);
            let beyond = takes_part & (new.lt(L::load(&row.lo)) | L::load(&row.hi).lt(new));
            let mut freed = beyond & !beyond;
            if freeing {
                freed = row.gives_way(new, row.residual(mode, velocity, new)) & !takes_part;
            }
            wrong |= (beyond | freed).any();
            row.fixed = L::select(beyond, row.clamp(new), row.fixed);
            row.free = L::select(beyond, L::ZERO, L::select(freed, L::ONE, row.free));
        }
        wrong
    }
}

/// The rotation vector of a rotation by θ followed by one by the small δ is θ + δ + δ × θ/2 + θ × (θ × δ)/12 (Baker, Campbell and
/// Hausdorff; the next term is θ³ × δ/720): the last two, with all in scaled coordinates.
#[inline(always)]
fn curve<L: Lanes>(delta: &[L; 8], step: &[L; 6], s: &[L; 8]) -> [L; 3] {
    let unscaled = |x: &[L]| {
        Vector3::new(s[1] * x[0], s[2] * x[0] + s[3] * x[1], s[4] * x[0] + s[5] * x[1] + s[6] * x[2])
    };
    let (theta, small) = (unscaled(&delta[3..6]), unscaled(&step[3..6]));
    let d = small.cross(theta) * L::splat(0.5) + theta.cross(theta.cross(small)) * L::splat(1.0 / 12.0);
    let over = |x: L, d: L| L::select(L::ZERO.lt(d), x / d, L::ZERO);
    let a = over(d.x, s[1]);
    let b = over(d.y - s[2] * a, s[3]);
    [a, b, over(d.z - s[4] * a - s[5] * b, s[6])]
}
