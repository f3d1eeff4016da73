//! What a space knows of a geom.

use crate::filter::ALL_BITS;
use ferrode_math::Aabb;

/// The number of a proxy, chosen by the caller: its index in the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ProxyId(pub u32);

/// No proxy: the end of a list.
const NOBODY: u32 = u32::MAX;

/// The box and bits of a geom.
#[derive(Clone, Copy, Debug)]
pub struct Proxy {
    /// World box; may be unbounded.
    pub aabb: Aabb,
    /// What the geom is.
    pub category_bits: u64,
    /// What it collides with.
    pub collide_bits: u64,
    /// The body it is on: two geoms on one body do not collide.
    pub body: Option<u64>,
    /// Whether spaces look at it.
    pub enabled: bool,
    next: u32,
    previous: u32,
}

impl Proxy {
    /// A proxy in all categories, enabled, on no body.
    pub fn new(aabb: Aabb) -> Self {
        Self {
            aabb,
            category_bits: ALL_BITS,
            collide_bits: ALL_BITS,
            body: None,
            enabled: true,
            next: NOBODY,
            previous: NOBODY,
        }
    }
}

/// All proxies, by number.
#[derive(Clone, Debug, Default)]
pub struct ProxyTable {
    proxies: Vec<Proxy>,
}

impl ProxyTable {
    /// A table without proxies.
    pub fn new() -> Self {
        Self::default()
    }

    /// Puts a proxy at `id`, which must not be in a space; the table grows as needed.
    pub fn set(&mut self, id: ProxyId, proxy: Proxy) {
        let i = id.0 as usize;
        if i >= self.proxies.len() {
            self.proxies.resize(i + 1, Proxy::new(Aabb::EMPTY));
        }
        self.proxies[i] = Proxy { next: NOBODY, previous: NOBODY, ..proxy };
    }

    /// The proxy at `id`.
    #[inline]
    pub fn get(&self, id: ProxyId) -> &Proxy {
        &self.proxies[id.0 as usize]
    }

    /// The proxy at `id`, to change.
    #[inline]
    pub fn get_mut(&mut self, id: ProxyId) -> &mut Proxy {
        &mut self.proxies[id.0 as usize]
    }
}

/// The members of a space: a list linked through the table, newest first.
#[derive(Clone, Debug)]
pub struct Members {
    head: u32,
    count: usize,
}

impl Default for Members {
    fn default() -> Self {
        Self { head: NOBODY, count: 0 }
    }
}

impl Members {
    /// Number of members.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Adds at the head.
    pub fn push_front(&mut self, table: &mut ProxyTable, id: ProxyId) {
        let p = table.get_mut(id);
        p.next = self.head;
        p.previous = NOBODY;
        if self.head != NOBODY {
            table.get_mut(ProxyId(self.head)).previous = id.0;
        }
        self.head = id.0;
        self.count += 1;
    }

    /// Takes a member out.
    pub fn remove(&mut self, table: &mut ProxyTable, id: ProxyId) {
        let p = table.get_mut(id);
        let (next, previous) = (p.next, p.previous);
        p.next = NOBODY;
        p.previous = NOBODY;
        if next != NOBODY {
            table.get_mut(ProxyId(next)).previous = previous;
        }
        if previous != NOBODY {
            table.get_mut(ProxyId(previous)).next = next;
        } else {
            self.head = next;
        }
        self.count -= 1;
    }

    /// Moves a member to the head.
    pub fn to_front(&mut self, table: &mut ProxyTable, id: ProxyId) {
        if self.head != id.0 {
            self.remove(table, id);
            self.push_front(table, id);
        }
    }

    /// The first member.
    pub fn first(&self) -> Option<ProxyId> {
        (self.head != NOBODY).then_some(ProxyId(self.head))
    }

    /// The member after `id`.
    pub fn after(&self, table: &ProxyTable, id: ProxyId) -> Option<ProxyId> {
        let next = table.get(id).next;
        (next != NOBODY).then_some(ProxyId(next))
    }

    /// The members from the head on.
    pub fn iter<'a>(&'a self, table: &'a ProxyTable) -> impl Iterator<Item = ProxyId> + 'a {
        core::iter::successors(self.first(), move |&id| self.after(table, id))
    }
}
