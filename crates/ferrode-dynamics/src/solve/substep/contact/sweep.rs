//! The passes over the contacts.

use super::extra::Extra;
use super::vector::{Motion, load3};
use super::{Batch, Batches, Pass, restitution};
use crate::solve::substep::bodies::SolverBodies;
use core::any::Any;
use ferrode_math::Vector3;
use ferrode_math::simd::{Kernel, Lanes, Record, Work};
use ferrode_math::stage::{Crew, Lot, Touch};

/// One pass over all batches.
pub(super) struct Sweep<'a> {
    pub batches: &'a mut (dyn Any + Send + Sync),
    pub crew: &'a Crew,
    pub bodies: &'a mut SolverBodies,
    pub pass: Pass,
    /// Length of a substep.
    pub h: f32,
    /// Since the start of the step.
    pub elapsed: f32,
}

/// What a pass reads beside the rows.
#[derive(Clone, Copy)]
struct Scene<'a, L> {
    deltas: &'a [Record],
    inv_h: L,
    elapsed: L,
}

impl Kernel for Sweep<'_> {
    type Out = ();

    fn run<L: Lanes>(self) {
        let Some(batches) = self.batches.downcast_mut::<Batches<L>>() else { return };
        let SolverBodies { velocities, deltas, .. } = self.bodies;
        let (pass, h, elapsed, deltas) = (self.pass, self.h, self.elapsed, deltas.as_slice());
        let mut rest = batches.list.as_mut_slice();
        let mut first = 0;
        for (number, group) in batches.groups.iter().enumerate() {
            let end = batches.ends[group.clone()].last().copied().unwrap_or(first);
            let (list, after) = rest.split_at_mut(end - first);
            (rest, first) = (after, end);
            batches.bodies.sweep(self.crew, number, list, velocities, |lot| {
                L::enter(SweepLot { lot, pass, deltas, h, elapsed });
            });
        }
    }
}

/// A pass over some batches.
struct SweepLot<'a, L: Lanes> {
    lot: Lot<'a, L, Batch<L>>,
    pass: Pass,
    deltas: &'a [Record],
    h: f32,
    elapsed: f32,
}

impl<L: Lanes> Work<L> for SweepLot<'_, L> {
    #[inline(always)]
    fn run(mut self) {
        let scene =
            Scene { deltas: self.deltas, inv_h: L::splat(1.0 / self.h), elapsed: L::splat(self.elapsed) };
        for i in 0..self.lot.len() {
            let (batch, touch) = self.lot.get(i);
            // Taken out meanwhile, so that both can be changed.
            let mut kept = if batch.special { batch.extra.take() } else { None };
            match (self.pass, kept.as_deref_mut()) {
                (Pass::WarmStart, extra) => warm_start(batch, extra, &touch),
                (Pass::Biased, None) => solve::<L, false, false>(batch, None, &touch, &scene),
                (Pass::Biased, extra) => solve::<L, false, true>(batch, extra, &touch, &scene),
                (Pass::Relax, None) => solve::<L, true, false>(batch, None, &touch, &scene),
                (Pass::Relax, extra) => solve::<L, true, true>(batch, extra, &touch, &scene),
                (Pass::Restitution, None) => {}
                (Pass::Restitution, Some(extra)) => restitution::solve(batch, extra, &touch),
            }
            if kept.is_some() {
                batch.extra = kept;
            }
        }
    }
}

/// The velocities of a batch's bodies, and how impulses change them.
pub(super) struct Pair<L: Lanes> {
    pub a: Motion<L>,
    pub b: Motion<L>,
    scale: [L; 2],
}

impl<L: Lanes> Pair<L> {
    #[inline(always)]
    pub fn gather(batch: &Batch<L>, touch: &Touch<'_, L>) -> Self {
        Self {
            a: Motion::from_record(touch.gather(0)),
            b: Motion::from_record(touch.gather(1)),
            scale: [L::load(&batch.scale[0]), L::load(&batch.scale[1])],
        }
    }

    #[inline(always)]
    pub fn scatter(self, touch: &Touch<'_, L>) {
        touch.scatter(0, self.a.to_record());
        touch.scatter(1, self.b.to_record());
    }

    /// Relative velocity of the centres.
    #[inline(always)]
    pub fn relative(&self) -> Vector3<L> {
        self.a.linear * self.scale[0] - self.b.linear * self.scale[1]
    }

