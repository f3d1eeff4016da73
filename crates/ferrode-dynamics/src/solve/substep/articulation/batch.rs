//! Articulations of one shape, solved side by side.
//!
//! With the velocities ũ before the sweep, impulses change by the solution of
//!
//! ```text
//! (J̃ J̃ᵀ + Γ) Δλ = −(J̃ ũ − target − bias + Γ λ)
//! ```
//!
//! Γ holds the CFM of springs and, for all rows, 10⁻⁶ of the diagonal, by which rows that say the same share the load. The
//! factorisation is backward stable: what is left of the right side is of the size of rounding, whatever the condition, and each sweep begins with what
//! is left.
//!
//! Rows with bounds (stops, motors) that hold take part like the others; those at a bound leave the equations, their impulse fixed. Which
//! is which is found by trying: rows that end beyond a bound are put there, rows at a bound that ought to give way are freed, and the
//! factor is made again.

use super::carry::{self, Motion, Rates, Start};
use super::factor::{self, Block, Factor};
use super::plan::{NODE, Plan};
use super::row::{Bound, LaneRow, Role, SOFTNESS, Written, angular, linear};
use super::shape::{JointEnds, Shape};
use super::triple::{add, cross, dot, over, scaled, unscaled, without_trifles};
use crate::arena::NIL;
use crate::solve::substep::joints::{JointConstraint, JointRow, Joints};
use core::cell::Cell;
use ferrode_math::simd::{Lanes, Mask, NO_RECORD, Record};

/// Trials in which rows may be freed; after them rows are only put to their bounds.
const FREEING: usize = 6;
/// Most trials.
const TRIALS: usize = 16;

/// Of scaled velocities: parts of 10⁻⁷ of it are rounded away.
const VELOCITY_TRIFLE: f32 = 1e-10;

/// What a sweep does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::solve::substep) enum Mode {
    /// Solves, with velocities that correct errors of position, for bodies that move with them for so many seconds then.
    Biased(f32),
    /// Solves for velocities alone.
    Relax,
    /// Moves the bodies so that errors of position vanish, but for what is of second order in them: a step of Newton's method, with the
    /// least motion in terms of kinetic energy. Only for rows without bounds that are no springs.
    Project,
}

/// The same joint of several articulations.
#[derive(Clone, Copy, Debug)]
struct LaneJoint<L> {
    /// Its bodies; the last one stands for all that no force moves.
    ends: JointEnds,
    /// Its first row, and its nodes.
    first: usize,
    nodes: usize,
    linear: Linear<L>,
}

/// The linear parts of a joint's scaled Jacobians.
#[derive(Clone, Copy, Debug)]
enum Linear<L> {
    /// The first three rows hold two points together along x, y and z, others turn only: the bodies' scales.
    Points([L; 2]),
    /// Any, from this place in the list.
    Any(usize),
}

#[inline(always)]
fn both<T>(list: &[T], ends: JointEnds) -> [&T; 2] {
    [&list[ends[0] as usize], &list[ends[1] as usize]]
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
    list: Vec<LaneJoint<L>>,
    starts: Vec<Start<L>>,
    rows: Vec<LaneRow<L>>,
    /// Linear parts of rows, of joints where these are not known by themselves.
    linear: Vec<[[L; 3]; 2]>,
    /// Whether all rows of a node are without bounds and are no springs.
    plain: Vec<bool>,
    bounds: Vec<Bound<L>>,
    plan: Plan,
    factor: Factor<L>,
    /// Whether the articulations are others than those that the plan was made for.
    fresh: bool,
    /// Whether the factor has to be made.
    stale: bool,
    /// Velocities before the sweep and within it; the last body stands for all that no force moves.
    before: Vec<[L; 6]>,
    velocities: Vec<[L; 6]>,
    scales: Vec<[L; 8]>,
    /// Inverses of the diagonal of the scales of rotation.
    unscales: Vec<[L; 3]>,
    /// √y and its inverse, with the part y of a torque that turns each body: 1 but for links under high tension. In here the bodies'
    /// scales of rotation have √y in them.
    yields: Vec<[L; 2]>,
    motions: Vec<Motion<L>>,
    /// By nodes: right side, then change of impulses.
    changes: Vec<[L; 3]>,
}

