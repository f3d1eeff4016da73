//! Pairs that may touch, and their contacts.

use super::*;
use crate::filter::passes;
use crate::space::Probe;
use crate::{CollideOptions, GeomContact, narrow};
use core::cell::Cell;

impl Colliders {
    /// Reports the pairs of members of a space that may touch (ODE's `dSpaceCollide`).
    ///
    /// Spaces in it are members like any other and come as a whole: to go on into them, call
    /// [`collide2_inside`](Self::collide2_inside) and [`collide_inside`](Self::collide_inside) in the callback, or
    /// [`contacts`](Self::contacts), which opens spaces by itself.
    pub fn collide(
        &mut self,
        space: SpaceKey,
        mut report: impl FnMut(&Self, Item, Item),
    ) -> Result<(), ColliderError> {
        self.space_node(space).ok_or(ColliderError::NoSuchSpace(space))?;
        self.clean(space.0.slot);
        let mut scratch = core::mem::take(&mut self.scratch);
        self.collide_members(space, &mut scratch, &mut report);
        self.scratch = scratch;
        Ok(())
    }

    /// As [`collide`](Self::collide), for use within a callback. Boxes of members that were moved before and not
    /// asked about since are those of before.
    pub fn collide_inside(&self, space: SpaceKey, mut report: impl FnMut(&Self, Item, Item)) {
        self.collide_members(space, &mut Scratch::default(), &mut report);
    }

    fn collide_members(
        &self,
        space: SpaceKey,
        scratch: &mut Scratch,
        report: &mut dyn FnMut(&Self, Item, Item),
    ) {
        if let Some(node) = self.space_node(space) {
            node.broad.get().collide(&self.table, scratch, &mut |a, b| {
                report(self, self.item(a), self.item(b));
            });
        }
    }

    /// Reports the pairs that may touch with one from `a` and the other from `b` (ODE's `dSpaceCollide2`).
    ///
    /// The first of each pair comes from `a`. Two geoms: that pair, if boxes and bits allow it. A geom and a space:
    /// the geom with each member. Two spaces: the one of the lower sublevel counts as a single geom; on equal
    /// sublevels the members of the one with each of the other. As in ODE, only the members looked up are skipped
    /// when disabled.
    pub fn collide2(
        &mut self,
        a: impl Into<Item>,
        b: impl Into<Item>,
        report: impl FnMut(&Self, Item, Item),
    ) -> Result<(), ColliderError> {
        let (a, b) = (a.into(), b.into());
        for item in [a, b] {
            let slot = self.checked(item)?.slot;
            if matches!(item, Item::Space(_)) {
                self.clean(slot);
            }
            self.refresh_aabb(slot);
        }
        self.collide2_inside(a, b, report);
        Ok(())
    }

    /// As [`collide2`](Self::collide2), for use within a callback.
    pub fn collide2_inside(
        &self,
        a: impl Into<Item>,
        b: impl Into<Item>,
        mut report: impl FnMut(&Self, Item, Item),
    ) {
        let (a, b) = (a.into(), b.into());
        let (Ok(ka), Ok(kb)) = (self.checked(a), self.checked(b)) else { return };
        let (sa, sb) = (self.space_at(ka.slot), self.space_at(kb.slot));
        match (sa, sb) {
            (None, None) => {
                if a != b && passes(&self.current_proxy(ka.slot), &self.current_proxy(kb.slot)) {
                    report(self, a, b);
                }
            }
            (None, Some(_)) => self.lookup(kb.slot, ka.slot, &mut |member| report(self, a, member)),
            (Some(_), None) => self.lookup(ka.slot, kb.slot, &mut |member| report(self, member, b)),
            (Some(na), Some(nb)) => {
                if ka == kb {
                    self.collide_members(SpaceKey(ka), &mut Scratch::default(), &mut report);
                } else if na.sublevel > nb.sublevel {
                    self.lookup(ka.slot, kb.slot, &mut |member| report(self, member, b));
                } else if na.sublevel < nb.sublevel {
                    self.lookup(kb.slot, ka.slot, &mut |member| report(self, a, member));
                } else if na.broad.members().len() >= nb.broad.members().len() {
                    for id in nb.broad.enumerate(&self.table) {
                        let other = self.item(id);
                        self.lookup(ka.slot, id.0, &mut |member| report(self, member, other));
                    }
                } else {
                    for id in na.broad.enumerate(&self.table) {
                        let other = self.item(id);
                        self.lookup(kb.slot, id.0, &mut |member| report(self, other, member));
                    }
                }
            }
        }
    }

    /// Reports the members of the space in slot `space` that may touch what is in slot `single`, itself excepted.
    fn lookup(&self, space: u32, single: u32, report: &mut dyn FnMut(Item)) {
        let Some(node) = self.space_at(space) else { return };
        let proxy = self.current_proxy(single);
        node.broad.get().collide_with(&self.table, Some(ProxyId(single)), &proxy, &mut |id| {
            if id.0 != single {
                report(self.item(id));
            }
        });
    }

