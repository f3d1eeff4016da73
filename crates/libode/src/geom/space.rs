//! Spaces: what is in them, and which pairs may touch.

use super::{GeomId, GeomRecord, class};
use crate::fault::{Fault, Outcome, export, export_calling};
use crate::real::{In, Out, Real, f};
use crate::record::Required;
use crate::slab::Link;
use core::ffi::c_int;
use core::sync::atomic::{AtomicU64, Ordering};
use ferrode_collide::space::{
    AxisOrder, BroadPhase, HashSpace, Proxy, ProxyId, ProxyTable, QuadtreeSpace, Scratch, SimpleSpace,
    SweepAndPruneSpace,
};
use ferrode_math::{Aabb, Vec3};

enum Broad {
    Simple(SimpleSpace),
    Hash(HashSpace),
    SweepAndPrune(SweepAndPruneSpace),
    Quadtree(QuadtreeSpace),
}

/// A cursor that is nowhere.
const NOWHERE: u64 = u64::MAX;

/// A geom in a space.
pub type Member = Link<GeomRecord>;

/// A space's members and the structure that finds pairs of them.
pub struct SpaceData {
    broad: Broad,
    table: ProxyTable,
    /// By proxy number; null for a free one.
    members: Vec<Member>,
    free: Vec<u32>,
    scratch: Scratch,
    cleanup: bool,
    sublevel: c_int,
    /// An index in the upper half and its member in the lower, while the list stays as it is. Threads may ask at once.
    cursor: AtomicU64,
}

impl SpaceData {
    fn new(broad: Broad) -> Self {
        Self {
            broad,
            table: ProxyTable::new(),
            members: Vec::new(),
            free: Vec::new(),
            scratch: Scratch::default(),
            cleanup: true,
            sublevel: 0,
            cursor: AtomicU64::new(NOWHERE),
        }
    }

    /// The structure, the table and the scratch memory, apart.
    fn parts(&mut self) -> (&mut dyn BroadPhase, &mut ProxyTable, &mut Scratch) {
        let broad: &mut dyn BroadPhase = match &mut self.broad {
            Broad::Simple(broad) => broad,
            Broad::Hash(broad) => broad,
            Broad::SweepAndPrune(broad) => broad,
            Broad::Quadtree(broad) => broad,
        };
        (broad, &mut self.table, &mut self.scratch)
    }

    fn broad(&self) -> &dyn BroadPhase {
        match &self.broad {
            Broad::Simple(broad) => broad,
            Broad::Hash(broad) => broad,
            Broad::SweepAndPrune(broad) => broad,
            Broad::Quadtree(broad) => broad,
        }
    }

    /// Members in ODE's order.
    pub fn list(&self) -> Vec<Member> {
        let member = |id: &ProxyId| self.members[id.0 as usize];
        match self.broad().arrays() {
            Some([dirty, clean]) => dirty.iter().chain(clean).map(member).collect(),
            None => self.broad().members().iter(&self.table).map(|id| member(&id)).collect(),
        }
    }

    /// Members newest or last moved first, which for sweep and prune is not the order of the index.
    fn linked(&self) -> Vec<Member> {
        self.broad().members().iter(&self.table).map(|id| self.members[id.0 as usize]).collect()
    }

    /// The member of an index, reached from the last one asked for when the program counts up.
    fn member(&self, index: usize) -> Option<Member> {
        let member = |id: ProxyId| self.members[id.0 as usize];
        if let Some([dirty, clean]) = self.broad().arrays() {
            return dirty
                .get(index)
                .or_else(|| clean.get(index.checked_sub(dirty.len())?))
                .map(|id| member(*id));
        }
        let list = self.broad().members();
        let cursor = self.cursor.load(Ordering::Relaxed);
        let start = (cursor >> 32) as usize;
        let (mut place, mut id) = if cursor != NOWHERE && start <= index {
            (start, Some(ProxyId(cursor as u32)))
        } else {
            (0, list.first())
        };
        while place < index {
            id = list.after(&self.table, id?);
            place += 1;
        }
        self.cursor.store((index as u64) << 32 | u64::from(id?.0), Ordering::Relaxed);
        id.map(member)
    }

    /// A member's box is about to change.
    pub fn moved(&mut self, proxy: u32) {
        self.cursor.store(NOWHERE, Ordering::Relaxed);
        let (broad, table, _) = self.parts();
        broad.moved(table, ProxyId(proxy));
    }