impl<L: Lanes> Batch<L> {
    /// One without a shape.
    pub fn new() -> Self {
        Self {
            shape: 0,
            members: 0,
            bodies: Vec::new(),
            joints: Vec::new(),
            list: Vec::new(),
            starts: Vec::new(),
            rows: Vec::new(),
            linear: Vec::new(),
            plain: Vec::new(),
            bounds: Vec::new(),
            plan: Plan::default(),
            factor: Factor::default(),
            fresh: true,
            stale: true,
            before: Vec::new(),
            velocities: Vec::new(),
            scales: Vec::new(),
            unscales: Vec::new(),
            yields: Vec::new(),
            motions: Vec::new(),
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
        self.fresh = true;
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

    /// Begins a step of substeps of `h` seconds: takes the joints over, and applies the impulses that they start with.
    #[inline(always)]
    pub fn begin(
        &mut self,
        shape: &Shape,
        joints: &Joints,
        h: f32,
        scales: &[Cell<Record>],
        velocities: &[Cell<Record>],
    ) {
        self.scales.clear();
        for index in &self.bodies {
            self.scales.push(L::gather(scales, index));
        }
        self.scales.push([L::ZERO; 8]);
        self.yields.clear();
        self.yields.resize(shape.bodies + 1, [L::ONE; 2]);
        self.motions.clear();
        self.motions.resize(shape.bodies + 1, Motion::NONE);
        self.take(shape, joints, true);
        self.feel_tension(L::splat(h));
        self.unscales.clear();
        for s in &self.scales {
            self.unscales.push([over(L::ONE, s[1]), over(L::ONE, s[3]), over(L::ONE, s[6])]);
        }
        self.gather(velocities);
        self.push_all(L::ONE);
        self.scatter(velocities);
    }

    /// Takes the rows to where the bodies have moved; and if they are to `act`, their impulses with them.
    #[inline(always)]
    pub fn advance(
        &mut self,
        shape: &Shape,
        joints: &Joints,
        act: bool,
        velocities: &[Cell<Record>],
        deltas: &[Cell<Record>],
    ) {
        let mixed = self.starts.len() < self.list.len();
        if act {
            self.gather(velocities);
            if mixed {
                self.push_all(-L::ONE);
            }
        }
        for (i, index) in self.bodies.iter().enumerate() {
            let [a, b, c, d, e, f, ..] = L::gather(deltas, index);
            let inverse = self.yields[i][1];
            let delta = [a, b, c, d * inverse, e * inverse, f * inverse];
            self.motions[i] = Motion::new(&delta, &self.scales[i]);
        }
        if mixed {
            self.take(shape, joints, false);
            if act {
                self.push_all(L::ONE);
            }
        } else {
            self.follow(joints.rates, act);
        }
        if act {
            self.scatter(velocities);
        }
        self.stale = true;
    }

    /// Writes carried rows, all that there are, anew; the change of their push acts if it is to.
    #[inline(always)]
    fn follow(&mut self, rates: Rates, act: bool) {
        let Self { list, starts, rows, motions, scales, velocities, .. } = self;
        for (joint, start) in list.iter().zip(starts) {
            let own = &mut rows[joint.first..][..joint.nodes * NODE];
            let motions = both(motions, joint.ends);
            if !act {
                start.write(rates, motions, both(scales, joint.ends), own);
                continue;
            }
            let mut turned = [[L::ZERO; 3]; 2];
            for row in own.iter() {
                for (t, a) in turned.iter_mut().zip(&row.angular) {
                    for (t, a) in t.iter_mut().zip(a) {
                        *t -= *a * row.impulse;
                    }
                }
            }
            start.write(rates, motions, both(scales, joint.ends), own);
            for row in own.iter() {
                for (t, a) in turned.iter_mut().zip(&row.angular) {
                    for (t, a) in t.iter_mut().zip(a) {
                        *t += *a * row.impulse;
                    }
                }
            }
            for (t, body) in turned.iter().zip(joint.ends) {
                for (u, t) in velocities[body as usize][3..].iter_mut().zip(t) {
                    *u += *t;
                }
            }
        }
    }

    /// Takes over the rows that joints have written, and those that are carried along; of the latter, after the `first` substep, with the impulses
    /// that they have.
    #[inline(always)]
    fn take(&mut self, shape: &Shape, joints: &Joints, first: bool) {
        let Self { list, starts, rows, linear, plain, bounds, plan, motions, scales, .. } = self;
        let range = |joint: u32| {
            let constraint = joints.constraints.get(joint as usize);
            constraint.map_or(0..0, |c| c.first as usize..(c.first + c.count) as usize)
        };
        let mut kept = Vec::new();
        if !first {
            let carried = list.iter().filter(|joint| matches!(joint.linear, Linear::Points(_)));
            kept.extend(
                carried.flat_map(|joint| &rows[joint.first..][..joint.nodes * NODE]).map(|r| r.impulse),
            );
        }
        let mut kept = kept.into_iter();
        list.clear();
        starts.clear();
        rows.clear();
        linear.clear();
        bounds.clear();
        for (joint, lanes) in self.joints.chunks_exact(L::LANES).enumerate() {
            let ends = shape.ends[joint];
            let (first_row, number) = (rows.len(), joint as u32);
            let scale = both(scales, ends);
            // All lanes are of one kind: it belongs to the shape.
            let kind = joints.constraints.get(lanes[0] as usize).map_or(0, |c| c.carried);
            if kind > 0 {
                rows.resize(first_row + usize::from(kind), LaneRow::new(Role::Plain));
                let own = &mut rows[first_row..];
                let (start, [lo, hi]) =
                    carry::take(lanes.iter().map(|c| joints.carried.get(*c as usize)), own);
                if own.len() > NODE {
                    let driven = lo.lt(hi).any();
                    own[5].role = if driven { Role::Bounded } else { Role::Filling };
                    if driven {
                        bounds.push(Bound {
                            row: first_row as u32 + 5,
                            joint: number,
                            lo,
                            hi,
                            fixed: L::ZERO,
                        });
                    } else {
                        own[5].free = L::ZERO;
                    }
                }
                for (row, impulse) in own.iter_mut().zip(&mut kept) {
                    row.impulse = impulse;
                }
                start.write(joints.rates, both(motions, ends), scale, own);
                starts.push(start);
                let points = Linear::Points([scale[0][0], scale[1][0]]);
                list.push(LaneJoint { ends, first: first_row, nodes: own.len() / NODE, linear: points });
                continue;
            }
            let size = lanes.iter().map(|c| range(*c).len()).max().unwrap_or(0);
            let nodes = size.div_ceil(NODE);
            list.push(LaneJoint { ends, first: first_row, nodes, linear: Linear::Any(linear.len()) });
            for i in 0..size {
                let mut written = Written::<L>::new();
                for (lane, constraint) in lanes.iter().enumerate() {
                    if let Some(row) = joints.rows[range(*constraint)].get(i) {
                        written.set(lane, row);
                    }
                }
                let (mut row, mut pushes, [lo, hi]) = written.row();
                for side in 0..2 {
                    row.angular[side] = scaled(scale[side], &row.angular[side]);
                    for x in &mut pushes[side] {
                        *x *= scale[side][0];
                    }
                }
                if row.role == Role::Bounded {
                    bounds.push(Bound { row: rows.len() as u32, joint: number, lo, hi, fixed: L::ZERO });
                }
                rows.push(row);
                linear.push(pushes);
            }
            rows.resize(first_row + nodes * NODE, LaneRow::new(Role::Filling));
            linear.resize(linear.len() + nodes * NODE - size, [[L::ZERO; 3]; 2]);
        }
        plain.clear();
        plain.extend(rows.chunks_exact(NODE).map(|node| node.iter().all(|row| row.role == Role::Plain)));
        plan.prepare(shape, self.fresh, list.iter().map(|joint| joint.nodes as u32));
        self.fresh = false;
        self.changes.resize(plan.nodes(), [L::ZERO; 3]);
        self.stale = true;
    }

    /// Makes bodies harder to turn that are under a tension at which the direction of the forces, that of the start of a substep, would be
    /// unstable.
    ///
    /// A force F at an arm r turns a body of inertia I back with ω² = F r/I; h²ω² may not be much larger than 1, the limit being 4. Of the joint's rows
    /// along unit directions e, Σ|r × e|² is 2r², and Σ|S⁻¹-scaled r × e|² over it the mean inverse inertia about axes across r.
    #[inline(always)]
    fn feel_tension(&mut self, h: L) {
        let Self { list, rows, linear, scales, yields, .. } = self;
        let mut tight = vec![L::ZERO; yields.len()];
        for joint in list.iter() {
            let own = &rows[joint.first..][..joint.nodes * NODE];
            for (side, body) in joint.ends.into_iter().enumerate() {
                let s = &scales[body as usize];
                let (mut force, mut arms, mut turns) = ([L::ZERO; 3], L::ZERO, L::ZERO);
                for (i, row) in own.iter().enumerate() {
                    let unit = match joint.linear {
                        Linear::Points(_) => unit_of::<L>(i, s[0]),
                        Linear::Any(at) => {
                            let l = &linear[at + i][side];
                            [over(l[0], s[0]), over(l[1], s[0]), over(l[2], s[0])]
                        }
                    };
                    let present = dot(&unit, &unit);
                    for (f, e) in force.iter_mut().zip(unit) {
                        *f += e * row.impulse;
                    }
                    // Back to r × e.
                    let j = &row.angular[side];
                    let z = over(j[2], s[6]);
                    let y = over(j[1] - s[5] * z, s[3]);
                    let x = over(j[0] - s[2] * y - s[4] * z, s[1]);
                    arms += present * (x * x + y * y + z * z);
                    turns += present * dot(j, j);
                }
                tight[body as usize] += over(h * dot(&force, &force).sqrt() * turns, (arms + arms).sqrt());
            }
        }
        let mut any = false;
        for ((y, tight), s) in yields.iter_mut().zip(tight).zip(scales.iter_mut()) {
            let part = L::select(L::ONE.lt(tight), L::ONE / tight, L::ONE).sqrt();
            any |= part.lt(L::ONE).any();
            *y = [part, L::ONE / part];
            for s in &mut s[1..7] {
                *s *= part;
            }
        }
        if any {
            for joint in list.iter() {
                for row in &mut rows[joint.first..][..joint.nodes * NODE] {
                    for (j, body) in row.angular.iter_mut().zip(joint.ends) {
                        let part = yields[body as usize][0];
                        *j = [j[0] * part, j[1] * part, j[2] * part];
                    }
                }
            }
        }
    }

    /// Gives the impulses back.
    #[inline(always)]
    pub fn store(&self, constraints: &[JointConstraint], rows: &mut [JointRow], kept: &mut [[f32; 6]]) {
        for (joint, lanes) in self.list.iter().zip(self.joints.chunks_exact(L::LANES)) {
            let own = &self.rows[joint.first..][..joint.nodes * NODE];
            for (lane, constraint) in lanes.iter().enumerate() {
                let Some(c) = constraints.get(*constraint as usize) else { continue };
                if c.carried > 0 {
                    for (to, from) in kept[*constraint as usize].iter_mut().zip(own) {
                        *to = from.impulse.store().as_ref()[lane];
                    }
                    continue;
                }
                for (to, from) in rows[c.first as usize..][..c.count as usize].iter_mut().zip(own) {
                    to.impulse = from.impulse.store().as_ref()[lane];
                }
            }
        }
    }

    /// One sweep.
    #[inline(always)]
    pub fn sweep(&mut self, mode: Mode, velocities: &[Cell<Record>], deltas: &[Cell<Record>]) {
        let project = mode == Mode::Project;
        if project {
            self.velocities.clear();
            self.velocities.resize(self.bodies.len() + 1, [L::ZERO; 6]);
            for row in &mut self.rows {
                row.free = if row.role == Role::Plain { L::ONE } else { L::ZERO };
            }
            for bound in &mut self.bounds {
                bound.fixed = self.rows[bound.row as usize].impulse;
            }
            self.stale |= !self.bounds.is_empty();
        } else {
            self.gather(velocities);
            self.guess(mode);
        }
        if !self.bounds.is_empty() {
            self.before.clone_from(&self.velocities);
        }
        for trial in 0..TRIALS {
            if self.stale {
                self.factorise();
            }
            if trial > 0 {
                self.velocities.clone_from(&self.before);
            }
            self.solve(mode);
            if project || self.bounds.is_empty() || !self.correct(mode, trial < FREEING) {
                break;
            }
            self.stale = true;
        }
        if project {
            self.move_bodies(deltas);
            return;
        }
        for (node, change) in self.rows.chunks_exact_mut(NODE).zip(&self.changes) {
            for (row, change) in node.iter_mut().zip(change) {
                row.impulse += *change;
            }
        }
        if let Mode::Biased(h) = mode {
            self.bend(h, deltas);
        }
        self.scatter(velocities);
    }

    /// Adds what was found in place of velocities to the displacements.
    #[inline(always)]
    fn move_bodies(&mut self, deltas: &[Cell<Record>]) {
        for (i, index) in self.bodies.iter().enumerate() {
            let (step, [root, inverse]) = (&self.velocities[i], self.yields[i]);
            let mut delta = L::gather(deltas, index);
            let curve = curve(&delta, inverse, &angular(step), &self.scales[i], &self.unscales[i]);
            for k in 0..3 {
                delta[k] += step[k];
                delta[k + 3] += (step[k + 3] + curve[k]) * root;
            }
            L::scatter(deltas, index, delta);
        }
    }

    /// Before the bodies move by `h` seconds: adds to their rotation vectors what that motion does to them beside being added.
    #[inline(always)]
    fn bend(&self, h: f32, deltas: &[Cell<Record>]) {
        let h = L::splat(h);
        for (i, index) in self.bodies.iter().enumerate() {
            let ([.., d, e, f], [root, inverse]) = (self.velocities[i], self.yields[i]);
            let mut delta = L::gather(deltas, index);
            let curve = curve(&delta, inverse, &[d * h, e * h, f * h], &self.scales[i], &self.unscales[i]);
            for k in 0..3 {
                delta[k + 3] += curve[k] * root;
            }
            L::scatter(deltas, index, delta);
        }
    }

    #[inline(always)]
    fn gather(&mut self, velocities: &[Cell<Record>]) {
        self.velocities.clear();
        let unit = L::splat(VELOCITY_TRIFLE);
        for (index, [_, inverse]) in self.bodies.iter().zip(&self.yields) {
            let [a, b, c, d, e, f, ..] = L::gather(velocities, index);
            let [a, b, c] = without_trifles(&[a, b, c], unit);
            let [d, e, f] = without_trifles(&[d * *inverse, e * *inverse, f * *inverse], unit);
            self.velocities.push([a, b, c, d, e, f]);
        }
        self.velocities.push([L::ZERO; 6]);
    }

    #[inline(always)]
    fn scatter(&self, velocities: &[Cell<Record>]) {
        for ((index, [a, b, c, d, e, f]), [root, _]) in
            self.bodies.iter().zip(&self.velocities).zip(&self.yields)
        {
            let numbers = [*a, *b, *c, *d * *root, *e * *root, *f * *root, L::ZERO, L::ZERO];
            L::scatter(velocities, index, numbers);
        }
    }

    /// The matrix of the rows that take part, and its factor.
    #[inline(always)]
    fn factorise(&mut self) {
        let Self { list, rows, linear, plain, plan, factor, .. } = self;
        factor.begin(plan);
        for (number, (joint, first)) in list.iter().zip(&plan.first).enumerate() {
            for i in 0..joint.nodes {
                for j in 0..=i {
                    let a = node(rows, joint, i);
                    let b = node(rows, joint, j);
                    let mut block = if i == j {
                        add_products(&turning_squares(a, 0), &turning_squares(a, 1))
                    } else {
                        add_products(&turning_products(a, b, [0, 0]), &turning_products(a, b, [1, 1]))
                    };
                    match joint.linear {
                        Linear::Points([s, t]) if i == 0 => {
                            let mass = s * s + t * t;
                            block = [
                                block[0] + mass,
                                block[1],
                                block[2],
                                block[3],
                                block[4] + mass,
                                block[5],
                                block[6],
                                block[7],
                                block[8] + mass,
                            ];
                        }
                        Linear::Points(_) => {}
                        Linear::Any(at) => {
                            for side in 0..2 {
                                for k in 0..NODE {
                                    for l in 0..NODE {
                                        let (a, b) = (&linear[at + i * NODE + k], &linear[at + j * NODE + l]);
                                        block[k * NODE + l] += dot(&a[side], &b[side]);
                                    }
                                }
                            }
                        }
                    }
                    let (row, column) = (*first as usize + i, *first as usize + j);
                    if !plain[row] || !plain[column] {
                        mask(&mut block, a, b);
                    }
                    if i == j {
                        for (k, row) in rows[joint.first + i * NODE..][..NODE].iter_mut().enumerate() {
                            let diagonal = block[k * NODE + k];
                            row.softness = diagonal * L::splat(SOFTNESS);
                            // A row that is fixed has the equation Δλ = 0.
                            block[k * NODE + k] =
                                (diagonal + row.softness + row.gamma) * row.free + (L::ONE - row.free);
                        }
                    }
                    factor.blocks[plan.own(number, i, j)] = block;
                }
            }
        }
        for product in &plan.products {
            let ((p, i, x), (q, j, y)) = (product.a, product.b);
            let (one, two) = (&list[p as usize], &list[q as usize]);
            let (i, j, sides) = (i as usize, j as usize, [usize::from(x), usize::from(y)]);
            let (a, b) = (node(rows, one, i), node(rows, two, j));
            let mut block = turning_products(a, b, sides);
            match (one.linear, two.linear) {
                (Linear::Points(s), Linear::Points(t)) => {
                    if i == 0 && j == 0 {
                        let mass = s[sides[0]] * t[sides[1]];
                        let mass = if x == y { mass } else { -mass };
                        block = [
                            block[0] + mass,
                            block[1],
                            block[2],
                            block[3],
                            block[4] + mass,
                            block[5],
                            block[6],
                            block[7],
                            block[8] + mass,
                        ];
                    }
                }
                _ => {
                    for k in 0..NODE {
                        for l in 0..NODE {
                            let a = linear_part(one, linear, i * NODE + k, sides[0]);
                            let b = linear_part(two, linear, j * NODE + l, sides[1]);
                            block[k * NODE + l] += dot(&a, &b);
                        }
                    }
                }
            }
            if !plain[plan.first[p as usize] as usize + i] || !plain[plan.first[q as usize] as usize + j] {
                mask(&mut block, a, b);
            }
            let target = &mut factor.blocks[product.target as usize];
            *target = if product.again { add_products(target, &block) } else { block };
        }
        factor.factorise(plan);
        self.stale = false;
    }

    /// J̃ ũ of a row.
    #[inline(always)]
    fn velocity(&self, bound: &Bound<L>, velocities: &[[L; 6]]) -> L {
        let joint = &self.list[bound.joint as usize];
        let (row, u) = (bound.row as usize, both(velocities, joint.ends));
        let (turning, place) = (self.rows[row].turning(u), row - joint.first);
        // Rows about the axis of a hinge.
        if place >= NODE && matches!(joint.linear, Linear::Points(_)) {
            return turning;
        }
        let parts = [linear_part(joint, &self.linear, place, 0), linear_part(joint, &self.linear, place, 1)];
        turning + (dot(&parts[0], &linear(u[0])) + dot(&parts[1], &linear(u[1])))
    }

    /// Guesses which rows with bounds take part, from their impulses and the velocities before the sweep.
    #[inline(always)]
    fn guess(&mut self, mode: Mode) {
        for i in 0..self.bounds.len() {
            let mut bound = self.bounds[i];
            let velocity = self.velocity(&bound, &self.velocities);
            self.stale |= bound.guess(&mut self.rows[bound.row as usize], mode, velocity);
            self.bounds[i] = bound;
        }
    }

    /// Changes the state of rows that are on the wrong side; whether there were any.
    #[inline(always)]
    fn correct(&mut self, mode: Mode, freeing: bool) -> bool {
        let mut wrong = false;
        for i in 0..self.bounds.len() {
            let mut bound = self.bounds[i];
            let velocity = self.velocity(&bound, &self.velocities);
            let place = bound.row as usize;
            let new = self.rows[place].impulse + self.changes[place / NODE][place % NODE];
            wrong |= bound.correct(&mut self.rows[place], mode, velocity, new, freeing);
            self.bounds[i] = bound;
        }
        wrong
    }

    /// Solves for the changes of the impulses, and changes the velocities by them.
    #[inline(always)]
    fn solve(&mut self, mode: Mode) {
        let Self { list, rows, linear, bounds, plan, factor, velocities, changes, .. } = self;
        for bound in bounds.iter() {
            let (joint, place) = (&list[bound.joint as usize], bound.row as usize);
            let mut x = [L::ZERO; NODE];
            x[place % NODE] = fixed(&rows[place], bound);
            push(joint, rows, linear, (place - joint.first) / NODE, &x, velocities);
        }
        for (joint, first) in list.iter().zip(&plan.first) {
            let u = both(velocities, joint.ends);
            for i in 0..joint.nodes {
                let own = node(rows, joint, i);
                let x = &mut changes[*first as usize + i];
                if mode == Mode::Project {
                    *x = [own[0].error * own[0].free, own[1].error * own[1].free, own[2].error * own[2].free];
                    continue;
                }
                let mut v = [own[0].turning(u), own[1].turning(u), own[2].turning(u)];
                match joint.linear {
                    Linear::Points([s, t]) if i == 0 => {
                        for k in 0..NODE {
                            v[k] += s * u[0][k] - t * u[1][k];
                        }
                    }
                    Linear::Points(_) => {}
                    Linear::Any(at) => {
                        for k in 0..NODE {
                            let l = &linear[at + i * NODE + k];
                            v[k] +=
                                dot(&l[0], &super::row::linear(u[0])) + dot(&l[1], &super::row::linear(u[1]));
                        }
                    }
                }
                for k in 0..NODE {
                    x[k] = -own[k].residual(mode, v[k], own[k].impulse) * own[k].free;
                }
                *x = without_trifles(x, L::splat(factor::TRIFLE));
            }
        }
        factor.solve(plan, changes);
        for (joint, first) in list.iter().zip(&plan.first) {
            for i in 0..joint.nodes {
                push(joint, rows, linear, i, &changes[*first as usize + i], velocities);
            }
        }
        for bound in bounds.iter() {
            let place = bound.row as usize;
            changes[place / NODE][place % NODE] += fixed(&rows[place], bound);
        }
    }

    /// Applies all impulses, times `factor`.
    #[inline(always)]
    fn push_all(&mut self, factor: L) {
        let Self { list, rows, linear, velocities, .. } = self;
        for joint in list.iter() {
            for i in 0..joint.nodes {
                let own = node(rows, joint, i);
                let x = [own[0].impulse * factor, own[1].impulse * factor, own[2].impulse * factor];
                push(joint, rows, linear, i, &x, velocities);
            }
        }
    }
}

/// What a row that does not take part is yet to push.
#[inline(always)]
fn fixed<L: Lanes>(row: &LaneRow<L>, bound: &Bound<L>) -> L {
    (bound.fixed - row.impulse) * (L::ONE - row.free)
}

/// The rows of a node.
#[inline(always)]
fn node<'a, L: Lanes>(rows: &'a [LaneRow<L>], joint: &LaneJoint<L>, i: usize) -> &'a [LaneRow<L>] {
    &rows[joint.first + i * NODE..][..NODE]
}

