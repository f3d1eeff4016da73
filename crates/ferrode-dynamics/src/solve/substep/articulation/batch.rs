//! Articulations of one shape, side by side: their bodies and rows in lanes, from the joints and back to them. The sweeps are in `sweep`.

use super::carry::{self, Motion, Rates, Start};
use super::factor::Factor;
use super::plan::{NODE, Plan};
use super::row::{Bound, LaneRow, Role, Written};
use super::shape::{JointEnds, Shape};
use super::triple::{over, scaled, without_trifles};
use crate::arena::NIL;
use crate::solve::substep::joints::{JointConstraint, JointRow, Joints};
use ferrode_math::simd::{Lanes, Mask, NO_RECORD};
use ferrode_math::stage::Lent;

/// The velocities, displacements and scales of a batch's bodies, by their numbers in its list.
pub(super) type BodyRecords<'a, L> = Lent<'a, L, 3>;
pub(super) const VELOCITIES: usize = 0;
pub(super) const DELTAS: usize = 1;
pub(super) const SCALES: usize = 2;

/// Of scaled velocities: parts of 10⁻⁷ of it are rounded away.
const VELOCITY_TRIFLE: f32 = 1e-10;

/// The same joint of several articulations.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaneJoint<L> {
    /// Its bodies; the last one stands for all that no force moves.
    pub ends: JointEnds,
    /// Its first row, and its nodes.
    pub first: usize,
    pub nodes: usize,
    pub linear: Linear<L>,
}

/// The linear parts of a joint's scaled Jacobians.
#[derive(Clone, Copy, Debug)]
pub(super) enum Linear<L> {
    /// The first three rows hold two points together along x, y and z, others turn only: the bodies' scales.
    Points([L; 2]),
    /// Any, from this place in the list.
    Any(usize),
}

#[inline(always)]
pub(super) fn both<T>(list: &[T], ends: JointEnds) -> [&T; 2] {
    [&list[ends[0] as usize], &list[ends[1] as usize]]
}

/// Articulations of one shape, as many as there are lanes or fewer.
#[derive(Debug)]
pub(super) struct Batch<L: Lanes> {
    /// Which shape they have.
    pub shape: u32,
    members: usize,
    /// Places of their bodies.
    pub bodies: Vec<L::Index>,
    /// Their joints among the constraints, in the order of elimination, lane by lane; `NIL` for lanes that are left.
    joints: Vec<u32>,
    pub list: Vec<LaneJoint<L>>,
    starts: Vec<Start<L>>,
    pub rows: Vec<LaneRow<L>>,
    /// Linear parts of rows, of joints where these are not known by themselves.
    pub linear: Vec<[[L; 3]; 2]>,
    /// Whether all rows of a node are without bounds and are no springs.
    pub plain: Vec<bool>,
    pub bounds: Vec<Bound<L>>,
    pub plan: Plan,
    pub factor: Factor<L>,
    /// Whether the articulations are others than those that the plan was made for.
    fresh: bool,
    /// Whether the factor has to be made.
    pub stale: bool,
    /// Velocities before the sweep and within it; the last body stands for all that no force moves.
    pub before: Vec<[L; 6]>,
    pub velocities: Vec<[L; 6]>,
    pub scales: Vec<[L; 8]>,
    /// Inverses of the diagonal of the scales of rotation.
    pub unscales: Vec<[L; 3]>,
    /// √y and its inverse, with the part y of a torque that turns each body: 1 but for links under high tension. In here the bodies'
    /// scales of rotation have √y in them.
    pub yields: Vec<[L; 2]>,
    motions: Vec<Motion<L>>,
    /// By nodes: right side, then change of impulses; and those of the relaxing sweep.
    pub changes: Vec<[[L; 3]; 2]>,
    /// Whether nothing else acts on the bodies, so that a biased sweep solves for the relaxing one too; and whether one has.
    pub alone: bool,
    pub ahead: bool,
    /// Whether the velocities are those of the bodies already.
    pub gathered: bool,
    /// Velocities after the relaxing sweep, if they are known beforehand.
    pub relaxed: Vec<[L; 6]>,
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
            alone: false,
            ahead: false,
            gathered: false,
            relaxed: Vec::new(),
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

    /// Begins a step of substeps of `h` seconds: takes the joints over, and applies the impulses that they start with. `alone`: nothing else
    /// acts on the bodies of articulations of this shape.
    #[inline(always)]
    pub fn begin(
        &mut self,
        shape: &Shape,
        joints: &Joints,
        (h, alone): (f32, bool),
        records: &BodyRecords<'_, L>,
    ) {
        (self.alone, self.ahead, self.gathered) = (alone, false, false);
        self.scales.clear();
        for i in 0..self.bodies.len() {
            self.scales.push(records.gather(SCALES, i));
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
        self.gather(records);
        self.push_all(L::ONE);
        self.give_back(records);
    }

    /// Takes the rows to where the bodies have moved; and if they are to `act`, their impulses with them.
    #[inline(always)]
    pub fn advance(&mut self, shape: &Shape, joints: &Joints, act: bool, records: &BodyRecords<'_, L>) {
        let mixed = self.starts.len() < self.list.len();
        if act {
            self.gather(records);
            if mixed {
                self.push_all(-L::ONE);
            }
        }
        for i in 0..self.bodies.len() {
            let [a, b, c, d, e, f, ..] = records.gather(DELTAS, i);
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
            self.give_back(records);
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
        self.changes.resize(plan.nodes(), [[L::ZERO; 3]; 2]);
        self.stale = true;
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

    #[inline(always)]
    pub fn gather(&mut self, records: &BodyRecords<'_, L>) {
        self.velocities.clear();
        let unit = L::splat(VELOCITY_TRIFLE);
        for (i, [_, inverse]) in self.yields[..self.bodies.len()].iter().enumerate() {
            let [a, b, c, d, e, f, ..] = records.gather(VELOCITIES, i);
            let [a, b, c] = without_trifles(&[a, b, c], unit);
            let [d, e, f] = without_trifles(&[d * *inverse, e * *inverse, f * *inverse], unit);
            self.velocities.push([a, b, c, d, e, f]);
        }
        self.velocities.push([L::ZERO; 6]);
    }

    #[inline(always)]
    pub fn scatter(&self, records: &BodyRecords<'_, L>) {
        let moving = self.velocities.iter().zip(&self.yields).take(self.bodies.len());
        for (i, ([a, b, c, d, e, f], [root, _])) in moving.enumerate() {
            let numbers = [*a, *b, *c, *d * *root, *e * *root, *f * *root, L::ZERO, L::ZERO];
            records.scatter(VELOCITIES, i, numbers);
        }
    }

    /// Lets others see the velocities before the next sweep, if there are any whom they concern.
    #[inline(always)]
    fn give_back(&mut self, records: &BodyRecords<'_, L>) {
        self.gathered = self.alone;
        if !self.alone {
            self.scatter(records);
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

/// The rows of a node.
#[inline(always)]
pub(super) fn node<'a, L: Lanes>(rows: &'a [LaneRow<L>], joint: &LaneJoint<L>, i: usize) -> &'a [LaneRow<L>] {
    &rows[joint.first + i * NODE..][..NODE]
}

/// The linear part of a row's scaled Jacobian.
#[inline(always)]
pub(super) fn linear_part<L: Lanes>(
    joint: &LaneJoint<L>,
    linear: &[[[L; 3]; 2]],
    i: usize,
    side: usize,
) -> [L; 3] {
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
pub(super) fn push<L: Lanes>(
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
