//! Which pairs may collide at all.

use crate::space::Proxy;

/// All bits: collides with everything that has any bit set.
pub const ALL_BITS: u64 = u64::MAX;

/// The pair rule of ODE's spaces, boxes aside: not the same body, and one geom's category among the other's collide
/// bits. One direction is enough.
#[inline]
pub fn may_collide(a: &Proxy, b: &Proxy) -> bool {
    (a.category_bits & b.collide_bits != 0 || b.category_bits & a.collide_bits != 0)
        && !(a.body.is_some() && a.body == b.body)
}

/// The whole rule: [`may_collide`], and the boxes share a point.
#[inline]
pub fn passes(a: &Proxy, b: &Proxy) -> bool {
    may_collide(a, b) && a.aabb.overlaps(&b.aabb)
}
