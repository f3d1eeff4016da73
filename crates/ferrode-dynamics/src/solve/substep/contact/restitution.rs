//! Restitution: gives back part of the speed that points approached with.

use super::Batch;
use super::extra::Extra;
use super::sweep::Pair;
use super::vector::load3;
use ferrode_math::simd::Lanes;
use ferrode_math::stage::Touch;

/// Asks each point that pushed, and that had approached faster than its threshold, for the speed away v = −e v₀.
#[inline(always)]
pub(super) fn solve<L: Lanes>(batch: &mut Batch<L>, extra: &Extra<L>, touch: &Touch<'_, L>) {
    let mut pair = Pair::gather(batch, touch);
    let n = load3::<L>(&batch.normal);
    let bounce = L::load(&extra.bounce);
    let threshold = -L::load(&extra.bounce_velocity);
    let lift = L::load(&extra.lift);
    for (k, row) in batch.points[..batch.count as usize].iter_mut().enumerate() {
        let angular = [load3::<L>(&row.angular[0]), load3::<L>(&row.angular[1])];
        let approach = L::load(&extra.approach[k]);
        let bounces = approach.lt(threshold) & L::ZERO.lt(L::load(&extra.peak[k])) & L::ZERO.lt(bounce);
        let v = n.dot(pair.relative()) + pair.angular(&angular) + L::load(&extra.drift[k]) - lift;
        let old = L::load(&row.impulse);
        let wanted = old - L::load(&row.mass) * (v + bounce * approach);
        let new = L::select(bounces, wanted.max(L::ZERO), old);
        row.impulse = new.store();
        pair.push(n * (new - old));
        pair.turn(&angular, new - old);
    }
    pair.scatter(touch);
}
