//! From two geoms to their pair: open addressing with linear probing.

use super::{NONE, Pair};

/// Places of pairs, by a hash of their geoms. Only asked for, never walked: its order decides nothing.
#[derive(Clone, Debug, Default)]
pub(super) struct PairTable {
    /// A power of two; at most three quarters are taken.
    places: Vec<u32>,
    count: usize,
}

fn hash(a: u32, b: u32) -> usize {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    let key = u64::from(high) << 32 | u64::from(low);
    let h = key.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    ((h ^ h >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 20) as usize
}

fn same(p: &Pair, a: u32, b: u32) -> bool {
    (p.a == a && p.b == b) || (p.a == b && p.b == a)
}

impl PairTable {
    #[inline]
    pub fn find(&self, pairs: &[Pair], a: u32, b: u32) -> Option<u32> {
        let mask = self.places.len().checked_sub(1)?;
        let mut i = hash(a, b) & mask;
        while self.places[i] != NONE {
            if same(&pairs[self.places[i] as usize], a, b) {
                return Some(self.places[i]);
            }
            i = (i + 1) & mask;
        }
        None
    }

    /// Adds the place of a pair that is not in the table.
    pub fn insert(&mut self, pairs: &[Pair], place: u32) {
        if 4 * (self.count + 1) > 3 * self.places.len() {
            let size = (2 * self.places.len()).max(64);
            let old = core::mem::replace(&mut self.places, vec![NONE; size]);
            old.into_iter().filter(|&p| p != NONE).for_each(|p| self.put(pairs, p));
        }
        self.put(pairs, place);
        self.count += 1;
    }

    fn put(&mut self, pairs: &[Pair], place: u32) {
        let p = &pairs[place as usize];
        let mask = self.places.len() - 1;
        let mut i = hash(p.a, p.b) & mask;
        while self.places[i] != NONE {
            i = (i + 1) & mask;
        }
        self.places[i] = place;
    }

    /// Takes a pair out, and moves those that had to give way to it back.
    pub fn remove(&mut self, pairs: &[Pair], a: u32, b: u32) {
        let Some(mask) = self.places.len().checked_sub(1) else { return };
        let mut i = hash(a, b) & mask;
        while self.places[i] != NONE && !same(&pairs[self.places[i] as usize], a, b) {
            i = (i + 1) & mask;
        }
        if self.places[i] == NONE {
            return;
        }
        self.count -= 1;
        let mut hole = i;
        loop {
            i = (i + 1) & mask;
            if self.places[i] == NONE {
                break;
            }
            let p = &pairs[self.places[i] as usize];
            let home = hash(p.a, p.b) & mask;
            // It may move to the hole if its home is not between the hole and it.
            if (i.wrapping_sub(home) & mask) >= (i.wrapping_sub(hole) & mask) {
                self.places[hole] = self.places[i];
                hole = i;
            }
        }
        self.places[hole] = NONE;
    }

    pub fn memory(&self) -> usize {
        self.places.capacity() * 4
    }
}
