//! Bodies as the kernels see them: scaled so that every mass is one.
//!
//! With the inverse mass s² and a factor S of the inverse inertia, S Sᵀ = I⁻¹ (Cholesky, world axes), the kernels work on
//!
//! ```text
//! ṽ = v / s      ω̃ = S⁻¹ ω        so that        J M⁻¹ Jᵀ = J̃ J̃ᵀ      with J̃ = (s n, Sᵀ (r × n))
//! ```
//!
//! One vector per row then serves to measure the velocity and to apply the impulse, ṽ += J̃ᵀ λ, without masses, and a body
//! that can't be moved has J̃ = 0 by itself. Displacements since the start of the step are kept the same way, in `f32`:
//! positions stay `f64` outside, so it makes no difference how far from the origin a body is.

use super::manifold::to_f32;
use crate::arena::Arena;
use crate::body::Body;
use core::sync::atomic::{AtomicBool, Ordering};
use ferrode_math::simd::{NO_RECORD, Record};
use ferrode_math::stage::{Crew, chunks};
use ferrode_math::{Mat3, Quat, Vec3, real};

/// Bodies of one task, in what is done body by body.
pub(super) const SHARE: usize = 256;

/// The bodies of a step in dense arrays.
#[derive(Clone, Debug, Default)]
pub(super) struct SolverBodies {
    /// The world's slots.
    pub slots: Vec<u32>,
    /// ṽ and ω̃.
    pub velocities: Vec<Record>,
    /// Displacement and rotation since the start of the step, scaled alike.
    pub deltas: Vec<Record>,
    /// s, then S by rows below the diagonal: 00, 10, 11, 20, 21, 22.
    pub scales: Vec<Record>,
    /// Acceleration by forces, scaled.
    accelerations: Vec<Record>,
    /// Velocity before the impulses of the current substep.
    references: Vec<Record>,
    /// Impulses of all substeps so far.
    totals: Vec<Record>,
    /// v and ω as they are, at the start of the step; for what no force moves.
    pub motions: Vec<Record>,
    /// Whether forces of the caller's act on a body.
    pub pushed: Vec<bool>,
    /// Where bodies are, from `origin`, which is where the first one is.
    pub centres: Vec<[f32; 3]>,
    pub origin: Vec3,
}

impl SolverBodies {
    /// Starts a step; the slots are pushed then, and [filled in](Self::fill).
    pub fn clear(&mut self) {
        self.slots.clear();
    }

    fn resize(&mut self) {
        let count = self.slots.len();
        self.pushed.resize(count, false);
        self.centres.resize(count, [0.0; 3]);
        for list in [
            &mut self.velocities,
            &mut self.deltas,
            &mut self.scales,
            &mut self.accelerations,
            &mut self.references,
            &mut self.totals,
            &mut self.motions,
        ] {
            list.resize(count, Record::ZERO);
        }
    }

    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Takes the bodies of `slots` in, at the start of a step of `h` seconds.
    pub fn fill(&mut self, crew: &Crew, world: &Arena<Body>, gravity: Vec3, h: f64) -> Gathered {
        self.resize();
        let (unusable, watched) = (AtomicBool::new(false), AtomicBool::new(false));
        let origin = self.slots.first().map_or(Vec3::ZERO, |slot| world.at(*slot).frame.position);
        self.origin = origin;
        let Self { slots, velocities, deltas, scales, accelerations, references, totals, motions, .. } = self;
        let (pushed, centres) = (&mut self.pushed, &mut self.centres);
        let moving = (chunks(velocities, SHARE), chunks(deltas, SHARE), chunks(references, SHARE));
        let still = (chunks(scales, SHARE), chunks(accelerations, SHARE), chunks(motions, SHARE));
        let other = (chunks(pushed, SHARE), chunks(centres, SHARE));
        let lists = (moving, still, chunks(totals, SHARE), other);
        crew.each(lists, |share, (moving, still, totals, (pushed, centres))| {
            let (velocities, deltas, references) = moving;
            let (scales, accelerations, motions) = still;
            deltas.fill(Record::ZERO);
            references.fill(Record::ZERO);
            totals.fill(Record::ZERO);
            for (i, slot) in slots[share * SHARE..].iter().take(velocities.len()).enumerate() {
                let body = world.at(*slot);
                if body.enabled && !body.quarantined && !body.is_finite() {
                    unusable.store(true, Ordering::Relaxed);
                }
                if body.moved.is_some() {
                    watched.store(true, Ordering::Relaxed);
                }
                centres[i] = to_f32(body.frame.position - origin);
                pushed[i] = body.force != Vec3::ZERO || body.torque != Vec3::ZERO;
                let known = Known::new(body, gravity, h);
                (velocities[i], scales[i]) = (known.velocity, known.scale);
                (accelerations[i], motions[i]) = (known.acceleration, known.motion);
            }
        });
        Gathered { unusable: unusable.into_inner(), watched: watched.into_inner() }
    }

