//! Hierarchical hashing of boxes to grid cells (ODE's hash space; Mirtich, *Impulse-based Dynamic Simulation*, 1996,
//! section 2.4).

use super::{BroadPhase, Members, Proxy, ProxyId, ProxyTable, Scratch, scan};
use crate::filter::passes;
use ferrode_math::{Aabb, Vec3};

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

    /// The level of a box: 2^(level−1) ≤ largest side < 2^level, at least the smallest; and its first and last cell there. `None` if it is too large.
    #[inline]
    fn place(&self, aabb: &Aabb) -> Option<(i32, [i64; 3], [i64; 3])> {
        if !aabb.is_finite() {
            return None;
        }
        let e = aabb.extent();
        let side = e.x.max(e.y).max(e.z);
        let level = if side > 0.0 { exponent(side).max(self.min_level) } else { self.min_level };
        if level > self.max_level {
            return None;
        }
        Some((level, cell(aabb.min, level)?, cell(aabb.max, level)?))
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
#[inline]
fn cell(p: Vec3, level: i32) -> Option<[i64; 3]> {
    let scale = power_of_two(-level);
    let mut c = [0; 3];
    for i in 0..3 {
        let x = p[i] * scale;
        if !(x.abs() < 1e15) {
            return None;
        }
        // Rounded down; `floor` is a function call where the processor is not asked for more than x86-64.
        let towards_zero = x as i64;
        c[i] = towards_zero - i64::from(towards_zero as f64 > x);
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

impl Entry {
    /// Where the search of the cells comes to a pair: when the finer of the two looks at its cells, or the earlier one if they are
    /// on one level; by levels, by the first cell that both are in, and in a cell by who came there last.
    fn order(&self, other: &Self) -> u64 {
        let first =
            if self.level == other.level { self.index < other.index } else { self.level < other.level };
        let (probe, other) = if first { (self, other) } else { (other, self) };
        let up = (other.level - probe.level) as u32;
        let mut key = u64::from(probe.index) << 7 | u64::from(up);
        for i in 0..3 {
            // A box touches at most two cells along each axis.
            key = key << 1 | u64::from(other.low[i] > probe.low[i] >> up);
        }
        key << INDEX_BITS | (INDEX_MASK - u64::from(other.index))
    }
}

/// Enough for the numbers of all boxes in a sweep.
const INDEX_BITS: u32 = MOST_SWEPT.trailing_zeros() + 1;
const INDEX_MASK: u64 = (1 << INDEX_BITS) - 1;

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
    swept: Vec<Swept>,
    /// Boxes by where they begin; then pairs, by when the search of the cells would come to them.
    order: Vec<u64>,
    nodes: Vec<Node>,
    table: Vec<u32>,
    /// For each entry, the last entry that was compared with it: no pair is seen twice.
    seen: Vec<u32>,
    levels: Vec<bool>,
}

const END: u32 = u32::MAX;
/// So many boxes are compared sooner by a sweep along one axis than by way of their cells.
const MOST_SWEPT: usize = 2048;

/// A box in a sweep: its extent along the axis of the sweep first.
#[derive(Clone, Copy, Debug)]
struct Swept {
    min: [f32; 3],
    max: [f32; 3],
    entry: u32,
}

/// A number that grows as `x` does.
fn ordered(x: f32) -> u32 {
    let bits = x.to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

fn address(level: i32, cell: [i64; 3], mask: u64) -> usize {
    let mut h = (level as i64 as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for c in cell {
        h = (h ^ c as u64).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        h ^= h >> 29;
    }
    (h & mask) as usize
}

impl HashSpace {
    /// Lists the members with their cells, and those that are too large; returns the highest level.
    fn list_entries(&self, table: &ProxyTable, s: &mut HashScratch) -> i32 {
        s.entries.clear();
        s.big.clear();
        let mut highest = self.min_level;
        for id in self.members.iter(table) {
            let p = table.get(id);
            if !p.enabled {
                continue;
            }
            match self.place(&p.aabb) {
                Some((level, low, high)) => {
                    highest = highest.max(level);
                    let index = s.entries.len() as u32;
                    s.entries.push(Entry { id, index, level, low, high });
                }
                None => s.big.push(id),
            }
        }
        highest
    }

    /// Finds pairs along the axis on which the boxes are most spread out, and reports them in the order of the cells.
    fn sweep(&self, table: &ProxyTable, s: &mut HashScratch, report: &mut dyn FnMut(ProxyId, ProxyId)) {
        let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
        for e in &s.entries {
            let b = &table.get(e.id).aabb;
            let c = b.min + b.max;
            sum += c;
            squares += c.component_mul(c);
        }
        let spread = squares * s.entries.len() as f64 - sum.component_mul(sum);
        let axis = if spread.x >= spread.y && spread.x >= spread.z {
            0
        } else if spread.y >= spread.z {
            1
        } else {
            2
        };
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        // Rounding to single precision keeps the order of numbers, so boxes that overlap still do.
        s.order.clear();
        s.order.extend(s.entries.iter().map(|e| {
            let low = table.get(e.id).aabb.min[axis] as f32;
            u64::from(ordered(low)) << 32 | u64::from(e.index)
        }));
        s.order.sort_unstable();
        s.swept.clear();
        s.swept.extend(s.order.iter().map(|key| {
            let entry = *key as u32;
            let Aabb { min, max } = &table.get(s.entries[entry as usize].id).aabb;
            Swept {
                min: [min[axis] as f32, min[u] as f32, min[v] as f32],
                max: [max[axis] as f32, max[u] as f32, max[v] as f32],
                entry,
            }
        }));
        s.order.clear();
        for (i, a) in s.swept.iter().enumerate() {
            for b in &s.swept[i + 1..] {
                if b.min[0] > a.max[0] {
                    break;
                }
                let apart = (a.min[1] > b.max[1])
                    | (b.min[1] > a.max[1])
                    | (a.min[2] > b.max[2])
                    | (b.min[2] > a.max[2]);
                if !apart {
                    let (a, b) = (&s.entries[a.entry as usize], &s.entries[b.entry as usize]);
                    if passes(table.get(a.id), table.get(b.id)) {
                        s.order.push(a.order(b));
                    }
                }
            }
        }
        s.order.sort_unstable();
        for key in &s.order {
            let probe = (key >> (INDEX_BITS + 10)) as usize;
            let other = (INDEX_MASK - (key & INDEX_MASK)) as usize;
            report(s.entries[probe].id, s.entries[other].id);
        }
    }

    /// Finds pairs by way of the cells.
    fn probe(
        &self,
        table: &ProxyTable,
        s: &mut HashScratch,
        highest: i32,
        report: &mut dyn FnMut(ProxyId, ProxyId),
    ) {
        s.nodes.clear();
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
    }
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
        let highest = self.list_entries(table, s);
        if s.entries.len() <= MOST_SWEPT {
            self.sweep(table, s, report);
        } else {
            self.probe(table, s, highest, report);
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

#[cfg(test)]
mod tests {
    use super::*;
    use ferrode_math::random::OdeRandom;

    /// Pairs by the sweep and by the cells, in the order of reporting.
    fn both(count: usize, side: f64, snap: bool, seed: u32) -> [Vec<(u32, u32)>; 2] {
        let mut random = OdeRandom::new(seed);
        let mut number = || f64::from(random.next_u32()) / 4294967296.0;
        let (mut space, mut table) = (HashSpace::new(), ProxyTable::new());
        for i in 0..count {
            let size = 3.0 * number() * number() * number();
            let mut corner =
                || if snap { (side * (number() - 0.5)).round() } else { side * (number() - 0.5) };
            let min = Vec3::new(corner(), corner(), corner());
            let size = if snap { (4.0 * size).round() / 4.0 } else { size };
            let mut proxy =
                Proxy::new(Aabb::new(min, min + Vec3::new(size, size * number(), size * number())));
            proxy.body = (i % 5 == 0).then_some((i % 10) as u64);
            proxy.category_bits = if i % 7 == 0 { 1 } else { 6 };
            proxy.collide_bits = if i % 3 == 0 { 2 } else { 7 };
            table.set(ProxyId(i as u32), proxy);
            space.insert(&mut table, ProxyId(i as u32));
        }
        let mut s = HashScratch::default();
        let mut lists = [Vec::new(), Vec::new()];
        let highest = space.list_entries(&table, &mut s);
        space.sweep(&table, &mut s, &mut |a, b| lists[0].push((a.0, b.0)));
        space.probe(&table, &mut s, highest, &mut |a, b| lists[1].push((a.0, b.0)));
        lists
    }

    #[test]
    fn the_sweep_reports_the_pairs_of_the_cells_in_their_order() {
        let mut pairs = 0;
        for seed in 0..60 {
            for (count, side, snap) in
                [(12, 1.5, false), (90, 4.0, false), (90, 4.0, true), (700, 9.0, false)]
            {
                let [swept, probed] = both(count, side, snap, seed);
                assert_eq!(swept, probed, "{count} boxes, seed {seed}");
                pairs += swept.len();
            }
        }
        assert!(pairs > 5000, "{pairs}");
    }
}
