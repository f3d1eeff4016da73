use super::bodies::in_first_frame;
use super::convex::touch;
use super::manifold::add_manifold;
use super::support::Body;
use crate::{Capsule, Contacts, Cylinder, Frame};
use ferrode_math::Vec3;

/// A capsule and a cylinder: exact distance and depth; two contacts where the capsule lies along the side or on a cap.
pub fn capsule_cylinder(
    capsule: &Capsule,
    fa: &Frame,
    cylinder: &Cylinder,
    fb: &Frame,
    out: &mut Contacts<'_>,
) {
    in_first_frame(fa, fb, out, |fa, fb, out| {
        let a = Body::capsule(capsule, fa, Vec3::ZERO);
        let b = Body::cylinder(cylinder, fb, Vec3::ZERO);
        if let Some(t) = touch(&a, &b) {
            add_manifold(&a, &b, &t, Vec3::ZERO, out);
        }
    });
}