    /// Begins a substep of `h` seconds: forces act, and the impulses that held in the one before act again.
    ///
    /// What the constraints did to a body in a substep is the sum of their impulses, so it needs no pass over the
    /// constraints to apply them again.
    pub fn integrate_velocities(&mut self, crew: &Crew, h: f32, first: bool) {
        let Self { velocities, references, totals, accelerations, .. } = self;
        let accelerations = accelerations.as_slice();
        let lists = (chunks(velocities, SHARE), chunks(references, SHARE), chunks(totals, SHARE));
        crew.each(lists, |share, (velocities, references, totals)| {
            let lists =
                velocities.iter_mut().zip(references).zip(&accelerations[share * SHARE..]).zip(totals);
            // Whole records at a time, which compilers keep in vectors.
            for (((u, reference), a), total) in lists {
                let (before, a) = (u.0, a.0);
                let impulse: [f32; 8] =
                    if first { [0.0; 8] } else { core::array::from_fn(|k| before[k] - reference.0[k]) };
                let after: [f32; 8] = core::array::from_fn(|k| before[k] + h * a[k]);
                total.0 = core::array::from_fn(|k| total.0[k] + impulse[k]);
                u.0 = core::array::from_fn(|k| after[k] + impulse[k]);
                reference.0 = after;
            }
        });
    }

    /// Moves the bodies by `h` seconds.
    pub fn integrate_positions(&mut self, crew: &Crew, h: f32) {
        let velocities = self.velocities.as_slice();
        crew.each(chunks(&mut self.deltas, SHARE), |share, deltas| {
            for (delta, u) in deltas.iter_mut().zip(&velocities[share * SHARE..]) {
                let (before, u) = (delta.0, u.0);
                delta.0 = core::array::from_fn(|k| before[k] + h * u[k]);
            }
        });
    }

    /// What the step did to a body: change of velocity by constraints, displacement and rotation, in world units.
    pub fn outcome(&self, body: usize) -> Outcome {
        let (u, reference) = (&self.velocities[body].0, &self.references[body].0);
        let total = &self.totals[body].0;
        let change: [f64; 6] = core::array::from_fn(|k| f64::from(total[k]) + f64::from(u[k] - reference[k]));
        let delta = self.deltas[body].0.map(f64::from);
        let scale = self.scales[body].0.map(f64::from);
        let s = scale[0];
        let factor = [scale[1], scale[2], scale[3], scale[4], scale[5], scale[6]];
        Outcome {
            linear: Vec3::new(change[0], change[1], change[2]) * s,
            angular: mul_lower(&factor, Vec3::new(change[3], change[4], change[5])),
            displacement: Vec3::new(delta[0], delta[1], delta[2]) * s,
            rotation: mul_lower(&factor, Vec3::new(delta[3], delta[4], delta[5])),
        }
    }

    /// Gives a body the velocity and pose at the end of a step of `h` seconds.
    pub fn advance(&self, place: usize, body: &mut Body, gravity: Vec3, h: f64) {
        let frame = &mut body.frame;
        if body.inv_mass > 0.0 {
            let outcome = self.outcome(place);
            let force = if body.gravity_mode { body.force + gravity * body.mass.mass } else { body.force };
            let torque = self.free_rotation(place, h);
            frame.linear_velocity += force * (body.inv_mass * h) + outcome.linear;
            frame.angular_velocity += torque + outcome.angular;
            frame.position += outcome.displacement;
            let q = rotation_of(outcome.rotation) * frame.quaternion;
            frame.quaternion = q.normalized().unwrap_or(q);
        } else {
            frame.position += frame.linear_velocity * h;
            let q = rotation_of(frame.angular_velocity * h) * frame.quaternion;
            frame.quaternion = q.normalized().unwrap_or(q);
        }
        frame.rotation = frame.quaternion.to_matrix();
        body.pose_version = body.pose_version.wrapping_add(1);
        crate::integrate::limit_angular_speed(body);
    }

