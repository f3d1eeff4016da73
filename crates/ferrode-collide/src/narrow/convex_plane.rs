use crate::{Contacts, Convex, Frame, Plane};

/// A polyhedron and a half-space: the corners below the plane, in the order of their numbers.
///
/// Libode has no contact once all corners are below; here they go on pushing.
pub fn convex_plane(convex: &Convex, fc: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    let middle = plane.depth(fc.position);
    // A hair more, so that rounding here never decides.
    if middle < -convex.reach() * (1.0 + 1e-6) {
        return;
    }
    // Along the normal in the polyhedron's own coordinates.
    let n = fc.vector_to_local(plane.normal());
    let points = convex.points();
    for (chunk, [x, y, z]) in points.chunks(4).zip(convex.blocks()) {
        let mut depth = [0.0; 4];
        for l in 0..4 {
            depth[l] = middle - (n.x * x[l] + n.y * y[l] + n.z * z[l]);
        }
        if depth.iter().all(|&d| d < 0.0) {
            continue;
        }
        for (&p, &depth) in chunk.iter().zip(&depth) {
            if depth >= 0.0 {
                out.push(fc.point_to_world(p), plane.normal(), depth);
            }
        }
    }
}