    /// Takes over a member's bits, body and whether to look at it.
    pub fn refresh(&mut self, geom: &GeomRecord) {
        let id = ProxyId(geom.proxy.get());
        let (broad, table, _) = self.parts();
        let proxy = table.get_mut(id);
        let visible = proxy.enabled;
        describe(proxy, geom);
        if proxy.enabled != visible {
            broad.switched(id);
        }
    }
}

/// The box around a space's members; all of the world for a space that is as large.
pub fn aabb_of(class: c_int, members: &[Member]) -> Aabb {
    if matches!(class, class::SWEEP_AND_PRUNE_SPACE | class::QUADTREE_SPACE) {
        return Aabb::EVERYTHING;
    }
    let boxes = members.iter().filter_map(|member| member.live()).map(GeomRecord::current_aabb);
    boxes.reduce(|a, b| a.union(&b)).unwrap_or(Aabb::new(Vec3::ZERO, Vec3::ZERO))
}

fn describe(proxy: &mut Proxy, geom: &GeomRecord) {
    proxy.category_bits = geom.category.get();
    proxy.collide_bits = geom.collide.get();
    proxy.body = (!geom.body.get().is_null()).then(|| geom.body.get().address() as u64);
    proxy.enabled = geom.is_visible();
}

fn proxy_of(geom: &GeomRecord) -> Proxy {
    let mut proxy = Proxy::new(geom.current_aabb());
    describe(&mut proxy, geom);
    proxy
}

/// Work on a space's contents.
fn with<T>(space: &GeomRecord, work: impl FnOnce(&mut SpaceData) -> T) -> Outcome<T> {
    let mut contents = space.contents.borrow_mut();
    Ok(work(contents.as_mut().ok_or(Fault::user("argument not a space"))?))
}

/// A look at a space's contents, by several threads at once if they like.
pub fn look<T>(space: &GeomRecord, work: impl FnOnce(&SpaceData) -> T) -> Outcome<T> {
    const fn is_sync<T: Sync>() {}
    const { is_sync::<(Broad, ProxyTable)>() };
    let not_space = Fault::user("argument not a space");
    // SAFETY: nobody changes the contents meanwhile: `work` is given nothing to do so with and does not call out, and other
    // threads must not (the C interface's contract).
    let contents = unsafe { space.contents.try_borrow_unguarded() }.map_err(|_| not_space)?;
    Ok(work(contents.as_ref().ok_or(not_space)?))
}

pub fn add(space: &'static GeomRecord, geom: &'static GeomRecord) -> Outcome<()> {
    space.require_unlocked()?;
    let mut above = Some(space);
    while let Some(other) = above {
        if core::ptr::eq(other, geom) {
            return Err(Fault::ARGUMENT);
        }
        above = other.parent();
    }
    let mut proxy = Proxy::new(Aabb::EMPTY);
    describe(&mut proxy, geom);
    with(space, |contents| {
        let number = contents.free.pop().unwrap_or(contents.members.len() as u32);
        if number as usize == contents.members.len() {
            contents.members.push(Link::NULL);
        }
        contents.members[number as usize] = Link::to(geom);
        geom.proxy.set(number);
        contents.cursor.store(NOWHERE, Ordering::Relaxed);
        let (broad, table, _) = contents.parts();
        table.set(ProxyId(number), proxy);
        broad.insert(table, ProxyId(number));
    })?;
    geom.space.set(Link::to(space));
    geom.dirty.set(true);
    geom.aabb.forget();
    space.moved()
}

pub fn remove(space: &'static GeomRecord, geom: &'static GeomRecord) -> Outcome<()> {
    space.require_unlocked()?;
    let number = geom.proxy.get();
    with(space, |contents| {
        contents.cursor.store(NOWHERE, Ordering::Relaxed);
        let (broad, table, _) = contents.parts();
        broad.remove(table, ProxyId(number));
        contents.members[number as usize] = Link::NULL;
        contents.free.push(number);
    })?;
    geom.space.set(Link::NULL);
    space.moved()
}

/// Destroys a space's members, or only takes them out.
pub fn empty(space: &'static GeomRecord) -> Outcome<()> {
    let (members, cleanup) = with(space, |contents| (contents.list(), contents.cleanup))?;
    for member in members.into_iter().filter_map(Link::live) {
        if cleanup {
            member.destroy()?;
        } else {
            remove(space, member)?;
        }
    }
    Ok(())
}

