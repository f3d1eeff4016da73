use super::dynamic_tree::DynamicTree;
use super::f32_box::Box32;
use super::{BroadPhase, Members, Probe, Proxy, ProxyId, ProxyTable, Scratch, TurnedBox};
use crate::filter::passes;
use ferrode_math::{Aabb, Vec3};

/// Leaves of what moves are larger than the geoms by this part of their size, so that small moves change nothing.
const FAT: f64 = 0.2;
/// A leaf that its geom left grows in the direction of the move by this part of it: the geom will go on.
const AHEAD: f64 = 1.0;

/// Trees of boxes that are kept from step to step: the space for many geoms of which most move little.
///
/// ```text
///   still tree    what has not moved since it was added: leaves fit tightly, and are left alone
///   moving tree   the rest: leaves are larger than their geoms and change only when these leave them
///   unbounded     planes: compared with everything
///   near          all pairs whose leaves overlap, sorted; only a leaf that changed looks for its pairs anew
/// ```
///
/// A step costs what moved, and what is near something. Pairs come in the order in which the geoms were inserted, the
/// earlier one first; neither movement nor numbering changes it. ODE has no such space.
#[derive(Clone, Debug, Default)]
pub struct BvhSpace {
    members: Members,
    still: DynamicTree,
    moving: DynamicTree,
    /// By proxy number.
    entries: Vec<Entry>,
    /// Marked since the last update.
    moved: Vec<ProxyId>,
    unbounded: Vec<ProxyId>,
    /// A bit a proxy: whether it may be switched off. Who has none need not be looked up in the table.
    off: Vec<u64>,
    next_rank: u64,
    near: Vec<Pair>,
    /// Working memory of the update.
    work: Work,
}

#[derive(Clone, Debug, Default)]
struct Work {
    changed: Vec<ProxyId>,
    found: Vec<Pair>,
    merged: Vec<Pair>,
    stack: Vec<(u32, u32)>,
    /// New leaves of the still and of the moving tree.
    new: [Vec<(u32, Box32)>; 2],
    /// New boxes of leaves of the moving tree.
    changes: Vec<(u32, Box32)>,
}

/// Two members in order of insertion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Pair {
    ranks: (u64, u64),
    a: ProxyId,
    b: ProxyId,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Home {
    /// Not in this space, or added since the last update.
    None,
    Still,
    Moving,
    Unbounded,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Insertions before this one: no two members ever have the same.
    rank: u64,
    home: Home,
    moved: bool,
    /// Its leaf is another than at the last update.
    changed: bool,
}

const ABSENT: Entry = Entry { rank: u64::MAX, home: Home::None, moved: false, changed: false };

impl BvhSpace {
    /// A space without members.
    pub fn new() -> Self {
        Self::default()
    }

    /// The boxes of all nodes of its trees as of the last search, from the roots down; for those who draw them.
    pub fn boxes(&self) -> Vec<Aabb> {
        let boxes = core::cell::RefCell::new(Vec::new());
        for tree in [&self.still, &self.moving] {
            let note = |b: &Box32| {
                boxes.borrow_mut().push(b.aabb());
                true
            };
            tree.walk(note, |_| {});
        }
        boxes.into_inner()
    }

    fn entry(&self, id: ProxyId) -> &Entry {
        &self.entries[id.0 as usize]
    }

    /// Notes whether a proxy may be switched off.
    fn note_off(&mut self, id: ProxyId, off: bool) {
        let (word, bit) = ((id.0 >> 6) as usize, 1 << (id.0 & 63));
        if word >= self.off.len() {
            self.off.resize(word + 1, 0);
        }
        if off {
            self.off[word] |= bit;
        } else {
            self.off[word] &= !bit;
        }
    }

    #[inline]
    fn is_enabled(&self, table: &ProxyTable, id: ProxyId) -> bool {
        let may_be_off = self.off.get((id.0 >> 6) as usize).is_none_or(|w| w >> (id.0 & 63) & 1 != 0);
        !may_be_off || table.get(id).enabled
    }

    fn mark(&mut self, id: ProxyId) {
        let entry = &mut self.entries[id.0 as usize];
        if !entry.moved {
            entry.moved = true;
            self.moved.push(id);
        }
    }

    /// Takes a proxy from where it is.
    fn unlink(&mut self, id: ProxyId) {
        match core::mem::replace(&mut self.entries[id.0 as usize].home, Home::None) {
            Home::None => {}
            Home::Still => self.still.remove(id.0),
            Home::Moving => self.moving.remove(id.0),
            Home::Unbounded => self.unbounded.retain(|&x| x != id),
        }
    }

