//! Hierarchical hashing of boxes to grid cells (ODE's hash space; Mirtich, *Impulse-based Dynamic Simulation*, 1996,
//! section 2.4).

use super::{BroadPhase, Members, Proxy, ProxyId, ProxyTable, Scratch, scan};
use crate::filter::passes;
use ferrode_math::Aabb;

/// Cells double in size from level to level; a geom lies in the at most eight cells that its box touches on the
/// level of its size, and is compared with what shares these cells on its own and all coarser levels.
#[derive(Clone, Debug)]
pub struct HashSpace {
    members: Members,
    min_level: i32,
    max_level: i32,
}

impl Default for HashSpace {
    fn default() -> Self {
        Self { members: Members::default(), min_level: -3, max_level: 10 }
    }
}

impl HashSpace {
    /// A space with ODE's levels, −3 to 10: cells of 1/8 m to 1024 m.
    pub fn new() -> Self {
        Self::default()
    }

    /// A space whose smallest cells measure 2^`min_level` and whose largest 2^`max_level`. The levels are swapped if
    /// need be, and kept within ±60.
    pub fn with_levels(min_level: i32, max_level: i32) -> Self {
        let mut space = Self::default();
        space.set_levels(min_level, max_level);
        space
    }

    /// Sets the levels; see [`with_levels`](Self::with_levels).
    pub fn set_levels(&mut self, min_level: i32, max_level: i32) {
        let (a, b) = (min_level.clamp(-60, 60), max_level.clamp(-60, 60));
        (self.min_level, self.max_level) = (a.min(b), a.max(b));
    }

    /// Smallest and largest level.
    pub fn levels(&self) -> (i32, i32) {
        (self.min_level, self.max_level)
    }

    /// The level of a box: 2^(level−1) ≤ largest side < 2^level, at least the smallest. `None` if it is too large.
    fn level(&self, aabb: &Aabb) -> Option<i32> {
        if !aabb.is_finite() {
            return None;
        }
        let e = aabb.extent();
        let side = e.x.max(e.y).max(e.z);
        let level = if side > 0.0 { exponent(side).max(self.min_level) } else { self.min_level };
        (level <= self.max_level && cell(aabb.min, level).is_some() && cell(aabb.max, level).is_some())
            .then_some(level)
    }
}

/// k with 2^(k−1) ≤ x < 2^k, for positive x.
fn exponent(x: f64) -> i32 {
    if x < f64::MIN_POSITIVE {
        return -1022;
    }
    ((x.to_bits() >> 52) & 0x7ff) as i32 - 1022
}

/// 2^k for |k| ≤ 1000.
fn power_of_two(k: i32) -> f64 {
    f64::from_bits(((k + 1023) as u64) << 52)
}

/// The cell of a point. `None` beyond the range of whole numbers: such a geom counts as too large.
fn cell(p: ferrode_math::Vec3, level: i32) -> Option<[i64; 3]> {
    let scale = power_of_two(-level);
    let mut c = [0; 3];
    for i in 0..3 {
        let x = (p[i] * scale).floor();
        if !(x.abs() < 1e15) {
            return None;
        }
        c[i] = x as i64;
    }
    Some(c)
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    id: ProxyId,
    index: u32,
    level: i32,
    low: [i64; 3],
    high: [i64; 3],
}

#[derive(Clone, Copy, Debug)]
struct Node {
    level: i32,
    cell: [i64; 3],
    entry: u32,
    next: u32,
}

/// Working memory of a search.
#[derive(Clone, Debug, Default)]
pub(crate) struct HashScratch {
    entries: Vec<Entry>,
    big: Vec<ProxyId>,
    nodes: Vec<Node>,
    table: Vec<u32>,
    /// For each entry, the last entry that was compared with it: no pair is seen twice.
    seen: Vec<u32>,
    levels: Vec<bool>,
}

const END: u32 = u32::MAX;

fn address(level: i32, cell: [i64; 3], mask: u64) -> usize {
    let mut h = (level as i64 as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for c in cell {
        h = (h ^ c as u64).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        h ^= h >> 29;
    }
    (h & mask) as usize
}

impl BroadPhase for HashSpace {
    fn insert(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.push_front(table, id);
    }

    fn remove(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.remove(table, id);
    }

    fn moved(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.to_front(table, id);
    }

    fn update(&mut self, _: &ProxyTable) {}

    fn collide(&self, table: &ProxyTable, scratch: &mut Scratch, report: &mut dyn FnMut(ProxyId, ProxyId)) {
        let s = &mut scratch.hash;
        s.entries.clear();
        s.big.clear();
        s.nodes.clear();
        let mut highest = self.min_level;
        for id in self.members.iter(table) {
            let p = table.get(id);
            if !p.enabled {
                continue;
            }
            match self.level(&p.aabb).and_then(|l| Some((l, cell(p.aabb.min, l)?, cell(p.aabb.max, l)?))) {
                Some((level, low, high)) => {
                    highest = highest.max(level);
                    let index = s.entries.len() as u32;
                    s.entries.push(Entry { id, index, level, low, high });
                }
                None => s.big.push(id),
            }
        }
        let size = (s.entries.len() * 8).next_power_of_two();
        let mask = size as u64 - 1;
        s.table.clear();
        s.table.resize(size, END);
        s.levels.clear();
        s.levels.resize((highest - self.min_level + 1) as usize, false);
        for e in &s.entries {
            s.levels[(e.level - self.min_level) as usize] = true;
            for x in e.low[0]..=e.high[0] {
                for y in e.low[1]..=e.high[1] {
                    for z in e.low[2]..=e.high[2] {
                        let cell = [x, y, z];
                        let slot = &mut s.table[address(e.level, cell, mask)];
                        s.nodes.push(Node { level: e.level, cell, entry: e.index, next: *slot });
                        *slot = (s.nodes.len() - 1) as u32;
                    }
                }
            }
        }
        s.seen.clear();
        s.seen.resize(s.entries.len(), END);
        for e in &s.entries {
            let p = table.get(e.id);
            let (mut low, mut high) = (e.low, e.high);
            for level in e.level..=highest {
                if s.levels[(level - self.min_level) as usize] {
                    for x in low[0]..=high[0] {
                        for y in low[1]..=high[1] {
                            for z in low[2]..=high[2] {
                                let cell = [x, y, z];
                                let mut n = s.table[address(level, cell, mask)];
                                while n != END {
                                    let node = s.nodes[n as usize];
                                    n = node.next;
                                    if node.entry == e.index
                                        || node.level != level
                                        || node.cell != cell
                                        || s.seen[node.entry as usize] == e.index
                                    {
                                        continue;
                                    }
                                    // On its own level a pair meets twice: once from either side.
                                    if level == e.level && node.entry < e.index {
                                        continue;
                                    }
                                    s.seen[node.entry as usize] = e.index;
                                    let other = s.entries[node.entry as usize].id;
                                    if passes(p, table.get(other)) {
                                        report(e.id, other);
                                    }
                                }
                            }
                        }
                    }
                }
                // The cell above: half the coordinates, rounded down.
                low = low.map(|c| c >> 1);
                high = high.map(|c| c >> 1);
            }
        }
        for e in &s.entries {
            for &b in &s.big {
                if passes(table.get(e.id), table.get(b)) {
                    report(e.id, b);
                }
            }
        }
        for (i, &a) in s.big.iter().enumerate() {
            for &b in &s.big[i + 1..] {
                if passes(table.get(a), table.get(b)) {
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
        scan(&self.members, table, proxy, report);
    }

    fn members(&self) -> &Members {
        &self.members
    }
}
