//! `dReal` and the arguments that C passes by pointer.
//!
//! The engine computes in `f64`; what crosses the boundary is a [`Real`], converted here and nowhere else.

use crate::fault::{Fault, Outcome};
use ferrode_math::{Mat3, Quat, Vec3};

/// The number type of the C interface, `dReal`.
#[cfg(not(feature = "single"))]
pub type Real = f64;
/// The number type of the C interface, `dReal`.
#[cfg(feature = "single")]
pub type Real = f32;

/// Three reals and a padding element, `dVector3`; also `dVector4` and `dQuaternion`.
pub type Real4 = [Real; 4];
/// Three rows of three reals and a padding element, `dMatrix3`.
pub type Real12 = [Real; 12];

/// From the boundary to the engine.
#[inline]
pub fn f(x: Real) -> f64 {
    #[allow(clippy::useless_conversion)]
    f64::from(x)
}

/// From the engine to the boundary.
#[inline]
pub fn r(x: f64) -> Real {
    x as Real
}

/// A vector from three arguments.
#[inline]
pub fn vec3(x: Real, y: Real, z: Real) -> Vec3 {
    Vec3::new(f(x), f(y), f(z))
}

#[inline]
pub fn vector(v: &[Real]) -> Vec3 {
    vec3(v[0], v[1], v[2])
}

#[inline]
pub fn vector3(v: Vec3) -> [Real; 3] {
    [r(v.x), r(v.y), r(v.z)]
}

#[inline]
pub fn padded(v: Vec3) -> Real4 {
    [r(v.x), r(v.y), r(v.z), 0.0]
}

#[inline]
pub fn quat(q: &Real4) -> Quat {
    Quat { w: f(q[0]), x: f(q[1]), y: f(q[2]), z: f(q[3]) }
}

#[inline]
pub fn quaternion(q: Quat) -> Real4 {
    [r(q.w), r(q.x), r(q.y), r(q.z)]
}

#[inline]
pub fn mat3(m: &Real12) -> Mat3 {
    let row = |i: usize| [f(m[4 * i]), f(m[4 * i + 1]), f(m[4 * i + 2])];
    Mat3::from_rows([row(0), row(1), row(2)])
}

#[inline]
pub fn matrix3(m: &Mat3) -> Real12 {
    let mut out = [0.0; 12];
    for (i, row) in m.rows.iter().enumerate() {
        for (j, x) in row.iter().enumerate() {
            out[4 * i + j] = r(*x);
        }
    }
    out
}

/// A pointer to `N` values that the function reads. Only C makes these, by calling an exported function; that the pointer
/// is null or good for `N` values is the contract of every function that takes one.
#[repr(transparent)]
#[derive(Clone, Copy)]
pub struct In<T, const N: usize = 1>(*const T);

impl<T: Copy, const N: usize> In<T, N> {
    /// The values, or the fault for a null pointer.
    #[inline]
    pub fn get(self) -> Outcome<[T; N]> {
        self.optional().ok_or(Fault::ARGUMENT)
    }

    /// A look at the values where they are, for large ones; or the fault for a null pointer. `work` does not call out.
    #[inline]
    pub fn look<R>(self, work: impl FnOnce(&[T; N]) -> R) -> Outcome<R> {
        if self.0.is_null() {
            return Err(Fault::ARGUMENT);
        }
        // SAFETY: not null, so by the type's contract good for N values of T, which nobody changes while `work` looks at them; C
        // aligns T naturally.
        Ok(work(unsafe { &*self.0.cast::<[T; N]>() }))
    }

    /// The values; `None` for a null pointer.
    #[inline]
    pub fn optional(self) -> Option<[T; N]> {
        // SAFETY: not null, so by the type's contract good for N values of T; C aligns T naturally.
        (!self.0.is_null()).then(|| unsafe { self.0.cast::<[T; N]>().read() })
    }
}

impl<T, const N: usize> In<T, N> {
    /// The pointer itself, to be kept.
    pub fn address(self) -> *const T {
        self.0
    }
}

/// A pointer to room for `N` values that the function writes; the contract is [`In`]'s.
#[repr(transparent)]
#[derive(Clone, Copy)]
pub struct Out<T, const N: usize = 1>(*mut T);

impl<T: Copy, const N: usize> Out<T, N> {
    /// Writes the values, or gives the fault for a null pointer.
    #[inline]
    pub fn set(self, values: [T; N]) -> Outcome<()> {
        self.check(Fault::ARGUMENT)?;
        self.set_if_wanted(values);
        Ok(())
    }

    /// Writes the values unless the pointer is null.
    #[inline]
    pub fn set_if_wanted(self, values: [T; N]) {
        if !self.0.is_null() {
            // SAFETY: not null, so by the type's contract there is room for N values of T; C aligns T naturally.
            unsafe { self.0.cast::<[T; N]>().write(values) }
        }
    }

    /// The values that are there now.
    #[inline]
    pub fn get(self) -> Outcome<[T; N]> {
        In(self.0.cast_const()).get()
    }

    /// The fault if the pointer is null.
    #[inline]
    pub fn check(self, fault: Fault) -> Outcome<()> {
        if self.0.is_null() { Err(fault) } else { Ok(()) }
    }
}

/// Room for the three components of a vector.
pub type OutVector = Out<Real, 3>;
/// Room for a padded rotation matrix.
pub type OutMatrix = Out<Real, 12>;
/// Room for a quaternion.
pub type OutQuaternion = Out<Real, 4>;
/// Three components to read.
pub type InVector = In<Real, 3>;
/// A padded rotation matrix to read.
pub type InMatrix = In<Real, 12>;
/// A quaternion to read.
pub type InQuaternion = In<Real, 4>;
