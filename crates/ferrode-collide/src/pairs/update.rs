//! One update: from what moved to what touches.

use super::contact::Contact;
use super::geoms::{GeomState, Motion};
use super::tasks::{each, each_chunk};
use super::{NONE, Pair, PairCache, PairSettings, set};
use crate::manifold::{Axis, Manifold, Touching, Workspace, convex_manifold, is_concave, manifolds};
use crate::narrow::collides;
use crate::space::dynamic_tree::DynamicTree;
use crate::space::f32_box::Box32;
use ferrode_math::stage::Crew;

/// Leaves whose pairs are looked for in one task.
const LEAVES: usize = 128;
/// Pairs of one task, a multiple of 64.
const PAIRS: usize = 1024;
/// Contacts of one task, a multiple of 64.
const CONTACTS: usize = 256;
/// Room for new contacts that a task keeps.
const MOST_KEPT: usize = 8;
/// Cosine of the angle by which the normal of a concave pair's manifold may turn in one step.
const SAME_NORMAL: f32 = 0.9;

/// Memory of the tasks, kept from step to step.
#[derive(Clone, Debug, Default)]
pub(super) struct Work {
    boxes: Vec<Vec<(u32, Box32, f64)>>,
    near: Vec<Vec<(u32, u32)>>,
    pairs: Vec<Found>,
    contacts: Vec<Kept>,
    new: [Vec<(u32, Box32)>; 2],
    changes: Vec<(u32, Box32)>,
    created: Vec<(u32, u32)>,
    old: Vec<(u32, Contact)>,
    /// Pairs that ended outside of an update.
    pub parted: Vec<(u32, u32)>,
}

/// What a task of pairs found.
#[derive(Clone, Debug, Default)]
struct Found {
    work: Workspace,
    /// Convex pairs that came near.
    one: Vec<(u32, f64, Manifold)>,
    /// Concave pairs looked at, with the end of their part of `manifolds`.
    several: Vec<(u32, u32)>,
    manifolds: Vec<Manifold>,
    /// Pairs whose leaves are apart.
    gone: Vec<u32>,
    /// Pairs that nobody moves.
    slept: Vec<u32>,
}

/// What a task of contacts found.
#[derive(Clone, Debug, Default)]
struct Kept {
    /// Convex pairs that parted, and how long they may stay unseen.
    parted: Vec<(u32, f64)>,
    /// Overlapping ones not reported yet.
    touching: Vec<u32>,
}

impl Work {
    pub fn memory(&self) -> usize {
        let pairs = self.pairs.iter().map(|p| {
            p.one.capacity() * size_of::<(u32, f64, Manifold)>()
                + p.manifolds.capacity() * size_of::<Manifold>()
        });
        pairs.sum::<usize>()
            + self.boxes.iter().map(|b| b.capacity() * size_of::<(u32, Box32, f64)>()).sum::<usize>()
            + self.near.iter().map(|b| b.capacity() * 8).sum::<usize>()
    }
}

/// The two geoms of a pair.
#[inline(always)]
fn two(geoms: &[Option<GeomState>], a: u32, b: u32) -> Option<(&GeomState, &GeomState)> {
    Some((geoms.get(a as usize)?.as_ref()?, geoms.get(b as usize)?.as_ref()?))
}

/// Points no further apart than this belong to a manifold of the two.
#[inline(always)]
fn margin(settings: &PairSettings, a: &GeomState, b: &GeomState) -> f64 {
    settings.margin + a.ahead_of_both(b)
}

/// The odometers of both, and what the pair looks ahead: see [`GeomState::spent`].
#[inline(always)]
fn spent(a: &GeomState, b: &GeomState) -> f64 {
    a.odometer + b.odometer + a.ahead_of_both(b)
}

/// How far two touching geoms may move until their manifold is found anew.
#[inline(always)]
fn tolerance(settings: &PairSettings, a: &GeomState, b: &GeomState) -> f64 {
    let small = 0.01 * if a.reach < b.reach { a.reach } else { b.reach };
    if small < settings.tolerance { small } else { settings.tolerance }
}

