//! Sorting the boxes along an axis (ODE's sweep-and-prune space; Terdiman, *Sweep-and-prune*, 2007, and *Radix sort
//! revisited*, 2000).

use super::{BroadPhase, Members, Proxy, ProxyId, ProxyTable, Scratch};
use crate::filter::{may_collide, passes};

/// The order in which a sweep looks at the axes: sorted by the first, tested on the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct AxisOrder([u8; 3]);

impl AxisOrder {
    /// x, y, z.
    pub const XYZ: Self = Self([0, 1, 2]);
    /// x, z, y.
    pub const XZY: Self = Self([0, 2, 1]);
    /// y, x, z.
    pub const YXZ: Self = Self([1, 0, 2]);
    /// y, z, x.
    pub const YZX: Self = Self([1, 2, 0]);
    /// z, x, y.
    pub const ZXY: Self = Self([2, 0, 1]);
    /// z, y, x.
    pub const ZYX: Self = Self([2, 1, 0]);

    /// From ODE's number: the axes in fields of two bits, the first in the lowest. `None` unless each axis comes once.
    pub fn from_ode(order: i32) -> Option<Self> {
        let axes = [order & 3, order >> 2 & 3, order >> 4 & 3];
        let mut sorted = axes;
        sorted.sort_unstable();
        ((0..64).contains(&order) && sorted == [0, 1, 2]).then(|| Self(axes.map(|a| a as u8)))
    }

    fn axes(self) -> [usize; 3] {
        self.0.map(usize::from)
    }
}

/// Sorts boxes by their lower bound on one axis and compares those whose intervals overlap. For scenes that spread
/// along that axis.
///
/// Geoms without an upper bound on that axis (planes) are reported with all others, as in ODE, whatever their boxes.
#[derive(Clone, Debug)]
pub struct SweepAndPruneSpace {
    members: Members,
    order: AxisOrder,
    /// In no order but that of what happened: what leaves is replaced by the last.
    clean: Vec<ProxyId>,
    dirty: Vec<ProxyId>,
    /// By proxy number: place in `clean` or `dirty`.
    places: Vec<Place>,
    sorted: Sorted,
    /// Members came, went, or were switched on since the last update.
    stale: bool,
}

#[derive(Clone, Copy, Debug)]
struct Place {
    index: u32,
    dirty: bool,
}

/// The enabled members at the last update.
#[derive(Clone, Debug, Default)]
struct Sorted {
    unbounded: Vec<ProxyId>,
    bounded: Vec<ProxyId>,
    keys: Vec<f32>,
    /// Places in `bounded` by rising key. Kept as the start of the next sort.
    ranks: Vec<u32>,
    places: Vec<u32>,
}

impl Sorted {
    fn update(&mut self, table: &ProxyTable, all: &[ProxyId], axis: usize) {
        self.unbounded.clear();
        self.bounded.clear();
        self.keys.clear();
        for &id in all.iter() {
            let p = table.get(id);
            if !p.enabled {
                continue;
            }
            if p.aabb.max[axis] == f64::INFINITY {
                self.unbounded.push(id);
            } else {
                self.bounded.push(id);
                self.keys.push(p.aabb.min[axis] as f32);
            }
        }
        let n = self.bounded.len();
        if self.ranks.len() != n {
            self.ranks.clear();
            self.ranks.extend(0..n as u32);
        }
        let keys = &self.keys;
        let key = |rank: u32| keys[rank as usize];
        if self.ranks.windows(2).all(|w| key(w[0]) <= key(w[1])) {
            return;
        }
        // Equal keys keep their order, or if negative turn it round: what sorting floats by their bits comes to.
        self.places.resize(n, 0);
        for (place, &rank) in self.ranks.iter().enumerate() {
            self.places[rank as usize] = place as u32;
        }
        let places = &self.places;
        self.ranks.sort_unstable_by(|&a, &b| {
            key(a).total_cmp(&key(b)).then_with(|| {
                let order = places[a as usize].cmp(&places[b as usize]);
                if key(a).is_sign_negative() { order.reverse() } else { order }
            })
        });
    }
}

