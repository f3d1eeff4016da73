use super::unit::{unit, unit_or};
use crate::{Contacts, Cylinder, Frame, Plane};
use ferrode_math::Vec3;

/// How near the cosine of axis and normal must be to ±1 for the cylinder to count as standing.
const STANDING: f64 = 1e-7;

/// A cylinder and a half-space: four points of the lower rim if it stands, else the lowest point of either rim.
pub fn cylinder_plane(cylinder: &Cylinder, fc: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    let (radius, half) = (cylinder.radius(), 0.5 * cylinder.length());
    let u = fc.axis(2);
    let n = plane.normal();
    // A hair more, so that rounding here never decides.
    if plane.depth(fc.position) < -cylinder.reach() * (1.0 + 1e-6) {
        return;
    }
    let cosine = u.dot(n);
    if 1.0 - cosine.abs() < STANDING {
        let disc = fc.position + if cosine < 0.0 { u * half } else { u * -half };
        // Radii from a fixed direction of the world: they do not turn with the cylinder.
        let helper = if u.x.abs() > STANDING { Vec3::Y } else { Vec3::X };
        let b = unit_or(u.cross(helper), Vec3::Z);
        let (a, b) = (u.cross(b), -b);
        for radial in [a, -a, b, -b] {
            let p = disc + radial * radius;
            let depth = plane.depth(p);
            if depth > 0.0 {
                out.push(p, n, depth);
            }
        }
        return;
    }
    let Some(down) = unit(u * cosine - n) else { return };
    for end in [-half, half] {
        let p = fc.position + u * end + down * radius;
        let depth = plane.depth(p);
        if depth >= 0.0 {
            out.push(p, n, depth);
        }
    }
}
