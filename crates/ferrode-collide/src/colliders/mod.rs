//! Geoms and spaces, ready to use.

mod bookkeeping;
mod pairs;

use crate::arena::{Arena, Key};
use crate::space::{
    AxisOrder, BroadPhase, BvhSpace, HashSpace, Members, Proxy, ProxyId, ProxyTable, QuadtreeSpace, Scratch,
    SimpleSpace, SweepAndPruneSpace,
};
use crate::{Frame, Geom, Shape};
use core::fmt;
use ferrode_math::{Aabb, Pose};

/// Names a geom in a [`Colliders`] and its clones. Never matches another geom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GeomKey(Key);

impl GeomKey {
    /// A number that no other geom of this process has, nor had; later geoms of one container have larger ones.
    pub fn serial(self) -> u64 {
        self.0.serial
    }
}

/// Names a space in a [`Colliders`] and its clones. Never matches another space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SpaceKey(Key);

/// What a space may contain: geoms and other spaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Item {
    /// A geom.
    Geom(GeomKey),
    /// A space, with all that is in it.
    Space(SpaceKey),
}

impl From<GeomKey> for Item {
    fn from(key: GeomKey) -> Self {
        Self::Geom(key)
    }
}

impl From<SpaceKey> for Item {
    fn from(key: SpaceKey) -> Self {
        Self::Space(key)
    }
}

/// The kinds of space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SpaceKind {
    /// All pairs: [`SimpleSpace`].
    Simple,
    /// Hierarchical grid: [`HashSpace`], with its smallest and largest level.
    Hash {
        /// Smallest cells measure 2 to this power.
        min_level: i32,
        /// Largest cells measure 2 to this power.
        max_level: i32,
    },
    /// Fixed tree of squares over x and y: [`QuadtreeSpace`].
    Quadtree {
        /// Centre of the largest square, x and y in metres.
        center: [f64; 2],
        /// Its half sides.
        half_sides: [f64; 2],
        /// How often it is halved: at most [`QuadtreeSpace::MAX_DEPTH`].
        depth: u32,
    },
    /// Boxes sorted along an axis: [`SweepAndPruneSpace`].
    SweepAndPrune(AxisOrder),
    /// Tree of boxes kept from step to step: [`BvhSpace`]. The fastest for many geoms; ODE has none.
    Bvh,
}

impl SpaceKind {
    /// A hash space with ODE's levels, −3 to 10.
    pub const HASH: Self = Self::Hash { min_level: -3, max_level: 10 };

    fn check(&self) -> Result<(), ColliderError> {
        if let Self::Quadtree { center, half_sides, depth } = *self {
            let bad = |what, value| Err(ColliderError::BadSpace { what, value });
            if let Some(&x) = center.iter().find(|x| !x.is_finite()) {
                return bad("quadtree centre", x);
            }
            if let Some(&x) = half_sides.iter().find(|x| !(x.is_finite() && **x >= 0.0)) {
                return bad("quadtree half side", x);
            }
            if depth > QuadtreeSpace::MAX_DEPTH {
                return bad("quadtree depth", f64::from(depth));
            }
        }
        Ok(())
    }
}

/// What cannot be done, and to what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColliderError {
    /// There is no such geom here.
    NoSuchGeom(GeomKey),
    /// There is no such space here.
    NoSuchSpace(SpaceKey),
    /// A plane has no pose, offset or body.
    NotPlaceable(GeomKey),
    /// A pose that is not finite.
    BadPose(Pose),
    /// A space cannot contain itself.
    SpaceWithinItself(SpaceKey),
    /// A space cannot be made with this number.
    BadSpace {
        /// Which number, as `quadtree depth`.
        what: &'static str,
        /// Its value.
        value: f64,
    },
}

