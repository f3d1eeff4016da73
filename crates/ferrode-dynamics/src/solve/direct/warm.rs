//! What rows did in the step before, under names that outlast a step.
//!
//! A miss costs time, never the result: pivoting ends at the same states from everywhere.

use crate::arena::NIL;
use ferrode_lcp::RowState;
use ferrode_math::Vec3;

/// A joint, or for contacts a pair of bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Key {
    /// Slots of the bodies.
    pub bodies: [u32; 2],
    /// Slot of the joint, or [`NIL`].
    pub joint: u32,
}

/// The states of a span's rows, by slot: without friction rows, and with them.
type States = [[Option<RowState>; 2]; 8];

#[derive(Clone, Copy, Debug)]
struct Entry {
    key: Key,
    point: Vec3,
    states: States,
}

/// The states of the last step and of this one, in order of arrival.
#[derive(Clone, Debug, Default)]
pub(super) struct WarmStart {
    last: Vec<Entry>,
    next: Vec<Entry>,
    /// The entries of `last` by key, and then by arrival.
    sorted: Vec<(Key, u32)>,
    /// Whether an entry of `next` has another key than that of `last` in its place.
    new_order: bool,
}

/// Where in a list who asks for all spans of an island expects the next one: mechanisms ask in the same order in each step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Expected(Option<usize>);

impl WarmStart {
    pub fn begin_step(&mut self) {
        self.next.clear();
        self.new_order = false;
    }

    pub fn end_step(&mut self) {
        let same_order = !self.new_order && self.next.len() == self.last.len();
        core::mem::swap(&mut self.last, &mut self.next);
        if same_order {
            return;
        }
        self.sorted.clear();
        self.sorted.extend(self.last.iter().enumerate().map(|(i, entry)| (entry.key, i as u32)));
        self.sorted.sort_unstable();
    }

    pub fn add(&mut self, key: Key, point: Vec3, states: States) {
        self.new_order |= self.last.get(self.next.len()).is_none_or(|entry| entry.key != key);
        self.next.push(Entry { key, point, states });
    }

    /// The states of the entry of that name with the nearest point.
    pub fn find(&self, key: Key, point: Vec3, expected: &mut Expected) -> Option<States> {
        // A joint has one entry, a pair of bodies one for each contact.
        if key.joint != NIL
            && let Some(i) = expected.0
            && let Some(entry) = self.last.get(i)
            && entry.key == key
        {
            expected.0 = Some(i + 1);
            return Some(entry.states);
        }
        let start = self.sorted.partition_point(|(other, _)| *other < key);
        let mut nearest: Option<(f64, usize)> = None;
        for (_, i) in self.sorted[start..].iter().take_while(|(other, _)| *other == key) {
            let i = *i as usize;
            let d = self.last[i].point - point;
            let distance = d.dot(d);
            if nearest.is_none_or(|(least, _)| distance < least) {
                nearest = Some((distance, i));
            }
        }
        let (_, i) = nearest?;
        expected.0 = Some(i + 1);
        Some(self.last[i].states)
    }
}

#[cfg(test)]
mod tests {
    use super::{Expected, Key, WarmStart};
    use ferrode_lcp::RowState;
    use ferrode_math::Vec3;

    #[test]
    fn the_nearest_point_of_the_pair_is_found() {
        let key = |a, b| Key { bodies: [a, b], joint: u32::MAX };
        let states = |s| [[Some(s); 2]; 8];
        let (mut warm, mut expected) = (WarmStart::default(), Expected::default());
        warm.begin_step();
        warm.add(key(3, 1), Vec3::X, states(RowState::Upper));
        warm.add(key(1, 2), Vec3::X, states(RowState::Lower));
        warm.add(key(1, 2), Vec3::Y, states(RowState::Free));
        warm.end_step();
        assert_eq!(
            warm.find(key(1, 2), Vec3::new(0.9, 0.2, 0.0), &mut expected),
            Some(states(RowState::Lower))
        );
        assert_eq!(
            warm.find(key(1, 2), Vec3::new(0.2, 0.9, 0.0), &mut expected),
            Some(states(RowState::Free))
        );
        assert_eq!(warm.find(key(2, 1), Vec3::X, &mut expected), None);
    }

    #[test]
    fn joints_are_found_in_any_order() {
        let key = |joint| Key { bodies: [u32::MAX; 2], joint };
        let (mut warm, mut expected) = (WarmStart::default(), Expected::default());
        warm.begin_step();
        let of = [RowState::Free, RowState::Lower, RowState::Upper].map(|s| [[Some(s); 2]; 8]);
        for (joint, states) in [5, 3, 8].into_iter().zip(of) {
            warm.add(key(joint), Vec3::ZERO, states);
        }
        warm.end_step();
        for (joint, states) in
            [(5, Some(of[0])), (8, Some(of[2])), (4, None), (3, Some(of[1])), (8, Some(of[2]))]
        {
            assert_eq!(warm.find(key(joint), Vec3::ZERO, &mut expected), states);
        }
        warm.begin_step();
        warm.end_step();
        assert_eq!(warm.find(key(5), Vec3::ZERO, &mut expected), None);
    }

    #[test]
    fn a_new_order_and_new_states_are_seen() {
        let key = |joint| Key { bodies: [u32::MAX; 2], joint };
        let states = |s| [[Some(s); 2]; 8];
        let (free, lower) = (states(RowState::Free), states(RowState::Lower));
        let mut warm = WarmStart::default();
        for (order, of_five) in [([5, 3], free), ([5, 3], lower), ([3, 5], free), ([3, 7], free)] {
            warm.begin_step();
            for joint in order {
                warm.add(key(joint), Vec3::ZERO, if joint == 5 { of_five } else { states(RowState::Upper) });
            }
            warm.end_step();
            let found = warm.find(key(5), Vec3::ZERO, &mut Expected::default());
            assert_eq!(found, order.contains(&5).then_some(of_five));
        }
    }
}
