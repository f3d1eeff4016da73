//! A node of a packed tree: seven boxes in a cache line.

use crate::space::f32_box::Box32;
use crate::space::leaf_box::LeafBox;
use crate::space::probe::Bundle;
use ferrode_math::simd::Octet;

/// Seven boxes in bytes, side by side, in a cache line: wide nodes with quantised boxes (Ylitie, Karras and Laine, *Efficient
/// incoherent ray traversal on GPUs through compressed wide BVHs*, 2017). A side that reads `q` lies at
/// `origin + q · 2^exponent` of its axis, never further in than the side that it stands for.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Seven {
    /// Along each axis the lower sides of the seven, then the upper ones. In place of an eighth: of the lower sides the exponent,
    /// with a sign, of the upper ones what `INNER` and `USED` say.
    pub(super) sides: [[[u8; 8]; 2]; 3],
    pub(super) origin: [f32; 3],
    /// The first of the nodes in it, which follow one another: what the first lanes hold. The others hold leaves.
    pub(super) child: u32,
}

const _: () = assert!(size_of::<Seven>() == 64);

/// Along which axis the last upper side is the number of nodes within.
const INNER: usize = 0;
/// Along which axis the last upper side has a bit for each lane that holds anything.
const USED: usize = 1;

/// Boxes to a node.
pub(super) const LANES: usize = 7;
/// Lowest exponent: what is smaller is as good as a point.
const FINEST: i32 = -60;
/// Highest; boxes that need more are beyond what rays are searched for here.
const COARSEST: i32 = 100;

impl Seven {
    pub(super) const VACANT: Self = Self { sides: [[[0; 8]; 2]; 3], origin: [0.0; 3], child: 0 };

    /// The power of two that is the step between sides along an axis.
    #[cfg(test)]
    pub(super) fn exponent(&self, axis: usize) -> i32 {
        i32::from(self.sides[axis][0][7].cast_signed())
    }

    /// The lower sides of an axis from the fourth on, and in the highest byte the exponent.
    #[inline(always)]
    fn exponent_word(&self, axis: usize) -> u32 {
        let [_, _, _, _, a, b, c, exponent] = self.sides[axis][0];
        u32::from_le_bytes([a, b, c, exponent])
    }

    /// How many of the first lanes hold nodes.
    #[inline(always)]
    pub(super) fn inner(&self) -> u8 {
        self.sides[INNER][1][7]
    }

    /// A bit for each lane that holds anything.
    #[inline(always)]
    pub(super) fn used(&self) -> u8 {
        self.sides[USED][1][7]
    }

    /// Boxes of which the first `inner` are of nodes, which begin at `child`.
    pub(super) fn new<'a>(
        boxes: impl ExactSizeIterator<Item = &'a Box32> + Clone,
        inner: u8,
        child: u32,
    ) -> Self {
        let mut seven = Self { child, ..Self::VACANT };
        let all = boxes.clone().fold(Box32::EMPTY, |all, b| all.union(b));
        let used = ((1u32 << boxes.len()) - 1) as u8;
        for axis in 0..3 {
            let origin = f64::from(all.min[axis]);
            let extent = f64::from(all.max[axis]) - origin;
            // Of the power of two below a 255th.
            let mut exponent = (((extent / 255.0).to_bits() >> 52) as i32 - 1023).clamp(FINEST, COARSEST);
            while 255.0 * power_of_two(exponent) < extent && exponent < COARSEST {
                exponent += 1;
            }
            let step = power_of_two(exponent);
            let [low, high] = &mut seven.sides[axis];
            for (l, b) in boxes.clone().enumerate() {
                // Within 0 and 255 but for rounding.
                low[l] = ((f64::from(b.min[axis]) - origin) / step).floor() as u8;
                high[l] = ((f64::from(b.max[axis]) - origin) / step).ceil() as u8;
            }
            low[7] = (exponent as i8).cast_unsigned();
            seven.origin[axis] = all.min[axis];
        }
        seven.sides[INNER][1][7] = inner;
        seven.sides[USED][1][7] = used;
        seven
    }

    /// What a bundle enters within the limit, as a bit a lane, and where, not after it does.
    #[inline(always)]
    pub(super) fn enter<O: Octet>(&self, spread: &Spread<O>, limit: f32) -> (u8, O) {
        let [x, y, z] = &spread.axes;
        let (x, y, z) = (self.cross(0, x), self.cross(1, y), self.cross(2, z));
        let enter = x.0.max(O::splat(0.0)).max(y.0.max(z.0));
        let leave = x.1.min(O::splat(limit)).min(y.1.min(z.1));
        (enter.le(leave) & self.used(), enter)
    }

    /// Where the slab between the sides of an axis is entered and left.
    #[inline(always)]
    fn cross<O: Octet>(&self, i: usize, axis: &SpreadAxis<O>) -> (O, O) {
        let sides = &self.sides[i];
        let origin = O::splat(self.origin[i]);
        let step = axis.inverse.scale(self.exponent_word(i));
        let near = (origin - axis.near) * axis.inverse;
        let far = (origin - axis.far) * axis.inverse;
        let enter = O::from_bytes(&sides[axis.side & 1]) * step + near;
        let leave = O::from_bytes(&sides[(axis.side & 1) ^ 1]) * step + far;
        (enter, leave)
    }
}

/// A bundle in all lanes.
pub(super) struct Spread<O> {
    axes: [SpreadAxis<O>; 3],
}

struct SpreadAxis<O> {
    near: O,
    far: O,
    inverse: O,
    /// The side that is met first.
    side: usize,
}

impl<O: Octet> Spread<O> {
    #[inline(always)]
    pub(super) fn new(bundle: &Bundle) -> Self {
        Self { axes: [Self::axis(bundle, 0), Self::axis(bundle, 1), Self::axis(bundle, 2)] }
    }

    #[inline(always)]
    fn axis(bundle: &Bundle, i: usize) -> SpreadAxis<O> {
        let [near, far] = bundle.origin[i];
        SpreadAxis {
            near: O::splat(near),
            far: O::splat(far),
            inverse: O::splat(bundle.inverse[i]),
            side: bundle.near[i] & 1,
        }
    }
}

impl Seven {
    /// A leaf in place of a node.
    pub(super) fn leaf(leaf: &LeafBox) -> Self {
        let mut cell = Self { origin: leaf.center, child: leaf.payload, ..Self::VACANT };
        for (k, x) in leaf.axes.iter().chain([&leaf.half]).flatten().enumerate() {
            cell.sides[k / 4][k / 2 % 2][k % 2 * 4..][..4].copy_from_slice(&x.to_ne_bytes());
        }
        cell
    }

    /// What [`leaf`](Self::leaf) was made of.
    #[inline(always)]
    pub(super) fn as_leaf(&self) -> LeafBox {
        let number = |k: usize| {
            let [a, b, c, d, e, f, g, h] = self.sides[k / 4][k / 2 % 2];
            f32::from_ne_bytes(if k.is_multiple_of(2) { [a, b, c, d] } else { [e, f, g, h] })
        };
        let three = |k: usize| [number(k), number(k + 1), number(k + 2)];
        LeafBox {
            axes: [three(0), three(3), three(6)],
            half: three(9),
            center: self.origin,
            payload: self.child,
        }
    }
}

/// 2 to the power of what an exponent of single precision can be.
pub(super) fn power_of_two(exponent: i32) -> f64 {
    f64::from(f32::from_bits(((exponent + 127) as u32) << 23))
}
