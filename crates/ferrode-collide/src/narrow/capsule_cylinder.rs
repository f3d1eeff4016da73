use super::convex::touch;
use super::manifold::add_manifold;
use super::support::Body;
use crate::{Capsule, Contacts, Cylinder, Frame};

/// A capsule and a cylinder: exact distance and depth; two contacts where the capsule lies along the side or on a cap.
pub fn capsule_cylinder(
    capsule: &Capsule,
    fa: &Frame,
    cylinder: &Cylinder,
    fb: &Frame,
    out: &mut Contacts<'_>,
) {
    let a = Body::capsule(capsule, fa, fa.position);
    let b = Body::cylinder(cylinder, fb, fa.position);
    if let Some(t) = touch(&a, &b) {
        add_manifold(&a, &b, &t, fa.position, out);
    }
}