    /// The displacement and rotation of a body so far, in world units.
    pub fn displacement(&self, body: usize) -> (Vec3, Vec3) {
        let outcome = self.outcome(body);
        (outcome.displacement, outcome.rotation)
    }

    /// The velocity of a body now, in world units.
    pub fn velocity(&self, body: usize) -> (Vec3, Vec3) {
        let u = self.velocities[body].0.map(f64::from);
        let scale = self.scales[body].0.map(f64::from);
        let factor = [scale[1], scale[2], scale[3], scale[4], scale[5], scale[6]];
        (Vec3::new(u[0], u[1], u[2]) * scale[0], mul_lower(&factor, Vec3::new(u[3], u[4], u[5])))
    }

    /// What torques that are no constraint's do to a body's angular velocity in `h` seconds.
    pub fn free_rotation(&self, body: usize, h: f64) -> Vec3 {
        let a = self.accelerations[body].0.map(f64::from);
        let scale = self.scales[body].0.map(f64::from);
        let factor = [scale[1], scale[2], scale[3], scale[4], scale[5], scale[6]];
        mul_lower(&factor, Vec3::new(a[3], a[4], a[5]) * h)
    }

    /// Twice the kinetic energy per mass, m²/s².
    pub fn energy_per_mass(&self, body: usize) -> f32 {
        let u = &self.velocities[body].0;
        let s = self.scales[body].0[0];
        (u[0] * u[0] + u[1] * u[1] + u[2] * u[2] + (u[3] * u[3] + u[4] * u[4] + u[5] * u[5])) * (s * s)
    }

    /// Whether forces move a body.
    pub fn is_movable(&self, body: u32) -> bool {
        self.scales.get(body as usize).is_some_and(|scale| scale.0[0] > 0.0)
    }

    /// Whether a body that forces don't move moves by itself.
    pub fn moves(&self, body: u32) -> bool {
        self.motions.get(body as usize).is_some_and(|motion| motion.0 != [0.0; 8])
    }

    /// The record that the kernels read for a body: none for what no force moves.
    pub fn record(&self, body: u32) -> u32 {
        if self.is_movable(body) { body } else { NO_RECORD }
    }
}

/// What was seen of the bodies taken in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gathered {
    /// One is not finite.
    pub unusable: bool,
    /// One has a callback.
    pub watched: bool,
}

/// A body at the start of a step.
struct Known {
    velocity: Record,
    scale: Record,
    acceleration: Record,
    motion: Record,
}

impl Known {
    fn new(body: &Body, gravity: Vec3, h: f64) -> Self {
        let (v, w) = (body.frame.linear_velocity, body.frame.angular_velocity);
        let record = |linear: Vec3, angular: Vec3| {
            let [a, b, c] = to_f32(linear);
            let [d, e, f] = to_f32(angular);
            Record([a, b, c, d, e, f, 0.0, 0.0])
        };
        let motion = record(v, w);
        if body.is_kinematic() || body.quarantined {
            return Self { velocity: Record::ZERO, scale: Record::ZERO, acceleration: Record::ZERO, motion };
        }
        let mut force = body.force;
        if body.gravity_mode {
            force += gravity * body.mass.mass;
        }
        let torque = body.torque + body.gyroscopic(h);
        let s = body.inv_mass.sqrt();
        let factor = inertia_factor(&body.frame.rotation, &body.inv_inertia);
        let [s00, s10, s11, s20, s21, s22] = factor;
        Self {
            velocity: record(v * (1.0 / s), solve_lower(&factor, w)),
            scale: Record([s, s00, s10, s11, s20, s21, s22, 0.0].map(|x| x as f32)),
            // s F, and Sᵀ τ.
            acceleration: record(force * s, mul_lower_transpose(&factor, torque)),
            motion,
        }
    }
}

/// What a step did to a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outcome {
    pub linear: Vec3,
    pub angular: Vec3,
    pub displacement: Vec3,
    pub rotation: Vec3,
}

/// A lower triangular matrix by rows.
pub(super) type Lower = [f64; 6];

