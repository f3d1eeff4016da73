//! Contacts in lanes: as many manifolds side by side as the machine has lanes.
//!
//! A manifold has up to four rows along its normal, and one block of friction at the centre of its points: two tangents,
//! whose impulse stays within the disc |f| ≤ μ N, and a twist about the normal, |τ| ≤ μ N r with r the mean distance of
//! the points from their centre, which is the torque that friction at the points would have. N is the sum of the normal
//! impulses. Both sides are linearised at the start of the step; separations follow the bodies' displacements.
//!
//! Rows hold scaled Jacobians (see `bodies`). The linear part of all rows of a manifold is its normal or tangent times the
//! two scales; only the angular parts are stored row by row.

mod extra;
mod prepare;
mod restitution;
mod store;
mod sweep;
mod vector;

use super::bodies::SolverBodies;
use super::colour::COLOURS;
use super::manifold::{ContactManifold, MANIFOLD_POINTS};
use super::room::make_room;
use super::soft::Coefficients;
use super::surface::SurfaceCoefficients;
use core::any::Any;
use core::ops::Range;
use ferrode_math::simd::{Kernel, Lanes, Level, dispatch_at};
use ferrode_math::stage::{Crew, Exclusive, chunks};

pub(super) use extra::Extra;

/// Three numbers per lane in memory.
type Block3<L> = [<L as Lanes>::Block; 3];

/// A row along the normal.
#[derive(Clone, Copy, Debug, Default)]
struct PointRow<B> {
    /// Angular parts: Sᵀ (r × n), and its negative for the second body.
    angular: [[B; 3]; 2],
    /// 1 / (J̃ J̃ᵀ); 0 for points that the manifold hasn't.
    mass: B,
    /// At the start of the step.
    separation0: B,
    /// Now.
    separation: B,
    impulse: B,
}

/// The block of friction.
#[derive(Clone, Copy, Debug, Default)]
struct FrictionRows<B> {
    /// Angular parts along the first and second tangent and about the normal, for each body.
    angular: [[[B; 3]; 2]; 3],
    /// Inverse of the 2×2 matrix of the tangents: 11, 12, 22.
    mass: [B; 3],
    twist_mass: B,
    /// Along the tangents, and about the normal.
    impulse: [B; 3],
    mu: B,
    /// Mean distance of the points from their centre.
    radius: B,
}

/// As many manifolds as there are lanes; no movable body is in two of them. Which bodies, [`Batches::bodies`] tells.
///
/// Places stay from step to step: what is beyond `count` and, without `special`, in `extra` is of earlier ones.
#[derive(Debug)]
struct Batch<L: Lanes> {
    normal: Block3<L>,
    tangent: Block3<L>,
    /// Square roots of the inverse masses.
    scale: [L::Block; 2],
    bias_rate: L::Block,
    mass_scale: L::Block,
    impulse_scale: L::Block,
    push_out: L::Block,
    points: [PointRow<L::Block>; MANIFOLD_POINTS],
    friction: FrictionRows<L::Block>,
    /// Points of the manifold that has most.
    count: u32,
    /// Whether the manifolds have more than plain friction.
    special: bool,
    extra: Option<Box<Extra<L>>>,
}

impl<L: Lanes> Batch<L> {
    fn blank() -> Self {
        let (one, three) = (L::Block::default(), Block3::<L>::default());
        Self {
            normal: three,
            tangent: three,
            scale: [one; 2],
            bias_rate: one,
            mass_scale: one,
            impulse_scale: one,
            push_out: one,
            points: Default::default(),
            friction: FrictionRows::default(),
            count: 0,
            special: false,
            extra: None,
        }
    }
}

/// Which manifolds a batch has.
#[derive(Clone, Copy, Debug)]
struct Span {
    /// Places in the order of manifolds.
    first: u32,
    end: u32,
    special: bool,
}

/// Batches of one kind of lanes.
#[derive(Debug)]
struct Batches<L: Lanes> {
    list: Vec<Batch<L>>,
    /// For each batch.
    spans: Vec<Span>,
    /// The bodies of each batch, in groups by colour.
    bodies: Exclusive<L>,
    /// Ends of the parts of all groups in the list of batches.
    ends: Vec<usize>,
    /// What is worked on one after the other, by places in `ends`: the parts of the world, and then each colour between them, or the
    /// overflow.
    groups: Vec<Range<usize>>,
}

impl<L: Lanes> Default for Batches<L> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            spans: Vec::new(),
            bodies: Exclusive::default(),
            ends: Vec::new(),
            groups: Vec::new(),
        }
    }
}

