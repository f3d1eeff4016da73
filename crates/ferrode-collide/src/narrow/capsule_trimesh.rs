use super::facet_axes::{FacetContacts, LeastOverlap, Place, clip_segment, each_facet};
use super::triangle::Facet;
use crate::{Capsule, Contacts, Frame, Shape, TriMesh};

/// Shortest axis that says anything.
const SHORTEST: f64 = 1e-5;

/// A capsule and a mesh: for each triangle that has the capsule's middle before it, the axis of least overlap among its
/// normal and those that its own edges and corners make with the capsule; then the line of the capsule that is deepest,
/// as far as it is over the triangle. Contacts lie on the capsule.
///
/// Where ODE's rule contradicts the surface, as at edges within it, the contacts are those of `body_trimesh`.
pub fn capsule_trimesh(capsule: &Capsule, fa: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    let (radius, half) = (capsule.radius(), 0.5 * capsule.length());
    each_facet(&Shape::Capsule(*capsule), fa, mesh, fm, out, |fc, facet| {
        capsule_facet(radius, half, fc, facet, mesh.use_flags(facet.index as u32))
    });
}

fn capsule_facet(radius: f64, half: f64, fc: &Frame, t: &Facet, flags: u8) -> Option<FacetContacts> {
    if t.height(fc.position) < 0.0 {
        return None;
    }
    let v = t.corners.map(|p| p - fc.position);
    let u = fc.axis(2);
    let mut best =
        LeastOverlap::new(v, t.normal, |d: ferrode_math::Vec3| d.dot(u).abs() * half + radius, SHORTEST);
    if best.overlap < 0.0 {
        return None;
    }
    let caps = [u * half, u * -half];
    let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
    let owns = |bit: usize| flags & (1 << bit) != 0;
    for e in (0..3).filter(|&e| owns(e)) {
        best.test(u.cross(edges[e]), 1.0, 1)?;
        for cap in caps {
            best.test((cap - v[e]).cross(edges[e]).cross(edges[e]), 1.0, 1)?;
        }
    }
    for i in (0..3).filter(|&i| owns(3 + i)) {
        for cap in caps {
            best.test((v[i] - cap).cross(u).cross(u), 1.0, 1)?;
            best.test(v[i] - cap, 1.0, 1)?;
        }
    }
    let n = best.normal;
    let mut found = FacetContacts::new(n, Place::Furthest);
    let line = clip_segment(caps.map(|cap| cap - n * radius), &v, t.normal);
    for p in line.into_iter().flatten() {
        found.push(fc.position + p, (best.level() - n.dot(p)).max(0.0));
    }
    Some(found)
}