/// Computes the boxes of what has moved, in spaces within too. Whatever has moved is at the head of the list.
pub fn clean(space: &'static GeomRecord) -> Outcome<()> {
    let member = |contents: &SpaceData, id: ProxyId| (id, contents.members[id.0 as usize]);
    let mut next = with(space, |contents| contents.broad().members().first().map(|id| member(contents, id)))?;
    while let Some((number, id)) = next
        && let Some(geom) = id.live().filter(|geom| geom.dirty.get())
    {
        if geom.is_space() {
            clean(geom)?;
        }
        // The program's own function may be asked, so nothing is borrowed meanwhile.
        let aabb = geom.current_aabb();
        geom.dirty.set(false);
        next = with(space, |contents| {
            contents.table.get_mut(number).aabb = aabb;
            contents.broad().members().after(&contents.table, number).map(|id| member(contents, id))
        })?;
    }
    with(space, |contents| {
        let (broad, table, _) = contents.parts();
        broad.update(table);
    })
}

pub type Pairs = Vec<(Member, Member)>;

/// Pairs of members of a space that may touch.
pub fn pairs_within(space: &'static GeomRecord, pairs: &mut Pairs) -> Outcome<()> {
    clean(space)?;
    with(space, |contents| {
        let members = core::mem::take(&mut contents.members);
        let (broad, table, scratch) = contents.parts();
        broad.collide(table, scratch, &mut |a, b| {
            pairs.push((members[a.0 as usize], members[b.0 as usize]));
        });
        contents.members = members;
    })
}

/// Members of a space that may touch a geom, which is not asked whether it is enabled.
fn lookup(
    space: &'static GeomRecord,
    single: &'static GeomRecord,
    found: &mut dyn FnMut(Member),
) -> Outcome<()> {
    let proxy = proxy_of(single);
    let own = single.parent().filter(|parent| core::ptr::eq(*parent, space));
    let id = own.map(|_| ProxyId(single.proxy.get()));
    with(space, |contents| {
        let members = core::mem::take(&mut contents.members);
        contents.broad().collide_with(&contents.table, id, &proxy, &mut |other| {
            if Some(other) != id {
                found(members[other.0 as usize]);
            }
        });
        contents.members = members;
    })
}

/// Pairs with one from each side that may touch; the first is from `a`.
pub fn pairs_between(a: &'static GeomRecord, b: &'static GeomRecord, pairs: &mut Pairs) -> Outcome<()> {
    for side in [a, b] {
        if side.is_space() {
            clean(side)?;
        }
    }
    let (ga, gb) = (Link::to(a), Link::to(b));
    match (a.is_space(), b.is_space()) {
        (false, false) => {
            if !core::ptr::eq(a, b) && ferrode_collide::filter::passes(&proxy_of(a), &proxy_of(b)) {
                pairs.push((ga, gb));
            }
            Ok(())
        }
        (false, true) => lookup(b, a, &mut |member| pairs.push((ga, member))),
        (true, false) => lookup(a, b, &mut |member| pairs.push((member, gb))),
        (true, true) => {
            if core::ptr::eq(a, b) {
                return pairs_within(a, pairs);
            }
            let level = |space| with(space, |contents| (contents.sublevel, contents.broad().members().len()));
            let ((la, na), (lb, nb)) = (level(a)?, level(b)?);
            if la > lb {
                lookup(a, b, &mut |member| pairs.push((member, gb)))
            } else if la < lb {
                lookup(b, a, &mut |member| pairs.push((ga, member)))
            } else {
                let (smaller, larger) = if na >= nb { (b, a) } else { (a, b) };
                for other in with(smaller, |contents| contents.linked())?.into_iter().filter_map(Link::live) {
                    let id = Link::to(other);
                    lookup(larger, other, &mut |member| {
                        pairs.push(if na >= nb { (member, id) } else { (id, member) });
                    })?;
                }
                Ok(())
            }
        }
    }
}

/// The order of axes in ODE's three fields of two bits. Programs pass numbers that name an axis twice or none (pyode's
/// default does), and libode takes them: what is missing is filled in.
fn axis_order_of(fields: c_int) -> Outcome<AxisOrder> {
    let mut axes = Vec::with_capacity(3);
    for axis in [fields & 3, fields >> 2 & 3, fields >> 4 & 3, 0, 1, 2] {
        if axis < 3 && !axes.contains(&axis) {
            axes.push(axis);
        }
    }
    AxisOrder::from_ode(axes[0] | axes[1] << 2 | axes[2] << 4).ok_or(Fault::ARGUMENT)
}

fn create(class: c_int, broad: Broad, parent: GeomId) -> Outcome<GeomId> {
    GeomRecord::create(class, None, Some(SpaceData::new(broad)), parent)
}

fn get(space: GeomId) -> Outcome<&'static GeomRecord> {
    let space = space.get()?;
    space.require_space()?;
    Ok(space)
}

