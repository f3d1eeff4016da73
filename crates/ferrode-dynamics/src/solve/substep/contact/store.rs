//! From rows back to manifolds.

use super::vector::{load3, store3};
use super::{Batches, Block3, ManifoldKey};
use crate::solve::substep::manifold::ContactManifold;
use core::any::Any;
use ferrode_math::Vector3;
use ferrode_math::simd::{Kernel, Lanes};

/// Impulses along two tangents, as vectors of the world.
#[inline(always)]
fn along<L: Lanes>(tangents: [Vector3<L>; 2], impulses: [L::Block; 2]) -> Block3<L> {
    store3(tangents[0] * L::load(&impulses[0]) + tangents[1] * L::load(&impulses[1]))
}

/// Writes the impulses of all batches into their manifolds.
pub(super) struct Store<'a> {
    pub batches: &'a (dyn Any + Send + Sync),
    pub order: &'a [u32],
    pub keys: &'a [ManifoldKey],
    pub manifolds: &'a mut [ContactManifold],
}

impl Kernel for Store<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Some(batches) = self.batches.downcast_ref::<Batches<L>>() else { return };
        for (batch, span) in batches.list.iter().zip(&batches.spans) {
            let (n, t1) = (load3::<L>(&batch.normal), load3::<L>(&batch.tangent));
            let t2 = n.cross(t1);
            let [f1, f2, twist] = batch.friction.impulse;
            let friction = along::<L>([t1, t2], [f1, f2]);
            let extra = batch.extra.as_ref().filter(|_| batch.special);
            let mut rolling = None;
            if let Some(extra) = extra {
                rolling = Some(along::<L>([t1, t2], extra.rolling_impulse));
            }
            let places = &self.order[span.first as usize..span.end as usize];
            for (lane, key) in places.iter().enumerate() {
                let manifold = &mut self.manifolds[self.keys[*key as usize].place as usize];
                for (record, row) in manifold.points.iter_mut().zip(&batch.points[..batch.count as usize]) {
                    record.0[7] = row.impulse.as_ref()[lane];
                }
                manifold.head.0[3] = twist.as_ref()[lane];
                for k in 0..3 {
                    manifold.head.0[4 + k] = friction[k].as_ref()[lane];
                    if let Some(rolling) = &rolling {
                        manifold.tail.0[4 + k] = rolling[k].as_ref()[lane];
                    }
                }
            }
        }
    }
}
