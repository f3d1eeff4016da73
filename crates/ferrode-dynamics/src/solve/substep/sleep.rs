//! Sleep: islands of bodies that rest fall asleep as a whole, and wake as a whole.
//!
//! A body rests while twice its kinetic energy per mass, v² + ω·Iω/m, is below the square of the settings' speed. When all
//! bodies that touch, or that joints link, have rested for the settings' time, they are disabled together. Whatever
//! wakes one of them, by hand or by touching it, wakes all.

use super::Workspace;
use super::contact::NOT_SOLVED;
use crate::World;
use crate::arena::NIL;
use ferrode_math::Vec3;

/// Disjoint sets of bodies, for finding islands.
#[derive(Clone, Debug, Default)]
pub(super) struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    pub(super) fn begin(&mut self, count: usize) {
        self.parent.clear();
        self.parent.extend(0..count as u32);
    }

    pub(super) fn root(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            let above = self.parent[self.parent[x as usize] as usize];
            self.parent[x as usize] = above;
            x = above;
        }
        x
    }

    /// The smaller root stays one, so that the sets don't depend on the order of unions.
    pub(super) fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.parent[high as usize] = low;
    }
}

impl World {
    /// Counts how long each body has rested, and puts islands to sleep whose bodies all have for long enough.
    pub(super) fn put_islands_to_sleep(&mut self, h: f64, work: &mut Workspace) {
        let settings = self.params.substep;
        let limit = settings.sleep_speed * settings.sleep_speed;
        if limit == 0.0 {
            return;
        }
        let mut ready = false;
        for (place, slot) in work.bodies.slots.iter().enumerate() {
            let Some(body) = self.bodies.get_mut(*slot) else { continue };
            let quiet = if body.is_kinematic() {
                body.frame.linear_velocity == Vec3::ZERO && body.frame.angular_velocity == Vec3::ZERO
            } else {
                !work.bodies.pushed[place] && f64::from(work.bodies.energy_per_mass(place)) < limit
            };
            body.rest_time = if quiet { body.rest_time + h } else { 0.0 };
            ready |= body.rest_time >= settings.sleep_time && !body.is_kinematic();
        }
        if !ready {
            return;
        }
        let Workspace { bodies, contacts, joints, sets, restless, .. } = work;
        sets.begin(bodies.len());
        restless.clear();
        restless.resize(bodies.len(), false);
        // What a moving kinematic body touches does not rest, whatever it does itself.
        let mut link = |a: u32, b: u32| match (bodies.is_movable(a), bodies.is_movable(b)) {
            (true, true) => sets.unite(a, b),
            (true, false) | (false, true) => {
                let (movable, other) = if bodies.is_movable(a) { (a, b) } else { (b, a) };
                if other != NIL && bodies.motions[other as usize].0 != [0.0; 8] {
                    restless[movable as usize] = true;
                }
            }
            _ => {}
        };
        for key in contacts.keys.iter().filter(|key| key.sort != NOT_SOLVED) {
            link(key.bodies[0], key.bodies[1]);
        }
        for constraint in &joints.constraints {
            link(constraint.bodies[0], constraint.bodies[1]);
        }
        for (place, slot) in bodies.slots.iter().enumerate() {
            let rests = self.bodies.get(*slot).is_none_or(|body| body.rest_time >= settings.sleep_time);
            if bodies.is_movable(place as u32) && (!rests || restless[place]) {
                let root = sets.root(place as u32);
                restless[root as usize] = true;
            }
        }
        let first_group = self.sleep_groups;
        for (place, slot) in bodies.slots.iter().enumerate() {
            let root = sets.root(place as u32);
            if restless[root as usize] || !bodies.is_movable(place as u32) {
                continue;
            }
            let Some(body) = self.bodies.get_mut(*slot) else { continue };
            body.enabled = false;
            body.frame.linear_velocity = Vec3::ZERO;
            body.frame.angular_velocity = Vec3::ZERO;
            // Roots are unique within the step, groups within the world's life.
            body.sleep_group = first_group + 1 + u64::from(root);
        }
        self.sleep_groups = first_group + bodies.len() as u64;
    }

    /// Wakes a body, and notes its island as one to be woken.
    pub(super) fn rouse(&mut self, slot: u32, waking: &mut Vec<u64>) {
        self.roll.call(slot);
        let body = self.bodies.at_mut(slot);
        body.enable();
        body.rest_time = 0.0;
        if body.sleep_group != 0 {
            waking.push(body.sleep_group);
            body.sleep_group = 0;
        }
    }

    /// Wakes all bodies of the islands noted.
    pub(super) fn wake_islands(&mut self, waking: &mut Vec<u64>) {
        if waking.is_empty() {
            return;
        }
        waking.sort_unstable();
        waking.dedup();
        let mut index = self.body_list.first;
        while index != NIL {
            let body = self.bodies.at_mut(index);
            if body.sleep_group != 0 && waking.binary_search(&body.sleep_group).is_ok() {
                body.sleep_group = 0;
                body.enable();
                body.rest_time = 0.0;
                self.roll.call(index);
            }
            index = body.next;
        }
        waking.clear();
    }
}
