use super::reduce::reduce;
use crate::{Contacts, Frame, GeomContact, Plane, TriMesh};

/// A mesh and a half-space: the vertices below the plane, `side1` the first triangle they belong to.
pub fn trimesh_plane(mesh: &TriMesh, fm: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    // The plane in the mesh's coordinates.
    let n = fm.vector_to_local(plane.normal());
    let d = plane.depth(fm.position);
    // The whole mesh above: nothing to look at. A hair more, so that rounding here never decides.
    let (centre, half) = (mesh.bounds().center(), mesh.bounds().extent() * 0.5);
    if d - n.dot(centre) + n.abs().dot(half) < -1e-9 * (d.abs() + centre.abs_max() + half.abs_max()) {
        return;
    }
    {
        let mut all = out.all();
        for (i, t) in mesh.triangles().iter().enumerate() {
            for &v in t {
                // Most vertices are met more than once: that first.
                if mesh.first_triangle(v) != Some(i as u32) {
                    continue;
                }
                let p = mesh.vertices()[v as usize];
                let depth = d - n.dot(p);
                if depth > 0.0 {
                    let mut c = GeomContact::new(fm.point_to_world(p), plane.normal(), depth);
                    c.side1 = i as i32;
                    all.push_contact(c);
                }
            }
        }
    }
    reduce(out, mesh.bounds().extent().abs_max());
}