    /// J̃ ũ of the angular part of a row.
    #[inline(always)]
    pub fn angular(&self, row: &[Vector3<L>; 2]) -> L {
        row[0].dot(self.a.angular) + row[1].dot(self.b.angular)
    }

    /// Applies an impulse at the centres.
    #[inline(always)]
    pub fn push(&mut self, impulse: Vector3<L>) {
        self.a.linear += impulse * self.scale[0];
        self.b.linear -= impulse * self.scale[1];
    }

    /// Applies an impulse to the angular part of a row.
    #[inline(always)]
    pub fn turn(&mut self, row: &[Vector3<L>; 2], impulse: L) {
        self.a.angular += row[0] * impulse;
        self.b.angular += row[1] * impulse;
    }

    /// J̃ J̃ᵀ of the linear part of a row.
    #[inline(always)]
    pub fn inv_mass(&self) -> L {
        self.scale[0] * self.scale[0] + self.scale[1] * self.scale[1]
    }
}

#[inline(always)]
fn load_row<L: Lanes>(row: &[super::Block3<L>; 2]) -> [Vector3<L>; 2] {
    [load3::<L>(&row[0]), load3::<L>(&row[1])]
}

// By name, not by `map`: that takes its array by value, and its closures don't inherit the instruction set unless they happen to be
// inlined.
#[inline(always)]
fn load3a<L: Lanes>(b: &super::Block3<L>) -> [L; 3] {
    [L::load(&b[0]), L::load(&b[1]), L::load(&b[2])]
}

#[inline(always)]
fn load2a<L: Lanes>(b: &[L::Block; 2]) -> [L; 2] {
    [L::load(&b[0]), L::load(&b[1])]
}

#[inline(always)]
fn warm_start<L: Lanes>(batch: &Batch<L>, extra: Option<&mut Extra<L>>, touch: &Touch<'_, L>) {
    let mut pair = Pair::gather(batch, touch);
    let (n, t1) = (load3::<L>(&batch.normal), load3::<L>(&batch.tangent));
    let t2 = n.cross(t1);
    let f = &batch.friction;
    let impulse = load3a::<L>(&f.impulse);
    let mut sum = t1 * impulse[0] + t2 * impulse[1];
    for (row, impulse) in f.angular.iter().zip(impulse) {
        pair.turn(&load_row::<L>(row), impulse);
    }
    for row in &batch.points[..batch.count as usize] {
        let impulse = L::load(&row.impulse);
        pair.turn(&load_row::<L>(&row.angular), impulse);
        sum += n * impulse;
    }
    pair.push(sum);
    if let Some(extra) = extra {
        for (row, impulse) in extra.rolling.iter().zip(&extra.rolling_impulse) {
            pair.turn(&load_row::<L>(row), L::load(impulse));
        }
    }
    pair.scatter(touch);
}

#[inline(always)]
fn clamp<L: Lanes>(x: L, bound: L) -> L {
    x.max(-bound).min(bound)
}

