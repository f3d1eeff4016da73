use crate::{Capsule, Contacts, Frame, Plane};

/// A capsule and a half-space: its lower end, then its upper one, each if it touches.
pub fn capsule_plane(capsule: &Capsule, fc: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    let n = plane.normal();
    let u = fc.axis(2);
    let half = 0.5 * capsule.length();
    let down = if n.dot(u) > 0.0 { -half } else { half };
    for end in [down, -down] {
        let p = fc.position + u * end - n * capsule.radius();
        let depth = plane.depth(p);
        if !(depth >= 0.0) {
            return;
        }
        out.push(p, n, depth);
    }
}