impl fmt::Display for ColliderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchGeom(key) => write!(f, "no such geom: {key:?}"),
            Self::NoSuchSpace(key) => write!(f, "no such space: {key:?}"),
            Self::NotPlaceable(key) => write!(f, "a plane has no pose, offset or body: {key:?}"),
            Self::BadPose(pose) => write!(f, "pose is not finite: {pose:?}"),
            Self::SpaceWithinItself(key) => write!(f, "a space cannot contain itself: {key:?}"),
            Self::BadSpace { what, value } => write!(f, "no space has this {what}: {value}"),
        }
    }
}

impl core::error::Error for ColliderError {}

/// The structure of a space.
#[derive(Clone, Debug)]
enum Broad {
    Simple(SimpleSpace),
    Hash(HashSpace),
    Quadtree(QuadtreeSpace),
    SweepAndPrune(SweepAndPruneSpace),
    Bvh(Box<BvhSpace>),
}

impl Broad {
    fn new(kind: SpaceKind) -> Self {
        match kind {
            SpaceKind::Simple => Self::Simple(SimpleSpace::new()),
            SpaceKind::Hash { min_level, max_level } => {
                Self::Hash(HashSpace::with_levels(min_level, max_level))
            }
            SpaceKind::Quadtree { center, half_sides, depth } => {
                Self::Quadtree(QuadtreeSpace::new(center, half_sides, depth))
            }
            SpaceKind::SweepAndPrune(order) => Self::SweepAndPrune(SweepAndPruneSpace::new(order)),
            SpaceKind::Bvh => Self::Bvh(Box::default()),
        }
    }

    fn get(&self) -> &dyn BroadPhase {
        match self {
            Self::Simple(s) => s,
            Self::Hash(s) => s,
            Self::Quadtree(s) => s,
            Self::SweepAndPrune(s) => s,
            Self::Bvh(s) => &**s,
        }
    }

    fn get_mut(&mut self) -> &mut dyn BroadPhase {
        match self {
            Self::Simple(s) => s,
            Self::Hash(s) => s,
            Self::Quadtree(s) => s,
            Self::SweepAndPrune(s) => s,
            Self::Bvh(s) => &mut **s,
        }
    }

    fn members(&self) -> &Members {
        self.get().members()
    }

    /// The members in ODE's order.
    fn enumerate<'a>(&'a self, table: &'a ProxyTable) -> impl Iterator<Item = ProxyId> + 'a {
        let [dirty, clean] = self.get().arrays().unwrap_or_default();
        let list = self.get().arrays().is_none().then(|| self.members().iter(table));
        dirty.iter().chain(clean).copied().chain(list.into_iter().flatten())
    }

    /// Whether the space's own box is all of the world: ODE's quadtree and sweep-and-prune spaces.
    fn is_endless(&self) -> bool {
        matches!(self, Self::Quadtree(_) | Self::SweepAndPrune(_))
    }
}

#[derive(Clone, Debug)]
struct SpaceNode {
    broad: Broad,
    sublevel: i32,
    kind: SpaceKind,
    /// Removing the space removes its members.
    cleanup: bool,
    manual_cleanup: bool,
}

#[derive(Clone, Debug)]
enum Content {
    Geom(Box<Geom>),
    Space(Box<SpaceNode>),
}

#[derive(Clone, Debug)]
struct Node {
    content: Content,
    /// Slot of the space it is in.
    parent: Option<u32>,
    /// The space it is in has yet to learn its new box. All spaces above a dirty node are dirty.
    dirty: bool,
    /// The box in the table is out of date.
    aabb_stale: bool,
}