impl PairCache {
    /// Brings pairs and contacts up to date with all that was told since the last update.
    ///
    /// `filter` is asked once for each pair of geoms that come near each other: those it turns away are forgotten until
    /// their boxes part and meet again.
    pub fn update(&mut self, filter: &(dyn Fn(u32, u32) -> bool + Sync)) {
        self.update_with(&Crew::default(), filter);
    }

    /// As [`PairCache::update`], with more threads; `filter` may be asked by several at once, in no order. The outcome is the same.
    pub fn update_with(&mut self, crew: &Crew, filter: &(dyn Fn(u32, u32) -> bool + Sync)) {
        self.step = self.step.wrapping_add(1);
        self.began.clear();
        self.ended.clear();
        self.ended.append(&mut self.work.parted);
        self.move_leaves(crew);
        self.find_pairs(crew, filter);
        self.wake_pairs();
        let tasks = self.look_at_pairs(crew);
        let kept = self.look_at_contacts(crew);
        self.apply(tasks, kept);
        self.news.moved.clear();
        self.changed.clear();
    }

    /// Fits leaves to the geoms that may have left theirs.
    fn move_leaves(&mut self, crew: &Crew) {
        let Self { geoms, still, moving, unbounded, news, changed, work, settings, step, .. } = self;
        let Work { boxes, new, changes, .. } = work;
        let tree =
            |g: &GeomState, id: u32| if g.motion == Motion::Fixed { still.leaf(id) } else { moving.leaf(id) };
        each_chunk(crew, &news.moved, PAIRS, boxes, |ids, out| {
            out.clear();
            for &id in ids {
                let Some(Some(g)) = geoms.get(id as usize) else { continue };
                if g.spent() <= g.leaf_limit || !g.bounded {
                    continue;
                }
                let around = g.around(settings.margin);
                let old = tree(g, id);
                let (mut leaf, mut room) = g.leaf(&around, settings.fat, old);
                if let Some(old) = old.filter(|o| o.contains(&around)) {
                    // Still within, by the smallest of the gaps.
                    let o = old.aabb();
                    let (low, high) = (around.min - o.min, o.max - around.max);
                    (leaf, room) = (old, low.x.min(low.y).min(low.z).min(high.x.min(high.y).min(high.z)));
                }
                out.push((id, leaf, g.spent() + room.max(0.0)));
            }
        });
        let tasks = news.moved.len().div_ceil(PAIRS);
        for &(id, leaf, limit) in boxes[..tasks].iter().flatten() {
            let Some(Some(g)) = geoms.get_mut(id as usize) else { continue };
            g.leaf_limit = limit;
            let fixed = g.motion == Motion::Fixed;
            let old = if fixed { still.leaf(id) } else { moving.leaf(id) };
            if old == Some(leaf) {
                continue;
            }
            g.leaf_changed = *step;
            changed.push(id);
            if fixed {
                still.remove(id);
                new[0].push((id, leaf));
            } else if old.is_some() {
                changes.push((id, leaf));
            } else {
                new[1].push((id, leaf));
            }
        }
        for &id in &news.moved {
            let Some(Some(g)) = geoms.get_mut(id as usize) else { continue };
            if !g.bounded {
                g.leaf_changed = *step;
                if !unbounded.contains(&id) {
                    unbounded.push(id);
                }
                changed.push(id);
            }
        }
        moving.change_all(changes);
        still.insert_all(&mut new[0], false);
        moving.insert_all(&mut new[1], true);
    }

