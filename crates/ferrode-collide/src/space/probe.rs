//! What searches of trees look for: boxes that a ray, a moving box or a growing ball meets.

use super::f32_box::{Box32, Pending, down};
use super::pair_nodes::PairNode;
use ferrode_math::{Aabb, Vec3};

/// More than the rounding of a difference, a reciprocal and a product.
const SLACK: f64 = 8.0 * f64::EPSILON;

/// Something that meets boxes sooner or later. Where it meets them is measured along the ray or path, in its lengths, or
/// from the box, in metres.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    kind: Kind,
    origin: [f64; 3],
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
    pub fn ray(origin: Vec3, direction: Vec3) -> Self {
        Self {
            kind: Kind::Ray,
            origin: origin.to_array(),
            inverse: direction.to_array().map(|x| 1.0 / x),
            half: [0.0; 3],
            flat: direction.to_array().iter().any(|x| !(1.0 / x).is_finite()),
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

    /// As [`enter_bounds`](Self::enter_bounds) for two boxes at once: where each is met, if it is.
    #[inline(always)]
    pub(crate) fn enter_pair(&self, pair: &PairNode, limit: f64) -> [Option<f64>; 2] {
        if self.kind != Kind::Ray || self.flat {
            return [0, 1].map(|l| {
                let min = [0, 1, 2].map(|i| f64::from(pair.min[i][l]));
                let max = [0, 1, 2].map(|i| f64::from(pair.max[i][l]));
                self.enter_bounds(min, max, limit)
            });
        }
        let (mut lo, mut hi) = ([0.0f64; 2], [limit; 2]);
        for i in 0..3 {
            let (o, inverse) = (self.origin[i], self.inverse[i]);
            for l in 0..2 {
                let s = (f64::from(pair.min[i][l]) - o) * inverse;
                let t = (f64::from(pair.max[i][l]) - o) * inverse;
                lo[l] = greater(lesser(s, t), lo[l]);
                hi[l] = lesser(greater(s, t), hi[l]);
            }
        }
        // Neither is negative unless the limit is.
        let met = |l: usize| (lo[l] <= hi[l] + SLACK * (lo[l] + hi[l])).then_some(lo[l]);
        [met(0), met(1)]
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

/// Of the children `c` and `c + 1`, and where they are met: the one to go on with; the other has to wait.
#[inline(always)]
pub(crate) fn nearer(c: u32, at: [Option<f64>; 2], pending: &mut Pending<(u32, f32)>) -> Option<u32> {
    match (at[0], at[1]) {
        (Some(a), Some(b)) => {
            let (near, far, at) = if b < a { (c + 1, c, a) } else { (c, c + 1, b) };
            pending.push((far, down(at)));
            Some(near)
        }
        (Some(_), None) => Some(c),
        (None, Some(_)) => Some(c + 1),
        (None, None) => None,
    }
}