    /// Puts leaves where their geoms are, and notes which are others than before.
    fn move_leaves(&mut self, table: &ProxyTable) {
        for k in 0..self.moved.len() {
            let id = self.moved[k];
            let entry = &mut self.entries[id.0 as usize];
            if !core::mem::take(&mut entry.moved) {
                // Removed, or removed and added again.
                continue;
            }
            let (home, aabb) = (entry.home, &table.get(id).aabb);
            let old = match home {
                Home::Still => self.still.leaf(id.0),
                Home::Moving => self.moving.leaf(id.0),
                Home::None | Home::Unbounded => None,
            };
            if old.is_some_and(|leaf| leaf.contains(aabb)) {
                if home == Home::Still {
                    self.still.turn(id.0);
                }
                continue;
            }
            entry.changed = true;
            self.work.changed.push(id);
            if home == Home::Moving && aabb.is_finite() {
                self.work.changes.push((id.0, fat(aabb, old)));
                continue;
            }
            self.unlink(id);
            self.entries[id.0 as usize].home = if !aabb.is_finite() {
                self.unbounded.push(id);
                Home::Unbounded
            } else if home == Home::None {
                self.work.new[0].push((id.0, Box32::around(aabb)));
                Home::Still
            } else {
                self.work.new[1].push((id.0, fat(aabb, None)));
                Home::Moving
            };
        }
        self.moved.clear();
        let Work { new, changes, .. } = &mut self.work;
        self.moving.change_all(changes);
        self.still.insert_all(&mut new[0], false);
        self.moving.insert_all(&mut new[1], true);
    }

    /// Finds the pairs of the leaves that changed, and forgets those that they had before.
    fn find_pairs(&mut self) {
        let Self { still, moving, entries, near, work, members, .. } = self;
        let Work { changed, found, merged, stack, .. } = work;
        let pair = |a: u32, b: u32| {
            let (ra, rb) = (entries[a as usize].rank, entries[b as usize].rank);
            let (a, b) = (ProxyId(a), ProxyId(b));
            if ra < rb { Pair { ranks: (ra, rb), a, b } } else { Pair { ranks: (rb, ra), a: b, b: a } }
        };
        found.clear();
        let still_changed = changed.iter().filter(|id| entries[id.0 as usize].home != Home::Moving).count();
        // Of a tree of which most leaves changed, all pairs are found anew: one walk down two branches at a time.
        let all = still_changed > 0 && 2 * changed.len() > members.len();
        let all_moving = all || (still_changed == 0 && 2 * changed.len() > moving.len());
        if all {
            still.pairs(stack, |a, b| found.push(pair(a, b)));
        }
        if all_moving {
            moving.pairs(stack, |a, b| found.push(pair(a, b)));
            moving.pairs_with(still, stack, |a, b| found.push(pair(a, b)));
        } else {
            for &id in changed.iter() {
                let entry = &entries[id.0 as usize];
                let leaf = match entry.home {
                    Home::Still => still.leaf(id.0),
                    Home::Moving => moving.leaf(id.0),
                    Home::None | Home::Unbounded => None,
                };
                let Some(leaf) = leaf else { continue };
                let mut consider = |other: u32| {
                    let o = &entries[other as usize];
                    // Two that changed find each other: once is enough.
                    if (!o.changed && other != id.0) || entry.rank < o.rank {
                        found.push(pair(id.0, other));
                    }
                };
                moving.query(&leaf, &mut consider);
                still.query(&leaf, &mut consider);
            }
        }
        found.sort_unstable();
        merged.clear();
        let stays = |p: &&Pair| {
            let fresh = |e: &Entry| all || e.changed || (all_moving && e.home == Home::Moving);
            let (a, b) = (&entries[p.a.0 as usize], &entries[p.b.0 as usize]);
            !fresh(a) && !fresh(b) && p.ranks == (a.rank, b.rank)
        };
        merge(near.iter().filter(stays), found.iter(), |p| merged.push(*p));
        core::mem::swap(near, merged);
        for id in changed.drain(..) {
            entries[id.0 as usize].changed = false;
        }
    }
}

/// The leaf of a box that left the leaf `old`: larger all round, and further ahead.
fn fat(aabb: &Aabb, old: Option<Box32>) -> Box32 {
    let e = aabb.extent();
    let fat = aabb.expanded(FAT * e.x.max(e.y).max(e.z));
    let Some(old) = old else { return Box32::around(&fat) };
    let center = Vec3::new(old.center2(0).into(), old.center2(1).into(), old.center2(2).into()) * 0.5;
    let ahead = (aabb.center() - center) * AHEAD;
    // What jumped does not go on like that.
    let ahead = if ahead.abs_max() < e.abs_max() { ahead } else { Vec3::ZERO };
    Box32::around(&Aabb::new(fat.min + ahead.min(Vec3::ZERO), fat.max + ahead.max(Vec3::ZERO)))
}

/// Calls `take` with the items of two sorted lists in order.
fn merge<'a>(
    a: impl Iterator<Item = &'a Pair>,
    b: impl Iterator<Item = &'a Pair>,
    mut take: impl FnMut(&Pair),
) {
    let (mut a, mut b) = (a.peekable(), b.peekable());
    while let Some(y) = b.peek() {
        while let Some(x) = a.next_if(|x| x < y) {
            take(x);
        }
        take(y);
        b.next();
    }
    a.for_each(take);
}