impl SweepAndPruneSpace {
    /// A space that sorts by the first axis of `order`.
    pub fn new(order: AxisOrder) -> Self {
        Self {
            members: Members::default(),
            order,
            clean: Vec::new(),
            dirty: Vec::new(),
            places: Vec::new(),
            sorted: Sorted::default(),
            stale: false,
        }
    }

    /// The axes.
    pub fn axis_order(&self) -> AxisOrder {
        self.order
    }

    fn push(&mut self, id: ProxyId, dirty: bool) {
        let list = if dirty { &mut self.dirty } else { &mut self.clean };
        self.places[id.0 as usize] = Place { index: list.len() as u32, dirty };
        list.push(id);
    }

    fn take(&mut self, id: ProxyId) {
        let Place { index, dirty } = self.places[id.0 as usize];
        let list = if dirty { &mut self.dirty } else { &mut self.clean };
        list.swap_remove(index as usize);
        if let Some(last) = list.get(index as usize) {
            self.places[last.0 as usize].index = index;
        }
    }
}

impl BroadPhase for SweepAndPruneSpace {
    fn insert(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.push_front(table, id);
        let i = id.0 as usize;
        if i >= self.places.len() {
            self.places.resize(i + 1, Place { index: 0, dirty: false });
        }
        self.push(id, true);
        self.stale = true;
    }

    fn remove(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.remove(table, id);
        self.take(id);
        self.stale = true;
    }

    fn moved(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.to_front(table, id);
        if !self.places[id.0 as usize].dirty {
            self.take(id);
            self.push(id, true);
        }
    }

    fn update(&mut self, table: &ProxyTable) {
        let mut dirty = core::mem::take(&mut self.dirty);
        for &id in &dirty {
            self.push(id, false);
        }
        dirty.clear();
        self.dirty = dirty;
        self.sorted.update(table, &self.clean, self.order.axes()[0]);
        self.stale = false;
    }

    fn switched(&mut self, _: ProxyId) {
        self.stale = true;
    }

    /// By lower bound on the first axis; then each unbounded geom with the other unbounded ones and all bounded ones.
    fn collide(&self, table: &ProxyTable, _: &mut Scratch, report: &mut dyn FnMut(ProxyId, ProxyId)) {
        let [first, second, third] = self.order.axes();
        let fresh;
        let s = if self.stale {
            let all: Vec<_> = self.dirty.iter().chain(&self.clean).copied().collect();
            fresh = {
                let mut s = Sorted::default();
                s.update(table, &all, first);
                s
            };
            &fresh
        } else {
            &self.sorted
        };
        for (k, &rank) in s.ranks.iter().enumerate() {
            let a = s.bounded[rank as usize];
            let pa = table.get(a);
            let end = pa.aabb.max[first] as f32;
            for &other in &s.ranks[k + 1..] {
                if s.keys[other as usize] > end {
                    break;
                }
                let b = s.bounded[other as usize];
                let pb = table.get(b);
                let overlap = |i: usize| pa.aabb.min[i] <= pb.aabb.max[i] && pa.aabb.max[i] >= pb.aabb.min[i];
                if overlap(second) && overlap(third) && pa.enabled && pb.enabled && may_collide(pa, pb) {
                    report(a, b);
                }
            }
        }
        for (k, &a) in s.unbounded.iter().enumerate() {
            let pa = table.get(a);
            for &b in s.unbounded[k + 1..].iter().chain(&s.bounded) {
                let pb = table.get(b);
                if pa.enabled && pb.enabled && may_collide(pa, pb) {
                    report(a, b);
                }
            }
        }
    }

    fn collide_with(
        &self,
        table: &ProxyTable,
        _: Option<ProxyId>,
        proxy: &Proxy,
        report: &mut dyn FnMut(ProxyId),
    ) {
        for &id in self.dirty.iter().chain(&self.clean) {
            let member = table.get(id);
            if member.enabled && passes(proxy, member) {
                report(id);
            }
        }
    }

    fn members(&self) -> &Members {
        &self.members
    }

    fn arrays(&self) -> Option<[&[ProxyId]; 2]> {
        Some([&self.dirty, &self.clean])
    }
}
