//! What the narrow phase reports, and where it puts it.

use ferrode_math::{ContactPoint, Vec3};

/// A contact between two geoms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeomContact {
    /// Position, normal (into the first geom) and depth.
    pub point: ContactPoint,
    /// The part of the first geom that touches: the triangle of a mesh; −1 for other shapes.
    pub side1: i32,
    /// The part of the second geom that touches.
    pub side2: i32,
}

impl GeomContact {
    /// A contact of two shapes without parts.
    #[inline]
    pub fn new(position: Vec3, normal: Vec3, depth: f64) -> Self {
        Self { point: ContactPoint { position, normal, depth }, side1: -1, side2: -1 }
    }

    /// Whether all numbers are finite; lifts a depth below zero to zero.
    fn lift_if_sound(&mut self) -> bool {
        let p = &mut self.point;
        p.depth = if p.depth < 0.0 { 0.0 } else { p.depth };
        p.depth.is_finite() && p.normal.is_finite() && p.position.is_finite()
    }

    /// The same contact seen from the other geom.
    #[inline]
    pub fn swapped(self) -> Self {
        Self {
            point: ContactPoint { normal: -self.point.normal, ..self.point },
            side1: self.side2,
            side2: self.side1,
        }
    }
}

/// What is asked of the narrow phase: ODE's `flags` in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CollideOptions {
    /// Most contacts wanted. Zero asks for nothing and gets nothing.
    pub max_contacts: u16,
    /// Any contact will do: only whether the shapes touch matters (`CONTACTS_UNIMPORTANT`).
    pub unimportant: bool,
}

impl CollideOptions {
    /// At most `max_contacts` contacts, good ones.
    pub const fn new(max_contacts: u16) -> Self {
        Self { max_contacts, unimportant: false }
    }

    /// From ODE's flags: the low 16 bits are the most contacts, bit 31 is `CONTACTS_UNIMPORTANT`.
    pub const fn from_ode_flags(flags: u32) -> Self {
        Self { max_contacts: (flags & 0xffff) as u16, unimportant: flags & 0x8000_0000 != 0 }
    }
}

impl Default for CollideOptions {
    /// As many contacts as there are, good ones.
    fn default() -> Self {
        Self::new(u16::MAX)
    }
}

/// The end of a list of contacts to which one pair of shapes adds its own, up to the number asked for.
#[derive(Debug)]
pub struct Contacts<'a> {
    list: &'a mut Vec<GeomContact>,
    start: usize,
    options: CollideOptions,
    /// What is added is turned round: it is that of the shapes in the other order.
    turned: bool,
    /// Contacts may have been changed after they were added.
    edited: bool,
}

impl<'a> Contacts<'a> {
    /// Adds to the end of `list`; what is already there stays as it is.
    #[inline]
    pub fn new(list: &'a mut Vec<GeomContact>, options: CollideOptions) -> Self {
        let start = list.len();
        Self { list, start, options, turned: false, edited: false }
    }

    /// Room for any number of contacts at the end of the list, to choose from afterwards.
    pub(crate) fn all(&mut self) -> Contacts<'_> {
        let options = CollideOptions { max_contacts: u16::MAX, ..self.options };
        self.edited = true;
        Contacts { start: self.list.len(), list: self.list, options, turned: self.turned, edited: true }
    }

    /// What was asked for.
    #[inline]
    pub fn options(&self) -> CollideOptions {
        self.options
    }

    /// Most contacts this pair may report.
    #[inline]
    pub fn capacity(&self) -> usize {
        usize::from(self.options.max_contacts)
    }

    /// Contacts added so far.
    #[inline]
    pub fn len(&self) -> usize {
        self.list.len() - self.start
    }

    /// Whether none has been added.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether no more are wanted.
    #[inline]
    pub fn is_full(&self) -> bool {
        self.len() >= self.capacity()
    }

    /// Adds a contact of shapes without parts, unless the list is full. One that is not made of finite numbers, which only
    /// poses that are none, or nearly overflow, can cause, is left out; a depth that rounding put below zero counts as
    /// zero.
    // Always inline: the numbers are tested and turned round in registers. Reading back what was just written in other
    // portions would make the processor wait, for longer than the contact took to find.
    #[inline(always)]
    pub fn push(&mut self, position: Vec3, normal: Vec3, depth: f64) {
        if self.is_full() {
            return;
        }
        let (p, n) = (position, normal);
        let sum = (p.x + p.y) + (p.z + n.x) + ((n.y + n.z) + depth);
        // Nothing times zero is zero but a finite number.
        if sum * 0.0 == 0.0 && depth >= 0.0 {
            let sign = if self.turned { -1.0 } else { 1.0 };
            self.list.push(GeomContact::new(position, normal * sign, depth));
        } else {
            self.push_unsound([p.x, p.y, p.z], [n.x, n.y, n.z], depth);
        }
    }

    /// As [`push`](Self::push), for contacts whose place and normal are made of finite numbers if the depth is one: where they
    /// follow from the same numbers.
    #[inline(always)]
    pub(crate) fn push_sound(&mut self, position: Vec3, normal: Vec3, depth: f64) {
        if (0.0..=f64::MAX).contains(&depth) && !self.is_full() {
            let sign = if self.turned { -1.0 } else { 1.0 };
            self.list.push(GeomContact::new(position, normal * sign, depth));
        }
    }

    /// As [`push`](Self::push), for shapes with parts.
    #[inline]
    pub fn push_contact(&mut self, contact: GeomContact) {
        if !self.is_full() {
            self.push_odd(contact);
        }
    }

    fn push_odd(&mut self, mut contact: GeomContact) {
        if contact.lift_if_sound() {
            self.list.push(if self.turned { contact.swapped() } else { contact });
        }
    }

    #[cold]
    #[inline(never)]
    fn push_unsound(&mut self, position: [f64; 3], normal: [f64; 3], depth: f64) {
        self.push_odd(GeomContact::new(Vec3::from_array(position), Vec3::from_array(normal), depth));
    }

    /// Drops contacts that changes after they were added left without finite numbers.
    #[inline(always)]
    pub(crate) fn finish(&mut self) {
        if self.edited {
            self.drop_unsound();
        }
    }

    #[inline(never)]
    fn drop_unsound(&mut self) {
        if !self.list[self.start..].iter_mut().all(GeomContact::lift_if_sound) {
            let mut kept = self.start;
            for i in self.start..self.list.len() {
                if self.list[i].lift_if_sound() {
                    self.list[kept] = self.list[i];
                    kept += 1;
                }
            }
            self.list.truncate(kept);
        }
    }

    /// Runs `find` for the shapes in the other order and turns round what it adds, on the way into the list: reading
    /// back what was just written would wait for the memory. `find` must not look at normals that it added.
    #[inline(always)]
    pub(crate) fn in_other_order(&mut self, find: impl FnOnce(&mut Self)) {
        self.turned = !self.turned;
        find(self);
        self.turned = !self.turned;
    }

    /// The contacts added so far.
    pub fn added(&mut self) -> &mut [GeomContact] {
        self.edited = true;
        &mut self.list[self.start..]
    }

    /// Keeps the first `n` of the contacts added.
    pub fn truncate(&mut self, n: usize) {
        self.list.truncate(self.start + n);
    }

    /// Turns the contacts added into those of the shapes in the other order.
    pub fn swap(&mut self) {
        for c in self.added() {
            *c = c.swapped();
        }
    }
}
