use crate::{Contacts, Convex, Frame, Plane};

/// A polyhedron and a half-space: the corners below the plane, in the order of their numbers.
///
/// Libode has no contact once all corners are below; here they go on pushing.
pub fn convex_plane(convex: &Convex, fc: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    for &p in convex.points() {
        let w = fc.point_to_world(p);
        let depth = plane.depth(w);
        if depth >= 0.0 {
            out.push(w, plane.normal(), depth);
        }
    }
}