/// Geoms in a tree of spaces.
///
/// Lists and pairs come in ODE's order: the newest member of a space first, and a member that moves goes to the
/// front (but in a [`Bvh`](SpaceKind::Bvh) space, which is not ODE's, all stay in order of insertion). Boxes are recomputed when a question needs them, so [`set_pose`](Self::set_pose) is cheap.
///
/// ODE locks a space while it reports pairs, and errs when a callback changes it. Here callbacks get a shared
/// reference, so that the compiler turns such a program away.
///
/// ```
/// use ferrode_collide::{CollideOptions, Colliders, Geom, SpaceKind, Sphere};
/// use ferrode_math::{Pose, Vec3};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut colliders = Colliders::new();
/// let space = colliders.add_space(None, SpaceKind::HASH)?;
/// let a = colliders.add_geom(Some(space), Geom::new(Sphere::new(1.0)?))?;
/// let b = colliders.add_geom(Some(space), Geom::new(Sphere::new(1.0)?))?;
/// colliders.set_pose(b, Pose::from_position(Vec3::new(1.5, 0.0, 0.0)))?;
/// let mut contacts = Vec::new();
/// colliders.collide(space, |colliders, x, y| {
///     colliders.contacts(x, y, CollideOptions::new(8), &mut contacts);
/// })?;
/// assert_eq!(contacts.len(), 1);
/// assert_eq!(contacts[0].2.point.depth, 0.5);
/// # Ok(()) }
/// ```
#[derive(Clone, Debug, Default)]
pub struct Colliders {
    nodes: Arena<Node>,
    table: ProxyTable,
    scratch: Scratch,
}

impl Colliders {
    /// No geoms, no spaces.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds an empty space, within `parent` or at the root.
    pub fn add_space(
        &mut self,
        parent: Option<SpaceKey>,
        kind: SpaceKind,
    ) -> Result<SpaceKey, ColliderError> {
        kind.check()?;
        let node =
            SpaceNode { broad: Broad::new(kind), sublevel: 0, kind, cleanup: true, manual_cleanup: false };
        self.add(parent, Content::Space(Box::new(node))).map(SpaceKey)
    }

    /// Adds a geom to a space, or to none: such a geom collides only when asked by name.
    pub fn add_geom(&mut self, space: Option<SpaceKey>, geom: Geom) -> Result<GeomKey, ColliderError> {
        if !geom.pose.is_finite() {
            return Err(ColliderError::BadPose(geom.pose));
        }
        self.add(space, Content::Geom(Box::new(geom))).map(GeomKey)
    }

    /// Removes a geom and returns it.
    pub fn remove_geom(&mut self, key: GeomKey) -> Option<Geom> {
        self.geom(key)?;
        self.detach(key.0.slot);
        match self.nodes.remove(key.0)?.content {
            Content::Geom(geom) => Some(*geom),
            Content::Space(_) => None,
        }
    }

    /// Removes a space and all that is in it, unless [`set_cleanup`](Self::set_cleanup) says that its members stay:
    /// these are then in no space. Returns whether there was one.
    pub fn remove_space(&mut self, key: SpaceKey) -> bool {
        let Some(space) = self.space_node(key) else { return false };
        let members: Vec<_> = space.broad.members().iter(&self.table).collect();
        let cleanup = space.cleanup;
        for id in members {
            match self.item(id) {
                _ if !cleanup => self.detach(id.0),
                Item::Geom(geom) => {
                    self.remove_geom(geom);
                }
                Item::Space(space) => {
                    self.remove_space(space);
                }
            }
        }
        self.detach(key.0.slot);
        self.nodes.remove(key.0).is_some()
    }

    /// Moves a geom or space into another space, or out of all.
    pub fn set_parent(
        &mut self,
        item: impl Into<Item>,
        parent: Option<SpaceKey>,
    ) -> Result<(), ColliderError> {
        let key = self.checked(item.into())?;
        if let Some(parent) = parent {
            self.space_node(parent).ok_or(ColliderError::NoSuchSpace(parent))?;
            let mut above = Some(parent.0.slot);
            while let Some(slot) = above {
                if slot == key.slot {
                    return Err(ColliderError::SpaceWithinItself(SpaceKey(key)));
                }
                above = self.nodes.at(slot).and_then(|n| n.parent);
            }
        }
        self.detach(key.slot);
        if let Some(parent) = parent {
            self.attach(key.slot, parent.0.slot);
        }
        Ok(())
    }

    /// The space a geom or space is in.
    pub fn parent(&self, item: impl Into<Item>) -> Option<SpaceKey> {
        let key = self.checked(item.into()).ok()?;
        self.nodes.get(key)?.parent.map(|slot| SpaceKey(self.nodes.key_at(slot)))
    }

