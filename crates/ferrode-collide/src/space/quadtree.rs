//! A fixed tree of squares over the x and y axes (ODE's quadtree space).

use super::{BroadPhase, Members, Proxy, ProxyId, ProxyTable, Scratch};
use crate::filter::passes;
use ferrode_math::Aabb;

const NONE: u32 = u32::MAX;

/// Squares halved a fixed number of times; height is ignored. A geom lives in the smallest square that holds its box,
/// what does not fit the largest lives there too. For flat worlds whose size is known.
#[derive(Clone, Debug)]
pub struct QuadtreeSpace {
    members: Members,
    /// Breadth first: the root, then the children of each block, four together.
    blocks: Vec<Block>,
    /// By proxy number.
    entries: Vec<Entry>,
    /// In the order in which they were added or moved.
    dirty: Vec<ProxyId>,
}

#[derive(Clone, Copy, Debug)]
struct Block {
    min: [f64; 2],
    max: [f64; 2],
    parent: u32,
    /// The first of four; `NONE` at the bottom.
    children: u32,
    /// The geoms that live here, linked through the entries, newest first.
    first: u32,
    /// Geoms here and below.
    count: u32,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    block: u32,
    next: u32,
    previous: u32,
    dirty: bool,
}

const NOWHERE: Entry = Entry { block: NONE, next: NONE, previous: NONE, dirty: false };

impl Block {
    /// Whether the box lies within: the lower bounds belong to the block, the upper ones do not.
    fn holds(&self, b: &Aabb) -> bool {
        (0..2).all(|i| b.min[i] >= self.min[i] && b.max[i] < self.max[i])
    }

    fn overlaps(&self, b: &Aabb) -> bool {
        (0..2).all(|i| b.min[i] <= self.max[i] && b.max[i] >= self.min[i])
    }
}

impl QuadtreeSpace {
    /// The most halvings: 4^10 squares take 100 megabytes.
    pub const MAX_DEPTH: u32 = 10;

    /// A space whose largest square has the given centre and half sides (x and y, in metres), halved `depth` times,
    /// at most [`MAX_DEPTH`](Self::MAX_DEPTH).
    pub fn new(center: [f64; 2], half_sides: [f64; 2], depth: u32) -> Self {
        let block = |min: [f64; 2], max: [f64; 2], parent| Block {
            min,
            max,
            parent,
            children: NONE,
            first: NONE,
            count: 0,
        };
        let bounds = |c: [f64; 2], h: [f64; 2]| ([c[0] - h[0], c[1] - h[1]], [c[0] + h[0], c[1] + h[1]]);
        let (min, max) = bounds(center, half_sides);
        // The upper bounds of the largest belong to it. Those of the others don't: a box that ends there touches what begins in
        // the next block, and must not be hidden from it.
        let mut blocks = vec![block(min, max.map(f64::next_up), NONE)];
        let mut level = vec![(0u32, center)];
        let mut half = half_sides;
        for _ in 0..depth.min(Self::MAX_DEPTH) {
            half = half.map(|h| 0.5 * h);
            let mut below = Vec::with_capacity(4 * level.len());
            for &(parent, c) in &level {
                blocks[parent as usize].children = blocks.len() as u32;
                for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                    let c = [c[0] + x * half[0], c[1] + y * half[1]];
                    let (min, max) = bounds(c, half);
                    below.push((blocks.len() as u32, c));
                    blocks.push(block(min, max, parent));
                }
            }
            level = below;
        }
        Self { members: Members::default(), blocks, entries: Vec::new(), dirty: Vec::new() }
    }

    fn block(&self, b: u32) -> &Block {
        &self.blocks[b as usize]
    }

    fn children(&self, b: u32) -> impl Iterator<Item = u32> + use<> {
        let first = self.block(b).children;
        (0..if first == NONE { 0 } else { 4 }).map(move |k| first + k)
    }

    /// The smallest block that holds the box, or the root.
    fn home(&self, aabb: &Aabb) -> u32 {
        let mut b = 0;
        if self.block(b).holds(aabb) {
            while let Some(child) = self.children(b).find(|&c| self.block(c).holds(aabb)) {
                b = child;
            }
        }
        b
    }

    fn count(&mut self, mut b: u32, change: i32) {
        while b != NONE {
            let block = &mut self.blocks[b as usize];
            block.count = block.count.wrapping_add_signed(change);
            b = block.parent;
        }
    }

    fn link(&mut self, id: ProxyId, b: u32) {
        let first = core::mem::replace(&mut self.blocks[b as usize].first, id.0);
        if first != NONE {
            self.entries[first as usize].previous = id.0;
        }
        let entry = &mut self.entries[id.0 as usize];
        (entry.block, entry.next, entry.previous) = (b, first, NONE);
        self.count(b, 1);
    }

    fn unlink(&mut self, id: ProxyId) {
        let Entry { block, next, previous, .. } = self.entries[id.0 as usize];
        if next != NONE {
            self.entries[next as usize].previous = previous;
        }
        match previous {
            NONE => self.blocks[block as usize].first = next,
            _ => self.entries[previous as usize].next = next,
        }
        self.entries[id.0 as usize].block = NONE;
        self.count(block, -1);
    }

    fn mark(&mut self, id: ProxyId) {
        let entry = &mut self.entries[id.0 as usize];
        if !entry.dirty {
            entry.dirty = true;
            self.dirty.push(id);
        }
    }

    /// The geoms of a block's own list from `first` on that may touch `proxy`.
    fn list(&self, table: &ProxyTable, proxy: &Proxy, mut next: u32, report: &mut dyn FnMut(ProxyId)) {
        while next != NONE {
            let member = table.get(ProxyId(next));
            if member.enabled && passes(proxy, member) {
                report(ProxyId(next));
            }
            next = self.entries[next as usize].next;
        }
    }

    /// All geoms below a block that may touch `proxy`.
    fn below(&self, table: &ProxyTable, proxy: &Proxy, b: u32, report: &mut dyn FnMut(ProxyId)) {
        for c in self.children(b) {
            let child = self.block(c);
            if child.count > 0 && child.overlaps(&proxy.aabb) {
                self.list(table, proxy, child.first, report);
                self.below(table, proxy, c, report);
            }
        }
    }

    fn collide_block(&self, table: &ProxyTable, b: u32, report: &mut dyn FnMut(ProxyId, ProxyId)) {
        let mut next = self.block(b).first;
        while next != NONE {
            let id = ProxyId(next);
            next = self.entries[next as usize].next;
            let proxy = table.get(id);
            if proxy.enabled {
                self.list(table, proxy, next, &mut |other| report(id, other));
                self.below(table, proxy, b, &mut |other| report(id, other));
            }
        }
        for c in self.children(b) {
            if self.block(c).count > 1 {
                self.collide_block(table, c, report);
            }
        }
    }
}

