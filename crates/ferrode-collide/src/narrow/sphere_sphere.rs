use crate::{Contacts, Frame, Sphere};
use ferrode_math::Vec3;

/// Two balls: one contact, midway between the two surfaces on the line of centres.
pub fn sphere_sphere(a: &Sphere, fa: &Frame, b: &Sphere, fb: &Frame, out: &mut Contacts<'_>) {
    spheres(fa.position, a.radius(), fb.position, b.radius(), out);
}

/// The contact of two balls given by centre and radius; tells whether they touch.
///
/// With d = |c1 − c2|: normal (c1 − c2)/d, depth r1 + r2 − d, position c1 + normal (r2 − r1 − d)/2. Balls with one
/// centre are pushed apart along x.
#[inline]
pub fn spheres(c1: Vec3, r1: f64, c2: Vec3, r2: f64, out: &mut Contacts<'_>) -> bool {
    let line = c1 - c2;
    let (square, reach) = (line.length_squared(), r1 + r2);
    // Most are apart, and need no root to know it. A hair more, so that rounding here never decides.
    if square > reach * reach * (1.0 + 1e-9) {
        return false;
    }
    let d = square.sqrt();
    let depth = reach - d;
    // Written so that a distance that is no number is no contact.
    if !(depth >= 0.0) {
        return false;
    }
    if d <= 0.0 {
        out.push_sound(c1, Vec3::X, depth);
        return true;
    }
    // Of lengths whose square is subnormal, the root has lost digits.
    let n = if d > 1e-145 { line * (1.0 / d) } else { line.normalized_or(Vec3::X) };
    out.push_sound(c1 + n * (0.5 * (r2 - r1 - d)), n, depth);
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CollideOptions;

    #[test]
    fn centres_that_almost_coincide_have_a_unit_normal() {
        for d in [1e-140, 1e-150, 1e-155, 1e-160, 1e-161, 1e-170, 1e-300, 1e-320] {
            let mut list = Vec::new();
            let mut out = Contacts::new(&mut list, CollideOptions::default());
            assert!(spheres(Vec3::new(0.0, d, 0.0), 1.0, Vec3::ZERO, 1.0, &mut out));
            let n = list[0].point.normal;
            assert!((n.length() - 1.0).abs() < 1e-15, "{d}: {n:?}");
        }
    }
}