    /// The geom `key`.
    #[inline]
    pub fn geom(&self, key: GeomKey) -> Option<&Geom> {
        match &self.nodes.get(key.0)?.content {
            Content::Geom(geom) => Some(geom),
            Content::Space(_) => None,
        }
    }

    /// Whether there is such a space here.
    pub fn contains_space(&self, key: SpaceKey) -> bool {
        self.space_node(key).is_some()
    }

    /// The kind of a space.
    pub fn space_kind(&self, key: SpaceKey) -> Option<SpaceKind> {
        self.space_node(key).map(|s| s.kind)
    }

    /// The boxes of the nodes of a space of trees ([`SpaceKind::Bvh`]) as of the last search, from the roots down; empty for
    /// other spaces. For those who draw them.
    pub fn tree_boxes(&self, space: SpaceKey) -> Vec<Aabb> {
        match self.space_node(space).map(|node| &node.broad) {
            Some(Broad::Bvh(tree)) => tree.boxes(),
            _ => Vec::new(),
        }
    }

    /// Number of members directly in a space.
    pub fn member_count(&self, space: SpaceKey) -> usize {
        self.space_node(space).map_or(0, |s| s.broad.members().len())
    }

    /// The members directly in a space, in ODE's order: newest or last moved first; for sweep and prune those moved
    /// since the last question, then the others.
    pub fn members(&self, space: SpaceKey) -> impl Iterator<Item = Item> + '_ {
        let node = self.space_node(space);
        node.into_iter().flat_map(|s| s.broad.enumerate(&self.table)).map(|id| self.item(id))
    }

    /// All geoms, in no order that means anything.
    pub fn geoms(&self) -> impl Iterator<Item = (GeomKey, &Geom)> {
        self.nodes.iter().filter_map(|(key, node)| match &node.content {
            Content::Geom(geom) => Some((GeomKey(key), &**geom)),
            Content::Space(_) => None,
        })
    }

    /// Number of geoms and spaces.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is neither geom nor space.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Sets a geom's world pose.
    pub fn set_pose(&mut self, key: GeomKey, pose: Pose) -> Result<(), ColliderError> {
        if !pose.is_finite() {
            return Err(ColliderError::BadPose(pose));
        }
        let geom = self.geom_mut(key)?;
        if !geom.shape.is_placeable() {
            return Err(ColliderError::NotPlaceable(key));
        }
        geom.pose = pose;
        geom.frame = Frame::from(&pose);
        self.mark_moved(key.0.slot);
        Ok(())
    }

    /// Moves a geom with its body: its world pose becomes the body's, times its offset if it has one.
    pub fn set_body_pose(&mut self, key: GeomKey, body: &Pose) -> Result<(), ColliderError> {
        let pose = match self.geom(key).ok_or(ColliderError::NoSuchGeom(key))?.offset {
            Some(offset) => *body * offset,
            None => *body,
        };
        self.set_pose(key, pose)
    }

    /// Puts a geom on a body (any number that tells bodies apart) or takes it off. The pose stays; the offset goes
    /// if the body is another.
    pub fn set_body(&mut self, key: GeomKey, body: Option<u64>) -> Result<(), ColliderError> {
        let geom = self.geom_mut(key)?;
        if body.is_some() && !geom.shape.is_placeable() {
            return Err(ColliderError::NotPlaceable(key));
        }
        if geom.body != body {
            geom.offset = None;
        }
        geom.body = body;
        self.sync_proxy(key.0.slot);
        if body.is_some() {
            self.mark_moved(key.0.slot);
        }
        Ok(())
    }

    /// Sets or clears a geom's pose in its body; the world pose follows at the next
    /// [`set_body_pose`](Self::set_body_pose).
    pub fn set_offset(&mut self, key: GeomKey, offset: Option<Pose>) -> Result<(), ColliderError> {
        if let Some(pose) = offset.filter(|p| !p.is_finite()) {
            return Err(ColliderError::BadPose(pose));
        }
        let geom = self.geom_mut(key)?;
        if !geom.shape.is_placeable() {
            return Err(ColliderError::NotPlaceable(key));
        }
        geom.offset = offset;
        self.mark_moved(key.0.slot);
        Ok(())
    }

    /// Gives a geom another shape. A geom that becomes a plane loses its pose.
    pub fn set_shape(&mut self, key: GeomKey, shape: impl Into<Shape>) -> Result<(), ColliderError> {
        let geom = self.geom_mut(key)?;
        geom.shape = shape.into();
        if !geom.shape.is_placeable() {
            geom.pose = Pose::IDENTITY;
            geom.frame = Frame::IDENTITY;
            geom.offset = None;
        }
        self.sync_proxy(key.0.slot);
        self.mark_moved(key.0.slot);
        Ok(())
    }

    /// Sets what a geom is and what it collides with.
    pub fn set_bits(&mut self, key: GeomKey, category: u64, collide: u64) -> Result<(), ColliderError> {
        let geom = self.geom_mut(key)?;
        geom.category_bits = category;
        geom.collide_bits = collide;
        self.sync_proxy(key.0.slot);
        Ok(())
    }

    /// Sets whether spaces look at a geom. [`contacts`](Self::contacts) does not ask.
    pub fn set_enabled(&mut self, key: GeomKey, enabled: bool) -> Result<(), ColliderError> {
        self.geom_mut(key)?.enabled = enabled;
        self.sync_proxy(key.0.slot);
        Ok(())
    }

    /// Sets the user's number of a geom.
    pub fn set_user(&mut self, key: GeomKey, user: u64) -> Result<(), ColliderError> {
        self.geom_mut(key)?.user = user;
        Ok(())
    }

    /// A space's sublevel, 0 at first; see [`collide2`](Self::collide2).
    pub fn sublevel(&self, key: SpaceKey) -> Option<i32> {
        self.space_node(key).map(|s| s.sublevel)
    }

    /// Sets a space's sublevel.
    pub fn set_sublevel(&mut self, key: SpaceKey, sublevel: i32) -> Result<(), ColliderError> {
        self.space_node_mut(key)?.sublevel = sublevel;
        Ok(())
    }

    /// Whether removing a space removes its members too; true at first.
    pub fn cleanup(&self, key: SpaceKey) -> Option<bool> {
        self.space_node(key).map(|s| s.cleanup)
    }

    /// Sets whether removing a space removes its members too.
    pub fn set_cleanup(&mut self, key: SpaceKey, cleanup: bool) -> Result<(), ColliderError> {
        self.space_node_mut(key)?.cleanup = cleanup;
        Ok(())
    }

    /// ODE's flag for which cache a space's meshes use. Kept for its users; no cache here needs it.
    pub fn manual_cleanup(&self, key: SpaceKey) -> Option<bool> {
        self.space_node(key).map(|s| s.manual_cleanup)
    }

    /// Sets the flag that [`manual_cleanup`](Self::manual_cleanup) returns.
    pub fn set_manual_cleanup(&mut self, key: SpaceKey, manual: bool) -> Result<(), ColliderError> {
        self.space_node_mut(key)?.manual_cleanup = manual;
        Ok(())
    }

    /// Sets the levels of a hash space; other kinds have none and stay as they are.
    pub fn set_hash_levels(&mut self, key: SpaceKey, min: i32, max: i32) -> Result<(), ColliderError> {
        let s = self.space_node_mut(key)?;
        if let Broad::Hash(hash) = &mut s.broad {
            hash.set_levels(min, max);
            let (min_level, max_level) = hash.levels();
            s.kind = SpaceKind::Hash { min_level, max_level };
        }
        Ok(())
    }

    /// The world box around a geom, or around all geoms in a space. An empty space has a box of no size at the
    /// origin; a quadtree or sweep-and-prune space always has all of the world.
    pub fn aabb(&self, item: impl Into<Item>) -> Option<Aabb> {
        let key = self.checked(item.into()).ok()?;
        Some(self.current_aabb(key.slot))
    }
}
