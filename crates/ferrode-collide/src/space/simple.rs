use super::{BroadPhase, Members, Proxy, ProxyId, ProxyTable, Scratch, scan};
use crate::filter::passes;

/// Tests all pairs: right for a few geoms, and the reference for the others.
///
/// Pairs come in list order, (first, second), (first, third) …
#[derive(Clone, Debug, Default)]
pub struct SimpleSpace {
    members: Members,
}

impl SimpleSpace {
    /// A space without members.
    pub fn new() -> Self {
        Self::default()
    }
}

impl BroadPhase for SimpleSpace {
    fn insert(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.push_front(table, id);
    }

    fn remove(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.remove(table, id);
    }

    fn moved(&mut self, table: &mut ProxyTable, id: ProxyId) {
        self.members.to_front(table, id);
    }

    fn update(&mut self, _: &ProxyTable) {}

    fn collide(&self, table: &ProxyTable, _: &mut Scratch, report: &mut dyn FnMut(ProxyId, ProxyId)) {
        let mut next = self.members.first();
        while let Some(a) = next {
            next = self.members.after(table, a);
            let pa = table.get(a);
            if !pa.enabled {
                continue;
            }
            let mut other = next;
            while let Some(b) = other {
                let pb = table.get(b);
                if pb.enabled && passes(pa, pb) {
                    report(a, b);
                }
                other = self.members.after(table, b);
            }
        }
    }

    fn collide_with(
        &self,
        table: &ProxyTable,
        _: Option<ProxyId>,
        proxy: &Proxy,
        report: &mut dyn FnMut(ProxyId),
    ) {
        scan(&self.members, table, proxy, report);
    }

    fn members(&self) -> &Members {
        &self.members
    }
}
