//! Joints: their rows, written anew in each substep from where the bodies are unless an articulation carries them along, and solved joint by
//! joint.
//!
//! The rows of a joint without bounds are solved as one block, exactly; limits and motors follow one after the other. A
//! row with a CFM of its own is a spring, converted as `soft` says; others spring back as the settings say. When rows change
//! between substeps, so do the bodies' velocities: by the impulses so far along the new rows, less those along the old.

use super::articulation::{CarriedJoint, Rates};
use super::bodies::{SolverBodies, mul_lower_transpose, rotation_of};
use super::manifold::to_f32;
use super::soft::Coefficients;
use crate::Softness;
use crate::arena::{Arena, NIL};
use crate::body::Body;
use crate::carried::is_spring;
use crate::ends::{Ends, Frame, StepContext};
use crate::joint::Joint;
use crate::rows::{JointRows, Row, RowKind, Wrench};
use ferrode_math::Vec3;

/// Slots of a joint whose impulses are remembered.
pub(super) const REMEMBERED: usize = 8;
/// Most rows that are solved as one block.
const BLOCK: usize = 6;

/// The part of its error that a joint of an articulation corrects in a substep.
const EXACT_RATE: f64 = 0.4;
/// Largest speed, in m/s or rad/s, at which it does.
const EXACT_SPEED: f64 = 20.0;

/// A row with scaled Jacobians.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointRow {
    /// In world units for joints of articulations, which scale them themselves.
    pub jacobian: [[f32; 6]; 2],
    /// 1 / (J̃ J̃ᵀ + γ).
    mass: f32,
    /// Wanted velocity.
    pub target: f32,
    /// Velocity that corrects the position, in the biased pass.
    pub bias: f32,
    /// The error of position that an articulation may take out by moving the bodies: none of springs, stops and motors.
    pub error: f32,
    mass_scale: f32,
    impulse_scale: f32,
    pub gamma: f32,
    pub lo: f32,
    pub hi: f32,
    pub impulse: f32,
    slot: u8,
    /// A spring stays one in the relaxing pass.
    pub spring: bool,
}

/// A joint of this step.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointConstraint {
    /// Slot of the joint.
    pub joint: u32,
    /// Dense places of its bodies, or `NIL`.
    pub bodies: [u32; 2],
    /// Its rows.
    pub first: u32,
    pub count: u32,
    /// Whether it is solved as a part of an articulation, and whether the joint is marked so.
    pub exact: bool,
    pub marked: bool,
    /// Number of its rows if an articulation carries them along, three or six, else 0.
    pub carried: u8,
    /// Rows of the block, which come first.
    block: u32,
    /// Inverse of the block's matrix, by rows of its lower triangle.
    inverse: [f32; BLOCK * (BLOCK + 1) / 2],
    /// Place of its forces and first of its rows in world units, if its forces are wanted.
    feedback: u32,
    world: u32,
}

/// What a joint pushed with in the step before, by slots of rows.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct JointMemory {
    pub serial: u64,
    pub impulses: [f32; REMEMBERED],
}

/// When rows are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum When {
    /// In the first substep.
    First,
    /// In another.
    Next,
    /// After the last.
    End,
}

/// The joints of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Joints {
    pub constraints: Vec<JointConstraint>,
    pub rows: Vec<JointRow>,
    before: Vec<JointRow>,
    scratch: Vec<Row>,
    /// Bodies at the ends of joints, and where they are.
    jointed: Vec<u32>,
    frames: Vec<Frame>,
    seen: Vec<bool>,
    /// Jacobians in world units of the joints whose forces are wanted, and the forces.
    world: Vec<[Vec3; 4]>,
    wrenches: Vec<[Wrench; 2]>,
    /// By constraints: what is carried along, and the impulses of its rows.
    pub carried: Vec<CarriedJoint>,
    pub kept: Vec<[f32; 6]>,
    pub rates: Rates,
    /// Whether there are joints outside articulations.
    are_loose: bool,
}

