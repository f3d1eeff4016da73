//! Axes that joints share: set in world coordinates, kept in body coordinates.

use crate::Error;
use crate::ends::Ends;
use crate::rows::Row;
use ferrode_math::{Mat3, Quat, Vec3, plane_space, real};

/// A world vector, already of unit length, in the coordinates of the first and second body. `raw` is the caller's own
/// vector: with one body ODE keeps it as given for the world's side, unnormalised.
pub(crate) fn local_axes(ends: &Ends<'_>, unit: Vec3, raw: Vec3) -> [Vec3; 2] {
    let first = ends.a().rotation.transpose_mul(unit);
    let second = match ends.second {
        Some(b) => b.rotation.transpose_mul(unit),
        None => raw,
    };
    [first, second]
}

/// A caller's axis, in world coordinates and of any length, in the coordinates of the first and second body.
///
/// # Errors
/// [`Error::ZeroVector`] or [`Error::NotFinite`], naming the axis as `what`.
pub(crate) fn set_axes(ends: &Ends<'_>, what: &'static str, axis: Vec3) -> Result<[Vec3; 2], Error> {
    Ok(local_axes(ends, crate::error::unit(what, axis)?, axis))
}

/// The same with the world direction that the first body's axis has now: what ODE does when a joint is attached.
pub(crate) fn reset_axes(ends: &Ends<'_>, first: Vec3) -> [Vec3; 2] {
    let axis = ends.a().rotation * first;
    local_axes(ends, axis.normalized_or(axis), axis)
}

/// Two rows, with slots `slot` and `slot + 1`, that turn the world axis `b` of the second body onto the unit axis `a` of
/// the first; `k` is the factor from error to velocity.
#[inline]
pub(crate) fn write_alignment_rows(a: Vec3, b: Vec3, k: f64, two_bodies: bool, rows: &mut [Row], slot: u8) {
    let (p, q) = plane_space(a);
    let error = a.cross(b);
    for ((row, u), slot) in rows.iter_mut().zip([p, q]).zip(slot..) {
        row.set_angular(u, two_bodies);
        row.correct(k, error.dot(u));
        row.slot = slot;
    }
}

/// The angle of a relative rotation about a local unit axis, in [−π, π), by ODE's rule.
///
/// Rotation about other axes spoils the value: the magnitude of the whole rotation is reported with the sign of its
/// component along the axis.
pub(crate) fn hinge_angle(relative: Quat, axis: Vec3) -> f64 {
    let u = relative.imaginary();
    let m = u.length();
    let theta = if u.dot(axis) >= 0.0 { real::atan2(m, relative.w) } else { real::atan2(m, -relative.w) };
    let theta = 2.0 * theta;
    let theta = if theta > core::f64::consts::PI { theta - 2.0 * core::f64::consts::PI } else { theta };
    -theta
}

/// The angle between two vectors in radians, 0 … π; 0 if one of them is zero.
pub(crate) fn angle_between(a: Vec3, b: Vec3) -> f64 {
    real::atan2(a.cross(b).length(), a.dot(b))
}

/// What an axis of a motor is fixed to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum AxisFrame {
    /// The world.
    #[default]
    World,
    /// The joint's first body.
    First,
    /// The joint's second body; the world if there is none.
    Second,
}

impl AxisFrame {
    /// The frame's rotation to the world.
    pub(crate) fn rotation(self, ends: &Ends<'_>) -> Mat3 {
        match self {
            Self::World => Mat3::IDENTITY,
            Self::First => ends.a().rotation,
            Self::Second => ends.b().rotation,
        }
    }

    /// The frame with first and second body exchanged.
    pub(crate) fn exchanged(self) -> Self {
        match self {
            Self::World => Self::World,
            Self::First => Self::Second,
            Self::Second => Self::First,
        }
    }
}
