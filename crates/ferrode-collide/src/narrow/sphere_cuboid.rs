use super::unit::unit;
use crate::{Contacts, Cuboid, Frame, Sphere};
use ferrode_math::Vec3;

/// A ball and a box: one contact, at the box's point nearest to the centre.
///
/// A centre within the box is pushed out through the nearest face; the contact is then at the centre.
pub fn sphere_cuboid(sphere: &Sphere, fs: &Frame, cuboid: &Cuboid, fb: &Frame, out: &mut Contacts<'_>) {
    let half = cuboid.half_sides();
    let local = fb.point_to_local(fs.position);
    let clamp = |x: f64, h: f64| {
        if x > h {
            h
        } else if x < -h {
            -h
        } else {
            x
        }
    };
    let clamped = Vec3::new(clamp(local.x, half.x), clamp(local.y, half.y), clamp(local.z, half.z));
    if clamped != local {
        if (local - clamped).length_squared() > sphere.radius() * sphere.radius() * (1.0 + 1e-9) {
            return;
        }
        let q = fb.point_to_world(clamped);
        let line = fs.position - q;
        let depth = sphere.radius() - line.length();
        if depth >= 0.0 {
            // A centre a rounding error outside may coincide with its nearest point in world coordinates.
            let n =
                unit(line).unwrap_or_else(|| fb.vector_to_world((local - clamped).normalized_or(Vec3::Z)));
            out.push(q, n, depth);
        }
        return;
    }
    if !local.is_finite() {
        return;
    }
    let mut nearest = 0;
    let mut least = half.x - local.x.abs();
    for i in 1..3 {
        let distance = half[i] - local[i].abs();
        if distance < least {
            least = distance;
            nearest = i;
        }
    }
    let axis = fb.axis(nearest);
    let n = if local[nearest] > 0.0 { axis } else { -axis };
    out.push(fs.position, n, least + sphere.radius());
}