/// What the joints need of the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointContext {
    pub step: StepContext,
    pub substeps: f64,
    pub soft: Coefficients,
    /// Of this step to the one before, in length.
    pub ratio: f32,
    /// Length of a substep.
    part: f64,
    /// What the CFM of a row with the world's ERP adds to the diagonal, as a multiple of that CFM.
    give: f64,
    /// At which articulations correct errors, 1/s.
    exact_rate: f64,
}

impl JointContext {
    pub fn new(step: StepContext, substeps: f64, soft: Coefficients, ratio: f32) -> Self {
        let part = step.h / substeps;
        let give = Softness { erp: step.erp, cfm: 1.0 }.at_substep(substeps).cfm / part;
        Self { step, substeps, soft, ratio, part, give, exact_rate: EXACT_RATE / part }
    }
}

impl Joints {
    /// Starts a step; the constraints are pushed then.
    pub fn clear(&mut self) {
        self.constraints.clear();
        self.rows.clear();
        self.before.clear();
        self.jointed.clear();
        self.world.clear();
        self.wrenches.clear();
    }

    /// Adds a joint between two bodies by their dense places. `exact`: whether it may be solved as a part of an articulation, and
    /// whether it has to.
    pub fn push(&mut self, joint: u32, bodies: [u32; 2], exact: [bool; 2], feedback: bool) {
        let place = if feedback {
            self.wrenches.push([Wrench::default(); 2]);
            self.wrenches.len() as u32 - 1
        } else {
            NIL
        };
        self.constraints.push(JointConstraint {
            joint,
            bodies,
            first: 0,
            count: 0,
            exact: exact[0],
            marked: exact[1],
            carried: 0,
            block: 0,
            inverse: [0.0; BLOCK * (BLOCK + 1) / 2],
            feedback: place,
            world: 0,
        });
    }

    /// Finds the joints whose rows articulations can carry along.
    pub fn find_carried(
        &mut self,
        context: &JointContext,
        bodies: &SolverBodies,
        world: &Arena<Body>,
        joints: &mut Arena<Joint>,
        memory: &[JointMemory],
    ) {
        self.carried.clear();
        self.kept.clear();
        self.rates = Rates {
            correct: context.exact_rate as f32,
            most: EXACT_SPEED as f32,
            substeps: (1.0 / context.part) as f32,
        };
        if !self.constraints.iter().any(|c| c.exact) {
            return;
        }
        self.carried.resize(self.constraints.len(), CarriedJoint::default());
        self.kept.resize(self.constraints.len(), [0.0; 6]);
        for (constraint, place) in self.constraints.iter_mut().zip(&mut self.carried) {
            // Bodies that move by themselves have rows written for them.
            let driven = |body: u32| !bodies.is_movable(body) && body != NIL && bodies.moves(body);
            if !constraint.exact || constraint.feedback != NIL || constraint.bodies.into_iter().any(driven) {
                continue;
            }
            let serial = joints.key_of(constraint.joint).serial;
            let joint = joints.at_mut(constraint.joint);
            let frame = |body: u32| (body != NIL).then(|| &world.at(bodies.slots[body as usize]).frame);
            let [first, second] = constraint.bodies.map(frame);
            let ends = Ends { first, second, reverse: joint.reverse };
            let Some(carried) = joint.kind.model_mut().carried(&ends, &context.step) else { continue };
            let remembered = memory.get(constraint.joint as usize).filter(|m| m.serial == serial);
            let impulses = remembered.map_or([0.0; 6], |m| {
                let [a, b, c, d, e, f, ..] = m.impulses.map(|x| x * context.ratio);
                [a, b, c, d, e, f]
            });
            constraint.carried = if carried.hinge.is_some() { 6 } else { 3 };
            *place = CarriedJoint::new(&carried, context.give, context.part, &impulses);
        }
    }

    /// Whether there are joints that write their rows, in each substep.
    pub fn are_written(&self) -> bool {
        self.constraints.iter().any(|c| c.carried == 0)
    }

