//! What searches of trees look for: boxes that a ray, a moving box or a growing ball meets.

use super::f32_box::{Box32, Pending, down};
use super::pair_nodes::PairNode;
use super::wide::{Entry, Four};
use ferrode_math::{Aabb, Vec3};

/// More than the rounding of a difference, a reciprocal and a product.
const SLACK: f64 = 8.0 * f64::EPSILON;

/// Something that meets boxes sooner or later. Where it meets them is measured along the ray or path, in its lengths, or
/// from the box, in metres.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    kind: Kind,
    origin: [f64; 3],
    direction: [f64; 3],
    /// Of the direction.
    inverse: [f64; 3],
    half: [f64; 3],
    /// Some component of the direction is zero.
    flat: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Ray,
    Sweep,
    Near,
}

impl Probe {
    /// A ray. The direction need not be a unit vector.
    #[inline]
    pub fn ray(origin: Vec3, direction: Vec3) -> Self {
        let inverse = [1.0 / direction.x, 1.0 / direction.y, 1.0 / direction.z];
        Self {
            kind: Kind::Ray,
            origin: origin.to_array(),
            direction: direction.to_array(),
            inverse,
            half: [0.0; 3],
            // What is not finite makes this NaN.
            flat: !(inverse[0] * 0.0 + inverse[1] * 0.0 + inverse[2] * 0.0 == 0.0),
        }
    }

    /// A bounded box that moves along `path`.
    pub fn sweep(aabb: &Aabb, path: Vec3) -> Self {
        let half = aabb.extent() * 0.5;
        // Against the rounding of centre and half.
        let slack = 4.0 * f64::EPSILON * aabb.min.abs_max().max(aabb.max.abs_max());
        Self {
            kind: Kind::Sweep,
            half: (half + Vec3::splat(slack)).to_array(),
            ..Self::ray(aabb.center(), path)
        }
    }

    /// What is near a bounded box: met at its distance.
    pub fn near(aabb: &Aabb) -> Self {
        Self { kind: Kind::Near, ..Self::sweep(aabb, Vec3::ZERO) }
    }

    /// Where the box is met, not before zero; `None` if it is not or beyond `limit`. Errs on the side of meeting.
    #[inline(always)]
    pub fn enter_bounds(&self, min: [f64; 3], max: [f64; 3], limit: f64) -> Option<f64> {
        match self.kind {
            Kind::Ray => self.cross(min, max, limit),
            Kind::Sweep => {
                let (mut min, mut max) = (min, max);
                for i in 0..3 {
                    min[i] -= self.half[i];
                    max[i] += self.half[i];
                }
                self.cross(min, max, limit)
            }
            Kind::Near => {
                let mut square = 0.0;
                for i in 0..3 {
                    let (lo, hi) = (self.origin[i] - self.half[i], self.origin[i] + self.half[i]);
                    let gap = (min[i] - hi).max(lo - max[i]).max(0.0);
                    square += gap * gap;
                }
                let distance = square.sqrt() * (1.0 - SLACK);
                (distance <= limit).then_some(distance)
            }
        }
    }

    #[inline(always)]
    fn cross(&self, min: [f64; 3], max: [f64; 3], limit: f64) -> Option<f64> {
        let (mut lo, mut hi) = (0.0f64, limit);
        for i in 0..3 {
            let (o, inverse) = (self.origin[i], self.inverse[i]);
            // Along no axis at all: the products below would not be numbers.
            if self.flat && !inverse.is_finite() {
                if o < min[i] || o > max[i] {
                    return None;
                }
                continue;
            }
            let (s, t) = ((min[i] - o) * inverse, (max[i] - o) * inverse);
            let (near, far) = (lesser(s, t), greater(s, t));
            lo = greater(near, lo);
            hi = lesser(far, hi);
        }
        (lo <= hi + SLACK * (lo.abs() + hi.abs())).then_some(lo)
    }

    /// As [`enter_bounds`](Self::enter_bounds).
    #[inline]
    pub fn enter_aabb(&self, b: &Aabb, limit: f64) -> Option<f64> {
        self.enter_bounds(b.min.to_array(), b.max.to_array(), limit)
    }

    /// As [`enter_bounds`](Self::enter_bounds) for two boxes at once: whether each is met, and where, rounded down.
    #[inline(always)]
    pub(crate) fn enter_pair(&self, pair: &PairNode, limit: f64) -> ([bool; 2], [f32; 2]) {
        let at = [0, 1].map(|l| {
            let b = pair.bounds(l);
            self.enter(&b, limit)
        });
        (at.map(|x| x.is_some()), at.map(|x| down(x.unwrap_or(0.0))))
    }