fn hash<T>(space: GeomId, work: impl FnOnce(&mut HashSpace) -> T) -> Outcome<T> {
    let not_hash = Fault::user("argument must be a hash space");
    with(get(space).map_err(|fault| if space.is_null() { fault } else { not_hash })?, |contents| {
        match &mut contents.broad {
            Broad::Hash(broad) => Ok(work(broad)),
            _ => Err(not_hash),
        }
    })?
}

export! {
    fn dSimpleSpaceCreate(parent: GeomId) -> GeomId {
        create(class::SIMPLE_SPACE, Broad::Simple(SimpleSpace::new()), parent)?
    }
    fn dHashSpaceCreate(parent: GeomId) -> GeomId {
        create(class::HASH_SPACE, Broad::Hash(HashSpace::new()), parent)?
    }
    fn dQuadTreeSpaceCreate(parent: GeomId, center: In<Real, 3>, extents: In<Real, 3>, depth: c_int) -> GeomId {
        let two = |v: [Real; 3]| [f(v[0]), f(v[1])];
        let (center, extents) = (two(center.get()?), two(extents.get()?));
        let depth = u32::try_from(depth).ok().filter(|depth| *depth <= QuadtreeSpace::MAX_DEPTH);
        let broad = QuadtreeSpace::new(center, extents, depth.ok_or(Fault::ARGUMENT)?);
        create(class::QUADTREE_SPACE, Broad::Quadtree(broad), parent)?
    }
    fn dSweepAndPruneSpaceCreate(parent: GeomId, axis_order: c_int) -> GeomId {
        let order = axis_order_of(axis_order)?;
        create(class::SWEEP_AND_PRUNE_SPACE, Broad::SweepAndPrune(SweepAndPruneSpace::new(order)), parent)?
    }
    fn dHashSpaceSetLevels(space: GeomId, min: c_int, max: c_int) {
        if min > max {
            return Err(Fault::user("must have minlevel <= maxlevel"));
        }
        hash(space, |broad| broad.set_levels(min, max))?
    }
    fn dHashSpaceGetLevels(space: GeomId, min: Out<c_int>, max: Out<c_int>) {
        let levels = hash(space, |broad| broad.levels())?;
        min.set_if_wanted([levels.0]);
        max.set_if_wanted([levels.1])
    }
    fn dSpaceSetCleanup(space: GeomId, mode: c_int) { with(get(space)?, |contents| contents.cleanup = mode != 0)? }
    fn dSpaceGetCleanup(space: GeomId) -> c_int { look(get(space)?, |contents| contents.cleanup)?.into() }
    fn dSpaceSetSublevel(space: GeomId, sublevel: c_int) {
        with(get(space)?, |contents| contents.sublevel = sublevel)?
    }
    fn dSpaceGetSublevel(space: GeomId) -> c_int { look(get(space)?, |contents| contents.sublevel)? }
    /// It chooses between caches that this library does not have; the getter says 1, as Debian's.
    fn dSpaceSetManualCleanup(space: GeomId, _mode: c_int) { get(space)?; }
    fn dSpaceGetManualCleanup(space: GeomId) -> c_int { get(space)?; 1 }
    fn dSpaceAdd(space: GeomId, geom: GeomId) {
        let (space, geom) = (get(space)?, geom.get()?);
        if geom.parent().is_some() {
            return Err(Fault::user("geom is already in a space"));
        }
        add(space, geom)?
    }
    fn dSpaceRemove(space: GeomId, geom: GeomId) {
        let (space, geom) = (get(space)?, geom.get()?);
        if !geom.parent().is_some_and(|parent| core::ptr::eq(parent, space)) {
            return Err(Fault::user("object is not in this space"));
        }
        remove(space, geom)?
    }
    fn dSpaceQuery(space: GeomId, geom: GeomId) -> c_int {
        let space = get(space)?;
        geom.get()?.parent().is_some_and(|parent| core::ptr::eq(parent, space)).into()
    }
    fn dSpaceGetNumGeoms(space: GeomId) -> c_int {
        look(get(space)?, |contents| contents.broad().members().len())? as c_int
    }
    fn dSpaceGetGeom(space: GeomId, index: c_int) -> GeomId {
        let space = get(space)?;
        let outside = Fault::user("index out of range");
        let index = usize::try_from(index).map_err(|_| outside)?;
        look(space, |contents| contents.member(index))?.ok_or(outside)?.handle()
    }
    fn dSpaceGetClass(space: GeomId) -> c_int { get(space)?.class.get() }
}

export_calling! {
    fn dSpaceDestroy(space: GeomId) { get(space)?.destroy()? }
    fn dSpaceClean(space: GeomId) { clean(get(space)?)? }
}