/// The contacts of a step.
#[derive(Debug, Default)]
pub(super) struct Contacts {
    /// Keys by colour and kind.
    pub order: Vec<u32>,
    /// Parts of the world: sections of the order before the one for what lies between parts, which the overflow follows.
    pub parts: usize,
    /// Where each colour of each section begins in `order`; the overflow and the end come last.
    starts: Vec<u32>,
    /// Of each manifold that counts.
    pub keys: Vec<ManifoldKey>,
    /// Batches in the lanes of this machine: `Batches<L>`.
    wide: Option<Box<dyn Any + Send + Sync>>,
    /// Batches of one lane for what fits no colour: `Batches<One>`.
    narrow: Option<Box<dyn Any + Send + Sync>>,
    counts: Vec<u32>,
    pub has_bounce: bool,
}

/// What is known of a manifold before its rows are made.
#[derive(Clone, Copy, Debug)]
pub(super) struct ManifoldKey {
    /// Dense places, or `u32::MAX`.
    pub bodies: [u32; 2],
    /// Of the manifold.
    pub place: u32,
    /// Whether forces move them.
    pub movable: [bool; 2],
    /// Colour, kind and number of points, in the order of solving; `NOT_SOLVED` for one without points or movable bodies.
    pub sort: u16,
}

impl ManifoldKey {
    /// The bodies that forces move.
    #[inline]
    pub fn movable_bodies(&self) -> [Option<u32>; 2] {
        [0, 1].map(|side| self.movable[side].then_some(self.bodies[side]))
    }

    /// The key of a manifold that is not solved.
    pub const LEFT_OUT: Self =
        Self { bodies: [u32::MAX; 2], place: u32::MAX, movable: [false; 2], sort: NOT_SOLVED };
}

/// What sorts a manifold out.
pub(super) const NOT_SOLVED: u16 = u16::MAX;
/// Points of a manifold whose sorting key is that of its colour alone, if it is a plain one.
pub(super) const MOST_POINTS: usize = MANIFOLD_POINTS;
/// Kinds of manifolds within a colour: plain and special ones with 4, 3, 2, 1 points.
const KINDS: usize = 2 * MANIFOLD_POINTS;

/// The sorting key of a manifold with `points` points: sections one after the other, and their colours.
pub(super) fn sort_key(section: usize, colour: usize, special: bool, points: usize) -> u16 {
    (((section * COLOURS + colour) * 2 + usize::from(special)) * MANIFOLD_POINTS + (MANIFOLD_POINTS - points))
        as u16
}

/// What all passes need.
#[derive(Clone, Copy)]
pub(super) struct Context<'a> {
    pub bodies: &'a SolverBodies,
    pub manifolds: &'a [ContactManifold],
    pub surfaces: &'a [SurfaceCoefficients],
    pub soft: Coefficients,
    /// Of this step to the one before, in length: impulses carried over grow with it.
    pub ratio: f32,
}

/// A pass over the contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    /// Applies the impulses of the step before.
    WarmStart,
    /// Solves, pushing overlapping bodies apart.
    Biased,
    /// Solves for velocities alone.
    Relax,
    /// Gives speed back.
    Restitution,
}

impl Contacts {
    /// Number of rows: those along normals, and three of friction per manifold.
    pub fn row_count(&self) -> usize {
        let points = |key: &ManifoldKey| MANIFOLD_POINTS - usize::from(key.sort) % MANIFOLD_POINTS;
        self.keys.iter().filter(|key| key.sort != NOT_SOLVED).map(|key| points(key) + 3).sum()
    }

    /// Sorts the manifolds by their keys.
    pub fn arrange(&mut self) {
        let colours = (self.parts + 1) * COLOURS;
        let kinds = (colours + 1) * KINDS;
        self.counts.clear();
        self.counts.resize(kinds + 1, 0);
        let solved = |key: &&ManifoldKey| key.sort != NOT_SOLVED;
        for key in self.keys.iter().filter(solved) {
            self.counts[usize::from(key.sort) + 1] += 1;
        }
        for k in 0..kinds {
            self.counts[k + 1] += self.counts[k];
        }
        self.starts.clear();
        self.starts.extend((0..colours + 2).map(|colour| self.counts[colour * KINDS]));
        self.order.clear();
        make_room(&mut self.order, self.counts[kinds] as usize);
        self.order.resize(self.counts[kinds] as usize, 0);
        for (i, key) in self.keys.iter().enumerate() {
            if key.sort != NOT_SOLVED {
                let place = &mut self.counts[usize::from(key.sort)];
                self.order[*place as usize] = i as u32;
                *place += 1;
            }
        }
    }

    /// Makes the rows of all manifolds.
    pub fn prepare(&mut self, level: Level, crew: &Crew, context: &Context<'_>) {
        dispatch_at(level, Prepare { contacts: self, crew, context, wide: true });
        dispatch_at(Level::Scalar, Prepare { contacts: self, crew, context, wide: false });
    }