    /// As [`enter_bounds`](Self::enter_bounds) for four boxes.
    #[inline(always)]
    pub(crate) fn enter_four(&self, four: &Four, limit: f64) -> [Entry; 4] {
        [0, 1, 2, 3].map(|l| {
            let at = if four.is_vacant(l) { None } else { self.enter(&four.bounds(l), limit) };
            at.map_or(Entry::MISSED, |at| Entry::new(down(at), l))
        })
    }

    /// The ray or path for boxes in single precision within `all`; `None` if this is neither, or single precision is too
    /// little for it.
    #[inline]
    pub(crate) fn lanes(&self, all: &Box32) -> Option<RayLanes> {
        if self.kind == Kind::Near {
            return None;
        }
        let mut lanes = RayLanes { origin: [[0.0; 4]; 3], inverse: [[0.0; 4]; 3], near: [0; 3] };
        for i in 0..3 {
            // Across an axis the ray is taken to go along it by next to nothing.
            let inverse = self.inverse[i].clamp(-STEEPEST, STEEPEST);
            let sign = if inverse < 0.0 { -1.0 } else { 1.0 };
            // Rounding of the origin and of differences from it, as a length.
            let reach = self.origin[i].abs() + f64::from(all.min[i].abs().max(all.max[i].abs()));
            // A box that moves is a ray among boxes that are larger by it.
            let pad = (self.half[i] + (reach + self.half[i]) * ROUNDING) * sign;
            let (near, far) = ((self.origin[i] + pad) as f32, (self.origin[i] - pad) as f32);
            let inverse = inverse as f32;
            lanes.origin[i] = [near, near, far, far];
            lanes.inverse[i] = [inverse, inverse, -inverse, -inverse];
            lanes.near[i] = usize::from(sign < 0.0);
            if !(near.is_finite() && far.is_finite() && inverse.is_finite() && inverse != 0.0) {
                return None;
            }
        }
        Some(lanes)
    }

    /// The ray or path for a packed tree within `all`; `None` if this is neither, or one that single precision is too little
    /// for.
    #[inline]
    pub(crate) fn bundle(&self, all: &Box32) -> Option<Bundle> {
        if self.kind == Kind::Near {
            return None;
        }
        let mut bundle = Bundle { origin: [[0.0; 2]; 3], inverse: [0.0; 3], near: [0; 3], line: None };
        let (mut fits, mut farthest, mut square) = (true, 0.0, 0.0);
        for i in 0..3 {
            // Across an axis the ray is taken to go along it by next to nothing. What is not a number stays so.
            let inverse = greater(-STEEPEST, lesser(STEEPEST, self.inverse[i]));
            let most = greater(f64::from(all.max[i]), -f64::from(all.min[i]));
            let reach = self.origin[i].abs() + most + self.half[i];
            // A box that moves is a ray among boxes that are larger by it. All that is rounded on the way to where a side is met
            // (the origin, the difference from it, the reciprocal, two products and a sum) is so by a part of its size, and the
            // sizes are `reach` or twice that times the reciprocal: as a length, less than 16 times 2⁻²⁴ of it.
            let pad = (self.half[i] + reach * (4.0 * ROUNDING)).copysign(inverse);
            bundle.origin[i] = [(self.origin[i] + pad) as f32, (self.origin[i] - pad) as f32];
            bundle.inverse[i] = inverse as f32;
            bundle.near[i] = usize::from(inverse < 0.0);
            fits &= (reach <= Bundle::REACH) & (inverse.abs() >= Bundle::FLATTEST);
            farthest = greater(reach, farthest);
            square += self.direction[i] * self.direction[i];
        }
        if (self.kind == Kind::Ray) & ((square - 1.0).abs() < 1e-6) {
            bundle.line = Some(Line {
                origin: [self.origin[0] as f32, self.origin[1] as f32, self.origin[2] as f32],
                direction: [self.direction[0] as f32, self.direction[1] as f32, self.direction[2] as f32],
                pad: (farthest * Line::ROUNDING) as f32 + f32::MIN_POSITIVE,
            });
        }
        fits.then_some(bundle)
    }

    #[inline(always)]
    pub(crate) fn enter(&self, b: &Box32, limit: f64) -> Option<f64> {
        self.enter_bounds(b.min.map(f64::from), b.max.map(f64::from), limit)
    }
}

// One instruction each, unlike `f64::min` and `f64::max`, which look out for NaN.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// More than the relative rounding of a few operations in single precision.
const ROUNDING: f64 = 1.0 / (1u64 << 21) as f64;
/// What is left is multiplied by it.
const WIDER: f32 = 1.0 + 4.0 * ROUNDING as f32;
/// The largest reciprocal of a ray's direction in single precision: differences of coordinates times it stay finite.
const STEEPEST: f64 = 1e28;

