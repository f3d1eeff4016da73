//! From all points of a touching patch to the four that are kept.

use super::{FAR, MANIFOLD_POINTS, Manifold, ManifoldPoint, single};
use crate::Frame;
use ferrode_math::Vec3;

/// Most points of a patch; then the best four stay, and there is room again.
const MOST: usize = 16;
/// Depths that differ by less, in parts of the patch's size, are one: at rest rounding must not choose.
const SAME_DEPTH: f64 = 1e-5;
/// How much better a new point must be than one that was there a step before.
const STAY: f64 = 1.2;

/// A point of a patch, in the patch's coordinates.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spot {
    pub a: Vec3,
    pub b: Vec3,
    pub depth: f64,
    pub feature: u32,
}

/// Points with one normal.
#[derive(Debug)]
pub(super) struct Patch {
    /// Unit, into A, in the patch's coordinates.
    pub normal: Vec3,
    /// Whether the normal belongs to A.
    pub normal_of_a: bool,
    pub parts: (i32, i32),
    /// Where the two geoms are in the patch's coordinates.
    pub frames: (Frame, Frame),
    /// From the patch's coordinates to the world's.
    pub world: Frame,
    spots: [Spot; MOST],
    count: usize,
}

impl Patch {
    pub fn new() -> Self {
        Self {
            normal: Vec3::Z,
            normal_of_a: false,
            parts: (-1, -1),
            frames: (Frame::IDENTITY, Frame::IDENTITY),
            world: Frame::IDENTITY,
            spots: [Spot::default(); MOST],
            count: 0,
        }
    }

    pub fn spots(&self) -> &[Spot] {
        &self.spots[..self.count]
    }

    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds a point.
    #[inline]
    pub fn push(&mut self, spot: Spot) {
        if self.count == MOST {
            let (chosen, count) = choose(self.spots(), self.normal, |_| false);
            let kept = chosen.map(|i| self.spots[i]);
            self.spots[..count].copy_from_slice(&kept[..count]);
            self.count = count;
        }
        self.spots[self.count] = spot;
        self.count += 1;
    }

    /// The greatest depth so far.
    pub fn depth(&self) -> f64 {
        self.spots().iter().fold(f64::NEG_INFINITY, |d, s| d.max(s.depth))
    }

    /// Overwrites `out`, whose points hand on their impulses.
    pub fn write(&self, out: &mut Manifold) {
        let old = *out;
        let (chosen, count) =
            choose(self.spots(), self.normal, |f| old.points().iter().any(|p| p.feature == f));
        let local = if self.normal_of_a { &self.frames.0 } else { &self.frames.1 };
        *out = Manifold {
            origin_b: Vec3::ZERO,
            normal: single(self.world.vector_to_world(self.normal)),
            local_normal: single(local.vector_to_local(self.normal)),
            part_a: self.parts.0,
            part_b: self.parts.1,
            points: [ManifoldPoint::default(); MANIFOLD_POINTS],
            count: count as u8,
            normal_of_a: self.normal_of_a,
            twist: [0.0; 3],
        };
        let first = self.frames.1.point_to_local(self.spots[chosen[0]].b);
        if first.abs_max() > f64::from(FAR) {
            out.origin_b = first;
        }
        let mut size = 0.0f64;
        for (p, &i) in out.points.iter_mut().zip(&chosen[..count]) {
            let s = &self.spots[i];
            *p = ManifoldPoint {
                anchor_a: single(self.frames.0.point_to_local(s.a)),
                anchor_b: single(self.frames.1.point_to_local(s.b) - out.origin_b),
                depth: s.depth as f32,
                feature: s.feature,
                impulse: [0.0; 3],
            };
            size = size.max((s.a - self.spots[chosen[0]].a).abs_max());
        }
        let reach = if size > 0.0 { 0.25 * size } else { 0.5 * f64::from(out.points[0].anchor_a.length()) };
        if old.count > 0 {
            out.inherit(&old, reach as f32);
        }
    }
}

/// The deepest point, the one furthest from it, and the two that widen the polygon most, on either side. Of points that
/// are nearly as good those that were there before stay.
#[inline(never)]
fn choose(
    spots: &[Spot],
    normal: Vec3,
    was_there: impl Fn(u32) -> bool,
) -> ([usize; MANIFOLD_POINTS], usize) {
    let mut chosen = [0; MANIFOLD_POINTS];
    if spots.len() == 1 {
        return (chosen, 1);
    }
    let mut known = [1.0; MOST];
    let mut deepest = f64::NEG_INFINITY;
    let (mut low, mut high) = (spots[0].a, spots[0].a);
    for (k, s) in known.iter_mut().zip(spots) {
        if spots.len() > MANIFOLD_POINTS && was_there(s.feature) {
            *k = STAY;
        }
        deepest = deepest.max(s.depth);
        low = low.min(s.a);
        high = high.max(s.a);
    }
    let size = (high - low).abs_max();
    // A known one among equals.
    let as_deep = |i: usize| spots[i].depth >= deepest - SAME_DEPTH * size;
    let first = best(spots.len(), |i| if as_deep(i) { known[i] } else { f64::NEG_INFINITY }).0;
    chosen[0] = first;
    if spots.len() <= MANIFOLD_POINTS {
        for (i, slot) in chosen.iter_mut().enumerate() {
            *slot = i;
        }
        chosen.swap(0, first);
        return (chosen, spots.len());
    }
    let at = |i: usize| spots[i].a;
    let second = best(spots.len(), |i| (at(i) - at(first)).length_squared() * known[i]).0;
    chosen[1] = second;
    let along = at(second) - at(first);
    let area = |i: usize| along.cross(at(i) - at(first)).dot(normal);
    let enough = 1e-6 * along.length_squared();
    let mut count = 2;
    for side in [1.0, -1.0] {
        let (i, size) = best(spots.len(), |i| side * area(i) * known[i]);
        if size > enough && !chosen[..count].contains(&i) {
            chosen[count] = i;
            count += 1;
        }
    }
    (chosen, count)
}

/// The number below `count` with the greatest measure, and that.
#[inline(always)]
fn best(count: usize, measure: impl Fn(usize) -> f64) -> (usize, f64) {
    let mut best = (0, f64::NEG_INFINITY);
    for i in 0..count {
        let m = measure(i);
        if m > best.1 {
            best = (i, m);
        }
    }
    best
}