/// The unit vector along which row i holds points together, on a body that moves.
#[inline(always)]
fn unit_of<L: Lanes>(i: usize, scale: L) -> [L; 3] {
    let mut unit = [L::ZERO; 3];
    if i < NODE {
        unit[i] = L::select(L::ZERO.lt(scale), L::ONE, L::ZERO);
    }
    unit
}

/// The linear part of a row's scaled Jacobian.
#[inline(always)]
fn linear_part<L: Lanes>(joint: &LaneJoint<L>, linear: &[[[L; 3]; 2]], i: usize, side: usize) -> [L; 3] {
    match joint.linear {
        Linear::Any(at) => linear[at + i][side],
        Linear::Points(scales) => {
            let mut part = [L::ZERO; 3];
            if i < NODE {
                part[i] = if side == 0 { scales[0] } else { -scales[1] };
            }
            part
        }
    }
}

/// Applies the impulses of a node.
#[inline(always)]
fn push<L: Lanes>(
    joint: &LaneJoint<L>,
    rows: &[LaneRow<L>],
    linear: &[[[L; 3]; 2]],
    i: usize,
    x: &[L; 3],
    velocities: &mut [[L; 6]],
) {
    let own = node(rows, joint, i);
    for (side, body) in joint.ends.into_iter().enumerate() {
        let u = &mut velocities[body as usize];
        for k in 0..3 {
            u[k + 3] += own[0].angular[side][k] * x[0]
                + own[1].angular[side][k] * x[1]
                + own[2].angular[side][k] * x[2];
        }
        match joint.linear {
            Linear::Points(scales) if i == 0 => {
                let s = if side == 0 { scales[0] } else { -scales[1] };
                for k in 0..3 {
                    u[k] += s * x[k];
                }
            }
            Linear::Points(_) => {}
            Linear::Any(at) => {
                let l = &linear[at + i * NODE..][..NODE];
                for k in 0..3 {
                    u[k] += l[0][side][k] * x[0] + l[1][side][k] * x[1] + l[2][side][k] * x[2];
                }
            }
        }
    }
}