/// A ray against two or four boxes at once, in single precision. Errs on the side of meeting.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayLanes {
    /// Two lanes for where boxes are entered, two for where they are left, of which everything has the other sign.
    origin: [[f32; 4]; 3],
    inverse: [[f32; 4]; 3],
    /// Along each axis the side that the ray meets first.
    near: [usize; 3],
}

impl RayLanes {
    /// Whether each is met within `limit`, and where, rounded down.
    #[inline(always)]
    pub fn enter_pair(&self, pair: &PairNode, limit: f32) -> ([bool; 2], [f32; 2]) {
        let mut at = [0.0, 0.0, -limit, -limit];
        for i in 0..3 {
            let sides = &pair.sides[i];
            let (near, far) = (sides[self.near[i] & 1], sides[(self.near[i] & 1) ^ 1]);
            let planes = [near[0], near[1], far[0], far[1]];
            for l in 0..4 {
                let x = (planes[l] - self.origin[i][l]) * self.inverse[i][l];
                at[l] = if x > at[l] { x } else { at[l] };
            }
        }
        // Neither entry is negative.
        let met = [0, 1].map(|l| at[l] <= -at[l + 2] * WIDER);
        (met, [at[0] * (2.0 - WIDER), at[1] * (2.0 - WIDER)])
    }

    /// As [`enter_pair`](Self::enter_pair) for four.
    #[inline(always)]
    pub fn enter_four(&self, four: &Four, limit: f32) -> [Entry; 4] {
        let (mut enter, mut leave) = ([0.0f32; 4], [limit; 4]);
        for i in 0..3 {
            let (sides, side) = (&four.sides[i], self.near[i] & 1);
            let (near, far) = (&sides[side], &sides[side ^ 1]);
            let (from, to, inverse) = (self.origin[i][0], self.origin[i][2], self.inverse[i][0]);
            for l in 0..4 {
                let (x, y) = ((near[l] - from) * inverse, (far[l] - to) * inverse);
                enter[l] = if x > enter[l] { x } else { enter[l] };
                leave[l] = if y < leave[l] { y } else { leave[l] };
            }
        }
        [0, 1, 2, 3].map(|l| {
            // No entry is negative.
            let met = enter[l] <= leave[l] * WIDER;
            if met { Entry::new(enter[l] * (2.0 - WIDER), l) } else { Entry::MISSED }
        })
    }

    /// A limit in single precision, not below the one given.
    #[inline(always)]
    pub fn limit(limit: f64) -> f32 {
        (limit * (1.0 + ROUNDING)) as f32
    }
}

/// A ray or path for nodes of a packed tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bundle {
    /// By axis: for where boxes are entered, and for where they are left.
    pub origin: [[f32; 2]; 3],
    pub inverse: [f32; 3],
    /// Along each axis the side that the ray meets first.
    pub near: [usize; 3],
    /// Of a ray of unit direction the line that it is on.
    pub line: Option<Line>,
}

/// A line for boxes that are turned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub origin: [f32; 3],
    pub direction: [f32; 3],
    /// How far from a box, times the sine of an angle, the line may seem to be for rounding.
    pub pad: f32,
}

impl Line {
    /// Of the largest coordinate in sight. Of single precision's 2⁻²⁴ there are less than 80 in differences of coordinates,
    /// three products with axes each, and two products of the results.
    const ROUNDING: f64 = 1.0 / (1u64 << 16) as f64;
}

impl Bundle {
    /// Largest coordinate: times the steepest reciprocal it is a number.
    const REACH: f64 = 1e8;
    /// Least reciprocal: times the step of a node it is more than nothing.
    const FLATTEST: f64 = 1e-12;
    /// A limit in single precision, not below the one given.
    #[inline(always)]
    pub fn limit(limit: f64) -> f32 {
        RayLanes::limit(limit)
    }
}

/// Of the children `c` and `c + 1`, and where they are met: the one to go on with; the other has to wait.
#[inline(always)]
pub(crate) fn nearer(
    c: u32,
    (met, at): ([bool; 2], [f32; 2]),
    pending: &mut Pending<(u32, f32)>,
) -> Option<u32> {
    match met {
        [true, true] => {
            let second = u32::from(at[1] < at[0]);
            pending.push((c + (second ^ 1), at[(second ^ 1) as usize]));
            Some(c + second)
        }
        [true, false] => Some(c),
        [false, true] => Some(c + 1),
        [false, false] => None,
    }
}