    /// Brings a space up to date for questions that change nothing.
    pub(crate) fn refresh(&mut self, space: SpaceKey) -> Result<(), ColliderError> {
        self.space_node(space).ok_or(ColliderError::NoSuchSpace(space))?;
        self.clean(space.0.slot);
        Ok(())
    }

    /// Calls `found` with the enabled geoms in a space whose boxes pass `test`, spaces within it included.
    pub(crate) fn visit_boxes(
        &self,
        space: SpaceKey,
        test: &dyn Fn(&Aabb) -> bool,
        found: &mut dyn FnMut(GeomKey, &Geom),
    ) {
        let Some(node) = self.space_node(space) else { return };
        node.broad.get().visit(&self.table, test, &mut |id| match self.item(id) {
            Item::Geom(key) => {
                if let Some(geom) = self.geom(key) {
                    found(key, geom);
                }
            }
            Item::Space(inner) => self.visit_boxes(inner, test, found),
        });
    }

    /// Calls `found` with the enabled geoms in a space whose boxes the probe meets within the limit, which it may lower; spaces
    /// within it included.
    pub(crate) fn seek(
        &self,
        space: SpaceKey,
        probe: &Probe,
        limit: &mut f64,
        found: &mut dyn FnMut(GeomKey, &Geom, &mut f64),
    ) {
        let Some(node) = self.space_node(space) else { return };
        let turned = |id: ProxyId| self.geom_at(id)?.1.turned_box();
        node.broad.get().seek(&self.table, probe, limit, &turned, &mut |id, limit| match self.geom_at(id) {
            Some((key, geom)) => found(key, geom, limit),
            None => {
                if let Item::Space(inner) = self.item(id) {
                    self.seek(inner, probe, limit, found);
                }
            }
        });
    }

    /// The proxy of a slot with its present box.
    fn current_proxy(&self, slot: u32) -> Proxy {
        let mut proxy = *self.table.get(ProxyId(slot));
        proxy.aabb = self.current_aabb(slot);
        proxy
    }

    /// Finds the contacts of two geoms and adds them to `out`, each with the geoms it is between; returns how many.
    ///
    /// Bits, enabled state and boxes are not asked; geoms on the same body have no contacts (ODE's `dCollide`). For
    /// a space, all its members that may touch are collided until `options.max_contacts` is reached.
    pub fn contacts(
        &self,
        a: impl Into<Item>,
        b: impl Into<Item>,
        options: CollideOptions,
        out: &mut Vec<(GeomKey, GeomKey, GeomContact)>,
    ) -> usize {
        thread_local! {
            /// Kept so that a call allocates nothing.
            static LIST: Cell<Vec<GeomContact>> = const { Cell::new(Vec::new()) };
        }
        let mut list = LIST.take();
        let start = out.len();
        self.contacts_with(a.into(), b.into(), options, &mut list, out);
        LIST.set(list);
        out.len() - start
    }

    /// As [`contacts`](Self::contacts), for two geoms, without naming them; allocates nothing if `out` has room.
    #[inline]
    pub fn geom_contacts(
        &self,
        a: GeomKey,
        b: GeomKey,
        options: CollideOptions,
        out: &mut Vec<GeomContact>,
    ) -> usize {
        // One after the other: looked up at once, both would be tested at length before the first is known to be there.
        let Some(ga) = self.geom(a) else { return 0 };
        let Some(gb) = self.geom(b) else { return 0 };
        if core::ptr::eq(ga, gb) || (ga.body.is_some() && ga.body == gb.body) {
            return 0;
        }
        narrow::collide_frames((&ga.shape, &ga.frame), (&gb.shape, &gb.frame), options, out)
    }

    /// As [`geom_contacts`](Self::geom_contacts), by [`narrow::steady`]: contacts on which bodies lie still.
    pub fn steady_contacts(
        &self,
        a: GeomKey,
        b: GeomKey,
        options: CollideOptions,
        out: &mut Vec<GeomContact>,
    ) -> usize {
        let (Some(ga), Some(gb)) = (self.geom(a), self.geom(b)) else { return 0 };
        if a == b || (ga.body.is_some() && ga.body == gb.body) {
            return 0;
        }
        narrow::steady_frames((&ga.shape, &ga.frame), (&gb.shape, &gb.frame), options, out)
    }

    fn contacts_with(
        &self,
        a: Item,
        b: Item,
        options: CollideOptions,
        list: &mut Vec<GeomContact>,
        out: &mut Vec<(GeomKey, GeomKey, GeomContact)>,
    ) {
        if let (Item::Geom(ga), Item::Geom(gb)) = (a, b) {
            list.clear();
            self.geom_contacts(ga, gb, options, list);
            out.extend(list.iter().map(|c| (ga, gb, *c)));
            return;
        }
        let limit = out.len() + usize::from(options.max_contacts);
        self.collide2_inside(a, b, |_, x, y| {
            let left = limit.saturating_sub(out.len());
            if left > 0 {
                let options = CollideOptions { max_contacts: left as u16, ..options };
                self.contacts_with(x, y, options, list, out);
            }
        });
    }
}
