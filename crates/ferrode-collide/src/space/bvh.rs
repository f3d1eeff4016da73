use super::tree::AabbTree;
use super::{BroadPhase, Members, Proxy, ProxyId, ProxyTable, Scratch};
use crate::filter::passes;
use ferrode_math::Aabb;

/// Leaves are larger than the geoms by this part of their size, so that small moves change nothing.
const FAT: f64 = 0.1;
/// No leaf: the geom's box is unbounded, or it is not in this space.
const NONE: u32 = u32::MAX;

/// A tree of boxes that is kept from step to step: the space for many geoms of which most move little.
///
/// Pairs come in the order in which the geoms were inserted, the earlier one first; neither movement nor numbering
/// changes it. ODE has no such space.
#[derive(Clone, Debug, Default)]
pub struct BvhSpace {
    members: Members,
    tree: AabbTree,
    /// By proxy number.
    entries: Vec<Entry>,
    moved: Vec<ProxyId>,
    unbounded: Vec<ProxyId>,
    next_rank: u64,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    leaf: u32,
    moved: bool,
    /// Insertions before this one.
    rank: u64,
}

impl BvhSpace {
    /// A space without members.
    pub fn new() -> Self {
        Self::default()
    }

    fn entry(&self, id: ProxyId) -> &Entry {
        &self.entries[id.0 as usize]
    }

    fn mark(&mut self, id: ProxyId) {
        let entry = &mut self.entries[id.0 as usize];
        if !entry.moved {
            entry.moved = true;
            self.moved.push(id);
        }
    }

    /// Takes a proxy out of the tree or the list of unbounded ones.
    fn unlink(&mut self, id: ProxyId) {
        let entry = &mut self.entries[id.0 as usize];
        if entry.leaf != NONE {
            self.tree.remove(entry.leaf);
            entry.leaf = NONE;
        } else {
            self.unbounded.retain(|&x| x != id);
        }
    }

    /// Puts a pair in order of insertion.
    fn ordered(&self, a: ProxyId, b: ProxyId) -> (u64, u64, ProxyId, ProxyId) {
        let (ra, rb) = (self.entry(a).rank, self.entry(b).rank);
        if ra < rb { (ra, rb, a, b) } else { (rb, ra, b, a) }
    }
}

impl BroadPhase for BvhSpace {
    fn insert(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.push_front(table, id);
        let i = id.0 as usize;
        if i >= self.entries.len() {
            self.entries.resize(i + 1, Entry { leaf: NONE, moved: false, rank: 0 });
        }
        self.entries[i] = Entry { leaf: NONE, moved: false, rank: self.next_rank };
        self.next_rank += 1;
        self.mark(id);
    }

    fn remove(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.remove(table, id);
        self.unlink(id);
        if self.entry(id).moved {
            self.moved.retain(|&x| x != id);
        }
    }

    fn moved(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.to_front(table, id);
        self.mark(id);
    }

    fn update(&mut self, table: &ProxyTable) {
        for k in 0..self.moved.len() {
            let id = self.moved[k];
            let aabb = table.get(id).aabb;
            let entry = &mut self.entries[id.0 as usize];
            entry.moved = false;
            if entry.leaf != NONE && self.tree.aabb(entry.leaf).contains(&aabb) {
                continue;
            }
            self.unlink(id);
            if aabb.is_finite() {
                let e = aabb.extent();
                let fat = aabb.expanded(FAT * e.x.max(e.y).max(e.z));
                self.entries[id.0 as usize].leaf = self.tree.insert(id.0, fat);
            } else {
                self.unbounded.push(id);
            }
        }
        self.moved.clear();
    }

    fn collide(&self, table: &ProxyTable, scratch: &mut Scratch, report: &mut dyn FnMut(ProxyId, ProxyId)) {
        let s = &mut scratch.bvh;
        s.pairs.clear();
        let pairs = &mut s.pairs;
        let mut consider = |a: ProxyId, b: ProxyId| {
            let (pa, pb) = (table.get(a), table.get(b));
            if pa.enabled && pb.enabled && passes(pa, pb) {
                pairs.push(self.ordered(a, b));
            }
        };
        self.tree.pairs(&mut s.stack, |a, b| consider(ProxyId(a), ProxyId(b)));
        for (i, &a) in self.unbounded.iter().enumerate() {
            for &b in &self.unbounded[..i] {
                consider(a, b);
            }
            self.tree.query(&table.get(a).aabb, |b| consider(a, ProxyId(b)));
        }
        pairs.sort_unstable_by_key(|p| (p.0, p.1));
        for &(_, _, a, b) in pairs.iter() {
            report(a, b);
        }
    }

    /// In the order of the tree.
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
        self.tree.query(&proxy.aabb, |id| consider(ProxyId(id)));
    }

    /// In the order of the tree.
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
        self.tree.walk(test, |id| {
            consider(ProxyId(id));
            true
        });
    }

    fn members(&self) -> &Members {
        &self.members
    }
}

/// Working memory of a search.
#[derive(Clone, Debug, Default)]
pub(crate) struct BvhScratch {
    stack: Vec<(u32, u32)>,
    pairs: Vec<(u64, u64, ProxyId, ProxyId)>,
}
