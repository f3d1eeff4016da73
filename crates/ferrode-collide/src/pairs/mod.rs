//! The pairs of a world that are near each other, and their manifolds, kept from step to step.
//!
//! What a solver for many bodies needs of collision detection, in the order in which a step asks for it:
//!
//! ```text
//!   move_geom, set_awake …            the caller tells what changed; nothing else is looked at
//!        |
//!        v                            update():
//!   [geoms]  frame, odometer ──> [trees] of fat boxes: a leaf changes only when its geom leaves it
//!        |                           |
//!        |                 leaf changed: who else is there?      (tasks of changed leaves)
//!        |                           v
//!        |            filter ──> [pairs]  32 bytes each: near, perhaps not touching
//!        |                           |   odometers beyond the pair's limit: narrow phase, last axis first
//!        |                           v                           (tasks of 1,024 pairs)
//!        └───────────────────> [contacts]  one manifold each, at a place that stays
//!                                    |   barely moved: refresh; else narrow phase, impulses handed on by feature
//!                                    v                           (tasks of 256 contacts)
//!                             apply: what begins and ends, in the order of the tasks
//!                                    |
//!   solver reads contacts, writes impulses into them; began() and ended() for those who listen
//! ```
//!
//! **Odometers.** Each geom adds up how far any point of it can have moved, ever: |Δp| + 2 sin(θ/2) · reach a step. A
//! pair stores a limit for the sum of its two odometers. Shapes known to be apart by a distance more than the margin
//! need no look until the sum has grown by that; shapes that touch are refreshed from their anchors until it has grown
//! by the tolerance. So a pair that barely moved costs two loads and a comparison, whichever way it moved.
//!
//! **Sleep.** A bit for each pair and contact tells whether one of its geoms is awake; 64 that sleep are skipped by one
//! comparison. What falls asleep keeps its manifold, impulses included.
//!
//! **Order.** Tasks are cut by place, never by thread, and what they found is applied in their order; so places, and all
//! that follows, depend on the history alone.

mod contact;
mod geoms;
mod table;
mod tasks;
mod update;

#[cfg(test)]
mod tests;

use contact::Slab;
pub use contact::{Contact, Contacts};
use geoms::GeomState;
use geoms::News;
pub use geoms::{Motion, Told};

use crate::manifold::{Axis, Vec3f};
use crate::space::dynamic_tree::DynamicTree;
use crate::{Frame, Shape};
use ferrode_math::stage::{Crew, chunks};
use table::PairTable;

const NONE: u32 = u32::MAX;
/// Records of a task of [`PairCache::tell`].
pub const TOLD: usize = 256;

/// How near is near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairSettings {
    /// Points no further apart than this are in a manifold, in metres, with negative depth.
    pub margin: f64,
    /// How far two touching geoms may move before their manifold is found anew instead of refreshed, in metres; for
    /// small geoms a hundredth of their reach counts, if that is less. Zero: always found anew.
    pub tolerance: f64,
    /// By how much boxes in the trees are larger than the geoms, in parts of their size.
    pub fat: f64,
}

impl Default for PairSettings {
    /// Margin 2 cm, tolerance 2 mm, boxes larger by 5 % all round: for bodies of about a metre.
    fn default() -> Self {
        Self { margin: 0.02, tolerance: 0.002, fat: 0.05 }
    }
}

/// Two geoms near each other.
#[derive(Clone, Copy, Debug)]
struct Pair {
    a: u32,
    b: u32,
    /// The first of its contacts, or `NONE`.
    first: u32,
    axis: Axis,
    /// May have several contacts.
    concave: bool,
    /// Reported as touching.
    touching: bool,
    /// Not in use.
    free: bool,
    /// No narrow phase until the odometers' sum is beyond this.
    limit: f64,
}

const _: () = assert!(size_of::<Pair>() <= 32);

/// Pairs of near geoms and their manifolds; see the [module](self).
///
/// Geoms are numbered by the caller, who keeps the numbers small: they are places in arrays.
#[derive(Clone, Debug, Default)]
pub struct PairCache {
    settings: PairSettings,
    geoms: Vec<Option<GeomState>>,
    /// Leaves of what cannot move, and of what can.
    still: DynamicTree,
    moving: DynamicTree,
    /// Planes and endless fields.
    unbounded: Vec<u32>,
    pairs: Vec<Pair>,
    free_pairs: Vec<u32>,
    /// Pairs that are looked at.
    awake: Vec<u64>,
    table: PairTable,
    contacts: Slab,
    /// Number of updates.
    step: u32,
    /// Geoms whose leaves changed.
    changed: Vec<u32>,
    news: News,
    told: Vec<News>,
    began: Vec<(u32, u32)>,
    ended: Vec<(u32, u32)>,
    work: update::Work,
}