/// Friction first, then the normals, so that non-penetration has the last word.
#[inline(always)]
fn solve<L: Lanes, const RELAX: bool, const SPECIAL: bool>(
    batch: &mut Batch<L>,
    mut extra: Option<&mut Extra<L>>,
    touch: &Touch<'_, L>,
    scene: &Scene<'_, L>,
) {
    let mut pair = Pair::gather(batch, touch);
    let n = load3::<L>(&batch.normal);
    let count = batch.count as usize;
    let mut normal_impulse = L::ZERO;
    for row in &batch.points[..count] {
        normal_impulse += L::load(&row.impulse);
    }

    if SPECIAL && let Some(extra) = extra.as_deref_mut() {
        roll(extra, &mut pair, normal_impulse);
        special_friction(batch, extra, &mut pair, n, normal_impulse);
    } else {
        friction(batch, &mut pair, n, normal_impulse);
    }

    // Displacement of the centres since the start of the step, along the normal.
    let (mut shift, mut deltas) = (L::ZERO, None);
    if RELAX {
        let moved = Pair {
            a: Motion::from_record(touch.gather_from(scene.deltas, 0)),
            b: Motion::from_record(touch.gather_from(scene.deltas, 1)),
            scale: pair.scale,
        };
        shift = n.dot(moved.relative());
        deltas = Some(moved);
    }
    let mut velocity = n.dot(pair.relative());
    let inv_mass = pair.inv_mass();
    let (mass_scale, impulse_scale) = (L::load(&batch.mass_scale), L::load(&batch.impulse_scale));
    let (bias_rate, push_out) = (L::load(&batch.bias_rate), L::load(&batch.push_out));
    let mut total = L::ZERO;
    for (k, row) in batch.points[..count].iter_mut().enumerate() {
        let angular = load_row::<L>(&row.angular);
        let mut separation = L::load(&row.separation);
        if let Some(moved) = &deltas {
            separation = L::load(&row.separation0) + shift + moved.angular(&angular);
            if SPECIAL && let Some(extra) = extra.as_deref() {
                separation += L::load(&extra.drift[k]) * scene.elapsed;
            }
            row.separation = separation.store();
        }
        let mut v = velocity + pair.angular(&angular);
        if SPECIAL && let Some(extra) = extra.as_deref() {
            v += L::load(&extra.drift[k]) - L::load(&extra.lift);
        }
        let apart = L::ZERO.lt(separation);
        // A point apart may close its gap within the substep, no faster.
        let gap = separation * scene.inv_h;
        let mass = L::load(&row.mass);
        let old = L::load(&row.impulse);
        let change = if RELAX {
            let bias = L::select(apart, gap, L::ZERO);
            let mut change = -(mass * (v + bias));
            if SPECIAL && let Some(extra) = extra.as_deref() {
                // A spring stays one; it has no part that overshoots.
                let gamma = L::load(&extra.gamma);
                let soft = mass / (L::ONE + gamma * mass);
                let back = (bias_rate * separation).max(-push_out);
                let sprung = -(soft * (v + back + gamma * old));
                change = L::select(L::ZERO.lt(gamma) & !apart, sprung, change);
            }
            change
        } else {
            let back = (bias_rate * separation).max(-push_out);
            let bias = L::select(apart, gap, back);
            let m = L::select(apart, L::ONE, mass_scale);
            let i = L::select(apart, L::ZERO, impulse_scale);
            let mut change = -(mass * m * (v + bias)) - i * old;
            if SPECIAL && let Some(extra) = extra.as_deref() {
                let gamma = L::load(&extra.gamma);
                let soft = mass / (L::ONE + gamma * mass);
                let sprung = -(soft * (v + bias + gamma * old));
                change = L::select(L::ZERO.lt(gamma) & !apart, sprung, change);
            }
            change
        };
        let new = (old + change).max(L::ZERO);
        let change = new - old;
        row.impulse = new.store();
        if SPECIAL && let Some(extra) = extra.as_deref_mut() {
            extra.peak[k] = L::load(&extra.peak[k]).max(new).store();
        }
        velocity += change * inv_mass;
        total += change;
        pair.turn(&angular, change);
    }
    pair.push(n * total);
    pair.scatter(touch);
}

/// Coulomb friction, the same in all directions.
#[inline(always)]
fn friction<L: Lanes>(batch: &mut Batch<L>, pair: &mut Pair<L>, n: Vector3<L>, normal_impulse: L) {
    let t1 = load3::<L>(&batch.tangent);
    let t2 = n.cross(t1);
    let f = &mut batch.friction;
    let rows = [load_row::<L>(&f.angular[0]), load_row::<L>(&f.angular[1]), load_row::<L>(&f.angular[2])];
    let bound = L::load(&f.mu) * normal_impulse;

    let relative = pair.relative();
    let v1 = t1.dot(relative) + pair.angular(&rows[0]);
    let v2 = t2.dot(relative) + pair.angular(&rows[1]);
    let m = load3a::<L>(&f.mass);
    let old = load3a::<L>(&f.impulse);
    let new1 = old[0] - (m[0] * v1 + m[1] * v2);
    let new2 = old[1] - (m[1] * v1 + m[2] * v2);
    let square = new1 * new1 + new2 * new2;
    let beyond = (bound * bound).lt(square);
    let shrink = L::select(beyond, bound / L::select(beyond, square, L::ONE).sqrt(), L::ONE);
    let (new1, new2) = (new1 * shrink, new2 * shrink);
    let (d1, d2) = (new1 - old[0], new2 - old[1]);
    pair.push(t1 * d1 + t2 * d2);
    pair.turn(&rows[0], d1);
    pair.turn(&rows[1], d2);

    let spin = pair.angular(&rows[2]);
    let new3 = clamp(old[2] - L::load(&f.twist_mass) * spin, bound * L::load(&f.radius));
    pair.turn(&rows[2], new3 - old[2]);
    f.impulse = [new1.store(), new2.store(), new3.store()];
}

