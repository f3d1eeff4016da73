//! One shape of a scene as the graphics card wants it.

use crate::Paint;
use crate::mesh::to_f32;
use ferrode_math::{Pose, Vec3};

/// Rows of the pose (rotation and position relative to the scene's origin), radii and pattern, half lengths and flags, colour.
pub type Instance = [f32; 24];

/// Size of an [`Instance`] in bytes.
pub const INSTANCE_BYTES: u64 = 24 * 4;

const GLOWING: u8 = 1;

/// Makes an instance.
pub fn instance(pose: &Pose, origin: Vec3, radii: Vec3, half: Vec3, paint: &Paint) -> Instance {
    let m = pose.rotation.to_matrix();
    let [px, py, pz] = to_f32(pose.position - origin);
    let [[a, b, c], [d, e, f], [g, h, i]] = [0, 1, 2].map(|k| to_f32(m.row(k)));
    let ([rx, ry, rz], [hx, hy, hz]) = (to_f32(radii), to_f32(half));
    let [red, green, blue, alpha] = paint.color.linear();
    let pattern = f32::from(paint.pattern as u8);
    let flags = f32::from(if paint.glowing { GLOWING } else { 0 });
    [a, b, c, px, d, e, f, py, g, h, i, pz, rx, ry, rz, pattern, hx, hy, hz, flags, red, green, blue, alpha]
}