    /// Makes pairs of changed leaves and those they overlap.
    fn find_pairs(&mut self, crew: &Crew, filter: &(dyn Fn(u32, u32) -> bool + Sync)) {
        let Self { geoms, still, moving, unbounded, pairs, table, changed, work, step, .. } = self;
        let Work { near, created, .. } = work;
        each_chunk(crew, changed, LEAVES, near, |ids, out| {
            out.clear();
            for &id in ids {
                let Some(Some(g)) = geoms.get(id as usize) else { continue };
                let mut consider = |other: u32| {
                    let Some(Some(o)) = geoms.get(other as usize) else { return };
                    let fixed = g.motion == Motion::Fixed && o.motion == Motion::Fixed;
                    // Two that changed find each other: once is enough.
                    let first = o.leaf_changed != *step || id < other;
                    if id != other && first && !fixed && table.find(pairs, id, other).is_none() {
                        out.push((id.min(other), id.max(other)));
                    }
                };
                if !g.bounded {
                    let mut meet = |(other, leaf): (u32, Box32)| {
                        if g.meets(&leaf) {
                            consider(other);
                        }
                    };
                    moving.leaves().for_each(&mut meet);
                    still.leaves().for_each(&mut meet);
                    continue;
                }
                let fixed = g.motion == Motion::Fixed;
                let Some(leaf) = (if fixed { still.leaf(id) } else { moving.leaf(id) }) else { continue };
                moving.query(&leaf, &mut consider);
                if !fixed {
                    still.query(&leaf, &mut consider);
                }
                for &u in unbounded.iter() {
                    if let Some(Some(plane)) = geoms.get(u as usize)
                        && plane.meets(&leaf)
                    {
                        consider(u);
                    }
                }
            }
        });
        let tasks = changed.len().div_ceil(LEAVES);
        created.clear();
        near[..tasks].iter().for_each(|n| created.extend_from_slice(n));
        created.sort_unstable();
        for k in 0..self.work.created.len() {
            let (a, b) = self.work.created[k];
            if filter(a, b) {
                self.add_pair(a, b);
            }
        }
    }

    fn add_pair(&mut self, a: u32, b: u32) {
        let Some((ga, gb)) = two(&self.geoms, a, b) else { return };
        if !collides(ga.shape.kind(), gb.shape.kind()) {
            return;
        }
        let ((a, ga), (b, gb)) = if gb.before(ga) { ((b, gb), (a, ga)) } else { ((a, ga), (b, gb)) };
        let pair = Pair {
            a,
            b,
            first: NONE,
            axis: Axis::of_fixed(ga.motion == Motion::Fixed, gb.motion == Motion::Fixed),
            concave: is_concave(&ga.shape, &gb.shape),
            touching: false,
            free: false,
            limit: f64::NEG_INFINITY,
        };
        let place = match self.free_pairs.pop() {
            Some(place) => {
                self.pairs[place as usize] = pair;
                place
            }
            None => {
                if self.pairs.len() == self.pairs.capacity() {
                    self.pairs.reserve_exact((self.pairs.len() / 8).max(256));
                }
                self.pairs.push(pair);
                self.pairs.len() as u32 - 1
            }
        };
        if self.pairs.len() > 64 * self.awake.len() {
            self.awake.push(0);
        }
        set(&mut self.awake, place, true);
        self.table.insert(&self.pairs, place);
    }

    /// Looks again at the pairs of geoms that woke.
    fn wake_pairs(&mut self) {
        for k in 0..self.news.woken.len() {
            for p in self.pairs_of(self.news.woken[k]) {
                set(&mut self.awake, p, true);
                self.contacts.set_chain_awake(self.pairs[p as usize].first, true);
            }
        }
        self.news.woken.clear();
    }