/// Friction with an ellipse of bounds, slip, surface motion and spinning friction.
#[inline(always)]
fn special_friction<L: Lanes>(
    batch: &mut Batch<L>,
    extra: &Extra<L>,
    pair: &mut Pair<L>,
    n: Vector3<L>,
    normal_impulse: L,
) {
    let t1 = load3::<L>(&batch.tangent);
    let t2 = n.cross(t1);
    let f = &mut batch.friction;
    let rows = [load_row::<L>(&f.angular[0]), load_row::<L>(&f.angular[1]), load_row::<L>(&f.angular[2])];
    let bound = |i: usize| {
        let bound = &extra.bounds[i];
        L::load(&bound.coefficient) * normal_impulse + L::load(&bound.constant)
    };
    let (b1, b2) = (bound(0), bound(1));
    let offset = load3a::<L>(&extra.offset);
    let slip = load2a::<L>(&extra.slip);
    let m = load3a::<L>(&f.mass);
    let old = load3a::<L>(&f.impulse);

    let relative = pair.relative();
    let v1 = t1.dot(relative) + pair.angular(&rows[0]) + offset[0] + slip[0] * old[0];
    let v2 = t2.dot(relative) + pair.angular(&rows[1]) + offset[1] + slip[1] * old[1];
    let new1 = old[0] - (m[0] * v1 + m[1] * v2);
    let new2 = old[1] - (m[1] * v1 + m[2] * v2);
    let (new1, new2) = within_ellipse(new1, new2, b1, b2);
    let (d1, d2) = (new1 - old[0], new2 - old[1]);
    pair.push(t1 * d1 + t2 * d2);
    pair.turn(&rows[0], d1);
    pair.turn(&rows[1], d2);

    let spin = pair.angular(&rows[2]) + offset[2];
    // What the points' friction holds, with the smaller of the coefficients, and spinning friction.
    let grip = b1.min(b2) * L::load(&f.radius) + bound(2);
    let new3 = clamp(old[2] - L::load(&f.twist_mass) * spin, grip);
    pair.turn(&rows[2], new3 - old[2]);
    f.impulse = [new1.store(), new2.store(), new3.store()];
}

/// Rolling friction.
#[inline(always)]
fn roll<L: Lanes>(extra: &mut Extra<L>, pair: &mut Pair<L>, normal_impulse: L) {
    let rows = [load_row::<L>(&extra.rolling[0]), load_row::<L>(&extra.rolling[1])];
    let bound = |i: usize| {
        let bound = &extra.rolling_bounds[i];
        L::load(&bound.coefficient) * normal_impulse + L::load(&bound.constant)
    };
    let (b1, b2) = (bound(0), bound(1));
    let old = load2a::<L>(&extra.rolling_impulse);
    let mass = load2a::<L>(&extra.rolling_mass);
    let new1 = old[0] - mass[0] * pair.angular(&rows[0]);
    let new2 = old[1] - mass[1] * pair.angular(&rows[1]);
    let (new1, new2) = within_ellipse(new1, new2, b1, b2);
    pair.turn(&rows[0], new1 - old[0]);
    pair.turn(&rows[1], new2 - old[1]);
    extra.rolling_impulse = [new1.store(), new2.store()];
}

/// The point (x, y), drawn towards the centre onto the ellipse with the given half axes if it lies beyond.
#[inline(always)]
fn within_ellipse<L: Lanes>(x: L, y: L, a: L, b: L) -> (L, L) {
    let (a_open, b_open) = (L::ZERO.lt(a), L::ZERO.lt(b));
    let u = L::select(a_open, x / L::select(a_open, a, L::ONE), L::ZERO);
    let v = L::select(b_open, y / L::select(b_open, b, L::ONE), L::ZERO);
    let (x, y) = (L::select(a_open, x, L::ZERO), L::select(b_open, y, L::ZERO));
    let square = u * u + v * v;
    let beyond = L::ONE.lt(square);
    let shrink = L::select(beyond, L::ONE / L::select(beyond, square, L::ONE).sqrt(), L::ONE);
    (x * shrink, y * shrink)
}
