use super::cutout::Cutout;
use super::reduce::keep_wanted;
use super::triangle::{Facet, Verdict, judge};
use super::triangle_pairs::triangle_pairs;
use crate::{Contacts, Frame, GeomContact, TriMesh};
use ferrode_math::{Aabb, Vec3};

/// Points of a triangle as deep as its deepest, to this, in metres, are contacts too.
const BAND: f64 = 1e-6;
/// Contacts nearer than this are one.
const ONE: f64 = 1e-4;
/// Depths that differ by less are one.
const EQUAL: f64 = 1e-5;
/// A contact whose point is nearer to the surface elsewhere than this share of its depth is none.
const NEARER: f64 = 0.5;

/// Two meshes: for each two triangles that cross, the deepest points of the one behind the other and over it; of the two
/// ways the one with less depth. Contacts lie on the mesh that reaches into the other. Contacts at one place are one: the
/// deeper, or, as deep, with the mean normal.
///
/// That is ODE's rule. Edges against edges are not told apart from that, and a wall may report how far it is behind the
/// far side of the other mesh: contacts from which the surface is less than half as far away elsewhere are left out, and those
/// beyond which the mesh goes on deeper without a bend.
pub fn trimesh_trimesh(a: &TriMesh, fa: &Frame, b: &TriMesh, fb: &Frame, out: &mut Contacts<'_>) {
    // In a's coordinates.
    let local = Frame::new(fa.point_to_local(fb.position), fa.rotation.transpose() * fb.rotation);
    let mut crossing = false;
    // Where walls are flush with walls, or meshes cover each other, nothing is deeper than the surface is near elsewhere: then
    // that does not count.
    for share in [NEARER, 0.0] {
        let mut all = out.all();
        triangle_pairs(a, b, &local, |i, j| {
            let (Some(ta), Some(tb)) = (a.facet(i), b.facet(j)) else { return };
            let tb = Facet {
                corners: tb.corners.map(|p| local.point_to_world(p)),
                normal: local.vector_to_world(tb.normal),
                ..tb
            };
            if cross(&ta, &tb) {
                crossing = true;
                let nearer_a = |p: Vec3, d: f64| is_near(a, p, share * d);
                let nearer_b = |p: Vec3, d: f64| is_near(b, local.point_to_local(p), share * d);
                facets(&ta, &tb, nearer_a, nearer_b, &mut all);
            }
        });
        if !crossing || out.added().iter().any(|c| c.point.depth > BAND) {
            break;
        }
    }
    keep_wanted(out, a.bounds().extent().abs_max().min(b.bounds().extent().abs_max()));
    for c in out.added() {
        c.point.position = fa.point_to_world(c.point.position);
        c.point.normal = fa.vector_to_world(c.point.normal);
    }
}

/// Whether a mesh has a triangle within `distance` of a point, all in its coordinates.
fn is_near(mesh: &TriMesh, p: Vec3, distance: f64) -> bool {
    let mut near = false;
    mesh.tree().query(&Aabb::from_center(p, Vec3::splat(distance)), |i| {
        near =
            near || mesh.facet(i).is_some_and(|t| (t.nearest(p) - p).length_squared() < distance * distance);
    });
    near
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

fn facets(
    a: &Facet,
    b: &Facet,
    nearer_a: impl Fn(Vec3, f64) -> bool,
    nearer_b: impl Fn(Vec3, f64) -> bool,
    out: &mut Contacts<'_>,
) {
    let (behind_b, behind_a) = (behind(a, b), behind(b, a));
    let depth = |found: &Option<(Cutout, f64)>| found.as_ref().map_or(f64::INFINITY, |f| f.1);
    // The other way only if the shorter one contradicts the surfaces.
    let order = if depth(&behind_b) <= depth(&behind_a) { [true, false] } else { [false, true] };
    for of_a in order {
        let found = if of_a { &behind_b } else { &behind_a };
        let Some((polygon, depth)) = *found else { continue };
        // The triangle that reaches in, the one that it reaches through, and the contact's normal.
        let (inner, surface, normal) = if of_a { (a, b, b.normal) } else { (b, a, -a.normal) };
        let mut any = false;
        for &p in polygon.corners() {
            if -surface.height(p) <= depth - BAND
                || judge(&inner.corners, inner.normal, &inner.neighbours, -surface.normal, || p)
                    == Verdict::Ghost
                || if of_a { nearer_b(p, depth) } else { nearer_a(p, depth) }
            {
                continue;
            }
            let mut c = GeomContact::new(p, normal, depth);
            c.side1 = a.index;
            c.side2 = b.index;
            add(c, out);
            any = true;
        }
        if any {
            return;
        }
    }
}

/// What of `a` is over and behind `b`, and how deep; `None` if nothing is.
fn behind(a: &Facet, b: &Facet) -> Option<(Cutout, f64)> {
    let mut polygon = Cutout::new(&a.corners);
    for e in 0..3 {
        // Of any length.
        let outward = (b.corners[(e + 1) % 3] - b.corners[e]).cross(b.normal);
        polygon.keep_below(outward, outward.dot(b.corners[e]));
    }
    polygon.keep_below(b.normal, b.normal.dot(b.corners[0]));
    let depth = polygon.corners().iter().map(|&p| -b.height(p)).reduce(f64::max)?;
    Some((polygon, depth.max(0.0)))
}

/// Adds a contact, or, if there is one at its place, lets the two be one. Those that push against each other cancel.
fn add(c: GeomContact, out: &mut Contacts<'_>) {
    let list = out.added();
    let Some(i) = list.iter().position(|k| (k.point.position - c.point.position).abs_max() < ONE) else {
        out.push_contact(c);
        return;
    };
    let k = &mut list[i];
    if c.point.depth > k.point.depth + EQUAL {
        *k = c;
    } else if c.point.depth > k.point.depth - EQUAL {
        match (k.point.normal + c.point.normal).normalized() {
            Some(mean) => {
                k.point.normal = mean;
                // Of two triangles.
                (k.side1, k.side2) = (-1, -1);
            }
            None => {
                let last = list.len() - 1;
                list.swap(i, last);
                out.truncate(last);
            }
        }
    }
}
