use crate::{Capsule, Contacts, Frame, Plane};

/// A capsule and a half-space: its lower end, then its upper one, each if it touches.
pub fn capsule_plane(capsule: &Capsule, fc: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    let n = plane.normal();
    let along = fc.axis(2) * (0.5 * capsule.length());
    // How much lower the lower end is than the middle.
    let drop = n.dot(along);
    let middle = plane.depth(fc.position) + capsule.radius();
    let lower = middle + drop.abs();
    if !(lower >= 0.0) {
        return;
    }
    let down = if drop > 0.0 { -along } else { along };
    let surface = fc.position - n * capsule.radius();
    out.push_sound(surface + down, n, lower);
    let upper = middle - drop.abs();
    if upper >= 0.0 {
        out.push_sound(surface - down, n, upper);
    }
}
