//! What rows did in the step before, under names that outlast a step.
//!
//! A miss costs time, never the result: pivoting ends at the same states from everywhere.

use ferrode_lcp::RowState;
use ferrode_math::Vec3;

/// What names a span's rows from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Name {
    /// Slot of the joint.
    Joint(u32),
    /// Of a contact, which programs make anew each step: the slots of its bodies, and its point in the first one's frame.
    Contact([u32; 2], Vec3),
}

/// The states of a span's rows, by slot: without friction rows, and with them.
pub(super) type States = [[Option<RowState>; 2]; 8];

#[derive(Clone, Copy, Debug)]
struct Contact {
    bodies: [u32; 2],
    point: Vec3,
    states: States,
}

#[derive(Clone, Copy, Debug, Default)]
struct Joint {
    /// The number of the step that the states are of; 0 for none.
    step: u64,
    states: States,
}

/// The states of the last step and of this one.
#[derive(Clone, Debug, Default)]
pub(super) struct WarmStart {
    /// The number of this step.
    step: u64,
    /// By slot.
    joints: Vec<Joint>,
    /// In order of arrival.
    last: Vec<Contact>,
    next: Vec<Contact>,
    /// The contacts of `last` by bodies, and then by arrival.
    sorted: Vec<([u32; 2], u32)>,
    /// Whether a contact of `next` has other bodies than that of `last` in its place.
    new_order: bool,
}

impl WarmStart {
    pub fn begin_step(&mut self) {
        self.step += 1;
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
        self.sorted.extend(self.last.iter().enumerate().map(|(i, contact)| (contact.bodies, i as u32)));
        self.sorted.sort_unstable();
    }

    pub fn add(&mut self, name: Name, states: States) {
        match name {
            Name::Joint(slot) => {
                let slot = slot as usize;
                if self.joints.len() <= slot {
                    self.joints.resize(slot + 1, Joint::default());
                }
                self.joints[slot] = Joint { step: self.step, states };
            }
            Name::Contact(bodies, point) => {
                let before = self.last.get(self.next.len());
                self.new_order |= before.is_none_or(|contact| contact.bodies != bodies);
                self.next.push(Contact { bodies, point, states });
            }
        }
    }

    /// The states of the joint, or of the contact of these bodies with the nearest point, in the step before.
    pub fn find(&self, name: Name) -> Option<States> {
        match name {
            Name::Joint(slot) => {
                let joint = self.joints.get(slot as usize)?;
                (joint.step > 0 && joint.step + 1 == self.step).then_some(joint.states)
            }
            Name::Contact(bodies, point) => {
                let start = self.sorted.partition_point(|(other, _)| *other < bodies);
                let mut nearest: Option<(f64, &Contact)> = None;
                for (_, i) in self.sorted[start..].iter().take_while(|(other, _)| *other == bodies) {
                    let contact = &self.last[*i as usize];
                    let d = contact.point - point;
                    let distance = d.dot(d);
                    if nearest.is_none_or(|(least, _)| distance < least) {
                        nearest = Some((distance, contact));
                    }
                }
                Some(nearest?.1.states)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Name, WarmStart};
    use ferrode_lcp::RowState;
    use ferrode_math::Vec3;

    #[test]
    fn the_nearest_point_of_the_pair_is_found() {
        let states = |s| [[Some(s); 2]; 8];
        let at = |a, b, x, y| Name::Contact([a, b], Vec3::new(x, y, 0.0));
        let mut warm = WarmStart::default();
        warm.begin_step();
        warm.add(at(3, 1, 1.0, 0.0), states(RowState::Upper));
        warm.add(at(1, 2, 1.0, 0.0), states(RowState::Lower));
        warm.add(at(1, 2, 0.0, 1.0), states(RowState::Free));
        warm.end_step();
        warm.begin_step();
        assert_eq!(warm.find(at(1, 2, 0.9, 0.2)), Some(states(RowState::Lower)));
        assert_eq!(warm.find(at(1, 2, 0.2, 0.9)), Some(states(RowState::Free)));
        assert_eq!(warm.find(at(2, 1, 1.0, 0.0)), None);
        warm.end_step();
        assert_eq!(warm.find(at(1, 2, 0.2, 0.9)), None);
    }

    #[test]
    fn joints_are_found_in_the_next_step_only() {
        let mut warm = WarmStart::default();
        warm.begin_step();
        let of = [RowState::Free, RowState::Lower, RowState::Upper].map(|s| [[Some(s); 2]; 8]);
        for (joint, states) in [5, 3, 8].into_iter().zip(of) {
            warm.add(Name::Joint(joint), states);
        }
        assert_eq!(warm.find(Name::Joint(5)), None);
        warm.end_step();
        warm.begin_step();
        for (joint, states) in [(5, Some(of[0])), (8, Some(of[2])), (4, None), (3, Some(of[1])), (99, None)] {
            assert_eq!(warm.find(Name::Joint(joint)), states);
        }
        warm.end_step();
        warm.begin_step();
        assert_eq!(warm.find(Name::Joint(5)), None);
    }

    #[test]
    fn a_new_order_and_new_states_are_seen() {
        let at = |a| Name::Contact([a, 1], Vec3::ZERO);
        let states = |s| [[Some(s); 2]; 8];
        let (free, lower) = (states(RowState::Free), states(RowState::Lower));
        let mut warm = WarmStart::default();
        for (order, of_five) in [([5, 3], free), ([5, 3], lower), ([3, 5], free), ([3, 7], free)] {
            warm.begin_step();
            for body in order {
                warm.add(at(body), if body == 5 { of_five } else { states(RowState::Upper) });
            }
            warm.end_step();
            assert_eq!(warm.find(at(5)), order.contains(&5).then_some(of_five));
        }
    }
}