    /// Makes a pass over all manifolds, colour after colour, the overflow last.
    pub fn pass(
        &mut self,
        level: Level,
        crew: &Crew,
        pass: Pass,
        bodies: &mut SolverBodies,
        (h, elapsed): (f32, f32),
    ) {
        if self.order.is_empty() {
            return;
        }
        if let Some(batches) = &mut self.wide {
            dispatch_at(level, sweep::Sweep { batches: &mut **batches, crew, bodies, pass, h, elapsed });
        }
        if let [.., overflow, end] = self.starts[..]
            && overflow != end
            && let Some(batches) = &mut self.narrow
        {
            let batches = &mut **batches;
            dispatch_at(Level::Scalar, sweep::Sweep { batches, crew, bodies, pass, h, elapsed });
        }
    }

    /// Writes the impulses back into the manifolds.
    pub fn store(&self, level: Level, manifolds: &mut [ContactManifold]) {
        if let Some(batches) = &self.wide {
            dispatch_at(
                level,
                store::Store { batches: &**batches, order: &self.order, keys: &self.keys, manifolds },
            );
        }
        if let Some(batches) = &self.narrow {
            dispatch_at(
                Level::Scalar,
                store::Store { batches: &**batches, order: &self.order, keys: &self.keys, manifolds },
            );
        }
    }
}

/// Makes batches of some colours.
struct Prepare<'a> {
    contacts: &'a mut Contacts,
    crew: &'a Crew,
    context: &'a Context<'a>,
    /// Whether those that have a colour; those that have none otherwise.
    wide: bool,
}

impl Kernel for Prepare<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Contacts { order, starts, keys, parts, wide, narrow, .. } = self.contacts;
        let place = if self.wide { wide } else { narrow };
        if !place.as_ref().is_some_and(|b| b.is::<Batches<L>>()) {
            *place = Some(Box::new(Batches::<L>::default()));
        }
        let Some(batches) = place.as_mut().and_then(|b| b.downcast_mut::<Batches<L>>()) else { return };
        let Batches { list, spans, bodies, ends, groups } = batches;
        spans.clear();
        ends.clear();
        groups.clear();
        let (parts, overflow) = (*parts, starts.len() - 2);
        let colours = if self.wide { 0..overflow } else { overflow..overflow + 1 };
        for colour in colours {
            let first_batch = spans.len();
            let (mut first, end) = (starts[colour], starts[colour + 1]);
            let manifolds = &order[first as usize..end as usize];
            let plain = manifolds.partition_point(|i| !is_special(keys[*i as usize].sort));
            let plain_end = first + plain as u32;
            while first < end {
                let special = first >= plain_end;
                let stop = (first + L::LANES as u32).min(if special { end } else { plain_end });
                spans.push(Span { first, end: stop, special });
                first = stop;
            }
            let section = colour / COLOURS;
            if section < parts {
                // Parts are one group: one after the other within each, and side by side.
                if colour % COLOURS == COLOURS - 1 {
                    ends.push(spans.len());
                }
                if colour + 1 == parts * COLOURS {
                    groups.push(0..ends.len());
                }
            } else if spans.len() > first_batch {
                // A colour between parts is shared out in lots.
                let start = ends.len();
                let size = lot_size::<L>(spans.len() - first_batch, self.crew);
                ends.extend((first_batch + size..spans.len()).step_by(size));
                ends.push(spans.len());
                groups.push(start..ends.len());
            }
        }
        if spans.len() > list.capacity() {
            // What they hold is of the step before: no need to have the old ones beside the new. Doubling would leave up to half of the
            // largest array unused.
            *list = Vec::new();
            list.reserve_exact((spans.len() + spans.len() / 8).max(32));
        }
        list.resize_with(spans.len(), Batch::blank);
        let rows = bodies.begin(groups.iter().map(|group| ends[group.clone()].iter().copied()), spans.len());
        let size = lot_size::<L>(spans.len(), self.crew);
        let (spans, keys, order) = (&*spans, &*keys, &*order);
        self.crew.each((chunks(list, size), chunks(rows, size)), |lot, (batches, rows)| {
            let spans = &spans[lot * size..];
            L::enter(prepare::PrepareLot { batches, rows, spans, context: self.context, keys, order });
        });
        bodies.verify(self.crew, self.context.bodies.len());
    }
}

/// How many of `count` batches make a task: a few tasks for each thread, or one for all where that is too little to share.
fn lot_size<L: Lanes>(count: usize, crew: &Crew) -> usize {
    if count * L::LANES < LEAST_SHARED {
        return count.max(1);
    }
    (count / (4 * crew.threads())).max(LEAST_TASK.div_ceil(L::LANES))
}

/// Manifolds that are solved by one thread rather than shared out: some two microseconds' worth.
const LEAST_SHARED: usize = 96;
/// Least manifolds of a task.
const LEAST_TASK: usize = 32;

fn is_special(sort: u16) -> bool {
    usize::from(sort) % KINDS >= MANIFOLD_POINTS
}