impl BroadPhase for BvhSpace {
    fn insert(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.push_front(table, id);
        self.note_off(id, !table.get(id).enabled);
        let i = id.0 as usize;
        if i >= self.entries.len() {
            self.entries.resize(i + 1, ABSENT);
        }
        self.entries[i] = Entry { rank: self.next_rank, ..ABSENT };
        self.next_rank += 1;
        self.mark(id);
    }

    fn remove(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.remove(table, id);
        self.unlink(id);
        self.entries[id.0 as usize] = ABSENT;
    }

    /// The list stays as it is: to reorder it costs more than all else that moving a geom does.
    fn moved(&mut self, _: &mut ProxyTable, id: ProxyId) {
        self.mark(id);
    }

    fn switched(&mut self, id: ProxyId) {
        self.note_off(id, true);
    }

    fn marked(&self) -> Option<&[ProxyId]> {
        Some(&self.moved)
    }

    fn update(&mut self, table: &ProxyTable) {
        self.move_leaves(table);
        if !self.work.changed.is_empty() {
            self.find_pairs();
        }
    }

    fn collide(&self, table: &ProxyTable, scratch: &mut Scratch, report: &mut dyn FnMut(ProxyId, ProxyId)) {
        let list = &mut scratch.bvh.pairs;
        list.clear();
        let mut add = |a: ProxyId, b: ProxyId| {
            let (pa, pb) = (table.get(a), table.get(b));
            let (ra, rb) = (self.entry(a).rank, self.entry(b).rank);
            if pa.enabled && pb.enabled && passes(pa, pb) {
                list.push(if ra < rb {
                    Pair { ranks: (ra, rb), a, b }
                } else {
                    Pair { ranks: (rb, ra), a: b, b: a }
                });
            }
        };
        for (i, &a) in self.unbounded.iter().enumerate() {
            for &b in &self.unbounded[..i] {
                add(a, b);
            }
            let around = Box32::around(&table.get(a).aabb);
            self.still.query(&around, |b| add(a, ProxyId(b)));
            self.moving.query(&around, |b| add(a, ProxyId(b)));
        }
        list.sort_unstable();
        let touches = |p: &&Pair| {
            let (pa, pb) = (table.get(p.a), table.get(p.b));
            passes(pa, pb)
                && pa.enabled
                && pb.enabled
                // Not removed since the update.
                && p.ranks == (self.entry(p.a).rank, self.entry(p.b).rank)
        };
        merge(self.near.iter().filter(touches), list.iter(), |p| report(p.a, p.b));
    }

    /// In the order of the trees.
    fn collide_with(
        &self,
        table: &ProxyTable,
        _: Option<ProxyId>,
        proxy: &Proxy,
        report: &mut dyn FnMut(ProxyId),
    ) {
        let mut consider = |id: ProxyId| {
            let member = table.get(id);
            if member.enabled && passes(proxy, member) {
                report(id);
            }
        };
        for &id in &self.unbounded {
            consider(id);
        }
        let around = Box32::around(&proxy.aabb);
        self.still.query(&around, |id| consider(ProxyId(id)));
        self.moving.query(&around, |id| consider(ProxyId(id)));
    }

    /// In the order of the trees.
    fn visit(&self, table: &ProxyTable, test: &dyn Fn(&Aabb) -> bool, report: &mut dyn FnMut(ProxyId)) {
        let mut consider = |id: ProxyId| {
            let member = table.get(id);
            if member.enabled && test(&member.aabb) {
                report(id);
            }
        };
        for &id in &self.unbounded {
            consider(id);
        }
        self.still.walk(|b| test(&b.aabb()), |id| consider(ProxyId(id)));
        self.moving.walk(|b| test(&b.aabb()), |id| consider(ProxyId(id)));
    }

    fn seek(
        &self,
        table: &ProxyTable,
        probe: &Probe,
        limit: &mut f64,
        turned: &dyn Fn(ProxyId) -> Option<TurnedBox>,
        report: &mut dyn FnMut(ProxyId, &mut f64),
    ) {
        let mut consider = |id: ProxyId, limit: &mut f64| {
            let member = table.get(id);
            // Leaves of what moves are larger than the geom: look at its own box before its shape is asked.
            if member.enabled && probe.enter_aabb(&member.aabb, *limit).is_some() {
                report(id, limit);
            }
        };
        for &id in &self.unbounded {
            consider(id, limit);
        }
        // Within its leaf what moves may turn at any time.
        self.moving.seek(probe, limit, &|_| None, |id, limit| consider(ProxyId(id), limit));
        self.still.seek(probe, limit, &|id| turned(ProxyId(id)), |id, limit| {
            if self.is_enabled(table, ProxyId(id)) {
                report(ProxyId(id), limit);
            }
        });
    }

    fn members(&self) -> &Members {
        &self.members
    }
}

/// Working memory of a search.
#[derive(Clone, Debug, Default)]
pub(crate) struct BvhScratch {
    pairs: Vec<Pair>,
}
