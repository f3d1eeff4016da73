//! What a step of `Substep` tells: events, and contacts when they are asked for.

use super::Pipeline;
use crate::contacts::{ContactOwner, TouchingContact};
use crate::{ContactEvent, World};
use ferrode_math::{ContactPoint, Vec3};

impl World {
    /// Events of the step, in the order of the geoms' slots.
    pub(super) fn report_substep(&mut self, pipeline: &mut Pipeline) {
        self.contacts.clear();
        self.events.clear();
        self.lazy_contacts.take();
        let ordered = |list: &[(u32, u32)]| {
            let mut list: Vec<(u32, u32)> = list.iter().map(|(a, b)| (*a.min(b), *a.max(b))).collect();
            list.sort_unstable();
            list
        };
        let key =
            |slot: u32| self.geom_infos.get(slot as usize).and_then(Option::as_ref).map(|info| info.key);
        let mut events = core::mem::take(&mut self.events);
        for (a, b) in ordered(pipeline.pairs.ended()) {
            if let (Some(x), Some(y)) = (key(a), key(b)) {
                events.push(ContactEvent::End(x, y));
            }
        }
        for (a, b) in ordered(pipeline.pairs.began()) {
            if let (Some(x), Some(y)) = (key(a), key(b))
                && !self.pair_passes(a, b)
            {
                events.push(ContactEvent::Begin(x, y));
            }
        }
        self.events = events;
    }

    /// Whether two geoms pass through each other, by their slots.
    fn pair_passes(&self, a: u32, b: u32) -> bool {
        let info = |slot: u32| self.geom_infos.get(slot as usize).and_then(Option::as_ref);
        match (info(a), info(b)) {
            (Some(a), Some(b)) => self.are_joined(a, b).unwrap_or(false) || self.pair_surface(a, b).is_none(),
            _ => true,
        }
    }

    /// The contacts of the last step of `Substep`.
    pub(crate) fn substep_contacts(&self) -> Vec<TouchingContact> {
        let mut list = Vec::new();
        let Some(pipeline) = &self.pipeline else { return list };
        let per_second = f64::from(self.dynamics.substep().substeps) / self.last_h;
        for (place, contact) in pipeline.pairs.contacts() {
            let info = |slot: u32| self.geom_infos.get(slot as usize).and_then(Option::as_ref);
            let (Some(a), Some(b)) = (info(contact.a), info(contact.b)) else { continue };
            let Some(manifold) = pipeline.manifolds.get(place as usize).filter(|m| !m.is_ignored()) else {
                continue;
            };
            let Some(frame) = pipeline.pairs.frame(contact.a) else { continue };
            let m = &contact.manifold;
            let normal = manifold.normal();
            let whole = manifold.normal_impulse();
            for (i, (point, solved)) in m.points().iter().zip(manifold.points()).enumerate() {
                if point.depth < 0.0 && solved.impulse == 0.0 {
                    continue;
                }
                // Friction acts at the middle of the points; each shows its share.
                let impulse = f64::from(solved.impulse);
                let share = if whole > 0.0 { impulse / whole } else { 0.0 };
                let force: Vec3 = (normal * impulse + manifold.friction_impulse() * share) * per_second;
                let depth = f64::from(point.depth);
                list.push(TouchingContact {
                    first: ContactOwner { geom: a.key, body: a.body, side: m.part_a },
                    second: ContactOwner { geom: b.key, body: b.body, side: m.part_b },
                    point: ContactPoint {
                        position: m.place_a(i, frame) + normal * (0.5 * depth),
                        normal,
                        depth,
                    },
                    force,
                    joint: None,
                });
            }
        }
        list
    }
}