impl PairCache {
    /// A cache without geoms.
    pub fn new(settings: PairSettings) -> Self {
        Self { settings, ..Self::default() }
    }

    /// How near is near.
    pub fn settings(&self) -> &PairSettings {
        &self.settings
    }

    /// Adds a geom under a number of the caller's, in place of one that had it. Rays are ignored: they ask questions, and
    /// touch nothing.
    pub fn insert(&mut self, id: u32, shape: Shape, frame: &Frame, motion: Motion) {
        self.remove(id);
        if matches!(shape, Shape::Ray(_)) {
            return;
        }
        if id as usize >= self.geoms.len() {
            self.geoms.resize_with(id as usize + 1, || None);
        }
        let mut geom = GeomState::new(shape, frame, motion);
        geom.moved = self.step.wrapping_add(1);
        self.geoms[id as usize] = Some(geom);
        self.news.moved.push(id);
    }

    /// Takes a geom out, and ends its pairs. Does nothing if there is none with this number.
    pub fn remove(&mut self, id: u32) {
        if self.geom(id).is_none() {
            return;
        }
        for pair in self.pairs_of(id) {
            self.remove_pair(pair);
        }
        self.still.remove(id);
        self.moving.remove(id);
        self.unbounded.retain(|&u| u != id);
        self.geoms[id as usize] = None;
        self.news.moved.retain(|&m| m != id);
        self.changed.retain(|&c| c != id);
        self.news.woken.retain(|&w| w != id);
    }

    fn geom(&self, id: u32) -> Option<&GeomState> {
        self.geoms.get(id as usize)?.as_ref()
    }

    /// Tells where a geom is now. Frames that are no numbers are ignored.
    #[inline]
    pub fn move_geom(&mut self, id: u32, frame: &Frame) {
        self.tell_of(id, |geom| geom.move_geom(frame));
    }

    /// How far a geom may go in the coming step beyond the margin, in metres, and its way in that step: contacts are looked for so far
    /// ahead. Two geoms that go the same way don't come nearer: they look no further ahead than their ways differ.
    pub fn set_ahead(&mut self, id: u32, ahead: f32, way: Vec3f) {
        self.tell_of(id, |geom| geom.set_ahead(ahead, way));
    }

