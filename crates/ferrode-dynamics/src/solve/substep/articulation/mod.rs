//! Articulations: connected sets of joints that are solved together, exactly, in every sweep.
//!
//! Sweeps that go from joint to joint bring a force past one joint at a time; long chains and heavy ends open under them. Here the joints of
//! a connected set are one block: J̃ J̃ᵀ over all of them is factorised in each substep (`shape`, `factor`), and after the contacts have had their
//! say, the joints' rows are solved so that none is violated (`batch`, `matrix`, `sweep`). In a tree that takes time proportional to the joints.
//!
//! Articulations of one shape are solved in lanes, side by side.

mod batch;
mod carry;
mod factor;
mod matrix;
mod plan;
mod row;
mod shape;
mod sweep;
mod tension;
mod triple;

use super::bodies::SolverBodies;
use super::joints::Joints;
use super::sleep::Sets;
use crate::arena::NIL;
use batch::{Batch, BodyRecords};
pub(super) use carry::{CarriedJoint, Rates};
use core::any::Any;
use core::ops::Range;
use ferrode_math::simd::{Kernel, Lanes, Level, NO_RECORD, Work, dispatch_few};
use ferrode_math::stage::{Crew, Exclusive};
use shape::{JointEnds, Shape};
use std::collections::HashMap;
use std::sync::Arc;
pub(super) use sweep::Mode;

/// Products of blocks per joint, on average, up to which joints that nothing is said of are solved exactly. A chain takes three;
/// this is a band of six joints.
const MOST_PRODUCTS: f64 = 24.0;
/// Joints, in lanes or alone, that are worth sharing out among threads: some microseconds' worth.
const MANY_JOINTS: usize = 30;
/// Shapes that are kept though no articulation had them in the last step.
const SPARE_SHAPES: usize = 64;

/// What is known of a topology; no shape if it costs too much.
#[derive(Debug)]
struct Known {
    shape: Option<Arc<Shape>>,
    used: u64,
}

/// Batches of one kind of lanes.
#[derive(Debug)]
struct Batches<L: Lanes> {
    list: Vec<Batch<L>>,
    /// The bodies of each: one group, a part for each batch.
    bodies: Exclusive<L>,
    /// Whether there are joints enough to be shared out.
    many: bool,
}

impl<L: Lanes> Batches<L> {
    fn new(list: Vec<Batch<L>>, joints: usize) -> Self {
        let mut bodies = Exclusive::<L>::default();
        let rows = |batch: &Batch<L>| batch.bodies.len().div_ceil(2);
        let mut end = 0;
        let ends = list.iter().map(|batch| {
            end += rows(batch);
            end
        });
        let places = bodies.begin([ends.collect::<Vec<_>>()], list.iter().map(rows).sum());
        let pairs = list.iter().flat_map(|batch| batch.bodies.chunks(2));
        for (row, pair) in places.iter_mut().zip(pairs) {
            row[1].as_mut().fill(NO_RECORD);
            row[..pair.len()].copy_from_slice(pair);
        }
        Self { list, bodies, many: joints >= MANY_JOINTS }
    }
}

/// The articulations of a step.
#[derive(Debug, Default)]
pub(super) struct Articulations {
    /// Shapes by topology and kinds of joints, with whether any cost is accepted.
    known: HashMap<(bool, Vec<(JointEnds, u8)>), Known>,
    shapes: Vec<Arc<Shape>>,
    step: u64,
    /// The joints of the step before, by their bodies, with what was made of them: whether they are solved exactly, and carried along.
    topology: Vec<[u32; 3]>,
    compared: Vec<[u32; 3]>,
    outcome: Vec<(bool, u8)>,
    /// The lanes that were asked for, and for how many threads.
    asked: Option<Asked>,
    /// The lanes of the batches.
    level: Option<Level>,
    sets: Sets,
    /// By body: its articulation, and its number therein.
    found: Vec<[u32; 2]>,
    members: Vec<Member>,
    /// The members by shape, each with that; what is not solved exactly is left out.
    order: Vec<(u32, u32)>,
    /// Those that are solved side by side: places in this order.
    groups: Vec<Range<usize>>,
    /// By shapes: whether something else, in some articulation, acts on its bodies.
    in_company: Vec<bool>,
    touched: Vec<bool>,
    /// Batches in the lanes of this machine, and of one lane for those that stand alone: `Batches<L>`.
    wide: Option<Box<dyn Any + Send + Sync>>,
    narrow: Option<Box<dyn Any + Send + Sync>>,
}

