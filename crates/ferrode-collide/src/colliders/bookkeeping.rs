//! Who is in which space, and whose box is out of date.

use super::*;

impl Colliders {
    pub(super) fn add(&mut self, parent: Option<SpaceKey>, content: Content) -> Result<Key, ColliderError> {
        if let Some(parent) = parent {
            self.space_node(parent).ok_or(ColliderError::NoSuchSpace(parent))?;
        }
        let key = self.nodes.insert(Node { content, parent: None, dirty: true, aabb_stale: true });
        self.table.set(ProxyId(key.slot), Proxy::new(Aabb::EMPTY));
        self.sync_proxy(key.slot);
        if let Some(parent) = parent {
            self.attach(key.slot, parent.0.slot);
        }
        Ok(key)
    }

    /// Copies to the table what spaces ask of a geom.
    pub(super) fn sync_proxy(&mut self, slot: u32) {
        if let Some(Content::Geom(geom)) = self.nodes.at(slot).map(|n| &n.content) {
            let p = self.table.get_mut(ProxyId(slot));
            p.category_bits = geom.category_bits;
            p.collide_bits = geom.collide_bits;
            p.body = geom.body;
            let enabled = geom.enabled && !geom.shape.is_zero_sized();
            let switched = core::mem::replace(&mut p.enabled, enabled) != enabled;
            let parent = self.nodes.at(slot).and_then(|n| n.parent);
            if let Some(parent) = parent.filter(|_| switched)
                && let Some(Content::Space(space)) = self.nodes.at_mut(parent).map(|n| &mut n.content)
            {
                space.broad.get_mut().switched(ProxyId(slot));
            }
        }
    }

    pub(super) fn attach(&mut self, slot: u32, parent: u32) {
        if let Some(node) = self.nodes.at_mut(slot) {
            node.parent = Some(parent);
            node.dirty = true;
            node.aabb_stale = true;
        }
        if let Some(Content::Space(space)) = self.nodes.at_mut(parent).map(|n| &mut n.content) {
            space.broad.get_mut().insert(&mut self.table, ProxyId(slot));
        }
        self.mark_moved(parent);
    }

    pub(super) fn detach(&mut self, slot: u32) {
        let Some(parent) = self.nodes.at_mut(slot).and_then(|n| n.parent.take()) else { return };
        if let Some(Content::Space(space)) = self.nodes.at_mut(parent).map(|n| &mut n.content) {
            space.broad.get_mut().remove(&mut self.table, ProxyId(slot));
        }
        self.mark_moved(parent);
    }

    /// A geom or space moved: it and the spaces above it that do not yet know become dirty and go to the front of
    /// their lists; the boxes of all spaces above are out of date.
    pub(super) fn mark_moved(&mut self, slot: u32) {
        let mut current = slot;
        while let Some(node) = self.nodes.at_mut(current) {
            node.aabb_stale = true;
            let Some(parent) = node.parent else { return };
            if node.dirty {
                break;
            }
            node.dirty = true;
            if let Some(Content::Space(space)) = self.nodes.at_mut(parent).map(|n| &mut n.content) {
                space.broad.get_mut().moved(&mut self.table, ProxyId(current));
            }
            current = parent;
        }
        let mut above = self.nodes.at(current).and_then(|n| n.parent);
        while let Some(node) = above.and_then(|s| self.nodes.at_mut(s)) {
            // Above a stale space all are stale.
            if node.aabb_stale {
                return;
            }
            node.aabb_stale = true;
            above = node.parent;
        }
    }

    /// The box of a geom or space as it is now, whether or not the table knows it.
    pub(super) fn current_aabb(&self, slot: u32) -> Aabb {
        let Some(node) = self.nodes.at(slot) else { return Aabb::EMPTY };
        if !node.aabb_stale {
            return self.table.get(ProxyId(slot)).aabb;
        }
        match &node.content {
            Content::Geom(geom) => geom.aabb(),
            Content::Space(space) => {
                if space.broad.is_endless() {
                    return Aabb::EVERYTHING;
                }
                let members = space.broad.members();
                if members.is_empty() {
                    return Aabb::new(ferrode_math::Vec3::ZERO, ferrode_math::Vec3::ZERO);
                }
                let boxes = members.iter(&self.table).map(|id| self.current_aabb(id.0));
                boxes.fold(Aabb::EMPTY, |a, b| a.union(&b))
            }
        }
    }