    /// Calls `tell` for a geom, to tell what became of it.
    pub fn tell_of(&mut self, id: u32, tell: impl FnOnce(&mut Told<'_>)) {
        let next = self.step.wrapping_add(1);
        if let Some(Some(geom)) = self.geoms.get_mut(id as usize) {
            tell(&mut Told { id, geom: Some(geom), next, news: &mut self.news });
        }
    }

    /// Whether a geom may be moved by contacts. Pairs of two that are not awake are not looked at.
    pub fn set_awake(&mut self, id: u32, awake: bool) {
        self.tell_of(id, |geom| geom.set_awake(awake));
    }

    /// Calls `tell` for each of the caller's records, which are numbered as the geoms are, to tell what became of its geom, with all
    /// threads. Each task of [`TOLD`] records has a place for what it finds. As if the calls were made one after the other.
    pub fn tell<S: Send, O: Send + Default>(
        &mut self,
        crew: &Crew,
        records: &mut [S],
        found: &mut Vec<O>,
        tell: impl Fn(u32, &mut S, &mut Told<'_>, &mut O) + Sync,
    ) {
        let next = self.step.wrapping_add(1);
        if self.geoms.len() < records.len() {
            self.geoms.resize_with(records.len(), || None);
        }
        let tasks = records.len().div_ceil(TOLD);
        found.resize_with(tasks, O::default);
        if self.told.len() < tasks {
            self.told.resize_with(tasks, News::default);
        }
        let lists = (chunks(&mut self.geoms[..records.len()], TOLD), chunks(records, TOLD));
        let places = (chunks(found, 1), chunks(&mut self.told, 1));
        crew.each((lists, places), |task, ((geoms, records), (found, news))| {
            for (i, (geom, record)) in geoms.iter_mut().zip(records).enumerate() {
                let id = (task * TOLD + i) as u32;
                let mut told = Told { id, geom: geom.as_mut(), next, news: &mut news[0] };
                tell(id, record, &mut told, &mut found[0]);
            }
        });
        for news in &mut self.told[..tasks] {
            self.news.moved.append(&mut news.moved);
            self.news.woken.append(&mut news.woken);
        }
    }

    /// Where a geom was last said to be.
    pub fn frame(&self, id: u32) -> Option<&Frame> {
        self.geom(id).map(|g| &g.frame)
    }

    /// The shape of a geom.
    pub fn shape(&self, id: u32) -> Option<&Shape> {
        self.geom(id).map(|g| &g.shape)
    }

    /// The manifolds of all pairs of which a geom is awake.
    pub fn contacts(&self) -> Contacts<'_> {
        self.contacts.awake()
    }

    /// All contacts by place, those asleep and vacant places included, and a bit for each that is awake: for solvers that
    /// run over them in parallel. A place stays a contact's own as long as it lasts.
    pub fn contact_places(&mut self) -> (&mut [Contact], &[u64]) {
        self.contacts.places()
    }

    /// As [`PairCache::contact_places`], to look at.
    pub fn places(&self) -> (&[Contact], &[u64]) {
        (&self.contacts.list, &self.contacts.awake)
    }

    /// A bit for each place that is in use, those asleep included.
    pub fn used_places(&self) -> &[u64] {
        &self.contacts.used
    }

    /// The contact at a place.
    pub fn contact(&self, place: u32) -> Option<&Contact> {
        self.contacts.get(place)
    }

    /// The contacts of two geoms, in whatever order they are given.
    pub fn contacts_between(&self, a: u32, b: u32) -> impl Iterator<Item = &Contact> {
        let first = self.table.find(&self.pairs, a, b).map_or(NONE, |p| self.pairs[p as usize].first);
        self.contacts.chain(first).map(|place| self.contacts.at(place))
    }

    /// Number of near pairs.
    pub fn pair_count(&self) -> usize {
        self.pairs.len() - self.free_pairs.len()
    }

    /// Whether nothing was told since the last update, and no pair is awake: another update would find nothing.
    pub fn is_idle(&self) -> bool {
        let told = !(self.news.moved.is_empty() && self.news.woken.is_empty() && self.changed.is_empty());
        !told && self.work.parted.is_empty() && self.awake.iter().all(|word| *word == 0)
    }

    /// Number of contacts, those asleep included.
    pub fn contact_count(&self) -> usize {
        self.contacts.len()
    }

    /// Pairs of geoms that overlap now and did not before the last update.
    pub fn began(&self) -> &[(u32, u32)] {
        &self.began
    }

    /// Pairs of geoms that overlapped before the last update and do not now; those of removed geoms included.
    pub fn ended(&self) -> &[(u32, u32)] {
        &self.ended
    }

    /// Bytes in use, shapes' own data aside.
    pub fn memory(&self) -> usize {
        self.geoms.capacity() * size_of::<Option<GeomState>>()
            + self.pairs.capacity() * size_of::<Pair>()
            + self.table.memory()
            + self.contacts.memory()
            + self.awake.capacity() * 8
            + self.work.memory()
    }

    /// The near pairs of a geom.
    fn pairs_of(&self, id: u32) -> Vec<u32> {
        let mut list = Vec::new();
        if self.unbounded.contains(&id) {
            list.extend((0..self.pairs.len() as u32).filter(|&p| {
                let pair = &self.pairs[p as usize];
                !pair.free && (pair.a == id || pair.b == id)
            }));
            return list;
        }
        let mut add = |other: u32| list.extend(self.table.find(&self.pairs, id, other));
        for leaf in self.still.leaf(id).iter().chain(&self.moving.leaf(id)) {
            self.still.query(leaf, &mut add);
            self.moving.query(leaf, &mut add);
        }
        self.unbounded.iter().for_each(|&u| add(u));
        list.sort_unstable();
        list
    }

    fn remove_pair(&mut self, p: u32) {
        let pair = self.pairs[p as usize];
        if pair.free {
            return;
        }
        if pair.touching {
            self.work.parted.push((pair.a, pair.b));
        }
        self.contacts.remove_chain(pair.first);
        self.table.remove(&self.pairs, pair.a, pair.b);
        self.pairs[p as usize].free = true;
        self.pairs[p as usize].first = NONE;
        set(&mut self.awake, p, false);
        self.free_pairs.push(p);
    }
}

#[inline(always)]
fn set(bits: &mut [u64], i: u32, on: bool) {
    let (word, bit) = ((i >> 6) as usize, 1u64 << (i & 63));
    if on {
        bits[word] |= bit;
    } else {
        bits[word] &= !bit;
    }
}
