//! Rows that keep two bodies from turning relative to each other.

use crate::ends::{Ends, StepContext};
use crate::rows::Row;
use ferrode_math::{Quat, Vec3};

/// The rotation by which the second body has left its place relative to the first, as a small-angle vector (twice the
/// imaginary part of the quaternion) in the world. `initial` is the relative rotation that is wanted.
pub(crate) fn error(ends: &Ends<'_>, initial: Quat) -> Vec3 {
    let q = ends.relative_rotation() * initial.conjugate();
    let u = if q.w < 0.0 { -q.imaginary() } else { q.imaginary() };
    (ends.a().rotation * u) * 2.0
}

/// Three rows with slots from `slot`, about x, y and z, that keep the relative rotation `initial`, with the world's ERP
/// and CFM.
pub(crate) fn write_rows(ends: &Ends<'_>, ctx: &StepContext, initial: Quat, rows: &mut [Row], slot: u8) {
    let error = error(ends, initial).to_array();
    for (((row, u), e), slot) in rows.iter_mut().zip([Vec3::X, Vec3::Y, Vec3::Z]).zip(error).zip(slot..) {
        row.set_angular(u, ends.two());
        row.correct(ctx.k(), e);
        row.slot = slot;
    }
}