    /// Takes note of the bodies at the ends of joints that write their rows.
    pub fn begin(&mut self, bodies: &SolverBodies, world: &Arena<Body>) {
        self.are_loose = self.constraints.iter().any(|c| !c.exact);
        if !self.are_written() {
            return;
        }
        self.seen.clear();
        self.seen.resize(bodies.len(), false);
        self.frames.resize(bodies.len(), Frame::WORLD);
        for constraint in self.constraints.iter().filter(|c| c.carried == 0) {
            for body in constraint.bodies {
                if body != NIL && !core::mem::replace(&mut self.seen[body as usize], true) {
                    self.jointed.push(body);
                    self.frames[body as usize] = world.at(bodies.slots[body as usize]).frame;
                }
            }
        }
    }

    /// Writes the rows of a substep, and makes up for what changed since the one before. Forces that joints add meanwhile act on the
    /// bodies. At the end, only the rows of articulations are written, and nothing acts.
    pub fn rewrite(
        &mut self,
        when: When,
        context: &JointContext,
        bodies: &mut SolverBodies,
        world: &Arena<Body>,
        joints: &mut Arena<Joint>,
        memory: &[JointMemory],
    ) {
        if !self.are_written() {
            return;
        }
        let (first, end) = (when == When::First, when == When::End);
        self.update_frames(first, bodies, world);
        core::mem::swap(&mut self.rows, &mut self.before);
        self.rows.clear();
        self.world.clear();
        for i in 0..self.constraints.len() {
            let mut constraint = self.constraints[i];
            if constraint.carried > 0 {
                continue;
            }
            let old = constraint.first as usize..(constraint.first + constraint.count) as usize;
            let old = if first { 0..0 } else { old };
            let loose = !constraint.exact;
            if end && loose {
                self.constraints[i].first = self.rows.len() as u32;
                self.rows.extend_from_slice(&self.before[old]);
                continue;
            }
            let serial = joints.key_of(constraint.joint).serial;
            let joint = joints.at_mut(constraint.joint);
            let frames = &self.frames;
            let frame = |body: u32| frames.get(body as usize);
            let ends = Ends {
                first: frame(constraint.bodies[0]),
                second: frame(constraint.bodies[1]),
                reverse: joint.reverse,
            };
            let model = joint.kind.model_mut();
            let count = model.row_count(&ends, &context.step).rows;
            self.scratch.clear();
            self.scratch.resize(count, Row::blank(context.step.cfm));
            let mut out = JointRows { rows: &mut self.scratch, forces: [Wrench::default(); 2] };
            model.write_rows(&ends, &context.step, &mut out);
            let forces = out.forces;

            for row in self.before[old.clone()].iter().filter(|_| loose) {
                apply(&row.jacobian, -row.impulse, constraint.bodies, bodies);
            }
            let start = self.rows.len();
            let remembered = (memory.get(constraint.joint as usize).copied())
                .filter(|m| m.serial == serial)
                .unwrap_or_default();
            constraint.world = self.world.len() as u32;
            // Rows without bounds come first, as many as fit the block.
            for bounded in [false, true] {
                for row in &self.scratch {
                    let free = row.lo == f64::NEG_INFINITY && row.hi == f64::INFINITY;
                    let in_block = free && usize::from(row.slot) < BLOCK;
                    if in_block == bounded {
                        continue;
                    }
                    let mut made = JointRow::new(row, &constraint, bodies, context);
                    let slot = usize::from(row.slot);
                    made.impulse = if first {
                        remembered.impulses.get(slot).map_or(0.0, |x| x * context.ratio)
                    } else {
                        self.before[old.clone()]
                            .iter()
                            .find(|b| b.slot == row.slot)
                            .map_or(0.0, |b| b.impulse)
                    };
                    made.impulse = made.impulse.max(made.lo).min(made.hi);
                    if loose {
                        apply(&made.jacobian, made.impulse, constraint.bodies, bodies);
                    }
                    self.rows.push(made);
                    if constraint.feedback != NIL {
                        self.world.push([row.linear1, row.angular1, row.linear2, row.angular2]);
                    }
                }
            }
            constraint.first = start as u32;
            constraint.count = (self.rows.len() - start) as u32;
            if loose {
                constraint.factor(&self.rows[start..]);
            }
            self.constraints[i] = constraint;
            let h = context.step.h / context.substeps;
            for (body, wrench) in constraint.bodies.into_iter().zip(forces).filter(|_| !end) {
                if body != NIL && (wrench.force != Vec3::ZERO || wrench.torque != Vec3::ZERO) {
                    bodies.push_impulse(body as usize, wrench.force * h, wrench.torque * h);
                }
            }
        }
    }

