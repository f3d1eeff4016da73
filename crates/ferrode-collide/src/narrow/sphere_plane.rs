use crate::{Contacts, Frame, Plane, Sphere};

/// A ball and a half-space: one contact, at the ball's lowest point.
pub fn sphere_plane(sphere: &Sphere, fs: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    let depth = plane.depth(fs.position) + sphere.radius();
    out.push_sound(fs.position - plane.normal() * sphere.radius(), plane.normal(), depth);
}
