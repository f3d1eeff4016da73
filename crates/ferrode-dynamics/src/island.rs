//! Islands: sets of bodies that joints hold together.

use crate::World;
use crate::arena::NIL;
use ferrode_lcp::abreast;

/// Bodies and joints of all islands, in the order in which they are stepped: the order of rows depends on it, so it is
/// ODE's.
#[derive(Clone, Debug, Default)]
pub(crate) struct Islands {
    /// Slots of bodies, island after island.
    pub bodies: Vec<u32>,
    /// Slots of joints, island after island.
    pub joints: Vec<u32>,
    /// Where each island ends in `bodies` and `joints`.
    pub ends: Vec<(usize, usize)>,
    body_seen: Vec<bool>,
    joint_seen: Vec<bool>,
    stack: Vec<u32>,
}

impl Islands {
    /// The bodies and the joints of an island.
    pub fn of(&self, island: usize) -> (&[u32], &[u32]) {
        let first = island.checked_sub(1).map_or((0, 0), |before| self.ends[before]);
        let end = self.ends[island];
        (&self.bodies[first.0..end.0], &self.joints[first.1..end.1])
    }

    /// How many islands, from this one on, have as many bodies and joints.
    pub fn alike(&self, island: usize) -> usize {
        let size = |island: usize| {
            let (bodies, joints) = self.of(island);
            (bodies.len(), joints.len())
        };
        let first = size(island);
        1 + (island + 1..self.ends.len())
            .take(abreast() - 1)
            .take_while(|other| size(*other) == first)
            .count()
    }
}

impl World {
    /// Finds the islands of awake bodies, and wakes what a joint links to them.
    ///
    /// From each awake body not yet seen, newest first, walk: the joints of a body, most recent first, then the body
    /// found last. The static world never connects islands; kinematic bodies do.
    pub(crate) fn find_islands(&mut self, islands: &mut Islands) {
        islands.bodies.clear();
        islands.joints.clear();
        islands.ends.clear();
        islands.body_seen.clear();
        islands.body_seen.resize(self.bodies.capacity(), false);
        islands.joint_seen.clear();
        islands.joint_seen.resize(self.joints.capacity(), false);
        let mut seed = self.body_list.first;
        while seed != NIL {
            let body = self.bodies.at(seed);
            let next = body.next;
            if body.enabled && !body.quarantined && !islands.body_seen[seed as usize] {
                self.walk_island(seed, islands);
            }
            seed = next;
        }
    }

    fn walk_island(&mut self, seed: u32, islands: &mut Islands) {
        islands.body_seen[seed as usize] = true;
        islands.stack.push(seed);
        while let Some(body) = islands.stack.pop() {
            islands.bodies.push(body);
            let mut link = self.bodies.at(body).first_joint;
            while link != NIL {
                let (index, side) = (link >> 1, (link & 1) as usize);
                let joint = self.joints.at(index);
                link = joint.nodes[side].next;
                if core::mem::replace(&mut islands.joint_seen[index as usize], true)
                    || !joint.enabled
                    || !self.moves_a_body(joint)
                {
                    continue;
                }
                islands.joints.push(index);
                let other = joint.nodes[1 - side].body;
                if other != NIL && !islands.body_seen[other as usize] && !self.bodies.at(other).quarantined {
                    islands.body_seen[other as usize] = true;
                    self.bodies.at_mut(other).enabled = true;
                    self.roll.call(other);
                    islands.stack.push(other);
                }
            }
        }
        islands.ends.push((islands.bodies.len(), islands.joints.len()));
    }

    /// Whether one of a joint's bodies can be moved by forces.
    pub(crate) fn moves_a_body(&self, joint: &crate::joint::Joint) -> bool {
        joint.nodes.iter().any(|node| {
            node.body != NIL && {
                let body = self.bodies.at(node.body);
                body.inv_mass > 0.0 && !body.quarantined
            }
        })
    }
}
