//! Vectors of lanes.

use super::Block3;
use ferrode_math::simd::Lanes;
use ferrode_math::{Scalar, Vector3};

/// Loads a vector.
#[inline(always)]
pub(super) fn load3<L: Lanes>(b: &Block3<L>) -> Vector3<L> {
    Vector3::new(L::load(&b[0]), L::load(&b[1]), L::load(&b[2]))
}

/// Stores a vector.
#[inline(always)]
pub(super) fn store3<L: Lanes>(v: Vector3<L>) -> Block3<L> {
    [v.x.store(), v.y.store(), v.z.store()]
}

/// The numbers that `f` gives for each lane.
#[inline(always)]
pub(super) fn lanes<L: Lanes>(f: impl Fn(usize) -> f32) -> L {
    let mut block = L::Block::default();
    for (lane, x) in block.as_mut().iter_mut().enumerate() {
        *x = f(lane);
    }
    L::load(&block)
}

/// Linear and angular part of a velocity or displacement.
#[derive(Clone, Copy)]
pub(super) struct Motion<L> {
    pub linear: Vector3<L>,
    pub angular: Vector3<L>,
}

impl<L: Scalar> Motion<L> {
    #[inline(always)]
    pub fn from_record(r: [L; 8]) -> Self {
        Self { linear: Vector3::new(r[0], r[1], r[2]), angular: Vector3::new(r[3], r[4], r[5]) }
    }

    #[inline(always)]
    pub fn to_record(self) -> [L; 8] {
        let (v, w) = (self.linear, self.angular);
        [v.x, v.y, v.z, w.x, w.y, w.z, L::ZERO, L::ZERO]
    }
}

/// Sᵀ x of a lower triangular S by rows.
#[inline(always)]
pub(super) fn mul_lower_transpose<L: Scalar>(s: &[L; 8], x: Vector3<L>) -> Vector3<L> {
    // s[0] is the scale of the mass; S follows.
    Vector3::new(s[1] * x.x + s[2] * x.y + s[4] * x.z, s[3] * x.y + s[5] * x.z, s[6] * x.z)
}

/// Two vectors across a unit normal, by the rule of [`ferrode_math::plane_space`].
#[inline(always)]
pub(super) fn tangent<L: Lanes>(n: Vector3<L>) -> Vector3<L> {
    let steep = L::splat(0.5).lt(n.z * n.z);
    let yz = n.y * n.y + n.z * n.z;
    let xy = n.x * n.x + n.y * n.y;
    let length = L::select(steep, yz, xy).sqrt();
    // A zero normal, as of a lane without manifold, has no tangent.
    let k = L::select(L::ZERO.lt(length), L::ONE / length, L::ZERO);
    Vector3::new(
        L::select(steep, L::ZERO, -n.y * k),
        L::select(steep, -n.z * k, n.x * k),
        L::select(steep, n.y * k, L::ZERO),
    )
}