/// Products of the angular parts of two nodes, for a body at these ends of theirs.
#[inline(always)]
fn turning_products<L: Lanes>(a: &[LaneRow<L>], b: &[LaneRow<L>], sides: [usize; 2]) -> Block<L> {
    let (x, y) = (sides[0] & 1, sides[1] & 1);
    let a = [&a[0].angular[x], &a[1].angular[x], &a[2].angular[x]];
    let b = [&b[0].angular[y], &b[1].angular[y], &b[2].angular[y]];
    [
        dot(a[0], b[0]),
        dot(a[0], b[1]),
        dot(a[0], b[2]),
        dot(a[1], b[0]),
        dot(a[1], b[1]),
        dot(a[1], b[2]),
        dot(a[2], b[0]),
        dot(a[2], b[1]),
        dot(a[2], b[2]),
    ]
}

/// The lower triangle of those of a node with itself.
#[inline(always)]
fn turning_squares<L: Lanes>(a: &[LaneRow<L>], side: usize) -> Block<L> {
    let side = side & 1;
    let [a, b, c] = [&a[0].angular[side], &a[1].angular[side], &a[2].angular[side]];
    let zero = L::ZERO;
    [dot(a, a), zero, zero, dot(b, a), dot(b, b), zero, dot(c, a), dot(c, b), dot(c, c)]
}

