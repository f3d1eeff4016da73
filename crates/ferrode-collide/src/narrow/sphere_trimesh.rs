use super::facet_axes::{greater, lesser};
use super::merge::{ContactMerge, merge};
use super::reduce::{keep_wanted, reduce};
use super::triangle::Facet;
use crate::shape::Neighbour;
use crate::{Contacts, Frame, GeomContact, Sphere, TriMesh};
use ferrode_math::{Aabb, Vec3};

/// A ball and a mesh: for each triangle that has the centre before it, the point nearest to the centre, with the
/// triangle's normal and the part of the overlap along it (as libode), merged as [`TriMesh::with_sphere_merge`] says.
pub fn sphere_trimesh(sphere: &Sphere, fs: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    let r = sphere.radius();
    let center = fm.point_to_local(fs.position);
    let around = Aabb::from_center(center, Vec3::splat(r));
    if !mesh.bounds().overlaps(&around) {
        return;
    }
    let consider = |i: u32, all: &mut Contacts<'_>| {
        let (n, corners) = (mesh.normal(i), mesh.corners(i));
        if n == Vec3::ZERO {
            return;
        }
        let facet = Facet { corners, normal: n, neighbours: [Neighbour::None; 3], index: i as i32 };
        let q = facet.nearest(center);
        let line = center - q;
        let distance = line.length();
        let overlap = r - distance;
        if overlap >= 0.0 {
            let cosine = if distance > 0.0 { line.dot(n) / distance } else { 1.0 };
            let mut c = GeomContact::new(fm.point_to_world(q), fm.vector_to_world(n), overlap * cosine);
            c.side2 = i as i32;
            all.push_contact(c);
        }
    };
    {
        let mut all = out.all();
        mesh.tree().query(&around, |i| {
            let n = mesh.normal(i);
            let a = mesh.corner(i, 0) - center;
            let height = -n.dot(a);
            if !((height >= 0.0) & (height <= r)) {
                return;
            }
            let (b, c) = (mesh.corner(i, 1) - center, mesh.corner(i, 2) - center);
            // Squared distance of the box around the triangle.
            let beside = |a: f64, b: f64, c: f64| {
                let (low, high) = (lesser(lesser(a, b), c), greater(greater(a, b), c));
                let gap = greater(greater(low, -high), 0.0);
                gap * gap
            };
            let square = beside(a.x, b.x, c.x) + beside(a.y, b.y, c.y) + beside(a.z, b.z, c.z);
            if square <= r * r * (1.0 + 1e-9) {
                consider(i, &mut all);
            }
        });
    }
    match mesh.sphere_merge() {
        ContactMerge::None => reduce(out, r),
        // Two triangles with one normal count twice.
        way => {
            keep_wanted(out, r);
            merge(way, out);
        }
    }
}
