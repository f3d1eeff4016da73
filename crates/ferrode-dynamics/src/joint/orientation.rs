//! Rows that keep two bodies from turning relative to each other.

use crate::ends::{Ends, StepContext};
use crate::rows::Row;
use ferrode_math::{Quat, Vec3, real};

/// The rotation by which the second body has left its place relative to the first, seen from the first, on the shorter
/// way. `initial` is the relative rotation conj(q₁) q₂ that is wanted.
fn deviation(ends: &Ends<'_>, initial: Quat) -> Quat {
    let q = ends.relative_rotation() * initial.conjugate();
    if q.w < 0.0 { -q } else { q }
}

/// The angle of that rotation.
pub(crate) fn angle(ends: &Ends<'_>, initial: Quat) -> f64 {
    let q = deviation(ends, initial);
    2.0 * real::atan2(q.imaginary().length(), q.w)
}

/// Three rows with slots from `slot`, about x, y and z, that keep the relative rotation `initial`, with the world's ERP
/// and CFM. The error that they correct is twice the imaginary part of the deviation: its angle, while it is small.
pub(crate) fn write_rows(ends: &Ends<'_>, ctx: &StepContext, initial: Quat, rows: &mut [Row], slot: u8) {
    let error = (ends.a().rotation * deviation(ends, initial).imaginary()) * 2.0;
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    for (((row, u), e), slot) in rows.iter_mut().zip(axes).zip(error.to_array()).zip(slot..) {
        row.set_angular(u, ends.two());
        row.correct(ctx.k(), e);
        row.slot = slot;
    }
}
