//! Spaces: which geoms come near each other (broad phase).
//!
//! A space is a data structure over *proxies*: numbers with a box and bits, kept in a [`ProxyTable`] that the caller
//! owns. It knows no shapes. Each kind reports pairs in the order in which ODE's space of that kind does, because
//! the order of contacts decides what `Quick` computes.

mod binning;
mod bvh;
pub(crate) mod dynamic_tree;
pub(crate) mod f32_box;
mod hash;
mod leaf_box;
mod mirror;
mod packed;
mod pair_nodes;
mod probe;
mod proxy;
mod quadtree;
mod simple;
mod sweep_and_prune;
pub mod tree;
mod wide;

use ferrode_math::Aabb;

pub use bvh::BvhSpace;
pub use hash::HashSpace;
pub use leaf_box::TurnedBox;
pub use probe::Probe;
pub use proxy::{Members, Proxy, ProxyId, ProxyTable};
pub use quadtree::QuadtreeSpace;
pub use simple::SimpleSpace;
pub use sweep_and_prune::{AxisOrder, SweepAndPruneSpace};

/// What every kind of space can do.
///
/// A proxy is in at most one space of those that share a table. After changing boxes, tell the space by
/// [`moved`](Self::moved), then call [`update`](Self::update) before the next question.
pub trait BroadPhase {
    /// Adds a proxy, at the head of the list of members.
    fn insert(&mut self, table: &mut ProxyTable, id: ProxyId);
    /// Removes a proxy.
    fn remove(&mut self, table: &mut ProxyTable, id: ProxyId);
    /// Notes that a proxy's box is about to change; it goes to the head of the list, where the order of ODE asks for it.
    fn moved(&mut self, table: &mut ProxyTable, id: ProxyId);
    /// Brings the structure up to date with the boxes in the table.
    fn update(&mut self, table: &ProxyTable);
    /// Reports every pair of members that may touch, once.
    fn collide(&self, table: &ProxyTable, scratch: &mut Scratch, report: &mut dyn FnMut(ProxyId, ProxyId));
    /// Reports every enabled member that may touch `proxy`, which need not be in this space; `id` is its number, if it
    /// has one.
    fn collide_with(
        &self,
        table: &ProxyTable,
        id: Option<ProxyId>,
        proxy: &Proxy,
        report: &mut dyn FnMut(ProxyId),
    );
    /// Notes that a member was switched on or off: to be called whenever [`Proxy::enabled`] has changed.
    fn switched(&mut self, _id: ProxyId) {}
    /// Reports every enabled member whose box passes `test`. If a box passes, so must all boxes around it.
    fn visit(&self, table: &ProxyTable, test: &dyn Fn(&Aabb) -> bool, report: &mut dyn FnMut(ProxyId)) {
        for id in self.members().iter(table) {
            let member = table.get(id);
            if member.enabled && test(&member.aabb) {
                report(id);
            }
        }
    }
    /// Reports every enabled member whose box the probe meets within the limit, nearer ones first as far as the
    /// structure tells. `report` may lower the limit. `turned` may know of a box that holds all of a member and is tighter than
    /// the one in the table; it stays until the member is [`moved`](Self::moved). A member whose tighter box is missed need not
    /// be reported.
    fn seek(
        &self,
        table: &ProxyTable,
        probe: &Probe,
        limit: &mut f64,
        _turned: &dyn Fn(ProxyId) -> Option<TurnedBox>,
        report: &mut dyn FnMut(ProxyId, &mut f64),
    ) {
        for id in self.members().iter(table) {
            let member = table.get(id);
            if member.enabled && probe.enter_aabb(&member.aabb, *limit).is_some() {
                report(id, limit);
            }
        }
    }
    /// The members, newest or last moved first.
    fn members(&self) -> &Members;
    /// What was marked since the last update, in no order; may name some twice, and some that left. `None`: the front of
    /// the list of members.
    fn marked(&self) -> Option<&[ProxyId]> {
        None
    }
    /// The members in the order in which ODE counts them, where that is not the order of the list.
    fn arrays(&self) -> Option<[&[ProxyId]; 2]> {
        None
    }
}

/// Memory that a search needs while it runs; kept between searches so that nothing is allocated.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    pub(crate) bvh: bvh::BvhScratch,
    pub(crate) hash: hash::HashScratch,
}

/// Tests `proxy` against every member in list order: what most of ODE's spaces do.
fn scan(members: &Members, table: &ProxyTable, proxy: &Proxy, report: &mut dyn FnMut(ProxyId)) {
    for id in members.iter(table) {
        let member = table.get(id);
        if member.enabled && crate::filter::passes(proxy, member) {
            report(id);
        }
    }
}