/// Lanes, if not those that are fastest; and threads.
pub(super) type Asked = (Option<Level>, usize);

/// An articulation.
#[derive(Debug, Default)]
struct Member {
    joints: Vec<u32>,
    bodies: Vec<u32>,
    ends: Vec<(JointEnds, u8)>,
    /// Whether a joint is marked exact, so that cost does not matter.
    marked: bool,
}

/// What is done with all articulations.
pub(super) enum Task<'a> {
    /// Batches are made of them.
    Arrange,
    /// They take over the joints at the start of a step, for substeps of so many seconds.
    Begin(&'a Joints, f32),
    /// Their rows follow the bodies, in another substep; or after the last one, when nothing acts any more.
    Advance(&'a Joints, bool),
    /// They are solved.
    Solve(Mode),
    /// The joints get their impulses.
    Store(&'a mut Joints),
}

impl Articulations {
    /// Finds the articulations among the joints, and takes those joints out of the sweeps from joint to joint.
    pub fn find(&mut self, asked: Asked, joints: &mut Joints, bodies: &mut SolverBodies) {
        if self.are_as_before(asked, joints, bodies) {
            for (c, outcome) in joints.constraints.iter_mut().zip(&self.outcome) {
                (c.exact, c.carried) = *outcome;
            }
            return;
        }
        self.shapes.clear();
        self.order.clear();
        self.groups.clear();
        self.step += 1;
        if joints.constraints.iter().any(|c| c.exact) {
            self.arrange(asked, joints, bodies);
        }
        self.outcome.clear();
        self.outcome.extend(joints.constraints.iter().map(|c| (c.exact, c.carried)));
    }

    /// Whether the joints are of the same kinds and between the same bodies as in the step before.
    fn are_as_before(&mut self, asked: Asked, joints: &Joints, bodies: &SolverBodies) -> bool {
        let mut found = core::mem::take(&mut self.compared);
        found.clear();
        found.extend(joints.constraints.iter().map(|c| {
            let movable = c.bodies.map(|body| bodies.is_movable(body));
            let flags = [c.exact, c.marked, movable[0], movable[1]].into_iter();
            let flags = flags.fold(u32::from(c.carried), |sum, flag| 2 * sum + u32::from(flag));
            [c.bodies[0], c.bodies[1], flags]
        }));
        let same = self.asked == Some(asked) && found == self.topology;
        self.compared = core::mem::replace(&mut self.topology, found);
        self.asked = Some(asked);
        same
    }

    fn arrange(&mut self, (level, threads): Asked, joints: &mut Joints, bodies: &mut SolverBodies) {
        self.find_sets(joints, bodies);
        for (number, member) in self.members.iter_mut().enumerate() {
            let key = (member.marked, core::mem::take(&mut member.ends));
            let known = self.known.entry(key).or_insert_with_key(|(marked, ends)| {
                let most = if *marked { f64::INFINITY } else { MOST_PRODUCTS };
                let ends: Vec<JointEnds> = ends.iter().map(|(ends, _)| *ends).collect();
                Known { shape: Shape::new(member.bodies.len(), &ends, most).map(Arc::new), used: 0 }
            });
            known.used = self.step;
            let Some(shape) = &known.shape else {
                for joint in &member.joints {
                    let constraint = &mut joints.constraints[*joint as usize];
                    (constraint.exact, constraint.carried) = (false, 0);
                }
                continue;
            };
            let place = self.shapes.iter().position(|s| Arc::ptr_eq(s, shape)).unwrap_or_else(|| {
                self.shapes.push(shape.clone());
                self.shapes.len() - 1
            });
            self.order.push((place as u32, number as u32));
        }
        self.order.sort_unstable();
        let level = level.unwrap_or_else(|| self.fastest(threads));
        self.level = Some(level);
        let lanes = dispatch_few(level, CountLanes);
        let mut at = 0;
        for shape in self.order.chunk_by(|a, b| a.0 == b.0) {
            self.groups.extend(shape.chunks(lanes).map(|group| {
                at += group.len();
                at - group.len()..at
            }));
        }
        self.pass(&Crew::default(), Task::Arrange, bodies);
        if self.known.len() > self.shapes.len() + SPARE_SHAPES {
            let step = self.step;
            self.known.retain(|_, known| known.used == step);
        }
    }

    /// The lanes in which the batches take the least time.
    fn fastest(&self, threads: usize) -> Level {
        let best = Level::best();
        if best != Level::Avx2 || !Level::Avx512.is_available() {
            return best;
        }
        // Of the thread that has the most of them.
        let batches = |lanes: usize| -> usize {
            let shapes = self.order.chunk_by(|a, b| a.0 == b.0);
            shapes.map(|shape| shape.len().div_ceil(lanes)).sum::<usize>().div_ceil(threads)
        };
        // Sixteen lanes of AVX-512 take 1.7 times as long as eight of AVX2, measured.
        if 17 * batches(16) < 10 * batches(8) { Level::Avx512 } else { best }
    }

    /// Gathers connected sets of joints, each with its bodies in the order in which its joints name them.
    fn find_sets(&mut self, joints: &mut Joints, bodies: &SolverBodies) {
        let Self { sets, found, members, .. } = self;
        sets.begin(bodies.len());
        for c in joints.constraints.iter_mut().filter(|c| c.exact) {
            match c.bodies.map(|body| bodies.is_movable(body)) {
                [true, true] => sets.unite(c.bodies[0], c.bodies[1]),
                [false, false] => (c.exact, c.carried) = (false, 0),
                _ => {}
            }
        }
        found.clear();
        found.resize(bodies.len(), [NIL; 2]);
        members.clear();
        for (joint, c) in joints.constraints.iter().enumerate().filter(|(_, c)| c.exact) {
            let movable = c.bodies.map(|body| bodies.is_movable(body).then_some(body));
            let Some(first) = movable[0].or(movable[1]) else { continue };
            let root = sets.root(first) as usize;
            if found[root][0] == NIL {
                found[root][0] = members.len() as u32;
                members.push(Member::default());
            }
            let member = &mut members[found[root][0] as usize];
            member.joints.push(joint as u32);
            member.marked |= c.marked;
            let ends = movable.map(|body| {
                let Some(body) = body else { return NIL };
                let number = &mut found[body as usize][1];
                if *number == NIL {
                    *number = member.bodies.len() as u32;
                    member.bodies.push(body);
                }
                *number
            });
            member.ends.push((ends, c.carried));
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Finds the shapes on whose bodies, in some articulation, something else acts: `others` are the pairs of bodies that it acts on.
    ///
    /// Shapes, not articulations: how they share batches must not show in the results.
    pub fn find_company(&mut self, bodies: usize, others: impl Iterator<Item = [u32; 2]>) {
        let Self { in_company, touched, order, members, shapes, .. } = self;
        in_company.clear();
        in_company.resize(shapes.len(), false);
        if order.is_empty() {
            return;
        }
        touched.clear();
        for body in others.flatten() {
            touched.resize(bodies, false);
            if let Some(touched) = touched.get_mut(body as usize) {
                *touched = true;
            }
        }
        if touched.is_empty() {
            return;
        }
        for (shape, member) in order.iter() {
            let shape = &mut in_company[*shape as usize];
            *shape = *shape || members[*member as usize].bodies.iter().any(|body| touched[*body as usize]);
        }
    }

    /// Does something with all of them.
    pub fn pass(&mut self, crew: &Crew, mut task: Task<'_>, bodies: &mut SolverBodies) {
        let Some(level) = self.level.filter(|_| !self.order.is_empty()) else { return };
        for (level, wide) in [(level, true), (Level::Scalar, false)] {
            dispatch_few(level, Run { articulations: self, crew, bodies, task: &mut task, wide });
        }
    }
}

/// Tells how many lanes there are.
struct CountLanes;

impl Kernel for CountLanes {
    type Out = usize;

    #[inline(always)]
    fn run<L: Lanes>(self) -> usize {
        L::LANES
    }
}

/// A task with lanes of one kind.
struct Run<'a, 'p> {
    articulations: &'a mut Articulations,
    crew: &'a Crew,
    bodies: &'a mut SolverBodies,
    task: &'a mut Task<'p>,
    wide: bool,
}

impl Kernel for Run<'_, '_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Articulations { shapes, members, order, groups, wide, narrow, in_company, .. } =
            self.articulations;
        let place = if self.wide { wide } else { narrow };
        if let Task::Arrange = self.task {
            let known = place.take().and_then(|b| b.downcast::<Batches<L>>().ok());
            let mut spare = known.map_or(Vec::new(), |b| b.list).into_iter();
            let mut joints = 0;
            // One that stands alone takes one lane.
            let mine = groups.iter().filter(|group| self.wide == (group.len() > 1));
            let list: Vec<_> = mine
                .map(|group| {
                    let number = order[group.start].0;
                    let shape = &shapes[number as usize];
                    joints += shape.order.len();
                    let mut batch = spare.next().unwrap_or_else(Batch::<L>::new);
                    batch.reset(number, shape);
                    for (_, member) in &order[group.clone()] {
                        let member = &members[*member as usize];
                        batch.push(shape, &member.bodies, &member.joints);
                    }
                    batch
                })
                .collect();
            *place = Some(Box::new(Batches::new(list, joints)));
            return;
        }
        let Some(batches) = place.as_mut().and_then(|b| b.downcast_mut::<Batches<L>>()) else { return };
        let act = match self.task {
            Task::Arrange => return,
            Task::Store(joints) => {
                for batch in &mut batches.list {
                    batch.store(&joints.constraints, &mut joints.rows, &mut joints.kept);
                }
                return;
            }
            Task::Begin(joints, h) => {
                batches.bodies.verify(self.crew, self.bodies.len());
                Act::Begin(joints, *h)
            }
            Task::Advance(joints, act) => Act::Advance(joints, *act),
            Task::Solve(mode) => Act::Solve(*mode),
        };
        let alone = Crew::default();
        let crew = if batches.many { self.crew } else { &alone };
        let SolverBodies { velocities, deltas, scales, .. } = self.bodies;
        let (shapes, in_company) = (&*shapes, &*in_company);
        batches.bodies.lend(crew, 0, &mut batches.list, [velocities, deltas, scales], |batch, records| {
            let shape = &shapes[batch.shape as usize];
            let alone = !in_company.get(batch.shape as usize).copied().unwrap_or(true);
            L::enter(OnBatch { batch, records, shape, alone, act });
        });
    }
}

/// What is done with each batch.
#[derive(Clone, Copy)]
enum Act<'a> {
    Begin(&'a Joints, f32),
    Advance(&'a Joints, bool),
    Solve(Mode),
}

struct OnBatch<'a, L: Lanes> {
    batch: &'a mut Batch<L>,
    records: BodyRecords<'a, L>,
    shape: &'a Shape,
    /// Whether nothing else acts on its bodies.
    alone: bool,
    act: Act<'a>,
}

impl<L: Lanes> Work<L> for OnBatch<'_, L> {
    #[inline(always)]
    fn run(self) {
        let Self { batch, records, shape, alone, act } = self;
        match act {
            Act::Begin(joints, h) => batch.begin(shape, joints, (h, alone), &records),
            Act::Advance(joints, act) => batch.advance(shape, joints, act, &records),
            Act::Solve(mode) => batch.sweep(mode, &records),
        }
    }
}
