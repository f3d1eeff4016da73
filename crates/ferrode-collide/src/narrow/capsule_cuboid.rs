use super::{closest_segment_cuboid, cuboid_cuboid, spheres};
use crate::{Capsule, Contacts, Cuboid, Frame};
use ferrode_math::Vec3;

/// A capsule and a box: a ball at the axis point nearest to the box.
///
/// As libode, a capsule whose axis enters the box is treated as the box around it.
pub fn capsule_cuboid(capsule: &Capsule, fc: &Frame, cuboid: &Cuboid, fb: &Frame, out: &mut Contacts<'_>) {
    let r = capsule.radius();
    let (p1, p2) = capsule.segment(fc);
    let (on_axis, on_box) = closest_segment_cuboid(p1, p2, cuboid, fb);
    // Nearer than rounding can tell, the axis counts as inside: the difference has no direction.
    let size = 0.5 * capsule.length() + r + cuboid.half_sides().length();
    let inside = 1e-14 * size + 1e-15 * (1.0 + on_box.abs_max());
    if (on_axis - on_box).length() >= inside {
        spheres(on_axis, r, on_box, 0.0, out);
    } else if let Ok(around) = Cuboid::from_half_sides(Vec3::new(r, r, 0.5 * capsule.length() + r)) {
        // libode asks with the box first, which decides between equal axes.
        cuboid_cuboid(cuboid, fb, &around, fc, out);
        out.swap();
    }
}
