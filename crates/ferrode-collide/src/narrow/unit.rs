//! Unit vectors, quickly.

use ferrode_math::Vec3;

/// The unit vector along `v`, as [`Vec3::normalized`] but for the last bits: that one first divides by the largest
/// component, which only lengths near the ends of the range of numbers need.
#[inline(always)]
pub(super) fn unit(v: Vec3) -> Option<Vec3> {
    let square = v.length_squared();
    if square > 1e-200 && square < 1e200 { Some(v * (1.0 / square.sqrt())) } else { v.normalized() }
}

/// As [`unit`]; `fallback` if `v` has no direction.
#[inline(always)]
pub(super) fn unit_or(v: Vec3, fallback: Vec3) -> Vec3 {
    unit(v).unwrap_or(fallback)
}
