use super::manifold::{Found, below_face};
use super::reduce::reduce;
use super::support::Body;
use super::triangle::Facet;
use super::triangle_pairs::triangle_pairs;
use crate::shape::Neighbour;
use crate::{Contacts, Frame, GeomContact, TriMesh};
use ferrode_math::Vec3;

/// Two meshes: for each two triangles that cross, what of the one lies behind the other, over it; of the two ways the
/// one with less depth. Edges against edges are not told apart from that.
pub fn trimesh_trimesh(a: &TriMesh, fa: &Frame, b: &TriMesh, fb: &Frame, out: &mut Contacts<'_>) {
    // In a's coordinates.
    let local = Frame::new(fa.point_to_local(fb.position), fa.rotation.transpose() * fb.rotation);
    {
        let mut all = out.all();
        triangle_pairs(a, b, &local, |i, j| {
            let (Some(ta), Some(tb)) = (a.facet(i), b.facet(j)) else { return };
            let tb = Facet {
                corners: tb.corners.map(|p| local.point_to_world(p)),
                normal: local.vector_to_world(tb.normal),
                ..tb
            };
            facets(&ta, &tb, &mut all);
        });
    }
    let size = a.bounds().extent().abs_max().min(b.bounds().extent().abs_max());
    reduce(out, size);
    for c in out.added() {
        c.point.position = fa.point_to_world(c.point.position);
        c.point.normal = fa.vector_to_world(c.point.normal);
    }
}

/// Whether two triangles share a point: no separating axis among the two normals and the nine products of edges.
fn cross(a: &Facet, b: &Facet) -> bool {
    let apart = |n: Vec3| {
        let span = |t: &Facet| {
            let [x, y, z] = t.corners.map(|p| n.dot(p));
            (x.min(y).min(z), x.max(y).max(z))
        };
        let ((a0, a1), (b0, b1)) = (span(a), span(b));
        a1 < b0 || a0 > b1
    };
    if apart(a.normal) || apart(b.normal) {
        return false;
    }
    for i in 0..3 {
        let e = a.corners[(i + 1) % 3] - a.corners[i];
        for j in 0..3 {
            if apart(e.cross(b.corners[(j + 1) % 3] - b.corners[j])) {
                return false;
            }
        }
    }
    true
}

fn facets(a: &Facet, b: &Facet, out: &mut Contacts<'_>) {
    if !cross(a, b) {
        return;
    }
    // a behind b, and b behind a.
    let behind_b = behind(a, b);
    let behind_a = behind(b, a);
    let (list, normal) = match (&behind_b, &behind_a) {
        (Some((list, x)), Some((_, y))) if x <= y => (list, b.normal),
        (Some((list, _)), None) => (list, b.normal),
        (_, Some((list, _))) => (list, -a.normal),
        (None, None) => return,
    };
    for &(p, depth) in list.iter() {
        let mut c = GeomContact::new(p, normal, depth);
        c.side1 = a.index;
        c.side2 = b.index;
        out.push_contact(c);
    }
}

/// What of `a` lies over and behind `b`, and how deep. `None` if nothing does, or if a's surface goes on deeper beyond
/// an edge: then it is the neighbour there that tells the depth.
fn behind(a: &Facet, b: &Facet) -> Option<(Found, f64)> {
    let found = below_face(&Body::triangle(b.corners), b.normal, &Body::triangle(a.corners), -b.normal);
    let &(middle, depth) = found.iter().max_by(|p, q| p.1.total_cmp(&q.1))?;
    // Contacts lie midway between the surfaces.
    let deepest = middle - b.normal * (0.5 * depth);
    let scale = (a.corners[1] - a.corners[0]).abs_max() + (a.corners[2] - a.corners[0]).abs_max();
    for e in 0..3 {
        let out = a.outward(e);
        let on_edge = out.dot(a.corners[e] - deepest) < 1e-9 * scale;
        if on_edge && a.neighbours[e] == Neighbour::FlatOrConcave && out.dot(b.normal) < -1e-9 {
            return None;
        }
    }
    Some((found, depth))
}