    fn update_frames(&mut self, first: bool, bodies: &SolverBodies, world: &Arena<Body>) {
        if first {
            return;
        }
        for body in &self.jointed {
            let place = *body as usize;
            if !bodies.is_movable(*body) {
                continue;
            }
            let start = &world.at(bodies.slots[place]).frame;
            let frame = &mut self.frames[place];
            let (displacement, rotation) = bodies.displacement(place);
            frame.position = start.position + displacement;
            let q = rotation_of(rotation) * start.quaternion;
            frame.quaternion = q.normalized().unwrap_or(start.quaternion);
            frame.rotation = frame.quaternion.to_matrix();
            (frame.linear_velocity, frame.angular_velocity) = bodies.velocity(place);
        }
    }

    /// Solves each joint once.
    pub fn solve(&mut self, relax: bool, bodies: &mut SolverBodies) {
        if !self.are_loose {
            return;
        }
        for constraint in self.constraints.iter().filter(|c| !c.exact) {
            let rows = &mut self.rows[constraint.first as usize..][..constraint.count as usize];
            let mut u = constraint.bodies.map(|body| bodies.scaled_velocity(body));
            constraint.solve(relax, rows, &mut u);
            for (body, u) in constraint.bodies.into_iter().zip(u) {
                bodies.set_scaled_velocity(body, u);
            }
        }
    }

    /// Adds up what the joints that report it pushed with in this substep.
    pub fn sum_feedback(&mut self) {
        for constraint in self.constraints.iter().filter(|c| c.feedback != NIL) {
            let rows = &self.rows[constraint.first as usize..][..constraint.count as usize];
            let sum = &mut self.wrenches[constraint.feedback as usize];
            for (row, j) in rows.iter().zip(&self.world[constraint.world as usize..]) {
                let impulse = f64::from(row.impulse);
                sum[0].force += j[0] * impulse;
                sum[0].torque += j[1] * impulse;
                sum[1].force += j[2] * impulse;
                sum[1].torque += j[3] * impulse;
            }
        }
    }

    /// Tells joints that ask for it the mean of their forces over a step of `h` seconds.
    pub fn write_feedback(&self, h: f64, joints: &mut Arena<Joint>) {
        for constraint in self.constraints.iter().filter(|c| c.feedback != NIL) {
            let joint = joints.at_mut(constraint.joint);
            let two = joint.nodes[1].body != NIL;
            let Some(feedback) = &mut joint.feedback else { continue };
            let [a, b] = self.wrenches[constraint.feedback as usize];
            let share = 1.0 / h;
            (feedback.force1, feedback.torque1) = (a.force * share, a.torque * share);
            if two {
                (feedback.force2, feedback.torque2) = (b.force * share, b.torque * share);
            }
        }
    }

    /// Number of rows.
    pub fn row_count(&self) -> usize {
        self.rows.len() + self.constraints.iter().map(|c| usize::from(c.carried)).sum::<usize>()
    }

    /// Keeps the impulses for the next step.
    pub fn remember(&self, memory: &mut Vec<JointMemory>, joints: &Arena<Joint>) {
        if self.constraints.is_empty() {
            return;
        }
        memory.resize(joints.capacity(), JointMemory::default());
        for (i, constraint) in self.constraints.iter().enumerate() {
            let kept = &mut memory[constraint.joint as usize];
            *kept = JointMemory { serial: joints.key_of(constraint.joint).serial, ..JointMemory::default() };
            if constraint.carried > 0 {
                kept.impulses[..6].copy_from_slice(&self.kept[i]);
                continue;
            }
            for row in &self.rows[constraint.first as usize..][..constraint.count as usize] {
                if let Some(impulse) = kept.impulses.get_mut(usize::from(row.slot)) {
                    *impulse = row.impulse;
                }
            }
        }
    }
}