#[inline(always)]
fn add_products<L: Lanes>(a: &Block<L>, b: &Block<L>) -> Block<L> {
    let mut sum = *a;
    for (s, b) in sum.iter_mut().zip(b) {
        *s += *b;
    }
    sum
}

/// Takes rows that don't take part out of a block.
#[inline(always)]
fn mask<L: Lanes>(block: &mut Block<L>, a: &[LaneRow<L>], b: &[LaneRow<L>]) {
    for k in 0..NODE {
        for l in 0..NODE {
            block[k * NODE + l] = block[k * NODE + l] * a[k].free * b[l].free;
        }
    }
}

/// The rotation vector of a rotation by θ followed by one by the small δ is θ + δ + δ × θ/2 + θ × (θ × δ)/12 (Baker, Campbell and
/// Hausdorff; the next term is θ³ × δ/720): the last two, with all in scaled coordinates, θ times `inverse`; `over`: 1/S of S's diagonal.
#[inline(always)]
fn curve<L: Lanes>(delta: &[L; 8], inverse: L, step: &[L; 3], s: &[L; 8], over: &[L; 3]) -> [L; 3] {
    let theta = unscaled(s, &[delta[3] * inverse, delta[4] * inverse, delta[5] * inverse]);
    let unit = L::splat(carry::TRIFLE);
    let (theta, small) = (without_trifles(&theta, unit), without_trifles(&unscaled(s, step), unit));
    let inner = without_trifles(&cross(&theta, &small), unit);
    let (one, two) = (cross(&small, &theta), cross(&theta, &inner));
    let (half, twelfth) = (L::splat(0.5), L::splat(1.0 / 12.0));
    let d = add(
        &[one[0] * half, one[1] * half, one[2] * half],
        &[two[0] * twelfth, two[1] * twelfth, two[2] * twelfth],
    );
    let a = d[0] * over[0];
    let b = (d[1] - s[2] * a) * over[1];
    [a, b, (d[2] - s[4] * a - s[5] * b) * over[2]]
}
