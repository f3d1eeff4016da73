//! Contacts at places that stay.

use super::{NONE, set};
use crate::manifold::Manifold;

/// A manifold of two geoms.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Contact {
    /// Where they touch, and what the solver keeps there.
    pub manifold: Manifold,
    /// The geom that the normal points into.
    pub a: u32,
    /// The other geom.
    pub b: u32,
    /// For the solver: whatever it wants to know again, such as the colour of the contact. Zero at first.
    pub tag: u32,
    pub(super) pair: u32,
    /// The next contact of the same pair, or `NONE`.
    pub(super) next: u32,
    /// May have siblings: found with them, not alone.
    pub(super) concave: bool,
    /// No narrow phase until the odometers' sum is beyond this.
    pub(super) limit: f64,
}

impl Contact {
    /// Whether the place where it is stands empty.
    pub fn is_vacant(&self) -> bool {
        self.pair == NONE
    }
}

/// All contacts, some of them vacant.
#[derive(Clone, Debug, Default)]
pub(super) struct Slab {
    pub list: Vec<Contact>,
    /// A bit for each that is in use and awake.
    pub awake: Vec<u64>,
    /// A bit for each that is in use.
    pub used: Vec<u64>,
    free: Vec<u32>,
}

/// The contacts that are awake, with their places.
#[derive(Clone, Debug)]
pub struct Contacts<'a> {
    slab: &'a Slab,
    word: usize,
    bits: u64,
}

impl<'a> Iterator for Contacts<'a> {
    type Item = (u32, &'a Contact);

    fn next(&mut self) -> Option<Self::Item> {
        while self.bits == 0 {
            self.word += 1;
            self.bits = *self.slab.awake.get(self.word)?;
        }
        let i = 64 * self.word + self.bits.trailing_zeros() as usize;
        self.bits &= self.bits - 1;
        Some((i as u32, &self.slab.list[i]))
    }
}

impl Slab {
    pub fn awake(&self) -> Contacts<'_> {
        Contacts { slab: self, word: 0, bits: self.awake.first().copied().unwrap_or(0) }
    }

    pub fn places(&mut self) -> (&mut [Contact], &[u64]) {
        (&mut self.list, &self.awake)
    }

    pub fn get(&self, place: u32) -> Option<&Contact> {
        self.list.get(place as usize).filter(|c| c.pair != NONE)
    }

    pub fn at(&self, place: u32) -> &Contact {
        &self.list[place as usize]
    }

    pub fn len(&self) -> usize {
        self.list.len() - self.free.len()
    }

    /// The places of a pair's contacts.
    pub fn chain(&self, first: u32) -> impl Iterator<Item = u32> {
        let known = |c: u32| (c != NONE).then_some(c);
        core::iter::successors(known(first), move |&c| known(self.list[c as usize].next))
    }

    pub fn add(&mut self, contact: Contact) -> u32 {
        let place = match self.free.pop() {
            Some(place) => {
                self.list[place as usize] = contact;
                place
            }
            None => {
                if self.list.len() == self.list.capacity() {
                    // Doubling would leave up to half of the largest array unused.
                    self.list.reserve_exact((self.list.len() / 8).max(256));
                }
                self.list.push(contact);
                self.list.len() as u32 - 1
            }
        };
        if self.list.len() > 64 * self.awake.len() {
            self.awake.push(0);
            self.used.push(0);
        }
        set(&mut self.awake, place, true);
        set(&mut self.used, place, true);
        place
    }

    pub fn remove_chain(&mut self, first: u32) {
        let mut c = first;
        while c != NONE {
            let next = self.list[c as usize].next;
            self.list[c as usize].pair = NONE;
            set(&mut self.awake, c, false);
            set(&mut self.used, c, false);
            self.free.push(c);
            c = next;
        }
    }

    pub fn set_chain_awake(&mut self, first: u32, awake: bool) {
        let mut c = first;
        while c != NONE {
            set(&mut self.awake, c, awake);
            c = self.list[c as usize].next;
        }
    }

    pub fn memory(&self) -> usize {
        self.list.capacity() * size_of::<Contact>()
            + (self.awake.capacity() + self.used.capacity()) * 8
            + self.free.capacity() * 4
    }
}