/// The factor S of R I⁻¹ Rᵀ, given I⁻¹ in the body's frame.
fn inertia_factor(r: &Mat3, inv_inertia: &Mat3) -> Lower {
    let i = &inv_inertia.rows;
    let isotropic = i[0][0] == i[1][1]
        && i[1][1] == i[2][2]
        && [i[0][1], i[0][2], i[1][0], i[1][2], i[2][0], i[2][1]].iter().all(|x| *x == 0.0);
    if isotropic {
        let s = i[0][0].sqrt();
        return [s, 0.0, s, 0.0, 0.0, s];
    }
    let world = *r * *inv_inertia * r.transpose();
    let a = &world.rows;
    // A pivot that rounding has put below zero stands for a direction that nothing turns.
    let root = |x: f64| if x > 0.0 { x.sqrt() } else { 0.0 };
    let over = |x: f64, d: f64| if d > 0.0 { x / d } else { 0.0 };
    let s00 = root(a[0][0]);
    let (s10, s20) = (over(a[1][0], s00), over(a[2][0], s00));
    let s11 = root(a[1][1] - s10 * s10);
    let s21 = over(a[2][1] - s20 * s10, s11);
    let s22 = root(a[2][2] - s20 * s20 - s21 * s21);
    [s00, s10, s11, s20, s21, s22]
}

/// S x.
pub(super) fn mul_lower(s: &Lower, x: Vec3) -> Vec3 {
    Vec3::new(s[0] * x.x, s[1] * x.x + s[2] * x.y, s[3] * x.x + s[4] * x.y + s[5] * x.z)
}

/// Sᵀ x.
pub(super) fn mul_lower_transpose(s: &Lower, x: Vec3) -> Vec3 {
    Vec3::new(s[0] * x.x + s[1] * x.y + s[3] * x.z, s[2] * x.y + s[4] * x.z, s[5] * x.z)
}

/// S⁻¹ x.
fn solve_lower(s: &Lower, x: Vec3) -> Vec3 {
    let over = |x: f64, d: f64| if d > 0.0 { x / d } else { 0.0 };
    let a = over(x.x, s[0]);
    let b = over(x.y - s[1] * a, s[2]);
    let c = over(x.z - s[3] * a - s[4] * b, s[5]);
    Vec3::new(a, b, c)
}

impl SolverBodies {
    /// ũ of a body; zero for none.
    #[inline(always)]
    pub fn scaled_velocity(&self, body: u32) -> [f32; 6] {
        match self.velocities.get(body as usize) {
            Some(Record([a, b, c, d, e, f, ..])) => [*a, *b, *c, *d, *e, *f],
            None => [0.0; 6],
        }
    }

    #[inline(always)]
    pub fn set_scaled_velocity(&mut self, body: u32, u: [f32; 6]) {
        if let Some(record) = self.velocities.get_mut(body as usize) {
            record.0[..6].copy_from_slice(&u);
        }
    }

    /// Gives a body an impulse and an impulse of torque, in world units. It is no constraint's, so it does not act again in
    /// the next substep.
    pub fn push_impulse(&mut self, body: usize, linear: Vec3, angular: Vec3) {
        let scale = self.scales[body].0.map(f64::from);
        let factor = [scale[1], scale[2], scale[3], scale[4], scale[5], scale[6]];
        let (l, a) = (linear * scale[0], mul_lower_transpose(&factor, angular));
        let [a, b, c, d, e, f] = [l.x, l.y, l.z, a.x, a.y, a.z].map(|x| x as f32);
        for (k, x) in [a, b, c, d, e, f].into_iter().enumerate() {
            self.velocities[body].0[k] += x;
            self.references[body].0[k] += x;
            // Joints' own forces count with what the constraints did.
            self.totals[body].0[k] += x;
        }
    }
}

/// The unit quaternion of a rotation vector.
///
/// tan(θ/2)/(θ/2) by its series: exact to 1e-7 for a third of a radian, which is 20 rad/s at 60 Hz; the functions
/// themselves beyond.
pub(super) fn rotation_of(v: Vec3) -> Quat {
    let square = v.length_squared();
    if square < 0.1 {
        let k = 0.5 * (1.0 + square * (1.0 / 12.0 + square * (1.0 / 120.0 + square * (17.0 / 20160.0))));
        let q = Quat::from_parts(1.0, v * k);
        return q.scale(1.0 / q.dot(q).sqrt());
    }
    let half = 0.5 * square.sqrt();
    Quat::from_parts(real::cos(half), v * (0.5 * real::sinc(half)))
}
