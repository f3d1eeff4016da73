//! Which bodies moved far in the last step, for continuous collision.

use crate::World;
use crate::body::BodyKey;

impl World {
    /// The bodies whose centres moved by more than `distance` metres in the last step of `Substep`, in the order in which they are
    /// stepped.
    pub fn moved_far(&self, distance: f64) -> impl Iterator<Item = BodyKey> + '_ {
        let bodies = &self.scratch.substep.bodies;
        let limit = (distance * distance) as f32;
        bodies.slots.iter().zip(bodies.deltas.iter().zip(&bodies.scales)).filter_map(
            move |(slot, (delta, scale))| {
                let ([x, y, z, ..], [s, ..]) = (delta.0, scale.0);
                let far = (x * x + y * y + z * z) * (s * s) > limit;
                (far && self.bodies.get(*slot).is_some()).then(|| self.body_key(*slot))
            },
        )
    }
}
