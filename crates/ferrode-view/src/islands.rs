//! Which bodies are connected, for colours.

use ferrode::{BodyKey, World};
use std::collections::BTreeMap;

/// The island of each body that can move, numbered from 0: bodies that joints, or contacts of the last step, connect through
/// others that can move.
pub fn islands(world: &World) -> BTreeMap<BodyKey, usize> {
    let movable =
        |key: BodyKey| world.body(key).is_ok_and(|body| !body.is_kinematic() && !body.is_quarantined());
    let keys: Vec<BodyKey> = world.bodies().map(|(key, _)| key).filter(|key| movable(*key)).collect();
    let place: BTreeMap<BodyKey, usize> = keys.iter().enumerate().map(|(n, key)| (*key, n)).collect();
    // Union-find with halving paths (Tarjan and van Leeuwen, 1984).
    let mut parent: Vec<usize> = (0..keys.len()).collect();
    let find = |parent: &mut Vec<usize>, mut n: usize| {
        while parent[n] != n {
            parent[n] = parent[parent[n]];
            n = parent[n];
        }
        n
    };
    let joints = world.joints().filter_map(|joint| world.joint_bodies(joint).ok());
    let contacts = world.contacts().iter().map(|contact| [contact.first.body, contact.second.body]);
    for pair in joints.chain(contacts) {
        let [Some(a), Some(b)] = pair.map(|key| key.and_then(|key| place.get(&key).copied())) else {
            continue;
        };
        let (a, b) = (find(&mut parent, a), find(&mut parent, b));
        parent[a.max(b)] = a.min(b);
    }
    let mut numbers = BTreeMap::new();
    let mut island = |root: usize| {
        let next = numbers.len();
        *numbers.entry(root).or_insert(next)
    };
    keys.iter().enumerate().map(|(n, key)| (*key, island(find(&mut parent, n)))).collect()
}

#[cfg(test)]
mod tests {
    use super::islands;
    use ferrode::prelude::*;

    #[test]
    fn contacts_and_joints_connect_but_the_ground_does_not() -> Result<(), Error> {
        let mut world = World::new();
        world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
        world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
        let mut add = |x: f64, z: f64| {
            let cube = BodyBuilder::new().at(Vec3::new(x, 0.0, z));
            world.add_body(cube.with_shape(Cuboid::new(Vec3::splat(1.0))?, 100.0))
        };
        let (low, high, alone, tied) = (add(0.0, 0.5)?, add(0.0, 1.5)?, add(3.0, 0.5)?, add(6.0, 0.5)?);
        world.add_ball(Some(alone), Some(tied), Vec3::new(4.5, 0.0, 0.5))?;
        world.step(0.01)?;
        let islands = islands(&world);
        assert_eq!(islands[&low], islands[&high]);
        assert_eq!(islands[&alone], islands[&tied]);
        assert_ne!(islands[&low], islands[&alone]);
        Ok(())
    }
}
