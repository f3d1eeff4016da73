//! What rows did in the step before, under names that outlast a step.
//!
//! A miss costs time, never the result: pivoting ends at the same states from everywhere.

use ferrode_lcp::RowState;
use ferrode_math::Vec3;

/// A joint, or for contacts a pair of bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Key {
    /// Slots of the bodies.
    pub bodies: [u32; 2],
    /// Slot of the joint.
    pub joint: u32,
}

/// The states of a span's rows, by slot: without friction rows, and with them.
type States = [[Option<RowState>; 2]; 8];

#[derive(Clone, Copy, Debug)]
struct Entry {
    key: Key,
    /// Order of arrival, so that sorting has one outcome.
    number: u32,
    point: Vec3,
    states: States,
}

/// The states of the last step and of this one.
#[derive(Clone, Debug, Default)]
pub(super) struct WarmStart {
    last: Vec<Entry>,
    next: Vec<Entry>,
}

impl WarmStart {
    pub fn begin_step(&mut self) {
        self.next.clear();
    }

    pub fn end_step(&mut self) {
        self.next.sort_unstable_by_key(|e| (e.key, e.number));
        core::mem::swap(&mut self.last, &mut self.next);
    }

    pub fn add(&mut self, key: Key, point: Vec3, states: States) {
        self.next.push(Entry { key, number: self.next.len() as u32, point, states });
    }

    /// The states of the entry of that name with the nearest point.
    pub fn find(&self, key: Key, point: Vec3) -> Option<States> {
        let start = self.last.partition_point(|e| e.key < key);
        let same = self.last[start..].iter().take_while(|e| e.key == key);
        let mut nearest: Option<(f64, States)> = None;
        for e in same {
            let d = e.point - point;
            let distance = d.dot(d);
            if nearest.as_ref().is_none_or(|(least, _)| distance < *least) {
                nearest = Some((distance, e.states));
            }
        }
        nearest.map(|(_, states)| states)
    }
}

#[cfg(test)]
mod tests {
    use super::{Key, WarmStart};
    use ferrode_lcp::RowState;
    use ferrode_math::Vec3;

    #[test]
    fn the_nearest_point_of_the_pair_is_found() {
        let key = |a, b| Key { bodies: [a, b], joint: u32::MAX };
        let states = |s| [[Some(s); 2]; 8];
        let mut warm = WarmStart::default();
        warm.begin_step();
        warm.add(key(3, 1), Vec3::X, states(RowState::Upper));
        warm.add(key(1, 2), Vec3::X, states(RowState::Lower));
        warm.add(key(1, 2), Vec3::Y, states(RowState::Free));
        warm.end_step();
        assert_eq!(warm.find(key(1, 2), Vec3::new(0.9, 0.2, 0.0)), Some(states(RowState::Lower)));
        assert_eq!(warm.find(key(1, 2), Vec3::new(0.2, 0.9, 0.0)), Some(states(RowState::Free)));
        assert_eq!(warm.find(key(2, 1), Vec3::X), None);
    }
}
