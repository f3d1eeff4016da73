use super::reduce::reduce;
use crate::{Contacts, Frame, GeomContact, Sphere, TriMesh};
use ferrode_math::Aabb;
use ferrode_math::Vec3;

/// A ball and a mesh: for each triangle that has the centre before it, the point nearest to the centre, with the
/// triangle's normal and the part of the overlap along it (as libode).
pub fn sphere_trimesh(sphere: &Sphere, fs: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    let r = sphere.radius();
    let center = fm.point_to_local(fs.position);
    let around = Aabb::from_center(center, Vec3::splat(r));
    {
        let mut all = out.all();
        mesh.tree().query(&around, |i| {
            let Some(facet) = mesh.facet(i) else { return };
            let height = facet.height(center);
            if height < 0.0 || height > r {
                return;
            }
            let q = facet.nearest(center);
            let line = center - q;
            let distance = line.length();
            let overlap = r - distance;
            if overlap >= 0.0 {
                let cosine = if distance > 0.0 { line.dot(facet.normal) / distance } else { 1.0 };
                let mut c = GeomContact::new(
                    fm.point_to_world(q),
                    fm.vector_to_world(facet.normal),
                    overlap * cosine,
                );
                c.side2 = facet.index;
                all.push_contact(c);
            }
        });
    }
    reduce(out, r);
}