/// Applies an impulse along a row.
fn apply(jacobian: &[[f32; 6]; 2], impulse: f32, places: [u32; 2], bodies: &mut SolverBodies) {
    if impulse == 0.0 {
        return;
    }
    for (place, j) in places.into_iter().zip(jacobian) {
        let mut u = bodies.scaled_velocity(place);
        for k in 0..6 {
            u[k] += j[k] * impulse;
        }
        bodies.set_scaled_velocity(place, u);
    }
}

fn dot(a: &[f32; 6], b: &[f32; 6]) -> f32 {
    (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])
}

impl JointRow {
    fn new(row: &Row, constraint: &JointConstraint, bodies: &SolverBodies, context: &JointContext) -> Self {
        let places = constraint.bodies;
        let scaled = |place: u32, linear: Vec3, angular: Vec3| {
            if constraint.exact {
                let ([a, b, c], [d, e, f]) = (to_f32(linear), to_f32(angular));
                return [a, b, c, d, e, f];
            }
            let Some(scale) = bodies.scales.get(place as usize) else { return [0.0; 6] };
            let s = scale.0.map(f64::from);
            let (l, a) = (linear * s[0], mul_lower_transpose(&[s[1], s[2], s[3], s[4], s[5], s[6]], angular));
            [l.x, l.y, l.z, a.x, a.y, a.z].map(|x| x as f32)
        };
        let jacobian =
            [scaled(places[0], row.linear1, row.angular1), scaled(places[1], row.linear2, row.angular2)];
        // Bodies that move but can't be moved, and their part of J v.
        let drift = |place: u32, linear: Vec3, angular: Vec3| match bodies.motions.get(place as usize) {
            Some(motion) if !bodies.is_movable(place) => {
                let m = motion.0.map(f64::from);
                linear.dot(Vec3::new(m[0], m[1], m[2])) + angular.dot(Vec3::new(m[3], m[4], m[5]))
            }
            _ => 0.0,
        };
        let still = drift(places[0], row.linear1, row.angular1) + drift(places[1], row.linear2, row.angular2);

        let step = &context.step;
        let h = context.part;
        // What of c corrects the position, and what is a wanted velocity.
        let bounces = row.restitution_target != 0.0 && row.c == row.restitution_target;
        let velocity = if bounces { row.c } else { row.velocity_target };
        let error = row.position_error;
        let own = row.kind != RowKind::Motor && is_spring(row.cfm, step);
        let (rate, most, gamma) = if own {
            let erp = if error != 0.0 { (row.c - velocity) * step.h / error } else { step.erp };
            let part = Softness { erp, cfm: row.cfm }.at_substep(context.substeps);
            (part.erp / h, f64::INFINITY, part.cfm / h)
        } else if constraint.exact {
            (context.exact_rate, EXACT_SPEED, row.cfm.max(0.0) * context.give)
        } else {
            (f64::from(context.soft.bias_rate), f64::INFINITY, row.cfm.max(0.0) * context.give)
        };
        let gamma = gamma as f32;
        // An articulation has a matrix of its own.
        let k = if constraint.exact {
            0.0
        } else {
            dot(&jacobian[0], &jacobian[0]) + dot(&jacobian[1], &jacobian[1]) + gamma
        };
        Self {
            jacobian,
            mass: if k > 0.0 { 1.0 / k } else { 0.0 },
            target: (velocity - still) as f32,
            bias: if bounces { 0.0 } else { (rate * error).clamp(-most, most) as f32 },
            error: if own || row.kind != RowKind::Joint { 0.0 } else { error as f32 },
            mass_scale: if own || row.kind == RowKind::Motor { 1.0 } else { context.soft.mass_scale },
            impulse_scale: if own || row.kind == RowKind::Motor { 0.0 } else { context.soft.impulse_scale },
            gamma,
            lo: (row.lo * h) as f32,
            hi: (row.hi * h) as f32,
            impulse: 0.0,
            slot: row.slot,
            spring: own,
        }
    }