impl BroadPhase for QuadtreeSpace {
    fn insert(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.push_front(table, id);
        let i = id.0 as usize;
        if i >= self.entries.len() {
            self.entries.resize(i + 1, NOWHERE);
        }
        self.entries[i] = NOWHERE;
        self.link(id, 0);
        self.mark(id);
    }

    fn remove(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.remove(table, id);
        self.unlink(id);
        if self.entries[id.0 as usize].dirty
            && let Some(k) = self.dirty.iter().position(|&x| x == id)
        {
            self.dirty.swap_remove(k);
        }
    }

    fn moved(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.to_front(table, id);
        self.mark(id);
    }

    fn update(&mut self, table: &ProxyTable) {
        for k in 0..self.dirty.len() {
            let id = self.dirty[k];
            self.entries[id.0 as usize].dirty = false;
            let home = self.home(&table.get(id).aabb);
            if home != self.entries[id.0 as usize].block {
                self.unlink(id);
                self.link(id, home);
            }
        }
        self.dirty.clear();
    }

    /// Block by block from the root: each geom with those after it in its block, then with those in smaller blocks.
    fn collide(&self, table: &ProxyTable, _: &mut Scratch, report: &mut dyn FnMut(ProxyId, ProxyId)) {
        self.collide_block(table, 0, report);
    }

    /// A member is compared from its own block down, then with the larger blocks' own geoms.
    fn collide_with(
        &self,
        table: &ProxyTable,
        id: Option<ProxyId>,
        proxy: &Proxy,
        report: &mut dyn FnMut(ProxyId),
    ) {
        let home = id.and_then(|id| self.entries.get(id.0 as usize)).map_or(NONE, |e| e.block);
        let start = if home == NONE { 0 } else { home };
        self.list(table, proxy, self.block(start).first, report);
        self.below(table, proxy, start, report);
        let mut above = self.block(start).parent;
        while above != NONE {
            self.list(table, proxy, self.block(above).first, report);
            above = self.block(above).parent;
        }
    }

    fn members(&self) -> &Members {
        &self.members
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ferrode_math::Vec3;

    #[test]
    fn boxes_that_touch_where_blocks_meet_are_a_pair() {
        for (x, y) in [(0.0, 5.3), (1.0, 5.3), (-3.0, 0.2), (5.3, 0.0), (4.0, 4.0), (16.0, 1.0), (0.1, 0.3)] {
            let (mut space, mut table) = (QuadtreeSpace::new([0.0; 2], [16.0; 2], 4), ProxyTable::new());
            // To either side of the place, along x and along y.
            for (i, (dx, dy)) in [(-1.0, -1.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 0.0)].into_iter().enumerate()
            {
                let min = Vec3::new(x + 0.25 * dx, y + 0.25 * dy, 0.0);
                let max = Vec3::new(x + 0.25 * (dx + 1.0), y + 0.25 * (dy + 1.0), 1.0);
                table.set(ProxyId(i as u32), Proxy::new(Aabb::new(min, max)));
                space.insert(&mut table, ProxyId(i as u32));
            }
            space.update(&table);
            let mut count = 0;
            space.collide(&table, &mut Scratch::default(), &mut |_, _| count += 1);
            assert_eq!(count, 6, "at {x} {y}");
        }
    }
}
