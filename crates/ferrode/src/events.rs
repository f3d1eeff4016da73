//! Who began and who ceased to touch.

use crate::World;
use ferrode_collide::GeomKey;

/// A change in what touches what, found by a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ContactEvent {
    /// The two geoms touch, and did not in the step before.
    Begin(GeomKey, GeomKey),
    /// The two geoms ceased to touch.
    End(GeomKey, GeomKey),
}

impl World {
    /// Compares the pairs that touch now with those of the step before. Both lists are sorted.
    pub(crate) fn find_events(&mut self, now: &mut Vec<(usize, usize)>) {
        now.sort_unstable();
        now.dedup();
        self.events.clear();
        let key = |slot: usize| self.geom_infos.get(slot).and_then(Option::as_ref).map(|info| info.key);
        let both = |(a, b): (usize, usize)| Some((key(a)?, key(b)?));
        let (mut i, mut j) = (0, 0);
        while i < self.touching.len() || j < now.len() {
            let before = self.touching.get(i);
            let after = now.get(j);
            match (before, after) {
                (Some(b), Some(a)) if a == b => (i, j) = (i + 1, j + 1),
                (Some(b), a) if a.is_none_or(|a| b < a) => {
                    self.events.extend(both(*b).map(|(x, y)| ContactEvent::End(x, y)));
                    i += 1;
                }
                (_, Some(a)) => {
                    self.events.extend(both(*a).map(|(x, y)| ContactEvent::Begin(x, y)));
                    j += 1;
                }
                _ => break,
            }
        }
        core::mem::swap(&mut self.touching, now);
    }
}