    /// J̃ ũ − target, and in the biased pass the correction.
    fn residual(&self, relax: bool, u: &[[f32; 6]; 2]) -> f32 {
        let v = dot(&self.jacobian[0], &u[0]) + dot(&self.jacobian[1], &u[1]) - self.target;
        let v = v + self.gamma * self.impulse;
        if relax && !self.spring { v } else { v - self.bias }
    }

    fn scales(&self, relax: bool) -> (f32, f32) {
        if relax { (1.0, 0.0) } else { (self.mass_scale, self.impulse_scale) }
    }

    fn push(&self, change: f32, u: &mut [[f32; 6]; 2]) {
        for (u, j) in u.iter_mut().zip(&self.jacobian) {
            for k in 0..6 {
                u[k] += j[k] * change;
            }
        }
    }
}

/// Place of row i, column j ≤ i in a lower triangle.
fn at(i: usize, j: usize) -> usize {
    i * (i + 1) / 2 + j
}

impl JointConstraint {
    /// Inverts the matrix of the rows without bounds.
    fn factor(&mut self, rows: &[JointRow]) {
        let free = |row: &&JointRow| row.lo == f32::NEG_INFINITY && row.hi == f32::INFINITY;
        let n = rows.iter().take(BLOCK).take_while(free).count();
        self.block = n as u32;
        let mut l = [[0.0f64; BLOCK]; BLOCK];
        for i in 0..n {
            for j in 0..=i {
                let (a, b) = (&rows[i].jacobian, &rows[j].jacobian);
                l[i][j] = f64::from(dot(&a[0], &b[0])) + f64::from(dot(&a[1], &b[1]));
            }
            // Rows that say the same twice share the impulse.
            l[i][i] += f64::from(rows[i].gamma) + 1e-6 * l[i][i];
        }
        // Cholesky: K = L Lᵀ. A row that nothing moves has a zero pivot, and no part in the inverse.
        for i in 0..n {
            for j in 0..=i {
                let mut sum = l[i][j];
                let (row, other) = (l[i], l[j]);
                for (x, y) in row[..j].iter().zip(&other[..j]) {
                    sum -= x * y;
                }
                l[i][j] = if i == j { if sum > 0.0 { 1.0 / sum.sqrt() } else { 0.0 } } else { sum * l[j][j] };
            }
        }
        // K⁻¹ = L⁻ᵀ L⁻¹; the diagonal of `l` holds reciprocals.
        let mut inverse = [[0.0f64; BLOCK]; BLOCK];
        for column in 0..n {
            inverse[column][column] = l[column][column];
            for i in column + 1..n {
                let mut sum = 0.0;
                for k in column..i {
                    sum -= l[i][k] * inverse[k][column];
                }
                inverse[i][column] = sum * l[i][i];
            }
        }
        for i in 0..n {
            for j in 0..=i {
                let mut sum = 0.0;
                for row in &inverse[i..n] {
                    sum += row[i] * row[j];
                }
                self.inverse[at(i, j)] = sum as f32;
            }
        }
    }

    fn solve(&self, relax: bool, rows: &mut [JointRow], u: &mut [[f32; 6]; 2]) {
        let n = self.block as usize;
        let (block, bounded) = rows.split_at_mut(n);
        let mut residual = [0.0f32; BLOCK];
        for (r, row) in residual.iter_mut().zip(block.iter()) {
            *r = row.residual(relax, u);
        }
        for (i, row) in block.iter_mut().enumerate() {
            let mut x = 0.0;
            for (j, r) in residual[..n].iter().enumerate() {
                x += self.inverse[if j <= i { at(i, j) } else { at(j, i) }] * r;
            }
            let (mass_scale, impulse_scale) = row.scales(relax);
            let change = -mass_scale * x - impulse_scale * row.impulse;
            row.impulse += change;
            row.push(change, u);
        }
        for row in bounded {
            let (mass_scale, impulse_scale) = row.scales(relax);
            let change = -row.mass * mass_scale * row.residual(relax, u) - impulse_scale * row.impulse;
            let new = (row.impulse + change).max(row.lo).min(row.hi);
            let change = new - row.impulse;
            row.impulse = new;
            row.push(change, u);
        }
    }
}