    /// Near pairs: those whose leaves parted, those that nobody moves, those that may touch now. Returns the number of
    /// tasks.
    fn look_at_pairs(&mut self, crew: &Crew) -> usize {
        let Self { geoms, still, moving, pairs, awake, work, settings, step, .. } = self;
        each(crew, pairs, awake, PAIRS, &mut work.pairs, |first, pairs, bits, out| {
            out.one.clear();
            out.several.clear();
            out.manifolds.clear();
            out.gone.clear();
            out.slept.clear();
            for_bits(bits, |i| {
                let (pair, place) = (&mut pairs[i], (first + i) as u32);
                let Some((a, b)) = two(geoms, pair.a, pair.b) else { return };
                if !a.awake() && !b.awake() && a.moved != *step && b.moved != *step {
                    out.slept.push(place);
                    return;
                }
                let changed = a.leaf_changed == *step || b.leaf_changed == *step;
                if changed && !leaves_meet(still, moving, (pair.a, a), (pair.b, b)) {
                    out.gone.push(place);
                    return;
                }
                if pair.first != NONE && !pair.concave {
                    return;
                }
                let sum = spent(a, b);
                // What has no bounds keeps no odometer of its turns.
                let turned = (!a.bounded && a.moved == *step) || (!b.bounded && b.moved == *step);
                if sum <= pair.limit && !turned {
                    return;
                }
                let margin = margin(settings, a, b);
                let (sa, sb) = ((&a.shape, &a.frame), (&b.shape, &b.frame));
                if pair.concave {
                    let before = out.manifolds.len();
                    let apart = manifolds(sa, sb, margin, &mut out.work, &mut out.manifolds);
                    let none = out.manifolds.len() == before;
                    pair.limit = sum + if none { apart } else { tolerance(settings, a, b) };
                    if !(none && pair.first == NONE) {
                        out.several.push((place, out.manifolds.len() as u32));
                    }
                    return;
                }
                let mut manifold = Manifold::default();
                match convex_manifold(sa, sb, margin, &mut pair.axis, &mut manifold) {
                    Touching::Apart(by) => pair.limit = sum + by,
                    Touching::Yes if manifold.is_sound() => {
                        out.one.push((place, sum + tolerance(settings, a, b), manifold));
                    }
                    Touching::Yes => pair.limit = sum,
                }
            });
        });
        self.pairs.len().div_ceil(PAIRS)
    }

    /// Contacts: refreshed, or of convex pairs that moved further, found anew. Returns the number of tasks.
    fn look_at_contacts(&mut self, crew: &Crew) -> usize {
        let Self { geoms, pairs, contacts, work, settings, step, .. } = self;
        let (list, awake) = contacts.places();
        let tasks = list.len().div_ceil(CONTACTS);
        each(crew, list, awake, CONTACTS, &mut work.contacts, |first, list, bits, out| {
            out.parted.clear();
            out.touching.clear();
            for_bits(bits, |i| {
                let (contact, place) = (&mut list[i], (first + i) as u32);
                let Some((a, b)) = two(geoms, contact.a, contact.b) else { return };
                if a.moved != *step && b.moved != *step {
                    return;
                }
                let sum = spent(a, b);
                let turned = (!a.bounded && a.moved == *step) || (!b.bounded && b.moved == *step);
                let pair = &pairs[contact.pair as usize];
                if contact.concave || (sum <= contact.limit && !turned) {
                    contact.manifold.refresh(&a.frame, &b.frame);
                } else {
                    let margin = margin(settings, a, b);
                    let mut axis = pair.axis;
                    let (sa, sb) = ((&a.shape, &a.frame), (&b.shape, &b.frame));
                    match convex_manifold(sa, sb, margin, &mut axis, &mut contact.manifold) {
                        Touching::Yes if contact.manifold.is_sound() => {
                            contact.limit = sum + tolerance(settings, a, b);
                        }
                        Touching::Yes => out.parted.push((place, sum)),
                        Touching::Apart(by) => out.parted.push((place, sum + by)),
                    }
                }
                if !pair.touching && contact.manifold.depth() >= 0.0 {
                    out.touching.push(place);
                }
            });
        });
        tasks
    }

    /// What the tasks found, in their order.
    fn apply(&mut self, tasks: usize, kept: usize) {
        let mut contacts = core::mem::take(&mut self.work.contacts);
        for task in &contacts[..kept] {
            for &(place, limit) in &task.parted {
                let pair = self.contacts.at(place).pair;
                let p = &mut self.pairs[pair as usize];
                p.limit = limit;
                if core::mem::take(&mut p.touching) {
                    self.ended.push((p.a, p.b));
                }
                p.first = NONE;
                self.contacts.remove_chain(place);
            }
            for &place in &task.touching {
                if let Some(c) = self.contacts.get(place) {
                    self.touch(c.pair);
                }
            }
        }
        core::mem::swap(&mut self.work.contacts, &mut contacts);
        let mut found = core::mem::take(&mut self.work.pairs);
        for task in &mut found[..tasks] {
            let mut start = 0;
            for &(pair, end) in &task.several {
                self.replace(pair, &mut task.manifolds[start..end as usize]);
                start = end as usize;
            }
            for (pair, limit, manifold) in &task.one {
                let p = &self.pairs[*pair as usize];
                let contact = Contact {
                    manifold: *manifold,
                    a: p.a,
                    b: p.b,
                    tag: 0,
                    pair: *pair,
                    next: NONE,
                    concave: false,
                    limit: *limit,
                };
                self.pairs[*pair as usize].first = self.contacts.add(contact);
                if manifold.depth() >= 0.0 {
                    self.touch(*pair);
                }
            }
            if task.one.capacity() > MOST_KEPT {
                // A world is filled once: what that took is not held for ever.
                task.one = Vec::new();
            }
            for &pair in &task.gone {
                self.remove_pair(pair);
            }
            for &pair in &task.slept {
                set(&mut self.awake, pair, false);
                self.contacts.set_chain_awake(self.pairs[pair as usize].first, false);
            }
        }
        self.work.pairs = found;
        self.ended.append(&mut self.work.parted);
    }