    /// Brings the box of one geom or space in the table up to date.
    pub(super) fn refresh_aabb(&mut self, slot: u32) {
        if self.nodes.at(slot).is_some_and(|n| n.aabb_stale) {
            let aabb = self.current_aabb(slot);
            self.table.get_mut(ProxyId(slot)).aabb = aabb;
            if let Some(node) = self.nodes.at_mut(slot) {
                node.aabb_stale = false;
            }
        }
    }

    /// Brings a space, and the dirty ones in it, up to date.
    pub(super) fn clean(&mut self, space: u32) {
        let marked = |c: &Self, k: usize| c.space_at(space)?.broad.get().marked()?.get(k).copied();
        if self.space_at(space).is_some_and(|s| s.broad.get().marked().is_some()) {
            let mut k = 0;
            while let Some(id) = marked(self, k) {
                // Some have left since, and may be elsewhere.
                if self.nodes.at(id.0).is_some_and(|n| n.dirty && n.parent == Some(space)) {
                    self.clean_member(id);
                }
                k += 1;
            }
        } else {
            // Dirty members are at the front of the list.
            let mut next = self.space_at(space).and_then(|s| s.broad.members().first());
            while let Some(id) = next {
                if !self.nodes.at(id.0).is_some_and(|n| n.dirty) {
                    break;
                }
                self.clean_member(id);
                next = self.space_at(space).and_then(|s| s.broad.members().after(&self.table, id));
            }
        }
        // Its own box is for whoever asks for it: that is a walk over all members.
        if let Some(Content::Space(node)) = self.nodes.at_mut(space).map(|n| &mut n.content) {
            node.broad.get_mut().update(&self.table);
        }
    }

    fn clean_member(&mut self, id: ProxyId) {
        let Some(node) = self.nodes.at_mut(id.0) else { return };
        node.dirty = false;
        match &node.content {
            Content::Geom(geom) => {
                if core::mem::take(&mut node.aabb_stale) {
                    self.table.get_mut(id).aabb = geom.aabb();
                }
            }
            Content::Space(_) => {
                self.clean(id.0);
                self.refresh_aabb(id.0);
            }
        }
    }

    pub(super) fn space_at(&self, slot: u32) -> Option<&SpaceNode> {
        match &self.nodes.at(slot)?.content {
            Content::Space(s) => Some(s),
            Content::Geom(_) => None,
        }
    }

    pub(super) fn space_node(&self, key: SpaceKey) -> Option<&SpaceNode> {
        match &self.nodes.get(key.0)?.content {
            Content::Space(s) => Some(s),
            Content::Geom(_) => None,
        }
    }

    pub(super) fn space_node_mut(&mut self, key: SpaceKey) -> Result<&mut SpaceNode, ColliderError> {
        match self.nodes.get_mut(key.0).map(|n| &mut n.content) {
            Some(Content::Space(s)) => Ok(s),
            _ => Err(ColliderError::NoSuchSpace(key)),
        }
    }

    pub(super) fn geom_mut(&mut self, key: GeomKey) -> Result<&mut Geom, ColliderError> {
        match self.nodes.get_mut(key.0).map(|n| &mut n.content) {
            Some(Content::Geom(geom)) => Ok(geom),
            _ => Err(ColliderError::NoSuchGeom(key)),
        }
    }

    /// The key of an item, if that is here.
    pub(super) fn checked(&self, item: Item) -> Result<Key, ColliderError> {
        match item {
            Item::Geom(key) => self.geom(key).map(|_| key.0).ok_or(ColliderError::NoSuchGeom(key)),
            Item::Space(key) => self.space_node(key).map(|_| key.0).ok_or(ColliderError::NoSuchSpace(key)),
        }
    }

    /// The geom that a proxy stands for, if it does for one.
    #[inline]
    pub(super) fn geom_at(&self, id: ProxyId) -> Option<(GeomKey, &Geom)> {
        match &self.nodes.at(id.0)?.content {
            Content::Geom(geom) => Some((GeomKey(self.nodes.key_at(id.0)), geom)),
            Content::Space(_) => None,
        }
    }

    /// What a proxy stands for.
    pub(super) fn item(&self, id: ProxyId) -> Item {
        let key = self.nodes.key_at(id.0);
        if self.space_at(id.0).is_some() { Item::Space(SpaceKey(key)) } else { Item::Geom(GeomKey(key)) }
    }
}
