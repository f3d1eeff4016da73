//! Points of many triangles, gathered and grouped by normal.

use super::patch::{Patch, Spot};
use crate::GeomContact;
use ferrode_math::Vec3;

/// Cosine of the angle up to which two normals are one: about five degrees.
const ONE_NORMAL: f64 = 0.996;

/// A point of some triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub spot: Spot,
    pub normal: Vec3,
    pub parts: (i32, i32),
}

/// Memory that searches of concave pairs need while they run; kept between them so that nothing is allocated.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    pub(super) list: Vec<Candidate>,
    pub(super) contacts: Vec<GeomContact>,
}

/// Calls `found` with patches of one normal each, the deepest first; `patch` brings the frames. Points nearer to each
/// other than `near` are one.
pub(super) fn group(list: &mut [Candidate], near: f64, patch: &mut Patch, mut found: impl FnMut(&Patch)) {
    let mut rest = list;
    while !rest.is_empty() {
        let deepest =
            (0..rest.len()).fold(0, |k, i| if rest[i].spot.depth > rest[k].spot.depth { i } else { k });
        let normal = rest[deepest].normal;
        rest.swap(0, deepest);
        let mut count = 1;
        for i in 1..rest.len() {
            if rest[i].normal.dot(normal) > ONE_NORMAL {
                rest.swap(i, count);
                count += 1;
            }
        }
        let (group, others) = rest.split_at_mut(count);
        patch.clear();
        patch.normal = normal;
        patch.normal_of_a = false;
        patch.parts = group[0].parts;
        for c in group.iter() {
            let twin = patch.spots().iter().any(|s| (s.a - c.spot.a).length_squared() < near * near);
            if twin {
                continue;
            }
            let mut spot = c.spot;
            // Its depth along the one normal.
            spot.depth = normal.dot(spot.b - spot.a);
            patch.push(spot);
        }
        found(patch);
        rest = others;
    }
}
