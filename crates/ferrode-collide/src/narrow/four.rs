//! Four numbers at once: arrays on which the same is done four times, which compilers turn into the machine's instructions.

use crate::TriMesh;
use crate::space::tree::AabbTree;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};
use ferrode_math::{Aabb, Scalar, Vec3, Vector3};

/// Four numbers, each for itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Four(pub [f64; 4]);

impl Four {
    #[inline(always)]
    fn with(self, b: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let (a, b) = (self.0, b.0);
        Self([f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2]), f(a[3], b[3])])
    }

    /// The same number four times.
    #[inline(always)]
    pub fn splat(x: f64) -> Self {
        Self([x; 4])
    }

    #[inline(always)]
    pub fn lesser(self, b: Self) -> Self {
        self.with(b, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    pub fn greater(self, b: Self) -> Self {
        self.with(b, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        self.with(self, |a, _| a.abs())
    }
}

/// The same vector four times.
#[inline(always)]
pub(super) fn four_times(v: Vec3) -> Vector3<Four> {
    Vector3::new(Four::splat(v.x), Four::splat(v.y), Four::splat(v.z))
}

/// Four vectors, side by side.
#[inline(always)]
pub(super) fn side_by_side(v: [Vec3; 4]) -> Vector3<Four> {
    let [a, b, c, d] = v;
    Vector3::new(Four([a.x, b.x, c.x, d.x]), Four([a.y, b.y, c.y, d.y]), Four([a.z, b.z, c.z, d.z]))
}

/// Calls `look_at` with the numbers of the boxes of a tree that overlap `aabb`, four at a time, and how many of them count: the
/// last ones are repeated to fill up.
#[inline(always)]
pub(super) fn by_fours(tree: &AabbTree, aabb: &Aabb, mut look_at: impl FnMut([u32; 4], usize)) {
    let mut waiting = [0; 4];
    let mut count = 0;
    tree.query(aabb, |i| {
        waiting[count & 3] = i;
        count += 1;
        if count == 4 {
            look_at(waiting, 4);
            count = 0;
        }
    });
    if count > 0 {
        for l in count..4 {
            waiting[l] = waiting[0];
        }
        look_at(waiting, count);
    }
}

/// The normals of four triangles of a mesh.
#[inline(always)]
pub(super) fn normals(mesh: &TriMesh, [i, j, k, l]: [u32; 4]) -> Vector3<Four> {
    side_by_side([mesh.normal(i), mesh.normal(j), mesh.normal(k), mesh.normal(l)])
}

/// Corner `which` of four triangles of a mesh, relative to `at`.
#[inline(always)]
pub(super) fn corners(mesh: &TriMesh, [i, j, k, l]: [u32; 4], which: usize, at: Vec3) -> Vector3<Four> {
    let corner = |i: u32| mesh.corner(i, which);
    side_by_side([corner(i), corner(j), corner(k), corner(l)]) - four_times(at)
}

macro_rules! operator {
    ($($name:ident $f:ident $name_assign:ident $f_assign:ident)*) => {$(
        impl $name for Four {
            type Output = Self;
            #[inline(always)]
            fn $f(self, b: Self) -> Self {
                self.with(b, |a, b| a.$f(b))
            }
        }
        impl $name_assign for Four {
            #[inline(always)]
            fn $f_assign(&mut self, b: Self) {
                *self = self.$f(b);
            }
        }
    )*};
}

operator!(Add add AddAssign add_assign Sub sub SubAssign sub_assign Mul mul MulAssign mul_assign);

impl Div for Four {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        self.with(b, |a, b| a / b)
    }
}

impl Neg for Four {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.with(self, |a, _| -a)
    }
}

impl Scalar for Four {
    const ZERO: Self = Self([0.0; 4]);
    const ONE: Self = Self([1.0; 4]);

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with(self, |a, _| a.sqrt())
    }

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self::splat(x)
    }
}