    /// Reports a pair as touching, once.
    fn touch(&mut self, pair: u32) {
        let p = &mut self.pairs[pair as usize];
        if !p.touching {
            p.touching = true;
            self.began.push((p.a, p.b));
        }
    }

    /// Gives a concave pair other manifolds: each takes over the place and impulses of the former one with the nearest
    /// normal.
    fn replace(&mut self, pair: u32, manifolds: &mut [Manifold]) {
        let p = self.pairs[pair as usize];
        let reach = two(&self.geoms, p.a, p.b).map_or(0.0, |(a, b)| 0.1 * a.reach.min(b.reach)) as f32;
        let mut old = core::mem::take(&mut self.work.old);
        old.clear();
        old.extend(self.contacts.chain(p.first).map(|c| (c, *self.contacts.at(c))));
        let mut first = NONE;
        let mut depth = f32::NEG_INFINITY;
        for m in manifolds.iter_mut().rev() {
            let mut best = (SAME_NORMAL, None);
            for (k, (_, o)) in old.iter().enumerate() {
                let cosine = o.manifold.normal.dot(m.normal);
                if cosine > best.0 {
                    best = (cosine, Some(k));
                }
            }
            let mut contact = Contact {
                manifold: *m,
                a: p.a,
                b: p.b,
                tag: 0,
                pair,
                next: first,
                concave: true,
                limit: 0.0,
            };
            first = if let Some(k) = best.1 {
                let (place, o) = old.swap_remove(k);
                contact.manifold.inherit(&o.manifold, reach);
                contact.tag = o.tag;
                self.contacts.list[place as usize] = contact;
                place
            } else {
                self.contacts.add(contact)
            };
            let d = m.depth();
            depth = if d > depth { d } else { depth };
        }
        for (place, _) in &old {
            self.contacts.list[*place as usize].next = NONE;
            self.contacts.remove_chain(*place);
        }
        self.work.old = old;
        let p = &mut self.pairs[pair as usize];
        p.first = first;
        if first == NONE && core::mem::take(&mut p.touching) {
            self.ended.push((p.a, p.b));
        }
        if depth >= 0.0 {
            self.touch(pair);
        }
    }
}

/// Calls `visit` with the number of each bit that is set.
#[inline(always)]
fn for_bits(words: &[u64], mut visit: impl FnMut(usize)) {
    for (w, &word) in words.iter().enumerate() {
        let mut bits = word;
        while bits != 0 {
            visit(64 * w + bits.trailing_zeros() as usize);
            bits &= bits - 1;
        }
    }
}

/// Whether the leaves of two geoms overlap.
fn leaves_meet(
    still: &DynamicTree,
    moving: &DynamicTree,
    (ia, a): (u32, &GeomState),
    (ib, b): (u32, &GeomState),
) -> bool {
    let leaf = |g: &GeomState, id: u32| {
        if g.motion == Motion::Fixed { still.leaf(id) } else { moving.leaf(id) }
    };
    match (a.bounded, b.bounded) {
        (true, true) => leaf(a, ia).zip(leaf(b, ib)).is_some_and(|(x, y)| x.overlaps(&y)),
        (true, false) => leaf(a, ia).is_some_and(|x| b.meets(&x)),
        (false, true) => leaf(b, ib).is_some_and(|x| a.meets(&x)),
        (false, false) => false,
    }
}
